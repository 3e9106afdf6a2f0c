"""Energies that criteria read: of distortion, and what viscoelastic layers dissipate; see `damage.quantities`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.citations import COMMONLY_QUOTED
from treadload.damage.quantity import Quantity, ordered
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.registry import QUANTITIES


@QUANTITIES.register("distortion_energy")
@dataclass(frozen=True)
class DistortionEnergy(Quantity):
    """Distortion energy per unit volume.

    >>> road, plate = tl.Pavement.half_space(tl.Elastic(100e6, 0.35)), tl.UniformDisc(0.15, 700e3)
    >>> response = tl.solve_response(plate, road, depths=[0.15, 0.3], x=[0.0], y=[0.0])
    >>> [f"{energy:.0f} J/m³" for energy in tl.damage.DistortionEnergy().field(response.dataset).values.ravel()]
    ['727 J/m³', '178 J/m³']
    """

    name = "distortion_energy"
    words = "distortion energy"
    unit, shown = "J/m^3", "J/m³"
    source = "Kunst"
    calibrated = "not calibrated: it ranks places, loads and mixes"

    def of(self, stress: Array, strain: Array) -> Array:
        """½ s:e of the deviators."""
        return tensors.distortion_energy(stress, strain)


@QUANTITIES.register("dissipated_energy")
@dataclass(frozen=True)
class DissipatedEnergy(Quantity):
    """Energy per unit volume that a passage of a moving wheel leaves in viscoelastic layers, the same all along x.

    >>> elastic = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> tl.damage.DissipatedEnergy().impossible_on(elastic)
    'the road is elastic and gives all energy back; give a layer a viscoelastic material'
    """

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
