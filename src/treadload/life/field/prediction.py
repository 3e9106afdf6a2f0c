"""Ages that the mechanics predict for the sections of a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.life.field.table import SectionTable

HARDENING = "hardening of the fatigue line"
"""What the mechanics leave open at the surface: 0 is the line of a young mix, 1 that of old cores."""


@dataclass(frozen=True, eq=False)
class Predictions:
    """Predicted ages of sections: years until Miner's sum is 1.

    sections: names (n,). surface, bottom: ages at the surface and at the bottom of the asphalt (n,), years; inf where
    no damage is done. parts: further numbers of each section by name (n,), such as the share of thermal stress.
    variants: ages at the surface by what the mechanics leave open, such as the hardening of the line, and its values.
    about: sentences on how they were predicted.

    >>> from pathlib import Path
    >>> folder = Path(tl.catalogue.__file__).parent / "data"
    >>> predictions = tl.life.read_predictions(folder / "field_tables" / "ltpp_predicted.csv")
    >>> f"{len(predictions.sections)} sections"
    '149 sections'
    """

    sections: tuple[str, ...]
    surface: Array
    bottom: Array
    parts: Mapping[str, Array] = field(default_factory=dict)
    variants: Mapping[str, Mapping[float, Array]] = field(default_factory=dict)
    about: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name, ages in (("surface", self.surface), ("bottom", self.bottom)):
            if np.shape(ages) != (len(self.sections),):
                raise InputError(
                    f"predicted ages at the {name} must be one for each of {len(self.sections)} sections, got shape "
                    f"{np.shape(ages)}"
                )
            if not np.all(np.asarray(ages) > 0):
                raise InputError(f"predicted ages at the {name} must be positive years, got {np.min(ages):g}")

    def of(self, table: SectionTable) -> Predictions:
        """The predictions of the sections of a table, in its order. Raises InputError for one that is missing."""
        places = {name: k for k, name in enumerate(self.sections)}
        missing = [name for name in table.sections if name not in places]
        if missing:
            raise InputError(
                f"{len(missing)} of {len(table)} sections have no predicted age, {missing[0]!r} first; predict them, "
                "or leave the predictions out"
            )
        rows = np.array([places[name] for name in table.sections])
        parts = {name: np.asarray(values)[rows] for name, values in self.parts.items()}
        variants = {
            name: {value: np.asarray(ages)[rows] for value, ages in by_value.items()}
            for name, by_value in self.variants.items()
        }
        return Predictions(
            table.sections, np.asarray(self.surface)[rows], np.asarray(self.bottom)[rows], parts, variants, self.about
        )
