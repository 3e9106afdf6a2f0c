"""Maneuvers: what a wheel's forces and spin are on a road, relative to its load.

A parking turn is none of these: the wheel spins and does not roll. `turn_on_the_spot` solves it, and the
`contact` of its result loads a road as any other contact does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from treadload.contact.friction.laws import FrictionLaw
from treadload.contact.rolling_state import Rolling
from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.registry import MANEUVERS
from treadload.units import Acceleration, Curvature, Length, Number, Radius, Share, Speed

GRAVITY = 9.81
"""m/s²."""


@dataclass(frozen=True)
class Maneuver:
    """How a wheel rolls, whatever its load.

    name: for tables and figures. tractive: force of the road on the tire along travel over the load, positive
    when driving. lateral: force to the right over the load. spin: rad/m, 1/R on a path of radius R to the right.
    locked: True if the wheel does not turn: creepage 1, all of the contact slides; tractive is then not read.
    load_ratio: load of the wheel in the maneuver over the load that `rolling` is given, > 0: above 1 where the
    vehicle leans on this wheel. tractive and lateral are over the load in the maneuver.
    Raises InputError.

    >>> braking = tl.contact.Maneuver.braking(3.0)  # m/s²
    >>> f"{braking.rolling(32.5e3, friction=0.7).tractive_force / 1e3:.1f} kN"
    '-9.9 kN'
    """

    name: str = "straight"
    tractive: float = 0.0
    lateral: float = 0.0
    spin: float = 0.0
    locked: bool = False
    load_ratio: float = 1.0

    def __post_init__(self) -> None:
        for word in ("tractive", "lateral", "spin", "load_ratio"):
            value = getattr(self, word)
            if not math.isfinite(value):
                raise InputError(f"{word} of the maneuver {self.name!r} must be finite, got {value}")
        positive(f"load_ratio of the maneuver {self.name!r}", self.load_ratio, remedy="1 keeps the load")

    @classmethod
    def braking(cls, deceleration: Acceleration | None = None) -> Maneuver:
        """A braked wheel; every wheel of the vehicle brakes in proportion to its load.

        deceleration: m/s², > 0; None locks the wheel, which takes all of the friction.
        """
        if deceleration is None:
            return cls("locked", locked=True)
        positive("deceleration", deceleration, "m/s²", "a firm stop has 3")
        return cls(f"braking at {deceleration:g} m/s²", tractive=-deceleration / GRAVITY)

    @classmethod
    def uphill(cls, grade: Share, driven_share: Share) -> Maneuver:
        """A driven wheel on a slope at constant speed, without the drag of the air.

        grade: rise over run, > 0. driven_share: part of the vehicle's weight on its driven axles, in (0, 1].
        """
        positive("grade", grade, remedy="rise over run, 6 % is 0.06")
        if not 0 < driven_share <= 1:
            raise InputError(f"driven_share must lie in (0, 1], got {driven_share}; a loaded semi-trailer has 0.25")
        return cls(f"uphill {100 * grade:g} %", tractive=grade / driven_share)

    @classmethod
    def turning(
        cls,
        radius: Radius,
        speed: Speed,
        *,
        crossfall: Share = 0.0,
        track: Length | None = None,
        centre_of_gravity: Length | None = None,
        wheel: Literal["outer", "inner"] = "outer",
    ) -> Maneuver:
        """A wheel on a circle, such as a roundabout: the side force V²/(gR) and the spin 1/R.

        radius: of the path, m, not 0; positive when the circle lies to the right of travel, negative to the left.
        speed: m/s, >= 0. crossfall: c, of the road towards the centre of the circle, rise over run; it takes off
        side force. Every wheel takes side force in proportion to its load: λ = (V²/gR - c) / (1 + c V²/gR) of it.
        track: t, of the vehicle, between the middles of its wheels, m. centre_of_gravity: h, above the road, m;
        both or neither. With them the vehicle leans, as a rigid body whose axles share the moment as they share the
        weight: the load of a wheel on level ground at rest grows by (1 + c V²/gR) / √(1 + c²) · (1 ± 2 λ h/t),
        + for the outer wheel, which lies away from the centre. Without them the load is the wheel's in the turn.
        wheel: "outer" or "inner". Raises InputError, also where the vehicle tips.
        """
        if not (math.isfinite(radius) and radius != 0 and math.isfinite(1 / radius)):
            raise InputError(f"radius must be a number of metres other than 0, got {radius}; use STRAIGHT")
        if not (math.isfinite(speed) and speed >= 0):
            raise InputError(f"speed must be >= 0 m/s, got {speed}")
        if not abs(crossfall) < 0.5:
            raise InputError(f"crossfall must lie in (-0.5, 0.5), got {crossfall}; 2.5 % is 0.025")
        if wheel not in ("outer", "inner"):
            raise InputError(f'wheel must be "outer" or "inner", got {wheel!r}')
        pull = speed * speed / (GRAVITY * abs(radius))
        if not (math.isfinite(pull) and 1 + pull * crossfall > 0):
            raise InputError(
                f"{speed:g} m/s on a circle of {abs(radius):g} m pull a wheel aside by {pull:.3g} of its weight, "
                f"which no road with a crossfall of {crossfall:g} can hold; lower the speed, or take a wider circle"
            )
        share = (pull - crossfall) / (1 + pull * crossfall)
        ratio = 1.0
        if track is not None or centre_of_gravity is not None:
            leaning = _leaning(share, track, centre_of_gravity)
            square_to_road = (1 + pull * crossfall) / math.hypot(1, crossfall)
            ratio = square_to_road * (1 + (leaning if wheel == "outer" else -leaning))
        name = f"turning, R = {abs(radius):g} m at {speed * 3.6:g} km/h"
        if ratio != 1 or wheel == "inner":
            name += f", {wheel} wheel"
        return cls(name, lateral=math.copysign(1, radius) * share, spin=1 / radius, load_ratio=ratio)

    def rolling(self, normal_load: float, friction: float | FrictionLaw, *, speed: float | None = None) -> Rolling:
        """The rolling state under a load, N, with a coefficient or friction law; speed in m/s.

        normal_load: before `load_ratio`. Raises InputError for forces that no friction of the law could carry.
        """
        load = self.load_ratio * normal_load
        state = Rolling(
            normal_load=load,
            friction=friction,
            tractive_force=None if self.locked else self.tractive * load,
            creepage_x=1.0 if self.locked else None,
            lateral_force=self.lateral * load,
            spin=self.spin,
            speed=speed,
        )
        try:
            state.check_friction_limit(load)
        except InputError as error:
            raise InputError(f"{self.name}: {error}. {self._way_out}") from error
        return state

    @property
    def _way_out(self) -> str:
        """What a driver can do when friction does not carry the maneuver."""
        if self.lateral:
            return "In a turn the force falls with the square of the speed: lower the speed, or take a wider circle"
        if self.tractive < 0:
            return "Brake less hard, or lock the wheel: Maneuver.braking()"
        return "Climb a gentler slope, or put more of the weight on driven axles"

    def __str__(self) -> str:
        return self.name

    __repr__ = as_call


STRAIGHT = Maneuver()
"""A wheel that rolls freely."""

MANEUVERS.makes(Maneuver)
MANEUVERS.register("uphill")(Maneuver.uphill)
MANEUVERS.register("turning")(Maneuver.turning)


@MANEUVERS.register("straight")
def _straight() -> Maneuver:
    """A wheel that rolls freely."""
    return STRAIGHT


@MANEUVERS.register("braking")
def _braking(deceleration: Acceleration) -> Maneuver:
    """A braked wheel; every wheel of the vehicle brakes in proportion to its load.

    deceleration: > 0.
    """
    return Maneuver.braking(deceleration)


@MANEUVERS.register("locked")
def _locked() -> Maneuver:
    """A wheel that does not turn: all of the contact slides."""
    return Maneuver.braking()


@MANEUVERS.register("forces")
def _forces(name: str = "forces", tractive: Number = 0.0, lateral: Number = 0.0, spin: Curvature = 0.0) -> Maneuver:
    """Forces over the load, and spin.

    name: for tables. tractive, lateral: force of the road on the tire along travel and to the right, over the load.
    spin: 1/R.
    """
    return Maneuver(name, tractive=tractive, lateral=lateral, spin=spin)


def _leaning(share: float, track: float | None, height: float | None) -> float:
    """2 λ h/t: the part of its load that the outer wheel gains and the inner one loses."""
    if track is None or height is None:
        missing = "track" if track is None else "centre_of_gravity"
        raise InputError(f"a vehicle leans by its track and the height of its centre of gravity; give {missing} too")
    positive("track", track, "metres", "a truck has 2")
    positive("centre_of_gravity", height, "metres", "a loaded truck has 1.5 to 2")
    leaning = 2 * share * height / track
    if abs(leaning) >= 1:
        raise InputError(
            f"the vehicle tips: a side force of {abs(share):.3g} of its weight at {height:g} m above the road lifts "
            f"the wheels of a track of {track:g} m from {track / (2 * height):.3g} on; lower the speed, or take a "
            "wider circle"
        )
    return leaning
