"""A road's texture: heights above its plane, on cells or along a line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from typing import TypedDict

import numpy as np
from typing_extensions import Unpack

from treadload.errors import InputError, positive
from treadload.kernels import fft
from treadload.kernels.arrays import Array
from treadload.tables import real_array

# No texture is higher than this, m; millimetres taken for metres are.
_HIGHEST = 0.2


class Changes(TypedDict, total=False):
    """What else than its heights a treatment changes of a texture, see `Texture`."""

    shortest: float | None
    periodic: bool


@dataclass(frozen=True, eq=False)
class Texture:
    """A frozen description of a road's texture.

    heights: (ny, nx), m, up positive, rows across (y), columns along travel (x); NaN where they are not known. One
    row is a profile: the same everywhere across. dx, dy: between the points, m. periodic: True if it continues at
    its ends; a measured one is mirrored there instead. shortest: m, the shortest wave in it, where that is known;
    left out, two points. source: where it is from. treated: what was done to it, sentence by sentence.
    It is a `Relief`: its middle stands at the origin of a contact. Raises InputError for another shape, infinite
    heights, no height at all, and more than 50 mm between the highest and the lowest.

    >>> ridges = tl.pavement.Texture([[0.0, 1e-3, 0.0, -1e-3] * 10], dx=2e-3, dy=2e-3, periodic=True)
    >>> round(ridges.rms_height * 1e3, 2)  # mm
    0.71
    """

    heights: Array
    dx: float
    dy: float
    periodic: bool = False
    shortest: float | None = None
    source: str = ""
    treated: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        heights = np.atleast_2d(real_array(self.heights, "a texture"))
        if heights.ndim != 2 or heights.shape[1] < 2:
            raise InputError(
                f"a texture must be an array (ny, nx) with two points or more along x, got shape {heights.shape}"
            )
        for name in ("dx", "dy"):
            positive(f"the spacing {name} of a texture", getattr(self, name), "metres", "0.5 mm is 0.0005")
        if self.shortest is not None:
            positive("the shortest wave of a texture", self.shortest, "metres", "1 mm is 0.001")
        if np.isinf(heights).any():
            raise InputError(
                f"the texture has {int(np.isinf(heights).sum())} infinite heights; write NaN where none was measured"
            )
        finite = heights[np.isfinite(heights)]
        if not finite.size:
            raise InputError(f"all {heights.size} heights of the texture are NaN; at least one must be a length in m")
        relief = float(finite.max() - finite.min())
        if relief > _HIGHEST:
            raise InputError(
                f"the heights of the texture differ by {relief:.3g} m, more than any ({_HIGHEST * 1e3:g} mm); "
                "give their unit, level the texture (treated), or clean the outliers"
            )
        heights[np.isnan(heights)] = np.nan
        heights += 0.0
        heights.flags.writeable = False
        object.__setattr__(self, "heights", heights)

    @property
    def is_profile(self) -> bool:
        """True if it is known along one line."""
        return int(self.heights.shape[0]) == 1

    @property
    def length(self) -> float:
        """Along x, m."""
        return float(self.heights.shape[1] * self.dx)

    @property
    def width(self) -> float:
        """Across, m; of a profile its dy."""
        return float(self.heights.shape[0] * self.dy)

    @property
    def x(self) -> Array:
        """(nx,) places along travel, m; 0 in the middle."""
        return _places(self.heights.shape[1], self.dx, self.periodic)

    @property
    def y(self) -> Array:
        """(ny,) places across, m; 0 in the middle."""
        return _places(self.heights.shape[0], self.dy, self.periodic)

    @property
    def finest_wave(self) -> float:
        """The shortest wave in it, m."""
        return self.shortest if self.shortest is not None else 2 * self.step

    @property
    def step(self) -> float:
        """Between points, m, the larger."""
        return self.dx if self.is_profile else max(self.dx, self.dy)

    @property
    def dropouts(self) -> int:
        """Number of heights that are not known."""
        return int(np.isnan(self.heights).sum())

    def whole(self, what: str) -> Array:
        """The heights where all are known. what: is asked, for the error. Raises InputError for NaN."""
        if self.dropouts:
            raise InputError(
                f"{what} needs every height, and {self.dropouts} of {self.heights.size} are not known (NaN): fill "
                "the drop-outs, texture.fill_dropouts, or cut the texture"
            )
        return self.heights

    @cached_property
    def rms_height(self) -> float:
        """Of all known heights about their mean, m."""
        return float(np.nanstd(self.heights))

    @cached_property
    def rms_slope(self) -> float:
        """Root of the mean square gradient; of a periodic texture by its waves, else by differences of points.

        Of a profile that along it.
        """
        heights = self.heights
        if self.periodic and not self.dropouts:
            ny, nx = heights.shape
            power = np.abs(fft.rfft2(heights)) ** 2
            weight = np.full(nx // 2 + 1, 2.0)
            weight[0] = 1.0
            if nx % 2 == 0:
                weight[-1] = 1.0
            k2 = (2 * np.pi * fft.rfftfreq(nx, self.dx)) ** 2 + (2 * np.pi * fft.fftfreq(ny, self.dy))[:, None] ** 2
            return math.sqrt(float((power * k2 * weight).sum())) / heights.size
        along = np.nanmean((np.diff(heights, axis=1) / self.dx) ** 2)
        across = 0.0 if self.is_profile else np.nanmean((np.diff(heights, axis=0) / self.dy) ** 2)
        return math.sqrt(float(along + across))

    @property
    def mean_wave(self) -> float:
        """2π √2 rms height over rms slope, m: the wave of crossed sines that have both; of a line without √2."""
        return 2 * math.pi * (1.0 if self.is_profile else math.sqrt(2)) * self.rms_height / self.rms_slope

    def height(self, x: Array, y: Array) -> Array:
        """(ny, nx), m, at x (nx,) and y (ny,), m: bilinear between points; beyond its ends repeated or mirrored.

        Raises InputError for NaN.
        """
        heights = self.whole("the height of a texture")
        columns, right = _between(np.asarray(x, dtype=float), self.x[0], self.dx, heights.shape[1], self.periodic)
        rows, down = _between(np.asarray(y, dtype=float), self.y[0], self.dy, heights.shape[0], self.periodic)
        lines = heights[rows[0]] * (1 - down)[:, None] + heights[rows[1]] * down[:, None]
        result: Array = lines[:, columns[0]] * (1 - right) + lines[:, columns[1]] * right
        return result

    def changed(self, heights: Array, done: str, **changes: Unpack[Changes]) -> Texture:
        """A copy with other heights and a sentence about what was done."""
        return replace(self, heights=heights, treated=(*self.treated, done), **changes)

    @cached_property
    def _digest(self) -> str:
        parts = (self.heights.shape, self.dx, self.dy, self.periodic, self.shortest)
        return sha256(repr(parts).encode() + np.ascontiguousarray(self.heights).tobytes()).hexdigest()

    def __eq__(self, texture: object) -> bool:
        return self._digest == texture._digest if isinstance(texture, Texture) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._digest)

    def __str__(self) -> str:
        ny, nx = self.heights.shape
        size = f"profile of {nx} points every {self.dx * 1e3:.4g} mm" if ny == 1 else (
            f"{nx} x {ny} points every {self.dx * 1e3:.4g} x {self.dy * 1e3:.4g} mm"
        )  # fmt: skip
        text = f"texture, {size}, rms height {self.rms_height * 1e3:.3g} mm, rms slope {self.rms_slope:.3g}"
        if self.dropouts:
            text += f", {self.dropouts} heights not known"
        return f"{text}; {self.source}" if self.source else text

    def __repr__(self) -> str:
        return f"<{self}>"

    def summary(self) -> str:
        """What it is and what was done to it."""
        return "\n".join([str(self), *(f"- {step}" for step in self.treated)])


def _places(count: int, step: float, periodic: bool) -> Array:
    middle = 0.5 * count if periodic else 0.5 * (count - 1)
    return step * (np.arange(count) - middle)


def _between(at: Array, first: float, step: float, count: int, periodic: bool) -> tuple[Sequence[Array], Array]:
    """Indices of the points on either side of places, and how far towards the second they are, 0 to 1."""
    place = (at - first) / step
    low = np.floor(place)
    part = place - low
    both = [low.astype(int), low.astype(int) + 1]
    if periodic:
        return [index % count for index in both], part
    # Mirrored in the outermost points; one point alone is everywhere.
    turn = max(2 * (count - 1), 1)
    folded = [index % turn for index in both]
    return [np.where(index > count - 1, turn - index, index) if count > 1 else 0 * index for index in folded], part
