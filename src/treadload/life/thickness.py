"""How thick a layer must be for a road to last: by root finding on its life."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.damage.life import Life
from treadload.damage.scatter import check_risks
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest, positive
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.stiffer import names_of
from treadload.life.thickness_search import ThicknessSearch, has_risk
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.units import years_in_words

# The root is found to this part of the step that the thickness is rounded to.
_FINE = 0.1


@dataclass(frozen=True, eq=False)
class ThicknessDesign(BaseResult, group="design"):
    """The thickness of a layer for which a road lasts, and what was tried on the way.

    dataset: exact_thickness and design_thickness, rounded up to a step, m, and lower_bound of the search as an
    attribute, m, which is the thickness where it lasts already; asked_years; trial_thickness (trial),
    rising, and trial_years (trial, criterion), at the risk that was asked for. road: with the rounded thickness.
    life: of that road. layer: its name; step: m. risk: that was asked for, None for that of the laws. stats: how much
    was solved. warnings: sentences for the user.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> answer = tl.life.design_thickness(design, "asphalt", years=20, between=(0.03, 0.06))
    >>> f"{answer.dataset.exact_thickness.item() * 1e3:.1f} mm, rounded up to a step of {answer.step * 1e3:.0f} mm"
    '43.7 mm, rounded up to a step of 10 mm'
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
        """The thickness, the service life on both sides of it, what governs, and the assessment."""
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

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> answer = tl.life.design_thickness(design, "asphalt", years=20, between=(0.03, 0.06))
    >>> f"{answer.dataset.design_thickness.item() * 1e3:.0f} mm of asphalt last 20 years"
    '50 mm of asphalt last 20 years'
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
    search = ThicknessSearch(design, number, target, risk, {"workers": workers, "progress": progress})
    if search.ruts and risk is not None:
        caveats += ("the rut has no risk: its years until the limit are those of its law as it is",)
    name = names_of(design.road)[number]
    exact = search.root(low, high, _FINE * step, name)
    exact, rounded = search.rounded(exact, step, (low, high), name)
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


def _warned(design: Design, risk: float | None) -> tuple[str, ...]:
    """Sentences on laws that a risk does not reach. Raises InputError where it reaches none."""
    if risk is None or design.scatter is not None:
        return ()
    without = [criterion for criterion in design.criteria if not has_risk(criterion.law_at(15.0))]
    if len(without) == len(design.criteria):
        raise InputError(
            f"no law of this design has a risk of its own, so that {100 * risk:g} % has no meaning; give the design "
            "a scatter, in a case [reliability], by which the years at that risk are found"
        )
    return tuple(
        f"{criterion.name}: its law, {criterion.law_at(15.0)}, has no risk, and counts as it is; [reliability] "
        "would give it one"
        for criterion in without
    )
