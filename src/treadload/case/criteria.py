"""Criteria of design in a case: a layer, a law by its name, and what the law's numbers are."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from pydantic import model_validator

from treadload.case.fields import Length, Modulus, Number, Part, Share, Strain
from treadload.damage import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    DesignCriterion,
    FatigueLaw,
    FatigueLine,
    FrenchBituminous,
    FrenchHydraulic,
    FrenchSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
)
from treadload.errors import InputError
from treadload.materials import Elastic, HydraulicMix, Mix, Unbound
from treadload.pavement import Pavement, bituminous_thickness
from treadload.response import MATERIAL_LENGTH


class CriterionPart(Part):
    """`[[criteria]]`: name, law, and the layer that it judges.

    layer: its name, or its number from the surface, 1 the top one; left out, the last one for laws of the subgrade
    and the top one for top-down cracking. place: "top" or "bottom"; left out, "top" for both of these, else "bottom".
    strain: "principal" or "in-plane". mean_over: side of the cube of road that an extension near the surface is a
    mean over; 10 mm if left out. The rest are parameters of the law, see `LAWS`; those left out are taken from the
    layer where it is one of the catalogue: ε₆, slope, SN, k_c and E(θ) of a mix, A and b of a platform.
    thickness: of all asphalt; left out, that of the bituminous layers around the criterion's, added up.
    binder_volume: of the effective binder, a share of the mix's volume.
    """

    name: str
    law: str
    layer: int | str | None = None
    place: Literal["top", "bottom"] | None = None
    strain: Literal["principal", "in-plane"] = "in-plane"
    mean_over: Length = MATERIAL_LENGTH
    epsilon_6: Strain | None = None
    sigma_6: Modulus | None = None
    slope: Number | None = None
    scatter: Number | None = None
    risk: Share | None = None
    calibration: Number | None = None
    joints: Number | None = None
    thickness: Length | None = None
    thickness_scatter: Length | None = None
    platform_modulus: Modulus | None = None
    modulus: Modulus | None = None
    air_voids: Share | None = None
    binder_volume: Share | None = None
    constant: Number | None = None
    traffic: Literal["heavy", "light", "inverted"] | None = None

    @model_validator(mode="after")
    def _known(self) -> CriterionPart:
        if self.law not in LAWS:
            near = difflib.get_close_matches(self.law, LAWS, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(LAWS)}"
            raise ValueError(f"no law {self.law!r}; {hint}")
        known = LAWS[self.law].parameters
        stray = sorted(name for name in self._given() if name not in known)
        if stray:
            raise ValueError(f"{stray[0]} is no parameter of the law {self.law!r}; it takes {', '.join(known)}")
        return self

    def _given(self) -> dict[str, Any]:
        """Parameters of the law that the table gives."""
        own = {"name", "law", "layer", "place", "strain", "mean_over"}
        return {name: value for name, value in dict(self).items() if name not in own and value is not None}

    def build(self, road: Pavement) -> DesignCriterion:
        """The criterion on a road. Raises InputError and ValueError."""
        kind = LAWS[self.law]
        number = self._number(road, kind.layer)
        law = kind.build(self.name, road, number, self._given())
        place = self.place or kind.place
        return DesignCriterion(self.name, law, number, place, self.strain, self.mean_over)

    def _number(self, road: Pavement, usual: int | None) -> int:
        """Number of the layer from 0 at the surface."""
        names = [layer.name for layer in road.layers]
        asked = self.layer
        if asked is None:
            if usual is None:
                raise ValueError(f"{self.name!r}: layer is missing; the road has {_listed(names)}")
            return usual % len(names)
        if isinstance(asked, int):
            if not 1 <= asked <= len(names):
                raise ValueError(f"{self.name!r}: no layer {asked}; the road has {_listed(names)}")
            return asked - 1
        found = [k for k, name in enumerate(names) if asked.casefold() == name.casefold()]
        if len(found) != 1:
            near = difflib.get_close_matches(asked, names, n=1)
            hint = f"did you mean {near[0]!r}? " if near and not found else ""
            many = "several layers have the name" if found else "no layer has the name"
            raise ValueError(f"{self.name!r}: {many} {asked!r}; {hint}the road has {_listed(names)}")
        return found[0]


def _listed(names: list[str]) -> str:
    return ", ".join(f"{number} {name!r}" for number, name in enumerate(names, start=1))


Law = FatigueLaw | Callable[[float], FatigueLaw]
_Build = Callable[[str, Pavement, int, dict[str, Any]], Law]


@dataclass(frozen=True)
class LawOfCase:
    """A law by its name. parameters: keys that it takes. layer: usual one, 0 the top, -1 the last. place: usual."""

    build: _Build
    parameters: tuple[str, ...]
    layer: int | None = None
    place: Literal["top", "bottom"] = "bottom"


def _needed(who: str, given: dict[str, Any], *names: str) -> None:
    missing = [name for name in names if given.get(name) is None]
    if missing:
        raise ValueError(f"{who!r}: {missing[0]} is missing, and the layer does not give it")


def _with(layer: Any, given: dict[str, Any], *names: str) -> dict[str, Any]:
    """Parameters given, and of those named the material's own where none is."""
    return {**{name: getattr(layer, name, None) for name in names}, **given}


def _platform(road: Pavement, number: int) -> float | None:
    """Modulus of the unbound layer of the catalogue below, Pa, if there is one."""
    below = road.layers[number + 1].material if number + 1 < len(road.layers) else None
    return below.modulus if isinstance(below, Unbound) else None


def _asphalt(who: str, road: Pavement, number: int) -> float:
    """Thickness of all asphalt around a layer, m. Raises InputError where it is not known."""
    try:
        return bituminous_thickness(road, number)
    except InputError as error:
        raise InputError(f"{who!r}: {error}") from error


def _bituminous(who: str, road: Pavement, number: int, given: dict[str, Any]) -> Law:
    mix = road.layers[number].material
    told = _with(mix, given, "epsilon_6", "slope", "scatter", "calibration") if isinstance(mix, Mix) else dict(given)
    told.setdefault("platform_modulus", _platform(road, number))
    if "thickness" not in told:
        # Nothing but Sh depends on it.
        known = "thickness_scatter" in told
        told["thickness"] = road.layers[number].thickness if known else _asphalt(who, road, number)
    _needed(who, told, "risk", "epsilon_6", "slope", "scatter", "thickness", "calibration")
    if not isinstance(mix, Mix):
        return FrenchBituminous(**told)
    return lambda temperature: FrenchBituminous(**told, modulus_ratio=mix.modulus_ratio(temperature))


def _hydraulic(who: str, road: Pavement, number: int, given: dict[str, Any]) -> Law:
    own = ("sigma_6", "slope", "scatter", "calibration", "joints", "thickness_scatter")
    mix = road.layers[number].material
    told = _with(mix, given, *own) if isinstance(mix, HydraulicMix) else given
    told = {"platform_modulus": _platform(road, number), **told}
    _needed(who, told, "risk", "sigma_6", "slope", "scatter", "calibration")
    return FrenchHydraulic(**{name: value for name, value in told.items() if value is not None})


def _subgrade(who: str, road: Pavement, number: int, given: dict[str, Any]) -> Law:
    traffic = given.pop("traffic", "heavy")
    soil = road.layers[number].material
    if isinstance(soil, Unbound):
        own = FrenchSubgrade.of(soil, traffic)
        return FrenchSubgrade(given.get("constant", own.constant), given.get("slope", own.slope))
    if "constant" not in given and traffic != "heavy":
        raise ValueError(f"{who!r}: give constant for the traffic {traffic!r}, or a layer of the catalogue")
    return FrenchSubgrade(**given)


def _line(who: str, road: Pavement, number: int, given: dict[str, Any]) -> Law:
    told = _with(road.layers[number].material, given, "epsilon_6", "slope")
    _needed(who, told, "epsilon_6", "slope")
    return FatigueLine(told["epsilon_6"], told["slope"])


def _of_modulus(kind: Callable[..., FatigueLaw], *needed: str) -> _Build:
    """A law that needs the modulus of the asphalt: given, or that of the layer at its temperature."""

    def build(who: str, road: Pavement, number: int, given: dict[str, Any]) -> Law:
        material = road.layers[number].material
        told = dict(given)
        if "thickness" in needed and "thickness" not in told:
            told["thickness"] = _asphalt(who, road, number)
        if "modulus" not in told and isinstance(material, Mix):
            _needed(who, told, *needed)
            return lambda temperature: kind(**told, modulus=material.modulus(temperature))
        if "modulus" not in told and isinstance(material, Elastic):
            told["modulus"] = material.modulus
        _needed(who, told, "modulus", *needed)
        return kind(**told)

    return build


_MEPDG = ("modulus", "thickness", "air_voids", "binder_volume", "calibration")
_VOLUMES = ("thickness", "air_voids", "binder_volume")

LAWS: Mapping[str, LawOfCase] = {
    "french-bituminous": LawOfCase(
        _bituminous,
        (
            "risk", "epsilon_6", "slope", "scatter", "calibration", "thickness", "thickness_scatter",
            "platform_modulus",
        ),
    ),
    "french-hydraulic": LawOfCase(
        _hydraulic,
        (
            "risk", "sigma_6", "slope", "scatter", "calibration", "joints", "thickness_scatter",
            "platform_modulus",
        ),
    ),
    "french-subgrade": LawOfCase(_subgrade, ("constant", "slope", "traffic"), -1, "top"),
    "fatigue-line": LawOfCase(_line, ("epsilon_6", "slope")),
    "mepdg-bottom-up": LawOfCase(_of_modulus(MepdgBottomUp, *_VOLUMES), _MEPDG),
    "mepdg-top-down": LawOfCase(_of_modulus(MepdgTopDown, *_VOLUMES), _MEPDG, 0, "top"),
    "asphalt-institute": LawOfCase(_of_modulus(AsphaltInstitute), ("modulus", "air_voids", "binder_volume")),
    "asphalt-institute-subgrade": LawOfCase(lambda *_: AsphaltInstituteSubgrade(), (), -1, "top"),
    "shell": LawOfCase(_of_modulus(ShellFatigue), ("modulus",)),
}  # fmt: skip
"""Laws that a case can name."""
