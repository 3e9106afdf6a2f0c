"""Direct solves of the damage at points of its inputs, and what they find beyond a surface through few of them."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from treadload.damage.life import Life
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.reliability.inputs import Input, question_at
from treadload.life.reliability.propagation import Quadratic, first_order
from treadload.life.variants import Solver, most

# Share of the damage whose classes and seasons are solved where a surface is checked: what is left moves the years by
# less than the draws do.
WHOLE = 0.95
# Risk whose likeliest point, and its opposite, correct a surface: the outermost risks are asked for near it.
_OUTER = 0.05
# Draws among which those at a quantile are looked for, and the part of them that counts as being there.
_DRAWS, _WINDOW = 20_000, 0.01
_TINY = 1e-12


@dataclass(eq=False)
class Direct:
    """Solves damages of a life with its inputs changed, and counts. contacts, responses, roads: solved so far."""

    design: Design
    life: Life
    inputs: Sequence[Input]
    pool: ThreadPoolExecutor
    progress: Progress | None
    contacts: int = 0
    responses: int = 0
    roads: int = 0

    def logarithms(self, number: int, coverage: float, points: Array) -> Array:
        """Ln of the damage of a year (n,) of a criterion, by its number, at points (n, input) in deviations.

        coverage: share of the damage whose classes and seasons are solved. Raises InputError where a point does none.
        """
        criterion, life = self.life.criteria[number], self.life
        pairs, _ = most(life.dataset["damage_share"].to_numpy()[number], coverage)
        solver = Solver(criterion, pairs, self.design.contacts, self.progress)
        questions = [
            question_at(self.inputs, self.design.road, life.traffic, life.climate, point) for point in points
        ]
        damage = np.array(solver.damages(questions, self.pool))
        if not (damage > 0).all():
            raise InputError(
                f"{criterion.name}: within the scatter of the inputs it does no damage at all, so that no "
                "surface runs through its logarithm; scatter less, or leave it out by criteria="
            )
        self.contacts += solver.solved
        self.responses += solver.responses
        self.roads += len(points)
        logarithms: Array = np.log(damage)
        return logarithms

    def corrected(self, number: int, surface: Quadratic) -> tuple[Quadratic, float]:
        """A surface of ln D with what the whole damage adds to it, and ln D of that in the middle.

        surface: over the inputs first, then what is not solved. Its likeliest point at a risk of 5 % and the opposite
        one are solved with nearly all classes and seasons; between them and the middle the difference is a quadratic.
        """
        count = len(self.inputs)
        direction = first_order(surface, _OUTER)[1][:count]
        length = float(np.linalg.norm(direction))
        unit = direction / max(length, _TINY)
        # As far as the risk lies from the middle; 95 % of the draws of each input lie within.
        far = 1.645 * length
        points = np.stack([0 * unit, -far * unit, far * unit])
        middle, *ends = self.logarithms(number, WHOLE, points)
        if length < _TINY:
            return surface, float(middle)
        less, more = np.array(ends) - middle - _beyond_middle(surface, points[1:])
        gradient, curvature = surface.gradient.copy(), surface.curvature.copy()
        gradient[:count] += 0.5 * (more - less) / far * unit
        curvature[:count, :count] += (more + less) / far**2 * np.outer(unit, unit)
        return replace(surface, gradient=gradient, curvature=curvature), float(middle)

    def held_back(
        self, number: int, surface: Quadratic, middle: float, risks: Sequence[float], per_risk: int, seed: int
    ) -> Array:
        """What ln D at each risk (n,) may err by: direct solves of draws that a surface holds for those at the risk.

        middle: ln D there, solved with nearly all classes and seasons. per_risk: how many, at least 2. Twice the
        standard error of their mean difference counts with it.
        """
        random = np.random.default_rng([seed, number])
        z = random.standard_normal((_DRAWS, len(surface.gradient)))
        order = np.argsort(surface(z))
        chosen = []
        for risk in risks:
            half = max(int(0.5 * _WINDOW * _DRAWS), 2 * per_risk)
            rank = int(np.clip((1 - risk) * _DRAWS, half, _DRAWS - half))
            chosen.append(z[random.choice(order[rank - half : rank + half], per_risk, replace=False)])
        points = np.concatenate(chosen)[:, : len(self.inputs)]
        beyond = self.logarithms(number, WHOLE, points) - middle - _beyond_middle(surface, points)
        by_risk = beyond.reshape(len(risks), per_risk)
        error: Array = np.abs(by_risk.mean(axis=1)) + 2 * by_risk.std(axis=1, ddof=1) / np.sqrt(per_risk)
        return error


def _beyond_middle(surface: Quadratic, points: Array) -> Array:
    """How much ln D of a surface at points (n, input) is above that in the middle; what is not solved stays there."""
    z = np.pad(points, [(0, 0), (0, len(surface.gradient) - points.shape[1])])
    above: Array = surface(z) - surface.constant
    return above
