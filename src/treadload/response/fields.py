"""From stress and strain tensors to a named dataset."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from treadload import variables
from treadload.kernels import tensors
from treadload.kernels.arrays import Array

COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
_DIMS = ("depth", "y", "x")


def response_dataset(
    stress: Array,
    strain: Array,
    depths: Array,
    y: Array,
    x: Array,
    *,
    displacement: Array | None = None,
    **attrs: Any,
) -> xr.Dataset:
    """Dataset (depth, y, x) of the tensors, the displacement, the principal strains and the invariants.

    stress: (6, nz, ny, nx), Pa, and strain: (6, nz, ny, nx), both in the order of `COMPONENTS`, tension
    positive, tensor shear. depths: (nz,), y: (ny,), x: (nx,), m. displacement: (3, nz, ny, nx), m, z down, or
    None. attrs: attributes of the dataset.
    principal_direction_1 has a last dimension `component` with labels x, y, z.
    """
    values, direction = tensors.principal(strain)
    in_plane, angle = tensors.in_plane_principal(strain)
    fields: dict[str, tuple[tuple[str, ...], Array]] = {
        **{f"stress_{name}": (_DIMS, part) for name, part in zip(COMPONENTS, stress, strict=True)},
        **{f"strain_{name}": (_DIMS, part) for name, part in zip(COMPONENTS, strain, strict=True)},
        **{f"principal_strain_{k + 1}": (_DIMS, values[k]) for k in range(3)},
        "principal_direction_1": ((*_DIMS, "component"), direction),
        "in_plane_strain_1": (_DIMS, in_plane),
        "in_plane_angle_1": (_DIMS, angle),
        "von_mises_stress": (_DIMS, tensors.von_mises(stress)),
        "octahedral_shear_stress": (_DIMS, tensors.octahedral_shear(stress)),
        "mean_stress": (_DIMS, tensors.mean(stress)),
        "mazars_strain": (_DIMS, tensors.mazars(values)),
    }
    coordinates = {"depth": depths, "y": y, "x": x, "component": ["x", "y", "z"]}
    if displacement is not None:
        fields |= {f"displacement_{name}": (_DIMS, part) for name, part in zip("xyz", displacement, strict=True)}
    return variables.dataset(fields, coordinates, **attrs)


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
