"""Daily thermal stress as cycles of Miner's sum: what is asked, what was found, and years with it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import scipy

from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.traffic import Traffic
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.materials import Mix, Thermorheological
from treadload.materials.published import published
from treadload.materials.relaxing import relaxation_of, silent_on_time
from treadload.units import PerDegree

# Of length, 1/K: between what gauges and cores of one road gave, see `Thermal`.
EXPANSION = 2.5e-5
_LARGEST = 1e-3
_REMEDY = 'give `thermal` the relaxation of a published material with a shift, as relaxation = "ViscoRoute"'
DAYS = (31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)
"""Days of the months; a life counts 365 of them a year."""


@dataclass(frozen=True)
class Thermal:
    """Daily thermal stress of restrained mixes, which counts in Miner's sum as one cycle a day.

    expansion: of length, of all mixes, 1/K; 2.5e-5 if left out: gauges in Interstate 40, New Mexico, and cores of it
    gave 2.3 to 2.8e-5 (Construction and Building Materials, 2014, abstract read; Islam and Tarefder 2014, Adv. Civ.
    Eng. Mater. 3(1), on the same road). expansions: of single mixes, by their names. relaxation: name of a published
    viscoelastic material with a shift that stands for the mixes; left out, each relaxes by its own table over
    temperature and frequency, see `materials.relaxing.relaxation_of`. Raises InputError.
    """

    expansion: PerDegree = EXPANSION
    expansions: dict[str, PerDegree] = field(default_factory=dict)
    relaxation: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "expansions", dict(self.expansions))
        for name, value in (("expansion", self.expansion), *self.expansions.items()):
            if not (math.isfinite(value) and 0 <= value <= _LARGEST):
                raise InputError(
                    f"{name} must be a number of 1/K in [0, {_LARGEST:g}], got {value}; mixes are near 2.5e-5"
                )
        if self.relaxation is not None:
            if self.relaxation not in published:
                raise InputError(
                    f"no viscoelastic material {self.relaxation!r} relaxes; {nearest(self.relaxation, published)}"
                )
            if not isinstance(published[self.relaxation].material, Thermorheological):
                raise InputError(
                    f"the viscoelastic material {self.relaxation!r} has no shift, which leaves open how it "
                    "relaxes at other temperatures; take one with a shift"
                )

    def __hash__(self) -> int:
        return hash((self.expansion, tuple(sorted(self.expansions.items())), self.relaxation))

    def unknown(self, material: object) -> str:
        """Why the relaxation of a bituminous material is unknown, in words; empty where `of` finds it."""
        if isinstance(material, Thermorheological) or self.relaxation is not None:
            return ""
        if not isinstance(material, Mix):
            return f"{material} does not define how it relaxes; {_REMEDY}"
        silent = silent_on_time(material)
        return f"{silent}; {_REMEDY}" if silent else ""

    def of(self, material: object) -> tuple[Thermorheological, float, float]:
        """How a bituminous material relaxes, its expansion, 1/K, and the misfit of its model to its table.

        Raises InputError for a material that does not state how it relaxes.
        """
        expansion = self.expansions.get(getattr(material, "name", ""), self.expansion)
        if isinstance(material, Thermorheological):
            return material, expansion, 0.0
        if self.relaxation is not None:
            asphalt = published[self.relaxation].material
            assert isinstance(asphalt, Thermorheological)
            return asphalt, expansion, 0.0
        if isinstance(material, Mix):
            fitted = relaxation_of(material)
            return fitted.material, expansion, fitted.misfit
        raise InputError(self.unknown(material))


@dataclass(frozen=True, eq=False)
class DailyCycles:
    """What the weather alone does, by criterion and month.

    stress: (criterion, month), largest tension of the mean day, Pa; NaN for a criterion that it does not load.
    readings: (criterion, month), what the law reads of it. damage: (criterion, month), of a year. utilisation:
    (criterion,), largest reading over what the law allows for the days of the design life, or of a year. about:
    sentences on what was assumed. warnings: sentences for the user.
    """

    stress: Array
    readings: Array
    damage: Array
    utilisation: Array
    about: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def yearly(self) -> Array:
        """Damage of a year by criterion."""
        total: Array = self.damage.sum(axis=1)
        return total


def includes_weather(law: FatigueLaw) -> bool:
    """True for a law fitted to roads, below whose traffic days went by: counting them again would count twice."""
    return bool(getattr(law, "includes_weather", False))


def years_until(traffic: Traffic, damage: float, weather: float) -> float:
    """Years until damage of the traffic, so much in its first year, and of the weather, every year, add up to 1."""
    alone = traffic.years_to(traffic.passes_per_year / damage) if damage > 0 else math.inf
    if not weather > 0:
        return alone
    last = min(alone, 1 / weather)

    def left(years: float) -> float:
        return damage * traffic.growth_factor(years) + weather * years - 1

    # At the shorter of the two lives one of them alone is 1, and both are no less.
    return last if left(last) <= 0 else float(scipy.optimize.brentq(left, 1e-9 * last, last, rtol=1e-12))


def passes_until(traffic: Traffic, damage: Array, weather: float) -> Array:
    """Passes of the traffic until both damages, see `years_until`, are 1; inf where none is done."""
    if not weather > 0:
        with np.errstate(divide="ignore", over="ignore"):
            return np.where(damage > 0, traffic.passes_per_year / damage, np.inf)
    years = [years_until(traffic, float(total), weather) for total in np.ravel(damage)]
    return np.array([traffic.passes(year) for year in years]).reshape(np.shape(damage))
