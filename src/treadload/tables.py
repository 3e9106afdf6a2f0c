"""Numbers from text files: the separator and the decimal mark are recognised, or the file is refused.

A cell is a number, a word that states that there is none, or an error: what cannot be read never becomes a hole.
"""

from __future__ import annotations

import csv
import math
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from treadload.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

NO_DATA = ("NaN", "NA", "N/A", "NoData", "null")
"""Words of a cell without a value, in capitals or not; an empty cell is one, too."""

_NO_DATA = {"", *(word.casefold() for word in NO_DATA)}
_INFINITE = {sign + word for sign in ("", "+", "-") for word in ("inf", "infinity")}
_POWER = "(?:[eE][+-]?[0-9]+)?"
_NUMBER = re.compile(rf"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+){_POWER}")
_COMMA_NUMBER = re.compile(rf"[+-]?[0-9]*,[0-9]+{_POWER}")
_LOST_MARK = re.compile(rf"[+-]?0[0-9]+{_POWER}")
_WHOLE = re.compile("[+-]?[0-9]+")
_WITHOUT_MARK = re.compile(f"[+-]?[0-9]+{_POWER}")
_PART = re.compile(f"[0-9]+{_POWER}")
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2},[0-9]{3}")
_QUOTED = re.compile(r'"[^"]*"')
# What a spreadsheet writes for an error; no comment, though it starts like one.
_SPREADSHEET = re.compile(r"#(?:N/A|REF!|VALUE!|DIV/0!|NAME\?|NUM!|NULL!)", re.IGNORECASE)
# A blank stands before a unit, too.
_HEADING = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")
_IN_WORDS = {";": "semicolons", "\t": "tabs", ",": "commas", " ": "blanks"}

_Line = tuple[int, str]


@dataclass(frozen=True)
class Table:
    """Cells of a text file as they stand there.

    rows: the cells of each line, blanks around them cut off. lines: its number in the file. separator: ";", a tab,
    "," or " " between cells. decimal: "." or "," if the caller knows it.
    """

    path: Path
    rows: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]
    separator: str
    decimal: str | None = None

    @property
    def has_header(self) -> bool:
        """True if the first line holds names only: no number, and no word for a missing one."""
        return not any(_is_value(cell) for cell in self.rows[0])

    def values(
        self,
        columns: Sequence[int] | None = None,
        *,
        first: int = 0,
        name: Callable[[int], str] = lambda column: "the value",
    ) -> tuple[NDArray[np.float64], str]:
        """Numbers (rows, columns) from row `first` on, NaN where a cell is marked as missing, and what was
        recognised, in words.

        columns: places in the row, all if left out. name: of what stands in a column, for errors.
        Raises InputError that names line, row and column for anything else, for infinity, and for rows of
        different lengths.
        """
        # The command line reads no table and starts without numbers.
        import numpy as np

        width = len(self.rows[0])
        for line, row in zip(self.lines, self.rows, strict=True):
            if len(row) != width:
                first_row = "the header" if first else "the first row"
                raise InputError(f"{self.path}, line {line}: {len(row)} values where {first_row} has {width}")
        if self.separator == "," and self.decimal is None and not first:
            _check_commas(self)
        places = range(width) if columns is None else columns
        mark = self._decimal(places, first)
        numbers = np.empty((len(self.rows) - first, len(places)))
        for at in range(first, len(self.rows)):
            for k, column in enumerate(places):
                numbers[at - first, k] = self._number(at, column, mark, name)
        marks = "decimal commas" if mark == "," else "decimal points"
        return numbers, f"{_IN_WORDS[self.separator]} between cells, {marks}" if width > 1 else marks

    def _number(self, row: int, column: int, mark: str, name: Callable[[int], str]) -> float:
        cell = self.rows[row][column]
        written = cell.replace(",", ".") if mark == "," else cell
        if _NUMBER.fullmatch(written):
            value = float(written)
            if _LOST_MARK.fullmatch(written):
                why = f"is {cell!r}, with a zero in front; has it lost its decimal mark?"
            elif math.isinf(value):
                why = "is infinite"
            else:
                return value
        elif cell.casefold() in _NO_DATA:
            return math.nan
        elif cell.casefold() in _INFINITE:
            why = "is infinite"
        else:
            why = f"is {_shortened(cell)}, not a number; a cell without a value is empty or NaN"
        raise InputError(
            f"{self.path}, line {self.lines[row]}: {name(column)} {why} (row {row + 1}, column {column + 1})"
        )

    def _decimal(self, places: Sequence[int], first: int) -> str:
        """The decimal mark of the cells, one for all."""
        places_of: dict[str, tuple[int, int]] = {}
        thousands, whole = True, False
        for row in range(first, len(self.rows)):
            for column in places:
                cell = self.rows[row][column]
                if "," in cell:
                    places_of.setdefault(",", (row, column))
                    thousands = thousands and bool(_THOUSANDS.fullmatch(cell))
                elif "." in cell:
                    places_of.setdefault(".", (row, column))
                else:
                    whole = whole or cell.lstrip("+-").isdigit()
        shown = {
            mark: f"{_shortened(self.rows[row][column])} in line {self.lines[row]}"
            for mark, (row, column) in places_of.items()
        }
        if len(shown) == 2:
            raise InputError(
                f"{self.path} has a comma in {shown[',']} and a point in {shown['.']}; write decimal points or "
                "decimal commas throughout, and nothing between thousands"
            )
        used = next(iter(shown), self.decimal or ".")
        if self.decimal not in (None, used):
            raise InputError(f"{self.path} has {shown[used]}, and the decimal mark given is {self.decimal!r}")
        if used == "," and self.decimal is None and thousands and whole:
            raise InputError(
                f'{self.path} has {shown[","]}, a decimal number or thousands; write points, or give decimal=","'
            )
        return used


def read_table(path: str | os.PathLike[str], *, decimal: str | None = None) -> Table:
    """The cells of a text file.

    Semicolons, tabs, commas or blanks separate, the first of these that is there; commas may be decimal marks beside
    the others. decimal: "." or ",", where the file alone does not show it. Lines that start with # are comments.
    Raises InputError for a file that cannot be read, is empty, or can be read in two ways.
    """
    path = Path(path)
    if decimal not in (None, ".", ","):
        raise InputError(f'decimal must be "." or ",", got {decimal!r}')
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from error
    except ValueError as error:
        at = f" (byte {error.start})" if isinstance(error, UnicodeDecodeError) else ""
        raise InputError(f"cannot read {path}: it is not UTF-8 text{at}; save it as UTF-8") from error
    numbered = list(enumerate(re.split(r"\r\n|\r|\n", text), start=1))
    comments = [(number, line) for number, line in numbered if _is_comment(line)]
    kept = [(number, line) for number, line in numbered if line.strip(" \t") and not _is_comment(line)]
    if not kept:
        raise InputError(f"{path} holds no numbers: it is empty or all comments")
    separator = _separator([line for _, line in kept], decimal)
    rows = tuple(_split(path, number, line, separator) for number, line in kept)
    table = Table(path, rows, tuple(number for number, _ in kept), separator, decimal)
    _check_dropped(table, comments, numbered)
    return table


def _is_comment(line: str) -> bool:
    bare = line.lstrip()
    return bare.startswith("#") and not _SPREADSHEET.match(bare)


def _is_value(cell: str) -> bool:
    bare = cell.casefold()
    return bare in _NO_DATA | _INFINITE or bool(_NUMBER.fullmatch(bare) or _COMMA_NUMBER.fullmatch(bare))


def _is_heading(line: str) -> bool:
    return bool(re.match(r"\s*[A-Za-z_]", line)) and re.split("[ \t,;]", line.strip())[0].casefold() not in _NO_DATA


def _separator(lines: Sequence[str], decimal: str | None) -> str:
    bare = [_QUOTED.sub("", line).strip(" ") for line in lines]
    for mark in (";", "\t"):
        if any(mark in line for line in bare):
            return mark
    if decimal == "," or not any("," in line for line in bare):
        return " "
    named = _is_heading(bare[0])
    if decimal == "." or (named and "," in bare[0]):
        return ","
    # A comma with a digit on either side, in lines with blanks, is a decimal mark.
    body = bare[1:] if named else bare
    marks = not any(re.search(r"(?<![0-9]),|,(?![0-9])", line) for line in body)
    return " " if marks and any(" " in line for line in body) else ","


def _split(path: Path, number: int, line: str, separator: str) -> tuple[str, ...]:
    if separator == " ":
        bare = line.strip(" \t")
        return tuple(_HEADING.findall(bare) if _is_heading(bare) else re.split("[ \t]+", bare))
    if '"' not in line:
        return tuple(cell.strip(" \t") for cell in line.split(separator))
    try:
        cells: list[str] = next(csv.reader([line], delimiter=separator, strict=True, skipinitialspace=True))
    except (csv.Error, StopIteration) as error:
        raise InputError(f"{path}, line {number}: its quotation marks cannot be read: {error}") from error
    return tuple(cell.strip(" \t") for cell in cells)


def _check_dropped(table: Table, comments: Sequence[_Line], numbered: Sequence[_Line]) -> None:
    """Refuse comments and empty lines that may be lost rows."""
    width, (begin, end) = len(table.rows[0]), (table.lines[0], table.lines[-1])
    for number, line in comments:
        bare = line.lstrip()[1:]
        cells = () if '"' in bare else _split(table.path, number, bare, table.separator)
        row = len(cells) == width and any(cells) and all(_is_value(cell) for cell in cells)
        if row and (width > 1 or begin < number < end):
            raise InputError(
                f"{table.path}, line {number} reads like a row of numbers and is a comment; remove it, or its #"
            )
    if width == 1 and not table.has_header:
        for number, line in numbered:
            if begin < number < end and not line.strip(" \t"):
                raise InputError(f"{table.path}, line {number} is empty; write NaN where there is no value")


def _check_commas(table: Table) -> None:
    """Refuse whole numbers that may be decimal numbers: neighbours that look like what one writer leaves of them."""
    rows = [[None if cell.casefold() in _NO_DATA else cell for cell in row] for row in table.rows]
    if any(cell is not None and not _WITHOUT_MARK.fullmatch(cell) for row in rows for cell in row):
        return
    if _are_fixed(rows) or _are_trimmed(rows):
        pairs = ((at, pair) for at, row in enumerate(rows) for pair in pairwise(row) if _may_join(*pair))
        at, (before, behind) = next(pairs)
        raise InputError(
            f"{table.path}: '{before},{behind}' in line {table.lines[at]} may be two whole numbers or one with a "
            'decimal comma; give decimal="." for the first, or write semicolons between cells'
        )


def _may_join(before: str | None, behind: str | None) -> bool:
    return bool(before and behind and _WHOLE.fullmatch(before) and _PART.fullmatch(behind))


def _mantissa(cell: str) -> str:
    return cell.lower().partition("e")[0].lstrip("+-")


def _are_fixed(rows: Sequence[Sequence[str | None]]) -> bool:
    """True if all numbers are pairs with as many digits behind each comma, or as a rule more than before any."""
    if len({row.count(None) for row in rows}) > 1:
        return False
    pairs: list[tuple[str | None, str | None]] = []
    for row in rows:
        for missing, run in groupby(row, key=lambda cell: cell is None):
            cells = [] if missing else list(run)
            if len(cells) % 2:
                return False
            pairs += zip(cells[::2], cells[1::2], strict=True)
    if not pairs or not all(_may_join(*pair) for pair in pairs):
        return False
    # Whole numbers next to each other are alike. Nothing but zeros is zero either way.
    digits = sorted(len(_mantissa(behind or "")) for _, behind in pairs)
    alike = digits[0] == digits[-1] or digits[len(digits) // 2] > max(len(before or "") for before, _ in pairs)
    return alike and any(cell != "0" for pair in pairs for cell in pair)


def _are_trimmed(rows: Sequence[Sequence[str | None]]) -> bool:
    """True if pairs, as many in each line, leave numbers of N digits but for zeros cut off at the end.

    One in ten numbers of N digits ends in a zero, one in a hundred in two; whole numbers lack more of them.
    """
    numbers = sum(cell is not None for row in rows for cell in row)
    lengths = [[len(_mantissa(cell or "").lstrip("0")) for cell in row] for row in rows]
    # Cells that join with the one before: nothing is cut off of a fraction that ends in a zero.
    joins = [
        [False, *(_may_join(*pair) and not _mantissa(pair[1] or "").endswith("0") for pair in pairwise(row))]
        for row in rows
    ]
    total, longest = sum(map(sum, lengths)), max(map(max, lengths))
    if not total or not all(map(any, joins)):
        return False
    # Half as many numbers as cells at least, so more digits cannot be filled.
    for digits in range(longest, int(2 * total / numbers + 0.5 + 2 / numbers) + 1):
        pairs = min(_most_pairs(*row, digits) for row in zip(lengths, joins, strict=True))
        left = numbers - pairs * len(rows)
        if pairs and digits * left - total <= left / 2 + 1:
            return True
    return False


def _most_pairs(lengths: Sequence[int], joins: Sequence[bool], digits: int) -> int:
    """The most neighbours in a row that join to numbers of no more than so many digits."""
    pairs, free = 0, True
    for at in range(1, len(lengths)):
        if free and joins[at] and lengths[at - 1] + lengths[at] <= digits:
            pairs, free = pairs + 1, False
        else:
            free = True
    return pairs


def _shortened(cell: str) -> str:
    return repr(cell if len(cell) <= 30 else f"{cell[:27]}...")


def real_array(values: object, what: str) -> NDArray[np.float64]:
    """An array of real numbers as float64; masked values are NaN.

    Raises InputError, naming what it is, for text, complex numbers, truth values, and lists of unequal lengths.
    """
    import numpy as np

    try:
        array = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan) if np.ma.isMA(values) else np.asarray(values)
        if array.dtype.kind in "iuf" or (
            array.dtype.kind == "O" and all(isinstance(item, int | float | np.number) for item in array.flat)
        ):
            return np.array(array, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{what} must be an array of numbers: {' '.join(str(error).split())}") from error
    raise InputError(f"{what} must be an array of numbers, got values of type {array.dtype}")


def finite_list(values: object, what: str, unit: str = "") -> NDArray[np.float64]:
    """One-dimensional finite numbers, at least one; a number is a list of one.

    Raises InputError, naming what it is and the unit, as in "rad", and what of it is wrong.
    """
    import numpy as np

    array = np.atleast_1d(real_array(values, what))
    expected = f"{what} must be a list of finite numbers{f' in {unit}' if unit else ''}, at least one"
    if array.ndim != 1 or array.size == 0:
        raise InputError(f"{expected}, got shape {array.shape}")
    if not np.isfinite(array).all():
        raise InputError(f"{expected}, got {array[~np.isfinite(array)][0]}")
    return array
