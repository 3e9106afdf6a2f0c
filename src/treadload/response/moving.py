"""Response under loads that move steadily over layers some of which are viscoelastic."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.points import Points
from treadload.kernels.half_space.wake import Cells, Term, delayed_fields
from treadload.kernels.layers.layered import Stack
from treadload.kernels.layers.moving import Body, Level, Path, dissipated_energy, moving_fields
from treadload.kernels.layers.wavenumbers import Spectrum, disc_spectrum, quadrature
from treadload.kernels.tensors import strain_from_stress
from treadload.materials import Anisotropic, Elastic, Material, Prony, Viscoelastic, as_prony
from treadload.materials.kinds import AnyElastic, limit_of
from treadload.pavement import Layer, Pavement
from treadload.pavement.stack import stack_of
from treadload.response.half_space import EvaluationGrid, half_space_response
from treadload.response.layered import drifting
from treadload.response.loads import GridLoad, SurfaceLoad, UniformDisc

# Where waves are cut and the half-space is split off: as for elastic layers, see `response.layered`.
_FALL, _SPLIT = 33.0, 0.9
# Energy goes with the square of the waves: what is left at e^-22 of it is 1e-7.
_FALL_OF_ENERGY = 11.0
# Depths whose limits differ by less than this factor share their wavenumbers.
_ALIKE = 1.5
# Wavenumbers that one response may take, some minutes, and that the energy at one depth may take, some seconds.
_MOST, _MOST_FOR_ENERGY = 2e7, 6e5
# The top layer follows its series of exponentials within this.
_SERIES = 1e-6
# Frequencies that the series must hold: those of waves this much longer than the problem, and of a part of a cell.
_LONGEST, _SHORTEST = 1e6, 0.1
# Creep over less than this part of a cell is immediate.
_QUICK = 1e-3
# Cells of a wake, a gigabyte with what their convolution needs.
_MOST_CELLS = 4e6
# Cells along a uniform disc or rectangle for the field of its wake; a grid's cells are halved.
_PIECES, _FINER = 120, 2


def at_speed(road: Pavement, speed: float | None) -> Pavement:
    """The road for loads of a speed, m/s: at rest and at infinite speed its viscoelastic layers are elastic.

    Raises InputError for a speed that is negative or missing, for a layer that needs a temperature and for a fluid.
    """
    if isinstance(speed, str) or (speed is not None and not speed >= 0):
        raise InputError(
            f"speed must be >= 0 m/s, got {speed!r}; loads travel along +x; for the other way turn them round"
        )
    if not road.is_viscoelastic:
        return road
    if speed is None:
        name, solid = next(
            (layer.name, layer.resolved) for layer in road.layers if not isinstance(layer.resolved, AnyElastic)
        )
        raise InputError(
            f"layer {name!r} is viscoelastic ({solid}): give speed=, of the load, in m/s; or solve an elastic "
            "limit of the road, speed=0 for a load at rest and speed=math.inf for a very fast one"
        )
    # A fluid has no limit of slow loads and would sink indefinitely: this refuses it.
    at_rest = road.rubbery
    if speed == 0:
        return at_rest
    return road.glassy if speed == math.inf else road


@dataclass(frozen=True)
class MovingFields:
    """Stress (6, nz, my, mx) in Pa, strain likewise, displacement (3, nz, my, mx) in m, energy (nz, my) in J/m³."""

    stress: Array
    strain: Array
    displacement: Array
    energy: Array
    method: str
    warnings: tuple[str, ...] = ()


def moving_response(
    loads: Sequence[SurfaceLoad],
    road: Pavement,
    speed: float,
    depths: Array,
    x: Array,
    y: Array,
    *,
    below: bool,
    at: Points | None = None,
) -> MovingFields:
    """Steady state of a road under loads that move along +x.

    speed: V, m/s, > 0 and finite. depths: (nz,), m, >= 0. x: (mx,), y: (my,), m, any coordinates, moving with the
    loads. below: whether a depth on an interface takes the layer below it. at: of the grid of x and y only
    these points; the energy has its distinct y. Inertia is left out.
    Energy: dissipated per unit volume by one passage, the integral of σ:dε over time; NaN where it needs too many
    wavenumbers. Near the surface a half-space of the top layer carries the steps of the load in closed form, its
    strain and displacement that of the load and its wake, see `kernels.half_space.wake`; the rest are waves, see
    `kernels.layers.moving`.
    Raises InputError where waves decay too slowly for the distance of the points.
    """
    problem = _Problem.of(loads, road, speed, depths, x, y, below)
    fields = np.zeros((len(depths), 15, *((len(y), len(x)) if at is None else at.shape)))
    if not road.is_homogeneous:
        for rows, limit in _alike(problem.limits):
            levels = [problem.levels[row] for row in rows]
            path, across = problem.panels(limit)
            fields[rows] = moving_fields(problem.spectra, problem.body, levels, limit, x, y, path, across, at)
    fields = np.moveaxis(fields, 1, 0)
    stress, displacement, strain = fields[:6].copy(), fields[6:9].copy(), fields[9:].copy()
    method = "moving"
    shallow = [row for row, level in enumerate(problem.levels) if level.split]
    if shallow:
        parts = _half_space(loads, problem.layers[0].resolved, problem.series, speed, depths[shallow], x, y, at)
        stress[:, shallow] += parts[0]
        strain[:, shallow] += parts[1]
        displacement[:, shallow] += parts[2]
        method = f"moving+{parts[3]}"
    for component, drifts in enumerate(drifting(problem.stack, loads)):
        if drifts:
            above = problem.stack.spring.index(0.0)
            displacement[component, [row for row, level in enumerate(problem.levels) if level.layer <= above]] = (
                np.nan
            )
    energy, warnings = problem.energy(y)
    return MovingFields(stress, strain, displacement, energy, method, warnings)


@dataclass(frozen=True)
class _Problem:
    """What the waves need to know."""

    layers: Sequence[Layer]
    stack: Stack
    body: Body
    series: Prony | None
    levels: Sequence[Level]
    limits: Array
    spectra: Sequence[Spectrum]
    reach: float
    extent: tuple[float, float]
    length: float

    @classmethod
    def of(
        cls,
        loads: Sequence[SurfaceLoad],
        road: Pavement,
        speed: float,
        depths: Array,
        x: Array,
        y: Array,
        below: bool,
    ) -> _Problem:
        layers = road.distinct_layers
        materials = [layer.resolved for layer in layers]
        glassy = _isotropic(layers, "glassy")
        stack = stack_of(road, glassy)
        bottom = float(stack.interfaces[-1]) if len(stack.interfaces) else 0.0
        depths = stack.snapped(depths)
        top = float(stack.interfaces[0]) if len(stack.interfaces) else math.inf
        levels, limits = [], []
        for z in depths.tolist():
            layer = stack.layer_at(z, below)
            split = layer == 0 and z < _SPLIT * top
            levels.append(Level(z, layer, below, split))
            limits.append(_FALL / (2 * top - z if split else z))
        extent_x, extent_y = _extent(load.extent_x for load in loads), _extent(load.extent_y for load in loads)
        reach, reach_x = _reach(extent_y, y), _reach(extent_x, x)
        stiff = [material.modulus for material in glassy]
        soft = [material.modulus for material in _isotropic(layers, "rubbery")]
        length = max(reach, reach_x, bottom * (max(stiff) / min(soft)) ** (1 / 3), float(depths.max()))
        series = None
        if any(level.split for level in levels) and not isinstance(materials[0], AnyElastic):
            cell = min(load.grid.dx if isinstance(load, GridLoad) else load.radius for load in loads)
            lowest, highest = speed / (_LONGEST * length), speed / (_SHORTEST * cell)
            series = as_prony(materials[0], lowest, highest, tolerance=_SERIES)
        followed: Sequence[Material] = materials if series is None else [series, *materials[1:]]
        body = Body(
            [_modulus(material, speed) for material in followed],
            [material.poisson for material in glassy],
            stack.thickness,
            stack.spring,
            stack.rigid,
        )
        spectra = [spectrum_of(load) for load in loads]
        return cls(layers, stack, body, series, levels, np.array(limits), spectra, reach, extent_x, length)

    def panels(self, limit: float) -> tuple[Path, tuple[Array, Array]]:
        path, across = Path.of(limit, self.extent, self.length), quadrature(limit, self.reach, self.length)
        if len(path.nodes) * len(across[0]) > _MOST:
            raise InputError(
                f"waves up to {limit:.0f} 1/m with points up to {self.reach:g} m beside the load need "
                f"{len(path.nodes)} x {len(across[0])} wavenumbers, more than {_MOST:g}: leave out the depths around "
                "thin layers near the surface or compute fewer distant points at a time"
            )
        return path, across

    def panels_of_energy(self, limit: float) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Waves meet their own conjugate: their phase turns over the length of the load, wherever the points are."""
        along = quadrature(limit, self.extent[1] - self.extent[0], self.length)
        return along, quadrature(limit, self.reach, self.length)

    def energy(self, y: Array) -> tuple[Array, tuple[str, ...]]:
        """Energy dissipated at each depth (nz, my), and a sentence on depths that are left out."""
        energy = np.zeros((len(self.levels), len(y)))
        lossy = [row for row, level in enumerate(self.levels) if callable(self.body.moduli[level.layer])]
        cheap = [row for row in lossy if self._affordable(self.levels[row].depth)]
        energy[[row for row in lossy if row not in cheap]] = np.nan
        limits = np.array([_FALL_OF_ENERGY / self.levels[row].depth for row in cheap])
        for rows, limit in _alike(limits):
            chosen = [cheap[row] for row in rows]
            levels = [replace(self.levels[row], split=False) for row in chosen]
            energy[chosen] = dissipated_energy(
                self.spectra, self.body, levels, limit, y, *self.panels_of_energy(limit)
            )
        # At a step of shear on the surface itself it has no bound, so it is left out there.
        if all(row in cheap or self.levels[row].depth == 0 for row in lossy):
            return energy, ()
        low, high = 1e-6, self.length
        while high > 1.01 * low:
            middle = math.sqrt(low * high)
            low, high = (low, middle) if self._affordable(middle) else (middle, high)
        return energy, (
            f"dissipated_energy is NaN at depths of less than {high * 1e3:.2g} mm: nearer to the surface, under "
            "this load and with points this far across, it takes too many wavenumbers",
        )

    def _affordable(self, depth: float) -> bool:
        if depth == 0:
            return False
        along, across = self.panels_of_energy(_FALL_OF_ENERGY / depth)
        return len(along[0]) * len(across[0]) <= _MOST_FOR_ENERGY


def _half_space(
    loads: Sequence[SurfaceLoad],
    material: Material,
    series: Prony | None,
    speed: float,
    depths: Array,
    x: Array,
    y: Array,
    at: Points | None,
) -> tuple[Array, Array, Array, str]:
    """Stress, strain and displacement of a half-space of the top layer, and the method."""
    where = EvaluationGrid(depths, x, y, at)
    if series is None:
        assert isinstance(material, Elastic)
        return half_space_response(loads, material, where)
    elastic = series.glassy
    stress, strain, displacement, method = half_space_response(loads, elastic, where)
    terms = [(strength, time * speed) for strength, time in series.creep_terms]
    later_stress, later = np.zeros_like(stress), np.zeros_like(displacement)
    for load in loads:
        cells = _cells_of_disc(load, y) if isinstance(load, UniformDisc) else _cells_of_grid(load)
        needed = (load.extent_x[1] - min(load.extent_x[0], float(x.min()))) / cells.dx * cells.load.shape[1]
        if needed > _MOST_CELLS:
            raise InputError(
                f"points as far as {load.extent_x[0] - x.min():g} m behind a load need {needed:.2g} cells of its "
                f"wake, more than {_MOST_CELLS:g}: leave them out at depths near the surface, or take larger cells"
            )
        quick = [strength for strength, length in terms if length < _QUICK * cells.dx]
        slow: list[Term] = [(strength, length) for strength, length in terms if length >= _QUICK * cells.dx]
        if quick:
            at_once = half_space_response([load], elastic, where)
            later_stress += sum(quick) * at_once[0]
            later += sum(quick) * at_once[2]
        if slow:
            wake = delayed_fields(cells, slow, depths, elastic.shear_modulus, elastic.poisson, x, y, at)
            later_stress += np.moveaxis(wake[0], 1, 0)
            later += np.moveaxis(wake[1], 1, 0)
    return (
        stress,
        strain + strain_from_stress(later_stress, elastic.modulus, elastic.poisson),
        displacement + later,
        method,
    )


def _cells_of_grid(load: GridLoad) -> Cells:
    """A grid's cells, each several along x, an even number: a cell's centre lies between two."""
    grid = load.grid
    times = max(_FINER, 2 * math.ceil(_PIECES / grid.nx / 2))
    if load.interpolation == "constant":
        return Cells(load.array, grid.dx, grid.dy, grid.x0, grid.y0).refined(times)
    # Means of the bilinear load over parts of cells, along both axes, one cell beyond the outermost centres.
    along, across = _hats(grid.nx, times), _hats(grid.ny, _FINER)
    dx, dy = grid.dx / times, grid.dy / _FINER
    x0, y0 = grid.x0 - grid.dx + 0.5 * dx, grid.y0 - grid.dy + 0.5 * dy
    return Cells(across @ load.array @ along.T, dx, dy, x0, y0)


def _hats(count: int, times: int) -> Array:
    """Means of hat functions, one for each of `count` centres, on parts of cells, (times (count + 1), count)."""
    parts = (np.arange(times * (count + 1)) + 0.5) / times - 1
    return np.asarray(np.maximum(0, 1 - np.abs(parts[:, None] - np.arange(count))))


def _cells_of_disc(disc: UniformDisc, y: Array) -> Cells:
    """A disc on cells by their covered area, with rows that the points fall on the middle of where they are even."""
    dy = 2 * disc.radius / _PIECES
    steps = np.diff(np.sort(y))
    if len(steps) and np.ptp(steps) < 1e-9 * np.abs(y).max():
        step = float(steps.mean())
        dy = step / math.ceil(step / dy) if step > dy else step * max(1, math.floor(dy / step))
    dx = 2 * disc.radius / _PIECES
    first = float(y.min()) + dy * (math.floor((disc.y - disc.radius - float(y.min())) / dy + 0.5))
    rows = math.ceil((disc.y + disc.radius - first) / dy + 0.5)
    points, shares = np.polynomial.legendre.leggauss(24)
    lines = first + dy * (np.arange(rows)[:, None] + 0.5 * points) - disc.y
    half = np.sqrt(np.maximum(disc.radius**2 - lines**2, 0))[..., None]
    edges = -disc.radius + dx * np.arange(_PIECES + 1)
    lengths = np.diff(np.clip(edges, -half, half), axis=-1)
    covered = np.einsum("jpi,p->ji", lengths, 0.5 * shares) / dx
    # Chords by Gauss's rule: what little area is lost at the rim comes back.
    covered *= math.pi * disc.radius**2 / (covered.sum() * dx * dy)
    load = np.zeros((3, rows, _PIECES))
    load[0] = disc.pressure * covered
    return Cells(load, dx, dy, disc.x + float(edges[0]) + 0.5 * dx, first)


def _isotropic(layers: Sequence[Layer], which: Literal["glassy", "rubbery"]) -> list[Elastic]:
    """Elastic limits of layers. Raises InputError for an anisotropic one."""
    limits = []
    for layer in layers:
        limit = limit_of(layer.resolved, which)
        if isinstance(limit, Anisotropic):
            raise InputError(
                f"layer {layer.name!r} is {limit}, beside viscoelastic layers: under moving loads all layers must be "
                "isotropic; take an Elastic, or elastic limits of the others with speed=0 or speed=math.inf"
            )
        limits.append(limit)
    return limits


def _modulus(material: Material, speed: float) -> float | Callable[[Array], ComplexArray]:
    if isinstance(material, Elastic):
        return material.modulus
    assert not isinstance(material, Anisotropic)
    solid: Viscoelastic = material
    return lambda kx: solid.complex_modulus(kx * speed).conj()


def spectrum_of(load: SurfaceLoad) -> Spectrum:
    """Transform of a load."""
    if isinstance(load, UniformDisc):
        return disc_spectrum(load.radius, load.pressure, load.x, load.y)
    return load.spectrum


def _extent(extents: Iterable[tuple[float, float]]) -> tuple[float, float]:
    first, last = zip(*extents, strict=True)
    return min(first), max(last)


def _reach(extent: tuple[float, float], points: Array) -> float:
    return float(max(points.max() - extent[0], extent[1] - points.min()))


def _alike(limits: Array) -> Iterable[tuple[list[int], float]]:
    """Rows whose limits are alike, and the largest of them."""
    left = [int(row) for row in np.argsort(-limits)]
    while left:
        rows = [row for row in left if limits[row] * _ALIKE >= limits[left[0]]]
        yield rows, float(limits[rows[0]])
        left = left[len(rows) :]
