"""How thick a layer must be for a road to last: by root finding on its life."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.miner import Life
from treadload.damage.rutting import Rutting
from treadload.damage.scatter import Scatter, check_risks
from treadload.damage.traffic import Traffic
from treadload.damage.words import RUT
from treadload.describing import first_line
from treadload.errors import InputError, nearest, positive
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.study.altered import names_of
from treadload.study.contacts import Contacts, Progress
from treadload.study.life import solve_life
from treadload.study.reliability import life_reliability
from treadload.tire import Tire

Criteria = Sequence[Criterion] | Callable[[Pavement], Sequence[Criterion]]

# The root is found to this part of the step that the thickness is rounded to.
_FINE = 0.1
# From one thickness to the next in search of two with the root between them.
_WIDER = 1.25
# A criterion that never fails counts with so many years: a root needs a number.
_LONG = 1e9
# How often years at a risk are set right at the thickness that was found with those of the one before.
_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class ThicknessDesign(BaseResult, group="design"):
    """The thickness of a layer for which a road lasts, and what was tried on the way.

    dataset: exact_thickness and design_thickness, rounded up to a step, m, and lower_bound of the search as an
    attribute, m, which is the thickness where it lasts already; asked_years; trial_thickness (trial),
    rising, and trial_years (trial, criterion), at the risk that was asked for. road: with the rounded thickness.
    life: of that road. layer: its name; step: m. risk: that was asked for, None for that of the laws. stats: how much
    was solved. warnings: sentences for the user.
    """

    holds: ClassVar[Holds] = Holds(
        {
            "exact_thickness design_thickness asked_years": "",
            "trial_thickness": "trial",
            "trial_years": "trial criterion",
        },
        labels={"criterion": "criterion"},
        numbers="lower_bound",
        positive="exact_thickness design_thickness asked_years trial_thickness",
    )

    dataset: xr.Dataset
    road: Pavement
    life: Life
    layer: str
    step: float
    risk: float | None = None
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def thickness(self) -> float:
        """Of the layer, rounded up, m."""
        return float(self.dataset["design_thickness"])

    @property
    def is_at_bound(self) -> bool:
        """True where the lower bound of the search lasts, and a step less does too: a thinner layer may do."""
        data = self.dataset
        bound = float(data.attrs["lower_bound"]) * (1 + 1e-9)
        thinner = data["trial_thickness"].to_numpy() < self.thickness - 1e-9
        lasts = data["trial_years"].to_numpy()[thinner].min(axis=1) >= float(data["asked_years"])
        return float(data["exact_thickness"]) <= bound and bool(lasts.all())

    def years(self, thickness: float) -> float:
        """Years that the road lasts with a thickness that was tried, m. Raises InputError for another."""
        tried = self.dataset["trial_thickness"].to_numpy()
        near = np.flatnonzero(np.abs(tried - thickness) < 1e-9)
        if not len(near):
            raise InputError(f"{thickness * 1e3:g} mm was not tried; {', '.join(f'{t * 1e3:g}' for t in tried)} were")
        return float(self.dataset["trial_years"][near[0]].min())

    def summary(self) -> str:
        """The thickness, the life on both sides of it, what governs, and what was tried."""
        data = self.dataset
        asked, exact = float(data["asked_years"]), float(data["exact_thickness"])
        risk = "by the laws as they are" if self.risk is None else f"at a risk of {100 * self.risk:g} %"
        at_most = "at most " if exact <= float(data.attrs["lower_bound"]) * (1 + 1e-9) else ""
        lines = [f"thickness of {self.layer} for {asked:g} years {risk}: {at_most}{exact * 1e3:.1f} mm"]
        for thickness in (self.thickness - self.step, self.thickness):
            row = np.flatnonzero(np.abs(data["trial_thickness"].to_numpy() - thickness) < 1e-9)
            if len(row):
                years = data["trial_years"][int(row[0])]
                governs = str(data["criterion"].to_numpy()[int(np.argmin(years.to_numpy()))])
                lines.append(f"  {thickness * 1e3:.0f} mm: {_years(float(years.min()))} years, by {governs}")
        lines.append("  at D = 1:")
        lines += [f"    {one.name}: {one.law_at(15.0).end_of_life}" for one in self.life.criteria]
        lasts = _years(self.years(self.thickness))
        verdict = f"Verdict: {self.layer} of {self.thickness * 1e3:.0f} mm lasts {lasts} years."
        if self.is_at_bound:
            verdict = (
                f"Verdict: {self.layer} may be thinner than {exact * 1e3:g} mm, the lower bound of the search, with "
                f"which the road lasts {lasts} years; give a smaller low to find the thickness for {asked:g} years."
            )
        lines.append(verdict)
        if self.stats:
            lines.append(
                "solved: {lives} lives with {contacts} contacts and {responses} responses".format(**self.stats)
            )
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    __repr__ = first_line


def design_thickness(
    tire: Tire,
    road: Pavement,
    traffic: Traffic,
    climate: Climate,
    criteria: Criteria,
    *,
    layer: int | str,
    years: float | None = None,
    risk: float | None = None,
    scatter: Scatter | None = None,
    low: float = 0.04,
    high: float = 0.4,
    step: float = 0.01,
    spacing: float = DEFAULT_SPACING,
    tolerance: float = 5e-3,
    workers: int | None = None,
    progress: Progress | None = None,
    contacts: Contacts | None = None,
    rutting: Rutting | None = None,
) -> ThicknessDesign:
    """The thickness of a layer for which all criteria last so many years, rounded up: Brent's method on ln(life).

    tire, road, traffic, climate, spacing, tolerance, workers, progress, contacts: as in `solve_life`. criteria: a
    list, or what gives them for a road: numbers of a law may depend on the thickness, as Sh does. layer: from 0 at
    the surface, or its name. years: those of the traffic if left out. risk: probability of failure, in (0, 1): laws
    that have a risk take it, and others stay as they are, with a warning; with a scatter all criteria are read at
    the years that they reach with this risk, see `life_reliability`. low, high: m, between which it is looked for.
    step: to which it is rounded up, m. rutting: how a rut is counted; its years until the limit count as those of a
    criterion, without scatter.

    Raises InputError for a layer without a thickness, and where no thickness between low and high lasts, with the
    longest life found and what limits it; ConvergenceError of a contact.
    """
    number = _number(road, layer)
    asked = traffic.years if years is None else years
    if asked is None:
        raise InputError("a design needs years, and the traffic has none; give years=20")
    positive("years", asked, "years", "20 is usual")
    positive("step", step, "metres", "1 cm is 0.01")
    if not 0 < low < high:
        raise InputError(f"low and high must be 0 < low < high, got {low:g} and {high:g} m; 0.04 and 0.4 are usual")
    if risk is not None:
        (risk,) = check_risks([risk])
    elif scatter is not None:
        raise InputError("a scatter without a risk says nothing of a design; give risk=0.05")
    given = _of_road(criteria)
    said = _warned(given(road), risk, scatter)
    contacts = contacts or Contacts(tire, spacing)
    shared = {"spacing": spacing, "workers": workers, "progress": progress, "contacts": contacts}
    search = _Search(
        tire, road, traffic, climate, given, number, asked, risk, scatter, shared, tolerance, rutting
    )  # fmt: skip
    if search.ruts and risk is not None:
        said += ("the rut has no risk: its years until the limit are those of its law as it is",)
    name = names_of(road)[number]
    exact = search.root(low, high, _FINE * step, name)
    rounded = math.ceil(exact / step - 1e-9) * step
    for thickness in (rounded, rounded - step):
        if thickness > 0:
            search.at_risk(thickness, fresh=True)
    if search.shortest(rounded) < asked * (1 - 1e-9):
        raise InputError(
            f"{name}: {exact * 1e3:.1f} mm lasts {asked:g} years, but the {rounded * 1e3:g} mm that it is rounded up "
            f"to last {search.shortest(rounded):.3g}: thickness does not lengthen this life steadily; look at "
            "it from low to high"
        )
    if exact == low:
        said += (
            f"{name}: {low * 1e3:g} mm, the lower bound of the search, lasts already; give a smaller low to find the "
            "thickness needed",
        )
    life = search.life(rounded)
    tried = sorted(search.known)
    dataset = variables.dataset(
        {
            "exact_thickness": ((), exact),
            "design_thickness": ((), rounded),
            "asked_years": ((), asked),
            "trial_thickness": (("trial",), tried),
            "trial_years": (("trial", "criterion"), np.array([search.known[thickness] for thickness in tried])),
        },
        {"criterion": search.names(life)},
        layer=name,
        step=step,
        lower_bound=low,
        **({} if risk is None else {"at_risk": risk}),
    )
    return ThicknessDesign(
        dataset, search.with_thickness(rounded), life, name, step, risk, search.counts,
        tuple(dict.fromkeys((*said, *life.warnings))),
    )  # fmt: skip


@dataclass(eq=False)
class _Search:
    """Lives by thickness, each solved once. known: years by criterion, at the risk, by thickness."""

    tire: Tire
    road: Pavement
    traffic: Traffic
    climate: Climate
    criteria: Callable[[Pavement], Sequence[Criterion]]
    number: int
    asked: float
    risk: float | None
    scatter: Scatter | None
    shared: dict[str, Any]
    tolerance: float
    rutting: Rutting | None = None
    known: dict[float, Array] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=lambda: {"lives": 0, "contacts": 0, "responses": 0})
    _lives: dict[float, Life] = field(default_factory=dict)
    # ln of the passes at the risk over those of the life, by criterion.
    _shift: Array | None = None

    @property
    def ruts(self) -> bool:
        """True where a rut ends the road too."""
        return self.rutting is not None and self.rutting.limit is not None

    def names(self, life: Life) -> list[str]:
        """What ends the road, in the order of the years."""
        return [*(one.name for one in life.criteria), *([RUT] if self.ruts else [])]

    def with_thickness(self, thickness: float) -> Pavement:
        """The road with that thickness of the layer."""
        layers = list(self.road.layers)
        layers[self.number] = replace(layers[self.number], thickness=thickness)
        return Pavement(layers, rigid_base=self.road.rigid_base)

    def life(self, thickness: float) -> Life:
        """The life of the road with a thickness, at the risk where laws have one."""
        if thickness not in self._lives:
            road = self.with_thickness(thickness)
            criteria = self.criteria(road)
            if self.risk is not None and self.scatter is None:
                criteria = [_at(one, self.risk) for one in criteria]
            life = solve_life(
                self.tire, road, self.traffic, self.climate, criteria, tolerance=self.tolerance,
                rutting=self.rutting, **self.shared,
            )  # fmt: skip
            self._lives[thickness] = life
            self.counts["lives"] += 1
            for name in ("contacts", "responses"):
                self.counts[name] += int(life.stats[name])
        return self._lives[thickness]

    def at_risk(self, thickness: float, *, fresh: bool = False) -> Array:
        """Years of all criteria. fresh: with a scatter, solve what it does at this very thickness."""
        life = self.life(thickness)
        rut = [life.rut_years] if self.ruts else []
        if self.scatter is None:
            self.known[thickness] = np.append(life.dataset["life_years"].to_numpy(), rut)
            return self.known[thickness]
        if fresh or self._shift is None:
            self._shift = self._shifted(thickness, life)
        passes = life.dataset["life_passes"].to_numpy() * np.exp(self._shift)
        self.known[thickness] = np.array([*(self.traffic.years_to(float(one)) for one in passes), *rut])
        return self.known[thickness]

    def shortest(self, thickness: float) -> float:
        """Years until the first criterion fails."""
        return float(min(self.known.get(thickness, self.at_risk(thickness)).min(), _LONG))

    def excess(self, thickness: float) -> float:
        """Logarithm of the life over the years that are asked for."""
        return math.log(max(float(min(self.at_risk(thickness).min(), _LONG)), 1e-9) / self.asked)

    def root(self, low: float, high: float, fine: float, name: str) -> float:
        """The thickness that lasts exactly, low where that lasts already. Raises InputError where none does."""
        found = low
        for _ in range(_ROUNDS if self.scatter is not None else 1):
            ends = self._bracket(low, high, name)
            if ends is None:
                return low
            before, found = found, float(brentq(self.excess, *ends, xtol=fine, rtol=1e-6))
            if self.scatter is None or abs(found - before) < 10 * fine:
                break
            self.at_risk(found, fresh=True)
        return found

    def _bracket(self, low: float, high: float, name: str) -> tuple[float, float] | None:
        """Two thicknesses with the root between them, near that of the road; None where low lasts already."""
        own = self.road.layers[self.number].thickness
        assert own is not None
        thin = thick = min(max(own, low), high)
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
        found = life_reliability(
            self.tire, self.with_thickness(thickness), life, scatter=self.scatter, risks=[self.risk], **self.shared
        )
        self.counts["responses"] += int(found.stats["responses"])
        shift = np.zeros(len(life.criteria))
        told = [str(name) for name in found.dataset["criterion"].to_numpy()]
        for number, one in enumerate(life.criteria):
            if one.name in told:
                passes = self.traffic.passes(min(found.years(self.risk, one.name), _LONG))
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
            f"no thickness of {name} from {low * 1e3:g} to {high * 1e3:g} mm lasts {self.asked:g} years: the longest "
            f"life is {float(lives[best].min()):.3g} years, at {best * 1e3:g} mm, by {criterion}{helps}; give a "
            "larger high, another layer, or a better mix"
        )


def _number(road: Pavement, layer: int | str) -> int:
    names = names_of(road)
    if isinstance(layer, str):
        if layer not in names:
            raise InputError(f"no layer has the name {layer!r}; {nearest(layer, names)}")
        number = names.index(layer)
    else:
        if not -len(names) <= layer < len(names):
            raise InputError(f"the road has {len(names)} layers, 0 to {len(names) - 1}; there is no layer {layer}")
        number = layer % len(names)
    if road.layers[number].thickness is None:
        raise InputError(
            f"{names[number]!r} is semi-infinite and has no thickness to look for; give a layer above it"
        )
    return number


def _of_road(criteria: Criteria) -> Callable[[Pavement], Sequence[Criterion]]:
    if callable(criteria):
        return criteria
    kept = tuple(criteria)
    return lambda _: kept


def _has_risk(law: FatigueLaw) -> bool:
    return hasattr(law, "risk") and hasattr(law, "risk_factor")


def _at(criterion: Criterion, risk: float) -> Criterion:
    """The criterion with this risk in its law, where that has one."""
    law = criterion.law
    if not _has_risk(criterion.law_at(15.0)):
        return criterion
    if callable(law):
        of_warmth = law
        return replace(criterion, law=lambda temperature: replace(of_warmth(temperature), risk=risk))  # type: ignore[type-var]
    return replace(criterion, law=replace(law, risk=risk))  # type: ignore[type-var]


def _warned(criteria: Sequence[Criterion], risk: float | None, scatter: Scatter | None) -> tuple[str, ...]:
    """Sentences on laws that a risk does not reach. Raises InputError where it reaches none."""
    if risk is None or scatter is not None:
        return ()
    without = [one for one in criteria if not _has_risk(one.law_at(15.0))]
    if len(without) == len(criteria):
        raise InputError(
            f"no law of this design has a risk of its own, so that {100 * risk:g} % says nothing; give scatter=, in "
            "a case [reliability], by which the years at that risk are found"
        )
    return tuple(
        f"{one.name}: its law, {one.law_at(15.0)}, has no risk, and counts as it is; [reliability] would give it one"
        for one in without
    )


def _years(years: float) -> str:
    return "no end of" if math.isinf(years) else f"{years:.3g}"
