"""What a table of a case can be one of: materials, bonds, friction, maneuvers, criteria."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any

from treadload.contact import Maneuver
from treadload.materials import Elastic, Material, Prony, TemperatureDependent, Thermorheological
from treadload.read import Choice, Made, made_by
from treadload.registry import BONDS, FRICTION, MANEUVERS, MATERIALS, SHIFTS
from treadload.units import Celsius, Share


def _tested(law: Any, table: Made, folder: Path) -> tuple[Any, tuple[float, float] | None]:
    """A law of shift, and the temperatures of the tests behind it, °C."""
    return law, getattr(table, "tested", None)


SHIFT = Choice(
    SHIFTS,
    "shift",
    more=lambda _: {"tested": tuple[Celsius, Celsius]},
    finish=_tested,
    about="tested: lowest and highest temperature of the tests behind it.",
)


def _shift_of(target: Callable[..., Any]) -> Mapping[str, Any]:
    """Times of a viscoelastic material may shift with temperature."""
    viscoelastic = any(hasattr(one, "complex_modulus") for one in made_by(target) if isinstance(one, type))
    # A protocol stands for a material of which the maker knows more.
    concrete = not any(getattr(one, "_is_protocol", False) for one in made_by(target))
    return {"shift": Annotated[Any, SHIFT]} if viscoelastic and concrete else {}


def _shifted(material: Any, table: Made, folder: Path) -> Material | TemperatureDependent:
    """The material, or one that waits for its temperature."""
    shift = getattr(table, "shift", None)
    made: Material | TemperatureDependent = material
    return made if shift is None else Thermorheological(material, *SHIFT.build(shift, folder))


ROAD_MATERIAL = Choice(
    MATERIALS,
    "material of a road",
    more=_shift_of,
    finish=_shifted,
    about="shift: how its times depend on temperature; without it the material is the same at all.",
)
TIRE_MATERIAL = Choice(MATERIALS, "material of a tire", only=(Elastic, Prony))
BOND = Choice(BONDS, "bond")
# A number, or the table of a law.
FRICTION_OR_NUMBER = Choice(FRICTION, keeps_number=True)
MANEUVER = Choice(
    MANEUVERS,
    "maneuver",
    more=lambda _: {"name": str, "share": Share},
    about="name: for tables. share: of the class's passes, in a list of maneuvers.",
)

RoadMaterial = Annotated[Any, ROAD_MATERIAL]
TireMaterial = Annotated[Any, TIRE_MATERIAL]
BondTable = Annotated[Any, BOND]
Friction = Annotated[Any, FRICTION_OR_NUMBER]
ManeuverTable = Annotated[Any, MANEUVER]


def maneuver_of(table: Any) -> tuple[Maneuver, str, float | None]:
    """A maneuver, its name for tables, and its share of the class's passes if it tells one."""
    made: Maneuver = MANEUVER.build(table)
    return made, getattr(table, "name", None) or made.name, getattr(table, "share", None)
