"""Maneuvers: what a wheel's forces and spin are on a road, relative to its load."""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.contact.friction import FrictionLaw
from treadload.contact.wheel import Rolling
from treadload.errors import InputError

GRAVITY = 9.81
"""m/s²."""


@dataclass(frozen=True)
class Maneuver:
    """How a wheel rolls, whatever its load.

    name: for tables and figures. tractive: force of the road on the tire along travel over the load, positive
    when driving. lateral: force to the right over the load. spin: rad/m, 1/R on a path of radius R to the right.
    locked: True if the wheel does not turn: creepage 1, all of the contact slides; tractive is then not read.
    Raises InputError.
    """

    name: str = "straight"
    tractive: float = 0.0
    lateral: float = 0.0
    spin: float = 0.0
    locked: bool = False

    def __post_init__(self) -> None:
        for word in ("tractive", "lateral", "spin"):
            value = getattr(self, word)
            if not math.isfinite(value):
                raise InputError(f"{word} of the maneuver {self.name!r} must be finite, got {value}")

    @classmethod
    def braking(cls, deceleration: float | None = None) -> Maneuver:
        """A braked wheel; every wheel of the vehicle brakes in proportion to its load.

        deceleration: m/s², > 0; None locks the wheel, which takes all of the friction.
        """
        if deceleration is None:
            return cls("locked", locked=True)
        _check_positive("deceleration", deceleration, "m/s²", "a firm stop has 3")
        return cls(f"braking at {deceleration:g} m/s²", tractive=-deceleration / GRAVITY)

    @classmethod
    def uphill(cls, grade: float, driven_share: float) -> Maneuver:
        """A driven wheel on a slope at constant speed, without the drag of the air.

        grade: rise over run, > 0. driven_share: part of the vehicle's weight on its driven axles, in (0, 1].
        """
        _check_positive("grade", grade, "rise over run", "6 % is 0.06")
        if not 0 < driven_share <= 1:
            raise InputError(f"driven_share must lie in (0, 1], got {driven_share}; a loaded semi-trailer has 0.25")
        return cls(f"uphill {100 * grade:g} %", tractive=grade / driven_share)

    @classmethod
    def turning(cls, radius: float, speed: float, *, crossfall: float = 0.0) -> Maneuver:
        """A wheel on a circle, such as a roundabout: the side force V²/(gR) and the spin 1/R.

        radius: of the path, m, not 0; positive when the circle lies to the right of travel, negative to the left.
        speed: m/s, >= 0. crossfall: of the road towards the centre of the circle, rise over run; it takes off
        side force.
        """
        if not (math.isfinite(radius) and radius != 0):
            raise InputError(f"radius must be a number of metres other than 0, got {radius}; use STRAIGHT")
        if not (math.isfinite(speed) and speed >= 0):
            raise InputError(f"speed must be >= 0 m/s, got {speed}")
        if not abs(crossfall) < 0.5:
            raise InputError(f"crossfall must lie in (-0.5, 0.5), got {crossfall}; 2.5 % is 0.025")
        pull = speed**2 / (GRAVITY * abs(radius))
        lateral = math.copysign((pull - crossfall) / (1 + pull * crossfall), radius)
        return cls(f"turning, R = {abs(radius):g} m at {speed * 3.6:g} km/h", lateral=lateral, spin=1 / radius)

    def rolling(self, normal_load: float, friction: float | FrictionLaw, *, speed: float | None = None) -> Rolling:
        """The rolling state under a load, N, with a coefficient or law of friction; speed in m/s."""
        if self.locked:
            return Rolling(
                normal_load=normal_load,
                friction=friction,
                creepage_x=1.0,
                lateral_force=self.lateral * normal_load,
                spin=self.spin,
                speed=speed,
            )
        return Rolling(
            normal_load=normal_load,
            friction=friction,
            tractive_force=self.tractive * normal_load,
            lateral_force=self.lateral * normal_load,
            spin=self.spin,
            speed=speed,
        )

    def __str__(self) -> str:
        return self.name


STRAIGHT = Maneuver()
"""A wheel that rolls freely."""


def _check_positive(name: str, value: float, unit: str, usual: str) -> None:
    if not (math.isfinite(value) and value > 0):
        raise InputError(f"{name} must be > 0 {unit}, got {value}; {usual}")
