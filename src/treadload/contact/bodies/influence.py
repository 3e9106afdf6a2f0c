"""Two bodies on a grid: the influence operators of their surfaces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import DTypeLike

from treadload.contact.bodies.body import Body, Offsets, Rows, Strip, Waves
from treadload.contact.bodies.kernel_spectra import KernelSpectra
from treadload.errors import InputError
from treadload.kernels import fft
from treadload.kernels.arrays import Array, BoolArray, ComplexArray
from treadload.kernels.complementarity.coulomb import four
from treadload.kernels.gridding.convolution import Convolution, Padding
from treadload.kernels.gridding.strips import StripInverse, Strips, coupling_of

# Waves that a patch holds, at which the coupling of pressure and shear is looked at.
_WAVES, _DIRECTIONS = 64, 48
# Of like bodies whose couplings cancel, relative.
_ROUND_OFF = 1e-12
# Operators on up to so many cells are kept for the next contact: 16 to 300 bytes a cell each, at most so many.
_KEPT_CELLS, _KEPT = 25_000, 12
# Pairs of bodies and sizes of cells whose symbols are kept.
_KEPT_PAIRS = 4

Symbols = Array | ComplexArray
Product = Callable[[Array], Array]
_Symbols = dict[tuple[str, tuple[int, int]], tuple[Symbols, ...]]
_NO_STRIPS = (
    'this problem needs a surface that is the same everywhere, and a tread with ribs is not; give tread = "layer"'
)


@dataclass(frozen=True)
class Influence:
    """Influence operators of two bodies on a piece of (ny, nx) cells of dx by dy, m.

    pair: both bodies, a `contact.bodies.body.Sum` or half-spaces seen as one. first_y: middle of the first row, m to
    the right; where it is not known, None, a pair with strips is refused. Operators are built when first asked
    for and kept. Signs as in `contact.bodies.body`: q acts on body 1.
    """

    shape: tuple[int, int]
    dx: float
    dy: float
    pair: Body
    first_y: float | None = None

    @cached_property
    def padding(self) -> Padding:
        """Padded space in which the field has the cells of the load."""
        return Padding.of(self.shape)

    @cached_property
    def rolling_padding(self) -> Padding:
        """Padded space in which the field has one column more, ahead of the leading edge."""
        return Padding.of(self.shape, (self.shape[0], self.shape[1] + 1))

    @property
    def symmetric(self) -> bool:
        """True if loads work on each other's displacements alike, as in elastic bodies."""
        return self.pair.symmetric

    @property
    def mirrored(self) -> bool:
        """True if kernels have parities along y, as without a turned grain."""
        return self.pair.mirrored

    @cached_property
    def _strips(self) -> tuple[Strip, ...]:
        """Groups of rows that are the same along travel only."""
        if not self.pair.striped:
            return ()
        if self.first_y is None:
            raise InputError(_NO_STRIPS)
        return self.pair.strips(Rows(self.shape[0], self.dy, self.first_y))

    def strips(self, padding: Padding) -> Strips | None:
        """The operators of these rows in the length of a padded space; None of a pair that has none."""
        return self.strips_of(padding.shape[1])

    def strips_ahead(self, distance: float) -> Strips | None:
        """`strips` in `padding` with the displacement at a distance ahead of the cells along x, m."""
        if distance == 0 or not self._strips:
            return self.strips(self.padding)
        length = self.padding.shape[1]
        blocks = tuple(strip.block(length, self.dx, distance) for strip in self._strips)
        return Strips(tuple(strip.rows for strip in self._strips), blocks, length)

    @property
    def has_blocks(self) -> bool:
        """True if groups of cells are known as wholes by dense matrices."""
        return bool(self._strips)

    @property
    def has_strips(self) -> bool:
        """True if groups of rows are the same along travel only."""
        return bool(self._strips)

    @property
    def material(self) -> BoolArray:
        """(ny,) rows that have material: all of a pair without strips."""
        if not self._strips:
            return np.ones(self.shape[0], bool)
        rows = np.zeros(self.shape[0], bool)
        for strip in self._strips:
            rows[strip.rows] = True
        return rows

    def strips_of(self, length: int) -> Strips | None:
        """`strips` with loads that repeat after so many cells along travel."""
        if not self._strips:
            return None
        if length not in self._lengths:
            blocks = tuple(strip.block(length, self.dx) for strip in self._strips)
            self._lengths[length] = Strips(tuple(strip.rows for strip in self._strips), blocks, length)
        return self._lengths[length]

    @cached_property
    def _lengths(self) -> dict[int, Strips]:
        return {}

    def strip_inverse(self, components: tuple[int, ...]) -> StripInverse | None:
        """About the inverse of the operators among some components, 0 and 1 of shear, 2 normal; None without strips.

        Exact on rows that repeat along travel, for loads on all of their cells.
        """
        if not self._strips:
            return None
        if components not in self._inverses:
            self._inverses[components] = self._inverse_of(components)
        return self._inverses[components]

    @cached_property
    def _inverses(self) -> dict[tuple[int, ...], StripInverse]:
        return {}

    @cached_property
    def derived(self) -> dict[str, Influence]:
        """Operators that were made of these, by what they are; kept as long as these."""
        return {}

    def _inverse_of(self, components: tuple[int, ...]) -> StripInverse:
        length = int(fft.next_fast_len(self.shape[1], real=True))
        strips = self.strips_of(length)
        assert strips is not None
        # Of what lags behind, the part in phase.
        strips = replace(strips, blocks=tuple(block.real for block in strips.blocks))
        at = Offsets(self.shape[0], length // 2 + 1, self.dx, self.dy)
        if components == (2,):
            return StripInverse.of(strips, components, {(2, 2): self.pair.normal(at)})
        xx, yy, xy = self.pair.tangential(at)
        # Under shear the belt couples ribs weakly, and its inverse group by group takes a fraction of the memory.
        return StripInverse.of(strips, components, {(0, 0): xx, (1, 1): yy, (0, 1): xy}, together=False)

    @cached_property
    def dundurs(self) -> float:
        """Dundurs' β: coupling over normal compliance, the largest of the waves that the patch holds.

        The size alone, where it differs with the direction of a turned grain. Of strips the largest share of a load
        that couples, in the mean over a uniform one.
        """
        if self._strips:
            return max(coupling_of(strip.table.compliance[0]) for strip in self._strips)
        longest = np.pi / np.hypot(self.shape[0] * self.dy, self.shape[1] * self.dx)
        waves = np.geomspace(longest, np.pi / min(self.dx, self.dy), _WAVES)
        if not self.mirrored:
            parts = np.array([self.pair.towards(waves, np.pi * n / _DIRECTIONS) for n in range(_DIRECTIONS)])
            largest = float((np.linalg.norm(parts[:, 1:], axis=1) / np.abs(parts[:, 0])).max())
            return largest if largest > _ROUND_OFF else 0.0
        normal, coupling = self.pair.across(waves)
        ratio = coupling / normal
        return float(ratio[np.argmax(np.abs(ratio))])

    @property
    def coupled(self) -> bool:
        """True if pressure makes the bodies slip and shear opens the gap."""
        return self.dundurs != 0

    @cached_property
    def normal(self) -> Product:
        """Gap opening by pressure, m/Pa."""
        return self._with_strips(self.convolved_normal)

    @cached_property
    def normal_single(self) -> Product:
        """`normal` of an elastic pair in single precision, for pressure in it."""
        convolved = self.convolved_normal
        return self._with_strips(replace(convolved, spectrum=convolved.spectrum.astype(np.float32)))

    def _with_strips(self, convolved: Convolution) -> Product:
        strips = self.strips(self.padding)
        if strips is None:
            return convolved

        def both(pressure: Array) -> Array:
            return strips.added_to(lambda along: [convolved(pressure, along)], pressure[None], (2,))[0]

        return both

    @cached_property
    def convolved_normal(self) -> Convolution:
        """The part of `normal` that is the same everywhere: all of it, but of a pair with strips."""
        if self.symmetric and self.mirrored:
            return Convolution(self.padding, self.padding.even_spectrum(self._normal_quadrant))
        return Convolution(
            self.padding, self._spectra.on(self.padding, lambda at: self.pair.normal(at)[None], ((1, 1),))[0]
        )

    def normal_on(self, shape: tuple[int, int], real: DTypeLike) -> Convolution:
        """`normal` of a symmetric pair on a part of (ny, nx) cells, in a precision."""
        padding = Padding.of(shape)
        if not self.mirrored:
            across, along = (np.rint(fft.fftfreq(m, 1 / m)).astype(int) for m in padding.shape)
            kernel = self._normal_kernel[np.ix_(across, along)].astype(real)
            return Convolution(padding, np.ascontiguousarray(padding.spectrum(kernel).real.T).T)
        rows, columns = padding.quadrant
        spectrum = padding.even_spectrum(self._normal_quadrant[:rows, :columns].astype(real))
        return Convolution(padding, spectrum)

    def normal_stiffness_on(self, shape: tuple[int, int], real: DTypeLike) -> Array:
        """`normal_stiffness` of a symmetric pair on periodic (ny, nx) cells, in a precision."""
        waves = Waves(shape, self.dx, self.dy)
        return np.asarray(waves.k / self.pair.normal_compliance(waves), real)

    @property
    def normal_self_influence(self) -> float:
        """Gap opening of a cell by a unit pressure on itself, m/Pa."""
        strips = self.strips(self.padding)
        alone = 0.0 if strips is None else float(strips.alone(2, 1)[0])
        return float(self.pair.normal(Offsets(1, 1, self.dx, self.dy))[0, 0]) + alone

    def tangential(self, padding: Padding) -> Symbols:
        """Symbols (3, my, mx // 2 + 1) of the displacement difference by shear, m/Pa: xx, yy, xy.

        Real for symmetric operators. Of a pair that is not mirrored (4, …), with u_y by q_x as the fourth.
        Raises InputError where a body drifts under shear.
        """
        return self._once("tangential", padding.shape, lambda: (self._spectra.tangential(padding),))[0]

    def self_influence(self, *, rolls: bool) -> float:
        """Displacement difference u_x of a cell by a unit shear on itself, m/Pa; u_x(x) - u_x(x + dx) if it rolls."""
        xx = self.pair.tangential(Offsets(1, 2, self.dx, self.dy))[0, 0]
        strips = self.strips(self.padding)
        if strips is not None:
            xx = xx + strips.alone(0, 2)
        return float(xx[0] - xx[1]) if rolls else float(xx[0])

    @cached_property
    def normal_stiffness(self) -> Array | ComplexArray:
        """About the inverse of `normal`: its symbol (ny, nx // 2 + 1) on the unpadded, periodic grid, Pa/m."""
        return np.asarray(self._waves.k / self.pair.normal_compliance(self._waves))

    def tangential_stiffness_on(self, shape: tuple[int, int]) -> Symbols:
        """About the inverse of `tangential`, Pa/m: xx, yy, xy (3, ny, nx // 2 + 1) on periodic (ny, nx) cells."""

        def computed() -> tuple[Symbols, ...]:
            waves = Waves(shape, self.dx, self.dy)
            _, xx, yy, xy = self.pair.compliance(waves)
            return (np.asarray(waves.k * np.array([yy, xx, -xy]) / (xx * yy - xy * xy)),)

        return self._once("stiffness", shape, computed)[0]

    def gap_by_shear(self, shear: Array) -> Array:
        """Gap opening (ny, nx), m, by shear (2, ny, nx) on body 1, Pa: zero for like bodies."""
        opening = self.convolved_gap(shear)
        strips = self.strips(self.padding)
        if strips is not None:
            opening = opening + strips.displacement(shear, (0, 1), (2,), self.shape[1])[0]
        return opening

    def convolved_gap(self, shear: Array) -> Array:
        """The part of `gap_by_shear` that is the same everywhere: all of it, but of a pair with strips."""
        return self.padding.inverse((self._coupling(self.padding)[0] * self.padding.forward(shear)).sum(0))

    def slip_by_pressure(self, pressure: Array) -> Array:
        """u(x) - u(x + dx) (2, ny, nx), m, by pressure (ny, nx), Pa: zero for like bodies."""
        padding = self.rolling_padding
        u = padding.inverse(self._coupling(padding)[1] * padding.forward(pressure))
        strips = self.strips(padding)
        if strips is not None:
            u += strips.displacement(pressure[None], (2,), (0, 1), self.shape[1] + 1)
        return u[..., :-1] - u[..., 1:]

    def displacement(self, pressure: Array, shear: Array) -> Array:
        """(u_x, u_y, u_n) (3, ny, nx), m, by pressure (ny, nx) and shear on body 1 (2, ny, nx), Pa.

        Raises InputError for shear where a body drifts under it.
        """
        p = self.padding.forward(pressure)
        (k_x, k_y), (by_x, by_y) = self._coupling(self.padding)
        spectra = np.array([by_x * p, by_y * p, self.convolved_normal.spectrum * p])
        if shear.any():
            x, y = self.padding.forward(shear)
            xx, yy, xy, yx = four(self.tangential(self.padding))
            spectra += np.array([xx * x + xy * y, yx * x + yy * y, k_x * x + k_y * y])
        moved = self.padding.inverse(spectra)
        strips = self.strips(self.padding)
        if strips is not None:
            loads = np.concatenate([shear, pressure[None]])
            moved += strips.displacement(loads, (0, 1, 2), (0, 1, 2), self.shape[1])
        return moved

    def tangential_ahead(self, distance: float) -> ComplexArray:
        """`tangential` at a distance ahead of the cells along x, m, in `padding`."""
        return self._spectra.tangential_ahead(self.padding, distance)

    def coupling_ahead(self, distance: float) -> tuple[ComplexArray, ComplexArray]:
        """Symbols (2, …) of u_n by q and of u by p at a distance ahead of the cells along x, m, in `padding`."""
        return self._spectra.coupling_ahead(self.padding, distance)

    @cached_property
    def _normal_quadrant(self) -> Array:
        """The kernel of `normal` at the offsets of `Padding.quadrant`."""
        return self.pair.normal(Offsets(*self.padding.quadrant, self.dx, self.dy))

    @cached_property
    def _normal_kernel(self) -> Array:
        """The kernel of `normal` of a pair that is not mirrored, at the wrapped offsets of `padding`."""
        return self._spectra.wrapped(self.padding, self.pair.normal, 0.0)

    @property
    def _spectra(self) -> KernelSpectra:
        return KernelSpectra(self.pair, self.dx, self.dy)

    @cached_property
    def _waves(self) -> Waves:
        return Waves(self.shape, self.dx, self.dy)

    def _coupling(self, padding: Padding) -> tuple[Symbols, ...]:
        """Symbols (2, my, mx // 2 + 1) of u_n by q and of u by p, m/Pa."""
        return self._once("coupling", padding.shape, lambda: self._spectra.coupling(padding))

    def _once(
        self, name: str, shape: tuple[int, int], compute: Callable[[], tuple[Symbols, ...]]
    ) -> tuple[Symbols, ...]:
        """Symbols in a Fourier space of a shape, computed once on few cells; on many they would fill the memory.

        They depend on the pair, the cells and that shape alone: boxes of nearly the same shape share them.
        """
        if self.shape[0] * self.shape[1] > _KEPT_CELLS:
            return compute()
        kept = self._symbols.get((name, shape))
        if kept is None:
            kept = compute()
            while len(self._symbols) >= _KEPT:
                self._symbols.pop(next(iter(self._symbols)), None)
            self._symbols[name, shape] = kept
        return kept

    @cached_property
    def _symbols(self) -> _Symbols:
        try:
            return _symbols_of(self.pair, self.dx, self.dy)
        except TypeError:
            # A body that cannot be hashed.
            return {}


def operators(shape: tuple[int, int], dx: float, dy: float, pair: Body, first_y: float | None = None) -> Influence:
    """`Influence` of the same arguments. On few cells that of an earlier contact serves, with what it has computed.

    The same tire on a grid offset, under another load or with other friction has the same operators; with strips the
    rows of the grid must be the same.
    """
    if not pair.striped:
        first_y = None
    try:
        hash(pair)
    except TypeError:
        return Influence(shape, dx, dy, pair, first_y)
    is_small = shape[0] * shape[1] <= _KEPT_CELLS
    return (_kept if is_small else Influence)(shape, dx, dy, pair, first_y)


_kept = lru_cache(maxsize=_KEPT)(Influence)


@lru_cache(maxsize=_KEPT_PAIRS)
def _symbols_of(pair: Body, dx: float, dy: float) -> _Symbols:
    """What `Influence._once` keeps of a pair on cells of dx by dy, m."""
    return {}


def forget_operators() -> None:
    """Drop the operators that `operators` keeps, as before the first contact: for measurements of time and memory."""
    _kept.cache_clear()
    _symbols_of.cache_clear()
