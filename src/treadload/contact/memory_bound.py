"""Whether the fields of a contact fit into the memory of the machine, estimated before they are made."""

from __future__ import annotations

import contextlib
import functools
import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from treadload.contact.bodies.body import Body
from treadload.contact.rolling_state import Rolling
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.tire import Tire

# Bytes for each cell at the peak of a solve, by the largest resident memory of processes on one thread, a third of
# the cells in contact: pressure alone 640 to 660, pressure and shear 880 to 970 (910 on layers), rubber with memory
# 2000. On ribs 7600, 10500 and 13200 for 8, 12 and 16 rows of cells on the widest rib: their waves have dense blocks.
_PRESSURE, _SHEAR, _NOT_SYMMETRIC, _RIBS, _ROW_OF_A_RIB = 660.0, 970.0, 2020.0, 2000.0, 700.0
# Of the memory, for the estimate; the rest is for the interpreter, the input and the fields of the result.
_SHARE = 0.8
# Where no system states its memory, bytes.
_UNKNOWN = 4e9
_GROUP_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")


def check_memory(tire: Tire, rolling: Rolling, bodies: Body, grid: Grid) -> None:
    """Refuse a grid on which a contact needs more than the memory of this machine.

    Raises InputError with the estimate, the memory, and the size of cells that fits.
    """
    need, most = estimated_memory(tire, rolling, bodies, grid), memory_of_machine()
    if need <= _SHARE * most:
        return
    remedy = "a height map keeps its cells: give one on larger cells, or use a machine with more memory"
    if tire.fixed_grid is None:
        remedy = f'use spacing = "{_fitting(tire, rolling, bodies, grid, _SHARE * most) * 1e3:.2g} mm" or more'
    raise InputError(
        f"a contact on {float(grid.nx) * grid.ny:.3g} cells of {grid.dx * 1e3:g} mm needs about {need / 1e9:.3g} GB, "
        f"more than {_SHARE:.0%} of the {most / 1e9:.3g} GB of memory of this machine; {remedy}"
    )


def estimated_memory(tire: Tire, rolling: Rolling, bodies: Body, grid: Grid) -> float:
    """Bytes that a contact of two bodies takes at its peak on a grid, within a third where it takes over 100 MB."""
    cells = float(grid.nx) * float(grid.ny)
    each = _PRESSURE if rolling.law.largest == 0 else _SHEAR
    if not bodies.symmetric:
        each = _NOT_SYMMETRIC
    widest = max((right - left for group in tire.ribs for left, right in group.faces), default=0.0)
    if widest > 0:
        each += _RIBS - _SHEAR + _ROW_OF_A_RIB * widest / grid.dy
    return each * cells


def _fitting(tire: Tire, rolling: Rolling, bodies: Body, grid: Grid, most: float) -> float:
    """Size of cells, m, rounded up to two digits, on which the contact takes so many bytes on the grid's area."""
    size = grid.dx
    while estimated_memory(tire, rolling, bodies, _of_size(grid, size)) > most:
        size *= 1.01
    digits = 10.0 ** (math.floor(math.log10(size)) - 1)
    return math.ceil(size / digits) * digits


def _of_size(grid: Grid, size: float) -> Grid:
    return Grid.centred(grid.nx * grid.dx, grid.ny * grid.dy, size)


@functools.cache
def memory_of_machine() -> float:
    """Bytes that this process may use: those of the machine, or the lower limit of its group or of the process."""
    return min(_limits(), default=_UNKNOWN)


def _limits() -> Iterator[float]:
    if sys.platform == "win32":
        yield _memory_of_windows()
        return
    with contextlib.suppress(ValueError, OSError, AttributeError):
        yield float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    for path in _GROUP_LIMITS:
        # "max" where there is none.
        with contextlib.suppress(OSError, ValueError):
            yield float(Path(path).read_text(encoding="ascii"))
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource

        for kind in (resource.RLIMIT_AS, resource.RLIMIT_DATA):
            soft, _ = resource.getrlimit(kind)
            if soft != resource.RLIM_INFINITY:
                yield float(soft)


def _memory_of_windows() -> float:
    import ctypes

    class Status(ctypes.Structure):
        """MEMORYSTATUSEX of the Windows API."""

        _fields_ = (
            ("dwLength", ctypes.c_ulong),
            ("dwMemoryLoad", ctypes.c_ulong),
            *((name, ctypes.c_ulonglong) for name in (
                "ullTotalPhys", "ullAvailPhys", "ullTotalPageFile", "ullAvailPageFile", "ullTotalVirtual",
                "ullAvailVirtual", "ullAvailExtendedVirtual",
            )),
        )  # fmt: skip

    status = Status()
    status.dwLength = ctypes.sizeof(Status)
    library = getattr(ctypes, "windll").kernel32  # noqa: B009, only Windows has it
    return float(status.ullTotalPhys) if library.GlobalMemoryStatusEx(ctypes.byref(status)) else _UNKNOWN
