"""Gridded loads in wavenumbers: cosine and sine parts along x and along y, and their slopes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array, IntArray


@dataclass(frozen=True, eq=False)
class Cells:
    """Load (3, ny, nx), Pa, on cells of dx by dy, m, the first centred at x0, y0, m.

    order: 1: uniform on each cell. 2: bilinear between centres, falling to zero in one cell around.
    """

    load: Array
    dx: float
    dy: float
    x0: float
    y0: float
    order: int = 1


@dataclass(frozen=True, eq=False)
class LoadSpectrum:
    """A load that goes into wavenumbers: cells of one load in several places along x, (place,), go together.

    parts: the cells, their places, the way into ky, (rows, 2 nky), and what is loaded: the load (3 or 1, rows,
    columns) and the columns, by number.
    """

    parts: list[tuple[Cells, list[float], Array, Array, IntArray]]
    precision: type[np.floating]

    @classmethod
    def of(cls, loads: Sequence[Cells], ky: Array, precision: type[np.floating]) -> LoadSpectrum:
        """With the way into ky, in a precision."""
        together: list[tuple[Cells, list[float]]] = []
        for cells in loads:
            alike = next((places for group, places in together if _moved_along(group, cells)), None)
            if alike is None:
                together.append((cells, [cells.x0]))
            else:
                alike.append(cells.x0)
        sheared = any(cells.load[1:].any() for cells, _ in together)
        parts: list[tuple[Cells, list[float], Array, Array, IntArray]] = []
        for block, places in together:
            # Grooves and the rim of the grid bear nothing.
            rows, columns = (np.flatnonzero(block.load.any(axis=(0, axis))) for axis in (2, 1))
            into = _towards(ky, block.dy, block.y0, rows, block.order).astype(precision, copy=False)
            load = block.load[: 3 if sheared else 1, rows[:, None], columns].astype(precision, copy=False)
            parts.append((block, places, into, load, columns))
        return cls(parts, precision)

    def at(self, kx: Array, ky: Array) -> Array:
        """Cosine and sine parts along x and along y, (3 or 6, 2, 2, nky, nkx).

        Of the pressure, its shears q_x and q_y, ∂x q_x, ∂y q_y and ∂x q_y + ∂y q_x; without shear of the pressure.
        """
        sheared = any(len(load) > 1 for *_, load, _ in self.parts)
        spectrum = np.zeros((6 if sheared else 1, 2, 2, len(ky), len(kx)), self.precision)
        direct = spectrum[: 3 if sheared else 1]
        for cells, places, narrow, load, columns in self.parts:
            wide = sum(_towards(kx, cells.dx, place, columns, cells.order) for place in places)
            wide = np.asarray(wide, self.precision)
            for turned, by_x in zip(direct.swapaxes(0, 1), np.split(wide, 2, axis=1), strict=True):
                turned += (narrow.T @ (load @ by_x)).reshape(turned.shape)
        if sheared:
            kx, ky = kx.astype(self.precision, copy=False), ky.astype(self.precision, copy=False)[:, None]
            slope_x(spectrum[1], kx, spectrum[3])
            slope_y(spectrum[2], ky, spectrum[4])
            spectrum[5] = slope_x(spectrum[2], kx) + slope_y(spectrum[1], ky)
        return spectrum


def _moved_along(cells: Cells, reference: Cells) -> bool:
    """Whether cells are the same load moved along x."""
    same = (cells.dx, cells.dy, cells.y0, cells.order) == (reference.dx, reference.dy, reference.y0, reference.order)
    return same and (cells.load is reference.load or np.array_equal(cells.load, reference.load))


def _towards(k: Array, width: float, first: float, cells: IntArray, order: int) -> Array:
    """Cosine and sine transforms of cells (n,), by number, (n, 2 nk)."""
    turn = np.outer(first + width * cells, k)
    # numpy's sinc takes half turns.
    share = width * np.sinc(k * width / (2 * math.pi)) ** order
    both: Array = np.concatenate([np.cos(turn) * share, np.sin(turn) * share], axis=1)
    return both


def slope_x(waves: Array, kx: Array, out: Array | None = None) -> Array:
    """∂/∂x of cosine and sine parts along x and y (2, 2, nky, nkx)."""
    out = np.empty_like(waves) if out is None else out
    np.multiply(waves[1], kx, out=out[0])
    np.multiply(waves[0], -kx, out=out[1])
    return out


def slope_y(waves: Array, ky: Array, out: Array | None = None) -> Array:
    """∂/∂y likewise. ky: (nky, 1)."""
    out = np.empty_like(waves) if out is None else out
    np.multiply(waves[:, 1], ky, out=out[:, 0])
    np.multiply(waves[:, 0], -ky, out=out[:, 1])
    return out
