"""The grid: rectangular cells on a piece of road."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array

# Of a coordinate in steps, after sums and files.
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Grid:
    """Cells of a rectangular piece of road.

    nx, ny: number of cells along x (travel) and y (right).
    dx, dy: cell size, m.
    x0, y0: centre of the first cell, m.

    >>> grid = tl.response.Grid.centred(0.1, 0.1, 0.01)
    >>> grid.shape
    (10, 10)
    """

    nx: int
    ny: int
    dx: float
    dy: float
    x0: float
    y0: float

    def __post_init__(self) -> None:
        if self.nx < 1 or self.ny < 1:
            raise InputError(f"a grid needs at least one cell each way, got {self.nx} x {self.ny} (nx x ny)")
        for name in ("dx", "dy"):
            value = getattr(self, name)
            positive(f"grid spacing {name}", value, "metres", "3 mm is 0.003")
        if not (math.isfinite(self.x0) and math.isfinite(self.y0)):
            raise InputError(f"grid origin must be finite, got x0 = {self.x0}, y0 = {self.y0}")

    @classmethod
    def centred(cls, length: float, width: float, dx: float, dy: float | None = None) -> Grid:
        """Smallest grid with the origin at its middle that covers length (x) by width (y), m."""
        dy = dx if dy is None else dy
        for name, value in {"length": length, "width": width, "spacing dx": dx, "spacing dy": dy}.items():
            positive(f"the {name} of a grid", value, "metres", "3 mm is 0.003")
        nx = max(1, math.ceil(length / dx - 1e-9))
        ny = max(1, math.ceil(width / dy - 1e-9))
        return cls(nx, ny, dx, dy, -0.5 * (nx - 1) * dx, -0.5 * (ny - 1) * dy)

    @classmethod
    def on_lattice(
        cls,
        length: float,
        width: float,
        dx: float,
        dy: float | None = None,
        *,
        offset: tuple[float, float] = (0.0, 0.0),
    ) -> Grid:
        """Smallest grid that covers length (x) by width (y), m, with a cell's centre at the origin in its middle.

        Its cells stand at whole multiples of dx and dy, as those of every other such grid: fields of two of them
        concatenate, and lines at x = 0 and y = 0 run through centres. offset: by which all of its cells are moved
        along x and y, in cells.
        """
        fewest = cls.centred(length, width, dx, dy)
        nx, ny = fewest.nx + 1 - fewest.nx % 2, fewest.ny + 1 - fewest.ny % 2
        along, across = offset
        return cls(nx, ny, fewest.dx, fewest.dy, (along - nx // 2) * fewest.dx, (across - ny // 2) * fewest.dy)

    @property
    def shape(self) -> tuple[int, int]:
        """(ny, nx): x runs fastest."""
        return self.ny, self.nx

    @property
    def cell_area(self) -> float:
        """Area of a cell, m²."""
        return self.dx * self.dy

    @property
    def x(self) -> Array:
        """(nx,) cell centres along travel, m."""
        return _centres(self.x0, self.dx, self.nx)

    @property
    def y(self) -> Array:
        """(ny,) cell centres to the right, m."""
        return _centres(self.y0, self.dy, self.ny)

    def __str__(self) -> str:
        return f"{self.nx} x {self.ny} cells of {self.dx * 1e3:g} x {self.dy * 1e3:g} mm"


def _centres(first: float, step: float, count: int) -> Array:
    """Evenly spaced coordinates, m; on whole or half steps as their multiples, so that equal places are equal."""
    halves = 2 * first / step
    nearest = round(halves)
    if abs(halves - nearest) <= _ROUND_OFF * max(1.0, abs(halves)):
        return step * (0.5 * nearest + np.arange(count))
    return first + step * np.arange(count)
