"""Gridded loads on elastic layers: into wavenumbers and out of them as convolutions with kernels of |k| alone.

With q the shear, δ = ∂x q_x + ∂y q_y and p the pressure, the wave frame of `kernels.layers.layered` turned back to x
and y reads

    u_x = A q_x - ∂x φ,   u_y = A q_y - ∂y φ,   φ = C δ + D p,   u_z = E δ + F p,

where A to F are functions of |k|; the forces f_x, f_y, f_z follow with five functions of their own. Each is even
in kx and in ky, so that sines and cosines do not mix: one quadrant serves, in real numbers. Strain is the gradient
of u, stress follows from strain and f_z. The functions of |k| are the road's, the transforms the load's: many roads
under many loads are their products.

No lattice of wavenumbers: Gauss panels that shrink towards kx = 0 and ky = 0 see no periodic image.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.load_spectra import Cells, LoadSpectrum, slope_x, slope_y
from treadload.kernels.layers.wavenumbers import Table, gauss, tabulated

# Up to this over the length of the problem panels end at so many times their beginning.
_CALM, _STRIDE = 0.02, 5.0
# The same among the layers' own lengths: their poles lie off the axis by half their distance from zero.
_RATIO = 3.0
# Points of a panel for each radian that half of it turns, besides those of its own.
_MORE = 0.6
# Waves that a blur has faded to (1 + 4.5²/2) e^(-4.5²/2), 4e-4, are left out.
_FADED = 4.5
# Wavenumbers of a block: keeps a block's fields, some 30 numbers for each, near the cache.
_BLOCK = 30_000
# Points on both sides of 0 are alike if they differ by less than this part of the largest.
_SAME = 1e-12
# Functions of |k| are tabulated from a power of ten below the smallest that is asked for, so that tables serve again.
_DECADE = math.log(10)

# What is summed up in wavenumbers, and what of it each component takes: xx, yy, zz, xy, xz, yz, u_x, u_y, u_z.
_EXX, _EYY, _GXY, _FX, _FY, _FZ, _UX, _UY, _UZ = range(9)
_FROM = ({_EXX, _EYY, _FZ}, {_EXX, _EYY, _FZ}, {_FZ}, {_GXY}, {_FX}, {_FY}, {_UX}, {_UY}, {_UZ})
# Functions of |k| that each source takes: under pressure, and those that shear adds.
_PRESSED = ((2,), (2,), (2,), (7,), (7,), (9,), (2,), (2,), (4,))
_SHEARED = ((0, 1), (0, 1), (0, 1), (5, 6), (5, 6), (8,), (0, 1), (0, 1), (3,))


@dataclass(frozen=True)
class Accuracy:
    """How finely waves are taken.

    fall: they are cut where they have fallen to e^-fall. smallest: panels of wavenumbers start at this over the
    length of the problem. least_points, usual_points: of a panel below all lengths, and among those of the layers.
    precision: in which waves, and the half-space split off, are multiplied and added up. phase: radians that half a
    panel turns at most.
    blur: deviation, m, of a bell over which fields are averaged, 0 for none; its width is compensated, so that fields
    that vary over lengths L are off by (blur/L)^4 alone, and waves end where it has faded.
    """

    fall: float
    smallest: float
    least_points: int
    usual_points: int
    precision: type[np.floating] = np.float64
    blur: float = 0.0
    phase: float = 24.0

    @property
    def cut(self) -> float:
        """The largest wavenumber that the blur leaves, 1/m."""
        return _FADED / self.blur if self.blur else math.inf

    def blurred(self, nodes: Array, weights: Array) -> tuple[Array, Array]:
        """Nodes and weights along one axis with what the blur leaves of each wave: (1 + s²k²/2) exp(-s²k²/2)."""
        if not self.blur:
            return nodes, weights
        faded = 0.5 * (self.blur * nodes) ** 2
        return nodes, weights * (1 + faded) * np.exp(-faded)


# Errors by a field's largest value, measured: 1e-11 of stress and strain, 1e-9 of displacement, which goes as 1/k.
# Cut at e^-33, with powers of k h before, waves leave 1e-10 of the strain, counted in soft soil below a stiff layer;
# at e^-27 3e-7, at e^-36 4e-12.
FULL = Accuracy(33.0, 1e-7, 8, 10)
# 1e-7 of stress and strain alone, see `tests/unit/test_synthesis.py`: for what is read in five digits, a third of
# the cost; 1e-6 with single numbers, half of that again.
READING = Accuracy(28.0, 1e-4, 4, 6, np.float32)
# The same with double numbers, where the largest of many values is looked for.
SEARCH = replace(READING, precision=np.float64)
# Stress in the layers that cracks grow through: 1e-6 of the largest on soft soil, a quarter of the cost of a reading.
CRACKS = Accuracy(20.0, 1e-3, 3, 5, np.float32, phase=72.0)
# The basin around wheels, beyond three deviations of what they load: bending alone, with no edge of a rib.
BASIN = Accuracy(28.0, 1e-3, 3, 5, np.float32, blur=0.028, phase=72.0)


@dataclass(frozen=True, eq=False)
class ElasticPlane:
    """One depth of one road to synthesise.

    kernels: k (n,) → (4, 2, n) and (2, n), as one depth of `kernels.layers.layered.Transfer`. shear, poisson: of the
    material there, Pa and 1, in the horizontal plane. limit: largest wavenumber that matters at this depth, 1/m.
    lift: see `kernels.layers.layered.Stack.lift_of`; None is isotropy.
    What it makes of wavenumbers is tabulated once, however many loads stand on it.
    """

    kernels: Callable[[Array], tuple[Array, Array]]
    shear: float
    poisson: float
    limit: float
    lift: float | None = None
    _tables: dict[tuple[int, type[np.floating]], Table] = field(default_factory=dict, repr=False)

    def radial(
        self, log_k: Array, functions: Sequence[int], smallest: float, precision: type[np.floating]
    ) -> dict[int, Array]:
        """Functions of the displacement, A, C, D, E, F, 0 to 4, and of the force, 5 to 9, (nky, nkx) each.

        log_k: ln |k|, (nky, nkx). functions: those to give. smallest: of all k that will be asked for, 1/m.
        """
        decade = math.floor(math.log(smallest) / _DECADE)
        key = (decade, precision)
        if key not in self._tables:
            lowest = math.exp(_DECADE * decade)
            self._tables[key] = tabulated(self._functions, lowest, 1.5 * self.limit, precision)
        values = np.moveaxis(self._tables[key](log_k, functions), -1, 0)
        return dict(zip(functions, values.astype(precision, order="C"), strict=True))

    def _functions(self, k: Array) -> Array:
        """As functions of k (n,) → (10, n)."""
        kernel, turned = self.kernels(k)

        def five(rows: Array, transverse: Array) -> list[Array]:
            ahead, down = rows
            return [transverse, (ahead[0] - transverse) / k**2, ahead[1] / k, down[0] / k, down[1]]

        moved, pushed = np.stack(five(kernel[:2], turned[0])) / k, np.stack(five(kernel[2:], turned[1]))
        return np.concatenate([moved, pushed])


@lru_cache(maxsize=256)
def rule(limit: float, reach: float, length: float, accuracy: Accuracy = FULL) -> tuple[Array, Array]:
    """Nodes (n,), rising, and weights, 1/m, on (0, limit) for a transform.

    limit: largest wavenumber, 1/m. reach: largest distance between a loaded and an output point along this axis,
    m. length: the largest length in the field, m: the reach or the characteristic length of the layers.
    """
    widest = 2 * accuracy.phase / max(reach, 1e-12)
    low, nodes, weights = 0.0, [], []
    while low < limit:
        calm = low * length < _CALM
        high = accuracy.smallest / length if low == 0 else (_STRIDE if calm else _RATIO) * low
        high = min(limit, high, low + widest)
        count = (accuracy.least_points if calm else accuracy.usual_points) + math.ceil(
            0.5 * (high - low) * reach * _MORE
        )
        points, share = _gauss(count)
        nodes.append(0.5 * (high - low) * points + 0.5 * (high + low))
        weights.append(0.5 * (high - low) * share)
        low = high
    return np.concatenate(nodes), np.concatenate(weights)


@lru_cache(maxsize=128)
def _gauss(count: int) -> tuple[Array, Array]:
    points, share = gauss(count)
    return points, share


def synthesise_cells(
    loads: Sequence[Sequence[Cells]],
    planes: Sequence[ElasticPlane],
    pairs: Sequence[tuple[int, int]],
    x: Array,
    y: Array,
    along: tuple[Array, Array],
    across: tuple[Array, Array],
    at: Points | None = None,
    components: Sequence[int] = range(9),
    precision: type[np.floating] = np.float64,
) -> Array:
    """Stress and displacement of elastic layers under gridded loads.

    loads: each a sum of cells. planes: depths, of one road or of many. pairs: (n) of a load and a plane, by number.
    x: (mx,), y: (my,), m, any coordinates. along, across: nodes and weights in kx and in ky, see `rule`. at: of the
    grid of x and y only these points. components: those to compute of xx, yy, zz, xy, xz, yz in Pa, tension positive,
    and u_x, u_y, u_z in m, z down. precision: in which waves are multiplied and added up, see `Accuracy`.
    Returns (n, len(components), my, mx) in that precision, the pairs of a component side by side. Every load is
    transformed once, every plane gives its functions of |k| once, and a pair is their product. Works in blocks of kx;
    the cost is that of the wavenumbers, whatever the number of cells times points.
    """
    (kx_all, wx_all), (ky_all, wy_all) = along, across
    sources = sorted(set().union(*(_FROM[component] for component in components)))
    sheared = any(cells.load[1:].any() for load in loads for cells in load)
    uses = [_PRESSED, _SHEARED] if sheared else [_PRESSED]
    functions = sorted({function for use in uses for source in sources for function in use[source]})
    smallest = math.hypot(kx_all[0], ky_all[0])
    rows = [int(np.searchsorted(ky_all, plane.limit, side="right")) for plane in planes]
    ky_all, wy_all = ky_all[: max(rows)], wy_all[: max(rows)]
    # At points on both sides of 0 alike, what is even and odd along and across is added up on one side alone.
    folded = at is None and _is_symmetric(x) and _is_symmetric(y)
    shape = (len(y), len(x)) if at is None else at.shape
    if folded:
        x, y = x[len(x) // 2 :], y[len(y) // 2 :]
    back = _back(ky_all, wy_all / math.pi**2, y).astype(precision)
    transforms = [LoadSpectrum.of(load, ky_all, precision) for load in loads]
    each = (2, len(sources), 2, len(y), len(x)) if folded else (len(sources), *shape)
    sums = np.zeros((len(pairs), *each), precision)
    step = max(1, _BLOCK // max(rows))
    for start in range(0, len(kx_all), step):
        kx, wx = kx_all[start : start + step], wx_all[start : start + step]
        if all(kx[0] > plane.limit for plane in planes):
            break
        spectra = [transform.at(kx, ky_all) for transform in transforms]
        log_k = np.log(np.hypot(kx, ky_all[:, None]))
        out = _back(kx, wx, x).astype(precision, copy=False)
        short_x, short_y = kx.astype(precision, copy=False), ky_all.astype(precision, copy=False)[:, None]
        for number, (plane, n) in enumerate(zip(planes, rows, strict=True)):
            served = [(place, load) for place, (load, plane) in enumerate(pairs) if plane == number]
            count = int(np.searchsorted(kx, plane.limit, side="right"))
            if not count or not served:
                continue
            radial = plane.radial(log_k[:n, :count], functions, smallest, precision)
            for place, load in served:
                waves = _waves(spectra[load][..., :n, :count], radial, short_x[:count], short_y[:n], sources)
                if folded:
                    _add_parts(sums[place], waves, back[:, :n], out[:, :count])
                else:
                    _add(sums[place], waves, back[:, :n], out[:, :count], at)
    places = dict(zip(sources, range(len(sources)), strict=True))
    fields = np.empty((len(components), len(pairs), *shape), precision)
    for number, (parts, (_, index)) in enumerate(zip(sums, pairs, strict=True)):
        total = _unfolded(parts, shape) if folded else parts
        _components(total, places, planes[index], components, fields[:, number])
    return fields.swapaxes(0, 1)


def _back(k: Array, weights: Array, x: Array) -> Array:
    """Matrices (2, nk, mx) from cosine and sine parts to the value at x."""
    turn = np.outer(k, x)
    return np.stack([np.cos(turn), np.sin(turn)]) * weights[:, None]


def _waves(spectrum: Array, radial: Mapping[int, Array], kx: Array, ky: Array, sources: Sequence[int]) -> Array:
    """Fields in wavenumbers, (2, n, 2, nky, nkx): cosine and sine parts along x, the sources, the parts along y.

    spectrum: of the load, see `LoadSpectrum.at`. radial: see `ElasticPlane.radial`. ky: (nky, 1).
    """
    pressure = spectrum[0]
    divergence = spectrum[3] + spectrum[4] if len(spectrum) > 1 else None

    def joined(by_pressure: int, by_divergence: int) -> Array:
        value: Array = pressure * radial[by_pressure]
        if divergence is not None:
            value += divergence * radial[by_divergence]
        return value

    def turned(potential: Array, by: int, shear: int) -> Array:
        """What shear does alone less the slope of a potential, in place of the slope."""
        if divergence is None:
            np.negative(potential, out=potential)
        else:
            np.subtract(spectrum[shear] * radial[by], potential, out=potential)
        return potential

    waves = np.empty((2, len(sources), *pressure.shape[1:]), pressure.dtype)
    phi = joined(2, 1) if {_EXX, _EYY, _GXY, _UX, _UY} & set(sources) else pressure
    psi = joined(7, 6) if {_FX, _FY} & set(sources) else pressure
    make = {
        _EXX: lambda: turned(phi * -(kx * kx), 0, 3),
        _EYY: lambda: turned(phi * -(ky * ky), 0, 4),
        _GXY: lambda: turned(slope_x(slope_y(phi, ky), 2 * kx), 0, 5),
        _FX: lambda: turned(slope_x(psi, kx), 5, 1),
        _FY: lambda: turned(slope_y(psi, ky), 5, 2),
        _FZ: lambda: joined(9, 8),
        _UX: lambda: turned(slope_x(phi, kx), 0, 1),
        _UY: lambda: turned(slope_y(phi, ky), 0, 2),
        _UZ: lambda: joined(4, 3),
    }
    for place, source in enumerate(sources):
        waves[:, place] = make[source]()
    return waves


def _is_symmetric(x: Array) -> bool:
    """Whether rising points lie on both sides of 0 alike."""
    return bool(np.abs(x + x[::-1]).max() <= _SAME * np.abs(x).max())


def _add_parts(total: Array, waves: Array, back: Array, out: Array) -> None:
    """Add a block to the parts even and odd along and across, (2, n, 2, my, mx), see `_unfolded`; else as `_add`."""
    to_y = back.swapaxes(1, 2)
    rows, columns = waves.shape[3:]
    my, mx = to_y.shape[1], out.shape[2]
    along_first = mx * rows * (columns + my) < my * columns * (rows + mx)
    for parts, part, matrix in zip(total, waves, out, strict=True):
        parts += to_y @ (part @ matrix) if along_first else (to_y @ part) @ matrix


def _unfolded(parts: Array, shape: tuple[int, int]) -> Array:
    """Sources (n, my, mx) at points on both sides of 0 from their parts even and odd along and across.

    parts: (2, n, 2, ...), at the points that are not below 0. shape: (my, mx).
    """
    my, mx = shape
    even, odd = parts
    lines = np.concatenate([(even - odd)[..., mx % 2 :][..., ::-1], even + odd], axis=-1)
    even, odd = lines[:, 0], lines[:, 1]
    sources: Array = np.concatenate([(even - odd)[:, my % 2 :][:, ::-1], even + odd], axis=1)
    return sources


def _add(total: Array, waves: Array, back: Array, out: Array, at: Points | None) -> None:
    """Add a block to the sources (n, my, mx). back: (2, nky, my); out: (2, nkx, mx)."""
    rows, columns = waves.shape[3:]
    to_y = back.reshape(2 * rows, -1).T
    my, mx = len(to_y), out.shape[2]
    if at is not None:
        upright, level = at.halves
        if len(upright.members):
            lines = _along_x(waves, out[:, :, upright.columns]).swapaxes(1, 2)
            total[..., upright.members] += upright.points.transposed.product(lines, to_y[upright.rows].T)
        if len(level.members):
            for part, matrix in zip(_along_y(waves, to_y[level.rows]), out[:, :, level.columns], strict=True):
                total[..., level.members] += level.points.product(part, matrix)
    elif mx * (2 * columns + my) < my * (2 * columns + mx * columns / rows):
        # Along x first, which is fewer products here.
        total += to_y @ _along_x(waves, out)
    else:
        for part, matrix in zip(_along_y(waves, to_y), out, strict=True):
            total += part @ matrix


def _along_x(waves: Array, out: Array) -> Array:
    """Waves summed along x, (n, 2 nky, mx)."""
    _, count, _, rows, columns = waves.shape
    lines: Array = waves[0].reshape(-1, columns) @ out[0]
    lines += waves[1].reshape(-1, columns) @ out[1]
    return lines.reshape(count, 2 * rows, -1)


def _along_y(waves: Array, to_y: Array) -> Array:
    """Cosine and sine parts along x of waves summed along y, (2, n, my, nkx)."""
    _, count, _, rows, columns = waves.shape
    lines: Array = to_y @ waves.reshape(2, count, 2 * rows, columns)
    return lines


def _components(
    total: Array, place: Mapping[int, int], plane: ElasticPlane, components: Sequence[int], out: Array
) -> None:
    """Stress and displacement, into (n, my, mx), from what was summed up. place: of each source in the sum."""
    nu, double = plane.poisson, 2 * plane.shear
    lifted = nu if plane.lift is None else plane.lift * (1 - nu)

    def normal(along: int, across: int) -> Array:
        stress: Array = double * (total[place[along]] + nu * total[place[across]]) - lifted * total[place[_FZ]]
        return stress / (1 - nu)

    make = (
        lambda: normal(_EXX, _EYY),
        lambda: normal(_EYY, _EXX),
        lambda: -total[place[_FZ]],
        lambda: 0.5 * double * total[place[_GXY]],
        lambda: -total[place[_FX]],
        lambda: -total[place[_FY]],
        lambda: total[place[_UX]],
        lambda: total[place[_UY]],
        lambda: total[place[_UZ]],
    )
    for part, component in zip(out, components, strict=True):
        part[...] = make[component]()
