"""The first crack from the surface: which way it runs, under which load and season, and what opens it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from treadload.contact.maneuver import STRAIGHT, Maneuver
from treadload.damage.criterion import Criterion
from treadload.damage.cycles import harm_of_each, rainflow, turning_points
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.life import Life
from treadload.damage.miner import wander_of
from treadload.damage.quantity import part, tension
from treadload.damage.traffic import AxleClass, Wander
from treadload.damage.words import CAUSES, DIRECTIONS
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array, BoolArray
from treadload.life.basin import Basin
from treadload.life.contacts import Counter
from treadload.life.design import Design
from treadload.life.followed import Evaluated, Followed, power_of
from treadload.life.lines import Lines
from treadload.life.passage import Passing, near_and_far
from treadload.life.passages import Passages
from treadload.life.seasons import warmed
from treadload.life.threads import pool_of
from treadload.life.wheels import Wheels, states_of, wheels_of
from treadload.pavement import Pavement

# The strain across a crack of each direction.
_ACROSS = {"transverse": "strain_xx", "longitudinal": "strain_yy"}
Variables = dict[str, tuple[tuple[str, ...], Array]]


def first_cracks(design: Design, life: Life, passages: Passages, workers: int | None = None) -> Variables:
    """The first crack of every criterion that reads a tensile strain at the top of the road.

    Solved again for the class and season that do most of its damage. Both directions are evaluated side by side, each
    by the normal strain across it with the law of the criterion: load repetitions of that class in that season to a
    crack, crack_repetitions (criterion, direction), inf for never, where it starts, crack_place, m, and the largest
    strain across it, crack_strain. cause_share (criterion, cause): of the damage that these wheels do at the worst
    place of the life, after wander, what their longitudinal force adds over the same wheels rolling freely, and of
    the rest what is evaluated further than `BEYOND` from every footprint, which is hogging, and nearer, which is the
    tread's; they add up to 1. NaN for other criteria and where no damage is done.
    workers: threads; all cores if left out. A contact is solved where these wheels brake or drive.
    """
    count = len(life.criteria)
    fields = {name: np.full((count, len(DIRECTIONS)), np.nan) for name in _REPETITIONS}
    shares = np.full((count, len(CAUSES)), np.nan)
    cache: dict[tuple[object, ...], SolvedPassage | None] = {}
    for k, criterion in enumerate(life.criteria):
        damage = life.dataset["damage_share"].to_numpy()[k]
        if not opens_at_surface(criterion, design.road) or not damage.max() > 0:
            continue
        row, season = (int(number) for number in np.unravel_index(int(damage.argmax()), damage.shape))
        law = life.class_laws[k][row][season]
        wander, worst = wander_of(life.class_laws[k][0][0], life.traffic), float(life.dataset["worst_y"][k])
        solve = partial(_solved, design, k, row, season, passages, cache)
        braked = solve()
        if braked is None:
            continue
        for number, direction in enumerate(DIRECTIONS):
            whole, _, largest = braked.harm(strain_across(direction), law)
            spread = wander.spread(whole, braked.spacing)
            margin = (len(spread) - len(whole)) // 2
            most = int(spread.argmax())
            fields["crack_repetitions"][k, number] = 1 / spread[most] if spread[most] > 0 else np.inf
            fields["crack_place"][k, number] = braked.y[0] + braked.spacing * (most - margin)
            fields["crack_strain"][k, number] = largest
        shares[k] = _causes(solve, design.traffic.classes[row], braked, law, wander, worst)
    return {name: (("criterion", "direction"), values) for name, values in fields.items()} | {
        "cause_share": (("criterion", "cause"), shares)
    }


_REPETITIONS = ("crack_repetitions", "crack_place", "crack_strain")


@dataclass(frozen=True, eq=False)
class SolvedPassage:
    """A passage of a class in a season with what its first criterion evaluates near and far."""

    task: Passing
    lines: Lines
    basin: Basin
    fields: tuple[xr.Dataset, xr.Dataset, xr.Dataset]

    @classmethod
    def of(cls, task: Passing) -> SolvedPassage | None:
        """Of a class on a road; None where the criterion has no basin."""
        read = near_and_far(task, 0)
        return None if read is None else cls(task, *read)

    @property
    def y(self) -> Array:
        """Across travel, evenly spaced, m."""
        return self.task.y

    @property
    def spacing(self) -> float:
        """Of y, m."""
        return float(self.y[1] - self.y[0])

    @property
    def criterion(self) -> Criterion:
        """As these wheels roll by."""
        return self.task.criterion(0)

    def followed(self, evaluated: Evaluated) -> Followed:
        """Values of a field and its tension along the lines."""
        power = power_of(self.criterion)
        over = self.criterion.mean_over
        return Followed.of(evaluated, self.fields, self.task.wheels, self.lines, self.basin, over, power)

    def harm(self, evaluated: Evaluated, law: FatigueLaw) -> tuple[Array, Array, float]:
        """On y (ny,): damage of the passage and its share with a peak far from the footprints; the largest cycle."""
        followed = self.followed(evaluated)
        order = np.argsort(followed.x, kind="stable")
        core = _cycles(followed.core[:, order], followed.far[order], law)
        away = _cycles(followed.away, np.ones(followed.away.shape[1], dtype=bool), law)
        whole, far = (np.concatenate(pair)[self.lines.ordered] for pair in zip(core, away, strict=True))
        lines = self.lines.evaluated
        largest = float(max(followed.core.max(), followed.away.max(initial=0.0)))
        return np.asarray(np.interp(self.y, lines, whole)), np.asarray(np.interp(self.y, lines, far)), largest


def _cycles(read: Array, far: BoolArray, law: FatigueLaw) -> tuple[Array, Array]:
    """Damage (n,) of lines of values (n, nx), and of it that of cycles with their peak in far columns (nx,)."""
    tops, bottoms = rainflow(*turning_points(read))
    harm = harm_of_each(law, tops, bottoms)
    # A cycle's peak is a value of the line: which one tells the column.
    away = (tops[:, :, None] == read[:, None, far]).any(axis=-1)
    return harm.sum(axis=1), np.where(away, harm, 0.0).sum(axis=1)


def opens_at_surface(criterion: Criterion, road: Pavement) -> bool:
    """Whether a criterion reads a tensile strain at the top of a road."""
    return criterion.place == "top" and criterion.number(road) == 0 and criterion.quantity.extends


def strain_across(direction: str) -> Evaluated:
    """The normal strain across a crack of a direction, and the tension without which none opens, Pa."""

    def evaluated(data: xr.Dataset) -> tuple[Array, Array | None]:
        return part(data, _ACROSS[direction]), tension(data)

    return evaluated


def _solved(
    design: Design,
    number: int,
    row: int,
    season: int,
    passages: Passages,
    cache: dict[tuple[object, ...], SolvedPassage | None],
    *,
    freely: bool = False,
) -> SolvedPassage | None:
    """A passage of a class by number in a season, rolling freely or as it does; None where it has no basin."""
    climate, axle_class = design.climate.seasons[season], design.traffic.classes[row]
    criterion = design.criteria[number]
    key = (row, season, freely, criterion.needs, criterion.depths(design.road), criterion.mean_over)
    if (same := cache.get(key)) is not None:
        warm = warmed(design.road, (criterion,), climate, axle_class)
        return replace(same, task=replace(same.task, warm=warm))
    y = passages.readings["y"].to_numpy()
    warm = warmed(design.road, (criterion,), climate, axle_class)
    wheels = _free(design, axle_class, warm.road, y) if freely else passages.wheels[row]
    task = Passing(wheels, warm, y, passages.readings.sizes["turn"], passages.reach)
    cache[key] = SolvedPassage.of(task)
    return cache[key]


def _free(design: Design, axle_class: AxleClass, road: Pavement, y: Array) -> Wheels:
    """The wheels of a class on y, m, without a longitudinal force."""
    rolling = replace(axle_class, maneuver=rolling_freely(axle_class.maneuver))
    states = states_of(rolling, design.tire)
    with pool_of(1) as pool:
        design.contacts.solve(states, road, pool, Counter(len(states), None))
    return wheels_of([design.contacts.of(state) for state in states], rolling, y)


def rolling_freely(maneuver: Maneuver) -> Maneuver:
    """The maneuver without braking and driving, with its side force and turn."""
    free = replace(maneuver, tractive=0.0, locked=False)
    # Most traffic has such a class: its contact is solved already.
    return STRAIGHT if replace(free, name=STRAIGHT.name) == STRAIGHT else free


def _causes(
    solve: Callable[..., SolvedPassage | None],
    axle_class: AxleClass,
    braked: SolvedPassage,
    law: FatigueLaw,
    wander: Wander,
    worst: float,
) -> Array:
    """Shares of hogging, tread and longitudinal force in the damage at a place, m, which add up to 1; NaN of none."""
    whole, far = _at_place(braked, law, wander, worst)
    if not whole > 0:
        return np.full(len(CAUSES), np.nan)
    force = 0.0
    if axle_class.maneuver.tractive or axle_class.maneuver.locked:
        free = solve(freely=True)
        assert free is not None
        alone, alone_far = _at_place(free, law, wander, worst)
        if alone < whole:
            force = 1 - alone / whole
            whole, far = (alone, alone_far) if alone > 0 else (1.0, 0.0)
    hogging = (1 - force) * far / whole
    return np.array([hogging, 1 - force - hogging, force])


def _at_place(solved: SolvedPassage, law: FatigueLaw, wander: Wander, place: float) -> tuple[float, float]:
    """Damage of a passage after wander at a place, m, and of it what is evaluated far from the footprints."""
    reach = (len(wander.weights(solved.spacing)) - 1) // 2
    column = round((place - float(solved.y[0])) / solved.spacing) + reach
    whole, far, _ = solved.harm(solved.criterion.read_uncut, law)
    spread = partial(wander.spread_at, spacing=solved.spacing, column=column)
    return float(spread(whole)), float(spread(far))
