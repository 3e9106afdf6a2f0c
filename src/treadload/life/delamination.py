"""A road before and after a bond between its layers fails: the same structure with it and without, side by side."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.damage.criterion import interface_number
from treadload.damage.interface import delaminate, interface_fields, interface_in_words
from treadload.damage.life import Life
from treadload.damage.miner import passes_in_two_phases
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.solve import solve_life
from treadload.pavement import BONDED, FRICTIONLESS, BondLaw, Pavement
from treadload.response import solve_response
from treadload.response.loads import Load
from treadload.rows import Row, row
from treadload.units import repetitions_in_words, years_in_words
from treadload.variables import Display, display_of

BEFORE, AFTER, PARTING = "bonded", "parted", "bonded, then parted"


def solve_interfaces(
    loads: Load | Sequence[Load],
    road: Pavement,
    *,
    x: ArrayLike | None = None,
    y: ArrayLike | None = None,
    speed: float | None = None,
) -> xr.Dataset:
    """Shear, pressure and sliding at every interface of a road under loads.

    Arguments as in `solve_response`, which is asked on both sides where a bond can slide. Returns the dataset of
    `interface_fields`, whose attribute `warnings` (JSON) holds those of the response. Raises InputError.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.06), tl.Layer(tl.Elastic(100e6, 0.4))])
    >>> braking = tl.response.UniformRectangle(0.2, 0.2, 8e5, traction_x=4e5)
    >>> fields = tl.life.solve_interfaces(braking, road, x=[0.0, 0.1], y=[0.0])
    >>> [f"{shear / 1e3:.0f} kPa" for shear in fields.interface_shear.values.ravel()]
    ['2 kPa', '53 kPa']
    """
    depths = road.interfaces[: len(road.layers) - 1]
    if not len(depths):
        raise InputError("this road has no interfaces between layers; give it two layers or more")
    above = solve_response(loads, road, depths=depths, x=x, y=y, speed=speed)
    if all(layer.bond == BONDED for layer in road.layers):
        fields = interface_fields(above, above)
    else:
        fields = interface_fields(
            above, solve_response(loads, road, depths=depths, x=x, y=y, speed=speed, side="below")
        )
    return fields.assign_attrs(warnings=json.dumps(above.warnings, ensure_ascii=False))


@dataclass(frozen=True, eq=False)
class BondComparison(BaseResult, group="bond_comparison"):
    """The life of a road bonded, debonded, and bonded until the bond fails.

    dataset: largest_reading, life_passes, life_years over (state, criterion), states "bonded", "parted" and
    "bonded, then parted"; parting_passes, parting_years. What is left of the bond acts by friction or as a spring:
    the failed bond's own criterion means nothing there. bonded, parted: the lives of both roads. interface: that
    fails, counted from the surface. bond: what is left of it. criterion: name of the bond that fails first.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> strength, fatigue = tl.damage.InterfaceStrength(3e6), tl.damage.ShearFatigue(slope=-0.2)
    >>> bond = tl.damage.Criterion.of_bond("bond", strength, fatigue)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1, "bottom")
    >>> asphalt, soil = tl.Elastic(5e9, 0.35), tl.Elastic(60e6, 0.4)
    >>> road = tl.Pavement([tl.Layer(asphalt, 0.02), tl.Layer(asphalt, 0.03), tl.Layer(soil)])
    >>> comparison = tl.life.compare_bonds(tl.Design(tire, road, traffic, climate, [bond, base], spacing=0.01))
    >>> f"the bond fails after {comparison.dataset.parting_years.item():.1f} years"
    'the bond fails after 9.1 years'
    """

    title: ClassVar[str] = "Debonding"
    holds: ClassVar[Holds] = Holds(
        {"largest_reading life_passes life_years": "state criterion", "parting_passes parting_years": ""},
        labels={"criterion": "criterion"},
        values={"state": (BEFORE, AFTER, PARTING)},
        texts="between",
    )

    dataset: xr.Dataset
    bonded: Life
    parted: Life
    interface: int
    bond: BondLaw
    criterion: str

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of both lives."""
        return tuple(dict.fromkeys(self.bonded.warnings + self.parted.warnings))

    @property
    def governing(self) -> str:
        """Name of the criterion that ends the road's life, the bond itself aside."""
        years = self.dataset["life_years"].sel(state=PARTING).to_numpy()
        layered = [k for k, criterion in enumerate(self.bonded.criteria) if not criterion.quantity.between_layers]
        return self.bonded.criteria[min(layered or range(len(years)), key=lambda k: years[k])].name

    @property
    def heading(self) -> str:
        """The interface, and what is left of its bond."""
        return f"bond of {interface_in_words(self.interface, self.dataset.attrs['between'])}, then {self.bond}"

    def rows(self) -> tuple[Row, ...]:
        """Largest values and service lives by criterion in the three states, failure of the bond, the assessment."""
        data, rows = self.dataset, []
        for criterion in self.bonded.criteria:
            for state in (BEFORE, AFTER, PARTING):
                at = data.sel(criterion=criterion.name, state=state)
                # Of the failed bond its own criterion means nothing.
                lost = criterion.name == self.criterion and state == AFTER
                group = f"{criterion.name}, {state}"
                display = Display(display_of("largest_reading").label, "", criterion.quantity.in_words)
                rows += [
                    row("largest_reading", math.nan if lost else at["largest_reading"], group=group, display=display),
                    row("life_years", math.nan if lost else at["life_years"], group=group),
                ]
        return (
            *rows,
            row("parting_passes", data["parting_passes"]),
            row("parting_years", data["parting_years"]),
            row("governing", self.governing),
            row("verdict", self._verdict()),
        )

    def _verdict(self) -> str:
        data, name = self.dataset, self.governing
        passes = float(data["parting_passes"])
        before, after = (
            years_in_words(float(data["life_years"].sel(criterion=name, state=state))) for state in (BEFORE, PARTING)
        )
        if math.isinf(passes):
            return f"the bond never fails; {name} lasts {before}."
        return (
            f"{self.criterion} fails after {repetitions_in_words(passes)} load repetitions, "
            f"{years_in_words(float(data['parting_years']))}; {name} governs and lasts {after} instead of {before}."
        )


def compare_bonds(
    design: Design,
    *,
    interface: int | None = None,
    bond: BondLaw = FRICTIONLESS,
    workers: int | None = None,
    progress: Progress | None = None,
) -> BondComparison:
    """How long a road lasts with its bond, without it, and when the bond fails on the way.

    criteria of the design: that of one bond at least, `Criterion.of_bond`, and what limits the road's
    life; the bottom of the layer above the interface belongs there, as that layer bends alone once debonded.
    interface: that fails; left out, that of the bond with the shortest life. bond: what is left of it, FRICTIONLESS,
    HALF_BONDED or Bond(stiffness=...). The road is taken as debonded everywhere as soon as the bond fails at the
    worst place: a layered model knows neither a debonded patch nor the stress concentration at its edge. Miner's sum
    runs on at the debonded road's rate, n₁ / N₁ + n₂ / N₂ = 1, at every point across the road, both rates those of a
    whole year; of several interfaces only the first fails. Raises InputError, and ConvergenceError of a contact.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> strength, fatigue = tl.damage.InterfaceStrength(3e6), tl.damage.ShearFatigue(slope=-0.2)
    >>> bond = tl.damage.Criterion.of_bond("bond", strength, fatigue)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1, "bottom")
    >>> asphalt, soil = tl.Elastic(5e9, 0.35), tl.Elastic(60e6, 0.4)
    >>> road = tl.Pavement([tl.Layer(asphalt, 0.02), tl.Layer(asphalt, 0.03), tl.Layer(soil)])
    >>> comparison = tl.life.compare_bonds(tl.Design(tire, road, traffic, climate, [bond, base], spacing=0.01))
    >>> passes = comparison.dataset.life_passes.sel(criterion="base").values
    >>> [f"{number:.1e}" for number in passes]  # bonded, debonded, and bonded until the bond fails
    ['6.0e+08', '5.3e+07', '1.4e+08']
    """
    road, traffic, criteria = design.road, design.traffic, design.criteria
    bonds = [criterion for criterion in criteria if criterion.quantity.between_layers]
    chosen = None if interface is None else interface_number(road, interface)
    bonds_compared = [bond for bond in bonds if chosen is None or bond.number(road) == chosen]
    if not bonds_compared:
        where = "" if chosen is None else f" of interface {chosen}"
        raise InputError(f"comparing bonds needs the criterion of a bond{where}, Criterion.of_bond, got none")

    def live(pavement: Pavement) -> Life:
        return solve_life(replace(design, road=pavement), workers=workers, progress=progress)

    before = live(road)
    passes = before.dataset["life_passes"]
    first = min(bonds_compared, key=lambda criterion: float(passes.sel(criterion=criterion.name)))
    parts = float(passes.sel(criterion=first.name))
    number = first.number(road)
    after = live(delaminate(road, number, bond))
    rates = _on_one_width([life.dataset["damage_per_year"] for life in (before, after)])
    # No traffic, no damage: any number of passes does.
    rates = [rate / (traffic.passes_per_year or 1.0) for rate in rates]
    in_turn = passes_in_two_phases(rates[0], rates[1], parts).min(axis=-1)
    lives = np.stack([passes.to_numpy(), after.dataset["life_passes"].to_numpy(), in_turn])
    readings = [life.dataset["largest_reading"].to_numpy() for life in (before, after)]
    together = readings[0] if math.isinf(parts) else np.maximum(*readings)
    dims = ("state", "criterion")
    dataset = variables.dataset(
        {
            "largest_reading": (dims, np.stack([*readings, together])),
            "life_passes": (dims, lives),
            "life_years": (dims, [[traffic.years_to(float(n)) for n in row] for row in lives]),
            "parting_passes": ((), parts),
            "parting_years": ((), traffic.years_to(parts)),
        },
        {"state": [BEFORE, AFTER, PARTING], "criterion": [criterion.name for criterion in criteria]},
        interface=number,
        between=" / ".join(road.layers[k].name or f"layer {k + 1}" for k in (number, number + 1)),
        bond=str(bond),
        parts=first.name,
    )
    return BondComparison(dataset, before, after, number, bond, first.name)


def _on_one_width(rates: Sequence[xr.DataArray]) -> list[Array]:
    """Damage (criterion, y) of lives whose basins are not as wide, on the lattice of the widest."""
    y = max((rate["y"].to_numpy() for rate in rates), key=len)
    return [
        np.stack([np.interp(y, rate["y"], row, left=0.0, right=0.0) for row in rate.to_numpy()]) for rate in rates
    ]
