"""Stress of the road without a crack, along the way of a crack, as every class passes in the solved seasons."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from treadload.damage.growth.intensity import Crossing, section_of
from treadload.kernels.arrays import Array
from treadload.life.climate import warmth_of
from treadload.life.contacts import Counter, Progress
from treadload.life.crack import Crack
from treadload.life.crossings import CrackLines, distances_to, nodes_of_climate, stresses
from treadload.life.design import Design
from treadload.life.seasons import Warmed
from treadload.life.wheels import Wheels, states_of, wheels_of
from treadload.response.basin import basin_reach


@dataclass(frozen=True, eq=False)
class CrackStress:
    """What the wheels of all classes do to the road where the crack will run.

    warm: the roads of all seasons. wheels: of each class. y: places across, m, evenly apart. reach: of the basin
    around the wheels, m. nodes: numbers of the roads that are solved. distances: from the mouth, m, where stress is
    read. crossings: by numbers of class and road, in the order of both. contacts: how many had to be solved.
    """

    warm: Warmed
    wheels: Sequence[Wheels]
    y: Array
    reach: float
    nodes: list[int]
    distances: Array
    crossings: Mapping[tuple[int, int], Crossing]
    contacts: int

    @classmethod
    def solve(
        cls, crack: Crack, design: Design, warm: Warmed, pool: Executor, progress: Progress | None = None
    ) -> CrackStress:
        """Every class passes once in each of the seasons that are solved. Raises ConvergenceError of a contact."""
        classes, ends, upwards = crack.life.traffic.classes, crack.ends, crack.upwards
        states = [state for row in classes for state in states_of(row, design.tire)]
        touched = len(design.contacts.missing(states))
        warmth = warmth_of(crack.life.climate.seasons, [road.road for road in warm.distinct])
        nodes = nodes_of_climate(warmth, len(warm.distinct))
        count = Counter(touched + len(classes) * len(nodes), progress)
        design.contacts.solve(states, warm.distinct[0].road, pool, count)
        by_class = [[design.contacts.of(state) for state in states_of(row, design.tire)] for row in classes]
        reach = basin_reach(road.road for roads in warm.by_class for road in roads)
        y = crack.life.readings["y"].to_numpy()
        wheels = [wheels_of(contacts, row, y) for contacts, row in zip(by_class, classes, strict=True)]
        interfaces = sorted(abs(ends.mouth - place) for place in _inside(warm, ends.top, ends.bottom))
        distances = distances_to(crack.thickness, interfaces, upwards=upwards)
        depths = ends.mouth - distances[::-1] if upwards else distances

        def cross(row: int) -> list[Crossing]:
            lines = CrackLines.of(wheels[row], y, reach)
            roads, crossings = [warm.by_class[row][node] for node in nodes], []
            for node, stress in zip(nodes, stresses(wheels[row], roads, depths, lines), strict=True):
                section, poisson = section_of(warm.by_class[row][node].road, ends.top, ends.bottom)
                from_mouth = stress[:, ::-1] if upwards else stress
                axles = len(wheels[row].x)
                crossing = Crossing(from_mouth, distances, lines.y, lines.x, section, upwards, poisson, axles)
                crossings.append(count.after(crossing, "response"))
            return crossings

        tasks = [(row, node) for row in range(len(classes)) for node in nodes]
        crossings = [crossing for several in pool.map(cross, range(len(classes))) for crossing in several]
        by_task = dict(zip(tasks, crossings, strict=True))
        return cls(warm, wheels, y, reach, nodes, distances, by_task, touched)

    @property
    def spacing(self) -> float:
        """Of places across, m."""
        return float(self.y[1] - self.y[0])

    def states(self, lengths: int) -> int:
        """How many states of stress are taken to the tip of a crack of so many lengths."""
        return lengths * sum(int(crossing.stress[0, 0].size) for crossing in self.crossings.values())


def _inside(warm: Warmed, top: float, bottom: float) -> list[float]:
    """Depths of the interfaces between two depths, m, in any season: of layers, and of a course's parts."""
    places = {round(float(z), 6) for road in warm.distinct for z in road.road.interfaces}
    return sorted(z for z in places if top + 1e-4 < z < bottom - 1e-4)
