"""The form of a road's life, on the left of its page."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from nicegui import ui

from treadload.app import fields as keys
from treadload.app import life_form as own
from treadload.app import maneuvers
from treadload.app.elements import choosing, heading, plain, with_attributes
from treadload.app.fields import Field
from treadload.app.form import Form
from treadload.app.groups import CaseFields
from treadload.app.life_form import LifeForm
from treadload.app.session import Session
from treadload.case import LifeCase

_WEATHER = (".csv", ".epw")


class LifeLeft(CaseFields):
    """Traffic, climate, criteria, and the tire and the road they meet."""

    def __init__(self, session: Session, changed: Callable[[Form], Any], opened: Callable[[str, str], Any]) -> None:
        super().__init__(session, "life", changed, opened)

    @property
    def life(self) -> LifeForm:
        """The form."""
        form = self.form
        assert isinstance(form, LifeForm)
        return form

    def tire_fields(self) -> Iterable[Field]:
        """Fields of the tire; its pressure is that of each class of axles."""
        return (one for one in super().tire_fields() if one.path != "tire.inflation_pressure")

    def groups(self) -> None:
        """From the traffic to the grid."""
        self._traffic()
        self._climate()
        self._criteria()
        self.road()
        self.tire()
        self._grid()

    def _traffic(self) -> None:
        heading("Traffic").style("margin-top:4px")
        with ui.element("div").classes("fields"):
            for field in own.PASSES:
                self.field(field)
        for number, row in enumerate(self.life.rows("traffic.classes")):
            self._row("traffic.classes", number, row, own.class_fields(number, row), moves=True)
        plain("add axles", lambda: self.again(self.life.with_more("traffic.classes")), label="add a class of axles")

    def _climate(self) -> None:
        heading("Climate")
        kind = self.life.climate
        with ui.element("div").classes("fields"):
            choosing(dict(own.CLIMATES), kind, "Given as", self._kind_of_climate)
            if kind == "file":
                ui.label(f"file: {self.session.known_as(str(self.form.value('climate.file')))}").classes("wide note")
            for field in own.climate_fields(kind, len(self.life.rows("climate.seasons"))):
                self.field(field, wide=field.kind == "list")
        with ui.element("div").classes("line").style("margin-top:6px"):
            self.upload(
                "weather …", _WEATHER, lambda kept: self.again(self.life.with_climate("file", kept)), "weather"
            )

    def _kind_of_climate(self, kind: str) -> None:
        if kind == "file":
            self.say("choose the file below: “weather …”")
            self.refresh()
            return
        self.again(self.life.with_climate(kind))

    def _criteria(self) -> None:
        heading("Criteria")
        case = self.form.check(self.session.folder).case
        layers = (
            [layer.name for layer in case.build_road().layers if layer.name] if isinstance(case, LifeCase) else []
        )
        for number, row in enumerate(self.life.rows("criteria")):
            self._row("criteria", number, row, own.criterion_fields(number, row, layers))
        with ui.element("div").classes("line"):
            plain("add a criterion", lambda: self.again(self.life.with_more("criteria")))
            scatters = self.form.value("reliability") is not None
            held = None if scatters else LifeForm.first().table["reliability"]
            plain("no probabilities" if scatters else "with probabilities",
                  lambda: self.again(self.form.with_values({"reliability": held})))  # fmt: skip
        if scatters:
            with ui.element("div").classes("fields").style("margin-top:6px"):
                for field in own.RELIABILITY:
                    self.field(field)

    def _row(self, path: str, number: int, row: Any, fields: Iterable[Field], *, moves: bool = False) -> None:
        with ui.element("div").classes("layer"):
            name = str(row.get("name", "")) if isinstance(row, dict) else ""
            with ui.element("div").classes("head"):
                ui.label(name)
                if len(self.life.rows(path)) > 1:
                    plain("remove", lambda: self.again(self.life.without(path, number)), label=f"remove {name}")
            with ui.element("div").classes("fields"):
                for field in fields:
                    self.field(field, wide=field.path.endswith((".name", ".law")))
            if moves:
                self._moves(number, row, name)

    def _moves(self, number: int, row: Any, name: str) -> None:
        """What the wheels of a class do."""
        path = f"traffic.classes.{number}"
        held = maneuvers.several(row)
        for which, told in enumerate(held or [self.form.value(f"{path}.maneuver")]):
            one, here = (which, f"{path}.maneuvers.{which}") if held else (None, f"{path}.maneuver")
            with ui.element("div").classes("fields"):
                rolls = choosing(
                    maneuvers.choices_of(told), maneuvers.kind_of(told), "Rolls", self._chosen(number, one)
                )
                with_attributes(rolls, data_move=f"{number}.{which}").classes(remove="wide")
                for field in maneuvers.maneuver_fields(here, told):
                    self.field(field)
            if held:
                with ui.element("div").classes("line after"):
                    plain("remove", lambda which=which: self.again(maneuvers.without_one(self.life, number, which)),
                          label=f"remove maneuver {which + 1} of {name}")  # fmt: skip
        with ui.element("div").classes("line after"):
            plain("does something else, too", lambda: self.again(maneuvers.with_another(self.life, number)),
                  label=f"another maneuver of {name}")  # fmt: skip

    def _chosen(self, number: int, which: int | None) -> Callable[[str], Any]:
        return lambda kind: self.again(maneuvers.with_kind(self.life, number, kind, which))

    def _grid(self) -> None:
        heading("Grid")
        with ui.element("div").classes("fields"):
            self.field(keys.SPACING)
            self.field(keys.TOLERANCE)
        heading("Your case")
        with ui.element("div").classes("line"):
            self.upload("open a TOML …", (".toml",), None, "toml")
            plain("begin anew", lambda: self.again(LifeForm.first()))
