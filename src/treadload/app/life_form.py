"""The form of a road's life: traffic, climate and criteria as a TOML file holds them, and their fields."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, ClassVar, Self

from treadload.app.fields import Field
from treadload.app.form import Form
from treadload.case import LifeCase
from treadload.case.climate import ClimatePart
from treadload.case.criteria import CriterionTable
from treadload.case.file import FilePart
from treadload.case.first import first_case
from treadload.case.traffic import GEARS, AxlePart, TrafficPart
from treadload.files import parse_toml
from treadload.read.signature import descriptions
from treadload.registry import CRITERIA

CLIMATES = {
    "months": "twelve months", "temperature": "one temperature", "air": "the air's months", "file": "a weather file",
    "seasons": "seasons of your own",
}  # fmt: skip
"""How the climate is given."""
_TRAFFIC, _AXLE, _CLIMATE = TrafficPart.about(), AxlePart.about(), ClimatePart.about()
_JUDGES = descriptions(CriterionTable.__doc__ or "", ("law", "layer", "place", "risk"))
_NEW_CLASS = {"name": "another axle", "share": 0.0, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
_NEW_CRITERION = {"name": "another criterion", "law": "french-subgrade"}


class LifeForm(Form):
    """Tables of a design case."""

    kind: ClassVar[type[FilePart]] = LifeCase
    solver: ClassVar[str] = "life"
    road_temperature: ClassVar[bool] = False

    @classmethod
    def first(cls) -> Self:
        """Where the page begins: the case that `treadload init life` writes."""
        return cls(parse_toml(first_case("life"), "case"))

    @property
    def climate(self) -> str:
        """One of `CLIMATES`."""
        held = self.table.get("climate", {})
        return next((kind for kind in CLIMATES if kind in held), "months")

    def with_climate(self, kind: str, file: str = "") -> Self:
        """The form with a climate of this kind. file: the kept name of a weather file."""
        made: dict[str, Any] = {
            "months": LifeForm.first().table["climate"],
            "temperature": {"temperature": 15},
            "air": {"air": {"months": [1, 2, 6, 10, 14, 17, 19, 19, 15, 10, 5, 2], "daily_range": "10 K"}},
            "file": {"file": file},
            "seasons": {"seasons": [{"name": "cold", "share": 0.5, "temperature": 5},
                                    {"name": "warm", "share": 0.5, "temperature": 20}]},
        }[kind]  # fmt: skip
        kept = frozenset(one for one in self.yours if not one.startswith("climate"))
        return replace(self, table={**self.table, "climate": copy.deepcopy(made)}, yours=kept | {"climate"})

    def rows(self, path: str) -> list[Any]:
        """Tables of a list of the case: "traffic.classes", "criteria" or "climate.seasons"."""
        held = self.value(path)
        return list(held) if isinstance(held, list) else []

    def with_more(self, path: str) -> Self:
        """The form with one more class or criterion."""
        new = _NEW_CRITERION if path == "criteria" else _NEW_CLASS
        return self.with_values({path: [*self.rows(path), dict(new)]})

    def without(self, path: str, number: int) -> Self:
        """The form without a row of a list."""
        return self.with_values({path: [row for k, row in enumerate(self.rows(path)) if k != number]})


PASSES = (
    Field("traffic.passes_per_year", "Passes a year", words=_TRAFFIC["passes_per_year"]),
    Field("traffic.growth", "Growth a year", words=_TRAFFIC["growth"]),
    Field("traffic.years", "Design life, years", words=_TRAFFIC["years"], otherwise="none"),
    Field("traffic.wander.deviation", "Wander", "mm", "m", words="standard deviation of wheels across the road",
          otherwise="none"),
)  # fmt: skip
"""How many pass, for how long."""
RELIABILITY = (
    Field("reliability.risks", "Risks", kind="list", words="of failing, whose years are told"),
    Field("reliability.traffic", "Traffic scatters", words="coefficient of variation of the passes", otherwise="0"),
)
"""What scatters."""


def class_fields(number: int, row: Any) -> Iterator[Field]:
    """Fields of a class of axles."""
    before = f"traffic.classes.{number}"
    yield Field(f"{before}.name", "Name", kind="text", words=_AXLE["name"])
    yield Field(f"{before}.share", "Share", words=_AXLE["share"])
    if isinstance(row, dict) and "wheel_load" in row:
        yield Field(f"{before}.wheel_load", "Wheel load", "kN", "N", words=_AXLE["wheel_load"])
    else:
        yield Field(f"{before}.axle_load", "Axle load", "kN", "N", words=_AXLE["axle_load"])
    yield Field(f"{before}.inflation_pressure", "Inflation", "bar", "Pa", words=_AXLE["inflation_pressure"])
    if not (isinstance(row, dict) and "wheels" in row):
        yield Field(
            f"{before}.gear", "Gear", kind="choice", words=_AXLE["gear"], choices={name: name for name in GEARS}
        )
    yield Field(f"{before}.speed", "Speed", "km/h", "m/s", words=_AXLE["speed"], otherwise="none")


def climate_fields(kind: str, seasons: int) -> Iterator[Field]:
    """Fields of a climate. seasons: how many it has of its own."""
    if kind == "temperature":
        yield Field("climate.temperature", "Temperature", "°C", "degC", words=_CLIMATE["temperature"])
    elif kind == "months":
        yield Field("climate.months", "January to December", "°C", "degC", kind="list", words=_CLIMATE["months"])
    elif kind == "air":
        yield Field(
            "climate.air.months", "Air, January to December", "°C", "degC", kind="list", words=_CLIMATE["air"]
        )
        yield Field("climate.air.daily_range", "Daily range", "K", "K", words="from the coldest to the warmest hour")
    elif kind == "seasons":
        for number in range(seasons):
            before = f"climate.seasons.{number}"
            yield Field(f"{before}.name", "Season", kind="text")
            yield Field(f"{before}.share", "Share of passes")
            yield Field(f"{before}.temperature", "Temperature", "°C", "degC")


def criterion_fields(number: int, row: Any, layers: Sequence[str]) -> Iterator[Field]:
    """Fields of a criterion. layers: names of those of the road."""
    before = f"criteria.{number}"
    yield Field(f"{before}.name", "Name", kind="text", words="of tables and figures")
    yield Field(f"{before}.law", "Law", kind="choice", words="whose numbers follow from its layer",
                choices={name: name for name in CRITERIA.names()})  # fmt: skip
    yield Field(f"{before}.layer", "Layer", kind="choice", words=_JUDGES.get("layer", ""),
                choices={"": "by the law", **{name: name for name in layers}})  # fmt: skip
    yield Field(f"{before}.place", "Place", kind="choice", words="of the layer",
                choices={"": "by the law", "top": "top", "bottom": "bottom"})  # fmt: skip
    law = row.get("law") if isinstance(row, dict) else ""
    if str(law).startswith("french"):
        yield Field(f"{before}.risk", "Risk", words="of failing within the design life", otherwise="of its class")
