"""What a table of a case can be one of: materials, bonds, friction, maneuvers, criteria."""

from __future__ import annotations

from typing import Annotated, Any

from treadload.contact import Maneuver
from treadload.materials import Anisotropic, Elastic, Prony
from treadload.materials.kinds import Surfaced
from treadload.materials.tables import ROAD_MATERIAL
from treadload.read import Choice
from treadload.registry import BONDS, FRICTION, MANEUVERS, MATERIALS, PLASTICITY
from treadload.units import Share

TIRE_MATERIAL = Choice(MATERIALS, "material of a tire", only=(Elastic, Anisotropic, Prony, Surfaced))
STONE = Choice(MATERIALS, "material of stones and mortar", only=(Elastic,))
BOND = Choice(BONDS, "bond")
PLASTIC = Choice(PLASTICITY)
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
PlasticTable = Annotated[Any, PLASTIC]
Friction = Annotated[Any, FRICTION_OR_NUMBER]
ManeuverTable = Annotated[Any, MANEUVER]


def maneuver_of(table: object) -> tuple[Maneuver, str, float | None]:
    """A maneuver, its name for tables, and its share of the class's passes if it gives one."""
    maneuver: Maneuver = MANEUVER.build(table)
    return maneuver, getattr(table, "name", None) or maneuver.name, getattr(table, "share", None)
