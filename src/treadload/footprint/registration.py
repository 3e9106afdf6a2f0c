"""Where a sensor lay under a tire: shift, turn and mirror that bring a measured map onto a computed one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from treadload.footprint.footprint import Footprint, edges_of
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.gridding.overlap import means_over_cells, means_over_faces
from treadload.response import GridLoad

# Angles, rad, from which the search starts, and beyond which a print is taken for one of another quarter.
_STARTS = np.radians([-8.0, -4.0, 0.0, 4.0, 8.0])
# Cells along the longer side of the maps that candidates are compared on: ribs and grooves are still seen.
_COARSE = 40
# And those on which the pose that is taken is refined: finer ones, such as pixels, tell no more.
_ENOUGH = 160
# Candidates whose correlation on coarse maps lies this far below the best are none.
_PROMISING = 0.05
# A print that is turned or mirrored overlaps more than it does as it stands by this share of the pressure, or it is
# not: treads are near enough symmetric for noise to choose between their images.
CLEAR = 0.02
# Step of the derivatives, in pitches.
_STEP = 0.1
# How far to the sides pins are looked for from where the centres of pressure meet, and the steps of that, m.
_REACH, _TRIED = 20e-3, 1e-3
# Accuracy of the pose, in pitches, and looks at the map: of candidates and of the one that is taken.
_RUGGED, _FINE = (1e-2, 4), (1e-6, 40)


@dataclass(frozen=True)
class Registration:
    """How a footprint was laid onto a contact.

    quarter_turns: anticlockwise on the page with travel to the right, after it was mirrored (y to -y) or not.
    shift_x, shift_y: by which its middle was then moved, m. angle: rad, by which its axes are turned from travel
    towards the right. overlap: share of the pressure that overlaps. candidates: overlap of poses by their
    words, on coarse maps.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> found = tl.footprint.register(load, tl.Footprint(load), turns=False)
    >>> f"{found.overlap:.0%} of the pressure overlaps"
    '100% of the pressure overlaps'
    """

    quarter_turns: int = 0
    mirrored: bool = False
    shift_x: float = 0.0
    shift_y: float = 0.0
    angle: float = 0.0
    overlap: float = math.nan
    candidates: Mapping[str, float] = field(default_factory=dict)

    @property
    def words(self) -> str:
        """What was done, "mirrored left to right" or "as it stands"."""
        return pose_in_words(self.quarter_turns, self.mirrored)

    def __str__(self) -> str:
        return (
            f"{self.words}, moved by {self.shift_x * 1e3:z.1f} and {self.shift_y * 1e3:z.1f} mm, turned by "
            f"{math.degrees(self.angle):z.2f}°"
        )


def pose_in_words(quarter_turns: int, mirrored: bool) -> str:
    """A turn by quarters and a mirror image in words."""
    if mirrored and quarter_turns % 2 == 0:
        return "mirrored front to back" if quarter_turns % 4 else "mirrored left to right"
    turned = f"turned by {90 * (quarter_turns % 4)}°"
    if quarter_turns % 4 == 0:
        return "as it stands"
    return f"mirrored and {turned}" if mirrored else turned


def laid(footprint: Footprint, quarter_turns: int, mirrored: bool) -> Footprint:
    """A footprint mirrored and turned by quarters with its shear, its middle at the origin."""
    stress, holes, grid = footprint.load.array, ~footprint.sensels, footprint.grid
    if mirrored:
        stress, holes = stress[:, ::-1] * np.array([1.0, 1.0, -1.0])[:, None, None], holes[::-1]
    pressure, along, across = np.rot90(stress, quarter_turns, axes=(1, 2))
    holes = np.rot90(holes, quarter_turns)
    for _ in range(quarter_turns % 4):
        # Rows run down the page and to the right of travel: travel turns to the left, the right ahead.
        along, across = across, -along
    dx, dy = (grid.dy, grid.dx) if quarter_turns % 2 else (grid.dx, grid.dy)
    ny, nx = pressure.shape
    middle = Grid(nx, ny, dx, dy, -0.5 * (nx - 1) * dx, -0.5 * (ny - 1) * dy)
    load = GridLoad(middle, pressure, along, across, source=footprint.source)
    pin = None if footprint.pin is None else (footprint.pin[::-1] if quarter_turns % 2 else footprint.pin)
    return replace(footprint, load=load, missing=holes, pin=pin)


def seen(load: GridLoad, sensels: Grid, angle: float) -> Array:
    """Pressure (ny, nx), Pa, of a load as means over sensels, exact by area. angle: of the sensels' axes, rad."""
    return means_over_cells(np.maximum(load.array[0], 0.0), *edges_of(load.grid), *edges_of(sensels), angle)


def through(load: GridLoad, sensor: Footprint, angle: float = 0.0) -> Array:
    """Pressure, traction_x and traction_y (3, ny, nx), Pa, of a load as a sensor's sensels or pins average them.

    angle: rad, by which the sensor's axes are turned from travel, along which the components are; of pins 0.
    """
    if sensor.pin is None:
        edges = edges_of(sensor.grid)
        return np.array([means_over_cells(part, *edges_of(load.grid), *edges, angle) for part in load.array])
    places = (sensor.grid.x, sensor.grid.y)
    return np.array([means_over_faces(part, *edges_of(load.grid), *places, sensor.pin) for part in load.array])


def cut_off(pressure: Array, threshold: float, saturation: float) -> Array:
    """Pressure as a sensor measures it: none below its threshold, no more than its saturation."""
    clipped: Array = np.where(pressure < threshold, 0.0, np.minimum(pressure, saturation))
    return clipped


def overlap(first: Array, second: Array) -> float:
    """Share of the pressure of two maps that overlaps: the sum of the lesser over that of the larger."""
    larger = float(np.maximum(first, second).sum())
    return float(np.minimum(first, second).sum()) / larger if larger > 0 else math.nan


def register(load: GridLoad, footprint: Footprint, *, turns: bool = True) -> Registration:
    """The pose in which a footprint fits a load best, in the sense of least squares of the pressures.

    The load is seen through the sensor at every pose, scaled to the footprint's pressures: a wrong calibration does
    not move it. turns: False leaves quarter turns and mirror images out. A pose other than as it stands is taken
    where it overlaps clearly more.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> tl.footprint.register(load, tl.Footprint(load), turns=False).words
    'as it stands'
    """
    poses = [(k, m) for m in (False, True) for k in range(4)] if turns else [(0, False)]
    coarse, rough = _coarse(load, footprint, _COARSE), _coarsened(footprint, _COARSE)
    windows: dict[tuple[float, float, float], tuple[Grid, Array]] = {}
    starts = {pose: _start(coarse, laid(rough, *pose), windows) for pose in poses}
    best = max(score for score, _ in starts.values())
    refined: dict[tuple[int, bool], tuple[float, Array]] = {}
    for pose, (score, start) in starts.items():
        if score >= best - _PROMISING or pose == (0, False):
            refined[pose] = _refined(coarse, laid(rough, *pose), start, *_RUGGED)
    chosen = max(refined, key=lambda pose: refined[pose][0])
    if refined[chosen][0] < refined[0, False][0] + CLEAR:
        chosen = (0, False)
    fine = laid(_coarsened(footprint, _ENOUGH), *chosen)
    share, pose_at = _refined(_coarse(load, footprint, _ENOUGH), fine, refined[chosen][1], *_FINE)
    candidates = {pose_in_words(*pose): value for pose, (value, _) in refined.items()}
    x, y, angle = (float(value) for value in pose_at)
    return Registration(*chosen, x, y, angle, share, candidates)


def register_pins(load: GridLoad, footprint: Footprint, near: float | None = None) -> Registration:
    """The shift along and across under which pins read a load best, in the sense of least squares of the pressures.

    A table of pins has axes of its own: nothing is turned or mirrored. Pins stand in grooves or beside them, so that
    the places across are tried one after the other before the best is refined. near: shift across,
    m, from which it is refined without that.
    """
    grid, measured, there = footprint.grid, footprint.pressure, footprint.sensels
    total, size = float(measured[there].sum()), float(np.linalg.norm(measured[there]))
    across, along = np.where(there, measured, 0.0).sum(axis=1), np.where(there, measured, 0.0).sum(axis=0)
    centre = _centre(load)
    start = np.array([centre[0] - float(along @ grid.x) / total, centre[1] - float(across @ grid.y) / total])

    def at(shift: Array) -> Array:
        laid_there = footprint.moved(float(shift[0]), float(shift[1]))
        by_pins = through(load, laid_there)[0]
        scaled = _ratio(by_pins, measured, there) * by_pins
        residual: Array = (scaled - measured)[there] / size
        return residual

    if near is None:
        steps = np.arange(-_REACH, _REACH + 1e-9, _TRIED)
        tried = [start + np.array([0.0, step]) for step in steps]
    else:
        tried = [np.array([start[0], near])]
    best = min(tried, key=lambda shift: float(np.square(at(shift)).sum()))
    solution = scipy.optimize.least_squares(
        at, best, x_scale=_TRIED, xtol=1e-10, ftol=1e-12, gtol=1e-12, max_nfev=_FINE[1]
    )
    x, y = (float(value) for value in solution.x)
    by_pins = through(load, footprint.moved(x, y))[0]
    share = overlap(_ratio(by_pins, measured, there) * by_pins[there], measured[there])
    return Registration(shift_x=x, shift_y=y, overlap=share)


def _coarse(load: GridLoad, footprint: Footprint, most: int) -> GridLoad:
    """A load on cells as fine as a footprint of at most so many along a side needs."""
    size = 0.7 * _size(footprint, most)
    if not _is_large(footprint, most) or max(load.grid.dx, load.grid.dy) >= size:
        return load
    return Footprint(GridLoad(load.grid, load.pressure)).resampled(size).load


def _coarsened(footprint: Footprint, most: int) -> Footprint:
    """A footprint on at most so many cells along a side, or as it is where it has few more."""
    if not _is_large(footprint, most):
        return footprint
    return replace(footprint.resampled(_size(footprint, most)), saturation=footprint.saturation)


def _size(footprint: Footprint, most: int) -> float:
    grid = footprint.grid
    return max(grid.dx, grid.dy, max(grid.nx * grid.dx, grid.ny * grid.dy) / most)


def _is_large(footprint: Footprint, most: int) -> bool:
    return _size(footprint, most) > 1.5 * max(footprint.pitch)


def _start(
    load: GridLoad, print_: Footprint, windows: dict[tuple[float, float, float], tuple[Grid, Array]]
) -> tuple[float, Array]:
    """Largest correlation of the maps over all shifts and a few angles, and its pose (x, y, angle).

    windows: cells about the load and what it presses on them, by angle and pitch: all poses need the same.
    """
    # scipy.signal brings scipy.stats along, which takes as long to import as all of this package.
    from scipy.signal import correlate

    grid, pressure = print_.grid, print_.pressure
    best, pose = -1.0, np.zeros(3)
    for angle in map(float, _STARTS):
        key = (angle, grid.dx, grid.dy)
        if key not in windows:
            placed = _window(load, *key)
            windows[key] = placed, seen(load, placed, angle)
        placed, computed = windows[key]
        size = math.sqrt(float((computed**2).sum() * (pressure**2).sum()))
        if size == 0:
            continue
        scores = correlate(computed, pressure, mode="full") / size
        j, i = (int(k) for k in np.unravel_index(int(scores.argmax()), scores.shape))
        if scores[j, i] > best + 1e-9:
            # Lag of the print's first cell behind the window's.
            ahead, right = i - (grid.nx - 1), j - (grid.ny - 1)
            best = float(scores[j, i])
            pose = np.array([placed.x0 + ahead * grid.dx - grid.x0, placed.y0 + right * grid.dy - grid.y0, angle])
    return best, pose


def _window(load: GridLoad, angle: float, dx: float, dy: float) -> Grid:
    """Cells about the centre of a load that hold it at an angle."""
    side = math.hypot(load.grid.nx * load.grid.dx, load.grid.ny * load.grid.dy)
    window = Grid.on_lattice(side, side, dx, dy)
    (x, y), cos, sin = _centre(load), math.cos(angle), math.sin(angle)
    return replace(window, x0=window.x0 + x * cos + y * sin, y0=window.y0 - x * sin + y * cos)


def _refined(load: GridLoad, print_: Footprint, start: Array, accuracy: float, most: int) -> tuple[float, Array]:
    """Overlap and pose (x, y, angle) of least squares, from a start."""
    grid, measured, there = print_.grid, print_.pressure, print_.sensels
    reach = 0.5 * math.hypot(grid.nx * grid.dx, grid.ny * grid.dy)
    scale = np.array([grid.dx, grid.dy, min(grid.dx, grid.dy) / reach])
    floor = print_.threshold
    full = measured >= print_.saturation * (1 - 1e-9)
    size = float(np.sqrt((measured[there] ** 2).sum()))
    wanted = np.maximum(measured, floor)

    def residual(pose: Array) -> Array:
        x, y, angle = start + pose * scale
        computed = seen(load, replace(grid, x0=grid.x0 + x, y0=grid.y0 + y), angle)
        by = _ratio(computed, measured, there & ~full)
        clipped = np.maximum(np.minimum(by * computed, print_.saturation), floor)
        difference: Array = ((clipped - wanted)[there]) / size
        return difference

    def slopes(pose: Array) -> Array:
        steps = _STEP * np.eye(3)
        columns: Array = np.stack([(residual(pose + s) - residual(pose - s)) / (2 * _STEP) for s in steps], axis=1)
        return columns

    solution = scipy.optimize.least_squares(
        residual, np.zeros(3), jac=slopes, xtol=accuracy, ftol=accuracy**2, max_nfev=most
    )
    x, y, angle = start + solution.x * scale
    computed = seen(load, replace(grid, x0=grid.x0 + x, y0=grid.y0 + y), angle)
    by = _ratio(computed, measured, there & ~full)
    clipped = cut_off(by * computed, floor, print_.saturation)
    return overlap(clipped[there], measured[there]), np.array([x, y, angle])


def _ratio(computed: Array, measured: Array, where: BoolArray) -> float:
    """What computed pressures are multiplied by to fit the measured ones best."""
    size = float((computed[where] ** 2).sum())
    by = float((computed[where] * measured[where]).sum()) / size if size > 0 else 1.0
    return by if by > 0 else 1.0


def _centre(load: GridLoad) -> tuple[float, float]:
    pressure, grid = np.maximum(load.array[0], 0.0), load.grid
    total = float(pressure.sum())
    return float((pressure.sum(axis=0) * grid.x).sum()) / total, float((pressure.sum(axis=1) * grid.y).sum()) / total
