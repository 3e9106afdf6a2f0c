"""Files appear whole or not at all, and are read whole."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
import tomllib
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from treadload.errors import InputError, one_line

if TYPE_CHECKING:
    import xarray as xr

# Tables in tables that a file may hold.
_DEEPEST = 60
# What xarray says, and goes on, of a variable that has a dimension twice.
_TWICE = "Duplicate dimension names"
# Suffixes, and what a file of that name holds.
NETCDF = {".nc": "NetCDF", ".nc4": "NetCDF", ".h5": "NetCDF"}
TABLE = {".csv": "tables"}
EXCEL = {".xlsx": "an Excel workbook"}
PARQUET = {".parquet": "Parquet"}
HTML = {".html": "a page", ".htm": "a page"}


def check_suffix(path: str | os.PathLike[str], known: Mapping[str, str], what: str) -> str:
    """The suffix of a path in small letters, if it is a known one, so that a file holds what its name says.

    known: suffixes and what they mean. what: is to be written, for the error. Raises InputError.
    """
    _check_no_folder(Path(path))
    suffix = Path(path).suffix.lower()
    if suffix not in known:
        means = {meaning: [one for one in known if known[one] == meaning] for meaning in known.values()}
        listed = ", ".join(f"{' or '.join(names)} ({meaning})" for meaning, names in means.items())
        said = f"the suffix {suffix} is not known" if suffix else "its name has no suffix"
        pdf = "; for a PDF print the page of `treadload report` from a browser" if suffix == ".pdf" else ""
        raise InputError(f"cannot write {what} to {os.fspath(path)}: {said}, use {listed}{pdf}")
    return suffix


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raise InputError now if a file at `path` could not be written later."""
    _temporary(Path(path)).unlink()


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path beside `path` that takes its place when the block ends well, and goes otherwise.

    Raises InputError if the folder does not exist or cannot be written.
    """
    path = Path(path)
    temporary = _temporary(path)
    try:
        yield temporary
        # mkstemp makes private files; a result is as open as any other file of the user.
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)
        temporary.replace(path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def text_of(path: str | os.PathLike[str], wanted: str) -> str:
    """The text of a file in UTF-8. wanted: what to give in place of one that is none. Raises InputError."""
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot read {os.fspath(path)}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise InputError(
            f"{os.fspath(path)} is not a text file in UTF-8 (byte {error.start}); give {wanted}"
        ) from error


def parse_toml(text: str, name: str) -> dict[str, Any]:
    """The tables of a TOML text. name: of the file, for the error. Raises InputError."""
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{name} is not valid TOML: {error}") from error
    except ValueError as error:
        # The only other error of Python's reader: whole numbers beyond what it converts.
        most = sys.get_int_max_str_digits()
        raise InputError(f"{name} holds a whole number of more than {most} digits") from error
    except RecursionError as error:
        raise InputError(f"{name} holds lists or tables too deep in each other to be read") from error
    layer: list[Any] = [table]
    for _ in range(_DEEPEST):
        inner = [one.values() if isinstance(one, dict) else one for one in layer]
        layer = [value for values in inner for value in values if isinstance(value, dict | list)]
    # Dotted keys go as deep as they are long, and what copies or writes tables calls itself once a level.
    if layer:
        raise InputError(f"{name} holds lists or tables too deep in each other to be read")
    return table


def read_tree(path: Path, kind: str) -> xr.DataTree:
    """A NetCDF-4 file in memory. kind: what it should be, for the error. Raises InputError if it cannot be read."""
    # The command line writes files and starts without numbers.
    import h5py
    import xarray as xr

    try:
        # Of a file whose root cannot be read h5netcdf makes half an object, whose end prints a traceback.
        with h5py.File(path, "r") as probe:
            probe.attrs.get("_nc3_strict")
        # Units are read by who needs them: none of them is a date.
        with warnings.catch_warnings():
            warnings.filterwarnings("error", _TWICE, UserWarning)
            with xr.open_datatree(path, engine="h5netcdf", decode_times=False) as tree:
                loaded: xr.DataTree = tree.load()
        # A variable whose dimensions were lost shows when its group is put together.
        for node in loaded.subtree:
            node.to_dataset()
    except Exception as error:
        why = one_line(str(error))
        if why.startswith(_TWICE):
            why = "a variable has the same dimension twice; give the second another name"
        raise InputError(f"cannot read {path} as {kind}: {why}") from error
    return loaded


def _check_no_folder(path: Path) -> None:
    if path.is_dir():
        raise InputError(f"cannot write {path}: it is a folder; give a file name")


def _temporary(path: Path) -> Path:
    _check_no_folder(path)
    if not path.parent.is_dir():
        raise InputError(f"cannot write {path}: the folder {path.parent} does not exist; make it first")
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=f".part{path.suffix}", dir=path.parent)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}; choose a folder you may write to") from error
    os.close(handle)
    return Path(name)
