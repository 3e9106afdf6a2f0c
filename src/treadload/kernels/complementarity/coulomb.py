"""The tangential problem: shear bounded by a disc, slip opposed to shear that reached the bound.

Find q (2, ny, nx) and the rigid slips ξ whose force is prescribed, so that with  s = S q + w + e ξ

    |q| ≤ g;   s = 0 where |q| < g;   q = -g s/|s| where s ≠ 0;   Σ q_c = Q_c for prescribed forces.

S q is u(x) - u(x + dx) in rolling and u itself in a shift, with u = A q the displacement difference. S is
monotone, so that a solution exists and is unique. `coulomb_newton` and `coulomb_splitting` are two ways to it.

Source: Kalker (1990), Three-Dimensional Elastic Bodies in Rolling Contact, ch. 4.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, ComplexArray
from treadload.kernels.gridding.convolution import Along, Padding
from treadload.kernels.gridding.strips import Strips


@dataclass(frozen=True)
class CoulombProblem:
    """What is given in the tangential problem.

    padding: padded space of the patch; in rolling its field has one column more than the load.
    compliance: symbols (3, my, mx // 2 + 1) of A: xx, yy, xy; real where A is symmetric. Where u_y by q_x differs
    from u_x by q_y, (4, …), with yx as the fourth.
    rolls: S q is u(x) - u(x + dx), else u. self_influence: diagonal of S, > 0.
    bound: g = μp (ny, nx) ≥ 0, zero outside contact.
    rigid: w (2, ny, nx): rigid slip that is known. travel: e, slip distance per unit of rigid slip ξ.
    totals: prescribed sums of q_x and q_y over the cells; None where the rigid slip is prescribed instead
    (it is then part of `rigid`). precondition: of slip (2, ny, nx), zero outside of a mask (ny, nx): an
    approximate inverse of S on the cells of the mask, in the precision of its argument. strips: what A has besides on
    groups of rows, in the length of the padding, before it is stretched by axes.
    """

    padding: Padding
    compliance: Array | ComplexArray
    rolls: bool
    self_influence: float
    bound: Array
    rigid: Array
    travel: float
    totals: tuple[float | None, float | None]
    precondition: Callable[[Array, BoolArray], Array]
    strips: Strips | None = None
    axes: tuple[float, float] = (1.0, 1.0)

    @property
    def forced(self) -> list[int]:
        """Components whose force is prescribed."""
        return [c for c in (0, 1) if self.totals[c] is not None]

    def apply(self, q: Array) -> Array:
        """S q (2, ny, nx), in the precision of q and the compliance."""
        xx, yy, xy, yx = four(self._symbols)

        def mix(waves: list[ComplexArray], part: slice) -> list[ComplexArray]:
            x, y = (wave.view(xx.dtype) for wave in waves)
            u_x = xx[part] * x
            u_x += xy[part] * y
            x *= yx[part]
            y *= yy[part]
            y += x
            return [u_x.view(waves[0].dtype), y.view(waves[0].dtype)]

        def convolved(along: Along | None) -> list[Array]:
            return self.padding.through([q[0], q[1]], mix, along)

        both = convolved(None) if self.strips is None else self.strips.added_to(convolved, q, (0, 1), self.axes)
        u_x, u_y = both
        s = np.empty_like(q)
        if not self.rolls:
            s[0], s[1] = u_x, u_y
            return s
        np.subtract(u_x[:, :-1], u_x[:, 1:], out=s[0])
        np.subtract(u_y[:, :-1], u_y[:, 1:], out=s[1])
        return s

    @cached_property
    def _symbols(self) -> Array | ComplexArray:
        """The compliance turned round as waves are; each real number twice, for both parts of a wave."""
        turned = self.compliance.transpose(0, 2, 1)
        return turned if np.iscomplexobj(turned) else paired(turned.real)

    def slip(self, q: Array, xi: Array) -> Array:
        """S q + w + e ξ (2, ny, nx), with ξ (2,) the rigid slips so far."""
        return self.apply(q) + self.rigid + self.travel * xi[:, None, None]


def paired(symbols: Array) -> Array:
    """Real symbols (…, n), each twice (…, 2 n): what multiplies the parts of waves in memory, four times as fast."""
    return np.repeat(symbols, 2, axis=-1)


def four(symbols: Array | ComplexArray) -> tuple[Array, Array, Array, Array]:
    """Symbols xx, yy, xy and yx of a compliance that has three, of which the last counts twice, or four."""
    return symbols[0], symbols[1], symbols[2], symbols[-1]


def project_disc(q: Array, bound: Array) -> Array:
    """Nearest shear (2, …) of size at most bound (…)."""
    return q * shrink(np.hypot(q[0], q[1]), bound)


def shrink(size: Array, bound: Array) -> Array:
    """Factor that brings a vector of this size back to the bound: 1 inside."""
    return np.divide(bound, size, out=np.ones_like(size), where=size > bound)
