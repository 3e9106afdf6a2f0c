"""Energy ratio of top-down cracking: what a mix can dissipate before it cracks over what it must bear."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import ClassVar, overload

import numpy as np

from treadload.damage.quantities import TENSION
from treadload.damage.quantity import Quantity
from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.units import PSI

# Strength, Pa, at which the term of the tension vanishes in the regression.
_STRENGTH_LIMIT = 6.36e6
# Conventional stresses of the asphalt layer that reports use: 148 to 230 psi.
_USUAL = 148 * PSI, 230 * PSI


@dataclass(frozen=True)
class EnergyRatio:
    """ER = a DCSE_f / (m^2.98 D₁): 1 and more resists cracking from the surface down.

    creep_compliance: D₁, 1/Pa, and slope: m in (0, 1), of the creep D(t) = D₀ + D₁ t^m, t in s. strength: St, Pa, in
    tension, below 6.36 MPa. fracture_energy: FE, J/m³, to fracture. resilient_modulus: MR, Pa. All from the
    indirect tension of the mix at one temperature, by custom 10 °C.
    DCSE_f = FE - St²/(2 MR); a = 0.0299 σ^-3.10 (6.36 - St) + 2.46e-8, σ in psi, St in MPa, with D₁ in 1/psi and
    DCSE_f in kJ/m³. σ: a conventional tensile stress of the asphalt layer, the same for all mixes compared; reports
    use 148 and 150 psi (1.02, 1.03 MPa), a thesis assumes 230 psi (1.59 MPa). It is not the peak that a computed
    contact leaves at the surface, which depends on the tread and on the cells and may exceed the strength: `warnings`
    states so. Read in a thesis of the University of Florida after Roque et al. (2004). Verified by three mixes of a
    report of the Florida DOT (2013, table 4): 2.812, 4.165 and 10.973 at 148 psi, printed 2.81, 4.16 and 10.93.

    >>> mix = tl.damage.EnergyRatio(5e-11, 0.45, strength=2.0e6, fracture_energy=3000.0, resilient_modulus=9e9)
    >>> f"{float(mix.ratio(1.03e6)):.1f}"  # 1 and more resists cracking from the surface down
    '4.2'
    """

    creep_compliance: float
    slope: float
    strength: float
    fracture_energy: float
    resilient_modulus: float

    reads: ClassVar[Quantity] = TENSION
    source: ClassVar[str] = "Roque et al. (2004), as printed in a thesis of the University of Florida"
    verified: ClassVar[bool] = True
    caveat: ClassVar[str] = ""

    def __post_init__(self) -> None:
        positive("creep_compliance", self.creep_compliance, "1/Pa", "mixes are near 1e-10")
        positive("strength", self.strength, "Pa", "mixes are near 2e6")
        positive("fracture_energy", self.fracture_energy, "J/m³", "mixes are near 2000")
        positive("resilient_modulus", self.resilient_modulus, "Pa", "mixes are near 1e10")
        if not 0 < self.slope < 1:
            raise InputError(f"slope must lie in (0, 1), got {self.slope}; m is near 0.5")
        if self.strength >= _STRENGTH_LIMIT:
            raise InputError(f"strength must be below 6.36 MPa in this regression, got {self.strength / 1e6:g} MPa")
        if self.limit <= 0:
            raise InputError(
                f"the fracture energy, {self.fracture_energy:g} J/m³, must exceed the elastic energy at fracture, "
                f"St²/(2 MR) = {self.fracture_energy - self.limit:g} J/m³; check the strength and the modulus"
            )

    @property
    def limit(self) -> float:
        """DCSE_f: dissipated creep strain energy at fracture, J/m³."""
        return self.fracture_energy - self.strength**2 / (2 * self.resilient_modulus)

    def needed(self, tension: float | Array | xr.DataArray) -> Array:
        """DCSE_min = m^2.98 D₁ / a, J/m³, under a conventional tension, Pa; 0 where there is none."""
        stresses = np.asarray(tension, dtype=float)
        stress = np.where(stresses > 0, stresses, 1.0) / PSI
        a = 0.0299 * stress**-3.10 * (_STRENGTH_LIMIT - self.strength) / 1e6 + 2.46e-8
        return np.asarray(np.where(stresses > 0, 1e3 * self.slope**2.98 * self.creep_compliance * PSI / a, 0.0))

    @overload
    def ratio(self, tension: xr.DataArray) -> xr.DataArray: ...
    @overload
    def ratio(self, tension: float | Array) -> Array: ...
    def ratio(self, tension: float | Array | xr.DataArray) -> Array | xr.DataArray:
        """ER under a conventional tension, Pa, any shape; inf where there is none.

        A field keeps its coordinates, with the sentences of `warnings` in its attribute `warnings` (JSON).
        """
        needed = self.needed(tension)
        ratio: Array = np.divide(self.limit, needed, out=np.full(needed.shape, np.inf), where=needed > 0)
        if not isinstance(tension, xr.DataArray):
            return ratio
        about = {"long_name": "energy ratio", "units": "1"}
        warnings_json = json.dumps(self.warnings(tension), ensure_ascii=False)
        return tension.copy(data=ratio).rename("energy_ratio").assign_attrs(about, warnings=warnings_json)

    def of(self, data: xr.Dataset) -> xr.DataArray:
        """ER of what it reads of a response's dataset, with the sentences of `warnings`: a computed tension is not
        one that its sources use.
        """
        return self.ratio(self.reads.field(data))

    def warnings(self, tension: float | Array | xr.DataArray) -> tuple[str, ...]:
        """Sentences for the user on a tension, Pa, that the regression was not made for."""
        values = np.asarray(tension, dtype=float)
        largest = float(np.max(values, where=np.isfinite(values), initial=0.0)) / 1e6
        low, high = (bound / 1e6 for bound in _USUAL)
        remedy = f"give the conventional stress of the layer, {low:.3g} to {high:.3g} MPa in the reports"
        caveats: list[str] = []
        if largest > self.strength / 1e6:
            caveats.append(
                f"energy ratio: {largest:.3g} MPa exceeds the strength of the mix, {self.strength / 1e6:.3g} MPa; it "
                f"is a peak of a computed contact and depends on its cells: {remedy}"
            )
        elif largest > high:
            caveats.append(f"energy ratio: {largest:.3g} MPa is more than its sources use; {remedy}")
        elif isinstance(tension, xr.DataArray) and "depth" in tension.coords and (tension["depth"] == 0).any():
            caveats.append(
                f"energy ratio: the tension is that of a computed surface, {largest:.3g} MPa at most; {remedy}"
            )
        return tuple(caveats)

    def summary(self, tension: float) -> str:
        """What the mix can dissipate, what it must, their ratio, and the warnings."""
        lines = [
            f"energy ratio {float(self.ratio(tension)):.3g} under {tension / 1e6:.3g} MPa: the mix can dissipate "
            f"{self.limit:.3g} J/m³ and needs {float(self.needed(tension)):.3g} J/m³",
            *(f"warning: {text}" for text in self.warnings(tension)),
        ]
        return "\n".join(lines)
