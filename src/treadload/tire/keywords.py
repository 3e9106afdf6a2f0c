"""What the makers of a tire take by keyword, and the materials and treads that it can have."""

from __future__ import annotations

from typing import Literal, TypedDict

from treadload.materials import Anisotropic, Elastic, Prony
from treadload.materials.kinds import Surfaced
from treadload.tire.belt import Belt

Tread = Literal["layer", "ribs"]
TireMaterial = Elastic | Anisotropic | Prony | Surfaced
# Why there is no tread = "blocks".
BLOCKS_ROLL = (
    "blocks follow from lateral grooves, of the profile, of a scan or given, and do not roll steadily: leave tread "
    "out and solve the passage of a pitch, with the table [pitch] of a case or solve_pitch(...)"
)


class BodyKeys(TypedDict, total=False):
    """Of a tire, beside its surface: keywords of all that make one, see `Tire`."""

    material: TireMaterial | None
    inflation_pressure: float | None
    name: str
    belt: Belt | None
    tread: Tread
    undertread: float | None


class ScanKeys(BodyKeys, total=False):
    """Of a tire whose surface is a scan: keywords of `Tire.from_scan`, which explains them."""

    units: str | None
    nominal_diameter: float | None
    rotation: float
    camber: float
    revolve: bool | Literal["auto"]
    fill_holes: bool | Literal["auto"]
    smooth: Literal[False, "auto"] | float
    outliers: Literal["remove", "refuse", "keep"]
    roundness: float
    scale: float | None
