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


def conditions_of(law: object) -> str:
    """A line on what ties a law to tests or roads, and on the loading of these.

    law: also of another package; its class may have `calibrated`, a text, and `conditions`, a `LoadingConditions`.
    """
    ties = getattr(law, "calibrated", "")
    return "; ".join(filter(None, (ties, str(getattr(law, "conditions", UNSTATED)))))
