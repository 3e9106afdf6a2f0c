"""A history of loading, shifting, turning and rolling, step by step: what sticks remembers where it stuck.

Over a step a particle that now is at x came from x + travel, and the two surfaces slipped there by

    s = w + u_new(x) - u_old(x + travel)

with w the rigid displacement of body 1 along body 2 over the step and u = u1 - u2 (Kalker 1990, section 1.5).
Steady rolling is where a march of equal steps comes to rest; with steps of one cell it rests exactly in the
solution of `contact.solvers.rolling`. Shear q acts on body 1, as there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from treadload.contact.bodies.ahead import Ahead
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.contact.solvers.tangential import Axes, Forces, TangentialSolution, solve_tangential
from treadload.errors import ConvergenceError, InputError
from treadload.kernels.arrays import Array
from treadload.kernels.mixing import Anderson

_MOST_ROUNDS = 150
# Rounds that are mixed: from so many rounds on, all that are of use.
_MEMORY, _SLOW, _LONG_MEMORY = 6, 20, 20
# Pressing aims lower than the whole step, and both lower still where what they leave keeps them apart.
_SHARE, _TIGHTER = 0.5, 0.3
# Kernels of so many different travels are kept: equal steps need two.
_KEPT_KERNELS = 4
# Steps of more cells than this leave little of the last shear to go by.
_FAR = 2.5


@dataclass(frozen=True, eq=False)
class Stage:
    """One step of a history, and what is known at its end.

    rigid: known rigid displacement of body 1 along body 2 over the step (2, ny, nx) or (2, 1, 1), m.
    forces: on body 1 (Q_x, Q_y), N; None where the rigid displacement is known (and in `rigid`).
    friction: μ, a number or (ny, nx), or a function from pressure (ny, nx), Pa, to the bound μp of shear.
    travel: distance rolled in the step, m, ≥ 0; zero: no rolling.
    axes: of the friction ellipse, as in `contact.solvers.tangential`.
    pressure: (ny, nx), Pa, where it is known; or load, N, or approach, m, under which it is found.
    gap: (ny, nx) before loading, m, where it is not that of the history.
    """

    rigid: Array
    forces: Forces
    friction: float | Array | Callable[[Array], Array]
    travel: float = 0.0
    axes: Axes = (1.0, 1.0)
    pressure: Array | None = None
    load: float | None = None
    approach: float | None = None
    gap: Array | None = None

    def bound(self, pressure: Array) -> Array:
        """Bound of shear (ny, nx), Pa, under a pressure (ny, nx), Pa."""
        return self.friction(pressure) if callable(self.friction) else self.friction * pressure

    def __post_init__(self) -> None:
        if not (np.isfinite(self.travel) and self.travel >= 0):
            raise InputError(
                f"a step travels forward by a finite distance, got {self.travel} m; turn the x axis round"
            )
        if not np.isfinite(self.rigid).all():
            raise InputError("the rigid displacement of a step must be finite, got NaN or infinity")
        if sum(control is not None for control in (self.pressure, self.load, self.approach)) != 1:
            raise InputError("give one of pressure (Pa), load (N) and approach (m) for a step, and only one")


@dataclass(frozen=True, eq=False)
class State:
    """Where a history stands at the end of a step.

    stage: the step. pressure: (ny, nx), Pa. tangential: shear on body 1, slip over the step, m, and the rigid
    displacement that was not known, m. normal: the normal contact, None where the pressure was given.
    change: of the pressure in the last round of the coupling between pressure and shear, relative.
    """

    stage: Stage
    pressure: Array
    tangential: TangentialSolution
    normal: NormalSolution | None = None
    change: float = 0.0

    @property
    def displaced(self) -> tuple[float, float]:
        """Rigid displacement that the prescribed forces made over the step, m; zero where it was known."""
        return self.tangential.rigid

    def work(self, cell_area: float) -> float:
        """Work of friction over the step, J, with the shear at its end: ≥ 0."""
        return float(-(self.tangential.shear * self.tangential.slip).sum()) * cell_area


@dataclass(frozen=True, eq=False)
class TransientSolution:
    """States at the ends of all steps of a history, or of the last alone.

    rigid: (n, 2) displacements that were not known, m. travel: (n,) of every step, m.
    states: those that were kept.
    """

    rigid: Array
    travel: Array
    states: tuple[State, ...] = field(repr=False)

    @property
    def last(self) -> State:
        """The state at the end."""
        return self.states[-1]

    @property
    def creepages(self) -> Array:
        """(n, 2) creepages that were not known: displacement over travel; NaN where nothing rolled."""
        travel = np.where(self.travel > 0, self.travel, np.nan)
        return self.rigid / travel[:, None]


def roll_transient(
    influence: Influence,
    stages: Iterable[Stage],
    *,
    gap: Array | None = None,
    before: State | None = None,
    keep: str = "all",
    tolerance: float = 1e-6,
    progress: Callable[[int], None] | None = None,
) -> TransientSolution:
    """March through a history of steps of any length.

    stages: the steps, in order. gap: (ny, nx) before loading, m, needed where a load or an approach is given.
    before: the state to go on from; left out, two bodies that have not touched yet.
    keep: "all" states or the "last". progress: called with the number of the step that is done.
    Returns the states at the ends of the steps. Raises InputError, and ConvergenceError with the residual reached.
    Method: Kalker (1990), section 4.2, with the solver of `kernels.complementarity.coulomb`; Panagiotopoulos' loop
    between pressure and shear of dissimilar bodies.
    """
    if keep not in ("all", "last"):
        raise InputError(f'keep must be "all" or "last", got {keep!r}')
    states: list[State] = []
    rigid, travel = [], []
    for number, state in enumerate(march(influence, stages, gap=gap, before=before, tolerance=tolerance), 1):
        rigid.append(state.displaced)
        travel.append(state.stage.travel)
        if keep == "last":
            states.clear()
        states.append(state)
        if progress is not None:
            progress(number)
    if not states:
        raise InputError("a history needs at least one step, got none")
    return TransientSolution(np.array(rigid), np.array(travel), tuple(states))


def march(
    influence: Influence,
    stages: Iterable[Stage],
    *,
    gap: Array | None = None,
    before: State | None = None,
    tolerance: float = 1e-6,
) -> Iterator[State]:
    """The states at the ends of the steps, one after the other; arguments as in `roll_transient`."""
    ahead = lru_cache(maxsize=_KEPT_KERNELS)(lambda distance: Ahead(influence, distance))
    here = Ahead(influence, 0.0)
    earlier: State | None = None
    state = before
    for stage in stages:
        start = _start(influence, stage, state, earlier)
        imposed = np.broadcast_to(stage.rigid, (2, *influence.shape)).copy()
        if state is not None:
            point = here if stage.travel == 0 else ahead(stage.travel)
            imposed -= point(state.tangential.shear, state.pressure)
        if stage.pressure is not None:
            tangential = _shear(influence, here, stage, stage.pressure, imposed, start, tolerance)
            new = State(stage, stage.pressure, tangential)
        else:
            before_loading = gap if stage.gap is None else stage.gap
            if before_loading is None:
                raise InputError("a step with a load or an approach needs the gap (ny, nx) of the two bodies, m")
            new = _press(influence, here, before_loading, stage, state, imposed, start, tolerance)
        earlier, state = state, new
        yield new


def _shear(
    influence: Influence,
    here: Ahead,
    stage: Stage,
    pressure: Array,
    imposed: Array,
    start: TangentialSolution | None,
    tolerance: float,
) -> TangentialSolution:
    """Shear at the end of a step under a pressure; imposed: slip without the displacement that is sought."""
    bound = stage.bound(pressure)
    if not bound.any() and any(stage.forces):
        raise InputError("no cell can carry shear, but a force is prescribed; raise friction or prescribe the slip")
    rigid = imposed + here.by_pressure(pressure)
    return solve_tangential(
        influence, bound, rigid, stage.forces, rolls=False, axes=stage.axes, start=start, tolerance=tolerance
    )


def _start(
    influence: Influence, stage: Stage, state: State | None, earlier: State | None
) -> TangentialSolution | None:
    """What the last two steps predict for the next; None where the solution on half the grid is the better start."""
    if state is None or earlier is None or stage.travel > _FAR * influence.dx:
        return None
    if not (_goes_on(earlier.stage, state.stage) and _goes_on(state.stage, stage)):
        return None
    shear = 2 * state.tangential.shear - earlier.tangential.shear
    along, across = 2 * np.array(state.displaced) - earlier.displaced
    return replace(state.tangential, shear=shear, rigid=(float(along), float(across)))


def _goes_on(stage: Stage, previous: Stage) -> bool:
    """Whether a step does again what the last did."""
    alike = [force is None for force in stage.forces] == [force is None for force in previous.forces]
    return alike and stage.travel == previous.travel and bool((stage.rigid * previous.rigid).sum() >= 0)


def _press(
    influence: Influence,
    here: Ahead,
    gap: Array,
    stage: Stage,
    state: State | None,
    imposed: Array,
    start: TangentialSolution | None,
    tolerance: float,
) -> State:
    """A step under a load or an approach: pressure and shear in turn, until the pressure no longer changes.

    The change in the first round shows how strongly the two are coupled: bodies nearly alike need no second.
    """
    coupled = influence.coupled
    offset: Array = np.zeros(influence.shape)
    if not coupled and state is not None and state.normal is not None and _same_load(state.stage, stage):
        normal = state.normal
    else:
        if coupled and state is not None:
            offset = here.gap(state.tangential.shear)
        normal = _normal(
            influence,
            gap + offset,
            stage,
            state.pressure if state else None,
            (_SHARE if coupled else 1.0) * tolerance,
        )
    mixing = Anderson(_MEMORY)
    within = tolerance
    newton = products = 0
    for rounds in range(1, _MOST_ROUNDS + 1):
        tangential = _shear(influence, here, stage, normal.pressure, imposed, start, within)
        newton, products = newton + tangential.newton, products + tangential.products
        counted = replace(tangential, newton=newton, products=products)
        if not coupled:
            return State(stage, normal.pressure, counted, normal)
        opening = here.gap(tangential.shear)
        fitting = normal.under(gap + opening, opening - offset, loaded=stage.load is not None)
        if rounds == _SLOW:
            mixing.memory = _LONG_MEMORY
        offset = mixing.next(offset, opening)
        before = normal.pressure
        normal = _normal(influence, gap + offset, stage, before, _SHARE * within)
        change = float(np.linalg.norm(normal.pressure - before) / np.linalg.norm(before))
        if max(change, fitting.residual) <= tolerance:
            return State(stage, before, counted, fitting, change)
        if change <= tolerance:
            within *= _TIGHTER
        start = tangential
    raise ConvergenceError(
        f"pressure and shear did not settle in {_MOST_ROUNDS} rounds of a step: the pressure still changes by "
        f"{change:.2e}, above the tolerance of {tolerance:.2e} (Dundurs' β = {influence.dundurs:.3f}); "
        "take smaller steps, lower the friction or raise the tolerance",
        change,
    )


def _normal(influence: Influence, gap: Array, stage: Stage, start: Array | None, tolerance: float) -> NormalSolution:
    if start is not None and not start.any():
        start = None
    return solve_normal(influence, gap, load=stage.load, approach=stage.approach, start=start, tolerance=tolerance)


def _same_load(stage: Stage, previous: Stage) -> bool:
    return stage.load == previous.load and stage.approach == previous.approach and stage.gap is previous.gap
