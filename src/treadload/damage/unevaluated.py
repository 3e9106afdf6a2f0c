"""What an assessment leaves out: bright spots of the map that its law does not evaluate, bottoms without a depth."""

from __future__ import annotations

import numpy as np

from treadload.composing import Source
from treadload.damage.cracks import gridded
from treadload.damage.quantity import STRAIN, STRESS, Reading, in_tension
from treadload.deferred import xarray as xr
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.kernels.layers.depths import same_depth
from treadload.materials import AtStress
from treadload.response import Response
from treadload.response.fields import direction_in_words, layer_in_words
from treadload.response.means import cells_of
from treadload.response.several import Question, tensors_of_many

# A strain of the map this many times the evaluated one is worth a sentence.
_NOTABLE = 1.1
# Points each way at the bottoms of layers, where fields are smooth, and strain there that is worth a sentence.
_POINTS, _STRAIN = 12, 1e-6


def bright_spot(response: Source, strain_of: Reading, evaluated: float, mean_over: float | None) -> list[str]:
    """Why the largest strain of a map is not what an assessment evaluates: a sentence, or none where the two agree.

    strain_of: which strain it evaluates. evaluated: that of the worst point, 0 where no crack opens.
    mean_over: side of the cubes over which means are evaluated, m; None for points.
    """
    data = gridded(response)
    if "mean_over" in data.attrs:
        return []
    strain = data.variables["principal_strain_1"].transpose("depth", "y", "x").to_numpy()
    row, j, i = index_of_largest(strain)
    most = float(strain[row, j, i])
    if not most > _NOTABLE * max(evaluated, 0.0) or most < _STRAIN:
        return []
    plane = data[["principal_direction_1"]].isel(depth=row)
    side = layer_in_words(plane)
    depth = f"depth {1e3 * float(plane['depth']):g} mm{f' ({side})' if side else ''}"
    way = direction_in_words(plane["principal_direction_1"].isel(y=j, x=i).to_numpy())
    if not in_tension(data[[name for name in STRESS if name in data]].isel(depth=[row], y=[j], x=[i])).all():
        why = "no principal stress is tensile there, so that this criterion does not evaluate it"
    elif "layer" in data.coords and int(plane["layer"]) > 0 and mean_over is not None:
        why = "it lies below the top layer, which this criterion evaluates"
    elif mean_over is not None:
        why = f"this criterion evaluates the {_kind(strain_of)} as means over {1e3 * mean_over:g} mm"
    else:
        why = f"this criterion evaluates the {_kind(strain_of)} at another depth or in another direction"
    return [
        f"the largest principal strain of the map, {most * 1e6:.3g} microstrain at "
        f"x = {1e3 * float(data['x'][i]):.0f} mm, y = {1e3 * float(data['y'][j]):.0f} mm, {depth}, "
        f"is {_along(way)}: {why}"
    ]


def bottoms_without_depth(response: Source) -> list[str]:
    """Bottoms of layers in tension at which a response has no depth, each with its strain and what to add; sentences.

    Elastic layers alone, solved on few points under the loads of the response. Stress-dependent ones are unbound: no
    law reads their tension.
    """
    if not isinstance(response, Response) or response.road is None or response.road.is_viscoelastic:
        return []
    data, road = gridded(response), response.road
    depths = data["depth"].to_numpy()
    missing = [
        k
        for k, z in enumerate(road.interfaces)
        if not (isinstance(road.layers[k].material, AtStress) or same_depth(depths, float(z)).any())
    ]
    if not missing or "mean_over" in data.attrs:
        return []
    at = {name: _thinned(data[name].to_numpy()) for name in ("x", "y")}
    question = Question(cells_of(response.loads), road, road.interfaces[missing])
    solved = tensors_of_many([question], at["x"], at["y"], needs=(*STRESS, *STRAIN), speed=response.speed)
    assert solved is not None
    warnings = []
    for row, k in enumerate(missing):
        strain = _tensile_strain(solved[0].isel(depth=[row]))
        if strain < _STRAIN:
            continue
        z = 1e3 * float(road.interfaces[k])
        name = road.layers[k].name or f"layer {k + 1}"
        warnings.append(
            f"the bottom of {name} at {z:g} mm is in tension, with a horizontal strain of about "
            f'{strain * 1e6:.2g} microstrain, and no depth covers it; add "{z:g} mm" to depths'
            + ("" if k == 0 else ", and assess it with the law of its layer")
        )
    return warnings


def _tensile_strain(data: xr.Dataset) -> float:
    """The largest horizontal strain where a horizontal stress is tensile; 0 without."""
    stress, strain = (np.stack([data[name].to_numpy() for name in names]) for names in (STRESS, STRAIN))
    values = np.where(tensors.in_plane_principal(stress)[0] > 0, tensors.in_plane_principal(strain)[0], 0.0)
    return float(values.max())


def _thinned(at: Array) -> Array:
    """Coordinates from the first to the last, few of them."""
    return at if len(at) <= _POINTS else np.linspace(at.min(), at.max(), _POINTS)


def _kind(strain: Reading) -> str:
    return "in-plane strain" if strain == "in-plane" else "largest principal strain"


def _along(way: str) -> str:
    return "vertical expansion" if way == "vertical" else f"directed {way}"
