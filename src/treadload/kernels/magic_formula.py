"""The Magic Formula, versions 5.2 and 6.1: forces and moments of a tire as a function of load, slip and lean.

Arrays in, arrays out, in the signs and the names of the formula: κ > 0 drives, α* = tan α, γ leans. ISO, SAE and
adapted SAE share these equations; what α, γ, F_y and M_z mean in each of them is left to the caller.
Without turn slip, forward, above the speed below which simulation programs fade the forces in.

Sources: Pacejka (2002) and (2012), Tire and Vehicle Dynamics, equations 4.E1 to 4.E78. Programs that read the files
follow Besselink, Schmeitz & Pacejka (2010), An improved Magic Formula/Swift tyre model that can handle inflation
pressure changes, Vehicle System Dynamics 48(S1), 337-352, where it differs from the book: camber itself in moments,
equivalent slip by tangents, rolling resistance over the nominal load, friction itself in the vertical shifts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array


def words(text: str) -> list[str]:
    """Names with blanks between."""
    return text.split()


LONGITUDINAL = words(
    "PCX1 PDX1 PDX2 PDX3 PEX1 PEX2 PEX3 PEX4 PKX1 PKX2 PKX3 PHX1 PHX2 PVX1 PVX2 PPX1 PPX2 PPX3 PPX4 "
    "RBX1 RBX2 RBX3 RCX1 REX1 REX2 RHX1"
)
LATERAL = words(
    "PCY1 PDY1 PDY2 PDY3 PEY1 PEY2 PEY3 PEY4 PEY5 PKY1 PKY2 PKY3 PKY4 PKY5 PKY6 PKY7 PHY1 PHY2 PHY3 "
    "PVY1 PVY2 PVY3 PVY4 PPY1 PPY2 PPY3 PPY4 PPY5 RBY1 RBY2 RBY3 RBY4 RCY1 REY1 REY2 RHY1 RHY2 "
    "RVY1 RVY2 RVY3 RVY4 RVY5 RVY6"
)
ALIGNING = words(
    "QBZ1 QBZ2 QBZ3 QBZ4 QBZ5 QBZ9 QBZ10 QCZ1 QDZ1 QDZ2 QDZ3 QDZ4 QDZ6 QDZ7 QDZ8 QDZ9 QDZ10 QDZ11 "
    "QEZ1 QEZ2 QEZ3 QEZ4 QEZ5 QHZ1 QHZ2 QHZ3 QHZ4 PPZ1 PPZ2 SSZ1 SSZ2 SSZ3 SSZ4"
)
OVERTURNING = [f"QSX{number}" for number in range(1, 15)] + ["PPMX1"]
ROLLING = [f"QSY{number}" for number in range(1, 9)]
SCALES = words(
    "LFZO LCX LMUX LEX LKX LHX LVX LGAX LCY LMUY LEY LKY LHY LVY LGAY LKYC LTR LRES LGAZ LKZC "
    "LXAL LYKA LVYKA LS LMX LVMX LMY"
)
DEFAULTS: Mapping[str, float] = (
    dict.fromkeys([*LONGITUDINAL, *LATERAL, *ALIGNING, *OVERTURNING, *ROLLING], 0.0)
    | dict.fromkeys(SCALES, 1.0)
    | {"PKY4": 2.0, "QSY7": 1.0}
)
"""Coefficients that the formula reads, with what they are where a file leaves them out."""

# Share of the load below which a peak is as good as none: keeps B finite.
_NO_PEAK = 1e-12
# Slip, rad, up to which its tangent is taken: α* is a tangent already and may exceed a right angle.
_LARGEST_ANGLE = 1.5


@dataclass(frozen=True)
class Wheel:
    """State of a wheel, in arrays that fit each other, in the signs of the coefficients.

    load: N, > 0. slip: κ. slip_angle: α, rad, within ±π/2. inclination: γ, rad. pressure: over the nominal one.
    speed: over the reference speed.
    """

    load: Array
    slip: Array
    slip_angle: Array
    inclination: Array
    pressure: Array
    speed: Array


@dataclass(frozen=True)
class Forces:
    """F_x, F_y in N, M_z, M_x in N m, and M_y in N m, here positive where it resists rolling forward."""

    longitudinal: Array
    lateral: Array
    aligning: Array
    overturning: Array
    resisting: Array


@dataclass(frozen=True)
class _Curve:
    """A pure curve: its force, slope K, peak over the load μ, horizontal and vertical shift, B times C."""

    force: Array
    slope: Array
    friction: Array
    horizontal: Array
    vertical: Array
    steepness: Array


def evaluate(
    coefficients: Mapping[str, float], wheel: Wheel, *, nominal_load: float, radius: float, is_newer: bool
) -> Forces:
    """Forces and moments under combined slip.

    coefficients: by name; `DEFAULTS` stand for those left out. nominal_load: F_z0, N. radius: R_0 of the unloaded
    tire, m. is_newer: version 6.1, else 5.2.
    """
    return Formula({**DEFAULTS, **coefficients}, wheel, nominal_load, radius, is_newer).forces()


@dataclass(frozen=True)
class Formula:
    """The formula for the wheels of one call, see `evaluate`; every coefficient has a number."""

    c: Mapping[str, float]
    wheel: Wheel
    nominal_load: float
    radius: float
    is_newer: bool

    @property
    def scaled_load(self) -> float:
        """F_z0' of the scale factor (4.E1)."""
        return self.nominal_load * self.c["LFZO"]

    @cached_property
    def df(self) -> Array:
        """Increment of the load over the nominal one (4.E2a)."""
        return self.wheel.load / self.scaled_load - 1

    @property
    def dp(self) -> Array:
        """Increment of the pressure over the nominal one (4.E2b)."""
        return self.wheel.pressure - 1

    @cached_property
    def tangent(self) -> Array:
        """α* (4.E3)."""
        return np.tan(self.wheel.slip_angle)

    @cached_property
    def lean(self) -> Array:
        """γ* (4.E4)."""
        return np.sin(self.wheel.inclination)

    @property
    def camber(self) -> Array:
        """γ where 6.1 takes the angle itself."""
        return self.wheel.inclination if self.is_newer else self.lean

    @cached_property
    def upright(self) -> Formula:
        """The same wheels without camber."""
        return replace(self, wheel=replace(self.wheel, inclination=0 * self.wheel.inclination))

    @cached_property
    def along(self) -> _Curve:
        """Pure longitudinal slip (4.E9 to 4.E18)."""
        c, df, dp, load = self.c, self.df, self.dp, self.wheel.load
        lean = self.camber * (1.0 if self.is_newer else c["LGAX"])
        friction = (c["PDX1"] + c["PDX2"] * df) * (1 - c["PDX3"] * lean**2) * c["LMUX"]
        friction = friction * (1 + c["PPX3"] * dp + c["PPX4"] * dp**2)
        slope = load * (c["PKX1"] + c["PKX2"] * df) * np.exp(c["PKX3"] * df) * c["LKX"]
        slope = slope * (1 + c["PPX1"] * dp + c["PPX2"] * dp**2)
        shift = (c["PHX1"] + c["PHX2"] * df) * c["LHX"]
        rise = load * (c["PVX1"] + c["PVX2"] * df) * c["LVX"] * c["LMUX"]
        slip = self.wheel.slip + shift
        curvature = (c["PEX1"] + c["PEX2"] * df + c["PEX3"] * df**2) * (1 - c["PEX4"] * _sign(slip)) * c["LEX"]
        return _sine_curve(c["PCX1"] * c["LCX"], friction * load, slope, curvature, slip, shift, rise, load)

    @cached_property
    def across(self) -> _Curve:
        """Pure lateral slip (4.E19 to 4.E30)."""
        c, df, dp, load = self.c, self.df, self.dp, self.wheel.load
        lean = self.lean * (1.0 if self.is_newer else c["LGAY"])
        friction = (c["PDY1"] + c["PDY2"] * df) * (1 - c["PDY3"] * lean**2) * c["LMUY"]
        friction = friction * (1 + c["PPY3"] * dp + c["PPY4"] * dp**2)
        widest = (c["PKY2"] + c["PKY5"] * lean**2) * (1 + c["PPY2"] * dp)
        slope = c["PKY1"] * self.scaled_load * (1 + c["PPY1"] * dp) * (1 - c["PKY3"] * np.abs(lean)) * c["LKY"]
        slope = slope * np.sin(c["PKY4"] * np.arctan(load / self.scaled_load / widest))
        by_lean = c["LKYC"] if self.is_newer else 1.0
        leaning = load * (c["PVY3"] + c["PVY4"] * df) * lean * by_lean * c["LMUY"]
        rise = load * (c["PVY1"] + c["PVY2"] * df) * c["LVY"] * c["LMUY"] + leaning
        shift = (c["PHY1"] + c["PHY2"] * df) * c["LHY"]
        if self.is_newer:
            thrust = load * (c["PKY6"] + c["PKY7"] * df) * (1 + c["PPY5"] * dp) * c["LKYC"] * lean
            shift = shift + (thrust - leaning) / _away_from_zero(slope, load)
        else:
            shift = shift + c["PHY3"] * lean
        slip = self.tangent + shift
        asymmetry = 1 + c["PEY5"] * lean**2 - (c["PEY3"] + c["PEY4"] * lean) * _sign(slip)
        curvature = (c["PEY1"] + c["PEY2"] * df) * asymmetry * c["LEY"]
        return _sine_curve(c["PCY1"] * c["LCY"], friction * load, slope, curvature, slip, shift, rise, load)

    @cached_property
    def weight_along(self) -> Array:
        """G of the longitudinal force under a slip angle (4.E51 to 4.E57)."""
        c = self.c
        steepness = (
            (c["RBX1"] + c["RBX3"] * self.lean**2) * np.cos(np.arctan(c["RBX2"] * self.wheel.slip)) * c["LXAL"]
        )
        curvature = c["REX1"] + c["REX2"] * self.df
        return _weight(steepness, c["RCX1"], curvature, self.tangent, c["RHX1"])

    @cached_property
    def weight_across(self) -> Array:
        """G of the lateral force under longitudinal slip (4.E59 to 4.E65)."""
        c = self.c
        steepness = (c["RBY1"] + c["RBY4"] * self.lean**2) * c["LYKA"]
        steepness = steepness * np.cos(np.arctan(c["RBY2"] * (self.tangent - c["RBY3"])))
        return _weight(
            steepness, c["RCY1"], c["REY1"] + c["REY2"] * self.df, self.wheel.slip, c["RHY1"] + c["RHY2"] * self.df
        )

    @cached_property
    def induced(self) -> Array:
        """Lateral force that longitudinal slip induces (4.E66, 4.E67)."""
        c = self.c
        share = (c["RVY1"] + c["RVY2"] * self.df + c["RVY3"] * self.lean) * np.cos(
            np.arctan(c["RVY4"] * self.tangent)
        )
        wave = np.sin(c["RVY5"] * np.arctan(c["RVY6"] * self.wheel.slip)) * c["LVYKA"]
        force: Array = self.across.friction * self.wheel.load * share * wave
        return force

    def forces(self) -> Forces:
        """All of them under combined slip."""
        along = self.weight_along * self.along.force
        across = self.weight_across * self.across.force + self.induced
        return Forces(
            along, across, self.aligning(along, across), self.overturning(across), self.rolling_resistance(along)
        )

    def aligning(self, along: Array, across: Array) -> Array:
        """Aligning moment (4.E31 to 4.E47, 4.E71 to 4.E78). along, across: F_x, F_y, N."""
        c, df, load = self.c, self.df, self.wheel.load
        lean = self.camber * (1.0 if self.is_newer else c["LGAZ"])
        by_slope = c["LKY"] / c["LMUY"]
        steepness = (c["QBZ1"] + c["QBZ2"] * df + c["QBZ3"] * df**2) * (
            1 + c["QBZ4"] * lean + c["QBZ5"] * np.abs(lean)
        )
        steepness = steepness * by_slope
        trail = load * (self.radius / self.scaled_load) * (c["QDZ1"] + c["QDZ2"] * df) * c["LTR"]
        trail = trail * (1 - c["PPZ1"] * self.dp) * (1 + c["QDZ3"] * lean + c["QDZ4"] * lean**2)
        tilt = self.lean if self.is_newer else lean
        slip = self.tangent + c["QHZ1"] + c["QHZ2"] * df + (c["QHZ3"] + c["QHZ4"] * df) * tilt
        curvature = c["QEZ1"] + c["QEZ2"] * df + c["QEZ3"] * df**2
        turning = (2 / np.pi) * np.arctan(steepness * c["QCZ1"] * slip)
        curvature = np.minimum(curvature * (1 + (c["QEZ4"] + c["QEZ5"] * tilt) * turning), 1)
        ratio = self.along.slope / _away_from_zero(self.across.slope, load) * self.wheel.slip
        facing = np.cos(self.wheel.slip_angle)
        arm = trail * facing * _cosine(steepness, c["QCZ1"], curvature, _equivalent(slip, ratio))
        residual = self.residual(lean, tilt, by_slope, ratio) * facing
        # Of 6.1 the pure force is that of the upright wheel, its weight that of the leaning one.
        turned = self.weight_across * self.upright.across.force if self.is_newer else across - self.induced
        offset = c["SSZ1"] + c["SSZ2"] * across / self.nominal_load + (c["SSZ3"] + c["SSZ4"] * df) * self.camber
        return -arm * turned + residual + self.radius * c["LS"] * offset * along

    def residual(self, lean: Array, tilt: Array, by_slope: float, ratio: Array) -> Array:
        """Residual moment, N m. lean, tilt: of the wheel. by_slope: λ_Ky/λ_μy. ratio: K_x κ/K_y."""
        c, df, curve = self.c, self.df, self.across
        slip = self.tangent + curve.horizontal + curve.vertical / _away_from_zero(curve.slope, self.wheel.load)
        by_lean = (c["QDZ8"] + c["QDZ9"] * df) * (1 + c["PPZ2"] * self.dp)
        if self.is_newer:
            by_lean = (by_lean + (c["QDZ10"] + c["QDZ11"] * df) * np.abs(tilt)) * tilt * c["LKZC"]
        else:
            by_lean = by_lean * lean
        peak = (c["QDZ6"] + c["QDZ7"] * df) * c["LRES"] + by_lean
        steepness = c["QBZ9"] * by_slope + c["QBZ10"] * curve.steepness
        shape = np.cos(np.arctan(steepness * _equivalent(slip, ratio)))
        moment: Array = self.wheel.load * self.radius * peak * c["LMUY"] * shape
        return moment

    def overturning(self, across: Array) -> Array:
        """Overturning moment (4.E69; Besselink et al. 2010). across: F_y, N."""
        c, load, lean = self.c, self.wheel.load / self.nominal_load, self.camber
        side = across / self.nominal_load
        arm = c["QSX1"] * c["LVMX"] - c["QSX2"] * lean * (1 + c["PPMX1"] * self.dp) + c["QSX3"] * side
        if self.is_newer:
            arm = arm + c["QSX4"] * np.cos(c["QSX5"] * np.arctan((c["QSX6"] * load) ** 2)) * np.sin(
                c["QSX7"] * lean + c["QSX8"] * np.arctan(c["QSX9"] * side)
            )
            arm = arm + c["QSX10"] * np.arctan(c["QSX11"] * load) * lean - c["QSX12"] * lean * np.abs(lean)
            arm = arm + side / load * (c["QSX13"] + c["QSX14"] * np.abs(lean))
        return self.radius * self.wheel.load * c["LMX"] * arm

    def rolling_resistance(self, along: Array) -> Array:
        """Rolling resistance moment, N m (4.E70; Besselink et al. 2010). along: F_x, N."""
        c, speed, lean = self.c, self.wheel.speed, self.camber
        load = self.wheel.load / self.nominal_load
        share = c["QSY1"] + c["QSY2"] * along / self.nominal_load + c["QSY3"] * np.abs(speed) + c["QSY4"] * speed**4
        if not self.is_newer:
            return self.radius * self.wheel.load * c["LMY"] * share
        share = share + (c["QSY5"] + c["QSY6"] * load) * lean**2
        scale = load ** c["QSY7"] * self.wheel.pressure ** c["QSY8"]
        return self.radius * self.nominal_load * c["LMY"] * share * scale


def _sine_curve(
    shape: float, peak: Array, slope: Array, curvature: Array, slip: Array, shift: Array, rise: Array, load: Array
) -> _Curve:
    """D sin(C atan(Bx - E(Bx - atan Bx))) + S_V with B = K/(C D) and E of 1 at most."""
    steepness = slope / _away_from_zero(shape * peak, load)
    bent = _bent(steepness * slip, np.minimum(curvature, 1))
    force = peak * np.sin(shape * np.arctan(bent)) + rise
    return _Curve(force, slope, peak / load, shift, rise, steepness * shape)


def _bent(x: Array, curvature: Array) -> Array:
    """Bx - E(Bx - atan Bx)."""
    return x - curvature * (x - np.arctan(x))


def _cosine(steepness: Array, shape: float, curvature: Array, slip: Array) -> Array:
    """cos(C atan(Bx - E(Bx - atan Bx)))."""
    return np.cos(shape * np.arctan(_bent(steepness * slip, curvature)))


def _weight(steepness: Array, shape: float, curvature: Array, slip: Array, shift: Array | float) -> Array:
    """What is left of a force under slip of the second direction: 1 where that is zero."""
    curvature = np.minimum(curvature, 1)
    weight: Array = _cosine(steepness, shape, curvature, slip + shift) / _cosine(
        steepness, shape, curvature, shift + 0 * slip
    )
    return weight


def _equivalent(slip: Array, ratio: Array) -> Array:
    """Slip angle that stands for combined slip in the trail: by tangents as far as they reach (4.E77, 4.E78)."""
    near = np.clip(slip, -_LARGEST_ANGLE, _LARGEST_ANGLE)
    angle = np.where(slip == near, np.arctan(np.hypot(np.tan(near), ratio)), np.hypot(slip, ratio))
    return angle * _sign(slip)


def _sign(values: Array) -> Array:
    return np.where(values < 0, -1.0, 1.0)


def _away_from_zero(values: Array, load: Array) -> Array:
    least = _NO_PEAK * load
    return np.where(np.abs(values) < least, _sign(values) * least, values)
