"""Curves of a solved tire over slip: along travel, across, and both together, at several loads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from treadload.contact import Contact, Rolling, creep_curve, solve_contact
from treadload.contact.solvers.coupling import Progress
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.tire import Tire

Kind = Literal["along", "across", "combined"]

# Slip κ along travel, slip angles, and both together; the steepest parts and the sliding ends are covered.
_ALONG = np.array([-0.3, -0.15, -0.08, -0.05, -0.03, -0.015, -0.005, 0.005, 0.015, 0.03, 0.05, 0.08, 0.15, 0.3])
_ACROSS = np.radians([0.5, 1.0, 1.5, 2.5, 3.5, 5.0, 7.0, 10.0, 14.0])
_COMBINED = np.array([-0.25, -0.12, -0.06, -0.03, -0.01, 0.01, 0.03, 0.06, 0.12, 0.25])
_ANGLES = np.radians([2.0, 5.0])
# Share of the contact that slips at the ends of a curve: below it the peak was not reached.
_SLIDES = 0.9
# Creepage of free rolling across, beyond which a tire pulls to a side.
_STRAIGHT = 1e-3
# Smallest and largest factor of the slips: κ of 0.09 and 0.9.
REACH = (0.3, 3.0)
WIDEST_SLIP, WIDEST_ANGLE = float(_ALONG[-1]), float(_ACROSS[-1])


@dataclass(frozen=True, eq=False)
class SlipCurve:
    """Forces of the road on a solved tire over slip under a load, in the signs of treadload, all (n,).

    kind: "along", "across" or "combined". normal_load: N. slip: κ, positive when driving. slip_angle: rad, positive
    when the wheel moves to the right. tractive_force, lateral_force: N. aligning_moment: N m. slip_fraction: share of
    the contact that slips. inflation_pressure: Pa; None: the nominal one.
    """

    kind: Kind
    normal_load: float
    slip: Array
    slip_angle: Array
    tractive_force: Array
    lateral_force: Array
    aligning_moment: Array
    slip_fraction: Array
    inflation_pressure: float | None = None

    @property
    def name(self) -> str:
        """Kind and load, the angle of combined slip, and the inflation pressure where it is not the nominal one."""
        angle = f" at {math.degrees(self.slip_angle[0]):g}°" if self.kind == "combined" else ""
        inflated = "" if self.inflation_pressure is None else f", {self.inflation_pressure / 1e3:g} kPa"
        return f"{self.kind}{angle}, {self.normal_load / 1e3:g} kN{inflated}"


@dataclass(frozen=True)
class SlipSolver:
    """Solves curves of a tire. rolling: friction and speed. reach: factor of all slips.

    inflation_pressure: that of the tire, Pa, where it is not the nominal one.
    """

    tire: Tire
    road: Pavement
    rolling: Rolling
    reach: float
    spacing: float | None
    progress: Progress | None
    inflation_pressure: float | None = None

    def free(self, load: float) -> Contact:
        """The tire rolling freely under a load, N. Raises InputError for a tire that pulls to a side."""
        self._say(f"{load / 1e3:g} kN, rolling freely")
        contact = solve_contact(self.tire, self.road, self._wheel(load), spacing=self.spacing)
        pull = float(contact.dataset["creepage_y"])
        if abs(pull) > _STRAIGHT:
            raise InputError(
                f"under {load:g} N the tire rolls freely at a slip angle of {math.degrees(pull):.2g}°, more than "
                f"{math.degrees(_STRAIGHT):.2g}°: curves to one side do not determine the other; fit its profile, or "
                "a tread without a hand"
            )
        return contact

    def pure(self, load: float, free: float) -> list[SlipCurve]:
        """Curves along travel and across. free: creepage of free rolling. Raises InputError where nothing slides."""
        curves = [
            self._along("along", load, free, self.reach * _ALONG, 0.0),
            self._across(load, self.reach * _ACROSS),
        ]
        for curve in curves:
            ends = (0, -1) if curve.kind == "along" else (-1,)
            for end in ends:
                share = float(curve.slip_fraction[end])
                if share < _SLIDES:
                    here = (
                        f"a slip of {curve.slip[end]:g}"
                        if curve.kind == "along"
                        else f"a slip angle of {math.degrees(curve.slip_angle[end]):g}°"
                    )
                    raise InputError(
                        f"the curve {curve.name} never slides: at {here} {100 * share:.0f} % of the contact slips, "
                        f"{100 * _SLIDES:.0f} % or more is needed, so its peak would be a guess; raise reach above "
                        f"{self.reach:g} (at most {REACH[1]:g}), or lower the friction"
                    )
        return curves

    def combined(self, load: float, free: float) -> list[SlipCurve]:
        """Curves over slip along travel at slip angles."""
        return [
            self._along("combined", load, free, self.reach * _COMBINED, float(angle))
            for angle in self.reach * _ANGLES
        ]

    def _along(self, kind: Kind, load: float, free: float, slips: Array, angle: float) -> SlipCurve:
        wheel = self._wheel(load)
        if angle:
            wheel = replace(wheel, creepage_y=math.tan(angle))
        # κ is counted from free rolling, creepage from the radius of the unloaded tread.
        return self._curve(kind, wheel, free - (1 - free) * slips, slips, np.full(slips.size, angle))

    def _across(self, load: float, angles: Array) -> SlipCurve:
        return self._curve("across", self._wheel(load), np.tan(angles), np.zeros(angles.size), angles)

    def _curve(self, kind: Kind, wheel: Rolling, creepages: Array, slips: Array, angles: Array) -> SlipCurve:
        load = float(wheel.normal_load or 0.0)
        self._say(f"{load / 1e3:g} kN, {kind}, {creepages.size} slips")
        data = creep_curve(
            self.tire, self.road, wheel, list(creepages), along="y" if kind == "across" else "x", spacing=self.spacing
        ).dataset
        names = ("tractive_force", "lateral_force", "aligning_moment", "slip_fraction")
        tractive, lateral, moment, fraction = (data[name].to_numpy() for name in names)
        return SlipCurve(kind, load, slips, angles, tractive, lateral, moment, fraction, self.inflation_pressure)

    def _wheel(self, load: float) -> Rolling:
        return Rolling(normal_load=load, friction=self.rolling.friction, speed=self.rolling.speed)

    def _say(self, text: str) -> None:
        if self.progress is not None:
            inflated = "" if self.inflation_pressure is None else f", {self.inflation_pressure / 1e3:g} kPa"
            self.progress(text + inflated)


def combined_loads(loads: Sequence[float]) -> list[float]:
    """The smallest, the middle and the largest of sorted loads, at which combined slip is solved."""
    return [loads[0], loads[len(loads) // 2], loads[-1]]
