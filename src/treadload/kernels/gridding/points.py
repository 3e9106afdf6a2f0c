"""Some points of the grid of the distinct coordinates x and y, without the grid's others.

Waves cost by the distinct coordinates, fields by the points. Points that share a line along x or along y are taken
together: two lines that cross are two products of matrices. The others are taken one by one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.lattice import Indices

# Fewer points on a line are taken one by one.
_LINE = 4


@dataclass(frozen=True, eq=False)
class Group:
    """Points of a list. members: (n,) their places in it. rows, columns: of y and of x.

    alone: True where row and column pair up, (n,) each; else the points are all columns of all rows, in that order.
    """

    members: Indices
    rows: Indices
    columns: Indices
    alone: bool = False


@dataclass(frozen=True, eq=False)
class Half:
    """Some points of a list, as a list of the rows and columns that they need.

    members: (n,) their places in the list. rows, columns: distinct, of y and of x. points: those members, by their
    place in `rows` and `columns`.
    """

    members: Indices
    rows: Indices
    columns: Indices
    points: Points


@dataclass(frozen=True, eq=False)
class Points:
    """A list of points. rows, columns: (n,) index into the distinct y and x.

    Fields at points are arrays (..., 1, n), where those of a grid are (..., my, mx).
    """

    rows: Indices
    columns: Indices

    @classmethod
    def of(cls, x: Array, y: Array) -> tuple[Points, Array, Array]:
        """The points at x, y (n,), and the distinct x and y."""
        distinct_x, columns = np.unique(x, return_inverse=True)
        distinct_y, rows = np.unique(y, return_inverse=True)
        return cls(rows, columns), distinct_x, distinct_y

    @property
    def shape(self) -> tuple[int, int]:
        """Of fields at points: (1, n)."""
        return 1, len(self.rows)

    @cached_property
    def groups(self) -> list[Group]:
        """Lines along x and y, each point on the longer one of its two, and the points that are left."""
        in_row, in_column = np.bincount(self.rows)[self.rows], np.bincount(self.columns)[self.columns]
        along = in_row >= in_column
        groups, left = [], [np.zeros(0, dtype=int)]
        for chosen, line in ((along, self.rows), (~along, self.columns)):
            members = np.flatnonzero(chosen)
            members = members[np.argsort(line[members], kind="stable")]
            for part in np.split(members, np.flatnonzero(np.diff(line[members])) + 1):
                if len(part) < _LINE:
                    left.append(part)
                elif line is self.rows:
                    groups.append(Group(part, self.rows[part[:1]], self.columns[part]))
                else:
                    groups.append(Group(part, self.rows[part], self.columns[part[:1]]))
        alone = np.concatenate(left)
        return [*groups, Group(alone, self.rows[alone], self.columns[alone], True)] if len(alone) else groups

    @cached_property
    def halves(self) -> tuple[Half, Half]:
        """The points on lines along y, cheapest summed along x first, and the rest, cheapest summed along y first."""
        upright = np.zeros(len(self.rows), dtype=bool)
        for group in self.groups:
            upright[group.members] = not group.alone and len(group.columns) == 1
        return self._half(upright), self._half(~upright)

    def _half(self, chosen: Array) -> Half:
        rows, at_row = np.unique(self.rows[chosen], return_inverse=True)
        columns, at_column = np.unique(self.columns[chosen], return_inverse=True)
        return Half(np.flatnonzero(chosen), rows, columns, Points(at_row, at_column))

    @cached_property
    def transposed(self) -> Points:
        """The same points with rows and columns exchanged."""
        return Points(self.columns, self.rows)

    def product(self, lines: Array, back: Array) -> Array:
        """The product of matrices lines (..., my, k) and back (k, mx) at the points, (..., 1, n)."""
        result = np.empty((*lines.shape[:-2], *self.shape))
        for group in self.groups:
            rows, columns = lines[..., group.rows, :], back[:, group.columns]
            part = np.einsum("...pk,kp->...p", rows, columns) if group.alone else rows @ columns
            result[..., 0, group.members] = part.reshape(*lines.shape[:-2], -1)
        return result

    def gathered(
        self,
        fields: Callable[[Array, Array], Array],
        x: Array,
        y: Array,
        alone: Callable[[Array, Array], Array] | None = None,
    ) -> Array:
        """Fields at the points, (..., 1, n), from functions of x and y.

        fields: of a grid, x (a,) and y (b,) → (..., b, a). alone: of points on no line, x and y (n,) → (..., n); left
        out, each is a grid of one point.
        """

        def one_by_one(x: Array, y: Array) -> Array:
            return np.stack([fields(x[k : k + 1], y[k : k + 1])[..., 0, 0] for k in range(len(x))], axis=-1)

        parts = []
        for group in self.groups:
            at_x, at_y = x[group.columns], y[group.rows]
            if group.alone:
                parts.append((alone or one_by_one)(at_x, at_y))
            else:
                part = fields(at_x, at_y)
                parts.append(part.reshape(*part.shape[:-2], -1))
        result = np.empty((*parts[0].shape[:-1], *self.shape))
        for group, part in zip(self.groups, parts, strict=True):
            result[..., 0, group.members] = part
        return result

    def total(self, cost: Callable[[Array, Array], Array], x: Array, y: Array) -> Array:
        """Sum over the grids that `gathered` takes of what each costs; points alone cost alike."""
        result: Array = np.sum(
            [
                len(group.members) * cost(x[group.columns[:1]], y[group.rows[:1]])
                if group.alone
                else cost(x[group.columns], y[group.rows])
                for group in self.groups
            ],
            axis=0,
        )
        return result
