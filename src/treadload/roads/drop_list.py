"""What lists of drops share, falling weights and moving loads alike: labels, columns, and some of the rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar, Self

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.tables import real_array


class DropList:
    """What lists of drops share: labels and columns with a row for each drop. by_drop: names of the other arrays."""

    by_drop: ClassVar[tuple[str, ...]]

    def _settle(self, count: int, **values: object) -> None:
        """Keep checked values, and check labels, columns and thicknesses of so many drops. Raises InputError."""
        drops: Any = self
        values["station"] = checked_labels("station", drops.station, count) or tuple(map(str, range(1, count + 1)))
        if hasattr(drops, "section"):
            values["section"] = checked_labels("section", drops.section, count)
        for name in ("position", "temperature"):
            if (column := getattr(drops, name, None)) is not None:
                values[name] = checked_column(name, column, count)
        values["thickness"] = {
            name: checked_column(f"thickness of {name}", column, count, least=0.0)
            for name, column in drops.thickness.items()
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def rows(self, chosen: Sequence[int] | IntArray | BoolArray) -> Self:
        """Some of the drops, by number or by a mask."""
        drops: Any = self
        at = np.arange(len(drops))[np.asarray(chosen)]
        parts = {name: getattr(drops, name)[at] for name in self.by_drop}
        for name in ("position", "temperature"):
            if (column := getattr(drops, name, None)) is not None:
                parts[name] = column[at]
        if labels := getattr(drops, "section", ()):
            parts["section"] = tuple(labels[k] for k in at)
        parts["station"] = tuple(drops.station[k] for k in at)
        parts["thickness"] = {name: column[at] for name, column in drops.thickness.items()}
        whole: Self = replace(drops, **parts)
        return whole


def checked_labels(name: str, labels: Sequence[str], count: int) -> tuple[str, ...]:
    """Labels as texts, one for each drop, or (). Raises InputError."""
    texts = tuple(map(str, labels))
    if texts and len(texts) != count:
        raise InputError(f"{name} needs a label for each of {count} drops, got {len(texts)}")
    return texts


def checked_column(name: str, values: object, count: int, *, least: float | None = None) -> Array:
    """One value, or one for each drop, as (n,); those of a thickness at least 0. Raises InputError."""
    column = np.atleast_1d(real_array(values, name))
    if column.shape == (1,):
        column = np.full(count, column[0])
    if column.shape != (count,):
        raise InputError(f"{name} needs one value, or one for each of {count} drops, got {column.shape}")
    if least is not None and not (column >= least).all():
        wrong = ~(column >= least)
        raise InputError(
            f"{name} must be {least:g} m or more at every drop, 0 where it is absent, got {column[wrong][0]:g} at "
            f"drop {int(np.argmax(wrong)) + 1}"
        )
    return column
