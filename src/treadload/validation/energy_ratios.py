"""Checks of the energy ratio: three mixes of a Florida report, from their indirect tension to the printed ratio."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from scipy.optimize import brentq

from treadload.damage import EnergyRatio
from treadload.units import PSI
from treadload.validation.check import Check, relative

_SOURCE = "Florida DOT, report of 2013-09-25 for the study of wide-base tires, table 4"
# The conventional stress of the report, psi, and the time of its creep rate, s.
_STRESS, _CREEP_TIME = 148.0, 1000.0


@dataclass(frozen=True)
class PrintedMix:
    """A row of the table. creep_compliance: D₁, 1/psi. creep_rate: at 1000 s, 1/psi/s. strength: MPa. modulus: GPa.
    fracture_energy: kJ/m³. ratio: the printed energy ratio.
    """

    name: str
    creep_compliance: float
    creep_rate: float
    strength: float
    modulus: float
    fracture_energy: float
    ratio: float

    @property
    def slope(self) -> float:
        """The slope m by the creep rate D₁ m t^(m-1); its own two digits move the ratio by up to 3.6 %."""
        rate = self.creep_rate / self.creep_compliance
        # The rate rises with m above 1/ln 1000 = 0.145 only.
        return float(brentq(lambda m: m * _CREEP_TIME ** (m - 1) - rate, 0.15, 0.99))

    @property
    def law(self) -> EnergyRatio:
        """The energy ratio of the mix."""
        return EnergyRatio(
            self.creep_compliance / PSI,
            self.slope,
            1e6 * self.strength,
            1e3 * self.fracture_energy,
            1e9 * self.modulus,
        )


PRINTED_MIXES = (
    PrintedMix("12.5 mm PG 67-22", 3.55e-7, 3.83e-9, 2.44, 13.97, 2.30, 2.81),
    PrintedMix("12.5 mm PG 76-22", 4.17e-7, 2.77e-9, 2.54, 13.16, 2.80, 4.16),
    PrintedMix("4.75 mm PG 76-22", 3.84e-7, 1.47e-9, 2.90, 14.21, 4.40, 10.93),
)


def energy_ratio_checks() -> Iterator[Check]:
    """Energy ratios at 148 psi. Of the inputs the creep rate has three digits, which change the ratio by 0.4 %."""
    for mix in PRINTED_MIXES:
        computed = float(mix.law.ratio(_STRESS * PSI))
        yield relative("energy ratio", f"{mix.name}: at 148 psi", computed, mix.ratio, 5e-3, _SOURCE)
