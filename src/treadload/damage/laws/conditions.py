"""For which loading a law was calibrated, as its source states it: frequency, temperature, kind of load, rest."""

from __future__ import annotations

from dataclasses import dataclass

NOT_STATED = "not stated"


@dataclass(frozen=True)
class LoadingConditions:
    """The loading behind the numbers of a law, in words; "not stated" where its source does not state it.

    frequency, temperature: of the tests. control: whether strain or stress was held. rest: periods between loads.
    """

    frequency: str = NOT_STATED
    temperature: str = NOT_STATED
    control: str = NOT_STATED
    rest: str = NOT_STATED

    def __str__(self) -> str:
        parts = {
            "frequency": self.frequency,
            "temperature": self.temperature,
            "controlled strain or stress": self.control,
            "rest periods": self.rest,
        }
        silent = [name for name, text in parts.items() if text == NOT_STATED]
        stated = [f"{name}: {text}" for name, text in parts.items() if text != NOT_STATED]
        return "; ".join([*stated, *([f"{', '.join(silent)}: {NOT_STATED}"] if silent else [])])


UNSTATED = LoadingConditions()
CATALOGUE = LoadingConditions(
    frequency="25 Hz",
    temperature="10 °C",
    control="two-point bending of trapezoids at constant displacement (NF P 98-261-1, now in NF EN 12697-24)",
    rest="none, a continuous sine (the same)",
)
"""Tests behind ε₆ of the mixes of the catalogue.

Frequency and temperature are those of the source of the numbers. The publisher's summary of NF P 98-261-1 (2001),
which NF EN 12697-24 was made to replace, states the rest: isosceles trapezoids clamped at their base, bent by a
continuous sine of constant displacement until conventional failure, which gives the slope of the line and the strain
that allows 10⁶ cycles, ε₆.
"""
BY_MODULUS = LoadingConditions(
    frequency="none of its own: through E, the modulus at the frequency of the load",
    temperature="none of its own: through E",
)
"""Laws with the modulus of the mix in them, which carries frequency and temperature."""


def conditions_of(law: object) -> str:
    """A line on what ties a law to tests or roads, what it takes of a cycle, and on the loading of its tests.

    law: also of another package; its class may have `calibrated`, a text, and `conditions`, a `LoadingConditions`.
    """
    tests = getattr(law, "tested_under", None)
    ties = "by tests of the layer's mix, without a shift to the road" if tests else getattr(law, "calibrated", "")
    conditions = tests or getattr(law, "conditions", UNSTATED)
    cycle = "amplitude and mean" if hasattr(law, "allowable_cycles") else "peak"
    return "; ".join(filter(None, (ties, f"evaluates each cycle by its {cycle}", str(conditions))))
