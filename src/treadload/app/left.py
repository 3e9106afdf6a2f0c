"""The form of a wheel on a road, on the left of the bench."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from treadload.app import fields as keys
from treadload.app.elements import choosing, heading, plain
from treadload.app.form import Form
from treadload.app.groups import CaseFields
from treadload.app.session import FOOTPRINTS, Session


class Left(CaseFields):
    """Tire, wheel, road, grid and verdict."""

    def __init__(self, session: Session, changed: Callable[[Form], Any], opened: Callable[[str, str], Any]) -> None:
        super().__init__(session, "bench", changed, opened)

    def groups(self) -> None:
        """From the tire to the verdict."""
        self.tire()
        self._rolling()
        self.road()
        self._grid()
        self._own_file()

    def more_files(self) -> None:
        """A measured footprint, beside those of the tire."""
        self.upload("footprint …", FOOTPRINTS, self._footprint, "footprint")

    def _rolling(self) -> None:
        form = self.form
        heading("Wheel")
        with ui.element("div").classes("fields"):
            self.field(keys.LOAD)
            self.field(keys.FRICTION)
            self.field(keys.SPEED)
            choosing(dict(keys.STATES), form.state, "It",
                     lambda state: self.again(self.form.with_state(state, by_force=self.form.by_force))
                     ).classes(remove="wide")  # fmt: skip
            if form.state != "free":
                choosing({"force": "by force", "creepage": "by creepage"}, "force" if form.by_force else "creepage",
                         "Prescribed", lambda by: self.again(form.with_state(form.state, by_force=by == "force"))
                         ).classes(remove="wide")  # fmt: skip
                for field in keys.rolling_fields(form.state, by_force=form.by_force):
                    self.field(field)

    def _grid(self) -> None:
        heading("Grid and verdict")
        with ui.element("div").classes("fields"):
            self.field(keys.SPACING)
            self.field(keys.TOLERANCE)
            self.field(keys.DEPTHS, wide=True)
            if self.form.value("damage") is not None:
                self.field(keys.EPSILON)
                self.field(keys.SLOPE)
                self.field(keys.STRAIN, wide=True)
        if self.form.value("damage") is None:
            plain(
                "add a verdict", lambda: self.again(self.form.with_values({"damage": Form.first().table["damage"]}))
            )
        else:
            plain("no verdict", lambda: self.again(self.form.with_values({"damage": None})))

    def _own_file(self) -> None:
        heading("Your case")
        with ui.element("div").classes("line"):
            self.upload("open a TOML …", (".toml",), None, "toml")
            self.upload("open a result …", (".nc",), lambda kept: self._opened("result", kept), "result")
            plain("begin anew", lambda: self.again(Form.first()))

    def _footprint(self, kept: str) -> Any:
        return self._opened("footprint", kept)
