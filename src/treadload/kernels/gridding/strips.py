"""Surfaces that are the same along travel only: one dense block a wave for every group of neighbouring rows.

Displacements (u_x, u_y, u_n) under loads (q_x, q_y, p). Along travel a product is a convolution, by FFT; across, the
rows of a group are coupled by a matrix, and rows of different groups are not. In the frame (q_x, q_y, -p) →
(u_x, u_y, -u_n), with u_x and q_x in quadrature, these matrices are real and symmetric.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray, IntArray
from treadload.kernels.gridding.convolution import Along

# Displacements from those of the frame; loads go the other way, by the conjugate.
_FRAME = np.array([1j, 1.0, -1.0])


@dataclass(frozen=True, eq=False)
class Strips:
    """Dense blocks of groups of rows.

    rows: numbers (n,) of the rows of every group, none in two. blocks: (length // 2 + 1, 3 n, 3 n) of every group,
    m/Pa: all rows of the first component, then of the second and the third; complex where displacements are sought
    elsewhere than at the cells. length: cells along travel after which
    loads repeat.
    """

    rows: tuple[IntArray, ...]
    blocks: tuple[Array | ComplexArray, ...]
    length: int
    _parts: dict[tuple[tuple[int, ...], tuple[int, ...], str], list[tuple[IntArray, Array]]] = field(
        default_factory=dict, init=False, repr=False
    )
    _of_itself: dict[int, Array] = field(default_factory=dict, init=False, repr=False)

    def added_to(
        self,
        convolved: Callable[[Along | None], list[Array]],
        loads: Array,
        components: tuple[int, ...],
        axes: tuple[float, ...] = (1.0, 1.0, 1.0),
    ) -> list[Array]:
        """Displacements (ny, nx), m, of a convolution and of these together.

        convolved: those of the convolution, with what `Padding.through` takes as `along`. loads: (components, ny,
        nx), Pa. components: of loads and displacements. axes: of each, by which both are stretched for these alone.
        """

        def along(waves: list[ComplexArray]) -> list[ComplexArray]:
            if all(axis == 1.0 for axis in axes):
                return self.on_waves(waves, components, components)
            scale = np.array(axes[: len(components)], waves[0].real.dtype)
            moved = self.on_waves([d * wave for d, wave in zip(scale, waves, strict=True)], components, components)
            return [d * wave for d, wave in zip(scale, moved, strict=True)]

        return convolved(along)

    def displacement(self, loads: Array, by: tuple[int, ...], of: tuple[int, ...], columns: int) -> Array:
        """Displacement (of, ny, columns), m, by loads (by, ny, nx), Pa, in the precision of the loads.

        by, of: which components: 0 along travel, 1 across, 2 normal.
        """
        waves = fft.rfft(loads, n=self.length, axis=-1)
        moved = self.on_waves([wave.T for wave in waves], by, of)
        field_: Array = fft.irfft(np.array([wave.T for wave in moved]), n=self.length, axis=-1)[..., :columns]
        return field_

    def on_waves(self, waves: list[ComplexArray], by: tuple[int, ...], of: tuple[int, ...]) -> list[ComplexArray]:
        """`displacement` of loads and fields transformed along travel: (length // 2 + 1, ny) of every component."""
        loads = np.stack(waves, axis=1)
        real = loads.real.dtype
        for number, component in enumerate(by):
            if component != 1:
                loads[:, number] *= _FRAME[component].conjugate()
        moved = np.zeros((loads.shape[0], len(of), loads.shape[2]), loads.dtype)
        for rows, blocks in self._blocks(by, of, real):
            # (waves, groups, rows): groups of as many rows are multiplied at once.
            column = loads[:, :, rows].swapaxes(1, 2).reshape(len(loads), len(rows), -1, 1)
            turned = np.iscomplexobj(blocks)
            product = blocks @ column if turned else (blocks @ column.view(real)).view(loads.dtype)
            moved[:, :, rows] = product.reshape(*column.shape[:2], len(of), -1).swapaxes(1, 2)
        for number, component in enumerate(of):
            if component != 1:
                moved[:, number] *= _FRAME[component]
        return list(moved.swapaxes(0, 1))

    def _blocks(
        self, by: tuple[int, ...], of: tuple[int, ...], real: np.dtype[np.floating]
    ) -> list[tuple[IntArray, Array]]:
        """Rows (groups, n) of groups of as many rows, and their blocks (waves, groups, of n, by n) in a precision."""
        key = by, of, real.char
        if key not in self._parts:
            kind = np.result_type(real, np.complex64) if np.iscomplexobj(self.blocks[0]) else real
            sizes = sorted({rows.size for rows in self.rows})
            alike = [[number for number, rows in enumerate(self.rows) if rows.size == size] for size in sizes]
            self._parts[key] = [
                (
                    np.stack([self.rows[number] for number in numbers]),
                    np.stack([self._block(self.blocks[number], by, of) for number in numbers], axis=1).astype(kind),
                )
                for numbers in alike
            ]
        return self._parts[key]

    @staticmethod
    def _block(block: Array | ComplexArray, by: tuple[int, ...], of: tuple[int, ...]) -> Array | ComplexArray:
        """The part of a block that gives some components by some others."""
        count = block.shape[1] // 3
        parts = block.reshape(-1, 3, count, 3, count)[:, list(of)][:, :, :, list(by)]
        return parts.reshape(-1, len(of) * count, len(by) * count)

    def alone(self, component: int, places: int) -> Array:
        """Mean displacement of a cell by its own load at distances of 0, 1, … cells along travel: (places,), m/Pa."""
        if component not in self._of_itself:
            diagonal = np.concatenate(
                [np.diagonal(self._block(b, (component,), (component,)), axis1=1, axis2=2) for b in self.blocks],
                axis=1,
            )
            self._of_itself[component] = fft.irfft(diagonal.mean(1) + 0j, n=self.length)
        return self._of_itself[component][:places]


@dataclass(frozen=True, eq=False)
class StripInverse:
    """The inverse of strips and of a convolution together, on rows that repeat after a length along travel.

    groups: rows (groups, n) of groups of as many rows, and inverse (length // 2 + 1, groups, m n, m n), Pa/m, for
    every size of groups. components: which, as in `Strips`.
    """

    groups: tuple[tuple[IntArray, Array], ...]
    components: tuple[int, ...]
    length: int

    @classmethod
    def of(
        cls,
        strips: Strips,
        components: tuple[int, ...],
        kernels: dict[tuple[int, int], Array],
        *,
        together: bool = True,
    ) -> StripInverse:
        """From strips of a length, and what a convolution adds.

        kernels: (ny, length // 2 + 1) at distances of 0, 1, … cells across and along: u_i by the load j, i ≤ j, of
        parity (-1)^([i = 0] + [j = 0]) along and (-1)^([i = 1] + [j = 1]) across. together: whether the convolution
        couples groups; without that the inverse is near where it is weak between them, and takes a fraction of the
        memory.
        """
        symbols = {}
        for (i, j), kernel in kernels.items():
            symbol = _along(kernel, strips.length, odd=(i == 0) != (j == 0))
            # Into the frame: u_i = f_i S* and q_j = f_j S, so that the matrix is real.
            symbols[i, j] = (symbol * (_FRAME[i].conjugate() * _FRAME[j])).real
        numbers = range(len(strips.rows))
        inverses: dict[int, list[tuple[IntArray, Array]]] = {}
        for members in [list(numbers)] if together else [[number] for number in numbers]:
            index = np.concatenate([strips.rows[number] for number in members])
            whole = cls._whole([(strips.rows[n], strips.blocks[n]) for n in members], index, components, symbols)
            inverses.setdefault(index.size, []).append((index, np.linalg.inv(whole).astype(np.float32)))
        groups = tuple(
            (np.stack([rows for rows, _ in alike]), np.stack([inverse for _, inverse in alike], axis=1))
            for alike in inverses.values()
        )
        return cls(groups, components, strips.length)

    @staticmethod
    def _whole(
        members: list[tuple[IntArray, Array | ComplexArray]],
        index: IntArray,
        components: tuple[int, ...],
        symbols: dict[tuple[int, int], Array],
    ) -> Array:
        """The matrices (waves, m n, m n) of some rows."""
        count, many, waves = index.size, len(components), members[0][1].shape[0]
        whole = np.zeros((waves, many, count, many, count))
        place = 0
        for rows, block in members:
            size = rows.size
            part = Strips._block(block, components, components).reshape(-1, many, size, many, size)
            whole[:, :, place : place + size, :, place : place + size] = part
            place += size
        apart = index[:, None] - index
        for (i, j), symbol in symbols.items():
            rows_apart = symbol[np.abs(apart)].transpose(2, 0, 1)
            if (i == 1) != (j == 1):
                rows_apart = rows_apart * np.sign(apart)
            at, to = components.index(i), components.index(j)
            whole[:, at, :, to] += rows_apart
            if i != j:
                whole[:, to, :, at] += rows_apart.swapaxes(1, 2)
        return whole.reshape(-1, many * count, many * count)

    def __call__(self, fields: Array) -> Array:
        """Loads (m, ny, nx) that give displacements (m, ny, nx) about, with nothing on rows of no strip."""
        many, ny, nx = fields.shape
        waves = fft.rfft(fields.astype(np.float32, copy=False), n=self.length, axis=-1).transpose(2, 0, 1)
        frame = _FRAME[list(self.components)].astype(np.complex64)[:, None]
        waves = waves * frame.conjugate()
        loads = np.zeros((len(waves), many, ny), np.complex64)
        for rows, inverse in self.groups:
            group = waves[:, :, rows].swapaxes(1, 2).reshape(len(waves), len(rows), -1, 1)
            product = (inverse @ group.view(np.float32)).view(np.complex64)
            loads[:, :, rows] = product.reshape(len(waves), len(rows), many, -1).swapaxes(1, 2)
        loads *= frame
        spread: Array = fft.irfft(loads.transpose(1, 2, 0), n=self.length, axis=-1)[..., :nx]
        return spread


def coupling_of(table: Array) -> float:
    """Largest singular value of C_nn^-½ C_nt C_tt^-½ of a compliance (3 n, 3 n) of u_x, u_y, u_n by q_x, q_y, p."""
    split = 2 * len(table) // 3
    shear, normal = np.linalg.cholesky(table[:split, :split]), np.linalg.cholesky(table[split:, split:])
    coupling = np.linalg.solve(shear, np.linalg.solve(normal, table[split:, :split]).T)
    return float(np.linalg.norm(coupling, 2))


def shortened(values: Array | ComplexArray, whole: int, length: int, *, odd: bool) -> Array | ComplexArray:
    """Waves of a kernel that repeats after fewer cells and is that of the longer one as far as it reaches.

    values: (whole // 2 + 1, …) in the frame of `Strips`. odd: along travel, as what joins its direction to others.
    whole, length: cells after which loads repeat, length the fewer. Returns (length // 2 + 1, …). Loads on half of
    the length see the kernel of the longer one, and nothing of its images.
    """
    half = length // 2
    kernel = _kernel(values, whole, odd)
    near = np.concatenate([kernel[: half + 1], kernel[whole - (length - half - 1) :]])
    if length % 2 == 0:
        # Half way round, plus and minus meet.
        near[half] = 0.5 * (kernel[half] + kernel[whole - half])
    waves = fft.rfft(near, axis=0) / (1j if odd else 1)
    return np.asarray(waves if np.iscomplexobj(values) else waves.real)


def without_images(values: Array | ComplexArray, length: int, fading: float, *, odd: bool) -> ComplexArray:
    """Waves of a kernel that fades behind the load, without those of its images ahead.

    values: (length // 2 + 1, …) in the frame of `Strips`. odd: as in `shortened`. length: cells after which loads
    repeat. fading: cells over which displacements fade. Half way round, where nothing is left of the body's
    immediate response any more, what fades is that of one load and, by a geometric series, of all images ahead of
    it; it falls with exp(-distance / fading) from there.
    """
    offset = fft.fftfreq(length, 1 / length)
    behind = length - length // 2
    images = fft.rfft(np.exp((offset - behind) / fading))
    half_way = _kernel(values, length, odd)[behind]
    return np.asarray(values - np.multiply.outer(images, half_way) / (1j if odd else 1))


def _kernel(values: Array | ComplexArray, length: int, odd: bool) -> Array:
    """What waves (length // 2 + 1, …) in the frame are at distances of cells along travel (length, …)."""
    kernel: Array = fft.irfft((1j if odd else 1) * values, n=length, axis=0)
    return kernel


def _along(kernel: Array, length: int, *, odd: bool) -> ComplexArray:
    """Transform along travel (ny, length // 2 + 1) of a kernel known at distances ≥ 0 (ny, length // 2 + 1)."""
    wrapped = np.zeros((kernel.shape[0], length))
    half = length // 2
    wrapped[:, : half + 1] = kernel[:, : half + 1]
    wrapped[:, half + 1 :] = (-1 if odd else 1) * kernel[:, 1 : length - half][:, ::-1]
    if odd:
        wrapped[:, 0] = 0
        if length % 2 == 0:
            wrapped[:, half] = 0
    transformed: ComplexArray = fft.rfft(wrapped, axis=-1)
    return transformed
