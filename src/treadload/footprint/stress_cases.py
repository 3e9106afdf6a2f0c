"""Contact stresses of the cases of a study: what of its store an interpolation between them needs."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from treadload._version import __version__
from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError, error_line
from treadload.files import parse_toml
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.units import quantity

# Inputs that an interpolation knows: their names in a call, keys and units.
INPUTS: Mapping[str, tuple[str, str]] = {
    "load": ("rolling.normal_load", "N"),
    "pressure": ("tire.inflation_pressure", "Pa"),
    "slip": ("rolling.creepage_x", ""),
}
FIELDS = ("pressure", "traction_x", "traction_y")
_REMEDY = 'solve it by tl.sweep(..., fields=["pressure", "traction_x", "traction_y"], store="set.zarr")'
_SOLVED, _FAILED = 1, 2
_LISTED = 3


@dataclass(frozen=True, eq=False)
class StressCases:
    """Solved cases of a study.

    points: (n, d) of the inputs that vary, SI, in the order of `INPUTS`. varied: their names there. fixed: name →
    value of the others. fields: (n, 3, ny, nx), Pa: pressure, traction_x, traction_y. friction: of Coulomb's law.
    rib_sides: as in `Tire`. failures: a sentence on the cases that failed, "" for none. title: of the tire.
    """

    points: Array
    varied: tuple[str, ...]
    fixed: Mapping[str, float]
    fields: Array
    grid: Grid
    friction: float
    rib_sides: str = ""
    failures: str = ""
    title: str = ""


def stress_cases(store: str | os.PathLike[str] | Source, version: str | None = None) -> StressCases:
    """The solved cases of a store. version: of treadload that wrote it, where it is not this one.

    Raises InputError for what is not a study, one of another version, one that is not finished, one without fields,
    and one that varies what an interpolation does not know.
    """
    if not isinstance(store, str | os.PathLike):
        return _cases(dataset_of(store), "the study", version)
    path = os.fspath(store)
    try:
        data = xr.open_zarr(path, chunks=None, decode_times=False)
    except (OSError, ValueError, KeyError, TypeError, ImportError) as error:
        raise InputError(f"{path} cannot be read as a Zarr store ({error_line(error)}); {_REMEDY}") from error
    with data:
        return _cases(data, path, version)


def _cases(data: xr.Dataset, name: str, version: str | None) -> StressCases:
    try:
        case = parse_toml(str(data.attrs["case"]), f"the case of {name}")
        inputs = {str(entry["key"]): str(entry["name"]) for entry in json.loads(data.attrs["design"])["inputs"]}
        written, status = str(data.attrs["treadload_version"]), data["status"]
    except (LookupError, TypeError, ValueError) as error:
        raise InputError(f"{name} is not a study of treadload: {error_line(error)}; {_REMEDY}") from error
    if written != (version or __version__):
        raise InputError(
            f"{name} was solved by treadload {written}, and {'the version given' if version else 'this'} is "
            f'{version or __version__}; solve it again, or accept it by version="{written}"'
        )
    state = status.to_numpy().ravel()
    waiting = int((~np.isin(state, (_SOLVED, _FAILED))).sum())
    if waiting:
        raise InputError(
            f"{name} is half-written: {waiting} of its {state.size} cases are not solved yet; the same tl.sweep or "
            "treadload sweep goes on in it"
        )
    lacking = [field for field in FIELDS if field not in data]
    if lacking:
        raise InputError(
            f"{name} has no {', '.join(lacking)}: the study did not keep them, or was stopped before they were "
            f"written (the same call then finishes it); {_REMEDY}"
        )
    keys = {key: word for word, (key, _) in INPUTS.items()}
    strange = [key for key in inputs if key not in keys]
    if strange:
        raise InputError(
            f"{name} varies {', '.join(strange)}, and an interpolation is over {', '.join(keys)} of one tire: fix "
            "the others in the case, in a store for each"
        )
    solved = state == _SOLVED
    dims = tuple(status.dims)
    columns = [
        np.broadcast_to(data[inputs[key]].broadcast_like(status).transpose(*dims).to_numpy(), status.shape).ravel()
        for key in keys
        if key in inputs
    ]
    grid = _grid(data, name)
    fields = np.stack(
        [data[field].transpose(*dims, "y", "x").to_numpy().reshape(-1, *grid.shape)[solved] for field in FIELDS], 1
    )
    absent = int(np.isnan(fields[:, 0]).all((1, 2)).sum())
    if absent:
        raise InputError(
            f"{name} is half-written: {absent} of its {int(solved.sum())} solved cases have no fields; the same "
            "tl.sweep or treadload sweep writes them"
        )
    varied = tuple(word for word, (key, _) in INPUTS.items() if key in inputs)
    fixed = {word: quantity(_at(case, key), unit) for word, (key, unit) in INPUTS.items()
             if word not in varied and _at(case, key) is not None}  # fmt: skip
    tire = case.get("tire")
    ribs = isinstance(tire, dict) and tire.get("tread") == "ribs"
    return StressCases(
        np.stack(columns, 1)[solved].astype(float) if columns else np.zeros((int(solved.sum()), 0)),
        varied,
        fixed,
        # Cells beyond the grid of a case carry nothing.
        np.nan_to_num(fields, nan=0.0),
        grid,
        _friction(case, name),
        "free" if ribs else "unknown",
        _failures(data, state, name),
        str(data.attrs.get("title", "")) or name,
    )


def _grid(data: xr.Dataset, name: str) -> Grid:
    """The cells of all cases together. Raises InputError unless they are one lattice."""
    steps = []
    for axis in ("x", "y"):
        differences = np.diff(data[axis].to_numpy())
        if not differences.size or np.ptp(differences) > 1e-6 * differences.min():
            raise InputError(
                f"the cells of {name} are not evenly spaced along {axis}; keep the spacing of all cases the same"
            )
        steps.append(float(differences.mean()))
    return Grid(data.sizes["x"], data.sizes["y"], steps[0], steps[1], float(data.x[0]), float(data.y[0]))


def _at(case: Mapping[str, object], key: str) -> object:
    table, _, leaf = key.partition(".")
    part = case.get(table)
    return part.get(leaf) if isinstance(part, dict) else None


def _friction(case: Mapping[str, object], name: str) -> float:
    value = _at(case, "rolling.friction")
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(
            f"{name} has the friction {value!r}, and interpolated shear is bounded by one coefficient; solve it with "
            "a number, such as friction = 0.7"
        )
    return float(value)


def _failures(data: xr.Dataset, state: Array, name: str) -> str:
    """A sentence on the cases that failed, with the first of them and their reasons."""
    failed = np.flatnonzero(state == _FAILED).tolist()
    if not failed:
        return ""
    try:
        reasons = {int(number): str(reason) for number, reason in json.loads(data.attrs["failures"])}
    except (LookupError, TypeError, ValueError):
        reasons = {}
    listed = "; ".join(f"case {number}: {reasons.get(number, 'no reason given')}" for number in failed[:_LISTED])
    more = f" and {len(failed) - _LISTED} more" if len(failed) > _LISTED else ""
    return f"{len(failed)} of {state.size} cases of {name} failed and are left out: {listed}{more}"
