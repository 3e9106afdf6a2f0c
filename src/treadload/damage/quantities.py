"""The quantities that laws and criteria read: extensions, compression on the soil, tension, equivalent strains.

Each is a word of a case and of `compute_quantities`; see `damage.quantity` for what one must provide.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from treadload.damage.quantity import (
    BOTTOM,
    STRAIN,
    STRESS,
    SUBGRADE,
    SURFACE,
    Quantity,
    Reading,
    check_reading,
    part,
)
from treadload.deferred import xarray as xr
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.registry import QUANTITIES


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
    """Largest extension of the surface of the road. strain: "in-plane" or "principal".

    >>> road, plate = tl.Pavement.half_space(tl.Elastic(1e9, 0.35)), tl.UniformDisc(0.1, 8e5)
    >>> response = tl.solve_response(plate, road, depths=[0.0], x=[0.0, 0.15], y=[0.0])
    >>> strains = tl.damage.SurfaceExtension().field(response.dataset)
    >>> [f"{strain * 1e6:.0f} microstrain" for strain in strains.values.ravel()]  # below and beside the load
    ['-162 microstrain', '72 microstrain']
    """

    words = "tensile strain at the surface"
    calibrated = "MEPDG's top-down cracking reads it at points under uniform discs (as coded in ProductOneME)"
    where = SURFACE
    name = "surface_extension"


@QUANTITIES.register("bottom_extension")
@dataclass(frozen=True)
class BottomExtension(Extension):
    """Largest extension at the bottom of the asphalt. strain: "in-plane" or "principal".

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0], y=[0.0])
    >>> f"{tl.damage.BottomExtension().field(response.dataset).item() * 1e6:.0f} microstrain"
    '269 microstrain'
    """

    words = "tensile strain at the bottom of the asphalt"
    calibrated = "the French method, MEPDG, the Asphalt Institute and Shell are fitted to it"
    where = BOTTOM
    name = "bottom_extension"
    bounded = True


@QUANTITIES.register("vertical_compression")
@dataclass(frozen=True)
class VerticalCompression(Quantity):
    """Vertical strain, compression positive.

    >>> road, plate = tl.Pavement.half_space(tl.Elastic(100e6, 0.35)), tl.UniformDisc(0.15, 700e3)
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=[0.0], y=[0.0])
    >>> f"{tl.damage.VerticalCompression().field(response.dataset).item() * 1e6:.0f} microstrain"
    '4171 microstrain'
    """

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
    """Largest principal stress of the horizontal plane; a crack opens across it.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(15e9, 0.25), 0.2), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.2], x=[0.0], y=[0.0])
    >>> f"{tl.damage.HorizontalTension().field(response.dataset).item() / 1e6:.2f} MPa at the bottom of the base"
    '1.55 MPa at the bottom of the base'
    """

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
    """Largest principal stress in space; a crack opens across it.

    >>> road, plate = tl.Pavement.half_space(tl.Elastic(1e9, 0.35)), tl.UniformDisc(0.1, 8e5)
    >>> response = tl.solve_response(plate, road, depths=[0.0], x=[0.0, 0.11], y=[0.0])
    >>> tensions = tl.damage.PrincipalTension().field(response.dataset)
    >>> [f"{tension / 1e3:.0f} kPa" for tension in tensions.values.ravel()]  # below and beside the load
    ['-680 kPa', '99 kPa']
    """

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


@QUANTITIES.register("vertical_shear_strain")
@dataclass(frozen=True)
class VerticalShear(Quantity):
    """Largest engineering shear strain between the vertical and the horizontal.

    >>> import numpy as np
    >>> strain = np.array([0.0, 0.0, 0.0, 0.0, 30e-6, 40e-6])  # zz, and half the engineering strains in xz and yz
    >>> f"{tl.damage.VerticalShear().of(strain, strain) * 1e6:.0f} microstrain: 2 √(30² + 40²)"
    '100 microstrain: 2 √(30² + 40²)'
    """

    name = "vertical_shear_strain"
    words = "vertical shear strain"
    shown = "microstrain"
    source = "Yoo"
    calibrated = "not calibrated: it ranks tires and depths near their edges"
    needs = STRAIN

    def of(self, stress: Array, strain: Array) -> Array:
        """2 √(ε_xz² + ε_yz²)."""
        return tensors.vertical_shear(strain)


EXTENSION = Extension()
SURFACE_EXTENSION = SurfaceExtension()
BOTTOM_EXTENSION = BottomExtension()
SUBGRADE_COMPRESSION = SubgradeCompression()
TENSION = HorizontalTension()
