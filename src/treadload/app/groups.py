"""The groups of fields that all cases with a tire on a road have."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from nicegui import ui

from treadload.app import fields as keys
from treadload.app.elements import choosing, heading, plain
from treadload.app.fielding import Fields
from treadload.app.fields import Field
from treadload.app.figures import Place
from treadload.app.form import profile_of
from treadload.app.session import MAPS, MESHES


class CaseFields(Fields):
    """Tire and road."""

    _section: Any = None

    def told(self) -> None:
        """The cross-section of a profile, live."""
        self._draw_section()

    def tire(self) -> None:
        """What rolls."""
        form = self.form
        heading("Tire").style("margin-top:4px")
        with ui.element("div").classes("fields"):
            choosing(dict(keys.SURFACES), form.surface, "Surface", self._surface)
            if form.surface in ("scan", "height_map"):
                file = form.value("tire.scan") or form.value("tire.height_map")
                ui.label(f"file: {self.session.known_as(str(file))}").classes("wide note")
            for field in self.tire_fields():
                self.field(field, wide=field.kind == "choice")
            self.field(keys.BELT)
        if form.surface == "profile":
            self._section = Place("section-of-tread", "cross-section of the tread")
            grooves = form.value("tire.profile.grooves") or []
            for number, row in enumerate(keys.groove_fields(len(grooves))):
                with ui.element("div").classes("layer"):
                    with ui.element("div").classes("head"):
                        ui.label(f"groove {number + 1}")
                        plain("remove", lambda n=number: self._grooves([g for k, g in enumerate(grooves) if k != n]))
                    with ui.element("div").classes("fields").style("grid-template-columns:1fr 1fr 1fr"):
                        for field in row:
                            self.field(field)
            plain(
                "add a groove",
                lambda: self._grooves([*grooves, {"centre": "0 mm", "width": "10 mm", "depth": "12 mm"}]),
            )
        else:
            self._section = None
        with ui.element("div").classes("line").style("margin-top:6px"):
            self.upload("mesh …", MESHES, lambda kept: self.again(self.form.with_surface("scan", kept)), "mesh")
            self.upload(
                "height map …", MAPS, lambda kept: self.again(self.form.with_surface("height_map", kept)), "map"
            )
            self.more_files()

    def more_files(self) -> None:
        """Files that belong to the tire of this page alone."""

    def tire_fields(self) -> Iterable[Field]:
        """Fields of the tire."""
        return keys.tire_fields(self.form.surface, has_belt=self.form.value("tire.belt") is not None)

    def _grooves(self, grooves: list[Any]) -> None:
        self.again(self.form.with_values({"tire.profile.grooves": grooves}))

    def _surface(self, surface: str) -> None:
        if surface in ("scan", "height_map"):
            self.say("choose the file below: “mesh …” or “height map …”")
            self.refresh()
            return
        self.again(self.form.with_surface(surface))

    def _draw_section(self) -> None:
        """The cross-section of a profile, live."""
        profile = profile_of(self.form)
        if self._section is None or profile is None:
            return
        half = 0.5 * profile.width
        places = [half * (number / 120 - 1) for number in range(241)]
        drop = profile.drop(places)  # type: ignore[arg-type]
        axis = {"showgrid": False, "zeroline": False, "ticks": "outside", "tickfont": {"size": 10}}
        figure = {
            "data": [{"type": "scatter", "mode": "lines", "x": [1e3 * y for y in places], "hoverinfo": "skip",
                      "y": [-1e3 * float(one) for one in drop], "line": {"color": "#8a94a0", "width": 2}}],
            "layout": {"height": 120, "margin": {"l": 34, "r": 6, "t": 6, "b": 30},
                       "font": {"size": 10, "color": "#8a94a0"},
                       "paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)",
                       "xaxis": {**axis, "title": {"text": "y (mm)", "standoff": 2}},
                       "yaxis": {**axis, "title": {"text": "mm"}}},
        }  # fmt: skip
        self._section.draw(json.dumps(figure))

    def road(self) -> None:
        """What it rolls on."""
        form = self.form
        heading("Road")
        with ui.element("div").classes("fields"):
            choosing(dict(keys.ROADS), form.road, "Road", lambda kind: self.again(self.form.with_road(kind)))
            if form.road == "structure":
                self.field(keys.STRUCTURE, wide=True)
        layers = form.layers
        mixes = any(isinstance(layer, dict) and "mix" in layer for layer in layers)
        if form.road == "half_space":
            with ui.element("div").classes("fields"):
                for field in keys.layer_fields(0, mix=mixes, last=True):
                    self.field(field)
        elif form.road == "layers":
            for number, layer in enumerate(layers):
                self._layer(number, layer, len(layers))
            plain("add a layer", lambda: self._add_layer())
        if mixes or form.road == "structure" or form.value("pavement.temperature") is not None:
            with ui.element("div").classes("fields").style("margin-top:6px"):
                if form.road_temperature:
                    self.field(keys.TEMPERATURE)
                self.field(keys.FREQUENCY)

    def _layer(self, number: int, layer: Any, count: int) -> None:
        last = number == count - 1
        is_mix = isinstance(layer, dict) and "mix" in layer
        with ui.element("div").classes("layer"):
            with ui.element("div").classes("head"):
                name = layer.get("name") or layer.get("mix") or "" if isinstance(layer, dict) else ""
                ui.label(f"{number + 1}  {name}{', endlessly deep' if last else ''}")
                with ui.element("div").classes("line"):
                    plain("as modulus" if is_mix else "as mix", lambda: self._kind_of_layer(number, not is_mix))
                    if count > 2 and not last:
                        kept = [one for k, one in enumerate(self.form.layers) if k != number]
                        plain(
                            "remove",
                            lambda: self.again(self.form.with_layers(kept)),
                            label=f"remove layer {number + 1}",
                        )
            with ui.element("div").classes("fields"):
                for field in keys.layer_fields(number, mix=is_mix, last=last):
                    self.field(field)

    def _kind_of_layer(self, number: int, mix: bool) -> None:
        layers = [dict(one) for one in self.form.layers]
        layer = {key: value for key, value in layers[number].items() if key in ("thickness", "bond")}
        own = (
            {"mix": "EB-BBSG3"} if mix else {"material": {"kind": "elastic", "modulus": "5400 MPa", "poisson": 0.35}}
        )
        layers[number] = {**layer, **own}
        form = self.form.with_layers(layers)
        waits = form.road_temperature and any("mix" in one for one in layers)
        self.again(form.with_values({"pavement.temperature": 15 if waits else None}))

    def _add_layer(self) -> None:
        layers = list(self.form.layers)
        layer = {
            "name": "layer",
            "thickness": "100 mm",
            "material": {"kind": "elastic", "modulus": "9000 MPa", "poisson": 0.35},
        }
        self.again(self.form.with_layers([*layers[:-1], layer, layers[-1]]))
