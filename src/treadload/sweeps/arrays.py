"""The arrays of a study in a Zarr group, of numbers and of fields."""

from __future__ import annotations

import io
import json
import math
import shutil
import warnings
import zipfile
import zlib
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from treadload.deferred import xarray as xr
from treadload.errors import InputError, how_to_install
from treadload.files import write_whole
from treadload.sweeps.design import Design
from treadload.sweeps.gathered import common_axes, coordinates_of, label_of, place
from treadload.sweeps.record import Record
from treadload.sweeps.selection import attributes

# Numbers of a chunk of a field.
_CHUNK = 500_000


def zarr() -> ModuleType:
    """The library of the store. Raises InputError where it is not installed."""
    try:
        import zarr as library
    except ImportError as error:
        raise InputError(
            f"a study on disk needs zarr, which is not installed; {how_to_install('study')}, or leave out the store"
        ) from error
    return library


def write_arrays(data: xr.Dataset, path: Path) -> None:
    """Write arrays of the same shape in place, and remove those that have become another."""
    library = zarr()
    group = library.open_group(path, mode="a", zarr_format=2)
    # Coordinates alone come with nothing to say, and would take away what is said already.
    data = data if data.attrs else data.assign_attrs(dict(group.attrs))
    for folder in path.iterdir():
        # An array that was being made when its process was stopped, which no reader takes.
        if (folder / ".zarray").exists() and not _has_dimensions(folder):
            shutil.rmtree(folder)
    for name in data.variables:
        old = group.get(str(name)) if (path / str(name)).exists() else None
        wanted = np.asarray(data[name].to_numpy())
        if old is not None and (
            old.shape != wanted.shape or (old.dtype.kind in "OUT") != (wanted.dtype.kind in "OU")
        ):
            shutil.rmtree(path / str(name))
    encoding = {str(name): {"chunks": data[name].shape or None} for name in data.variables if data[name].ndim}
    fresh = {name: how for name, how in encoding.items() if not (path / name).exists()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data.to_zarr(path, mode="a", zarr_format=2, consolidated=False, encoding=fresh or None)
        # Then `xarray.open_zarr` opens it at once, and does not stumble over the journal.
        library.consolidate_metadata(path, zarr_format=2)


def _has_dimensions(folder: Path) -> bool:
    """Whether an array in a folder has the attribute by which xarray knows its dimensions."""
    try:
        return "_ARRAY_DIMENSIONS" in json.loads((folder / ".zattrs").read_text(encoding="utf-8"))
    except (OSError, ValueError, TypeError):
        return False


def keep_fields(record: Record, folder: Path) -> None:
    """Write the fields of a record to a file of their own."""
    folder.mkdir(exist_ok=True)
    values: dict[str, Any] = {f"field {name}": array for name, (_, array) in record.fields.items()}
    axes = {f"axis {dim}": values for dim, values in record.coordinates.items()}
    dims = json.dumps({name: [dims, np.shape(array)] for name, (dims, array) in record.fields.items()})
    # An archive that cannot be closed on a full disk would complain later, from nowhere.
    content = io.BytesIO()
    np.savez(content, number=np.array(record.number), dims=np.array(dims), **values, **axes)  # type: ignore[arg-type]
    write_whole(_file(folder, record.number), content.getvalue(), sync=False)


def restore_fields(
    path: Path, design: Design, solved: Sequence[int], numbers: Collection[str], folder: Path
) -> dict[int, Path]:
    """Files of cases whose fields are only in the arrays, which are made again as files. Returns them by number.

    solved: numbers of these cases. numbers: names of arrays that are no fields.
    """
    if not solved or not (path / ".zmetadata").exists():
        return {}
    group = zarr().open_group(path, mode="r", zarr_format=2)
    columns = {*numbers, "status", "seconds", *(variable.name for variable in design.inputs)}
    dims = {name: tuple(array.attrs.get("_ARRAY_DIMENSIONS", ())) for name, array in group.arrays()}
    fields_by_name = {
        name: of[len(design.dims) :] for name, of in dims.items() if of[: len(design.dims)] == design.dims
    }
    fields_by_name = {name: of for name, of in fields_by_name.items() if of and name not in columns}
    axes = {dim: np.asarray(group[dim]) for of in fields_by_name.values() for dim in of if dim in dims}
    for number in solved if fields_by_name else ():
        at = tuple(map(int, np.unravel_index(number, design.shape)))
        fields = {_name_of(name, design): (of, np.asarray(group[name][at])) for name, of in fields_by_name.items()}
        keep_fields(Record(number, 0.0, fields=fields, coordinates=axes), folder)
    return {number: _file(folder, number) for number in solved} if fields_by_name else {}


def write_fields(path: Path, design: Design, files: Mapping[int, Path]) -> list[int]:
    """Put the fields that files of cases hold into arrays over the places of all. files: by number of the case.

    Returns the numbers of cases whose file is damaged; their rows are NaN.
    """
    group = zarr().open_group(path, mode="a", zarr_format=2)
    parts = {number: _fields_of(number, file, shapes_only=True) for number, file in files.items()}
    members = [part for part in parts.values() if part is not None]
    damaged = {number for number, part in parts.items() if part is None}
    axes = common_axes(members, "fields")
    write_arrays(xr.Dataset(coords=coordinates_of(axes)), path)
    for name, dims in {name: dims for part in members for name, (dims, _) in part.fields.items()}.items():
        sizes = tuple(len(axes[dim]) for dim in dims)
        # As many neighbours along the last dimension of the design as make a chunk of a good size.
        along = max(1, min(design.shape[-1], _CHUNK // max(1, math.prod(sizes))))
        label = label_of(name, design)
        if (path / label).exists():
            shutil.rmtree(path / label)
        target = group.create_array(
            label, shape=(*design.shape, *sizes), chunks=(*([1] * (len(design.shape) - 1)), along, *sizes),
            dtype="f8", fill_value=np.nan,
            attributes={"_ARRAY_DIMENSIONS": [*design.dims, *dims], **_in_json(attributes(name))},
        )  # fmt: skip
        blocks: dict[tuple[int, ...], list[int]] = {}
        for number in files:
            *outer, last = map(int, np.unravel_index(number, design.shape))
            blocks.setdefault((*outer, last // along), []).append(number)
        for (*outer, block), numbers in blocks.items():
            start = block * along
            rows = np.full((min(along, design.shape[-1] - start), *sizes), np.nan)
            for number in numbers:
                fields = _fields_of(number, files[number])
                row = number % design.shape[-1] - start
                if fields is None:
                    damaged.add(number)
                elif name in fields.fields:
                    place(rows[row : row + 1], fields.fields[name], fields.coordinates, axes)
            target[(*outer, slice(start, start + len(rows)))] = rows
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        zarr().consolidate_metadata(path, zarr_format=2)
    return sorted(damaged)


def _name_of(label: str, design: Design) -> str:
    """The result that has a label, see `label_of`."""
    name = label.removeprefix("solved_")
    return name if label_of(name, design) == label else label


def _file(folder: Path, number: int) -> Path:
    return folder / f"{number}.npz"


def damaged_fields(files: Mapping[int, Path]) -> list[int]:
    """Numbers of cases whose file is damaged. files: by number of the case."""
    return [number for number, file in files.items() if _fields_of(number, file) is None]


def _fields_of(number: int, file: Path, *, shapes_only: bool = False) -> Record | None:
    """What a file of a case holds; None where it is damaged or another case's."""
    try:
        # What is no archive would leave a file open that numpy opens itself.
        with file.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
            if int(archive["number"]) != number:
                return None
            dims = json.loads(str(archive["dims"]))
            coordinates = {name[5:]: archive[name] for name in archive.files if name.startswith("axis ")}
            fields = {
                name: (tuple(names), np.broadcast_to(np.nan, shape) if shapes_only else archive[f"field {name}"])
                for name, (names, shape) in dims.items()
            }
    except (zipfile.BadZipFile, zlib.error, EOFError, ValueError, LookupError, TypeError, NotImplementedError,
            AttributeError, OSError, RuntimeError, MemoryError):  # fmt: skip
        return None
    return Record(number, 0.0, fields=fields, coordinates=coordinates)


def _in_json(about: Mapping[str, object]) -> dict[str, object]:
    """Attributes as Zarr keeps them, without arrays."""
    return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in about.items()}
