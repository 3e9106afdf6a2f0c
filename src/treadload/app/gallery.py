"""Registered figures of a run on a page: one is chosen from a list and drawn below it."""

from __future__ import annotations

from nicegui import background_tasks, ui

from treadload.app.answers import Picture
from treadload.app.elements import with_attributes
from treadload.app.page_frame import Page


class Gallery:
    """A list of the figures of a run. page: that it is part of."""

    def __init__(self, page: Page) -> None:
        self._page, self._run = page, ""

    def build(self) -> None:
        """The list and the place of the picture; nothing is listed before `show`."""
        self._choice = ui.select({}, label="figure", on_change=lambda event: self._chosen(event.value))
        self._choice.props('dense outlined options-dense clearable id="gallery"').classes("long")
        self._place = ui.element("div").classes("pictures")
        self._choice.set_visibility(False)

    async def show(self, run: str) -> None:
        """List the figures of a run. run: its name; the list of one that stands already is left as it is."""
        if run == self._run:
            return
        self._run = run
        answer = await self._page.last("gallery", run=run)
        with self._page.client:
            self._place.clear()
            self._choice.set_options(answer.get("titles", {}), value=None)
            self._choice.set_visibility(bool(answer.get("titles")))

    def _chosen(self, key: str | None) -> None:
        self._place.clear()
        if key is not None and self._page.now is not None:
            background_tasks.create(self._draw(self._page.now.name, key))

    async def _draw(self, run: str, key: str) -> None:
        answer = await self._page.last("picture", run=run, key=key)
        if "error" not in answer and self._choice.value == key:
            with self._page.client, self._place:
                put(key, answer["picture"])


def put(key: str, picture: Picture) -> None:
    """A picture of the process, or the sentence that says why there is none, where the page is being built."""
    if picture["url"]:
        shown = ui.element("img").classes("wide" if picture["wide"] else "")
        with_attributes(shown, src=picture["url"], alt=picture["title"], data_picture=key)
    else:
        with_attributes(ui.label(picture["missing"]).classes("note"), data_picture=key)
