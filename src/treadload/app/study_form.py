"""The part of the page of a study that starts one: a case, the inputs that vary, and their values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from nicegui import ui

from treadload.app.answers import MOST_CASES
from treadload.app.elements import choosing, heading, mark_error, plain, with_attributes
from treadload.app.form import Form
from treadload.app.form_field import FREE, NUMBER, Field
from treadload.app.form_parts import parts_in
from treadload.app.run_names import name_of_key
from treadload.app.session import Session
from treadload.errors import InputError
from treadload.units import quantity

# Cases to start from, by the page whose form they are; inputs of one study; values that an input begins with.
_PAGES = {"/": "case of the bench", "/life": "case of the life page"}
_MOST_INPUTS, _COUNT = 3, "5"
# What is offered first.
_FIRST = ("rolling.normal_load", "traffic.passes_per_year")


@dataclass(frozen=True)
class _Input:
    """The fields of one input on the page."""

    key: Any
    low: Any
    high: Any
    count: Any


class StudyForm:
    """Which case is varied, and how."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._page = "/"
        self._inputs: list[_Input] = []

    @property
    def form(self) -> Form:
        """The case that is varied: that of its page, as it stands there."""
        return self._session.forms.get(self._page) or Form.first(self._page.strip("/") or "run")

    def build(self) -> None:
        """Put the fields on the page."""
        heading("Start a study")
        choosing(_PAGES, self._page, "vary the", self._chosen)
        self._rows = ui.element("div").props('id="inputs"')
        with ui.element("div").classes("line"):
            plain("add an input", self._add).props('id="add-input"')
        self._size = ui.label("").classes("note").props('id="study-size"')
        self._add()

    def _chosen(self, page: str) -> None:
        self._page = page
        self._rows.clear()
        self._inputs.clear()
        self._add()

    def _fields(self) -> dict[str, Field]:
        """Numbers of the case that can vary, by their paths."""
        form = self.form
        whole = form.parts(self._session.folder)
        fields = (part for part in parts_in(whole) if isinstance(part, Field) and part.kind in (NUMBER, FREE))
        return {field.path: field for field in fields if self._number(field) is not None}

    def _number(self, field: Field) -> float | None:
        """The value of a field, in its unit."""
        try:
            return float(field.shown(self.form.value(field.path)))
        except ValueError:
            return None

    def _add(self) -> None:
        if len(self._inputs) >= _MOST_INPUTS:
            return
        fields = self._fields()
        taken = {line.key.value for line in self._inputs}
        preferred = [path for path in (*_FIRST, *fields) if path in fields and path not in taken]
        if not preferred:
            return
        options = {
            path: f"{name_of_key(path, self.form.table)}{f', {field.unit}' if field.unit else ''}"
            for path, field in fields.items()
        }
        with self._rows, ui.element("div").classes("layer"):
            key = ui.select(options, value=preferred[0], label="input", with_input=True)
            with_attributes(key, data_input=str(len(self._inputs))).props("dense outlined options-dense")
            with ui.element("div").classes("fields three"):
                low, high, count = (
                    with_attributes(ui.input(words), data_of=f"{words} {len(self._inputs)}").props(
                        'dense outlined stack-label autocomplete="off"'
                    ).classes("field")
                    for words in ("from", "to", "values")
                )  # fmt: skip
        line = _Input(key, low, high, count)
        self._inputs.append(line)
        self._begin(line)
        key.on_value_change(lambda: self._begin(line))
        for element in (low, high, count):
            element.on_value_change(self._sized)
        self._sized()

    def _begin(self, line: _Input) -> None:
        """A range around the value that the case has."""
        field = self._fields().get(str(line.key.value))
        value = None if field is None else self._number(field)
        if field is None or value is None:
            return
        for element, share in ((line.low, 0.8), (line.high, 1.2)):
            with_attributes(element, suffix=field.unit)
            element.set_value(f"{value * share:.6g}" if value else ("0" if share < 1 else "1"))
        line.count.set_value(line.count.value or _COUNT)

    def _sized(self) -> None:
        counts = [str(line.count.value or "") for line in self._inputs]
        if all(text.isascii() and text.isdigit() for text in counts):
            number = math.prod(int(text) for text in counts)
            self._size.text = f"{number} cases, of at most {MOST_CASES}"

    def varied(self) -> list[str] | None:
        """What varies, "key=low:high:count" each; None where a field is wrong, which it then states."""
        fields, keys = self._fields(), [str(line.key.value) for line in self._inputs]
        texts: list[str] = []
        is_right = True
        for number, line in enumerate(self._inputs):
            field = fields.get(keys[number])
            wrong = "choose an input" if field is None else ""
            wrong = wrong or ("this input varies already" if keys[number] in keys[:number] else "")
            mark_error(line.key, wrong)
            ends = []
            for element in (line.low, line.high):
                text = str(element.value or "").strip()
                try:
                    value = None if field is None else field.read(text)
                    if value is None:
                        raise InputError("give a number")
                    assert field is not None
                    ends.append((quantity(value, field.si), str(value)))
                    mark_error(element, "")
                except (InputError, ValueError) as error:
                    mark_error(element, str(error))
                    is_right = False
            if len(ends) == 2 and not ends[0][0] < ends[1][0]:
                mark_error(line.high, "must be larger than from")
                is_right = False
            count = str(line.count.value or "").strip()
            is_count = count.isascii() and count.isdigit() and 2 <= int(count) <= MOST_CASES
            mark_error(line.count, "" if is_count else f"2 to {MOST_CASES}")
            is_right = is_right and is_count and not wrong
            if len(ends) == 2:
                texts.append(f"{keys[number]}={ends[0][1]}:{ends[1][1]}:{count}")
        return texts if is_right and texts else None
