"""Stress and displacement inside an anisotropic half-space under uniformly loaded rectangles, the surface included.

A wave of traction t makes u = Σ a f exp(ik w)/k with three modes of Stroh, w = x cos θ + y sin θ + p z, Im p > 0, so
that a rectangle gives the sums [[ ]] over its corners, at distances X, Y, of

    F = (1/4π²) ∮ Σ B(θ) ln(-i w) dθ / (cos θ sin θ),   B = i C:(a ⊗ (m + p n)) f,   f = (-i b)⁻¹ t,

over a whole turn; of the displacement with i a f w (ln(-i w) - 1) in place of B ln(-i w). On the real axis w passes
by zero closely where z is small beside the distance R, and 1/(cos θ sin θ) has poles, whose residues depend on X or
on Y alone and cancel in the sums. Both are met by the path of integration, θ - i h sin(θ - φ) with φ near the
direction of the corner: there |w| > 0.7 h R even on the surface, so that a fixed number of points serves all depths
and distances. Four paths do, each for the corners of one quadrant; what lies between them are the residues, added in
closed form. The branches of p follow from the real axis; the paths leave it as far as the modes stay apart from their
conjugates.

Load, signs and components as in `kernels.half_space.interior`.
Sources: Ting (1996), Anisotropic Elasticity, chapters 5 and 8; Willis (1966), J. Mech. Phys. Solids 14, 163-176.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from treadload.kernels.anisotropy.stiffness import as_tensor
from treadload.kernels.anisotropy.symbol import NotConvergedError
from treadload.kernels.arrays import Array, BoolArray, ComplexArray
from treadload.kernels.gridding.gridded import Method, on_grid
from treadload.kernels.gridding.lattice import Corner, Source, of_corners
from treadload.kernels.half_space.corners import SNAP, is_surface, snapped

_ROW, _COLUMN = np.array([0, 1, 2, 0, 0, 1]), np.array([0, 1, 2, 1, 2, 2])
"""Of xx, yy, zz, xy, xz, yz."""
# Corners of one quadrant share a path.
_SECTORS = 4
# How far the paths may leave the real axis, step by step, as long as the modes stay as far from their conjugates as
# this part of what they do on it.
_HEIGHTS, _APART = (0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.45, 0.6, 0.8), 0.3
_SAMPLES = 256
# Points of half a path: half as many more until that changes the largest field of a corner by less than this.
_FEWEST, _MOST, _CONVERGED = 16, 1000, 1e-10
# Modes nearer to each other than this lose digits: the stiffness is then changed by as little as it says.
_DEFECTIVE, _SPLIT = 1e6, 1e-9
# Corners that are worked on together.
_AT_ONCE = 4096


@dataclass(frozen=True, eq=False)
class _Path:
    """One path, for directions of corners near φ. side_x, side_y: signs of X and Y there.

    along, across: cos θ and sin θ (n,). p: (n, 3). stress: (n·3, 18), weights of ln(-i w), component by component
    under p, t_x, t_y. displacement: (n·3, 27), of ln(-i w) - 1, those to be multiplied by x, by y and by z.
    """

    side_x: float
    side_y: float
    along: ComplexArray
    across: ComplexArray
    p: ComplexArray
    stress: ComplexArray
    displacement: ComplexArray


_Pole = tuple[ComplexArray, ComplexArray, ComplexArray]
"""Modes at a pole: p (3,), weights (3, 18) of stress and (3, 9) of displacement."""


@dataclass(frozen=True, eq=False)
class Modes:
    """What the inside of an anisotropic half-space needs of its stiffness.

    paths: one for each quadrant. poles: modes at θ = 0 and π/2. points: of half a path. error: of the fields of a
    corner, measured, relative to the largest. split: True if modes fell together and the stiffness was changed by
    1e-9 of it.
    """

    paths: tuple[_Path, ...]
    poles: tuple[_Pole, ...]
    points: int
    error: float
    split: bool

    @classmethod
    def of(cls, stiffness: Array) -> Modes:
        """Of a stiffness (6, 6), Pa, positive definite. Raises NotConvergedError where 1024 points do not suffice."""
        scale = float(np.abs(stiffness).max())
        matrix, split = stiffness / scale, False
        if _worst(matrix) > _DEFECTIVE:
            pattern = 1 + 0.5 * np.sin(np.arange(6.0))
            matrix, split = matrix * (1 + _SPLIT * np.outer(pattern, pattern)), True
        height = _height(matrix)
        poles, angle = _poles(matrix, scale), 2 * math.pi * (np.arange(24) + 0.37) / 24

        def tried(points: int) -> tuple[Modes, Array]:
            # Corners all around stand for all: stress depends on the direction from the corner alone.
            modes = cls(_paths(matrix, height, points, scale), poles, points, 0.0, split)
            fields = [corner_fields(modes, np.cos(angle), np.sin(angle), z) for z in (0.0, 0.05, 1.0)]
            return modes, np.concatenate(fields, axis=-1) * np.where(np.arange(27) < 18, 1, scale)[:, None]

        modes, values = tried(_FEWEST)
        while 1.5 * modes.points < _MOST:
            finer, better = tried(modes.points * 3 // 2)
            error = float(np.abs(values - better).max() / np.abs(better).max())
            if error <= _CONVERGED:
                return replace(modes, error=error)
            modes, values = finer, better
        raise NotConvergedError(f"{_MOST} directions do not resolve the stress below the surface")


def fields_on_grid(
    load: Array,
    dx: float,
    dy: float,
    depths: Array,
    unit: float,
    modes: Modes,
    x: Array,
    y: Array,
    method: Method = "auto",
    *,
    moves: bool = True,
) -> tuple[Array, Array, str]:
    """Stress and displacement on the grid of any coordinates x and y, by the cheapest method.

    modes: of the stiffness over a unit, Pa. The others, and what is returned, as in
    `kernels.half_space.interior.fields_on_grid`.
    """

    def corners(x: Array, y: Array, z: float) -> Iterator[Corner]:
        shape = np.broadcast_shapes(x.shape, y.shape)
        flat_x, flat_y = (np.broadcast_to(places, shape).ravel() for places in (snapped(x, dx), snapped(y, dy)))
        z = 0.0 if is_surface(z, dx, dy) else z
        both = corner_fields(modes, flat_x, flat_y, z, dx, dy, moves=moves).reshape(-1, *shape)
        for number, values in enumerate(both):
            component, load = divmod(number, 3)
            yield values, ((load, component),)

    both, used = on_grid(Source(load, dx, dy, of_corners(corners, dx, dy), 9), depths, x, y, method)
    return both[:, :6], both[:, 6:] / unit, used


def corner_fields(
    modes: Modes, x: Array, y: Array, z: float, dx: float = 1.0, dy: float = 1.0, *, moves: bool = True
) -> Array:
    """Functions (27, n) whose sums over corners are stress xx … yz and displacement x, y, z, each by p, t_x, t_y.

    x, y: (n,) from a corner, z: depth, m. moves: False leaves the last nine out, (18, n). On the surface a quantity
    that jumps takes the mean of its sides, and logarithms are cut as in `kernels.half_space.corners.at_corners`, by
    the cell dx by dy, m.
    """
    result = np.zeros((27 if moves else 18, x.size))
    if z > 0:
        _on_sides(modes, x, y, z, moves, result, slice(None))
        return result
    middle = (x == 0) | (y == 0)
    _on_sides(modes, x[~middle], y[~middle], 0.0, moves, result, ~middle)
    if middle.any():
        result[:, middle] = _between(modes, x[middle], y[middle], dx, dy, moves)
    return result


def _between(modes: Modes, x: Array, y: Array, dx: float, dy: float, moves: bool) -> Array:
    """The functions of `corner_fields` on the surface where x or y is zero."""
    values = np.zeros((27 if moves else 18, x.size))
    # The mean of the sides, a hair's breadth away; then the logarithm of that breadth becomes the other one.
    for shift_x in (-SNAP * dx, SNAP * dx):
        for shift_y in (-SNAP * dy, SNAP * dy):
            part = np.empty_like(values)
            near = np.where(x == 0, shift_x, x), np.where(y == 0, shift_y, y)
            _on_sides(modes, *near, 0.0, moves, part, slice(None))
            values += 0.25 * part
    cut, level = -math.log(2 * math.pi * SNAP), math.log(0.27 * math.sqrt(dx * dy) / (SNAP * math.hypot(dx, dy)))
    by_x, by_y = (-weights.sum(0).imag / (2 * math.pi) for _, weights, _ in modes.poles)
    values[:18] += cut * (np.outer(by_x, np.sign(y) * (x == 0)) + np.outer(by_y, np.sign(x) * (y == 0)))
    values[:18] += np.outer(_rise(modes), level * ((x == 0) & (y == 0)))
    return values


def _rise(modes: Modes) -> Array:
    """By how much the functions of a corner, stress (18,), grow on the surface with the logarithm of the distance."""
    near, far = np.zeros((18, 1)), np.zeros((18, 1))
    for distance, into in ((1.0, near), (math.e, far)):
        _on_sides(modes, np.array([distance]), np.array([0.7 * distance]), 0.0, False, into, slice(None))
    return np.asarray((far - near)[:, 0])


def _on_sides(
    modes: Modes, x: Array, y: Array, z: float, moves: bool, into: Array, places: slice | BoolArray
) -> None:
    """Fill in the functions of corners none of which is singular."""
    values = np.empty((into.shape[0], x.size))
    sector = np.floor(np.arctan2(y, x) * (_SECTORS / (2 * math.pi))).astype(int) % _SECTORS
    for number, path in enumerate(modes.paths):
        members = np.flatnonzero(sector == number)
        for batch in np.array_split(members, max(1, -(-members.size // _AT_ONCE))):
            if batch.size:
                values[:, batch] = _along(path, modes.poles, x[batch], y[batch], z, moves)
    into[:, places] = values


def _along(path: _Path, poles: tuple[_Pole, ...], x: Array, y: Array, z: float, moves: bool) -> Array:
    """The functions (27 or 18, n) of corners near the direction of a path."""
    c, s, p = path.along, path.across, path.p
    w_r = (np.multiply.outer(x, c.real) + np.multiply.outer(y, s.real))[..., None] + z * p.real
    w_i = (np.multiply.outer(x, c.imag) + np.multiply.outer(y, s.imag))[..., None] + z * p.imag
    # ln(-i w) in real numbers: five times quicker than in complex ones.
    size = 0.5 * np.log(w_r * w_r + w_i * w_i).reshape(x.size, -1)
    turn = np.arctan2(-w_r, w_i).reshape(x.size, -1)
    parts = [size @ path.stress.real - turn @ path.stress.imag]
    if moves:
        # w is x cos θ + y sin θ + p z, so that its product with the logarithm needs no product at the points.
        size -= 1
        by_x, by_y, by_z = np.split(size @ path.displacement.real - turn @ path.displacement.imag, 3, axis=1)
        parts.append(x[:, None] * by_x + y[:, None] * by_y + z * by_z)
    # What the path leaves on the other side of the poles on the real axis: functions of X alone, of Y alone.
    for side, at, (p, stress, displacement) in zip((path.side_y, path.side_x), (x, y), poles, strict=True):
        w = at[:, None] + z * p
        log = np.log(-1j * w)
        parts[0] -= side / (2 * math.pi) * (log @ stress).imag
        if moves:
            parts[1] -= side / (2 * math.pi) * ((w * (log - 1)) @ displacement).imag
    return np.concatenate([part.T for part in parts])


def _modes(
    matrix: Array, along: ComplexArray, across: ComplexArray
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """P (n, 3), and weights per load (n, 3, 6, 3) of stress and (n, 3, 3, 3) of displacement.

    along, across: cos θ and sin θ (n,), which may be complex.
    """
    tensor, m = as_tensor(matrix), np.stack([along, across, np.zeros_like(along)], axis=-1)
    n = np.array([0.0, 0.0, 1.0])
    p, vectors = np.linalg.eig(_fundamental(tensor, m))
    order = np.argsort(-p.imag, axis=1)[:, :3]
    p = np.take_along_axis(p, order, 1)
    vectors = np.take_along_axis(vectors, order[:, None, :], 2)
    a, b = vectors[:, :3], vectors[:, 3:]
    # f (mode, load): loads are p, t_x, t_y, of which p acts along z.
    f = np.linalg.inv(-1j * b)[:, :, [2, 0, 1]]
    direction = m[:, None, :] + p[..., None] * n
    strain = np.einsum("nkm,nml->nmkl", a, direction)
    stress = 1j * np.einsum("ijkl,nmkl->nmij", tensor, strain, optimize=True)[..., _ROW, _COLUMN]
    return p, stress[..., None] * f[:, :, None, :], 1j * a.transpose(0, 2, 1)[..., None] * f[:, :, None, :]


def _paths(matrix: Array, height: float, points: int, scale: float) -> tuple[_Path, ...]:
    paths = []
    turn = math.pi * (np.arange(points) + 0.5) / points
    for number in range(_SECTORS):
        direction = 2 * math.pi / _SECTORS * (number + 0.5)
        theta = turn - 1j * height * np.sin(turn - direction)
        slope = 1 - 1j * height * np.cos(turn - direction)
        c, s = np.cos(theta), np.sin(theta)
        p, stress, displacement = _modes(matrix, c, s)
        # Twice the half turn, whose other half is its conjugate.
        weight = (slope / (c * s) / (2 * math.pi * points))[:, None, None, None]
        lever = np.stack(np.broadcast_arrays(c[:, None], s[:, None], p), axis=-1)[..., None]
        displacement = lever * displacement.reshape(points, 3, 1, 9) / scale
        paths.append(
            _Path(
                *(float(np.sign(np.cos(direction))), float(np.sign(np.sin(direction)))),
                *(c, s, p),
                (weight * stress).reshape(3 * points, 18),
                (weight * displacement).reshape(3 * points, 27),
            )
        )
    return tuple(paths)


def _poles(matrix: Array, scale: float) -> tuple[_Pole, ...]:
    p, stress, displacement = _modes(matrix, np.array([1.0, 0.0], complex), np.array([0.0, 1.0], complex))
    stress, displacement = stress.reshape(2, 3, 18), displacement.reshape(2, 3, 9) / scale
    return tuple((p[k], stress[k], displacement[k]) for k in range(2))


def _height(matrix: Array) -> float:
    """How far paths may leave the real axis, h, so that all modes stay apart from the other three on the way."""
    turn = math.pi * (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    least, allowed = _APART * _gap(matrix, turn), 0.0
    for height in _HEIGHTS:
        if _gap(matrix, np.concatenate([turn - 1j * height, turn + 1j * height])) < least:
            break
        allowed = height
    if not allowed:
        raise NotConvergedError("the modes of this stiffness come too near to their conjugates")
    return allowed


def _gap(matrix: Array, theta: Array | ComplexArray) -> float:
    """How far the three highest Im p lie above zero and the three others below, the least of some directions."""
    m = np.stack([np.cos(theta), np.sin(theta), np.zeros_like(theta)], axis=-1)
    imaginary = np.sort(np.linalg.eigvals(_fundamental(as_tensor(matrix), m)).imag, axis=1)
    return float(min(imaginary[:, 3].min(), -imaginary[:, 2].max()))


def _worst(matrix: Array) -> float:
    """The largest condition of the vectors of the modes over directions: how many digits are lost."""
    angle = math.pi * (np.arange(_FEWEST) + 0.25) / _FEWEST
    m = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
    return float(np.linalg.cond(np.linalg.eig(_fundamental(as_tensor(matrix), m))[1]).max())


def _fundamental(tensor: Array, m: Array | ComplexArray) -> Array | ComplexArray:
    """Stroh's matrices (n, 6, 6), whose eigenvalues are p and whose eigenvectors a and b, for directions m (n, 3)."""
    q = np.einsum("nj,ijkl,nl->nik", m, tensor, m, optimize=True)
    r = np.einsum("nj,ijk->nik", m, tensor[..., 2])
    inverse = np.linalg.inv(tensor[:, 2, :, 2])
    turned = inverse @ r.transpose(0, 2, 1)
    whole = np.empty((len(m), 6, 6), r.dtype)
    whole[:, :3, :3], whole[:, :3, 3:] = -turned, inverse
    whole[:, 3:, :3], whole[:, 3:, 3:] = r @ turned - q, -r @ inverse
    return whole
