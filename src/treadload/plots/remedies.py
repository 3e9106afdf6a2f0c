"""What would help a road, as a tornado: years of the road and of every criterion after each remedy."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullFormatter

from treadload.composing import Source
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import INK, headline, legend_below, measure, plain, styled

_LONGER, _SHORTER = "#0b6fae", "#d55e00"
_LETTERS, _MOST = 34, 24
# A panel whose longest bar is this many times its shortest has a logarithmic axis.
_FAR = 8.0
# Years beyond which a bar ends.
_LONG = 1000.0
# Times as long at most as a bar shows of criteria that last longer than that.
_MOST_TIMES = 100.0


@figure(
    "Remedies", name="tornado", main=True, title="What would help", wide=True,
    caption="Years of the road, and by every criterion, after each change by one step; bars begin at the years of "
    "the road as it is. Each was solved again. A criterion that lasts more than 1000 years is drawn by how many "
    "times as long it lasts.",
)  # fmt: skip
@styled
def remedy_tornado(remedies: Source) -> Figure:
    """Bars from the years of the road as it is to those after each remedy: of the road, and by every criterion.

    remedies: a Remedies or its dataset. The best and the worst are drawn where there are more than 24. Returns the
    figure. Raises InputError if variables are missing, and where there is no remedy.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> answer = tl.life.remedies(design, life, tl.life.RemedySteps(only=("thickness",)))
    >>> [label.get_text() for label in tl.plots.remedy_tornado(answer).axes[0].get_yticklabels()]
    ['2 cm more asphalt']
    """
    data = fields_of(remedies, "remedy_years", "road_years", "life_years")
    if not data.sizes["remedy"]:
        raise InputError("no remedy applies, so that there is nothing to draw")
    count = data.sizes["remedy"]
    if count > _MOST:
        data = data.isel(remedy=[*range(_MOST // 2), *range(count - _MOST // 2, count)])
    names = [textwrap.fill(plain(str(name)), _LETTERS) for name in data["remedy"].to_numpy()]
    criteria = [str(name) for name in data["criterion"].to_numpy()]
    before, after = data["life_years"].to_numpy(), data["remedy_years"].to_numpy()
    panels = [("Road", float(before.min()), data["road_years"].to_numpy())]
    if len(criteria) > 1:
        panels += [(name, float(before[k]), after[:, k]) for k, name in enumerate(criteria)]
    figure = new_figure(3.2 + 1.9 * len(panels), 1.7 + 0.27 * len(names))
    axes = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    rows = np.arange(float(len(names)))[::-1]
    for ax, (title, start, ends) in zip(axes, panels, strict=True):
        far = start > _LONG
        if far:
            _panel(ax, rows, 1.0, _times(ends, start), _factor)
        else:
            _panel(ax, rows, start, np.minimum(ends, _LONG), _number)
        ax.set_xlabel("times as long" if far else "service life (years)")
        headline(ax, textwrap.fill(title, 20), _years(start))
    axes[0].set_yticks(rows, names)
    axes[0].set_ylim(-0.6, len(names) - 0.4)
    handles: list[Artist] = [Patch(color=_LONGER, label="longer"), Patch(color=_SHORTER, label="shorter")]
    legend_below(axes[0], handles, columns=2)
    return figure


def _panel(ax: Axes, rows: Array, start: float, ends: Array, words: Callable[[float], str]) -> None:
    """Bars from a start to their ends. words: of the number at an end."""
    low, high = min(float(ends.min()), start), max(float(ends.max()), start)
    log = high > _FAR * low > 0
    ax.barh(
        rows, ends - start, left=start, height=0.66, color=[_LONGER if end >= start else _SHORTER for end in ends]
    )
    ax.axvline(start, color=INK, lw=0.9)
    if log:
        ax.set_xscale("log")
        ax.set_xlim(low / (high / low) ** 0.25, high * (high / low) ** 0.3)
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())
    else:
        wide = max(high - low, 0.02 * start)
        ax.set_xlim(max(low - 0.3 * wide, 0.0), high + 0.35 * wide)
        ax.xaxis.set_major_locator(MaxNLocator(3))
    for row, end in zip(rows, ends, strict=True):
        if abs(end - start) < 5e-3 * start:
            continue
        side = 1 if end >= start else -1
        ax.annotate(
            words(end), (end, row), xytext=(3 * side, 0), textcoords="offset points", va="center",
            ha="left" if side > 0 else "right", fontsize=7.5,
        )  # fmt: skip
    ax.tick_params(axis="y", length=0)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.grid(True, axis="x")


def _times(years: Array, start: float) -> Array:
    """Years over those at the start, at most `_MOST_TIMES` or one over it; 1 where neither ends."""
    with np.errstate(invalid="ignore"):
        factor: Array = np.nan_to_num(years / start, nan=1.0, posinf=_MOST_TIMES)
    return factor.clip(1 / _MOST_TIMES, _MOST_TIMES)


def _factor(times: float) -> str:
    bound = "> " if times >= _MOST_TIMES else "< " if times <= 1 / _MOST_TIMES else ""
    return f"{bound}× {measure(times)}"


def _number(years: float) -> str:
    return f"> {_LONG:g}" if years >= _LONG or math.isinf(years) else measure(years)


def _years(years: float) -> str:
    return f"as it is {_number(years)} years"
