"""The rolling state of the wheel."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.contact.friction.laws import Coulomb, FrictionLaw, Interface, largest_force, law_of
from treadload.describing import as_call
from treadload.errors import InputError, positive, within
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.units import Curvature, Force, Length, Number, Speed

# Name, unit, and what is usual, of what must lie above zero.
_ABOVE_ZERO = (
    ("normal_load", "N", "a truck's wheel carries 20e3 to 60e3"),
    ("approach", "metres", "1 mm is 0.001"),
    ("speed", "m/s", "80 km/h is 22.2"),
)

# Beyond them arithmetic ends, not tires: solvers square what they compare in single precision.
_LOADS, _APPROACHES, _MOST_SPIN = (1e-15, 1e15), (1e-15, 1e3), 1e6


@dataclass(frozen=True, kw_only=True)
class Rolling:
    """What the wheel does on the road: give forces, or creepages, or one of each.

    normal_load: N, > 0; or approach. approach: of the tire towards the road, m, > 0, in place of the normal_load.
    friction: coefficient μ ≥ 0 of Coulomb's law, or a friction law (`contact.friction.laws`).
    tractive_force: force of the road on the tire along travel, N: positive when driving, negative when
    braking; or creepage_x. Neither given: a tractive force of zero. creepage_x: (V - ωR)/V, negative when driving.
    lateral_force: force of the road on the tire to the right, N; or creepage_y. Neither: no lateral force.
    creepage_y: velocity of the tire relative to the road to the right, over V.
    spin: turn slip 1/R_path plus `Tire.camber_spin`, about z (down), rad/m. speed: of rolling, m/s; friction that
    falls with slip or heat needs it, and so does power in W.

    >>> wheel = tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
    >>> wheel.tractive_force
    10000.0
    """

    normal_load: Force | None = None
    friction: float | FrictionLaw
    approach: Length | None = None
    tractive_force: Force | None = None
    creepage_x: Number | None = None
    lateral_force: Force | None = None
    creepage_y: Number | None = None
    spin: Curvature = 0.0
    speed: Speed | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and name != "friction" and not math.isfinite(value):
                raise InputError(f"{name} must be a finite number, got {value}")
        if (self.normal_load is None) == (self.approach is None):
            raise InputError("give either normal_load (N) or approach (m), not both and not neither")
        for name, unit, usual in _ABOVE_ZERO:
            value = getattr(self, name)
            if value is not None:
                positive(name, value, unit, usual)
        if self.normal_load is not None:
            within("normal_load", self.normal_load, *_LOADS, "N", "a truck's wheel carries 20e3 to 60e3")
        if self.approach is not None:
            within("approach", self.approach, *_APPROACHES, "m", "1 mm is 0.001")
        within("spin", self.spin, -_MOST_SPIN, _MOST_SPIN, "rad/m", "a turn of 20 m radius has 0.05")
        if self.law.needs_speed and self.speed is None:
            raise InputError(f"friction {self.law} depends on the slip speed: give the rolling speed (m/s) too")
        for force, creepage in (("tractive_force", "creepage_x"), ("lateral_force", "creepage_y")):
            if getattr(self, force) is not None and getattr(self, creepage) is not None:
                raise InputError(f"give either {force} or {creepage}, not both")
            value = getattr(self, creepage)
            if value is not None and abs(value) > 1:
                raise InputError(
                    f"{creepage} must lie in [-1, 1], got {value:g}; a locked wheel has a longitudinal creepage of "
                    "1, and long before that all of the contact slides"
                )

    @property
    def forces(self) -> tuple[float | None, float | None]:
        """Prescribed forces of the road on the tire along x and y, N; None where the creepage is given."""
        along = None if self.creepage_x is not None else (self.tractive_force or 0.0)
        across = None if self.creepage_y is not None else (self.lateral_force or 0.0)
        return along, across

    @property
    def creepages(self) -> tuple[float, float]:
        """Prescribed creepages along x and y; zero where the force is given."""
        return self.creepage_x or 0.0, self.creepage_y or 0.0

    @cached_property
    def law(self) -> FrictionLaw:
        """The friction law; a number is Coulomb's."""
        return law_of(self.friction)

    @property
    def coefficient(self) -> float:
        """Coulomb's coefficient μ. Raises InputError for any other law."""
        if isinstance(self.law, Coulomb):
            return float(self.law.number)
        raise InputError(
            f"this problem knows Coulomb's friction only, got {self.law}; give a coefficient such as 0.7"
        )

    def check_friction_limit(self, normal_load: float, total: float | None = None) -> None:
        """Refuse forces that friction cannot carry.

        normal_load: N. total: Σ μp dA at rest, N; left out, what the law's largest coefficient would carry.
        """
        largest = self.law.largest
        demand, limit = largest_force(self.law.axes, self.forces, largest * normal_load if total is None else total)
        if demand == 0 or demand < limit * (1 - 1e-9):
            return
        if isinstance(self.law, Coulomb):
            why = f"the largest possible is μP = {largest:g} x {normal_load:.6g} N ="
        else:
            why = (
                f"the largest possible in its direction, with friction {self.law} and {normal_load:.6g} N of load, is"
            )
        raise InputError(
            f"gross sliding: a force of {demand:.6g} N along the road needs more than friction can carry; "
            f"{why} {limit:.6g} N. Lower the force, raise friction or the load, or prescribe the creepage instead"
        )

    def __str__(self) -> str:
        load = (
            f"P = {self.normal_load / 1e3:g} kN"
            if self.normal_load
            else f"approach = {(self.approach or 0) * 1e3:g} mm"
        )
        parts = [load, f"μ = {self.law}"]
        for symbol, force, creepage in zip("xy", self.forces, self.creepages, strict=True):
            parts.append(f"creepage_{symbol} = {creepage:g}" if force is None else f"Q_{symbol} = {force / 1e3:g} kN")
        if self.spin:
            parts.append(f"spin = {self.spin:g} rad/m")
        return ", ".join(parts)

    __repr__ = as_call


def bound_on(grid: Grid, rolling: Rolling) -> Callable[[Array], Array]:
    """Shear, Pa, that friction carries on cells under a pressure (ny, nx), Pa, at which nothing slides yet."""

    def bound(pressure: Array) -> Array:
        still = np.zeros((2, *pressure.shape))
        return rolling.law.bound(Interface(pressure, still, grid.x, grid.y, grid.dx, rolling.speed))

    return bound
