"""Files that are uploaded to a page, and what is wrong with the whole of what stands on it."""

from __future__ import annotations

import weakref
from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import events, ui

from treadload.app.elements import plain, with_attributes
from treadload.app.guard import MOST_UPLOADED
from treadload.app.session import Session
from treadload.errors import InputError

_TOO_LARGE = f"this file is not of the kind that goes here, or larger than {MOST_UPLOADED // 2**20} MB"


def _receiver(page: weakref.ref[Uploads], number: int) -> Callable[[events.UploadEventArguments], Awaitable[None]]:
    """What an upload calls, without keeping its page: the route of an upload outlives the page in caches of FastAPI,
    4096 routes of them, and a page with all its fields would stay with it.
    """

    async def received(event: events.UploadEventArguments) -> None:
        uploads = page()
        if uploads is not None:
            await uploads.uploaded(event, number)

    return received


class Uploads:
    """What is wrong with the whole, and files that are uploaded."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._problems: Any = None
        self._has_problem = False
        # Of each button: the suffixes that it takes, and who is called with the name of the file.
        self._receivers: list[tuple[tuple[str, ...], Callable[[str], object] | None]] = []

    def build(self) -> None:
        """Put the place for problems on the page."""
        self._problems = ui.element("div").props('role="alert" id="problems"')

    def show_problem(self, text: str) -> None:
        """Show what is wrong with the whole."""
        self._has_problem = True
        self._problems.clear()
        with self._problems:
            ui.label(text).classes("problem")

    def clear_problem(self) -> None:
        """The problem is over: something was solved since."""
        if self._has_problem:
            self._has_problem = False
            self._problems.clear()

    def upload(self, text: str, suffixes: tuple[str, ...], kept: Callable[[str], object] | None) -> None:
        """A button that asks for a file. kept: called with the name under which it is kept; None for a case."""
        with ui.element("div").classes("upload"):
            number = len(self._receivers)
            self._receivers.append((suffixes, kept))
            chooser = ui.upload(
                auto_upload=True, max_file_size=MOST_UPLOADED, on_rejected=lambda: self.show_problem(_TOO_LARGE),
                on_upload=_receiver(weakref.ref(self), number),
            )  # fmt: skip
            with_attributes(chooser, accept=",".join(suffixes), aria_hidden="true")
            plain(text, lambda: chooser.run_method("pickFiles"))

    async def uploaded(self, event: events.UploadEventArguments, number: int) -> None:
        """Keep a file, or show why not. number: of the button that it came by."""
        suffixes, kept = self._receivers[number]
        try:
            content = await event.file.read()
            if len(content) > MOST_UPLOADED:
                raise InputError(_TOO_LARGE)
            if kept is None:
                self.case_came(event.file.name[:120], content)
                return
            name = self.session.keep(event.file.name, content, suffixes)
        except InputError as error:
            self.show_problem(str(error))
            return
        waiting: Any = kept(name)
        if hasattr(waiting, "__await__"):
            await waiting

    def case_came(self, name: str, content: bytes) -> None:
        """A case was uploaded. name: that the user knows."""
