"""How much the inputs of a life scatter: fatigue, thickness, moduli, traffic, temperature."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from treadload.errors import InputError

# Coefficients of variation and deviations beyond which a number is in another unit: 30 % of a modulus is much.
_MOST_SHARE, _MOST_THICKNESS, _MOST_DEGREES, _MOST_FATIGUE = 1.0, 0.2, 20.0, 3.0


@dataclass(frozen=True)
class Scatter:
    """Standard deviations of what a life depends on.

    fatigue: SN, of log₁₀ of the passes that a law allows, of all laws or by the name of a criterion; left out, that
    of each law, else of the mix that it judges. thickness: Sh, m, of all asphalt together, whose layers change in
    proportion, or by the name of a layer; left out, by the rule of the French method. moduli: coefficient of
    variation of the modulus of every layer, each on its own, or by the name of a layer. traffic: coefficient of
    variation of the passes. temperature: of the whole year, K. modulus_correlation: of the logarithms of two moduli,
    (layer, layer, correlation) for each pair that has one, as a backcalculation states them; both layers stand in
    `moduli` by name.
    Thickness and temperature are normal, moduli, traffic and fatigue lognormal about what the life took. Raises
    InputError.
    """

    fatigue: float | Mapping[str, float] | None = None
    thickness: float | Mapping[str, float] | None = None
    moduli: float | Mapping[str, float] = 0.0
    traffic: float = 0.0
    temperature: float = 0.0
    modulus_correlation: tuple[tuple[str, str, float], ...] = ()

    def __post_init__(self) -> None:
        for layer, neighbour, correlation in self.modulus_correlation:
            if not isinstance(self.moduli, Mapping) or not {layer, neighbour} <= set(self.moduli):
                raise InputError(
                    f"the correlation of {layer!r} and {neighbour!r} needs the scatter of both moduli by name"
                )
            if layer == neighbour or not -1 < correlation < 1:
                raise InputError(
                    f"the correlation of {layer!r} and {neighbour!r} must lie in (-1, 1) and join two layers, got "
                    f"{correlation:g}"
                )
        for name, most, unit, hint in (
            ("fatigue", _MOST_FATIGUE, "", "SN is 0.25 to 0.3 for bituminous mixes, 1 for treated layers"),
            ("thickness", _MOST_THICKNESS, " m", "25 mm is 0.025"),
            ("moduli", _MOST_SHARE, "", "10 % is 0.1"),
            ("traffic", _MOST_SHARE, "", "15 % is 0.15"),
            ("temperature", _MOST_DEGREES, " K", "1 to 2 K is usual"),
        ):
            entry = getattr(self, name)
            for key, value in entry.items() if isinstance(entry, Mapping) else [("", entry)]:
                if value is not None and not (math.isfinite(value) and 0 <= value <= most):
                    of = f" of {key!r}" if key else ""
                    raise InputError(
                        f"the scatter of {name}{of} must lie in [0, {most:g}]{unit}, got {value}; {hint}"
                    )


def check_risks(risks: Sequence[float]) -> tuple[float, ...]:
    """Risks, rising, each once. Raises InputError for one that is not in (0, 1)."""
    levels = tuple(sorted({float(risk) for risk in risks}))
    if not levels:
        raise InputError("a reliability needs at least one risk, got none; 5 % is 0.05")
    wrong = next((risk for risk in levels if not 0 < risk < 1), None)
    if wrong is not None:
        raise InputError(
            f"a risk must lie between 0 and 1, got {wrong:g}: no thickness and no year makes failure impossible or "
            "certain; 5 % is 0.05"
        )
    return levels
