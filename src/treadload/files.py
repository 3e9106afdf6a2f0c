"""The one door by which files are written, whole or not at all; and how they are read."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import shutil
import stat
import sys
import tomllib
import warnings
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from treadload.deferred import xarray as xr
from treadload.errors import InputError, WriteError, one_line

if TYPE_CHECKING:
    import h5netcdf
    import h5py

Content = bytes | str | Iterable[str]
# No space, no quota, or more than a file may hold.
_NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
# Letters of a name that a temporary file repeats.
_STEM = 40
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


def check_suffix(path: str | os.PathLike[str], suffixes: Mapping[str, str], what: str) -> str:
    """The suffix of a path in small letters, if it is a known one, so that a file is what its name promises.

    suffixes: suffixes and what they mean. what: is to be written, for the error. Raises InputError.
    """
    _check_no_folder(Path(path))
    suffix = Path(path).suffix.lower()
    if suffix not in suffixes:
        means = {meaning: [name for name in suffixes if suffixes[name] == meaning] for meaning in suffixes.values()}
        listed = ", ".join(f"{' or '.join(names)} ({meaning})" for meaning, names in means.items())
        problem = f"the suffix {suffix} is not known" if suffix else "its name has no suffix"
        pdf = "; for a PDF print the page of `treadload report` from a browser" if suffix == ".pdf" else ""
        raise InputError(f"cannot write {what} to {os.fspath(path)}: {problem}, use {listed}{pdf}")
    return suffix


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raise InputError now if a file at `path` could not be written later."""
    place = _place(Path(path))
    if place.temporary is not None:
        try:
            place.fill(b"", sync=False)
        finally:
            place.clear()


def write_whole(path: str | os.PathLike[str], content: Content, *, sync: bool = True) -> Path:
    """Write a file whole or not at all: an old one of this name stays as it is until the new one is on the disk.

    content: bytes, text, which is written in UTF-8, or pieces of text, which need not be in memory together. A link
    is followed; the mode of an old file is kept. sync: False for what can be made again after a power cut, which is
    ten times as fast. Returns the path. Raises InputError for a path that cannot be a file and WriteError where the
    disk is full, read-only or gone.
    """
    return write_all([(path, content)], sync=sync)[0]


def write_all(contents: Iterable[tuple[str | os.PathLike[str], Content]], *, sync: bool = True) -> tuple[Path, ...]:
    """Write several files, none of which takes its place before all are on the disk; see `write_whole`.

    contents: path and content of each. Returns the paths.
    """
    files = [(_place(Path(path)), content) for path, content in contents]
    try:
        for place, content in files:
            place.fill(content, sync=sync)
        for place, _ in files:
            place.take()
        for folder in {place.target.parent for place, _ in files} if sync else ():
            _sync_folder(folder)
    finally:
        for place, _ in files:
            place.clear()
    return tuple(place.path for place, _ in files)


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


def parse_toml(text: str, name: str) -> dict[str, object]:
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
        inner = [item.values() if isinstance(item, dict) else item for item in layer]
        layer = [value for values in inner for value in values if isinstance(value, dict | list)]
    # Dotted keys go as deep as they are long, and what copies or writes tables calls itself once a level.
    if layer:
        raise InputError(f"{name} holds lists or tables too deep in each other to be read")
    return table


def read_tree(path: Path, kind: str) -> xr.DataTree:
    """A NetCDF-4 file in memory. kind: what it should be, for the error.

    Raises InputError if it cannot be read, changes while it is read, or has links that lead in circles or out of it.
    """
    try:
        # Held open, it is the same file to the end, also where another one takes its name.
        with path.open("rb") as stream:
            before = _state(stream)
            try:
                return _tree(path)
            finally:
                if _state(stream) != before:
                    raise InputError("it changed while it was read; wait for what writes it, and read it again")
    except Exception as error:
        why = one_line(getattr(error, "strerror", None) or str(error))
        if why.startswith(_TWICE):
            why = "a variable has the same dimension twice; give the second another name"
        if isinstance(error, UnicodeDecodeError):
            why = f"the name or label {error.object!r} is not UTF-8; write it again"
        raise InputError(f"cannot read {path} as {kind}: {why}") from error


def _tree(path: Path) -> xr.DataTree:
    # The command line writes files and starts without numbers.
    import h5netcdf
    import h5py
    from xarray.backends import H5NetCDFStore

    # Of a file whose root cannot be read h5netcdf makes half an object, whose end prints a traceback.
    with h5py.File(path, "r") as probe:
        probe.attrs.get("_nc3_strict")
        _check_links(probe)

    # Units are read by who needs them: none of them is a date.
    with warnings.catch_warnings():
        warnings.filterwarnings("error", _TWICE, UserWarning)
        with (
            remembering(path, "r") as file,
            h5netcdf.File(file, "r", decode_vlen_strings=True, phony_dims="access") as source,
        ):
            groups = {
                group.name: xr.open_dataset(H5NetCDFStore(source, group=group.name), decode_times=False).load()
                for group in _groups_of(source)
            }
    loaded = xr.DataTree.from_dict(groups)
    # A variable whose dimensions were lost shows when its group is put together.
    for node in loaded.subtree:
        node.to_dataset()
        _replace_texts(node)
    return loaded


def remembering(path: str | os.PathLike[str], mode: str, **options: object) -> h5py.File:
    """An HDF5 file that keeps what it has opened, for h5netcdf, which opens each dataset again for each property.

    path, mode, options: as of `h5py.File`.
    """
    import h5py

    class Remembering(h5py.File):  # type: ignore[misc]
        def __init__(self) -> None:
            super().__init__(path, mode, **options)
            self.opened: dict[object, h5py.HLObject] = {}

        def __getitem__(self, name: object) -> object:
            if not isinstance(name, str):
                return super().__getitem__(name)
            kept = self.opened.get(name)
            # What is deleted has no links: h5netcdf makes the dataset of a dimension again as that of its coordinate.
            if kept is None or not h5py.h5o.get_info(kept.id).rc:
                kept = self.opened[name] = super().__getitem__(name)
            return kept

    return Remembering()


def _groups_of(group: h5netcdf.Group) -> Iterator[h5netcdf.Group]:
    yield group
    for inner in group.groups.values():
        yield from _groups_of(inner)


def _replace_texts(node: xr.DataTree) -> None:
    """Replace what is not UTF-8 in the attributes of a group and its variables by "?"; readers refuse other texts."""
    holders: list[Any] = [node, *node.variables.values()]
    for holder in holders:
        holder.attrs = {_valid(str(name)): _valid(value) for name, value in holder.attrs.items()}


def _valid(value: object) -> object:
    """A text without what stands for bytes that are not UTF-8, which no file takes; anything else as it is."""
    return value.encode("utf-8", "replace").decode("utf-8") if isinstance(value, str) else value


def _state(stream: BinaryIO) -> tuple[int, int]:
    """How long a file is and when it was last written."""
    now = os.fstat(stream.fileno())
    return now.st_size, now.st_mtime_ns


def _check_links(file: h5py.File) -> None:
    """Refuse what a reader follows for ever, or to another file. file: of h5py. Raises ValueError."""
    import h5py

    seen, waiting = {file["/"]}, [file["/"]]
    while waiting:
        group = waiting.pop()
        for name in group:
            place = f"{group.name.rstrip('/')}/{name}"
            if isinstance(group.get(name, getlink=True), h5py.ExternalLink):
                raise ValueError(f"{place} is a link to another file; put what it holds into this one")
            if group.get(name, getclass=True) is not h5py.Group:
                continue
            inner = group[name]
            if inner in seen:
                raise ValueError(f"{place} is a link to a group that has another name; write the file without links")
            if place.count("/") > _DEEPEST:
                raise ValueError(f"{place[:100]} lies more than {_DEEPEST} groups deep; write the file with fewer")
            seen.add(inner)
            waiting.append(inner)


def _check_no_folder(path: Path) -> None:
    if os.path.isdir(path):
        raise InputError(f"cannot write {path}: it is a folder; give a file name")


@dataclass(frozen=True)
class _Place:
    """Where a file goes.

    path: as the user gave it. target: where its links lead. temporary: beside it, None for what is no file on a disk,
    as /dev/stdout, and cannot be replaced. mode: of the old file, None where there is none.
    """

    path: Path
    target: Path
    temporary: Path | None
    mode: int | None

    def fill(self, content: Content, *, sync: bool) -> None:
        """Write the temporary file. sync: True to wait until it is on the disk."""
        pieces = (content,) if isinstance(content, bytes | str) else content
        with self._refusing(content):
            with (self.temporary or self.target).open("xb" if self.temporary else "wb") as stream:
                for piece in pieces:
                    # A file cut within a character is not valid text.
                    stream.write(piece.encode("utf-8", "replace") if isinstance(piece, str) else piece)
                if self.temporary is not None and sync:
                    stream.flush()
                    os.fsync(stream.fileno())
            if self.temporary is not None and self.mode is not None:
                self.temporary.chmod(self.mode)

    def take(self) -> None:
        """Let the temporary file take the place of the old one, in a single step."""
        if self.temporary is not None:
            with self._refusing(()):
                self.temporary.replace(self.target)

    def clear(self) -> None:
        """Remove the temporary file, where it has not become the file."""
        if self.temporary is not None:
            with contextlib.suppress(OSError):
                self.temporary.unlink(missing_ok=True)

    @contextlib.contextmanager
    def _refusing(self, content: Content) -> Iterator[None]:
        """State why a file could not be written, what it needs, and that the old one is still there."""
        try:
            yield
        except OSError as error:
            self.clear()
            why, remedy = error.strerror or str(error), "choose a folder you may write to"
            if error.errno in _NO_ROOM:
                needs = f"{_size(len(content))} needed, " if isinstance(content, bytes | str) else ""
                with contextlib.suppress(OSError):
                    why += f" ({needs}{_size(shutil.disk_usage(self.target.parent).free)} free)"
                remedy = "make room there, or choose another folder"
            kept = "" if self.mode is None else "; the file that was there is unchanged"
            raise WriteError(f"cannot write {self.path}: {why}; {remedy}{kept}") from error


def _place(path: Path) -> _Place:
    """Where a file of this path goes. Raises InputError where none can be."""
    _check_no_folder(path)
    try:
        old = path.stat()
    except FileNotFoundError:
        old = None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError(f"cannot write {path}: {why}; give another name") from error
    if old is not None and not stat.S_ISREG(old.st_mode):
        return _Place(path, path, None, None)
    target = Path(os.path.realpath(path))
    if not target.parent.is_dir():
        raise InputError(f"cannot write {path}: the folder {target.parent} does not exist; make it first")
    if old is not None and not os.access(target, os.W_OK):
        raise InputError(f"cannot write {path}: it is read-only; make it writable, or give another name")
    # In the same folder, where a move is a single step; short, as names are bounded.
    temporary = target.with_name(f".{target.stem[:_STEM]}-{secrets.token_hex(8)}.part")
    return _Place(path, target, temporary, None if old is None else stat.S_IMODE(old.st_mode))


def _sync_folder(folder: Path) -> None:
    """Wait until the names in a folder are on the disk, where a system can."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _size(count: int) -> str:
    """Bytes for a sentence."""
    return f"{count / 1e3:.0f} kB" if count < 1e6 else f"{count / 1e6:.0f} MB"
