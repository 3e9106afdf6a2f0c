"""Results as NetCDF-4 that others can open: written whole or not at all, checked when read."""

from __future__ import annotations

import os
from pathlib import Path

import xarray as xr

from treadload.errors import InputError
from treadload.files import NETCDF, check_suffix, read_tree, replacing
from treadload.results.schema import check_tree


def save(results: xr.DataTree | xr.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write results as NetCDF-4; the file appears whole or not at all. Tables: `write_csv`, `write_excel`.

    Raises InputError if the path cannot be written, or its suffix names another format.
    """
    check_suffix(path, NETCDF, "NetCDF")
    with replacing(path) as temporary:
        results.to_netcdf(temporary, engine="h5netcdf")
    return Path(path)


def load(path: str | os.PathLike[str]) -> xr.DataTree:
    """Read a tree of results into memory. Raises InputError if the file is none of ours, or broken."""
    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"there is no result file {path}; `treadload run case.toml -o {path}` makes one")
    loaded = read_tree(path, "a result in NetCDF-4")
    if "treadload_version" not in loaded.attrs:
        raise InputError(f"{path} is a NetCDF file, but no result of treadload: it lacks treadload_version")
    check_tree(loaded, str(path))
    return loaded
