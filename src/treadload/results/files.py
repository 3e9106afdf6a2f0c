"""Results as NetCDF-4 that others can open: written whole or not at all, checked when read."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from treadload._version import __version__
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.files import NETCDF, check_suffix, read_tree, remembering, write_whole
from treadload.results.opened import Results
from treadload.results.questions import renamed
from treadload.results.schema import check_tree, short
from treadload.results.tree import CF, FORMAT, as_tree


def save_results(results: Any, path: str | os.PathLike[str]) -> Path:
    """Write results as NetCDF-4; the file appears whole or not at all. Tables: `write_csv`, `write_excel`.

    results: whatever verbs give: a result, a list or a mapping of names to results, the result of a case, a tree of
    `to_tree`, results that were opened. A dataset alone is written as it is.
    Raises InputError if the path cannot be written, or its suffix names another format.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.1, 0.1, 0.01), [[1e5] * 10] * 10)
    >>> tl.save_results(tl.Footprint(load), "footprint.txt")
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: cannot write NetCDF to footprint.txt: the suffix .txt is not known, use .nc or
    .nc4 or .h5 (NetCDF)
    """
    check_suffix(path, NETCDF, "NetCDF")
    data = results if isinstance(results, xr.Dataset) else as_tree(results)
    return write_whole(path, _image(data))


def _image(data: xr.DataTree | xr.Dataset) -> bytes:
    """The bytes of a NetCDF-4 file, made in memory.

    On a full disk HDF5 ends the process while it closes its file, and so it does in a stream of Python's where memory
    ends; in memory of its own it raises MemoryError in an orderly way.
    """
    # Reading the case of a command needs neither.
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    tree = data if isinstance(data, xr.DataTree) else xr.DataTree(data)
    try:
        with remembering("memory", "w", driver="core", backing_store=False, track_order=True) as image:
            with h5netcdf.File(image, "w") as file:
                root = H5NetCDFStore(file)
                for node in tree.subtree:
                    store = root if node is tree else root.get_child_store(node.path)
                    _by_convention(node.to_dataset(inherit=node is tree), root=node is tree).dump_to_store(store)
            image.flush()
            content: bytes = image.id.get_file_image()
    except (OSError, RuntimeError) as error:
        if "memory" in str(error):
            raise MemoryError(str(error)) from error
        raise
    return content


def _by_convention(data: xr.Dataset, *, root: bool) -> xr.Dataset:
    """What CF asks of a file: no missing values of coordinates, the convention and a history."""
    data = data.copy(deep=False)
    for coordinate in data.coords.values():
        coordinate.encoding["_FillValue"] = None
    if root:
        history = f"{data.attrs.get('created', '')} written by treadload {__version__}".strip()
        data.attrs = {"Conventions": CF, "history": history, **data.attrs}
    return data


def open_results(path: str | os.PathLike[str]) -> Results:
    """Results from a file, read into memory, as the objects that were saved.

    Parts come by their names, `open_results("x.nc").contact.plot.pressure()`, and go into every verb. What no file
    can hold, the mesh of a scan or a function, raises an error that explains this when a verb needs it.
    Raises InputError if the file is not a result of treadload, is broken, or written by a later treadload.

    >>> tl.open_results("road_42.nc")
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: there is no result file road_42.nc; `treadload run case.toml -o road_42.nc`
    makes one
    """
    path = Path(path)
    if path.suffix == ".zarr" and path.is_dir():
        raise InputError(
            f"{path} is the store of a study: `treadload study report {path}` reports it, "
            f'tl.sweeps.open_sweep("{path}") opens it'
        )
    if not os.path.isfile(path):
        raise InputError(f"there is no result file {path}; `treadload run case.toml -o {path}` makes one")
    loaded = read_tree(path, "a result in NetCDF-4")
    if "treadload_version" not in loaded.attrs:
        raise InputError(f"{path} is a NetCDF file, but not a result of treadload: it lacks treadload_version")
    written = loaded.attrs.get("results_format", 1)
    if isinstance(written, bool) or not isinstance(written, int | np.integer):
        raise InputError(f"{path}: the attribute results_format must be a whole number, got {short(written)}")
    if int(written) > FORMAT:
        raise InputError(
            f"{path} was written by treadload {loaded.attrs['treadload_version']} in the format {int(written)} of "
            f"results; this is treadload {__version__}, which reads formats up to {FORMAT}: update treadload"
        )
    for part in loaded.subtree:
        part.attrs = renamed(part.attrs)
    check_tree(loaded, str(path))
    return Results(loaded, str(path))
