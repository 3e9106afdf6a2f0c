"""Random contacts of a few cells to a few hundred, judged by direct sums: steady rolling and histories.

Two half-spaces, alike or not, under a load or an approach, with forces, creepages or one of each, and spin; surfaces
smooth, rough, flat and with grooves; friction from none to 5, also under laws. `fuzz.direct_sums` gives what pressure
and shear do, so that nothing of a solver judges its own work.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fuzz.direct_sums import Array, DirectSums
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.friction import Anisotropic, Exponential, PressureDependent
from treadload.contact.friction.laws import Coulomb, FrictionLaw, Interface
from treadload.contact.rolling_state import Rolling
from treadload.contact.solvers.coupling import Surfaces, solve_coupled
from treadload.contact.solvers.marching import Stage, march
from treadload.contact.solvers.rolling import rigid_slip
from treadload.errors import ConvergenceError
from treadload.grid import Grid
from treadload.kernels.half_space.rectangle import CombinedElasticity

TOLERANCE = 1e-6
# Of what is judged over the tolerance: conditions are met to it, and pressure and shear fit each other to it.
SLACK = 3.0
# Sums of a few hundred numbers in another order, relative to the largest of their terms.
ROUND_OFF = 1e-11
# Shear and forces of a known creepage beside those of the equations solved densely, relative.
ACCURATE = 5e-4


@dataclass(frozen=True, eq=False)
class Scene:
    """Two bodies on a grid. gap: (ny, nx), m, NaN where there is no material. load: N, that suits them."""

    bodies: CombinedElasticity
    grid: Grid
    gap: Array
    load: float

    @property
    def influence(self) -> Influence:
        """The operators under test."""
        return Influence(self.grid.shape, self.grid.dx, self.grid.dy, HalfSpaces(self.bodies))

    @property
    def sums(self) -> DirectSums:
        """The operators that judge."""
        b, g = self.bodies, self.grid
        return DirectSums(g.shape, g.dx, g.dy, b.shear_modulus, b.poisson, b.difference)


def attack(rng: random.Random, folder: Path) -> str:
    """Draw a contact, solve it and judge it."""
    scene = draw_scene(rng)
    return (_roll if rng.random() < 0.6 else _march)(rng, scene)


def draw_scene(rng: random.Random) -> Scene:
    """Bodies, cells, a surface, and a load that presses some of them."""
    ratio = rng.choice((0.0, 0.5, 0.5, 0.49, 0.45, 0.3, rng.uniform(0, 0.5)))
    shear = 10 ** rng.uniform(5, 8)
    kind = rng.random()
    if kind < 0.25:
        bodies = CombinedElasticity.of(shear, ratio, shear, ratio)
    elif kind < 0.5:
        bodies = CombinedElasticity.of(shear, ratio, math.inf, 0.0)
    else:
        other = shear * 10 ** rng.uniform(-1, 4), rng.choice((0.0, 0.2, 0.35, 0.5, rng.uniform(0, 0.5)))
        bodies = CombinedElasticity.of(shear, ratio, *other)
    nx, ny = rng.randint(4, 18), rng.randint(3, 18)
    dx = 10 ** rng.uniform(-4, -2)
    dy = dx * rng.choice((1.0, 1.0, 0.5, 2.0, rng.uniform(0.4, 2.5)))
    grid = Grid(nx, ny, dx, dy, -dx * (nx - 1) / 2, -dy * (ny - 1) / 2)
    # A contact of less than a cell to one that is larger than the grid.
    half = min(nx * dx, ny * dy) / 2
    width = rng.choice((rng.uniform(0.2, 2.0) * max(dx, dy), rng.uniform(0.2, 1.2) * half))
    strain = 10 ** rng.uniform(-4, -0.5)
    radius = width / strain
    middle = (rng.choice((0.0, rng.uniform(-0.6, 0.6) * dx)), rng.choice((0.0, rng.uniform(-0.6, 0.6) * dy)))
    x, y = grid.x[None, :] - middle[0], grid.y[:, None] - middle[1]
    slender = rng.choice((1.0, 1.0, rng.uniform(0.3, 3.0)))
    gap = x**2 / (2 * radius) + slender * y**2 / (2 * radius)
    numbers = np.random.default_rng(rng.getrandbits(32))
    form = rng.random()
    if form < 0.15:
        gap = np.where(np.hypot(x, y) < width, 0.0, np.nan)
        if np.isnan(gap).all():
            gap = np.where(np.isnan(gap), 0.0, gap)
    elif form < 0.4:
        gap = gap + strain * width * rng.choice((0.01, 0.1, 1.0)) * numbers.random(gap.shape)
    if rng.random() < 0.2:
        gap[:, rng.randrange(nx)] = np.nan
    if rng.random() < 0.2:
        gap[rng.randrange(ny), :] = np.nan
    if np.isnan(gap).all():
        gap = np.zeros(gap.shape)
    load = 4 / 3 * bodies.contact_modulus * width**2 * strain
    return Scene(bodies, grid, gap, load)


def draw_friction(rng: random.Random) -> float:
    """A coefficient."""
    return rng.choice((0.01, 0.01, 0.03, 0.1, 0.3, 0.7, 1.0, 1.5, 5.0, rng.uniform(0.0, 1.5)))


def draw_law(rng: random.Random, scene: Scene) -> FrictionLaw:
    """A law that has one steady state."""
    number, kind = draw_friction(rng), rng.random()
    if kind < 0.75 or number == 0:
        return Coulomb(number)
    pressed = scene.load / (scene.grid.cell_area * 10)
    if kind < 0.83:
        return Anisotropic(number, number * rng.uniform(0.5, 2.0))
    if kind < 0.91:
        return PressureDependent(number, pressed, rng.uniform(0, 1 / 3))
    return Exponential(number, number * rng.uniform(0.7, 1.0), rng.uniform(0.5, 5.0))


def _roll(rng: random.Random, scene: Scene) -> str:
    law = draw_law(rng, scene)
    grid = scene.grid
    bodies = scene.bodies
    # A creepage at which about all slips, and from a ten-millionth of it on.
    full = min(0.3, law.largest * scene.load / (bodies.shear_modulus * (grid.nx * grid.dx) ** 2 * 0.05))
    wheel: dict[str, Any] = {"friction": law, "speed": 10.0}
    if rng.random() < 0.85:
        wheel["normal_load"] = scene.load
    else:
        wheel["approach"] = float(np.nanmin(scene.gap) + scene.load / (bodies.contact_modulus * grid.nx * grid.dx))
    limit = law.largest * scene.load * 0.9
    for force, creepage in (("tractive_force", "creepage_x"), ("lateral_force", "creepage_y")):
        sign = rng.choice((-1, 1))
        if rng.random() < 0.5 and "normal_load" in wheel:
            part = rng.choice((0.0, rng.uniform(0, 1.3), rng.uniform(0, 1.3), 10 ** rng.uniform(-7, 0)))
            wheel[force] = sign * limit * part
        else:
            wheel[creepage] = sign * full * rng.choice((0.0, rng.uniform(0, 3), 10 ** rng.uniform(-7, 0)))
    if rng.random() < 0.4:
        wheel["spin"] = rng.choice((-1, 1)) * full / (grid.nx * grid.dx) * 10 ** rng.uniform(-3, 1)
    rolling = Rolling(**wheel)
    try:
        solved = ask(
            lambda: solve_coupled(
                scene.influence, Surfaces(grid, scene.gap), rolling, check=lambda p: None, tolerance=TOLERANCE
            )
        )
    except ConvergenceError as error:
        # There is no such contact: friction at rest carries the force, and slip takes it away.
        if law.needs_speed and "gross sliding: friction falls" in str(error):
            return REFUSED
        raise
    if isinstance(solved, Refusal):
        return REFUSED
    normal, slipping = solved.normal, solved.slipping
    tangential = slipping.tangential
    judge_pressing(scene, normal, tangential.shear, rolling.normal_load, rolling.approach)
    at = Interface(normal.pressure, tangential.slip, grid.x, grid.y, grid.dx, rolling.speed)
    creepages = np.array(rolling.creepages) + tangential.rigid
    rigid = rigid_slip(grid.x, grid.y, grid.dx, (creepages[0], creepages[1]), rolling.spin) * grid.dx
    here, ahead = scene.sums.displacement(0.0), scene.sums.displacement(grid.dx)
    p, q = normal.pressure.ravel(), tangential.shear.ravel()
    by_shear = here[0] - ahead[0]
    known = rigid.ravel() + (here[1] - ahead[1]) @ p
    judge_shear(scene, law.bound(at), law.axes, by_shear, known, tangential, rolling.forces, scale=grid.dx)
    if None in rolling.forces and rolling.forces == (None, None) and not law.needs_speed and law.axes == (1.0, 1.0):
        judge_forces(law.bound(at), by_shear, known, q)
    return TAKEN


def _march(rng: random.Random, scene: Scene) -> str:
    grid, sums = scene.grid, scene.sums
    mu = draw_friction(rng)
    stages = []
    travel = rng.choice((0.0, 0.0, 0.3, 1.0, 1.7)) * grid.dx
    known_forces = rng.random() < 0.5
    full = mu * scene.load / (scene.bodies.shear_modulus * grid.nx * grid.dx)
    for _ in range(rng.randint(1, 4)):
        load = scene.load * rng.choice((1.0, 1.0, rng.uniform(0.5, 2.0)))
        rigid, forces = np.zeros((2, 1, 1)), [None, None]
        for c in (0, 1):
            if known_forces:
                forces[c] = mu * load * rng.choice((0.0, rng.uniform(-0.65, 0.65)))
            else:
                rigid[c] = full * rng.choice((0.0, rng.uniform(-2, 2), 10 ** rng.uniform(-6, 0)))
        stages.append(Stage(rigid, (forces[0], forces[1]), mu, travel, load=load))
    n = grid.nx * grid.ny
    before = np.zeros(2 * n), np.zeros(n)
    here, past = sums.displacement(0.0), sums.displacement(travel)
    for state in march(scene.influence, stages, gap=scene.gap, tolerance=TOLERANCE):
        tangential = state.tangential
        judge_pressing(scene, state.normal, tangential.shear, state.stage.load, None)
        p, q = state.pressure.ravel(), tangential.shear.ravel()
        moved = state.stage.rigid + np.array(state.displaced)[:, None, None]
        rigid = np.broadcast_to(moved, (2, *grid.shape)).ravel()
        known = rigid + here[1] @ p - past[0] @ before[0] - past[1] @ before[1]
        judge_shear(scene, mu * state.pressure, (1.0, 1.0), here[0], known, tangential, state.stage.forces)
        before = q, p
    return TAKEN


def judge_pressing(scene: Scene, normal: Any, shear: Array, load: float | None, approach: float | None) -> None:
    """No pull, no overlap, no pressure across a gap; load carried, gap and approach those of the tractions."""
    p = normal.pressure
    if not (np.isfinite(p).all() and p.min() >= 0 and (p > 0).any()):
        raise WrongAnswer("pressure pulls, is not finite or is zero")
    if p[np.isnan(scene.gap)].any():
        raise WrongAnswer("pressure where there is no material")
    if load is not None and abs(p.sum() * scene.grid.cell_area / load - 1) > ROUND_OFF * 100:
        raise WrongAnswer(f"a load of {load:g} N is carried as {p.sum() * scene.grid.cell_area:g} N")
    if approach is not None and abs(normal.approach / approach - 1) > ROUND_OFF:
        raise WrongAnswer(f"an approach of {approach:g} m became {normal.approach:g} m")
    sums = scene.sums
    by_shear = (sums.opening_by_shear @ shear.ravel()).reshape(p.shape)
    opening = scene.gap + by_shear + (sums.opening_by_pressure @ p.ravel()).reshape(p.shape)
    gap = opening - normal.approach
    scale = max(abs(normal.approach - np.nanmin(scene.gap + by_shear)), np.abs(by_shear).max())
    allowed = SLACK * TOLERANCE * scale + ROUND_OFF * float(np.nanmax(np.abs(opening)))
    material = ~np.isnan(scene.gap)
    for what, size in (
        ("a gap where bodies press", np.abs(gap[p > 0]).max()),
        ("overlap", -gap[material].min()),
        ("another gap than the one reported", np.abs(normal.gap - gap)[material].max()),
    ):
        _at_most(what, float(size), allowed)


def judge_shear(
    scene: Scene,
    bound: Array,
    axes: tuple[float, float],
    by_shear: Array,
    known: Array,
    found: Any,
    forces: tuple[float | None, float | None],
    scale: float = 1.0,
) -> None:
    """Coulomb's law in every cell with the slip of the direct sums; forces; the slip reported.

    by_shear: (2 n, 2 n), m/Pa. known: (2 n,), m, slip by all else. scale: of the slip reported, m.
    """
    q = found.shear.reshape(2, -1)
    g = bound.ravel()
    stretch = np.array(axes)[:, None]
    slip = (by_shear @ q.ravel() + known).reshape(2, -1)
    whole = float(np.linalg.norm(g))
    beyond = np.maximum(np.hypot(*(q / stretch)) - g, 0.0)
    _at_most("shear beyond the bound of friction", float(np.linalg.norm(beyond)), SLACK * TOLERANCE * whole)
    r = 1 / by_shear[0, 0]
    allowed = SLACK * TOLERANCE * whole + ROUND_OFF * float(np.linalg.norm(r * known))
    reach = q / stretch - r * stretch * slip
    size = np.hypot(*reach)
    error = q / stretch - reach * np.divide(g, size, out=np.ones_like(g), where=size > g)
    _at_most("Coulomb's law", float(np.linalg.norm(error)), allowed)
    for c, force in enumerate(forces):
        if force is not None:
            missing = abs(q[c].sum() * scene.grid.cell_area - force)
            _at_most(f"force {c}", missing, SLACK * TOLERANCE * g.sum() * scene.grid.cell_area)
    reported = found.slip.reshape(2, -1) * scale
    slips = (g > 0) & ~found.stick.ravel()
    _at_most("slip reported", float(np.linalg.norm(r * (reported - slip)[:, slips])), allowed)
    if reported[:, ~slips].any():
        raise WrongAnswer("slip reported where it sticks")


def judge_forces(bound: Array, by_shear: Array, known: Array, q: Array) -> None:
    """Shear beside that of the same equations, solved densely by Newton's method from there on."""
    exact = polished(bound.ravel(), by_shear, known, q)
    if exact is None:
        return
    _at_most("shear of a creepage", float(np.linalg.norm(q - exact)), ACCURATE * float(np.linalg.norm(exact)))


def polished(g: Array, by_shear: Array, known: Array, q: Array) -> Array | None:
    """Shear (2 n,) of Coulomb's law to round-off; None where Newton's method does not end."""
    n, r = g.size, 1 / by_shear[0, 0]
    inside = g > 0
    cells = np.concatenate([inside, inside])
    a, w, g = r * by_shear[np.ix_(cells, cells)], r * known[cells], g[inside]
    z, n = q[cells].copy(), g.size
    for _ in range(60):
        reach = (z - a @ z - w).reshape(2, n)
        size = np.hypot(*reach)
        slips = size > g
        factor = np.where(slips, g / np.where(slips, size, 1.0), 1.0)
        error = z - (reach * factor).ravel()
        if np.linalg.norm(error) <= 1e-13 * np.linalg.norm(g) or np.linalg.norm(error) <= 1e-11 * np.linalg.norm(z):
            out = np.zeros(cells.size)
            out[cells] = z
            return out
        unit = reach / np.where(size > 0, size, 1.0)
        # Derivative of the projection: the identity inside, factor times what lies across the reach outside.
        across = np.stack([-unit[1], unit[0]])
        parts = [[np.where(slips, factor * across[i] * across[j], float(i == j)) for j in (0, 1)] for i in (0, 1)]
        turn = np.block([[np.diag(parts[i][j]) for j in (0, 1)] for i in (0, 1)])
        z = z - np.linalg.solve(np.eye(2 * n) - turn @ (np.eye(2 * n) - a), error)
    return None


def _at_most(what: str, size: float, allowed: float) -> None:
    if not size <= allowed:
        raise WrongAnswer(f"{what}: {size:.3g}, at most {allowed:.3g}, by a factor of {size / allowed:.3g}")
