"""A tire as a tread on an inflated belt: what pressure makes of its stiffness, and the data of known ones."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.kernels.belt import Sheet
from treadload.materials import Elastic, Prony
from treadload.named import Catalogue, read_tables
from treadload.tire.modulus import unlike_a_truck
from treadload.tire.ribs import RibGroup
from treadload.units import BendingStiffness, Length, Number, PerLength, Pressure, Radius, Stiffness, quantity

# Thinner than any worn tread with its undertread, thicker than any new one, m.
_THINNEST, _THICKEST = 1e-3, 1.0
TREAD = Elastic(5.5e6, 0.47)
RUBBER = 0.49
"""Least Poisson's ratio of rubber that keeps its volume; a layer that stands for grooves as well has less."""


@dataclass(frozen=True)
class LateralBelt:
    """The belt as a string that gives way sideways as a whole.

    stiffness: of its lateral foundation, N/m per m of length, > 0. length: over which a deflection fades, m, > 0.
    Under a lateral force the tire shifts by about force / (2 stiffness (length + half the contact length)).
    Source: Pacejka (2012), Tire and Vehicle Dynamics, chapter 5 (stretched string).

    >>> belt = tl.tire.LateralBelt(stiffness=1.5e6, length=0.3)
    >>> f"{10e3 / (2 * belt.stiffness * (belt.length + 0.1)) * 1e3:.1f} mm"  # under 10 kN, contact 200 mm long
    '8.3 mm'
    """

    stiffness: Pressure
    length: Length

    def __post_init__(self) -> None:
        for name, unit in (("stiffness", "N/m per m"), ("length", "m")):
            positive(f"{name} of the lateral belt", getattr(self, name), unit)

    __repr__ = as_call


@dataclass(frozen=True, kw_only=True)
class Belt:
    """A tread layer bonded to a tensioned, bending belt on sidewalls.

    tread: of the layer between the road and the belt, elastic or, for steady rolling, viscoelastic.
    ribs_poisson: Poisson's ratio of ribs and blocks with free sides, where tread has that of a layer, below 0.49;
    left out, that of tread. A layer without grooves has less than rubber, as it stands for ribs that bulge as well.
    tread_thickness: m, ribs and undertread. foundation: what the sidewalls hold against a deflection of the belt, per
    unit of inflation pressure, 1/m; sidewall_stiffness: the part without inflation, Pa/m.
    meridional: tension across per inflation pressure, m: (ρ² - ρ_w²)/(2ρ) of the crown's and the widest radius.
    bending: (D_x, D_xy, D_y), N m, along, of twist, and across. arm: from the surface of the tread to the neutral
    line of the belt, m; shear acts at it. crown_radius: of the tread arc across that inflation has to flatten, m;
    left out, that of the tire's surface. belt_radius: of the belt's own arc across, m, by which its rows roll on
    different radii; left out, none. lateral: sideways motion of the belt as a whole; left out, none.
    name, source: free text. caveats: what is not certain about it, a sentence each.

    Defaults: those of a 315/80R22.5, see `Belt.from_library` for where each comes from.
    Raises InputError when a number is out of bounds, for an arm longer than the tread is thick, and for a belt with
    neither tension nor bending across.

    >>> belt = tl.tire.Belt.from_library("315/80R22.5")
    >>> belt.foundation
    3.6
    """

    tread: Elastic | Prony = TREAD
    tread_thickness: Length = 0.020
    foundation: PerLength = 3.6
    sidewall_stiffness: Stiffness = 0.0
    meridional: Length = 0.098
    bending: tuple[BendingStiffness, BendingStiffness, BendingStiffness] = (80.0, 100.0, 150.0)
    arm: Length = 0.020
    crown_radius: Radius | None = None
    belt_radius: Radius | None = None
    lateral: LateralBelt | None = None
    ribs_poisson: Number | None = None
    name: str = ""
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "bending", tuple(float(value) for value in self.bending))
        object.__setattr__(self, "caveats", tuple(self.caveats))
        if not isinstance(self.tread, Elastic | Prony):
            raise InputError(f"belt: the tread must be an Elastic or a Prony, got {self.tread!r}")
        if self.ribs_poisson is not None and not RUBBER <= self.ribs_poisson < 0.5:
            raise InputError(
                f"belt: ribs_poisson must be at least {RUBBER:g} and below 0.5, as of rubber, got "
                f"{self.ribs_poisson:g}"
            )
        if not _THINNEST <= self.tread_thickness <= _THICKEST:
            raise InputError(
                f"belt: tread_thickness must lie between {_THINNEST * 1e3:g} mm and {_THICKEST:g} m, got "
                f"{self.tread_thickness:g} m; lengths are in metres"
            )
        for name, unit in (("foundation", "1/m"), ("sidewall_stiffness", "Pa/m"), ("meridional", "m"), ("arm", "m")):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise InputError(f"belt: {name} must be a number of {unit} and not negative, got {value:g}")
        if self.foundation == 0 and self.sidewall_stiffness == 0:
            raise InputError("belt: nothing holds it; give foundation (1/m) or sidewall_stiffness (Pa/m) above 0")
        if len(self.bending) != 3 or not all(math.isfinite(value) and value >= 0 for value in self.bending):
            raise InputError(
                f"belt: bending must be three stiffnesses in N m, along, of twist and across, ≥ 0, got {self.bending}"
            )
        if self.arm > self.tread_thickness:
            raise InputError(
                f"belt: the arm of {self.arm * 1e3:g} mm is longer than the tread is thick, "
                f"{self.tread_thickness * 1e3:g} mm; it reaches from the surface of the tread to the neutral line of "
                "the belt, and the tread's thickness is counted down to that"
            )
        if self.arm > 0 and not (self.bending[0] > 0 and self.bending[2] > 0):
            raise InputError(
                "belt: with an arm it needs bending stiffness along and across; one that bends freely turns without "
                "limit under the edge of a load. Give bending such as (80, 100, 150) N m, or arm = 0"
            )
        if self.meridional == 0 and self.bending[2] == 0:
            raise InputError(
                "belt: neither tension nor bending across; its rows would not be coupled. Give meridional, "
                "about 0.1 m for a truck tire, or bending across"
            )
        for name in ("crown_radius", "belt_radius"):
            if getattr(self, name) is not None:
                positive(f"{name} of the belt", getattr(self, name), "m")

    @classmethod
    def from_library(cls, name: str) -> Belt:
        """The belt of this name in the catalogue, e.g. "315/80R22.5". Raises InputError when it is not there."""
        return belts[name]

    def under_ribs(self) -> Belt:
        """The belt whose tread has the Poisson's ratio of ribs and blocks, where it has that of a layer.

        >>> Belt.from_library("315/80R22.5").under_ribs().tread
        Elastic(modulus=5.5e6, poisson=0.495)
        """
        if self.ribs_poisson is None:
            return self
        is_layer = self.tread.poisson < RUBBER
        tread = replace(self.tread, poisson=self.ribs_poisson) if is_layer else self.tread
        return replace(self, tread=tread, ribs_poisson=None)

    def worn(self, wear: float | str) -> Belt:
        """The belt below a tread that `wear`, m, has been worn off: thickness and arm are smaller by it.

        Raises InputError for a negative wear, and for one that leaves less than 1 mm of tread.

        >>> belt = Belt(tread_thickness=0.020, arm=0.020).worn("6 mm")
        >>> round(belt.tread_thickness, 9), round(belt.arm, 9)
        (0.014, 0.014)
        """
        depth = quantity(wear, "m")
        if not 0 <= depth <= self.tread_thickness - _THINNEST:
            raise InputError(
                f"wear must be at least 0 and at most {(self.tread_thickness - _THINNEST) * 1e3:g} mm, which leaves "
                f"{_THINNEST * 1e3:g} mm of tread on the belt, got {depth * 1e3:g} mm"
            )
        return replace(self, tread_thickness=self.tread_thickness - depth, arm=max(0.0, self.arm - depth))

    def inflated(
        self, inflation_pressure: float, rolling_radius: float | None, crown_radius: float | None
    ) -> InflatedBelt:
        """The belt under an inflation pressure, Pa, on a tire of these radii, m, along and across; None: unknown.

        Tension: T_y = meridional p, and T_x = R (p - T_y/r_y) by Laplace's law, so that flattening it takes just p.
        An endless crown_radius, inf, is a tread that is flat across.
        Raises InputError where a radius is missing, or where the tension across carries more than the pressure.
        """
        if rolling_radius is None:
            raise InputError(
                "a belt needs the radius of the tire, and this surface does not bend along travel; give a height "
                "map with its curvature, a profile or a scan, or a material in place of the belt"
            )
        across = self.crown_radius if self.crown_radius is not None else crown_radius
        if across is None:
            raise InputError("a belt needs the radius of the tread across: give crown_radius to Belt, in m")
        tension_y = self.meridional * inflation_pressure
        tension_x = rolling_radius * (inflation_pressure - tension_y / across)
        if not tension_x > 0:
            raise InputError(
                f"belt: with a crown radius of {across:g} m and meridional = {self.meridional:g} m, tension across "
                f"carries {self.meridional / across:.3g} times the inflation pressure and leaves none along; "
                f"meridional must be below the crown radius, it is about 0.1 m"
            )
        sheet = Sheet(
            tension_x,
            tension_y,
            (self.bending[0], self.bending[1], self.bending[2]),
            self.foundation * inflation_pressure + self.sidewall_stiffness,
            self.arm,
            2 * math.pi * rolling_radius,
        )
        return InflatedBelt(self, sheet, rolling_radius, across, inflation_pressure)

    def __str__(self) -> str:
        return (
            f"belt {self.name}".rstrip() + f": tread {self.tread_thickness * 1e3:g} mm of {self.tread}, sidewalls "
            f"{self.foundation:g} /m, arm {self.arm * 1e3:g} mm"
        )

    __repr__ = as_call


@dataclass(frozen=True)
class InflatedBelt:
    """A belt under its inflation pressure, on a tire of known radii; see `Belt.inflated`.

    sheet: tensions, bending and foundation. rolling_radius, crown_radius: of the unloaded tread, along and across, m.
    inflation_pressure: Pa. ribs: of the tread; empty for a layer.

    >>> belt = tl.tire.Belt.from_library("315/80R22.5").inflated(820e3, 0.5, 1.0)
    >>> f"{belt.sheet.tension_x / 1e3:.0f} kN/m along, {belt.sheet.tension_y / 1e3:.0f} kN/m across"
    '370 kN/m along, 80 kN/m across'
    """

    belt: Belt
    sheet: Sheet
    rolling_radius: float
    crown_radius: float
    inflation_pressure: float
    ribs: tuple[RibGroup, ...] = ()

    def row_slip(self, y: Array) -> Array:
        """Rigid slip along x of the rows of the belt that roll on smaller radii, over rolling speed: (ny,).

        y: across, m. Zero where the belt's own radius is not given.
        """
        radius = self.belt.belt_radius
        if radius is None:
            return np.zeros_like(y)
        return np.asarray(np.square(y) / (2 * radius * self.rolling_radius))


def belt_caveat(belt: Belt, inflation_pressure: float, diameter: float | None) -> str | None:
    """A sentence where a belt has numbers of the truck tire that are the defaults, on a tire of another kind.

    inflation_pressure: Pa. diameter: outer, m; None where it is not known.
    """
    off = unlike_a_truck(inflation_pressure, diameter)
    truck = Belt()
    same = [name for name in ("foundation", "meridional", "bending") if getattr(belt, name) == getattr(truck, name)]
    if off is None or not same:
        return None
    return (
        f"{', '.join(same)} of the belt {'is' if len(same) == 1 else 'are'} those of one truck tire (315/80R22.5 at "
        f"820 kPa), and this one has {off}: give Belt({', '.join(f'{name}=...' for name in same)}), fitted to a "
        "measured deflection or footprint"
    )


def read_belts(path: str | Path) -> list[Belt]:
    """The belt of a TOML file, in a list: the keys are the arguments of Belt. Raises InputError with file and key.

    >>> from pathlib import Path
    >>> folder = Path(tl.catalogue.__file__).parent / "data"
    >>> (belt,) = tl.catalogue.read_belts(folder / "belts" / "315_80R22.5.toml")
    >>> belt.name
    '315/80R22.5'
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    file = Path(path)
    return [read(Belt, read_tables(file), str(file))]


belts: Catalogue[Belt] = Catalogue(
    "belt",
    (Belt,),
    folder="belts",
    read=read_belts,
    words=str,
    group="treadload.belts",
    use='belt = "315/80R22.5" in [tire] of a case',
)
"""Belts of inflated tires, for `Tire(belt=...)`."""
