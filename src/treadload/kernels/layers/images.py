"""Surface displacement of layers under a uniformly loaded rectangle, as a sum of images of the load.

The compliance of the surface in wavenumbers, times k, is that of a half-space of the top layer plus what the
layers change. The change is smooth, so a sum of e^{-k b} over many depths b reproduces it. Each term is the
field at height b above a point load, whose integral over a rectangle is closed: coefficients without a period,
without a grid in k, and for any cell.

With R² = x² + y² + b², for the body under the load, z down, per unit load

    u_z by p:  n/(2π) 1/R                    u_x by p:  c/(2π) x/(R (R + b))  (u_z by -q_x alike)
    u_i by q_j:  1/(2π) [t δ_ij/R - d ∂_i ∂_j V],   V = b ln(R + b) - R

where n, c, t and d are the parts of k·u_z, k·i u_k, k·u_t and k·(i u_k - u_t) that go with e^{-k b}.

Source: complex-image fits as for layered electromagnetic media, Chow, Yang, Fang & Howard (1991), IEEE Trans.
Microw. Theory Tech. 39, 588-592; here with fixed real depths and linear least squares.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.layers.layered import Stack, transfer

# Images per decade of depth, from this part of the top layer to this multiple of the longest length of the stack.
# Measured on soft, stiff, thin, sprung and inverted stacks: a residual of 1e-9 to 8e-7. Fewer images fit worse,
# more of them grow large and cancel.
_A_DECADE = 16
_NEAREST, _FARTHEST = 0.5, 30.0
_SAMPLES_A_DECADE = 40
# The change of the layers is e^{-2 k h}: at k h = 40 nothing is left.
_CUT = 40.0
# The limit of long waves is exact: it counts as this many samples.
_LIMIT = 10.0
# Compliance below this part of the top layer's is fitted to that part of the top layer's: stiffer layers below a
# soft one are seen by wide contacts, a rigid base lets no field reach them.
_FLOOR, _FLOOR_ON_ROCK = 1e-3, 1e-2
# Longest wave on a rigid base, times that length: longer ones feel the limit alone, and their samples take images
# from where they are needed; a tenth of it fits worse.
_LONGEST_ON_ROCK = 0.03
# Coefficients are kept for whole multiples of these many cells, which neighbouring shapes share; fewer cells are not
# worth a place.
_ROUND = 32


@dataclass(frozen=True, eq=False)
class Images:
    """What layers add to the compliance of a half-space of the top layer's material: Σ part · e^{-k depth}.

    depth: (n,), m, > 0. normal, coupling, transverse, difference: (n,), 1/Pa: parts of k·u_z by p, of k·i u_k
    by p (and k·u_z by the shear i q_k), of k·u_t by q_t, and of k·i u_k by i q_k less k·u_t by q_t.
    bonded: False if a frictionless interface lets the top drift under shear: transverse and difference are NaN.
    residual: largest error of the fit, relative to the compliance of the whole at that wavenumber, or to 0.1 % of
    the top layer's (1 % on a rigid base) where the whole is less.
    """

    depth: Array
    normal: Array
    coupling: Array
    transverse: Array
    difference: Array
    bonded: bool
    residual: float

    def at(self, wavenumbers: Array) -> Array:
        """Normal, coupling, transverse and difference part (4, …) at wavenumbers (…), 1/m."""
        parts = np.stack([self.normal, self.coupling, self.transverse, self.difference])
        fades = np.exp(-self.depth[:, None] * np.ravel(wavenumbers))
        values: Array = (parts @ fades).reshape(4, *np.shape(wavenumbers))
        return values


def fit_images(stack: Stack) -> Images:
    """Images of layers of real moduli; the residual is measured between the samples of the fit.

    Accuracy: a residual below 1e-6 for roads with moduli up to six decades apart; up to 1e-4 where incompressible
    layers lie between loose interfaces and a rigid base.
    """
    bonded = 0.0 not in stack.spring
    length = _longest(stack)
    first = stack.faded(stack.thickness[0])
    near, far = _NEAREST * first, _FARTHEST * length
    depth = np.geomspace(near, far, math.ceil(_A_DECADE * math.log10(far / near)))
    # On a rigid base compliance falls with k itself: its limit says all that lies below.
    low = _LONGEST_ON_ROCK / length if stack.rigid else 1e-2 / far
    high = _CUT / first
    samples = np.geomspace(low, high, 2 * math.ceil(_SAMPLES_A_DECADE * math.log10(high / low)) + 1)
    top = half_space_compliance(stack, 0)
    end = np.zeros(4) if stack.rigid else half_space_compliance(stack, -1)
    floor = _FLOOR_ON_ROCK if stack.rigid else _FLOOR
    whole = surface_compliance(samples, stack)
    change = whole - top[:, None]
    fades = np.exp(-np.outer(samples, depth))
    parts = np.full((4, depth.size), math.nan)
    residual = 0.0
    for row in range(4 if bonded else 2):
        # Normal and coupling are measured against the normal compliance, the two of shear against the transverse.
        scale = 0 if row < 2 else 2
        weight = 1 / np.maximum(np.abs(whole[scale]), floor * top[scale])
        equations, sides = weight[::2, None] * fades[::2], weight[::2] * change[row, ::2]
        if bonded or row == 0:
            limit = _LIMIT * weight[0]
            equations = np.vstack([equations, np.full(depth.size, limit)])
            sides = np.append(sides, limit * (end[row] - top[row]))
        parts[row] = np.linalg.lstsq(equations, sides, rcond=1e-15)[0]
        residual = max(residual, float(np.abs(weight * (fades @ parts[row] - change[row])).max()))
    normal, coupling, transverse, difference = parts
    return Images(depth, normal, coupling, transverse, difference, bonded, residual)


def surface_compliance(wavenumbers: Array, stack: Stack) -> Array:
    """k·u_z by p, k·i u_k by p, k·u_t by q_t and k·i u_k by i q_k less that: (4, nk), 1/Pa, of the surface."""
    result = transfer(wavenumbers, stack, [0.0], [True])
    plane, transverse = result.plane[0], result.transverse[0, 0]
    compliance: Array = np.stack([plane[1, 1], plane[0, 1], transverse, plane[0, 0] - transverse])
    return compliance


def coefficients(images: Images, ny: int, nx: int, dx: float, dy: float, first: float = 0.0) -> Array:
    """Displacement of the surface by unit loads on a cell, at distances from its centre: (6, ny, nx), m/Pa.

    At x = first + dx · (0 … nx-1) and y = dy · (0 … ny-1), m:
    u_z by p (even in x and y); u_x by q_x, u_y by q_y (even), u_x by q_y = u_y by q_x (odd in both); k_x (odd in
    x), k_y (odd in y): u_x = k_x ∗ p, u_z = -(k_x ∗ q_x + k_y ∗ q_y). Positive along +x, +y and down.
    """
    if nx < _ROUND:
        return _sums(images, ny, nx, dx, dy, first)
    rows, columns = -(-ny // _ROUND) * _ROUND, -(-nx // _ROUND) * _ROUND
    return _coefficients(images, rows, columns, dx, dy, first)[:, :ny, :nx]


@lru_cache(maxsize=8)
def _coefficients(images: Images, ny: int, nx: int, dx: float, dy: float, first: float) -> Array:
    return _sums(images, ny, nx, dx, dy, first)


def _sums(images: Images, ny: int, nx: int, dx: float, dy: float, first: float) -> Array:
    x, y = first + dx * (np.arange(nx + 1) - 0.5)[None, :], dy * (np.arange(ny + 1) - 0.5)[:, None]
    total = np.zeros((6, ny + 1, nx + 1))
    xy, squared = x * y, x**2 + y**2
    shear = images.bonded
    for b, n, c, t, d in zip(
        images.depth, images.normal, images.coupling, images.transverse, images.difference, strict=True
    ):
        root = np.sqrt(squared + b * b)
        # asinh(y/√(x² + b²)) and its fellow; multiples of one of them that a corner sum drops are left out.
        along_x, along_y = np.arcsinh(y / np.sqrt(x**2 + b * b)), np.arcsinh(x / np.sqrt(y**2 + b * b))
        angle_x = np.arctan(xy / (b * (root + b) + x**2))
        angle_y = np.arctan(xy / (b * (root + b) + y**2))
        # ln((R + b)/2b), and R - b, without loss of digits where b is large.
        rise = squared / (root + b)
        logarithm = np.log1p(rise / (2 * b))
        part_x, part_y = x * along_x - b * angle_x, y * along_y - b * angle_y
        total[0] += n * (part_x + part_y)
        total[4] += c * (y * logarithm + b * along_x + x * angle_x)
        total[5] += c * (x * logarithm + b * along_y + y * angle_y)
        if shear:
            total[1] += (t + d) * part_x + t * part_y
            total[2] += t * part_x + (t + d) * part_y
            total[3] += d * (rise - b * logarithm)
    if not shear:
        total[1:4] = math.nan
    sums: Array = (total[:, 1:, 1:] - total[:, 1:, :-1] - total[:, :-1, 1:] + total[:, :-1, :-1]) / (2 * np.pi)
    return sums


def half_space_compliance(stack: Stack, layer: int) -> Array:
    """`surface_compliance`, (4,), 1/Pa, of a half-space of one of the layers.

    Source: Johnson (1985), Contact Mechanics, section 3; of layers that are another along z that of
    `kernels.layers.upright`.
    """
    shear, poisson, upright = stack.shear[layer], stack.poisson[layer], stack.upright_of(layer)
    if upright is None:
        return np.array([1 - poisson, -(1 - 2 * poisson) / 2, 1.0, -poisson]) / float(shear)
    xx, zz, xz, transverse = upright.half_space(float(shear), poisson)
    return np.array([zz, xz, transverse, xx - transverse])


def _longest(stack: Stack) -> float:
    """The longest length over which layers act together, m: stretching, bending and sliding of the stiffest."""
    depth, stiffest, softest = float(stack.interfaces[-1]), max(stack.moduli), min(stack.moduli)
    last = stack.upright_of(-1)
    lowest = float(stack.shear[-1]) if last is None else min(float(stack.shear[-1]), last.shear)
    length = depth * math.cbrt(stiffest / softest)
    if not stack.rigid:
        length = max(length, depth * stiffest / lowest)
    for spring in stack.spring:
        if 0 < spring < math.inf:
            length = max(length, stiffest / spring, math.sqrt(stiffest * depth / spring))
    return length
