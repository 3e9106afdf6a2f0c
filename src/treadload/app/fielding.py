"""Fields of a form on the page: what is typed, whose it is, what is wrong with it; files that are uploaded."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

from nicegui import events, ui

from treadload.app.elements import plain, with_attributes
from treadload.app.fields import Field, default_of
from treadload.app.form import Checked, Form
from treadload.app.guard import MOST_UPLOADED
from treadload.app.session import Session
from treadload.errors import InputError

_TOO_LARGE = f"this file is not of the kind that goes here, or larger than {MOST_UPLOADED // 2**20} MB"


class Uploads:
    """What is wrong with the whole, and files that are uploaded."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._problems: Any = None
        self._said = False

    def build(self) -> None:
        """Put the place for problems on the page."""
        self._problems = ui.element("div").props('role="alert" id="problems"')

    def say(self, text: str) -> None:
        """Say what is wrong with the whole."""
        self._said = True
        self._problems.clear()
        with self._problems:
            ui.label(text).classes("problem")

    def unsay(self) -> None:
        """What was said is over: something was solved since."""
        if self._said:
            self._said = False
            self._problems.clear()

    def upload(self, text: str, suffixes: tuple[str, ...], kept: Callable[[str], Any] | None, name: str) -> None:
        """A button that asks for a file. kept: called with the name under which it is kept."""
        with ui.element("div").classes("upload"):
            chooser = ui.upload(
                auto_upload=True, max_file_size=MOST_UPLOADED, on_rejected=lambda: self.say(_TOO_LARGE),
                on_upload=lambda event: self._uploaded(event, suffixes, kept),
            )  # fmt: skip
            with_attributes(chooser, accept=",".join(suffixes), aria_hidden="true").classes.append(f"upload-{name}")
            plain(text, lambda: chooser.run_method("pickFiles"))

    async def _uploaded(
        self, event: events.UploadEventArguments, suffixes: tuple[str, ...], kept: Callable[[str], Any] | None
    ) -> None:
        try:
            content = await event.file.read()
            if len(content) > MOST_UPLOADED:
                raise InputError(_TOO_LARGE)
            if suffixes == (".toml",):
                self.case_came(event.file.name[:120], content)
                return
            name = self.session.keep(event.file.name, content, suffixes)
        except InputError as error:
            self.say(str(error))
            return
        made: Any = None if kept is None else kept(name)
        if hasattr(made, "__await__"):
            await made

    def case_came(self, name: str, content: bytes) -> None:
        """A case was uploaded. name: that the user knows."""


class Fields(Uploads, ABC):
    """The fields of a room, and what is said of them. changed: called with a form that the reader takes.

    opened: called with a kind and the kept name of a file that is no case.
    """

    def __init__(
        self, session: Session, room: str, changed: Callable[[Form], Any], opened: Callable[[str, str], Any]
    ) -> None:
        super().__init__(session)
        self._room, self._changed, self._opened = room, changed, opened
        self._shown: dict[str, tuple[Field, Any]] = {}
        self._checked = Checked(None, {})

    @property
    def form(self) -> Form:
        """As it stands."""
        return self.session.forms[self._room]

    def build(self) -> None:
        """Put the fields on the page."""
        super().build()
        self._all()

    @ui.refreshable_method
    def _all(self) -> None:
        self._shown.clear()
        self.groups()
        self.tell()

    @abstractmethod
    def groups(self) -> None:
        """The groups of fields."""

    def refresh(self) -> None:
        """Show the fields anew."""
        self._all.refresh()

    def again(self, form: Form) -> None:
        """The form has other fields than before."""
        self.take(form)
        self._solve()

    def _solve(self) -> None:
        # The fields of another form are put on the page, and what is wrong with it is told, a moment later.
        if self.form.check(self.session.folder).case is not None:
            self._changed(self.form)

    def take(self, form: Form) -> None:
        """Show another form, of a run or a file."""
        self.session.forms[self._room] = form
        self.refresh()

    def tell(self) -> None:
        """Check the form, and say at each field whose its value is and what is wrong with it."""
        self._checked = self.form.check(self.session.folder)
        for path, (field, element) in self._shown.items():
            wrong = self._checked.at(path, set(self._shown))
            otherwise = default_of(field, self._checked.case)
            given = self.form.value(path) is not None
            # What a road of yours leaves out is no value of yours.
            yours = given and self.form.is_yours(path)
            hint = "yours" if yours else "default" if given or not otherwise else f"default: {otherwise}"
            with_attributes(element, hint=hint).props(remove="error error-message")
            element.classes(add="is-yours" if yours else "", remove="" if yours else "is-yours")
            if wrong:
                element.props["error"], element.props["error-message"] = True, wrong
                element.update()
        self._problems.clear()
        with self._problems:
            for text in self._checked.elsewhere(set(self._shown)):
                ui.label(text).classes("problem")
        self._said = False
        self.told()

    def unsay(self) -> None:
        """What was said is over; what is wrong with the fields of now is not."""
        if self._said:
            self.tell()

    def told(self) -> None:
        """What is said of the fields has been said."""

    def field(self, field: Field, *, wide: bool = False) -> None:
        """Put a field on the page."""
        value = field.shown(self.form.value(field.path))
        element: Any
        if field.kind == "choice":
            options = dict(field.choices or {})
            if value and value not in options:
                options[value] = value
            if not value and "" not in options:
                value = field.shown(default_of(field, None)) or next(iter(options))
            element = ui.select(options, value=value, label=field.label)
            element.on_value_change(lambda event: self._typed(field, str(event.value or "")))
            element.props("options-dense")
        else:
            element = ui.input(field.label, value=value)
            with_attributes(element, suffix=field.unit).props('stack-label autocomplete="off"')
            element.on("blur", lambda: self._typed(field, str(element.value or "")))
            element.on("keydown.enter", lambda: self._typed(field, str(element.value or "")))
        with_attributes(element, data_path=field.path).props("dense outlined")
        element.classes("field wide" if wide else "field")
        if field.words:
            element.tooltip(field.words)
        self._shown[field.path] = (field, element)

    def _typed(self, field: Field, text: str) -> None:
        if text.strip() == field.shown(self.form.value(field.path)):
            return
        before = self.form.table
        self.session.forms[self._room] = self.form.with_text(field, text)
        self.tell()
        if self.form.table != before:
            self._solve()

    def case_came(self, name: str, content: bytes) -> None:
        """A case of one's own. Raises InputError."""
        try:
            text = content.decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(f"{name} is not a text file in UTF-8") from error
        self.again(type(self.form).from_text(text, name, self.session.files))
