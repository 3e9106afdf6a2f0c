"""Goodman's stiffness of a bond from shear tests of cores, and a bond whose stiffness follows temperature."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Self

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.labels import factor
from treadload.pavement.bonds import Bond, BondLaw
from treadload.registry import BONDS
from treadload.tables import finite_list, read_table
from treadload.units import Celsius, Stiffness

# Of the largest force: where the rising branch is straight, past seating and before it softens.
_FROM, _TO = 0.2, 0.5
_FEWEST = 5

QUOTED_STIFFNESS: Mapping[str, float] = MappingProxyType({"slipping": 1e7, "adhering": 1e11})
"""Stiffness of bonds, Pa/m, as commonly quoted, not checked against the source: Al Hakim, Armitage and Thom (1998),
Pavement assessment including bonding condition, back-calculated from deflections: 10 MN/m³ where layers slip, 10⁵
MN/m³ where they adhere."""


@dataclass(frozen=True, eq=False)
class ShearTest:
    """One shear test of a core.

    displacement: of one half against the other, m, rising. force: N. area: of the interface, m². temperature: °C.
    rate: of the displacement, m/s. height: of asphalt between the clamps that shears, too, m, and shear_modulus: its
    own, Pa; 0 and infinity leave it out, and the stiffness is then that of both. Raises InputError.

    >>> rows = range(21)
    >>> test = tl.pavement.ShearTest([5e-5 * n for n in rows], [1e3 * n for n in rows], area=0.0177, temperature=20.0)
    >>> f"strength {test.strength / 1e6:.2f} MPa, stiffness {test.stiffness / 1e9:.2f} MPa/mm"
    'strength 1.13 MPa, stiffness 1.13 MPa/mm'
    """

    displacement: Array
    force: Array
    area: float
    temperature: float
    rate: float = 50e-3 / 60
    height: float = 0.0
    shear_modulus: float = math.inf

    def __post_init__(self) -> None:
        for name in ("displacement", "force"):
            object.__setattr__(self, name, finite_list(getattr(self, name), name))
        if len(self.displacement) != len(self.force):
            raise InputError(
                f"a shear test has {len(self.displacement)} displacements and {len(self.force)} forces; give one each"
            )
        positive("the area of a core", self.area, "m²", "150 mm across are 0.0177")
        positive("the rate of a shear test", self.rate, "m/s", "50 mm/min is 0.83e-3")
        if not (self.height >= 0 and self.shear_modulus > 0):
            raise InputError(
                f"height must be >= 0 m and shear_modulus > 0 Pa, got {self.height} and {self.shear_modulus}; leave "
                "both out to take the asphalt with the bond"
            )
        if not self.force.max(initial=0.0) > 0:
            raise InputError("a shear test needs a force > 0; is its sign turned round?")
        if (np.diff(self.displacement[: self._top + 1]) < 0).any():
            raise InputError("the displacement of a shear test must not fall before the largest force; sort its rows")

    @classmethod
    def from_csv(
        cls,
        path: str | os.PathLike[str],
        *,
        area: float,
        temperature: float,
        rate: float = 50e-3 / 60,
        height: float = 0.0,
        shear_modulus: float = math.inf,
        units: tuple[str, str] = ("mm", "kN"),
    ) -> Self:
        """A test from a text file whose first two columns are displacement and force, with or without a heading.

        units: of both columns. The others as in the class. Raises InputError.
        """
        table = read_table(path)
        if len(table.rows[0]) < 2:
            raise InputError(f"{path} has one column; a shear test needs displacement and force")
        head = ("the displacement", "the force")
        values, _ = table.values([0, 1], first=1 if table.has_header else 0, name=head.__getitem__)
        both = values * [factor(units[0], "m"), factor(units[1], "N")]
        return cls(both[:, 0], both[:, 1], area, temperature, rate, height, shear_modulus)

    @property
    def _top(self) -> int:
        return int(self.force.argmax())

    @property
    def strength(self) -> float:
        """Largest shear stress, Pa."""
        return float(self.force.max() / self.area)

    @property
    def slip(self) -> float:
        """Displacement at the largest force, m, from where the straight branch would begin."""
        straight, begin = self._straight
        return float(self.displacement[self._top] + begin / straight)

    @property
    def stiffness(self) -> float:
        """Goodman's stiffness k_s, Pa/m: slope of the rising branch from 20 to 50 % of the largest force.

        Less the asphalt's: 1/k_s = 1/k - height / shear_modulus. Raises InputError where that leaves nothing.
        """
        compliance = self.area / self._straight[0] - self.height / self.shear_modulus
        if not compliance > 0:
            raise InputError(
                f"{self.height * 1e3:g} mm of asphalt of {self.shear_modulus / 1e6:g} MPa alone give more than this "
                "test shows; take a stiffer asphalt, or less of it"
            )
        return float(1 / compliance)

    @property
    def _straight(self) -> tuple[float, float]:
        """Slope, N/m, and force at no displacement, N."""
        rising = slice(0, self._top + 1)
        force, moved = self.force[rising], self.displacement[rising]
        part = (force >= _FROM * force.max()) & (force <= _TO * force.max())
        if part.sum() < _FEWEST or np.ptp(moved[part]) == 0:
            raise InputError(
                f"a shear test needs {_FEWEST} rows or more between {100 * _FROM:g} and {100 * _TO:g} % of its "
                f"largest force, got {int(part.sum())}; record it faster"
            )
        slope, begin = np.polyfit(moved[part], force[part], 1)
        if not slope > 0:
            raise InputError("the force of a shear test must rise with the displacement; are its columns exchanged?")
        return float(slope), float(begin)


@BONDS.register("tested")
@dataclass(frozen=True)
class TestedBond(BondLaw):
    """A bond whose stiffness was measured at temperatures; ln k_s is linear between them.

    temperatures: °C, rising, two or more. stiffnesses: k_s at each, Pa/m, > 0. Beyond the tests it is refused.
    Raises InputError.

    >>> bond = tl.pavement.TestedBond((10.0, 30.0), (20e9, 2e9))
    >>> f"{bond.at(20).stiffness:.2g} Pa/m"
    '6.3e+09 Pa/m'
    """

    # Not a class of tests.
    __test__ = False

    temperatures: tuple[Celsius, ...]
    stiffnesses: tuple[Stiffness, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "temperatures", tuple(self.temperatures))
        object.__setattr__(self, "stiffnesses", tuple(self.stiffnesses))
        if len(self.temperatures) != len(self.stiffnesses) or len(self.temperatures) < 2:
            raise InputError(
                f"a tested bond needs a stiffness for each of two temperatures or more, got {len(self.temperatures)} "
                f"temperatures and {len(self.stiffnesses)} stiffnesses"
            )
        if not (np.diff(self.temperatures) > 0).all():
            raise InputError(f"the temperatures of a tested bond must rise, got {list(self.temperatures)} °C")
        for stiffness in self.stiffnesses:
            positive("the stiffness of a tested bond", stiffness, "Pa/m", "1000 MPa/m is 1e9")

    @classmethod
    def of(cls, tests: Iterable[ShearTest]) -> Self:
        """Through shear tests: the geometric mean of those at one temperature. Raises InputError."""
        logarithms: dict[float, list[float]] = {}
        for test in tests:
            logarithms.setdefault(test.temperature, []).append(math.log(test.stiffness))
        rising = sorted(logarithms)
        return cls(tuple(rising), tuple(math.exp(float(np.mean(logarithms[warm]))) for warm in rising))

    @property
    def stiffness(self) -> float:  # type: ignore[override]
        """Not known yet: raises InputError."""
        raise InputError(f"{self} waits for its temperature; take Pavement.at_temperature(...)")

    @property
    def depends_on_temperature(self) -> bool:
        """True."""
        return True

    def at(self, temperature: float) -> Bond:
        """The bond at a temperature of the layer above, °C. Raises InputError beyond the tests."""
        low, high = self.temperatures[0], self.temperatures[-1]
        if not low <= temperature <= high:
            raise InputError(
                f"a bond tested from {low:g} to {high:g} °C has no stiffness at {temperature:g} °C; test it there, "
                "or add the value that you assume"
            )
        return Bond(float(np.exp(np.interp(temperature, self.temperatures, np.log(self.stiffnesses)))))

    def __str__(self) -> str:
        low, high = self.temperatures[0], self.temperatures[-1]
        return f"bond tested from {low:g} to {high:g} °C"
