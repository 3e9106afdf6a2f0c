"""Heat conduction with freezing and thawing water, one-dimensional: the enthalpy method, implicit in time.

Enthalpy over temperature is piecewise linear: heat of the frozen body, latent heat over a narrow range below 0 °C,
heat of the thawed one. It is the unknown, so that the front needs no tracking, and none of its heat is lost.

Source: Voller & Cross (1981), Int. J. Heat Mass Transfer 24, 545-556; Carslaw & Jaeger (1959), Conduction of Heat in
Solids, 2nd ed., section 11.2, for Neumann's closed form.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.kernels.arrays import Array

# Over which water freezes, K below 0 °C.
_RANGE = 0.02
# Newton's steps on the enthalpies of one time step, and their accuracy as a part of the heat of 1 K.
_STEPS, _CLOSE = 300, 1e-6
# A step is halved no further than to this part of it; the ice of so many steps changes the conductivity.
_DAMPED, _FOLLOWED = 1e-5, 12


@dataclass(frozen=True, eq=False)
class FreezingCells:
    """Cells over depth, from the surface down, each (n,).

    thickness: m. conductivity, frozen_conductivity: W/(m K). capacity, frozen_capacity: J/(m³ K). latent: heat of
    freezing, J/m³, >= 0.
    """

    thickness: Array
    conductivity: Array
    frozen_conductivity: Array
    capacity: Array
    frozen_capacity: Array
    latent: Array

    @property
    def whole(self) -> Array:
        """Enthalpy from frozen at the end of the range to thawed at 0 °C, J/m³."""
        return self.latent + 0.5 * _RANGE * (self.capacity + self.frozen_capacity)

    def enthalpy(self, temperature: Array) -> Array:
        """Enthalpy at temperatures, °C, J/m³; 0 where the last water freezes."""
        low, high = temperature + _RANGE, temperature
        within = np.clip(low / _RANGE, 0.0, 1.0) * self.whole
        total: Array = self.frozen_capacity * np.minimum(low, 0.0) + within + self.capacity * np.maximum(high, 0.0)
        return total

    def temperature(self, enthalpy: Array) -> tuple[Array, Array]:
        """Temperature, °C, of enthalpies, J/m³, and its slope over them."""
        whole = self.whole
        frozen, thawed = enthalpy < 0, enthalpy > whole
        slope = np.where(frozen, 1 / self.frozen_capacity, np.where(thawed, 1 / self.capacity, _RANGE / whole))
        value = np.where(
            frozen,
            -_RANGE + enthalpy / self.frozen_capacity,
            np.where(thawed, (enthalpy - whole) / self.capacity, -_RANGE + _RANGE * enthalpy / whole),
        )
        return value, slope

    def frozen_share(self, enthalpy: Array) -> Array:
        """Share of the water that is frozen; 1 below 0 °C where there is none."""
        return 1 - np.clip(enthalpy / self.whole, 0.0, 1.0)

    def conductances(self, share: Array) -> tuple[Array, float]:
        """Conductances between cells (n - 1,) and from the surface to the first, W/(m² K), at shares of ice (n,)."""
        conductivity = self.conductivity ** (1 - share) * self.frozen_conductivity**share
        half = 0.5 * self.thickness / conductivity
        return 1 / (half[1:] + half[:-1]), float(1 / half[0])


def freezing(cells: FreezingCells, start: Array, surface: Array, step: float) -> tuple[Array, Array]:
    """Temperatures, °C, and shares of frozen water (nt, n) of the cells at times 0, step, 2 step, ...

    start: (n,), °C, at the time 0. surface: (nt,), °C, temperatures that the surface is held at; within a step that
    of its end. No heat passes the bottom. Of first order in time. NaN from where Newton's method does not close.
    """
    count, n = len(surface), len(cells.thickness)
    temperatures, shares = np.empty((count, n)), np.empty((count, n))
    enthalpy = cells.enthalpy(np.asarray(start, dtype=float))
    temperatures[0], shares[0] = cells.temperature(enthalpy)[0], cells.frozen_share(enthalpy)
    weight = step / cells.thickness
    close = _CLOSE * cells.capacity
    bands = np.zeros((3, n))
    for row in range(1, count):
        before = enthalpy
        least, damping = math.inf, 1.0
        change = np.zeros(n)
        for number in range(_STEPS):
            value, slope = cells.temperature(enthalpy)
            if number <= _FOLLOWED:
                # Ice conducts better; where the search goes on for long, it does so with what conducted then.
                between, top = cells.conductances(cells.frozen_share(enthalpy))
                least = math.inf if number == _FOLLOWED else least
            diagonal = np.zeros(n)
            diagonal[:-1] += between
            diagonal[1:] += between
            diagonal[0] += top
            outflow = diagonal * value
            outflow[:-1] -= between * value[1:]
            outflow[1:] -= between * value[:-1]
            outflow[0] -= top * surface[row]
            residual = enthalpy - before + weight * outflow
            size = float(np.abs(residual / close).max())
            if size <= 1:
                break
            if size >= least and damping > _DAMPED:
                # Beyond a kink of the enthalpy: a shorter step on the same way.
                enthalpy = enthalpy + 0.5 * damping * change
                damping *= 0.5
                continue
            least, damping = size, 1.0
            bands[0, 1:] = -weight[:-1] * between * slope[1:]
            bands[1] = 1 + weight * diagonal * slope
            bands[2, :-1] = -weight[1:] * between * slope[:-1]
            change = scipy.linalg.solve_banded((1, 1), bands, residual)
            enthalpy = enthalpy - change
        else:
            temperatures[row:], shares[row:] = math.nan, math.nan
            return temperatures, shares
        temperatures[row], shares[row] = value, cells.frozen_share(enthalpy)
    return temperatures, shares


def neumann_front(
    frozen: tuple[float, float], thawed: tuple[float, float], latent: float, surface: float, ground: float
) -> float:
    """Growth of the frozen depth in a half-space below a suddenly cold surface: depth over √time, m/√s.

    frozen, thawed: conductivity, W/(m K), and capacity, J/(m³ K). latent: J/m³, > 0. surface: °C, < 0. ground: °C at
    the start, >= 0. Neumann's closed form, see the module.
    """
    (k_frozen, c_frozen), (k_thawed, c_thawed) = frozen, thawed
    a_frozen, a_thawed = k_frozen / c_frozen, k_thawed / c_thawed
    ratio = math.sqrt(a_frozen / a_thawed)

    def balance(number: float) -> float:
        cold = k_frozen * -surface / math.sqrt(a_frozen) * math.exp(-(number**2)) / math.erf(number)
        warm = (
            k_thawed * ground / math.sqrt(a_thawed) * math.exp(-((number * ratio) ** 2)) / math.erfc(number * ratio)
        )
        return cold - warm - math.sqrt(math.pi * a_frozen) * latent * number

    number = float(scipy.optimize.brentq(balance, 1e-9, 5.0 / max(ratio, 1.0), xtol=1e-14))
    return 2 * number * math.sqrt(a_frozen)
