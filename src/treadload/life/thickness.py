"""How thick a layer must be for a road to last: by root finding on its life."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import scipy
import xarray as xr

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.life import Life
from treadload.damage.scatter import check_risks
from treadload.damage.words import RUT
from treadload.errors import InputError, nearest, positive
from treadload.kernels.arrays import Array
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.reliability import life_reliability
from treadload.life.solve import solve_life
from treadload.life.variants import names_of
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.units import years_in_words

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

    title: ClassVar[str] = "Thickness design"
    subject: ClassVar[str] = "How thick a layer must be"
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

    @property
    def heading(self) -> str:
        """The layer, the years and the risk."""
        risk = "by the laws as they are" if self.risk is None else f"at a risk of {100 * self.risk:g} %"
        return f"{self.layer} for {float(self.dataset['asked_years']):g} years {risk}"

    def rows(self) -> tuple[Row, ...]:
        """The thickness, the service life on both sides of it, what governs, and the verdict."""
        data = self.dataset
        exact = float(data["exact_thickness"])
        lowest = exact <= float(data.attrs["lower_bound"]) * (1 + 1e-9)
        rows = [
            row("exact_thickness", exact, note="at most: the lower bound of the search" if lowest else ""),
            row("design_thickness", data["design_thickness"]),
        ]
        for thickness in (self.thickness - self.step, self.thickness):
            for number in np.flatnonzero(np.abs(data["trial_thickness"].to_numpy() - thickness) < 1e-9)[:1]:
                years = data["trial_years"][int(number)].to_numpy()
                first, group = int(np.argmin(years)), row("trial_thickness", thickness).text
                rows.append(row("trial_years", years[first], group=group))
                rows.append(row("governing", str(data["criterion"].to_numpy()[first]), group=group))
        rows += [
            row("end_of_life", criterion.law_at(15.0).end_of_life, note=criterion.name)
            for criterion in self.life.criteria
        ]
        if self.stats:
            rows.append(
                row("solved", "{lives} lives, {contacts} contacts, {responses} responses".format(**self.stats))
            )
        return (*rows, row("verdict", self._verdict()))

    def _verdict(self) -> str:
        data, lasts = self.dataset, years_in_words(self.years(self.thickness))
        if not self.is_at_bound:
            return f"{self.layer} of {self.thickness * 1e3:.0f} mm lasts {lasts}."
        return (
            f"{self.layer} may be thinner than {float(data['exact_thickness']) * 1e3:g} mm, the lower bound of the "
            f"search, with which the road lasts {lasts}; give a smaller low to find the thickness for "
            f"{float(data['asked_years']):g} years."
        )


def design_thickness(
    design: Design,
    layer: int | str,
    *,
    years: float | None = None,
    risk: float | None = None,
    between: tuple[float, float] = (0.04, 0.4),
    step: float = 0.01,
    workers: int | None = None,
    progress: Progress | None = None,
) -> ThicknessDesign:
    """The thickness of a layer for which all criteria last so many years, rounded up: Brent's method on ln(life).

    layer: from 0 at the surface, or its name. years: those of the traffic if left out. risk: probability of failure,
    in (0, 1): laws that have a risk take it, and others stay as they are, with a warning; with a scatter in design
    all criteria are read at the years that they reach with this risk, see `life_reliability`. Without a risk
    the laws count as they are. between: low and high, m, the bounds of the search. step: to which the thickness is
    rounded up, m. A rut counts by its years until the limit, as a criterion without scatter. workers, progress: as in
    `solve_life`.

    Raises InputError for a layer without a thickness, and where no thickness between low and high lasts, with the
    longest life found and what limits it; ConvergenceError of a contact.
    """
    (low, high), number = between, _number(design.road, layer)
    target = design.traffic.years if years is None else years
    if target is None:
        raise InputError("a design needs years, and the traffic has none; give years=20")
    positive("years", target, "years", "20 is usual")
    positive("step", step, "metres", "1 cm is 0.01")
    if not 0 < low < high:
        raise InputError(f"low and high must be 0 < low < high, got {low:g} and {high:g} m; 0.04 and 0.4 are usual")
    if risk is not None:
        (risk,) = check_risks([risk])
    caveats = _warned(design, risk)
    search = _Search(design, number, target, risk, {"workers": workers, "progress": progress})
    if search.ruts and risk is not None:
        caveats += ("the rut has no risk: its years until the limit are those of its law as it is",)
    name = names_of(design.road)[number]
    exact = search.root(low, high, _FINE * step, name)
    rounded = math.ceil(exact / step - 1e-9) * step
    for thickness in (rounded, rounded - step):
        if thickness > 0:
            search.at_risk(thickness, fresh=True)
    if search.shortest(rounded) < target * (1 - 1e-9):
        raise InputError(
            f"{name}: {exact * 1e3:.1f} mm lasts {target:g} years, but the {rounded * 1e3:g} mm that it is rounded "
            f"up to last {search.shortest(rounded):.3g}: thickness does not lengthen this life steadily; look at "
            "it from low to high"
        )
    if exact == low:
        caveats += (
            f"{name}: {low * 1e3:g} mm, the lower bound of the search, lasts already; give a smaller low to find the "
            "thickness needed",
        )
    life = search.life(rounded)
    tried = sorted(search.years_by_thickness)
    dataset = variables.dataset(
        {
            "exact_thickness": ((), exact),
            "design_thickness": ((), rounded),
            "asked_years": ((), target),
            "trial_thickness": (("trial",), tried),
            "trial_years": (
                ("trial", "criterion"),
                np.array([search.years_by_thickness[thickness] for thickness in tried]),
            ),
        },
        {"criterion": search.names(life)},
        layer=name,
        step=step,
        lower_bound=low,
        **({} if risk is None else {"at_risk": risk}),
    )
    return ThicknessDesign(
        dataset, design.with_thickness(number, rounded).road, life, name, step, risk, search.counts,
        tuple(dict.fromkeys((*caveats, *life.warnings))),
    )  # fmt: skip


@dataclass(eq=False)
class _Search:
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
        return float(min(self.years_by_thickness.get(thickness, self.at_risk(thickness)).min(), _LONG))

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


def _warned(design: Design, risk: float | None) -> tuple[str, ...]:
    """Sentences on laws that a risk does not reach. Raises InputError where it reaches none."""
    if risk is None or design.scatter is not None:
        return ()
    without = [criterion for criterion in design.criteria if not _has_risk(criterion.law_at(15.0))]
    if len(without) == len(design.criteria):
        raise InputError(
            f"no law of this design has a risk of its own, so that {100 * risk:g} % says nothing; give the design a "
            "scatter, in a case [reliability], by which the years at that risk are found"
        )
    return tuple(
        f"{criterion.name}: its law, {criterion.law_at(15.0)}, has no risk, and counts as it is; [reliability] "
        "would give it one"
        for criterion in without
    )


def _years(years: float) -> str:
    return "no end of" if math.isinf(years) else f"{years:.3g}"
