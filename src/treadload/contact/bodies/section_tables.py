"""Tables of cross-sections, kept in memory and in the user's cache folder: a section is solved once.

A file holds one table, for E = 1 Pa. It is written whole or not at all, and made again, without a word, where it is
missing, damaged, or of another version. TREADLOAD_CACHE names another folder; empty, it keeps tables in memory only.

E scales out, ν does not: a search for ν would solve a table for every ν that it tries. `interpolated` makes it use a
polynomial through tables at a few ν in place of that.

Tables of the catalogue's treads are part of the package, in single precision and by the lower triangle of their
matrices; `benchmarks/ship_section_tables.py` makes them.
"""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Iterator
from contextvars import ContextVar
from functools import lru_cache
from pathlib import Path

import numpy as np

from treadload.contact.bodies.kept_files import cache_file, content_of, keep_arrays, read_arrays
from treadload.files import write_whole
from treadload.kernels.arrays import Array
from treadload.kernels.sections import FaceTable, Section, face_compliance

# Raised with every change of the elements or of what a file holds.
_VERSION = 1
# Tables in memory, and on the disk: a few MB each.
_KEPT, _MOST_FILES = 8, 40
# Tables of the catalogue's treads.
_SHIPPED = Path(__file__).parent / "shipped_sections"
# Lengths of sections are compared to so many decimals of a metre: ribs that differ by round-off share a table.
_DECIMALS = 9
# Poisson's ratios between which tables are interpolated, and their number: compliance is nearly linear in 1 - 2ν, so
# that a parabola through tables at 0.45 to 0.4999 errs by less than 1e-5 of the largest.
_BETWEEN: ContextVar[tuple[float, ...]] = ContextVar("interpolated Poisson's ratios", default=())
_NODES = 3


def face_table(section: Section, poisson: float) -> FaceTable:
    """Displacement of the face of a section of E = 1 Pa, solved, or taken from an earlier time. poisson: ν < ½."""
    nodes = _BETWEEN.get()
    if nodes and nodes[0] <= poisson <= nodes[-1]:
        return _between(_rounded(section), float(poisson), nodes)
    return _table(_rounded(section), float(poisson))


@contextlib.contextmanager
def interpolated(low: float, high: float) -> Iterator[None]:
    """Interpolate tables of sections of a Poisson's ratio from low to high, both below ½, while this is open.

    For a search for ν: tables are solved at three ν and not at each that is tried. Others are solved as always.
    """
    token = _BETWEEN.set(_chebyshev(low, high))
    try:
        yield
    finally:
        _BETWEEN.reset(token)


def _chebyshev(low: float, high: float) -> tuple[float, ...]:
    """Places of extremes of a Chebyshev polynomial, the ends among them; digits that a file's name repeats."""
    turn = np.cos(np.pi * np.arange(_NODES) / (_NODES - 1))
    places = 0.5 * (low + high) - 0.5 * (high - low) * turn
    return tuple(float(f"{place:.10g}") for place in np.concatenate([[low], places[1:-1], [high]]))


def _between(section: Section, poisson: float, nodes: tuple[float, ...]) -> FaceTable:
    waves, compliance = _tables_at(section, nodes)
    at = np.array(nodes)
    apart = at[:, None] - at[None, :] + np.eye(len(at))
    # Lagrange's polynomials: 1 at their node, 0 at the others.
    weights = np.array(
        [np.prod([(poisson - at[j]) / apart[i, j] for j in range(len(at)) if j != i]) for i in range(len(at))]
    )
    return FaceTable(section, poisson, waves, np.tensordot(weights, compliance, 1))


@lru_cache(maxsize=_KEPT)
def _tables_at(section: Section, nodes: tuple[float, ...]) -> tuple[Array, Array]:
    """Waves and the compliance at each ν, one after the other."""
    tables = [_table(section, poisson) for poisson in nodes]
    return tables[0].waves, np.stack([table.compliance for table in tables])


@lru_cache(maxsize=_KEPT)
def _table(section: Section, poisson: float) -> FaceTable:
    path = _path(section, poisson)
    table = _read_shipped(section, poisson)
    if table is None and path is not None:
        table = _read(path, section, poisson)
    if table is None:
        table = face_compliance(section, poisson)
        if path is not None:
            arrays = {"waves": table.waves, "compliance": table.compliance}
            keep_arrays(path, _description(section, poisson), arrays, _MOST_FILES)
    return table


def _rounded(section: Section) -> Section:
    def near(lengths: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(round(length, _DECIMALS) + 0.0 for length in lengths)

    ribs = tuple((round(left, _DECIMALS) + 0.0, round(right, _DECIMALS) + 0.0) for left, right in section.ribs)
    first, last = near(section.ends)
    (height,) = near((section.height,))
    draft: float | tuple[tuple[float, float], ...]
    if isinstance(section.draft, tuple):
        draft = tuple((near(pair)[0], near(pair)[1]) for pair in section.draft)
    else:
        (draft,) = near((section.draft,))
    return Section(ribs, height, near(section.floors), (first, last), draft, section.halvings)


def _path(section: Section, poisson: float) -> Path | None:
    """Where the table of a section lies; None where tables are not kept on the disk."""
    return cache_file("sections", _file_name(section, poisson))


def _file_name(section: Section, poisson: float) -> str:
    return f"{hashlib.sha256(f'{_VERSION} {section!r} {poisson!r}'.encode()).hexdigest()[:32]}.npz"


def ship(section: Section, poisson: float, folder: Path | None = None) -> Path:
    """Solve a section and write its table into the package, or another folder. Returns the path of the file."""
    section = _rounded(section)
    table = face_compliance(section, poisson)
    lower = np.tril_indices(table.compliance.shape[1])
    arrays = {"waves": table.waves, "triangle": table.compliance[:, lower[0], lower[1]].astype(np.float32)}
    path = (_SHIPPED if folder is None else folder) / _file_name(section, poisson)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, content_of(_description(section, poisson), arrays), sync=False)
    return path


def shipped_path(section: Section, poisson: float) -> Path:
    """Where the package has the table of a section, if it has."""
    return _SHIPPED / _file_name(_rounded(section), poisson)


def _read_shipped(section: Section, poisson: float) -> FaceTable | None:
    """The table of a section that came with the package; None of a section without one."""
    stored = read_arrays(_SHIPPED / _file_name(section, poisson), ("description", "waves", "triangle"))
    if stored is None or str(stored[0]) != _description(section, poisson):
        return None
    _, waves, triangle = stored
    nodes = 3 * section.mesh.face_lines.size
    if triangle.shape != (waves.size, nodes * (nodes + 1) // 2) or not np.isfinite(triangle).all():
        return None
    compliance = np.empty((waves.size, nodes, nodes))
    rows, columns = np.tril_indices(nodes)
    compliance[:, rows, columns] = compliance[:, columns, rows] = triangle
    return FaceTable(section, poisson, _read_only(waves), _read_only(compliance))


def _read(path: Path, section: Section, poisson: float) -> FaceTable | None:
    """The table of a file; None where there is none, or where it does not hold what it should."""
    stored = read_arrays(path, ("description", "waves", "compliance"))
    if stored is None:
        return None
    description, waves, compliance = stored
    nodes = 3 * section.mesh.face_lines.size
    sound = (
        str(description) == _description(section, poisson)
        and waves.ndim == 1
        and compliance.shape == (waves.size, nodes, nodes)
        and bool(np.isfinite(compliance).all())
    )
    return FaceTable(section, poisson, _read_only(waves), _read_only(compliance)) if sound else None


def _description(section: Section, poisson: float) -> str:
    return f"treadload section {_VERSION}: {section!r}, poisson {poisson!r}"


def _read_only(values: Array) -> Array:
    values.flags.writeable = False
    return values
