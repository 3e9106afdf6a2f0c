"""What one case of a study gave: a record that JSON and arrays can hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from sys import intern
from typing import Any, TypedDict

import numpy as np

Values = tuple[tuple[str, ...], Any]
"""Dimensions of an array, and the array."""


class RecordTable(TypedDict, total=False):
    """A record as JSON holds it."""

    number: int
    seconds: float
    numbers: dict[str, object]
    coordinates: dict[str, list[float | str]]
    warnings: list[str]
    failure: str
    fields: list[str]


@dataclass(frozen=True, eq=False)
class Record:
    """What a case gave, or why it failed.

    number: of the case in its design. seconds: that it took. numbers: name → small arrays, kept of every case.
    fields: name → arrays that were asked for. coordinates: of their dimensions. warnings: sentences. failure: why it
    failed, None if it did not.
    """

    number: int
    seconds: float
    numbers: Mapping[str, Values] = field(default_factory=dict)
    fields: Mapping[str, Values] = field(default_factory=dict)
    coordinates: Mapping[str, np.ndarray] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    failure: str | None = None

    def to_json(self) -> dict[str, object]:
        """Everything but the fields."""
        used = {dim for dims, _ in self.numbers.values() for dim in dims}
        return {
            "number": self.number,
            "seconds": round(self.seconds, 6),
            **({} if self.failure is None else {"failure": self.failure}),
            **({"warnings": list(self.warnings)} if self.warnings else {}),
            # A number without dimensions stands alone.
            "numbers": {
                name: [list(dims), np.asarray(array).tolist()] if dims else np.asarray(array).tolist()
                for name, (dims, array) in self.numbers.items()
            },
            "coordinates": {dim: self.coordinates[dim].tolist() for dim in sorted(used)},
            "fields": list(self.fields),
        }

    @classmethod
    def from_json(cls, document: RecordTable) -> Record:
        """The record without its fields. Raises KeyError, TypeError and ValueError for anything else."""
        return cls(
            int(document["number"]),
            float(document["seconds"]),
            {intern(name): _values(value) for name, value in document["numbers"].items()},
            coordinates={str(dim): np.array(values) for dim, values in document["coordinates"].items()},
            warnings=tuple(map(str, document.get("warnings", ()))),
            failure=None if document.get("failure") is None else str(document["failure"]),
        )


def _values(value: object) -> Values:
    """A number without dimensions, which takes less memory than an array, or dimensions and an array."""
    if not isinstance(value, list):
        return (), value
    dims, array = value
    # Of journals that give every number its dimensions.
    return tuple(intern(dim) for dim in dims), np.array(array) if dims else array
