"""The rolling state of the wheel."""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.errors import InputError


@dataclass(frozen=True, kw_only=True)
class Rolling:
    """What the wheel does on the road: give forces, or creepages, or one of each.

    normal_load: N, > 0; or approach: m, of the tire towards the road, > 0.
    friction: coefficient of friction μ ≥ 0.
    tractive_force: force of the road on the tire along travel, N: positive when driving, negative when
    braking; or creepage_x = (V - ωR)/V: negative when driving. Neither given: a tractive force of zero.
    lateral_force: force of the road on the tire to the right, N; or creepage_y. Neither: no lateral force.
    spin: rad/m, turn slip 1/R_path plus camber, about z (down). speed: m/s, kept for the record and for
    what depends on it later.
    """

    normal_load: float | None = None
    friction: float
    approach: float | None = None
    tractive_force: float | None = None
    creepage_x: float | None = None
    lateral_force: float | None = None
    creepage_y: float | None = None
    spin: float = 0.0
    speed: float | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not math.isfinite(value):
                raise InputError(f"{name} must be a finite number, got {value}")
        if (self.normal_load is None) == (self.approach is None):
            raise InputError("give either normal_load (N) or approach (m), not both and not neither")
        for name, unit in (("normal_load", "N"), ("approach", "m"), ("speed", "m/s")):
            value = getattr(self, name)
            if value is not None and value <= 0:
                raise InputError(f"{name} must be > 0 {unit}, got {value:g} {unit}")
        if self.friction < 0:
            raise InputError(f"friction must be >= 0, got {self.friction:g}; a dry road is near 0.7")
        for force, creepage in (("tractive_force", "creepage_x"), ("lateral_force", "creepage_y")):
            if getattr(self, force) is not None and getattr(self, creepage) is not None:
                raise InputError(f"give either {force} or {creepage}, not both")

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

    def check_friction_limit(self, normal_load: float) -> None:
        """Refuse forces that friction cannot carry under this normal load, N."""
        along, across = (force or 0.0 for force in self.forces)
        demand, limit = math.hypot(along, across), self.friction * normal_load
        if demand > 0 and demand >= limit * (1 - 1e-9):
            raise InputError(
                f"gross sliding: a force of {demand:.6g} N along the road needs more than friction can carry; "
                f"the largest possible is μP = {self.friction:g} x {normal_load:.6g} N = {limit:.6g} N. "
                "Lower the force, raise friction or the load, or prescribe the creepage instead"
            )

    def __str__(self) -> str:
        load = (
            f"P = {self.normal_load / 1e3:g} kN"
            if self.normal_load
            else f"approach = {(self.approach or 0) * 1e3:g} mm"
        )
        parts = [load, f"μ = {self.friction:g}"]
        for symbol, force, creepage in zip("xy", self.forces, self.creepages, strict=True):
            parts.append(f"creepage_{symbol} = {creepage:g}" if force is None else f"Q_{symbol} = {force / 1e3:g} kN")
        if self.spin:
            parts.append(f"spin = {self.spin:g} rad/m")
        return ", ".join(parts)
