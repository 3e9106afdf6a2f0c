"""Values of rows in the characters of a page."""

from __future__ import annotations

import re

from treadload.plots.kit.style import thousands
from treadload.rows import Row
from treadload.units import times_power_of_ten
from treadload.us_units import sentence_in_display_units

# A number such as 1.2e+05 in a sentence.
_POWER = re.compile(r"\d+(?:\.\d+)?e[+-]?\d+")
_MINUS = re.compile(r"(?<![\w-])-(?=[\d.])")
_WHOLE = re.compile(r"\d{5,}")


def typeset(row: Row, *, bare: bool = False) -> str:
    """A row's value in the characters of a page: powers of ten, thousands, a true minus. bare: without its unit."""
    text = row.number if bare else row.text
    text = with_powers(text)
    if isinstance(row.value, str):
        return text
    return thousands(float(text)) if _WHOLE.fullmatch(text) else with_minus(text)


def typeset_text(text: str) -> str:
    """A text with its numbers in the units of display and in the characters of a page."""
    return with_minus(with_powers(sentence_in_display_units(text)))


def with_powers(text: str) -> str:
    """A text of numbers with powers of ten: 1.2×10⁵ in place of 1.2e+05.

    >>> with_powers("6.04e+06 load repetitions")
    '6.04×10⁶ load repetitions'
    """
    return _POWER.sub(lambda match: times_power_of_ten(match[0]), text)


def with_minus(text: str) -> str:
    """A text of numbers with true minus signs; hyphens inside words stay."""
    return _MINUS.sub("\u2212", text)
