"""Pressure and shear that fit each other: dissimilar bodies couple them both ways.

Shear opens or closes the gap, pressure makes the surfaces slip. The unknown is the gap that shear makes; a round
solves normal contact with it, then rolling, and asks what gap the new shear makes. Anderson's method mixes the
last rounds, so that strong coupling settles where plain alternation circles.

Source of the loop: Panagiotopoulos (1975), Ing. Arch. 44, 421-432; of the mixing that of `kernels.mixing`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.condensed import CondensedInfluence
from treadload.contact.bodies.influence import Influence
from treadload.contact.friction.laws import Interface
from treadload.contact.rolling_state import Rolling
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.contact.solvers.rolling import rigid_slip
from treadload.contact.solvers.slipping import SlippingSolution, solve_slipping, strongest
from treadload.contact.solvers.tangential import TangentialSolution
from treadload.contact.solvers.window import GrownError, Window
from treadload.errors import ConvergenceError, InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.mixing import Anderson

_MOST_ROUNDS = 150
# Rounds that are mixed: from so many rounds on, all that are of use.
_MEMORY, _SLOW, _LONG_MEMORY = 6, 20, 20
# Where what pressing and rolling leave keeps them apart, both aim this much lower.
_TIGHTER = 0.3
# A change of the pressure below it is round-off.
_SAME = 1e-14
# Of ribs: what pressing and rolling aim at in the first round, and rolling then per change of the pressure. Pressing
# costs less than rolling, and what it leaves would mislead the mixing: it aims at the tolerance at once.
_FIRST_PRESSING, _FIRST_AIM, _AIM = 1e-4, 1e-2, 0.1

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Start:
    """A contact near the one sought, on the same grid: pressure (ny, nx), Pa, and shear with its creepages.

    tangential: None where the wheel is driven or turned otherwise, so that half the grid is a better start.
    """

    pressure: Array
    tangential: TangentialSolution | None


@dataclass(frozen=True)
class Coupled:
    """Normal and tangential solutions that fit each other.

    rounds: of the loop. change: of the pressure in the last round, relative. normal_iterations, newton, krylov,
    splitting: of all rounds.
    """

    normal: NormalSolution
    slipping: SlippingSolution
    rounds: int
    change: float
    normal_iterations: int
    newton: int
    krylov: int
    splitting: int


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Two surfaces before they touch, on a grid.

    gap: initial (ny, nx), m. rows: rigid slip along x (ny, 1) of rows that roll on other radii, `Tire.row_slip`.
    """

    grid: Grid
    gap: Array
    rows: Array | None = None


def solve_coupled(
    influence: Influence,
    surfaces: Surfaces,
    rolling: Rolling,
    *,
    check: Callable[[Array], None],
    start: Start | None = None,
    tolerance: float = 1e-6,
    tell: Progress = lambda text: None,
) -> Coupled:
    """Pressure, shear, slip and creepages of two bodies on a grid.

    check: called with the first pressure, to refuse it early, and with the one returned, which shear may have
    widened.
    start: a solution near this one. tolerance: of the normal and the tangential
    conditions, and of the relative change of pressure.
    Bodies whose Dundurs' β is below the tolerance count as alike. Raises InputError where nothing touches or
    friction cannot carry the forces, ConvergenceError with the residual reached.
    """
    grid, gap, rows = surfaces.grid, surfaces.gap, surfaces.rows
    coupled = abs(influence.dundurs) > tolerance
    # Under friction, ribs press with a share of what their shear will do. Where friction falls with slip there may be
    # two steady states, and the plain rounds lead to the one that sticks more.
    foresees = coupled and rolling.law.largest > 0 and not rolling.law.needs_speed
    condensed = CondensedInfluence.of(influence) if foresees else None

    def opened(shear: Array, pressure: Array) -> Array:
        """What the gap has besides the initial one and what pressing adds."""
        return influence.gap_by_shear(shear) if condensed is None else condensed.gap_by(shear, pressure)

    offset: Array = np.zeros(grid.shape)
    last = None if start is None else start.tangential
    if coupled and start is not None and last is not None:
        offset = opened(last.shear, start.pressure)

    def press(by_shear: Array, near: Array | None, within: float) -> NormalSolution:
        control = {"load": rolling.normal_load, "approach": rolling.approach}
        # Shear moves the gap's zero a little, and with it what the tolerance is relative to.
        share = 0.5 if coupled else 1.0
        return solve_normal(condensed or influence, gap + by_shear, **control, start=near, tolerance=share * within)

    # Ribs couple strongly, and no round needs to be much better than the pressure that it starts from.
    striped = coupled and influence.has_strips
    first = max(_FIRST_PRESSING, tolerance) if striped else tolerance
    normal = press(offset, None if start is None else start.pressure, first)
    check(normal.pressure)
    at_rest = _at_rest(normal.pressure, grid, rolling)
    window = Window.of(influence, grid, normal.pressure) if striped else None
    if window is not None:
        part = Start(normal.pressure, last)
        solved = _in_window(window, influence, surfaces, rolling, part, tolerance=tolerance, tell=tell)
        if solved is not None:
            check(solved.normal.pressure)
            return replace(solved, normal_iterations=solved.normal_iterations + normal.iterations)
    rigid = rigid_slip(grid.x, grid.y, grid.dx, rolling.creepages, rolling.spin)
    if rows is not None:
        rigid[0] += rows
    mixing = Anderson(_MEMORY)
    within = tolerance
    aim = max(_FIRST_AIM, within) if striped else within
    iterations, newton, krylov, splitting, change = normal.iterations, 0, 0, 0, 0.0
    for rounds in range(1, _MOST_ROUNDS + 1):
        tell(f"rolling contact, round {rounds}" if coupled else "rolling contact")
        driven = rigid + influence.slip_by_pressure(normal.pressure) / grid.dx if coupled else rigid
        slip = at_rest.slip if last is None else last.slip
        at = replace(at_rest, pressure=normal.pressure, slip=slip)
        slipping = solve_slipping(influence, rolling.law, at, driven, rolling.forces, start=last, tolerance=aim)
        last = slipping.tangential
        newton, krylov = newton + slipping.newton, krylov + slipping.krylov
        splitting += slipping.splitting
        if not coupled or not (last.shear.any() or offset.any()):
            if normal.residual > within:
                normal = press(offset, normal.pressure, within)
                iterations += normal.iterations
                continue
            check(normal.pressure)
            return Coupled(normal, slipping, rounds, change, iterations, newton, krylov, splitting)
        # The same pressure with the gap and the approach that this very shear makes.
        opening = opened(last.shear, normal.pressure)
        fitting = normal.under(gap + opening, opening - offset, loaded=rolling.normal_load is not None)
        settled = rounds > 1 and change <= tolerance and aim <= within
        if settled and fitting.residual <= tolerance:
            check(normal.pressure)
            return Coupled(fitting, slipping, rounds, change, iterations, newton, krylov, splitting)
        if settled:
            within *= _TIGHTER
        if rounds == _SLOW:
            mixing.memory = _LONG_MEMORY
        before = normal.pressure
        offset = mixing.next(offset, opening)
        normal = press(offset, before, within)
        iterations += normal.iterations
        change = float(np.linalg.norm(normal.pressure - before) / np.linalg.norm(before))
        aim = max(within, _AIM * change) if striped else within
        if rounds > 1 and change <= _SAME and fitting.residual <= tolerance:
            # The shear that was found under the same pressure is that of this one.
            check(before)
            return Coupled(fitting, slipping, rounds, change, iterations, newton, krylov, splitting)
    raise ConvergenceError(
        f"normal and tangential contact did not settle in {_MOST_ROUNDS} rounds: the pressure still changes by "
        f"{change:.2e}, above the tolerance of {tolerance:.2e} (Dundurs' β = {influence.dundurs:.3f}); "
        "lower the friction or raise the tolerance",
        change,
    )


def _in_window(
    window: Window,
    influence: Influence,
    surfaces: Surfaces,
    rolling: Rolling,
    start: Start,
    *,
    tolerance: float,
    tell: Progress,
) -> Coupled | None:
    """The solution on the whole grid by that in a window; None where the contact does not stay in it."""
    grid, rows = surfaces.grid, surfaces.rows
    part = Surfaces(window.grid, window.of_field(surfaces.gap), None if rows is None else rows[window.rows])
    near = Start(
        window.of_field(start.pressure),
        None if start.tangential is None else window.tangential_of(start.tangential),
    )
    try:
        solved = solve_coupled(
            window.influence, part, rolling, check=window.check, start=near, tolerance=tolerance, tell=tell
        )
    except GrownError:
        return None
    slipping = window.slipping_on_grid(solved.slipping)
    normal = window.normal_on_grid(influence, surfaces.gap, solved.normal, slipping.tangential.shear)
    if normal.residual > tolerance:
        return None
    if slipping.temperature is not None:
        slip = slipping.tangential.slip
        everywhere = Interface(normal.pressure, slip, grid.x, grid.y, grid.dx, rolling.speed)
        slipping = replace(slipping, temperature=rolling.law.temperature(everywhere))
    return replace(solved, normal=normal, slipping=slipping)


def _at_rest(pressure: Array, grid: Grid, rolling: Rolling) -> Interface:
    """The interface before it slips, once it is sure that friction there can carry the forces."""
    load = float(pressure.sum()) * grid.cell_area
    if load <= 0:
        raise InputError(
            f"an approach of {(rolling.approach or 0) * 1e3:g} mm does not bring tire and road into contact; raise it"
        )
    at_rest = Interface(pressure, np.zeros((2, *grid.shape)), grid.x, grid.y, grid.dx, rolling.speed)
    rolling.check_friction_limit(load, float(strongest(rolling.law, at_rest).sum()) * grid.cell_area)
    return at_rest
