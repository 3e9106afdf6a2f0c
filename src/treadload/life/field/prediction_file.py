"""Predicted ages in a text file: a section a line, a column for each age, sentences on how they were predicted."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from treadload.errors import InputError
from treadload.files import text_of, write_whole
from treadload.kernels.arrays import Array
from treadload.life.field.prediction import Predictions

_FIXED = ("section", "surface", "bottom")
# Of a column of a variant: what it is, and its value.
_VARIANT = re.compile(r"(.+) = ([-+.0-9e]+)")
_DIGITS = 6


def write_predictions(predictions: Predictions, path: str | os.PathLike[str]) -> Path:
    """Write predicted ages as a table of text that `read_predictions` takes. Returns the path. Raises WriteError.

    >>> import numpy as np
    >>> predictions = tl.life.Predictions(("A", "B"), np.array([8.0, 12.0]), np.array([30.0, 25.0]))
    >>> print(tl.life.write_predictions(predictions, "ages.csv").read_text(encoding="utf-8"))
    section;surface;bottom
    A;8;30
    B;12;25
    """
    columns: dict[str, Array] = {"surface": predictions.surface, "bottom": predictions.bottom}
    for what, by_value in predictions.variants.items():
        columns |= {f"{what} = {value:g}": ages for value, ages in by_value.items()}
    lines = [f"# {text}" for text in predictions.about]
    lines.append(";".join(["section", *columns]))
    for k, name in enumerate(predictions.sections):
        lines.append(";".join([name, *(f"{ages[k]:.{_DIGITS}g}" for ages in columns.values())]))
    return write_whole(Path(path), "\n".join(lines) + "\n")


def read_predictions(path: str | os.PathLike[str]) -> Predictions:
    """Predicted ages, years, from a file of `write_predictions`. Raises InputError that names file and line.

    >>> import numpy as np
    >>> predictions = tl.life.Predictions(("A", "B"), np.array([8.0, 12.0]), np.array([30.0, 25.0]))
    >>> path = tl.life.write_predictions(predictions, "ages.csv")
    >>> [f"{age:.0f} years" for age in tl.life.read_predictions(path).surface]
    ['8 years', '12 years']
    """
    file = Path(path)
    numbered = list(enumerate(text_of(file, "predicted ages").splitlines(), start=1))
    about = tuple(line[1:].strip() for _, line in numbered if line.startswith("#"))
    rows = [(number, line.split(";")) for number, line in numbered if line.strip() and not line.startswith("#")]
    if not rows or tuple(rows[0][1][:3]) != _FIXED:
        raise InputError(f"{file}: the first line must name the columns {';'.join(_FIXED)} and variants")
    heads = rows[0][1]
    values: list[list[float]] = []
    for number, row in rows[1:]:
        try:
            values.append([float(cell) for cell in row[1:]])
        except ValueError as error:
            raise InputError(f"{file}, line {number}: {error}; ages are numbers of years, or inf") from error
        if len(row) != len(heads):
            raise InputError(f"{file}, line {number}: {len(row)} values where the header has {len(heads)}")
    columns = np.array(values).reshape(-1, len(heads) - 1).T
    variants: dict[str, Mapping[float, Array]] = {}
    for head, ages in zip(heads[3:], columns[2:], strict=True):
        named = _VARIANT.fullmatch(head)
        if named is None:
            raise InputError(f"{file}: the column {head!r} is no variant; write it as 'what it is = value'")
        variants[named[1]] = {**variants.get(named[1], {}), float(named[2]): ages}
    names = tuple(row[0] for _, row in rows[1:])
    return Predictions(names, columns[0], columns[1], variants=variants, about=about)
