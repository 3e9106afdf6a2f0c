"""Materials of roads as design methods tabulate them: moduli, and what they bear."""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.materials.celsius import check_celsius
from treadload.materials.elastic import Elastic
from treadload.materials.stress_dependent import UnboundByStress

# No mix bears a million cycles at one per cent: such a number is microstrain without its unit.
_LARGEST_STRAIN = 0.01


@dataclass(frozen=True)
class Mix:
    """A bituminous mix: Young's modulus over temperature and frequency, and its fatigue.

    name: in the catalogue. temperatures: °C, increasing, (nθ,). frequencies: of loading, Hz, increasing, (nf,).
    moduli: Pa, (nf, nθ), rows of one frequency. poisson: Poisson's ratio. frequency: that `at` reads, Hz.
    epsilon_6: strain that a million cycles allow at 10 °C and 25 Hz, plain strain; None where it is not known.
    slope: b of the fatigue line. scatter: SN, of the logarithm of the fatigue life. calibration: k_c.
    source: where the numbers are from. caveats: what is not certain about them, a sentence each.
    The modulus is linear in temperature between those tabulated, and a power of frequency between those tabulated.
    The first rule reproduces the printed E(15 °C, 10 Hz) of every French mix; the second misses the printed ratios
    at 3 Hz, when these are left out, by 2 % on average, one linear in log f by 4 %.
    Raises InputError.

    >>> mix = tl.catalogue.mixes["EB-GB3"]
    >>> [round(mix.with_frequency(f).at(15).modulus / 1e6) for f in (3, 10)]  # MPa at 15 °C, at 3 and 10 Hz
    [7470, 9000]
    """

    name: str
    temperatures: tuple[float, ...]
    frequencies: tuple[float, ...]
    moduli: tuple[tuple[float, ...], ...]
    poisson: float
    frequency: float = 10.0
    epsilon_6: float | None = None
    slope: float | None = None
    scatter: float | None = None
    calibration: float | None = None
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        place = f"mix {self.name!r}"
        temperatures = tuple(check_celsius(value) for value in self.temperatures)
        try:
            frequencies = tuple(float(value) for value in self.frequencies)
            moduli = tuple(tuple(float(value) for value in row) for row in self.moduli)
        except (TypeError, ValueError) as error:
            raise InputError(f"{place}: frequencies, Hz, and moduli, Pa, must be numbers: {error}") from error
        object.__setattr__(self, "temperatures", temperatures)
        object.__setattr__(self, "frequencies", frequencies)
        object.__setattr__(self, "moduli", moduli)
        if len(temperatures) < 2 or not _increase(temperatures):
            raise InputError(f"{place}: temperatures must be at least two and increase, got {list(temperatures)} °C")
        if not (frequencies and _increase(frequencies) and frequencies[0] > 0 and math.isfinite(frequencies[-1])):
            raise InputError(f"{place}: frequencies must be > 0 Hz and increase, got {list(frequencies)}")
        if [len(row) for row in moduli] != [len(temperatures)] * len(frequencies):
            raise InputError(
                f"{place}: moduli needs a row of {len(temperatures)} temperatures for each of "
                f"{len(frequencies)} frequencies, got rows of {[len(row) for row in moduli]}"
            )
        for value in (value for row in moduli for value in row):
            Elastic(value, self.poisson)
        self._check_fatigue(place)

    def _check_fatigue(self, place: str) -> None:
        if self.epsilon_6 is not None and not 0 < self.epsilon_6 < _LARGEST_STRAIN:
            raise InputError(
                f"{place}: epsilon_6 must be a plain strain between 0 and {_LARGEST_STRAIN}, got {self.epsilon_6}; "
                "100 microstrain is 100e-6"
            )
        if self.slope is not None and not -1 < self.slope < 0:
            raise InputError(f"{place}: slope must lie in (-1, 0), got {self.slope}; -0.2 is usual")
        _check_positive(place, frequency=self.frequency, scatter=self.scatter, calibration=self.calibration)

    def with_frequency(self, frequency: float) -> Mix:
        """The same mix, of which `at` reads the modulus at another frequency of loading, Hz."""
        return replace(self, frequency=frequency)

    def modulus(self, temperature: float, *, frequency: float | None = None, extrapolate: bool = False) -> float:
        """Young's modulus, Pa, at a temperature, °C, and a frequency of loading, Hz; left out, the mix's own.

        extrapolate: outside the table ln E is extrapolated linearly over temperature and over ln f, from the last
        two points. Raises InputError there otherwise, and for another frequency of a mix tabulated at one only.
        """
        theta = check_celsius(temperature)
        f = self.frequency if frequency is None else float(frequency)
        positive(f"mix {self.name!r}: frequency", f, "Hz", "10 Hz is usual")
        if len(self.frequencies) == 1 and f != self.frequencies[0]:
            raise InputError(
                f"mix {self.name!r} is tabulated at {self.frequencies[0]:g} Hz only, got {f:g} Hz; take a mix with "
                "a table over frequency, or a master curve"
            )
        if not extrapolate:
            self._check_within("°C", theta, self.temperatures)
            self._check_within("Hz", f, self.frequencies)
        over_frequency = [_over_temperature(theta, self.temperatures, row) for row in self.moduli]
        return _power(f, self.frequencies, over_frequency)

    def at(self, temperature: float, *, frequency: float | None = None, extrapolate: bool = False) -> Elastic:
        """The mix as an elastic material at a temperature, °C; arguments as for `modulus`."""
        return Elastic(self.modulus(temperature, frequency=frequency, extrapolate=extrapolate), self.poisson)

    def modulus_ratio(self, temperature: float, *, extrapolate: bool = False) -> float:
        """E(10 °C) / E(θ), both at 10 Hz, whose root the French method calls k_θ; θ in °C."""
        cool = self.modulus(10.0, frequency=10.0)
        return cool / self.modulus(temperature, frequency=10.0, extrapolate=extrapolate)

    def _check_within(self, unit: str, value: float, table: Sequence[float]) -> None:
        if not table[0] <= value <= table[-1]:
            raise InputError(
                f"mix {self.name!r}: {value:g} {unit} lies outside its data, {table[0]:g} to {table[-1]:g} {unit}; "
                "extrapolate=True extrapolates beyond them"
            )

    def __str__(self) -> str:
        return (
            f"{self.name}, {self.temperatures[0]:g} to {self.temperatures[-1]:g} °C at {self.frequency:g} Hz, "
            f"ν = {self.poisson:g}"
        )

    __repr__ = as_call


@dataclass(frozen=True, kw_only=True)
class HydraulicMix(Elastic):
    """A material bound by cement, slag or ash: elastic, and its fatigue.

    modulus: Pa. poisson: Poisson's ratio. name: in the catalogue. sigma_6: stress of a million cycles, Pa.
    slope: b of the fatigue line. scatter: SN. calibration: k_c. joints: k_d, for discontinuities; None where it
    depends on the structure. thickness_scatter: Sh, m; None where it does. source: where the numbers are from.
    caveats: what is not certain about them, a sentence each. Raises InputError.

    >>> mix = tl.catalogue.mixes["GC-T3"]
    >>> f"{mix.sigma_6 * (1e7 / 1e6) ** mix.slope / 1e6:.2f} MPa"  # stress of ten million cycles
    '0.64 MPa'
    """

    name: str
    sigma_6: float
    slope: float
    scatter: float
    calibration: float
    joints: float | None = None
    thickness_scatter: float | None = None
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        place = f"mix {self.name!r}"
        if not -1 < self.slope < 0:
            raise InputError(f"{place}: slope must lie in (-1, 0), got {self.slope}; -1/15 is usual")
        _check_positive(place, sigma_6=self.sigma_6, scatter=self.scatter, calibration=self.calibration)
        _check_positive(place, joints=self.joints, thickness_scatter=self.thickness_scatter)

    def __str__(self) -> str:
        return f"{self.name}, {super().__str__()}"

    __repr__ = as_call


@dataclass(frozen=True, kw_only=True)
class Unbound(Elastic):
    """Unbound granular material or a platform: elastic, and its allowable vertical strain ε_z = A NE^b.

    modulus: Pa. poisson: Poisson's ratio. name: in the catalogue. slope: b. constant: A under medium and heavy
    traffic, plain strain. constant_light: A under light traffic. constant_inverted: A of the granular layer of an
    inverted structure; None for a platform. source: where the numbers are from. caveats: what is not certain about
    them, a sentence each. Raises InputError.

    >>> soil = tl.catalogue.mixes["PF3"]
    >>> f"{soil.constant * 1e6**soil.slope * 1e6:.0f} microstrain"  # vertical, allowed by a million standard axles
    '559 microstrain'
    """

    name: str
    slope: float
    constant: float
    constant_light: float
    constant_inverted: float | None = None
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        place = f"unbound material {self.name!r}"
        if not -1 < self.slope < 0:
            raise InputError(f"{place}: slope must lie in (-1, 0), got {self.slope}; -0.222 is usual")
        constants = {
            "constant": self.constant,
            "constant_light": self.constant_light,
            "constant_inverted": self.constant_inverted,
        }
        _check_positive(place, **constants)
        for name, value in constants.items():
            if value is not None and value > 1:
                raise InputError(
                    f"{place}: {name} must be a plain strain below 1, got {value}; 12000 microstrain is 0.012"
                )

    def __str__(self) -> str:
        return f"{self.name}, {super().__str__()}"

    __repr__ = as_call


RoadMaterial = Mix | HydraulicMix | Unbound | UnboundByStress
"""What the catalogue of mixes holds."""


def _check_positive(place: str, **values: float | None) -> None:
    for name, value in values.items():
        if value is not None:
            positive(f"{place}: {name}", value, remedy="tl.catalogue.mixes shows what is usual")


def _increase(values: Sequence[float]) -> bool:
    return all(before < after for before, after in itertools.pairwise(values))


def _over_temperature(theta: float, temperatures: Sequence[float], moduli: Sequence[float]) -> float:
    """Modulus, linear between the tabulated ones; beyond them ln E is, so that it stays positive."""
    i, part = _segment(theta, temperatures)
    low, high = moduli[i], moduli[i + 1]
    return low + part * (high - low) if 0 <= part <= 1 else low * (high / low) ** part


def _power(f: float, frequencies: Sequence[float], moduli: Sequence[float]) -> float:
    """Modulus, with ln E linear in ln f between the tabulated ones and beyond."""
    if len(moduli) == 1:
        return moduli[0]
    i, part = _segment(math.log(f), [math.log(knot) for knot in frequencies])
    return float(moduli[i] * (moduli[i + 1] / moduli[i]) ** part)


def _segment(x: float, table: Sequence[float]) -> tuple[int, float]:
    """Number of the interval of the table that holds x, or is the nearest to it, and x as a part of it."""
    i = min(max(bisect.bisect_right(table, x) - 1, 0), len(table) - 2)
    return i, (x - table[i]) / (table[i + 1] - table[i])
