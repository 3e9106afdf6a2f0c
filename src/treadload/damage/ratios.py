"""Quantities over the strength of a mix: octahedral shear over its strength, creep energy over what it can dissipate.

Both are 1 where the mix is used up, and need its data: in a case a table, in Python their arguments.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from treadload.citations import COMMONLY_QUOTED
from treadload.damage.laws.energy_ratio import EnergyRatio
from treadload.damage.quantities import HorizontalTension
from treadload.damage.quantity import STRESS, Quantity
from treadload.errors import InputError, positive
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.registry import QUANTITIES
from treadload.units import Angle, Compliance, Number, Pressure

# Beyond the end of the strength's line in tension: finite, so that readings can be interpolated.
_FAILED = 1e3


@QUANTITIES.register("octahedral_shear_ratio")
@dataclass(frozen=True)
class OctahedralRatio(Quantity):
    """Octahedral shear stress over the shear strength under the mean stress there; the mix fails at 1.

    cohesion: c, of triaxial tests at the temperature of the layer. friction_angle: φ.
    τ_oct / [2√2/(3 - sin φ) (c cos φ - p sin φ)] with the mean stress p, tension positive: Mohr and Coulomb's line of
    triaxial compression as a cone. Readings are at most 1000. Raises InputError.

    >>> road = tl.Pavement.half_space(tl.Elastic(1e9, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.1, 8e5), road, depths=[0.05], x=[0.0, 0.1], y=[0.0])
    >>> ratio = tl.damage.OctahedralRatio(cohesion=200e3, friction_angle=0.7).field(response.dataset)
    >>> [f"{value:.2f}" for value in ratio.values.ravel()]  # larger below the edge of the load than below its centre
    ['0.48', '0.58']
    """

    cohesion: Pressure
    friction_angle: Angle

    name = "octahedral_shear_ratio"
    words = "octahedral shear over the strength under the mean stress"
    source = (
        "Lytton's pair of octahedral shear and mean stress; the ratio as a criterion of design in Lazăr and Răcănel "
        f"(2017), doi:10.1515/rjti-2017-0054, and Ameri-Gaznon and Little (1990), the latter {COMMONLY_QUOTED}"
    )
    calibrated = "by triaxial tests of the mix, as a limit of one load; no law of passes was found in a source"
    needs = STRESS
    harm = "shoving, no crack"

    def __post_init__(self) -> None:
        positive("cohesion", self.cohesion, "Pa", "mixes are near 200e3 at 40 °C")
        if not 0 <= self.friction_angle < math.pi / 2:
            raise InputError(
                f"friction_angle must lie in [0, π/2) rad, got {self.friction_angle:g}; 40° is math.radians(40)"
            )

    def of(self, stress: Array, strain: Array) -> Array:
        """τ_oct over its strength."""
        sine, cosine = math.sin(self.friction_angle), math.cos(self.friction_angle)
        bears = 2 * math.sqrt(2) / (3 - sine) * (self.cohesion * cosine - sine * tensors.mean(stress))
        shear = tensors.octahedral_shear(stress)
        # Beyond the tip of the cone nothing is borne.
        with np.errstate(divide="ignore", invalid="ignore"):
            used = np.where(bears > 0, shear / bears, _FAILED)
        return np.minimum(used, _FAILED)


@dataclass(frozen=True)
class EnergyDemand(HorizontalTension):
    """Creep energy that a mix must be able to dissipate over what it can, 1/ER; at 1 and more it cracks.

    mix: with the data of the mix, see `EnergyRatio`. A crack opens across the largest horizontal tension.

    >>> mix = tl.damage.EnergyRatio(5e-11, 0.45, strength=2.0e6, fracture_energy=3000.0, resilient_modulus=9e9)
    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.3], y=[0.0])
    >>> [f"{value:.2f}" for value in tl.damage.EnergyDemand(mix).field(response.dataset).values.ravel()]
    ['0.42', '0.15']
    """

    mix: EnergyRatio

    name = "energy_ratio"
    words = "inverse energy ratio, DCSE needed over DCSE at fracture"
    unit, shown = "1", ""
    source = "Roque et al. (2004), as printed in a thesis of the University of Florida"
    calibrated = (
        f"by cracked and sound roads of Florida under a conventional stress, {COMMONLY_QUOTED}; not under a computed "
        "one"
    )

    @property
    def caveat(self) -> str:
        """That a computed stress is no conventional one."""
        return "the stress of the energy ratio is the computed one, while its sources use a conventional one"

    def of(self, stress: Array, strain: Array) -> Array:
        """DCSE_min / DCSE_f under the largest tension of the plane."""
        return self.mix.needed(super().of(stress, strain)) / self.mix.limit


@QUANTITIES.register("energy_ratio")
def energy_ratio_of(
    creep_compliance: Compliance,
    slope: Number,
    strength: Pressure,
    fracture_energy: Pressure,
    resilient_modulus: Pressure,
) -> EnergyDemand:
    """Inverse of the energy ratio of a mix under the computed tension, see `EnergyRatio`; the mix cracks at 1.

    creep_compliance: D₁. slope: m of the creep D₀ + D₁ t^m, in (0, 1). strength: St, in tension. fracture_energy: FE,
    of a volume of mix, in J/m³, which is Pa. resilient_modulus: MR. All by the indirect tension test. Raises
    InputError.
    """
    return EnergyDemand(EnergyRatio(creep_compliance, slope, strength, fracture_energy, resilient_modulus))
