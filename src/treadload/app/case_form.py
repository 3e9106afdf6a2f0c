"""The form at the left of a page: one renderer for the parts of any case, whatever tables it has."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from nicegui import ui

from treadload.app.elements import choosing, heading, mark_error, marks_change, plain, with_attributes
from treadload.app.field_errors import at_fields
from treadload.app.form import Checked, Form
from treadload.app.form_field import LIST, Field
from treadload.app.form_parts import Absent, Choosing, Group, Part, Rows
from treadload.app.link_box import LinkBox
from treadload.app.road_drawing import RoadDrawing
from treadload.app.session import FILES, Session
from treadload.app.tread_section import TreadSection
from treadload.app.uploads import Uploads
from treadload.errors import InputError
from treadload.us_units import in_us_units

_IN_US_UNITS = (
    "A number in a field is in the SI unit at the field, or has its unit: 8000 lbf. Results are in US units."
)


class CaseForm(Uploads):
    """The fields of a case, and what is wrong with them.

    room: of the page whose form it is. changed: called with a form that the reader takes. files: buttons for files
    that are no part of the case: text → suffixes and what is done with the kept name.
    """

    def __init__(
        self, session: Session, room: str, changed: Callable[[Form], object],
        files: dict[str, tuple[tuple[str, ...], Callable[[str], object]]] | None = None,
    ) -> None:  # fmt: skip
        super().__init__(session)
        self._room, self._changed, self._files = room, changed, files or {}
        self._shown: dict[str, tuple[Field, Any]] = {}
        self._checked = Checked(None, {})
        # Called once the fields were compared with what is shown of them.
        self.when_checked: Callable[[], object] = lambda: None
        # The form and the names of files from before an upload that is not solved yet.
        self._before_upload: tuple[Form, dict[str, str]] | None = None
        self._open: set[str] = set()
        self._section: TreadSection | None = None
        self._road: RoadDrawing | None = None
        self._fields: Any = None

    @property
    def form(self) -> Form:
        """As it stands."""
        return self.session.forms[self._room]

    def build(self) -> None:
        """Put the fields on the page."""
        super().build()
        self.link = LinkBox(self.session, lambda: self.form, self.again)
        self._fields = ui.element("div")
        self._all()

    def _all(self) -> None:
        """Put the fields of the form of now in place of those of before."""
        self._fields.clear()
        self._shown.clear()
        self._section = self._road = None
        with self._fields:
            self._whole()

    def _whole(self) -> None:
        if in_us_units():
            ui.label(_IN_US_UNITS).classes("note").props('id="units"')
        whole = self.form.parts(self.session.folder)
        tables = [part for part in whole.parts if isinstance(part, Group | Rows)]
        self._heading("Case", "")
        self._parts([part for part in whole.parts if part not in tables])
        self._more("", [part for part in whole.rest if not isinstance(part, Absent)])
        for table in tables:
            self._heading(table.label, table.path if table.can_go else "")
            self._inside(table)
        absent = [part for part in whole.rest if isinstance(part, Absent)]
        if absent:
            heading("Also solve")
            self._parts(absent)
        heading("Your case")
        with ui.element("div").classes("line"):
            self.upload("open a TOML …", (".toml",), None)
            self.link.button()
            for text, (suffixes, opened) in self._files.items():
                self.upload(text, suffixes, opened)
            marks_change(plain("start again", lambda: self.again(Form.first(self.form.command))))
        for sentence in self.form.schema.broken:
            ui.label(sentence).classes("warning")
        self.check()

    def _heading(self, text: str, path: str) -> None:
        with ui.element("div").classes("title"):
            heading(text)
            if path:
                self._remove(path, text)

    def _inside(self, table: Group | Rows) -> None:
        """What a table or a list holds."""
        if isinstance(table, Rows):
            for row in table.rows:
                with ui.element("div").classes("layer"):
                    with ui.element("div").classes("head"):
                        ui.label(row.label)
                        self._remove(row.path, row.label)
                    self._inside(row)
            add = plain(
                f"add to {table.label.lower()}", lambda: self.again(self.form.with_row(table.path, self._folder))
            )
            marks_change(add)
            return
        if table.path == "pavement":
            self._road = RoadDrawing()
        self._parts(table.parts)
        if table.path == "tire.profile":
            self._section = TreadSection()
        files = [path for path in FILES if table.path.endswith(path.rpartition(".")[0])]
        if files and not table.is_inline:
            with ui.element("div").classes("line after"):
                for path in files:
                    text, suffixes = FILES[path]
                    self.upload(text, suffixes, self._takes_file(f"{table.path}.{path.rpartition('.')[2]}"))
        self._more(table.path, table.rest)

    def _parts(self, parts: Iterable[Part]) -> None:
        grid: Any = None
        for part in parts:
            framed = isinstance(part, Rows) or (isinstance(part, Group) and not part.is_inline)
            if grid is None or framed:
                grid = None if framed else ui.element("div").classes("fields")
            if isinstance(part, Group) and part.is_inline:
                self._inside(part)
                grid = None
            elif isinstance(part, Group | Rows):
                with ui.element("div").classes("table"):
                    with ui.element("div").classes("head"):
                        with ui.label(part.label):
                            if part.words:
                                ui.tooltip(part.words)
                        if part.can_go:
                            self._remove(part.path, part.label)
                    self._inside(part)
            else:
                with grid:
                    self._leaf(part)

    def _leaf(self, part: Field | Choosing | Absent) -> None:
        if isinstance(part, Choosing):
            self._choosing(part)
        elif isinstance(part, Absent):
            add = plain(
                f"add {part.label.lower()}", lambda: self.again(self.form.with_added(part.path, self._folder))
            )
            marks_change(add).tooltip(part.words)
        else:
            self.field(part)

    def _more(self, path: str, rest: Sequence[Part]) -> None:
        """Keys that the table does not give, put on the page when they are asked for."""
        if not rest:
            return
        place = ui.element("div")

        def show() -> None:
            self._open ^= {path}
            place.clear()
            with place:
                self._rest(path, rest, show)
            self.check()

        with place:
            self._rest(path, rest, show)

    def _rest(self, path: str, rest: Sequence[Part], show: Callable[[], None]) -> None:
        is_open = path in self._open
        if is_open:
            self._parts(rest)
        name = path or "the case"
        button = plain("fewer" if is_open else f"{len(rest)} more …", show, label=f"other keys of {name}")
        with_attributes(button, aria_expanded="true" if is_open else "false", data_more=path).classes("quiet")

    def _remove(self, path: str, label: str) -> None:
        remove = plain("remove", lambda: self.again(self.form.without(path, self._folder)), label=f"remove {label}")
        marks_change(with_attributes(remove, data_remove=path).classes("quiet"))

    def _choosing(self, part: Choosing) -> None:
        options = dict(part.options)
        if part.chosen not in options:
            options[part.chosen] = "as it stands" if part.chosen or self.form.value(part.path) is not None else ""
        select = choosing(options, part.chosen, part.label, lambda name: self._chosen(part, name))
        with_attributes(select, data_choice=part.path)
        if part.words:
            select.tooltip(part.words)

    def _chosen(self, part: Choosing, name: str) -> None:
        if not name:
            self.again(self.form.without(part.path, self._folder))
            return
        path = f"{part.path}.{name}" if part.is_key else part.path
        ending = next((ending for ending in FILES if path.endswith(ending)), "")
        form = self.form.with_added(path, self._folder, shape="" if part.is_key else name)
        if ending and form.check(self._folder).case is None:
            self.show_problem(f"choose the file below: “{FILES[ending][0]}”")
            self._all()
            return
        self.again(form)

    def _takes_file(self, path: str) -> Callable[[str], object]:
        return lambda name: self._file_came(path, name)

    def _file_came(self, path: str, name: str) -> None:
        """A file takes the place of the value of a key, until solving finds that it cannot be used."""
        shown = self.session.known_as(name)
        before = {text: kept for text, kept in self.session.files.items() if kept != name}
        if self.session.replaced.get(name):
            before[shown] = self.session.replaced[name]
        form = self.form.with_added(path, self._folder, name)
        wrong = form.check(self._folder).wrong
        if wrong and self.form.check(self._folder).case is not None:
            self._put_back(before)
            self.show_problem(f"{shown}: {'; '.join(wrong.values())}")
            return
        self._before_upload = (self.form, before)
        self.again(form)

    def _put_back(self, files: dict[str, str]) -> None:
        self.session.files.clear()
        self.session.files.update(files)

    def upload_solved(self) -> None:
        """The file that came last is in force."""
        self._before_upload = None

    def upload_failed(self) -> bool:
        """Bring back the form and the file of before an upload; False where there was none."""
        if self._before_upload is None:
            return False
        (form, files), self._before_upload = self._before_upload, None
        self._put_back(files)
        self.take(form)
        return True

    @property
    def _folder(self) -> Path:
        return self.session.folder

    def again(self, form: Form) -> None:
        """The form has other fields than before."""
        self.take(form)
        self._solve()

    def _solve(self) -> None:
        if self.form.check(self._folder).case is not None:
            self._changed(self.form)

    def take(self, form: Form) -> None:
        """Show another form, of a run or a file."""
        self.session.forms[self._room] = form
        self._all()

    def check(self) -> None:
        """Check the form, and show at each field whose its value is and what is wrong with it."""
        self._checked = self.form.check(self._folder)
        placed, elsewhere = self._at_fields(self._checked.wrong)
        for path, (field, element) in self._shown.items():
            otherwise = self.form.default_of(field, self._checked.case)
            is_given = self.form.value(path) is not None
            # What a road of yours leaves out is no value of yours.
            is_yours = is_given and self.form.is_yours(path)
            hint = "yours" if is_yours else "default" if is_given or not otherwise else f"default: {otherwise}"
            with_attributes(element, hint=hint)
            element.classes(add="is-yours" if is_yours else "", remove="" if is_yours else "is-yours")
            mark_error(element, placed.get(path, ""))
        self._problems.clear()
        with self._problems:
            for text in elsewhere:
                ui.label(text).classes("problem")
        self._has_problem = False
        if self._section is not None:
            self._section.draw(self.form)
        if self._road is not None:
            self._road.draw(self._checked.case)
        self.when_checked()

    def show_problem(self, text: str) -> None:
        """Show what is wrong: at the field that the sentence names, else above all fields."""
        text = self.session.in_words(text)
        placed, _ = self._at_fields({"": text})
        for path, sentence in placed.items():
            mark_error(self._shown[path][1], sentence)
            self._has_problem = True
        if not placed:
            super().show_problem(text)

    def _at_fields(self, wrong: Mapping[str, str]) -> tuple[dict[str, str], list[str]]:
        """Sentences at the fields on the page and elsewhere, see `at_fields`."""
        fields = {path: field for path, (field, _) in self._shown.items()}
        return at_fields(wrong, fields, {path: self.form.value(path) for path in fields})

    def clear_problem(self) -> None:
        """The problem is over; what is wrong with the fields of now is not."""
        if self._has_problem:
            self.check()

    def field(self, field: Field) -> None:
        """Put a field on the page."""
        value = self._shown_text(field.shown(self.form.value(field.path)))
        element: Any
        if field.kind == "flag":
            element = ui.switch(field.label, value=(value or field.otherwise) == "yes")
            element.on_value_change(lambda event: self._typed(field, "yes" if event.value else "no"))
            marks_change(with_attributes(element, data_path=field.path), "update:model-value")
            element.props("dense").classes("switch")
            if field.words:
                element.tooltip(field.words)
            return
        if field.choices is not None:
            options = dict(field.choices)
            if value not in options:
                options[value] = value
            element = ui.select(options, value=value, label=field.label)
            element.on_value_change(lambda event: self._typed(field, str(event.value or "")))
            element.props("options-dense")
        else:
            element = ui.input(field.label, value=value)
            with_attributes(element, suffix=field.unit).props('stack-label autocomplete="off"')
            element.on("blur", lambda: self._typed(field, str(element.value or "")))
            element.on("keydown.enter", lambda: self._typed(field, str(element.value or "")))
        marks_change(with_attributes(element, data_path=field.path), "update:model-value").props("dense outlined")
        is_wide = field.kind in (LIST, "text") and len(value) > 14
        element.classes("field wide" if is_wide else "field")
        if field.words:
            element.tooltip(field.words)
        self._shown[field.path] = (field, element)

    def _shown_text(self, text: str) -> str:
        """The name of a file as the user knows it, in place of that under which it is kept."""
        return self.session.known_as(text)

    def _typed(self, field: Field, text: str) -> None:
        text = text.strip()
        if text == self._shown_text(field.shown(self.form.value(field.path))):
            self.when_checked()
            return
        before = self.form.table
        self.session.forms[self._room] = self.form.with_text(field, self.session.files.get(text, text))
        self.check()
        if self.form.table != before:
            self._solve()

    def case_came(self, name: str, content: bytes) -> None:
        """A case of the user's. Raises InputError."""
        try:
            text = content.decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(f"{name} is not a text file in UTF-8") from error
        self.again(Form.from_text(text, name, self.session.files, self.form.command))
