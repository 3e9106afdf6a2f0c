"""Lives over the thickness of a layer: the thickness that lasts exactly, and the step that it is rounded up to."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy

from treadload.damage.answer import RUT
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.life import Life
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.life.design import Design
from treadload.life.halving import as_solved
from treadload.life.reliability import life_reliability
from treadload.life.solve import solve_life

# From one thickness to the next in search of two with the root between them.
_WIDER = 1.25
# A criterion that never fails counts with so many years: a root needs a number.
_LONG = 1e9
# How often years at a risk are set right at the thickness that was found with those of the one before.
_ROUNDS = 3
# How many steps beside the root are tried for a thickness whose own years at the risk are enough.
_STEPS = 4


@dataclass(eq=False)
class ThicknessSearch:
    """Lives by thickness, each solved once. years_by_thickness: by criterion, at the risk, by thickness."""

    design: Design
    number: int
    target: float
    risk: float | None
    running: dict[str, Any]
    years_by_thickness: dict[float, Array] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=lambda: {"lives": 0, "contacts": 0, "responses": 0})
    _lives: dict[float, Life] = field(default_factory=dict)
    # ln of the passes at the risk over those of the life, by criterion.
    _shift: Array | None = None

    @property
    def ruts(self) -> bool:
        """True where a rut ends the road too."""
        return self.design.rutting is not None and self.design.rutting.limit is not None

    @property
    def scatters(self) -> bool:
        """True where years at the risk come from a scatter."""
        return self.risk is not None and self.design.scatter is not None

    def names(self, life: Life) -> list[str]:
        """What ends the road, in the order of the years."""
        return [*(criterion.name for criterion in life.criteria), *([RUT] if self.ruts else [])]

    def life(self, thickness: float) -> Life:
        """The life of the road with a thickness, at the risk where laws have one."""
        if thickness not in self._lives:
            design = self.design.with_thickness(self.number, thickness)
            if self.risk is not None and not self.scatters:
                design = replace(design, criteria=[_at(criterion, self.risk) for criterion in design.criteria])
            life = solve_life(design, **self.running)
            # Years by thickness must not step where another thickness has other cells.
            self.design = as_solved(self.design, life)
            self._lives[thickness] = life
            self.counts["lives"] += 1
            for name in ("contacts", "responses"):
                self.counts[name] += int(life.stats[name])
        return self._lives[thickness]

    def at_risk(self, thickness: float, *, fresh: bool = False) -> Array:
        """Years of all criteria. fresh: with a scatter, solve what it does at this very thickness."""
        life = self.life(thickness)
        rut = [life.rut_years] if self.ruts else []
        if not self.scatters:
            self.years_by_thickness[thickness] = np.append(life.dataset["life_years"].to_numpy(), rut)
            return self.years_by_thickness[thickness]
        if fresh or self._shift is None:
            self._shift = self._shifted(thickness, life)
        passes = life.dataset["life_passes"].to_numpy() * np.exp(self._shift)
        self.years_by_thickness[thickness] = np.array(
            [*(self.design.traffic.years_to(float(count)) for count in passes), *rut]
        )
        return self.years_by_thickness[thickness]

    def shortest(self, thickness: float) -> float:
        """Years until the first criterion fails."""
        if thickness not in self.years_by_thickness:
            self.at_risk(thickness)
        return float(min(self.years_by_thickness[thickness].min(), _LONG))

    def excess(self, thickness: float) -> float:
        """Logarithm of the life over the years that are asked for."""
        return math.log(max(float(min(self.at_risk(thickness).min(), _LONG)), 1e-9) / self.target)

    def root(self, low: float, high: float, fine: float, name: str) -> float:
        """The thickness that lasts exactly, low where that lasts already. Raises InputError where none does."""
        root = low
        for _ in range(_ROUNDS if self.scatters else 1):
            ends = self._bracket(low, high, name)
            if ends is None:
                return low
            before, root = root, float(scipy.optimize.brentq(self.excess, *ends, xtol=fine, rtol=1e-6))
            if not self.scatters or abs(root - before) < 10 * fine:
                break
            self.at_risk(root, fresh=True)
        return root

    def rounded(self, exact: float, step: float, between: tuple[float, float], name: str) -> tuple[float, float]:
        """The root and the thickness that it is rounded up to, whose life is solved afresh, as that of a step less.

        With a scatter the root was found with the years at the risk of a thickness nearby: where those of the rounded
        thickness itself fall short, the next step up is taken, and the root lies between the two.
        Raises InputError where the steps above fall short too.
        """
        (low, high), enough = between, self.target * (1 - 1e-9)
        rounded = start = math.ceil(exact / step - 1e-9) * step
        settled: dict[float, float] = {}
        for _ in range(_STEPS):
            thin = rounded - step
            for thickness in (thin, rounded):
                if thickness > 0 and thickness not in settled:
                    self.at_risk(thickness, fresh=True)
                    settled[thickness] = self.shortest(thickness)
            if settled[rounded] < enough and rounded + step <= high * (1 + 1e-9):
                rounded += step
            elif exact > low and thin >= low and settled[rounded] >= enough and settled[thin] >= enough:
                rounded = thin
            else:
                break
        if settled.get(rounded, 0.0) < enough:
            raise InputError(
                f"{name}: {exact * 1e3:.1f} mm lasts {self.target:g} years, but {start * 1e3:g} mm, to which it is "
                f"rounded up, {settled[start]:.3g}: thickness does not lengthen this life steadily; solve the life "
                "from low to high, as `treadload sweep` does"
            )
        thin = rounded - step
        if not thin < exact <= rounded:
            short, long = (math.log(settled[size] / self.target) for size in (thin, rounded))
            exact = min(thin + step * short / (short - long), rounded) if short < 0 else thin
        return exact, rounded

    def _bracket(self, low: float, high: float, name: str) -> tuple[float, float] | None:
        """Two thicknesses with the root between them, near that of the road; None where low lasts already."""
        start_thickness = self.design.road.layers[self.number].thickness
        assert start_thickness is not None
        thin = thick = min(max(start_thickness, low), high)
        while self.excess(thick) < 0:
            if thick == high:
                self._refuse(low, high, name)
            thin, thick = thick, min(thick * _WIDER, high)
        while thin == thick or self.excess(thin) >= 0:
            if thin == low:
                return None
            thin, thick = max(thin / _WIDER, low), thin
        return thin, thick

    def _shifted(self, thickness: float, life: Life) -> Array:
        assert self.risk is not None
        design = self.design.with_thickness(self.number, thickness)
        shifted = life_reliability(design, life, risks=[self.risk], held_back=0, **self.running)
        self.counts["responses"] += int(shifted.stats["responses"])
        shift = np.zeros(len(life.criteria))
        names = [str(name) for name in shifted.dataset["criterion"].to_numpy()]
        for number, criterion in enumerate(life.criteria):
            if criterion.name in names:
                passes = self.design.traffic.passes(min(shifted.years(self.risk, criterion.name), _LONG))
                shift[number] = math.log(passes / float(life.dataset["life_passes"][number]))
        return shift

    def _refuse(self, low: float, high: float, name: str) -> None:
        lives = {thickness: self.at_risk(thickness) for thickness in (low, high)}
        best = max(lives, key=lambda thickness: float(lives[thickness].min()))
        number = int(lives[best].argmin())
        criterion = self.names(self.life(best))[number]
        gained = float(lives[high][number] / lives[low][number])
        helps = "" if gained > 1.05 else f", which a thicker {name} does not help"
        raise InputError(
            f"no thickness of {name} from {low * 1e3:g} to {high * 1e3:g} mm lasts {self.target:g} years: the "
            f"longest life is {float(lives[best].min()):.3g} years, at {best * 1e3:g} mm, by {criterion}{helps}; "
            "give a larger high, another layer, or a better mix"
        )


def has_risk(law: FatigueLaw) -> bool:
    """Whether a law takes a probability of failure."""
    return hasattr(law, "risk") and hasattr(law, "risk_factor")


def _at(criterion: Criterion, risk: float) -> Criterion:
    """The criterion with this risk in its law, where that has one."""
    law = criterion.law
    if not has_risk(criterion.law_at(15.0)):
        return criterion
    if callable(law):
        of_warmth = law
        return replace(criterion, law=lambda temperature: replace(of_warmth(temperature), risk=risk))  # type: ignore[type-var]
    return replace(criterion, law=replace(law, risk=risk))  # type: ignore[type-var]
