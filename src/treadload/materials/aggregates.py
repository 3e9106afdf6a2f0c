"""Aggregates: stones, soft inclusions or voids in a mortar, drawn at random, at given places, or from a scan.

Drawing spheres one by one, the largest first, each where it overlaps none before, ends near a third of the volume.
Real asphalt holds 60 to 75 %: draw the stones above some 4 mm, and call the rest mortar, with what is smaller in it.

Source: Widom (1966), J. Chem. Phys. 44, 3888, for random sequential addition.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array, IntArray
from treadload.materials.elastic import Elastic
from treadload.tables import real_array

# Places tried for a stone before there is no room; how many at once; how often all is begun anew.
_TRIES, _AT_ONCE, _STARTS = 10_000, 400, 8
# Most stones that a window may have: a minute of drawing.
_MOST = 20_000
# Spheres of one size, drawn one by one, end here.
_JAMMED = 0.38
# Overlap of spheres that is round-off, relative to their radii.
_TOUCH = 1e-9
# Sum of shares that is 1 as people write them.
_ADDED = 1e-6


@dataclass(frozen=True)
class Window:
    """The block of road that stones lie in: length along x, width along y, depth, m. Its middle is x = y = 0."""

    length: float
    width: float
    depth: float

    @property
    def volume(self) -> float:
        """m³."""
        return self.length * self.width * self.depth

    def __str__(self) -> str:
        return f"{self.length * 1e3:g} x {self.width * 1e3:g} x {self.depth * 1e3:g} mm"


@dataclass(frozen=True, eq=False)
class Spheres:
    """Stones that are spheres: x and y from the middle of the window, z down from the surface, radius, (n,), m."""

    x: Array
    y: Array
    z: Array
    radius: Array

    def __post_init__(self) -> None:
        parts = [np.asarray(getattr(self, name)) for name in ("x", "y", "z", "radius")]
        alike = len({part.shape for part in parts}) == 1 and parts[0].ndim == 1 and parts[0].size
        if not alike or any(part.dtype.kind != "f" or not np.isfinite(part).all() for part in parts):
            raise InputError("places and radii of stones must be lists of finite numbers of metres, at least one")
        if (self.radius <= 0).any():
            raise InputError(f"the radius of a stone must be positive, got {self.radius.min():g} m")
        out = int(np.argmin(self.z - self.radius))
        if self.z[out] < self.radius[out] * (1 - _TOUCH):
            raise InputError(
                f"stone {out + 1} of radius {self.radius[out]:g} m at a depth of {self.z[out]:g} m rises out of the "
                "road; z is the depth of its centre, at least its radius"
            )

    @property
    def volume(self) -> float:
        """Of all of them, m³."""
        return float(4 / 3 * math.pi * (self.radius**3).sum())

    def numbers(self, x: Array, y: Array, z: Array) -> IntArray:
        """Number of the stone, from 1, that the centre of each cell is in, 0 for none, (nz, ny, nx). x, y, z: m."""
        result = np.zeros((len(z), len(y), len(x)), int)
        for number, (cx, cy, cz, r) in enumerate(zip(self.x, self.y, self.z, self.radius, strict=True), start=1):
            parts = [np.flatnonzero(np.abs(axis - c) < r) for axis, c in ((z, cz), (y, cy), (x, cx))]
            if all(len(part) for part in parts):
                block = tuple(slice(part[0], part[-1] + 1) for part in parts)
                square = (z[block[0], None, None] - cz) ** 2 + (y[block[1], None] - cy) ** 2 + (x[block[2]] - cx) ** 2
                result[block][square < r * r] = number
        return result


@dataclass(frozen=True)
class Drawn:
    """Spheres to be drawn, see `Aggregates.random`."""

    fraction: float
    radii: tuple[tuple[float, float], ...]
    seed: int
    gap: float
    cover: float

    def __post_init__(self) -> None:
        if isinstance(self.fraction, bool | str) or not 0 < self.fraction < 1:
            raise InputError(
                f"the fraction of stones must lie in (0, 1), got {self.fraction!r}; 0.35 is what can be drawn"
            )
        for radius, share in self.radii:
            positive("the radius of a stone", radius, "metres", "5 mm is 0.005")
            positive("the share of a size of stones", share)
        total = sum(share for _, share in self.radii)
        if abs(total - 1) > _ADDED:
            raise InputError(f"the shares of the sizes of stones add up to {total:g}; they must add up to 1")
        for name, value in {"the gap between stones": self.gap, "the cover of stones": self.cover}.items():
            if isinstance(value, bool | str) or not (math.isfinite(value) and value >= 0):
                raise InputError(f"{name} must be a number of metres >= 0, got {value!r}")
        if isinstance(self.seed, bool) or not isinstance(self.seed, int) or self.seed < 0:
            raise InputError(f"the seed of a packing must be a whole number >= 0, got {self.seed!r}")


@dataclass(frozen=True, eq=False)
class Scanned:
    """Numbers of stones by cells, 0 for mortar, (nz, ny, nx); spacing: (dx, dy, dz), m."""

    numbers: Any
    spacing: tuple[float, float, float]

    def __post_init__(self) -> None:
        numbers = np.asarray(self.numbers)
        if numbers.ndim != 3 or numbers.dtype.kind not in "biuf" or not numbers.size:
            raise InputError(
                f"voxels must be an array (nz, ny, nx) of numbers of stones, got shape {numbers.shape} of "
                f"{numbers.dtype}"
            )
        whole = numbers.astype(float)
        if not np.isfinite(whole).all() or (whole < 0).any() or (whole != np.round(whole)).any():
            raise InputError("voxels must be whole numbers >= 0: 0 for mortar, else the number of the stone")
        if not whole.any():
            raise InputError("voxels hold no stone: all numbers are 0")
        if not isinstance(self.spacing, tuple) or len(self.spacing) != 3:
            raise InputError(
                f"the spacing of voxels must be a number of metres or (dx, dy, dz), got {self.spacing!r}"
            )
        for size in self.spacing:
            positive("the spacing of voxels", size, "metres", "1 mm is 0.001")
        object.__setattr__(self, "numbers", whole.astype(int))


@dataclass(frozen=True, eq=False)
class Aggregates:
    """Stones of one material, or voids, in a mortar.

    packing: where they are; made by `random`, `from_centres` and `from_voxels`. material: of the stones; softer than
    the mortar is allowed; None: voids.

    >>> stone = tl.Elastic(60e9, 0.2)
    >>> tl.materials.Aggregates.from_centres([0.0, 0.009], [0.0, 0.0], [0.02, 0.02], 0.005, stone)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: 1 pair(s) of stones overlap, stones 1 and 2 by 1 mm; stones are solid: move
    them apart or give smaller radii
    """

    packing: Drawn | Spheres | Scanned
    material: Elastic | None

    def __post_init__(self) -> None:
        if self.material is not None and not isinstance(self.material, Elastic):
            raise InputError(
                f"stones must be Elastic, or None for voids, got {type(self.material).__name__}; equivalent "
                "inclusions are isotropic here, e.g. tl.Elastic(60e9, 0.2)"
            )

    @classmethod
    def random(
        cls,
        fraction: float,
        radii: Sequence[float | tuple[float, float]],
        material: Elastic | None,
        *,
        seed: int = 0,
        gap: float = 0.0,
        cover: float = 0.0,
    ) -> Aggregates:
        """Spheres drawn at random, the largest first, in whatever window they are asked for.

        fraction: of the window's volume, in (0, 1); some 0.35 can be reached, more with sizes far apart. radii: m,
        or (radius, share of the stones' volume); without shares each has the same. seed: another gives another
        packing. gap: least distance between stones, m. cover: least of mortar above and below them, m.
        Raises InputError here for a wrong value, and where it is drawn for a packing that cannot be reached.
        """
        entries = list(radii) if isinstance(radii, Sequence) and not isinstance(radii, str) else []
        pairs = [entry if isinstance(entry, tuple | list) else (entry, 1.0) for entry in entries]
        if not pairs or any(len(pair) != 2 for pair in pairs):
            raise InputError(f"radii of stones must be a list of metres, or of (radius, share), got {radii!r}")
        if len({isinstance(entry, tuple | list) for entry in entries}) > 1:
            raise InputError("radii of stones have shares of the volume all or none; give each as (radius, share)")
        # Sizes without shares have the same.
        even = 1.0 if isinstance(entries[0], tuple | list) else 1 / len(pairs)
        return cls(
            Drawn(fraction, tuple(sorted(((r, s * even) for r, s in pairs), reverse=True)), seed, gap, cover),
            material,
        )

    @classmethod
    def from_centres(
        cls, x: ArrayLike, y: ArrayLike, z: ArrayLike, radius: ArrayLike, material: Elastic | None
    ) -> Aggregates:
        """Spheres at given places.

        x, y: from the middle of the window, m. z: depth of the centres, m. radius: m; each (n,), or one number.
        Raises InputError for values that are no numbers, stones that rise out of the road, and stones that overlap.
        """
        parts = [
            np.atleast_1d(real_array(part, name)) for part, name in ((x, "x"), (y, "y"), (z, "z"), (radius, "radius"))
        ]
        try:
            parts = [np.array(part, float) for part in np.broadcast_arrays(*parts)]
        except ValueError as error:
            sizes = ", ".join(str(len(part)) for part in parts)
            raise InputError(f"stones need as many x, y, z and radius, got {sizes} of them") from error
        spheres = Spheres(*parts)
        check_apart(spheres)
        return cls(spheres, material)

    @classmethod
    def from_voxels(
        cls, numbers: ArrayLike, spacing: float | tuple[float, float, float], material: Elastic | None
    ) -> Aggregates:
        """Stones from a scan in cells.

        numbers: (nz, ny, nx), from the surface down: 0 mortar, else the number of the stone, or True; where there
        are no numbers but True or 1, all is one stone. spacing: of the cells, m, or (dx, dy, dz). The window is the
        array's. Raises InputError for a wrong shape or value.
        """
        sizes = tuple(spacing) if isinstance(spacing, tuple | list) else (spacing, spacing, spacing)
        return cls(Scanned(numbers, sizes), material)  # type: ignore[arg-type]

    @property
    def scanned(self) -> tuple[tuple[int, int, int], tuple[float, float, float]] | None:
        """Shape (nz, ny, nx) and spacing (dx, dy, dz), m, of a scan; None of spheres."""
        if not isinstance(self.packing, Scanned):
            return None
        nz, ny, nx = self.packing.numbers.shape
        return (nz, ny, nx), self.packing.spacing

    def spheres(self, window: Window, present: Sequence[Spheres] = ()) -> Spheres | None:
        """The stones in a window, drawn if they are drawn; None of a scan.

        present: stones that are there already. Raises InputError for a packing that cannot be reached, a stone larger
        than the window or beyond it.
        """
        if isinstance(self.packing, Scanned):
            return None
        if isinstance(self.packing, Spheres):
            return _inside(self.packing, window)
        return _drawn(self.packing, window, present)

    def numbers(self, spheres: Spheres | None, x: Array, y: Array, z: Array) -> IntArray:
        """Number of the stone, from 1, of each cell, 0 for none, (nz, ny, nx). x, y, z: centres, m."""
        if spheres is not None:
            return spheres.numbers(x, y, z)
        assert isinstance(self.packing, Scanned)
        stones: IntArray = self.packing.numbers.copy()
        return stones

    def __str__(self) -> str:
        kind = "voids" if self.material is None else f"stones, {self.material}"
        if isinstance(self.packing, Drawn):
            sizes = ", ".join(f"{2e3 * radius:g}" for radius, _ in self.packing.radii[::-1])
            return f"{kind}: {100 * self.packing.fraction:g} % drawn at random, diameters {sizes} mm"
        count = len(self.packing.x) if isinstance(self.packing, Spheres) else len(np.unique(self.packing.numbers)) - 1
        return f"{kind}: {count} of them {'in cells' if isinstance(self.packing, Scanned) else 'at given places'}"

    __repr__ = as_call


def check_apart(*groups: Spheres) -> None:
    """Raise InputError where spheres overlap."""
    at = np.concatenate([np.stack([group.x, group.y, group.z], axis=1) for group in groups])
    radius = np.concatenate([group.radius for group in groups])
    pairs = scipy.spatial.cKDTree(at).query_pairs(2 * float(radius.max()), output_type="ndarray")
    if not len(pairs):
        return
    reach = radius[pairs].sum(axis=1)
    depth = reach - np.linalg.norm(at[pairs[:, 0]] - at[pairs[:, 1]], axis=1)
    wrong = depth > _TOUCH * reach
    if wrong.any():
        first, second = pairs[np.argmax(depth)]
        raise InputError(
            f"{int(wrong.sum())} pair(s) of stones overlap, stones {min(first, second) + 1} and "
            f"{max(first, second) + 1} by {depth.max() * 1e3:.3g} mm; stones are solid: move them apart or give "
            "smaller radii"
        )


def _inside(spheres: Spheres, window: Window) -> Spheres:
    _check_size(float(spheres.radius.max()), window)
    beyond = np.max(
        [
            np.abs(spheres.x) + spheres.radius - window.length / 2,
            np.abs(spheres.y) + spheres.radius - window.width / 2,
            spheres.z + spheres.radius - window.depth,
        ],
        axis=0,
    )
    worst = int(np.argmax(beyond))
    if beyond[worst] > _TOUCH * spheres.radius[worst]:
        raise InputError(
            f"stone {worst + 1} reaches {beyond[worst] * 1e3:.3g} mm beyond the window of {window}; x and y count "
            "from the window's middle: enlarge the window or leave the stone out"
        )
    return spheres


def _check_size(radius: float, window: Window) -> None:
    least = min(window.length, window.width, window.depth)
    if 2 * radius > least:
        raise InputError(
            f"a stone of diameter {2e3 * radius:g} mm is larger than the window of {window}; enlarge the window to "
            "three diameters or more, or leave the size out"
        )


def _drawn(packing: Drawn, window: Window, present: Sequence[Spheres]) -> Spheres:
    """Spheres in a window, see `Aggregates.random`."""
    _check_size(packing.radii[0][0] + packing.cover, window)
    single = packing.fraction * window.volume / (4 / 3 * math.pi)
    counts = [round(single * share / radius**3) for radius, share in packing.radii]
    if not sum(counts):
        least = 4 / 3 * math.pi * packing.radii[-1][0] ** 3 / window.volume
        raise InputError(
            f"a fraction of {packing.fraction:g} is less than half a stone in the window of {window}, where one "
            f"stone is {least:.2g}; enlarge the window or the fraction"
        )
    if sum(counts) > _MOST:
        raise InputError(
            f"the window of {window} would hold {sum(counts)} stones, more than {_MOST}; leave out the smallest "
            "size, which belongs to the mortar"
        )
    generator = np.random.default_rng(packing.seed)
    sizes = np.repeat([radius for radius, _ in packing.radii], counts)
    most = 0
    for _ in range(_STARTS):
        places = _placed(generator, sizes, packing, window, present)
        if len(places) == len(sizes):
            return Spheres(places[:, 0], places[:, 1], places[:, 2], sizes)
        most = max(most, len(places))
    # Those of its size that did not find room count as wanted, smaller ones were not tried.
    planned = sizes[sizes >= sizes[most]]
    raise InputError(_no_room(packing, sizes[:most], planned, window))


def _placed(
    generator: np.random.Generator, sizes: Array, packing: Drawn, window: Window, present: Sequence[Spheres]
) -> Array:
    """Places (n, 3) of the first n spheres of these sizes, as many as find room."""
    rows = [np.stack([spheres.x, spheres.y, spheres.z, spheres.radius], axis=1) for spheres in present]
    placed = np.concatenate([*rows, np.empty((0, 4))])
    first = len(placed)
    for radius in sizes:
        low = np.array([radius - window.length / 2, radius - window.width / 2, radius + packing.cover])
        high = np.array([-low[0], -low[1], window.depth - radius - packing.cover])
        place = _room(generator, placed, radius + packing.gap, low, high)
        if place is None:
            break
        placed = np.concatenate([placed, [[*place, radius]]])
    result: Array = placed[first:, :3]
    return result


def _room(generator: np.random.Generator, placed: Array, reach: float, low: Array, high: Array) -> Array | None:
    """A place for a sphere among others, None where none is found."""
    for _ in range(_TRIES // _AT_ONCE):
        places = low + (high - low) * generator.random((_AT_ONCE, 3))
        free = np.ones(_AT_ONCE, bool)
        if placed.size:
            apart = ((places[:, None] - placed[:, :3]) ** 2).sum(axis=-1)
            free = (apart >= (placed[:, 3] + reach) ** 2).all(axis=1)
        if free.any():
            roomiest: Array = places[int(np.argmax(free))]
            return roomiest
    return None


def _no_room(packing: Drawn, radii: Array, planned: Array, window: Window) -> str:
    """radii: of the stones that found room. planned: of those that were tried to the end of the size that did not."""
    reached, wanted = float((radii**3).sum()), float((planned**3).sum())
    return (
        f"{packing.fraction:.3g} of the window of {window} cannot be filled by drawing stones one by one: "
        f"{len(radii)} stones, a fraction of {4 / 3 * math.pi * reached / window.volume:.3g}, found room in the best "
        f"of {_STARTS} attempts; one size alone ends near {_JAMMED}, less in small windows: lower the fraction to "
        f"{0.95 * packing.fraction * reached / wanted:.2g}, take sizes farther apart, or count the smaller stones as "
        "mortar"
    )
