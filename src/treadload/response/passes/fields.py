"""The dataset of passes, and what to know of it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response.fields import COMPONENTS
from treadload.response.passes.box import Box, Course
from treadload.response.passes.stepping import Record
from treadload.response.passes.surface import surface_profile
from treadload.response.passes.verdict import CRITERION

# The program's bound of small strains.
_SMALL = 0.05


def passes_dataset(
    road: Pavement,
    among: Sequence[Course],
    box: Box,
    records: Sequence[Record],
    attrs: dict[str, object],
    by_pass: Mapping[str, Array] | None = None,
) -> xr.Dataset:
    """The dataset of `Passes`.

    among: the courses that can yield. attrs: further attributes. by_pass: more fields, one number a pass.
    """
    strain = np.array([record.strain for record in records])
    across = box.y0 + box.dy * np.arange(-box.ny, 2 * box.ny)
    profile = surface_profile(strain, box, road, across)
    dims = ("pass", "depth", "y")
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        **{f"plastic_strain_{name}": (dims, strain[:, k]) for k, name in enumerate(COMPONENTS)},
        **{
            f"residual_stress_{name}": (dims, np.array([record.residual[k] for record in records]))
            for k, name in enumerate(COMPONENTS)
        },
        "equivalent_plastic_strain": (dims, np.array([record.hardening for record in records])),
        "residual_displacement_z": (("pass", "across"), profile),
        "rut_depth": (("pass",), np.maximum(profile.max(axis=1), 0.0)),
        "heave": (("pass",), np.maximum(-profile.min(axis=1), 0.0)),
        "plastic_increment": (("pass",), np.array([record.added for record in records])),
        "plastic_left": (("pass",), np.array([record.left for record in records])),
        "wheel_offset": (("pass",), np.array([record.offset for record in records])),
        **{name: (("pass",), values) for name, values in (by_pass or {}).items()},
    }
    places = {"pass": np.array([float(record.number) for record in records]), "depth": box.depths, "y": box.y}
    laws = ", ".join(dict.fromkeys(f"{type(course.material.law).__name__}" for course in among))
    # Infinity has no place among the attributes of a file.
    finite_attrs = {
        key: value for key, value in attrs.items() if not (isinstance(value, float) and math.isinf(value))
    }
    return variables.dataset(
        fields, {**places, "across": across}, criterion=CRITERION, law=f"yields by {laws}", dx=box.dx, dy=box.dy,
        row_edges=box.edges, **finite_attrs,
    )  # fmt: skip


def cautions(road: Pavement, among: Sequence[Course], records: Sequence[Record]) -> Iterator[str]:
    """What to know of passes over a road."""
    largest = max(float(record.hardening.max()) for record in records)
    if largest > _SMALL:
        yield (
            f"the plastic strain reaches {100 * largest:.1f} %, above {100 * _SMALL:g} %: strains are taken as small "
            "here, and the rut is only a rough one"
        )
    if not road.is_homogeneous:
        yield (
            "the residual stress is that of a half-space of the yielding material; stress under the wheel and the "
            "rut are those of the layered road"
        )
    elastic = {course.material.elastic for course in among}
    if len(elastic) > 1:
        yield (
            "layers of different stiffness yield: they stress each other as rows of a half-space of the geometric "
            "mean of their moduli"
        )
