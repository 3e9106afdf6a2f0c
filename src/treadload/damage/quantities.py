"""The quantities that laws and criteria read: extensions, compression on the soil, tension, equivalent strains.

Each is a word of a case and of `compute_quantities`; see `damage.quantity` for what one must provide.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import xarray as xr

from treadload.citations import COMMONLY_QUOTED
from treadload.damage.quantity import (
    BOTTOM,
    STRAIN,
    STRESS,
    SUBGRADE,
    SURFACE,
    Quantity,
    Reading,
    check_reading,
    ordered,
    part,
)
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.registry import QUANTITIES
from treadload.units import Strain

MAZARS_ONSET = 100e-6  # of asphalt: 50 to 100 microstrain, as commonly quoted


def _in_the_plane(tensor: tuple[str, ...]) -> tuple[str, ...]:
    """Names of its horizontal components."""
    return tensor[0], tensor[1], tensor[3]


def _along(angle: Array) -> Array:
    """Horizontal unit vectors (..., 3) at an angle from travel towards the right, rad."""
    return np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)


@dataclass(frozen=True)
class Extension(Quantity):
    """Largest extension; a crack opens across it.

    strain: "in-plane" reads the horizontal plane, whose cracks are vertical, "principal" space. The principal strains
    that a response brings are taken as they are. Raises InputError.

    >>> tl.damage.Extension("space")
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: strain must be "principal" or "in-plane", got 'space'
    """

    strain: Reading = "in-plane"

    words = "tensile strain"
    shown = "microstrain"
    source = "Materials 2021, 14, 2117"
    calibrated = "fatigue lines and their shifts to the road are measured for it; near the surface no law is"
    extends = True
    needs_tension = True

    def __post_init__(self) -> None:
        check_reading(self.strain)

    @property
    def name(self) -> str:  # type: ignore[override]
        """The word of the plane or of space."""
        return "extension_strain" if self.strain == "principal" else "in_plane_extension"

    @property
    def needs(self) -> tuple[str, ...]:  # type: ignore[override]
        """The strain, in the plane or in space."""
        return STRAIN if self.strain == "principal" else _in_the_plane(STRAIN)

    def with_strain(self, strain: Reading) -> Self:
        """The extension in space or in the plane."""
        return replace(self, strain=strain)

    def of(self, stress: Array, strain: Array) -> Array:
        """Largest principal strain, in space or in the plane."""
        if self.strain == "principal":
            return tensors.largest_principal(strain)
        return tensors.in_plane_principal(strain)[0]

    def normal(self, stress: Array, strain: Array) -> Array:
        """Its direction."""
        if self.strain == "principal":
            return tensors.principal(strain)[1]
        return _along(tensors.in_plane_principal(strain)[1])

    def values(self, data: xr.Dataset) -> Array:
        """As the response gives it, or from its strain."""
        name = "principal_strain_1" if self.strain == "principal" else "in_plane_strain_1"
        return part(data, name) if name in data else super().values(data)

    def crack(self, data: xr.Dataset) -> Array | None:
        """Its direction as the response gives it, or from its strain."""
        if self.strain == "principal":
            name = "principal_direction_1"
            return part(data, name) if name in data else super().crack(data)
        name = "in_plane_angle_1"
        return _along(part(data, name)) if name in data else super().crack(data)


@QUANTITIES.register("extension_strain")
def _in_space() -> Extension:
    """Largest principal strain, in space."""
    return Extension("principal")


@QUANTITIES.register("in_plane_extension")
def _in_plane() -> Extension:
    """Largest principal strain of the horizontal plane."""
    return Extension("in-plane")


@QUANTITIES.register("surface_extension")
@dataclass(frozen=True)
class SurfaceExtension(Extension):
    """Largest extension of the surface of the road. strain: "in-plane" or "principal"."""

    words = "tensile strain at the surface"
    calibrated = "MEPDG's top-down cracking reads it at points under uniform discs (as coded in ProductOneME)"
    where = SURFACE
    name = "surface_extension"


@QUANTITIES.register("bottom_extension")
@dataclass(frozen=True)
class BottomExtension(Extension):
    """Largest extension at the bottom of the asphalt. strain: "in-plane" or "principal"."""

    words = "tensile strain at the bottom of the asphalt"
    calibrated = "the French method, MEPDG, the Asphalt Institute and Shell are fitted to it"
    where = BOTTOM
    name = "bottom_extension"
    bounded = True


@QUANTITIES.register("vertical_compression")
@dataclass(frozen=True)
class VerticalCompression(Quantity):
    """Vertical strain, compression positive."""

    name = "vertical_compression"
    words = "vertical compression"
    shown = "microstrain"
    source = "laws of rutting"
    calibrated = "laws of the subgrade are fitted to it on top of the soil, nowhere else"
    needs = ("strain_zz",)
    harm = "ruts, no crack"

    def of(self, stress: Array, strain: Array) -> Array:
        """-ε_zz."""
        return np.asarray(-strain[2])


@QUANTITIES.register("subgrade_compression")
@dataclass(frozen=True)
class SubgradeCompression(VerticalCompression):
    """Vertical strain on top of the soil, compression positive.

    >>> tl.damage.SubgradeCompression().in_words(4.2e-4)
    '420 microstrain'
    """

    name = "subgrade_compression"
    words = "vertical strain on the subgrade"
    calibrated = "the French method and the Asphalt Institute are fitted to it"
    where = SUBGRADE
    bounded = True


@QUANTITIES.register("horizontal_tension")
@dataclass(frozen=True)
class HorizontalTension(Quantity):
    """Largest principal stress of the horizontal plane; a crack opens across it."""

    name = "horizontal_tension"
    words = "tensile stress"
    unit, shown = "Pa", "MPa"
    source = "Tamagny at the surface; Roque's input; laws of layers bound by cement"
    calibrated = "the French law of hydraulic layers is fitted to it at their bottom; at the surface nothing is"
    needs = _in_the_plane(STRESS)

    def of(self, stress: Array, strain: Array) -> Array:
        """Largest principal stress of the plane."""
        return tensors.in_plane_principal(stress)[0]

    def normal(self, stress: Array, strain: Array) -> Array:
        """Its direction."""
        return _along(tensors.in_plane_principal(stress)[1])


@QUANTITIES.register("principal_tension")
@dataclass(frozen=True)
class PrincipalTension(Quantity):
    """Largest principal stress in space; a crack opens across it."""

    name = "principal_tension"
    words = "principal tension"
    unit, shown = "Pa", "MPa"
    source = "strength theories of the largest tension (Rankine)"
    calibrated = "by the tensile strength of the mix, as a limit of one load; not for repeated ones"
    needs = STRESS

    def of(self, stress: Array, strain: Array) -> Array:
        """σ₁."""
        return tensors.largest_principal(stress)

    def normal(self, stress: Array, strain: Array) -> Array:
        """Its direction."""
        return tensors.principal(stress)[1]


@QUANTITIES.register("mazars_strain")
@dataclass(frozen=True)
class MazarsStrain(Quantity):
    """Mazars equivalent strain, √Σ⟨ε⟩², of the extensions alone; its crack opens across the largest of them."""

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
    """Von Mises equivalent strain, √(½ Σ (εᵢ - εⱼ)²)."""

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
    """Octahedral shear stress."""

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
    """Mean of the three normal stresses, tension positive."""

    name = "mean_stress"
    words = "mean stress"
    unit, shown = "Pa", "MPa"
    source = "Lytton, with the octahedral shear stress"
    calibrated = "not by itself: a confining stress, part of a strength"
    needs = STRESS

    def of(self, stress: Array, strain: Array) -> Array:
        """(σ_xx + σ_yy + σ_zz) / 3."""
        return tensors.mean(stress)


@QUANTITIES.register("distortion_energy")
@dataclass(frozen=True)
class DistortionEnergy(Quantity):
    """Distortion energy per unit volume."""

    name = "distortion_energy"
    words = "distortion energy"
    unit, shown = "J/m^3", "J/m³"
    source = "Kunst"
    calibrated = "not calibrated: it ranks places, loads and mixes"

    def of(self, stress: Array, strain: Array) -> Array:
        """½ s:e of the deviators."""
        return tensors.distortion_energy(stress, strain)


@QUANTITIES.register("vertical_shear_strain")
@dataclass(frozen=True)
class VerticalShear(Quantity):
    """Largest engineering shear strain between the vertical and the horizontal."""

    name = "vertical_shear_strain"
    words = "vertical shear strain"
    shown = "microstrain"
    source = "Yoo"
    calibrated = "not calibrated: it ranks tires and depths near their edges"
    needs = STRAIN

    def of(self, stress: Array, strain: Array) -> Array:
        """2 √(ε_xz² + ε_yz²)."""
        return tensors.vertical_shear(strain)


@QUANTITIES.register("dissipated_energy")
@dataclass(frozen=True)
class DissipatedEnergy(Quantity):
    """Energy per unit volume that a passage of a moving wheel leaves in viscoelastic layers, the same all along x."""

    name = "dissipated_energy"
    words = "dissipated energy"
    unit, shown = "J/m^3", "J/m³"
    source = "responses of moving wheels"
    calibrated = f"laboratories relate its sum to failure, W = A N^z, mix by mix, {COMMONLY_QUOTED}; no number here"
    needs = ("dissipated_energy",)
    remedy = "solve a moving wheel on a viscoelastic road"

    def impossible_on(self, road: Pavement) -> str:
        """An elastic road gives all energy back; a road without a temperature is not decided yet."""
        if any(layer.depends_on_temperature for layer in road.layers) or road.is_viscoelastic:
            return ""
        return "the road is elastic and gives all energy back; give a layer a viscoelastic material"

    def of(self, stress: Array, strain: Array) -> Array:
        """Not given by the stress and strain of an instant: raises InputError."""
        raise InputError("stress and strain do not give the dissipated energy; read it from a response")

    def values(self, data: xr.Dataset) -> Array:
        """What the response gives, at every x."""
        self.check(data)
        energy, dims = data[self.name], ordered(data)
        whole = energy.expand_dims({dim: data.sizes[dim] for dim in dims if dim not in energy.dims})
        return np.asarray(whole.transpose(*dims).to_numpy())

    def crack(self, data: xr.Dataset) -> None:
        """None: energy has no direction."""

    def field(self, data: xr.Dataset) -> xr.DataArray:
        """What the response gives, over (depth, y)."""
        self.check(data)
        return data[self.name]


EXTENSION = Extension()
SURFACE_EXTENSION = SurfaceExtension()
BOTTOM_EXTENSION = BottomExtension()
SUBGRADE_COMPRESSION = SubgradeCompression()
TENSION = HorizontalTension()
