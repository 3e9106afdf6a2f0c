"""What a surface does under pressure and shear: the seam at which a kind of body meets the solvers.

A body gives the displacement of its surface by a uniformly loaded cell, at any distances along x from it, and the
compliance of its surface to a wave. Two bodies in contact are the sum of both. Signs are those of a pair (Kalker
1990): q acts on body 1, p presses the bodies together, u = u1 - u2, u_n opens the gap; a body on the side of the road
gives its displacement with the sign of -u2. Then for every pair

    u_n = N ∗ p + k_x ∗ q_x + k_y ∗ q_y
    u_x = T_xx ∗ q_x + T_xy ∗ q_y - k_x ∗ p
    u_y = T_xy ∗ q_x + T_yy ∗ q_y - k_y ∗ p

N, T_xx and T_yy are even in y, T_xy and k_y odd in y, k_x even in y; so they are along x in a symmetric body, with
T_xy and k_x odd there. A body whose grain is turned or tilted is no image of itself in these planes. Its kernels have
no parity but that under (x, y) → (-x, -y), which a symmetric body keeps, and there are three more, `Body.tilted`:

    u_n = N ∗ p + (k_x + e_x) ∗ q_x + (k_y + e_y) ∗ q_y
    u_x = T_xx ∗ q_x + (T_xy + a) ∗ q_y - (k_x - e_x) ∗ p
    u_y = (T_xy - a) ∗ q_x + T_yy ∗ q_y - (k_y - e_y) ∗ p

a is odd under (x, y) → (-x, -y), e_x and e_y are even: loads work on each other's displacements alike.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray, IntArray
from treadload.kernels.gridding.strips import shortened, without_images
from treadload.kernels.sections import CellTable

# Loads on strips repeat after no less than this, m: at half of it a rib feels nothing of them, so that grids of any
# length have the same operator.
_PERIOD = 0.6
# Blocks of strips that are kept while operators of a grid are made, some MB each.
_KEPT = 8


@dataclass(frozen=True)
class Offsets:
    """Where a surface is looked at: distances from the centre of a loaded cell of dx by dy, m.

    x = first + dx · (0 … nx - 1), y = first_y + dy · (0 … ny - 1). first, first_y: 0 in the middle of the cell;
    first_y is a whole number of cells, and 0 for mirrored bodies.
    """

    ny: int
    nx: int
    dx: float
    dy: float
    first: float = 0.0
    first_y: float = 0.0

    @property
    def x(self) -> Array:
        """(nx,), m."""
        return self.first + self.dx * np.arange(self.nx)

    @property
    def y(self) -> Array:
        """(ny,), m."""
        return self.first_y + self.dy * np.arange(self.ny)


@dataclass(frozen=True)
class Waves:
    """The waves that a periodic grid of (ny, nx) cells of dx by dy, m, holds, as its real transform orders them."""

    shape: tuple[int, int]
    dx: float
    dy: float

    @cached_property
    def k(self) -> Array:
        """|k| (ny, nx // 2 + 1), 1/m; at k = 0 that of the finite patch: a uniform load is not a rigid motion."""
        k = np.hypot(*self._vector)
        short, long = sorted((self.shape[1] * self.dx, self.shape[0] * self.dy))
        # A uniform load sinks a long strip by the logarithm of its slenderness.
        k[0, 0] = np.pi / (short * (1 + np.log(long / short)))
        return k

    @property
    def cosine(self) -> Array:
        """k_x/|k|, zero at k = 0."""
        return np.asarray(self._vector[0] / self.k)

    @property
    def sine(self) -> Array:
        """k_y/|k|, zero at k = 0."""
        return np.asarray(self._vector[1] / self.k)

    @cached_property
    def along(self) -> Array:
        """k_x (1, nx // 2 + 1), 1/m; never zero: nothing stays under a wheel for longer than it takes to cross."""
        kx = self._vector[0].copy()
        kx[0, 0] = np.pi / (self.shape[1] * self.dx)
        return kx

    @cached_property
    def _vector(self) -> tuple[Array, Array]:
        ny, nx = self.shape
        return 2 * np.pi * fft.rfftfreq(nx, self.dx)[None, :], 2 * np.pi * fft.fftfreq(ny, self.dy)[:, None]


@dataclass(frozen=True)
class Rows:
    """Rows of cells across travel. count: how many. dy: m. first: middle of the first, m to the right."""

    count: int
    dy: float
    first: float

    @property
    def y(self) -> Array:
        """(count,) middles of the rows, m."""
        return self.first + self.dy * np.arange(self.count)


@dataclass(frozen=True, eq=False)
class Strip:
    """A group of rows of a body that is the same along travel only.

    rows: numbers (n,) of the rows of the group. table: compliance of its rows for E = 1 Pa. modulus: E, Pa.
    mirrored: True where the table is that of the image in y = 0. memory: strength and length, m, of every part of the
    displacement that fades behind a steadily rolling load.
    """

    rows: IntArray
    table: CellTable
    modulus: float
    mirrored: bool = False
    memory: tuple[tuple[float, float], ...] = ()

    def block(self, cells: int, dx: float, ahead: float = 0.0) -> Array | ComplexArray:
        """As in `kernels.gridding.strips.Strips`: waves of cells of dx, m, that repeat after so many.

        ahead: distance of the displacement from the cells, m.
        """
        block = _unit_block(self.table, cells, dx, ahead, self.memory) / self.modulus
        if not self.mirrored:
            return block
        count = self.rows.size
        parts = block.reshape(-1, 3, count, 3, count)[:, :, ::-1, :, ::-1].copy()
        parts[:, 1] *= -1
        parts[:, :, :, 1] *= -1
        return parts.reshape(block.shape)


@lru_cache(maxsize=_KEPT)
def _unit_block(
    table: CellTable, cells: int, dx: float, ahead: float, memory: tuple[tuple[float, float], ...]
) -> Array | ComplexArray:
    """Block of a strip for E = 1 Pa, not to be written to: mirrored ribs share a table, and so its blocks."""
    whole = max(cells, 2 * math.ceil(0.5 * _PERIOD / dx))
    parities = False, True
    weights = table.lattice_weights(whole, dx, ahead)
    for strength, length in memory:
        faded = table.lattice_weights(whole, dx, ahead, length)
        alone = [without_images(part, whole, length / dx, odd=odd) for part, odd in zip(faded, parities, strict=True)]
        weights = weights[0] + strength * alone[0], weights[1] + strength * alone[1]
    if whole > cells:
        even, odd = (shortened(part, whole, cells, odd=odd) for part, odd in zip(weights, parities, strict=True))
        weights = even, odd
    return table.by_weights(*weights)


class Body(ABC):
    """A surface, or the two of a pair. Displacements as in `contact.bodies.body`, m/Pa, per unit load on a cell."""

    @property
    def symmetric(self) -> bool:
        """True if loads work on each other's displacements alike, as in elastic bodies."""
        return True

    @property
    def mirrored(self) -> bool:
        """True if it is its own image in the plane y = 0, and in x = 0 where it is symmetric, as without a grain."""
        return True

    @property
    def at_rest(self) -> Body:
        """The body under loads that stay: itself, unless it has memory."""
        return self

    @abstractmethod
    def normal(self, at: Offsets) -> Array:
        """N (ny, nx): u_n by p."""

    @abstractmethod
    def tangential(self, at: Offsets) -> Array:
        """T_xx, T_yy, T_xy (3, ny, nx). Raises InputError where nothing bounds it, as `check_shear`."""

    @abstractmethod
    def coupling(self, at: Offsets) -> Array:
        """k_x, k_y (2, ny, nx); zero in a body that does not couple pressure and shear."""

    def tilted(self, at: Offsets) -> Array:
        """a, e_x, e_y (3, ny, nx), asked of bodies that are not mirrored; zero unless the grain leans."""
        return np.zeros((3, at.ny, at.nx))

    @abstractmethod
    def compliance(self, waves: Waves) -> Array | ComplexArray:
        """Compliance to waves, times |k|, 1/Pa: of u_n by p; xx, yy and xy of u by q: (4, ny, nx // 2 + 1).

        It serves as a preconditioner: near is enough.
        """

    def normal_compliance(self, waves: Waves) -> Array | ComplexArray:
        """The first of `compliance`, (ny, nx // 2 + 1), where it can be had without the others."""
        return np.asarray(self.compliance(waves)[0])

    @abstractmethod
    def across(self, k: Array) -> Array:
        """The same of u_n by p, and of the coupling, u_k by p, to waves |k| (n,), 1/m: (2, n), 1/Pa.

        The size, where the response lags behind; the mean over directions, where they differ.
        """

    def towards(self, k: Array, angle: float) -> ComplexArray:
        """The same to waves in a direction, rad from x: u_n by p, by q_x and by q_y (3, n), 1/Pa.

        Asked where a grain is turned.
        """
        normal, coupling = self.across(k)
        return np.array([normal, -1j * math.cos(angle) * coupling, -1j * math.sin(angle) * coupling])

    @property
    def striped(self) -> bool:
        """True if it has strips."""
        return False

    def strips(self, rows: Rows) -> tuple[Strip, ...]:
        """What the surface gives besides, where it is the same along travel only: groups of rows, none in two.

        Rows of a body with strips that are in none of them have no material.
        """
        return ()

    def check_shear(self) -> None:  # noqa: B027
        """Refuse shear on a surface that drifts under it without limit. Raises InputError."""

    @property
    def stats(self) -> Mapping[str, object]:
        """What was approximated, for the statistics of a contact."""
        return {}

    def joined(self, body: Body) -> Body | None:
        """This body and another as one of the same kind, or None."""
        return None


@dataclass(frozen=True)
class Sum(Body):
    """Bodies whose displacements add up: the two of a contact, or the parts of one."""

    parts: tuple[Body, ...]

    @classmethod
    def of(cls, *bodies: Body) -> Body:
        """The sum of bodies, those of one kind joined where they can be."""
        parts: list[Body] = []
        for body in bodies:
            for part in body.parts if isinstance(body, Sum) else (body,):
                for number, present in enumerate(parts):
                    joined = present.joined(part)
                    if joined is not None:
                        parts[number] = joined
                        break
                else:
                    parts.append(part)
        return parts[0] if len(parts) == 1 else cls(tuple(parts))

    @property
    def symmetric(self) -> bool:
        """As all of them are."""
        return all(part.symmetric for part in self.parts)

    @property
    def mirrored(self) -> bool:
        """As all of them are."""
        return all(part.mirrored for part in self.parts)

    @property
    def at_rest(self) -> Body:
        """Of all of them."""
        return Sum.of(*(part.at_rest for part in self.parts))

    def normal(self, at: Offsets) -> Array:
        """Added up."""
        return np.asarray(sum(_either_side(part, part.normal, at, 1.0) for part in self.parts))

    def tangential(self, at: Offsets) -> Array:
        """Added up."""
        return np.asarray(sum(_either_side(part, part.tangential, at, _OF_SHEAR) for part in self.parts))

    def coupling(self, at: Offsets) -> Array:
        """Added up."""
        return np.asarray(sum(_either_side(part, part.coupling, at, _OF_COUPLING) for part in self.parts))

    def tilted(self, at: Offsets) -> Array:
        """Added up; of those alone that are not mirrored."""
        return np.asarray(sum(part.tilted(at) for part in self.parts if not part.mirrored))

    def compliance(self, waves: Waves) -> Array | ComplexArray:
        """Added up."""
        return np.asarray(sum(part.compliance(waves) for part in self.parts))

    def normal_compliance(self, waves: Waves) -> Array | ComplexArray:
        """Added up."""
        return np.asarray(sum(part.normal_compliance(waves) for part in self.parts))

    def across(self, k: Array) -> Array:
        """Added up."""
        return np.asarray(sum(part.across(k) for part in self.parts))

    def towards(self, k: Array, angle: float) -> ComplexArray:
        """Added up."""
        return np.asarray(sum(part.towards(k, angle) for part in self.parts))

    @property
    def striped(self) -> bool:
        """As any of them is."""
        return any(part.striped for part in self.parts)

    def strips(self, rows: Rows) -> tuple[Strip, ...]:
        """Of all of them."""
        return tuple(strip for part in self.parts for strip in part.strips(rows))

    def check_shear(self) -> None:
        """Refused by any of them."""
        for part in self.parts:
            part.check_shear()

    @property
    def stats(self) -> Mapping[str, object]:
        """Of all of them."""
        return {name: value for part in self.parts for name, value in part.stats.items()}


# Parities along y of T_xx, T_yy, T_xy and of k_x, k_y in a mirrored body.
_OF_SHEAR = np.array([1.0, 1.0, -1.0])[:, None, None]
_OF_COUPLING = np.array([1.0, -1.0])[:, None, None]


def _either_side(part: Body, kernels: Callable[[Offsets], Array], at: Offsets, parity: float | Array) -> Array:
    """Kernels of a part where y may be negative: a mirrored one is asked for y ≥ 0 alone."""
    if not part.mirrored or at.first_y == 0:
        return kernels(at)
    rows = np.rint(at.y / at.dy).astype(int)
    half = kernels(replace(at, ny=int(np.abs(rows).max()) + 1, first_y=0.0))
    return half[..., np.abs(rows), :] * np.where(rows[:, None] < 0, parity, 1.0)
