"""Stress intensity at the tip of a crack, cycles of it, and how much the crack grows by a passage of the traffic."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from concurrent.futures import Executor

import numpy as np

from treadload.damage.growth.intensity import Crossing, Way, crack_paths, faces_along, intensity_ranges, modes
from treadload.damage.growth.solution import MODES
from treadload.kernels.arrays import Array
from treadload.kernels.fracture.crack import CrackFaces
from treadload.kernels.fracture.dislocations import Section
from treadload.life.climate import warmth_of
from treadload.life.crack import Crack
from treadload.life.crack_stress import CrackStress
from treadload.life.crossings import between_rows, over_seasons


def path_of(crack: Crack, stress: CrackStress) -> Way:
    """The path of the crack: straight, or kinked as it is at the place where the criterion's damage is largest."""
    growth, life, lengths = crack.growth, crack.life, crack.lengths
    if growth.path != "kinked":
        slope = 0.0 if isinstance(growth.path, str) else math.tan(growth.path)
        return Way(np.array([0.0, lengths[-1]]), np.array([0.0, slope * lengths[-1]]))
    worst = float(life.dataset["worst_y"][crack.number])
    shares = life.dataset["damage_share"].to_numpy()[crack.number]
    row, season = np.unravel_index(int(shares.argmax()), shares.shape)
    road = stress.warm.where[int(season)]
    if road not in stress.nodes:
        warmth = warmth_of(life.climate.seasons, [warm.road for warm in stress.warm.distinct])
        assert warmth is not None
        places = warmth.reshape(len(warmth), -1)
        # The solved road that is nearest in warmth.
        road = min(stress.nodes, key=lambda node: float(np.linalg.norm(places[node] - places[road])))
    chosen = stress.crossings[int(row), road]
    place = int(np.abs(chosen.y - worst).argmin())
    return crack_paths([chosen], np.ones(1), place, lengths, crack.trace, growth.friction)


def ranges_of_crossings(
    crack: Crack, stress: CrackStress, way: Way, pool: Executor
) -> tuple[dict[tuple[int, int], Array], int]:
    """Ranges of stress intensity, Pa √m, of every class on every solved road; how many states of faces are jammed.

    Raises ConvergenceError of faces that do not settle.
    """
    growth, lengths = crack.growth, crack.lengths.tolist()

    # Classes share the roads of a season, unless they read moduli at frequencies of their own.
    @functools.cache
    def faces_at(section: Section, length: float) -> CrackFaces:
        return faces_along(section, way.until(length), length, upwards=crack.upwards, points=growth.points)

    def ranges_of(crossing: Crossing) -> tuple[Array, int]:
        stack, jammed = [], 0
        for length in lengths:
            history, stuck = modes(crossing, faces_at(crossing.section, length), crack.trace, growth.friction)
            stack.append(intensity_ranges(history, crossing.poisson, crossing.axles))
            jammed += stuck
        return np.stack(stack), jammed

    solved = list(pool.map(ranges_of, stress.crossings.values()))
    ranges = {task: of_task for task, (of_task, _) in zip(stress.crossings, solved, strict=True)}
    return ranges, sum(stuck for _, stuck in solved)


def growth_rates(
    crack: Crack, stress: CrackStress, way: Way, ranges: Mapping[tuple[int, int], Array]
) -> tuple[Array, Array]:
    """Growth of the depth (k, ny), m per passage of the whole traffic, at the lengths of the crack and stress.y.

    Without wander. ranges: of every class on every solved road. Returns as well the largest ranges in any season,
    Pa √m (class, k, mode, ny).
    """
    classes, seasons, lengths = crack.life.traffic.classes, crack.life.climate.seasons, crack.lengths
    y, nodes, warm = stress.y, stress.nodes, stress.warm
    _, slopes = way.at(lengths)
    rate = np.zeros((len(lengths), len(y)))
    largest = np.zeros((len(classes), len(lengths), len(MODES), len(y)))
    for row, axles in enumerate(classes):
        at_nodes = [between_rows(stress.crossings[row, node].y, y, ranges[row, node]) for node in nodes]
        stack = np.stack(at_nodes)
        largest[row] = stack.max(axis=(0, -1)).transpose(0, 2, 1)
        roads = warm.by_class[row]
        every_road = over_seasons(warmth_of(seasons, [road.road for road in roads]), nodes, stack)
        for season, road in zip(seasons, warm.where, strict=True):
            here, share = every_road[road], axles.share * season.share
            for k in range(len(lengths)):
                law = crack.law_at(roads[road], float(lengths[k]))
                # Along a path that leans a crack must grow by more than its depth does.
                rate[k] += share * law.growth(here[k, :, 3]).sum(axis=-1) / math.hypot(1.0, float(slopes[k]))
    return rate, largest
