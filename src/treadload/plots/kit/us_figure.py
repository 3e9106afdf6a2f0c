"""A finished figure in the units of display: its axes, colour bars and texts, whichever function drew it.

A figure is drawn in the SI units of its labels; here the ticks are set where they are round in US units, and every
number with a unit is shown in its US unit. Data stay where they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import (
    FixedFormatter,
    FixedLocator,
    Formatter,
    FuncFormatter,
    Locator,
    MaxNLocator,
    NullLocator,
)

from treadload.kernels.arrays import Array
from treadload.us_units import AxisUnit, axis_in_display_units, in_us_units, sentence_in_display_units

_MINUS = "\u2212"


def show_in_display_units(figure: Figure) -> None:
    """Show a figure in the units of display; in SI it stays as it is. One that is shown in US units already stays."""
    if not in_us_units():
        return
    for ax in figure.findobj(Axes):
        assert isinstance(ax, Axes)
        for axis in ax._axis_map.values():
            _show_axis(axis)
    for text in texts_of(figure):
        text.set_text(sentence_in_display_units(text.get_text()))


def texts_of(figure: Figure) -> Iterator[Text]:
    """The texts of a figure without those of its axes' ticks: titles, labels, annotations, legends."""
    waiting: list[Artist] = [figure]
    while waiting:
        artist = waiting.pop()
        if isinstance(artist, Text):
            yield artist
        if isinstance(artist, Axis):
            yield artist.label
        else:
            waiting += artist.get_children()


def _show_axis(axis: Axis) -> None:
    """Ticks and label of an axis in the units of display."""
    low, high = axis.get_view_interval()
    label, unit = axis_in_display_units(axis.get_label_text(), max(abs(low), abs(high)))
    axis.set_label_text(label)
    locator, formatter = axis.get_major_locator(), axis.get_major_formatter()
    if isinstance(locator, FixedLocator) and not _has_numbers(formatter):
        # Ticks with texts of their own stay in their places.
        texts = [formatter(at, k) for k, at in enumerate(locator())]
        shown = [_text(text, unit) for text in texts]
        if shown != texts:
            axis.set_major_formatter(FixedFormatter(shown))
        return
    # Axes that share their limits share their ticks.
    if unit is None or isinstance(locator, _RoundTicks):
        return
    if isinstance(locator, FixedLocator):
        locator = MaxNLocator(max(len(locator()) - 1, 1))
    axis.set_major_locator(_RoundTicks(locator, unit))
    axis.set_major_formatter(_Numbers(formatter, unit))
    minor = axis.get_minor_locator()
    if type(minor).__name__ == "LogLocator":
        axis.set_minor_locator(_RoundTicks(minor, unit))
        axis.set_minor_formatter(_Numbers(axis.get_minor_formatter(), unit))
    elif isinstance(minor, FixedLocator):
        axis.set_minor_locator(NullLocator())


def _has_numbers(formatter: Formatter) -> bool:
    """True for a formatter that writes any number, False for texts that were given with their ticks."""
    is_list = isinstance(formatter, FuncFormatter) and isinstance(formatter.func, partial)
    return not (is_list or isinstance(formatter, FixedFormatter))


def _text(text: str, unit: AxisUnit | None) -> str:
    """The text of a tick, which may be a bare number where the axis has a unit."""
    if unit is None:
        return sentence_in_display_units(text)
    try:
        return f"{unit.number(float(text.replace(_MINUS, '-'))):.4g}"
    except ValueError:
        return sentence_in_display_units(text)


class _Shown:
    """An axis as its ticks are to see it: with limits in the US unit."""

    def __init__(self, axis: Axis, unit: AxisUnit) -> None:
        self._axis, self._unit = axis, unit

    def __getattr__(self, name: str) -> object:
        return getattr(self._axis, name)

    def get_view_interval(self) -> Array:
        return np.array([self._unit.number(value) for value in self._axis.get_view_interval()])

    def get_data_interval(self) -> Array:
        return np.array([self._unit.number(value) for value in self._axis.get_data_interval()])

    def get_minpos(self) -> float:
        return self._unit.number(self._axis.get_minpos())


class _RoundTicks(Locator):
    """Ticks where another locator sets them in the US unit."""

    def __init__(self, locator: Locator, unit: AxisUnit) -> None:
        self._locator, self._unit = locator, unit

    def set_axis(self, axis: object) -> None:
        super().set_axis(axis)  # type: ignore[arg-type]
        self._locator.set_axis(_Shown(axis, self._unit) if isinstance(axis, Axis) else None)  # type: ignore[arg-type]

    def __call__(self) -> Sequence[float]:
        assert self.axis is not None
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin: float, vmax: float) -> Sequence[float]:
        numbers = self._locator.tick_values(self._unit.number(vmin), self._unit.number(vmax))
        return np.array([self._unit.value(number) for number in numbers])  # type: ignore[return-value]


class _Numbers(Formatter):
    """Numbers as another formatter writes them, in the US unit."""

    def __init__(self, formatter: Formatter, unit: AxisUnit) -> None:
        self._formatter, self._unit = formatter, unit

    def set_axis(self, axis: object) -> None:
        super().set_axis(axis)  # type: ignore[arg-type]
        self._formatter.set_axis(_Shown(axis, self._unit) if isinstance(axis, Axis) else None)  # type: ignore[arg-type]

    def set_locs(self, locs: list[float]) -> None:
        super().set_locs(locs)
        self._formatter.set_locs([self._unit.number(value) for value in locs])

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self._formatter(self._unit.number(x), pos)

    def get_offset(self) -> str:
        return self._formatter.get_offset()
