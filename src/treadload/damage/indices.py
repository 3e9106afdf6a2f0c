"""Indices of what a passage does to the surface besides cracking it: rutting near the surface, ravelling, polishing.

They rank tires, maneuvers, temperatures and layers. One of them is calibrated, the permanent strain of asphalt; the
energy and the works are not: no source that was read ties them to a rut, to stones lost or to friction lost.
"""

from __future__ import annotations

import itertools
import json

import numpy as np

from treadload import variables
from treadload.composing import Source, dataset_of
from treadload.damage.cracks import gridded
from treadload.damage.energies import DistortionEnergy
from treadload.damage.quantities import VerticalCompression
from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials import PassesPowerLaw
from treadload.pavement import Pavement, bituminous_thickness

TEXTURE_DEPTH = 1e-3
"""Texture depth of a wearing course, m: a sand patch finds 0.5 to 1.5 mm on a usual asphalt, as commonly quoted, not
checked against the source."""

NO_WORK = 1e-8
"""Works below it are none, J/m²: shear of some 0.1 kPa, a few ten-thousandths of μp, and the slip of as little, which
a solution to its tolerance leaves of a wheel that rolls freely."""

_INCH = 0.0254
_FEWEST = 3
_CAVEATS = (
    "its factor of depth was read in a public program, not in a document; the ratio itself is the national "
    "calibration of NCHRP 1-37A (2004) for strain at points under uniform discs"
)


def polishing_work(contact: Source) -> xr.DataArray:
    """Work of sliding that a passage leaves on the road, J/m² of it, over y: what polishes stones and wears the tire.

    contact: of a rolling wheel, with friction_work over (y, x). Its sum over the width is friction_work_total. Not
    calibrated: polishing tests relate friction lost to the number of passes of their own rubber, not to this work.
    Raises InputError for a contact that does not slide along.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> wheel = tl.Rolling(normal_load=100.0, friction=0.7, tractive_force=-35.0)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> work = tl.damage.polishing_work(contact)
    >>> f"{work.max().item():.2f} J/m² below the middle of the tire"
    '6.51 J/m² below the middle of the tire'
    """
    data = dataset_of(contact)
    if "friction_work" not in data:
        raise InputError("the work of polishing needs friction_work, which the contact lacks; give one that rolls")
    return _over(
        data["friction_work"].transpose("y", "x").to_numpy().sum(axis=1) * _step(data), data, "polishing_work"
    )


def tearing_work(contact: Source, shear_modulus: float, *, texture_depth: float = TEXTURE_DEPTH) -> xr.DataArray:
    """Largest elastic work of a passage's shear in a skin as deep as the texture, J/m², over y: it loosens stones.

    q² t / (2 G) of the largest shear q that each strip of road meets: the work in a ring of mortar of the texture's
    depth t around the stones, which nothing holds at its sides. contact: with traction_x, traction_y. shear_modulus:
    G of the mix at its temperature, Pa. texture_depth: t, m. Not calibrated: it ranks maneuvers and temperatures.
    Raises InputError.

    >>> recorded = tl.response.GridLoad.from_arrays([[400e3, 800e3, 400e3]], [[50e3, 200e3, 100e3]], spacing=0.05)
    >>> work = tl.damage.tearing_work(tl.Footprint(recorded), shear_modulus=40e6)
    >>> f"{work.item():.2f} J/m²"
    '0.50 J/m²'
    """
    positive("shear_modulus", shear_modulus, "Pa", "asphalt is near 2e9 at 15 °C")
    positive("texture_depth", texture_depth, "metres", "1 mm is 0.001")
    if texture_depth > 0.02:
        raise InputError(f"texture_depth must be in m, at most 0.02, got {texture_depth:g}; 1 mm is 0.001")
    data = dataset_of(contact)
    missing = [name for name in ("traction_x", "traction_y") if name not in data]
    if missing:
        raise InputError(f"the work of tearing needs {missing[0]}, which the contact lacks; give a computed contact")
    shear = np.hypot(*(data[name].transpose("y", "x").to_numpy() for name in ("traction_x", "traction_y"))).max(
        axis=1
    )
    return _over(shear**2 * texture_depth / (2 * shear_modulus), data, "tearing_work")


def distortion_work(response: Source, road: Pavement) -> xr.DataArray:
    """Shear-strain energy that a passage puts into each layer below a strip of road, J/m², over (layer, y).

    The largest distortion energy along x at every depth, integrated over the depths of the response that lie in the
    layer, by trapezoids: it should have several in each, from top to bottom. response: on a grid, from above at
    interfaces. Layers with fewer than two depths are NaN. Not calibrated: elastic energy is given back; a rut grows
    with a small part of it. Raises InputError.

    >>> asphalt, soil = tl.Elastic(2e9, 0.35), tl.Elastic(60e6, 0.4)
    >>> road = tl.Pavement([tl.Layer(asphalt, 0.06), tl.Layer(asphalt, 0.12), tl.Layer(soil)])
    >>> depths = [0.0, 0.02, 0.04, 0.06, 0.09, 0.12, 0.15, 0.18]
    >>> response = tl.solve_response(tl.UniformDisc(0.125, 8e5), road, depths=depths, x=[-0.1, 0.0, 0.1], y=[0.0])
    >>> [f"{work:.0f} J/m²" for work in tl.damage.distortion_work(response, road).values.ravel()[:2]]
    ['3 J/m²', '12 J/m²']
    """
    data = gridded(response)
    depths, energy = data["depth"].to_numpy(), DistortionEnergy().values(data).max(axis=-1)
    edges = np.concatenate([[0.0], road.interfaces, [np.inf]])
    rows = []
    for top, bottom in itertools.pairwise(edges):
        # A depth at an interface is read from above: it belongs to the layer that ends there.
        within = (depths > top) & (depths <= bottom) | (depths == 0.0) & (top == 0.0)
        whole = (
            np.trapezoid(energy[within], depths[within], axis=0)
            if within.sum() > 1
            else np.full(energy.shape[1], np.nan)
        )
        rows.append(whole)
    places = {"layer": np.arange(len(rows)), "y": data["y"].to_numpy()}
    return variables.dataset({"distortion_work": (("layer", "y"), np.array(rows))}, places)["distortion_work"]


def asphalt_rut(
    response: Source, road: Pavement, temperature: float, passes: float, *, thickness: float | None = None
) -> xr.DataArray:
    """Rut of all asphalt after passes of one load in one track, m, over y: the calibrated one.

    Σ ε_r k_z 10^-3.35412 T^1.5606 N^0.4791 dz over the depths of the response in the asphalt: ε_r the largest
    vertical compression along x, T the temperature, °C in [5, 65] here and °F in the formula, N the passes, > 0.
    k_z = (C₁ + C₂ z) 0.328196^z, C₁ = -0.1039 h² + 2.4868 h - 17.342, C₂ = 0.0172 h² - 1.7331 h + 27.428, z and the
    thickness h of all asphalt in inches, at least 0. thickness: h, m; left out, that of the bituminous layers.
    The attribute `warnings` has its caveat. Raises InputError.
    Source: NCHRP 1-37A (2004), part 3, chapter 3; k_z as coded in ProductOneME (commit c89fe2b).

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(2e9, 0.35), 0.2), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> depths = [0.0, 0.03, 0.06, 0.09, 0.12, 0.16, 0.2]
    >>> response = tl.solve_response(tl.UniformDisc(0.125, 662e3), road, depths=depths, x=[0.0], y=[0.0])
    >>> rut = tl.damage.asphalt_rut(response, road, temperature=30.0, passes=1e6, thickness=0.2)
    >>> f"{rut.item() * 1e3:.0f} mm"
    '9 mm'
    """
    positive("passes", passes, remedy="a rut needs at least one")
    law = PassesPowerLaw.asphalt(temperature)
    data = gridded(response)
    whole = bituminous_thickness(road, 0) if thickness is None else thickness
    positive("thickness", whole, "metres", "21 cm is 0.21")
    depths = data["depth"].to_numpy()
    within = depths <= whole * (1 + 1e-9)
    if within.sum() < _FEWEST:
        raise InputError(
            f"the rut needs the response at {_FEWEST} depths or more in the {1e3 * whole:g} mm of asphalt, got "
            f"{within.sum()}; solve it with more, from the surface to the bottom"
        )
    strain = np.maximum(VerticalCompression().values(data).max(axis=-1)[within], 0.0)
    factor = depth_factor(depths[within], whole) * law.factor * passes**law.exponent
    rut = np.trapezoid(strain * factor[:, None], depths[within], axis=0)
    field = _over(rut, data, "asphalt_rut")
    return field.assign_attrs(warnings=json.dumps([f"rut of the asphalt: {_CAVEATS}"], ensure_ascii=False))


def depth_factor(depth: Array, thickness: float) -> Array:
    """k_z of the permanent strain of asphalt, see `asphalt_rut`, at depths, m, in asphalt of a thickness, m."""
    z, h = np.asarray(depth) / _INCH, thickness / _INCH
    first = -0.1039 * h**2 + 2.4868 * h - 17.342
    second = 0.0172 * h**2 - 1.7331 * h + 27.428
    return np.asarray(np.maximum((first + second * z) * 0.328196**z, 0.0))


def _step(data: xr.Dataset) -> float:
    x = data["x"].to_numpy()
    return float(x[1] - x[0])


def _over(values: Array, data: xr.Dataset, name: str) -> xr.DataArray:
    return variables.dataset({name: (("y",), values)}, {"y": data["y"].to_numpy()})[name]
