"""Fields that are round-off: which they are, and the sentence that stands in place of their figure."""

from __future__ import annotations

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.variables import SCALES, VARIABLES, axis_display_of

ROUND_OFF = 1e-6
"""Part of the largest value of its kind in a result below which a field is round-off.

Contacts and responses are solved to a millionth (the default tolerance of the solvers); a component that vanishes by
symmetry, or without friction, is of this size or less.
"""
_STRAINS = ("strain", "extension", "compression")
# Kinds of values that can be compared with each other: by their SI unit, dimensionless ones if they are strains.
_WORDS = {"Pa": "stress", "m": "length", "J/m^3": "energy"}


def round_off(source: Source, name: str, *, over: Source | None = None) -> str:
    """Why a field is not drawn: a sentence with its largest value and that of its kind; "" for one to be drawn.

    source: a result or its dataset. name: of one of its variables. over: the dataset whose values of this kind (all
    stresses, all strains) are the scale; left out, the source.
    """
    data = dataset_of(source)
    kind = _kind(data, name)
    largest = _largest(data[name])
    whole = dataset_of(over) if over is not None else data
    scale = max((_largest(whole[str(key)]) for key in whole.data_vars if _kind(whole, str(key)) == kind), default=0.0)
    if not kind or scale == 0 or largest >= ROUND_OFF * scale:
        return ""
    return (
        f"round-off, at most {_number(largest, name, data)}, below a millionth of the largest "
        f"{_WORDS.get(kind, kind)}, {_number(scale, name, data)}"
    )


def _kind(data: xr.Dataset, name: str) -> str:
    unit = str(data[name].attrs.get("units", VARIABLES.get(name, ("", ""))[0]))
    if unit in ("1", "") and any(part in name for part in _STRAINS):
        return "strain"
    return "" if unit in ("1", "") or not np.issubdtype(data[name].dtype, np.floating) else unit


def _largest(field: xr.DataArray) -> float:
    sizes = np.abs(field.to_numpy())
    return float(sizes[np.isfinite(sizes)].max(initial=0.0))


def _number(value: float, name: str, data: xr.Dataset) -> str:
    unit = axis_display_of(name, str(data[name].attrs.get("units", "1"))).unit
    return f"{value * SCALES.get(unit, 1.0):.2g} {unit}".strip()
