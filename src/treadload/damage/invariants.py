"""Quantities by invariants of stress and strain: equivalent strains, octahedral shear, mean stress.

See `damage.quantities` for those that have a direction.
"""

from __future__ import annotations

from dataclasses import dataclass

from treadload.citations import COMMONLY_QUOTED
from treadload.damage.quantity import STRAIN, STRESS, Quantity
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.registry import QUANTITIES
from treadload.units import Strain

MAZARS_ONSET = 100e-6  # of asphalt: 50 to 100 microstrain, as commonly quoted


@QUANTITIES.register("mazars_strain")
@dataclass(frozen=True)
class MazarsStrain(Quantity):
    """Mazars equivalent strain, √Σ⟨ε⟩², of the extensions alone; its crack opens across the largest of them.

    >>> import numpy as np
    >>> strain = np.array([100e-6, 75e-6, -90e-6, 0.0, 0.0, 0.0])  # xx, yy, zz and the shears
    >>> f"{tl.damage.MazarsStrain().of(strain, strain) * 1e6:.0f} microstrain: √(100² + 75²)"
    '125 microstrain: √(100² + 75²)'
    """

    name = "mazars_strain"
    words = "Mazars equivalent strain"
    shown = "microstrain"
    source = "Mazars (1986), Eng. Fract. Mech. 25"
    calibrated = "for concrete; for asphalt neither the onset nor a law of passes was found in a source"
    needs = STRAIN
    needs_tension = True

    def of(self, stress: Array, strain: Array) -> Array:
        """√Σ⟨ε⟩²."""
        return tensors.mazars(tensors.principal_values(strain))

    def normal(self, stress: Array, strain: Array) -> Array:
        """The direction of the largest extension."""
        return tensors.principal(strain)[1]


@QUANTITIES.register("mazars_onset_ratio")
@dataclass(frozen=True)
class MazarsOnset(MazarsStrain):
    """Mazars equivalent strain over the strain at which damage begins.

    onset: that strain, 50 to 100 microstrain as commonly quoted, not checked against the source. Raises InputError.

    >>> import numpy as np
    >>> strain = np.array([100e-6, 75e-6, -90e-6, 0.0, 0.0, 0.0])  # xx, yy, zz and the shears
    >>> f"{tl.damage.MazarsOnset(onset=50e-6).of(strain, strain):.1f} times the strain at which damage begins"
    '2.5 times the strain at which damage begins'
    """

    onset: Strain = MAZARS_ONSET

    name = "mazars_onset_ratio"
    words = "Mazars equivalent strain over that at which damage begins"
    shown = ""

    def __post_init__(self) -> None:
        if not 0 < self.onset < 0.01:
            raise InputError(f"mazars_onset must be a plain strain in (0, 0.01), got {self.onset}; 100e-6 is usual")

    @property
    def caveat(self) -> str:
        """The onset, where it is ours."""
        return f"the strain at which damage begins is {COMMONLY_QUOTED}" if self.onset == MAZARS_ONSET else ""

    def of(self, stress: Array, strain: Array) -> Array:
        """√Σ⟨ε⟩² over the onset."""
        return super().of(stress, strain) / self.onset


@QUANTITIES.register("von_mises_strain")
@dataclass(frozen=True)
class VonMisesStrain(Quantity):
    """Von Mises equivalent strain, √(½ Σ (εᵢ - εⱼ)²).

    >>> import numpy as np
    >>> pulled = np.array([100e-6, -35e-6, -35e-6, 0.0, 0.0, 0.0])  # strain by tension along x, ν = 0.35
    >>> f"{tl.damage.VonMisesStrain().of(pulled, pulled) * 1e6:.0f} microstrain: (1 + ν) times the tensile strain"
    '135 microstrain: (1 + ν) times the tensile strain'
    """

    name = "von_mises_strain"
    words = "von Mises equivalent strain"
    shown = "microstrain"
    source = "Sousa; the strain of a four-point beam test stands for (1 + ν) times itself"
    calibrated = "by beam tests through that factor; not on roads"
    needs = STRAIN

    def of(self, stress: Array, strain: Array) -> Array:
        """√(½ Σ (εᵢ - εⱼ)²)."""
        return tensors.von_mises(strain)


@QUANTITIES.register("octahedral_shear_stress")
@dataclass(frozen=True)
class OctahedralShear(Quantity):
    """Octahedral shear stress.

    >>> import numpy as np
    >>> stress = np.array([-300e3, -300e3, -900e3, 0.0, 0.0, 0.0])  # Pa, as in a triaxial test
    >>> f"{tl.damage.OctahedralShear().of(stress, stress) / 1e3:.0f} kPa: √2/3 of the difference of 600 kPa"
    '283 kPa: √2/3 of the difference of 600 kPa'
    """

    name = "octahedral_shear_stress"
    words = "octahedral shear stress"
    unit, shown = "Pa", "MPa"
    source = "Lytton, with the mean stress"
    calibrated = "together with the mean stress, as the octahedral shear over its strength; alone it is not"
    needs = STRESS

    def of(self, stress: Array, strain: Array) -> Array:
        """√((σ₁-σ₂)² + (σ₂-σ₃)² + (σ₃-σ₁)²) / 3."""
        return tensors.octahedral_shear(stress)


@QUANTITIES.register("mean_stress")
@dataclass(frozen=True)
class MeanStress(Quantity):
    """Mean of the three normal stresses, tension positive.

    >>> import numpy as np
    >>> stress = np.array([-300e3, -300e3, -900e3, 0.0, 0.0, 0.0])  # Pa, as in a triaxial test
    >>> f"{tl.damage.MeanStress().of(stress, stress) / 1e3:.0f} kPa"
    '-500 kPa'
    """

    name = "mean_stress"
    words = "mean stress"
    unit, shown = "Pa", "MPa"
    source = "Lytton, with the octahedral shear stress"
    calibrated = "not by itself: a confining stress, part of a strength"
    needs = STRESS

    def of(self, stress: Array, strain: Array) -> Array:
        """(σ_xx + σ_yy + σ_zz) / 3."""
        return tensors.mean(stress)
