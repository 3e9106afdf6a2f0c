"""From stress and strain tensors to a named dataset."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.kernels.arrays import Array
from treadload.kernels.layers.depths import on_interface, same_depth

COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
_DIMS = ("depth", "y", "x")

Fields = dict[str, tuple[tuple[str, ...], Array]]


def response_dataset(
    stress: Array,
    strain: Array,
    depths: Array,
    y: Array,
    x: Array,
    *,
    displacement: Array | None = None,
    points: bool = False,
    layers: Sequence[int] | None = None,
    **attrs: object,
) -> xr.Dataset:
    """Dataset (depth, y, x) of the tensors, the displacement, the principal strains and the invariants.

    stress: (6, nz, ny, nx), Pa, and strain: (6, nz, ny, nx), both in the order of `COMPONENTS`, tension
    positive, tensor shear. depths: (nz,), y: (ny,), x: (nx,), m. displacement: (3, nz, ny, nx), m, z down, or
    None. points: True for a list of n points, whose tensors are (6, nz, 1, n), y and x both (n,); the dataset then
    is (depth, point). layers: (nz,), number of the layer that was read at each depth. attrs: attributes of the
    dataset.
    principal_direction_1 has a last dimension `component` with labels x, y, z.
    """
    dims: tuple[str, ...] = _DIMS
    if points:
        dims = ("depth", "point")
        stress, strain = stress[:, :, 0], strain[:, :, 0]
        displacement = None if displacement is None else displacement[:, :, 0]
    values, direction = tensors.principal(strain)
    in_plane, angle = tensors.in_plane_principal(strain)
    fields: Fields = {
        **tensor_fields(stress, strain, dims),
        **{f"principal_strain_{k + 1}": (dims, values[k]) for k in range(3)},
        "principal_direction_1": ((*dims, "component"), direction),
        "in_plane_strain_1": (dims, in_plane),
        "in_plane_angle_1": (dims, angle),
        "von_mises_stress": (dims, tensors.von_mises(stress)),
        "octahedral_shear_stress": (dims, tensors.octahedral_shear(stress)),
        "mean_stress": (dims, tensors.mean(stress)),
        "mazars_strain": (dims, tensors.mazars(values)),
    }
    places: dict[str, Any] = (
        {name: ("point", values) for name, values in (("y", y), ("x", x))} if points else {"y": y, "x": x}
    )
    coordinates = {"depth": depths, **places, "component": ["x", "y", "z"]}
    if layers is not None:
        coordinates["layer"] = ("depth", np.asarray(layers))
    if displacement is not None:
        fields |= {f"displacement_{name}": (dims, part) for name, part in zip("xyz", displacement, strict=True)}
    return variables.dataset(fields, coordinates, **attrs)


def tensor_fields(stress: Array, strain: Array, dims: tuple[str, ...] = _DIMS) -> Fields:
    """The components of stress and strain (6, ...) by their names."""
    return {
        f"{tensor}_{name}": (dims, part)
        for tensor, parts in (("stress", stress), ("strain", strain))
        for name, part in zip(COMPONENTS, parts, strict=True)
    }


def layer_in_words(plane: xr.Dataset) -> str:
    """Which side of an interface a plane at one depth was read on, "bottom of GB3"; empty where it is on none.

    plane: with the coordinates depth and layer, of a dataset of `response_dataset`; without layer, or with one that
    lies beyond the interfaces, nothing is known.
    """
    ends = np.atleast_1d(np.asarray(plane.attrs.get("interfaces", []), dtype=float))
    if "layer" not in plane.coords or not len(ends) or not on_interface(float(plane["depth"]), ends)[0]:
        return ""
    number = int(plane["layer"])
    if not 0 <= number <= len(ends):
        return ""
    names = json.loads(plane.attrs.get("layer_names", "[]"))
    name = names[number] if number < len(names) and names[number] else f"layer {number + 1}"
    top = number > 0 and bool(same_depth(float(plane["depth"]), ends[number - 1]))
    return f"{'top' if top else 'bottom'} of {name}"


def direction_in_words(direction: Array) -> str:
    """A direction (3,) as its angle from travel towards the right and its tilt from the horizontal."""
    x, y, z = (float(c) for c in direction)
    tilt = np.degrees(np.arctan2(abs(z), np.hypot(x, y)))
    if tilt > 89.5:
        return "vertical"
    words = angle_in_words(float(np.arctan2(y, x)))
    return f"{words}, tilted {tilt:.0f}° from the horizontal" if tilt >= 0.5 else words


def angle_in_words(angle: float) -> str:
    """An angle from travel towards the right, rad, taken as that of a line without sense."""
    degrees = (np.degrees(angle) + 90) % 180 - 90
    if abs(degrees) < 0.5:
        return "along travel"
    if abs(degrees) > 89.5:
        return "across travel"
    return f"{abs(degrees):.0f}° from travel to the {'right' if degrees > 0 else 'left'}"


def kind_of_points(data: xr.Dataset) -> str:
    """What the points of a response are: a map, a section along or across travel, a line of the surface, a list."""
    if "point" in data.sizes:
        return "points"
    depth, y, x = (data.sizes.get(name, 1) for name in ("depth", "y", "x"))
    if depth == 1 and y == 1 and x > 1:
        return "bowl"
    if y == 1 and x > 1:
        return "slice_along"
    return "slice_across" if x == 1 and y > 1 else "response"


def number_of_depth(data: xr.Dataset, depth: float) -> int:
    """Number of a depth, m, among those of a response. Raises InputError for a depth that it does not have."""
    depths = data["depth"].to_numpy()
    nearest = int(np.argmin(np.abs(depths - depth)))
    if not same_depth(depths[nearest], depth):
        listed = ", ".join(f"{level:g}" for level in depths)
        raise InputError(f"the response has no depth {depth:g} m, it has {listed} m; solve it with that depth")
    return nearest
