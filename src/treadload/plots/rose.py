"""Roses of crack traces, and bars of the directions of the cracks of several cases."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.projections.polar import PolarAxes

from treadload.composing import Source
from treadload.damage.cracks import HORIZONTAL, OBLIQUE_TOLERANCE, ORIENTATIONS, crack_rose, orientation
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import MICRO, fields_of
from treadload.plots.kit.style import INK, MUTED, ORIENTATION_COLOURS, PAPER, RULE, headline, plain, styled

_MOST_COLUMNS = 4
# Inches of one half circle, and letters in a line over it.
_WIDTH, _HEIGHT, _LETTERS = 2.5, 3.5, 26
# Shares that may be circles.
_ROUND = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0)
# A bar narrower than this part of the whole has no room for its number.
_NARROW = 0.055
# Road that extends by less than this part of the largest does not count unless the caller says so.
_SIGNIFICANT = 0.2
# From left to right in a bar.
_ORDER = ("longitudinal", "oblique", "transverse", "horizontal")
_TITLE: Any = {"x": 0.01, "ha": "left", "fontsize": 11.5, "fontweight": "bold"}


@styled
def trace_rose(roses: Source | Sequence[Source], labels: Sequence[str] | None = None) -> Figure:
    """Roses of crack traces: how much of the road cracks in which direction.

    roses: one or several, as `crack_rose` gives them. labels: a name each. Travel points to the right of the
    page and the right of travel down, as in the maps; a trace has no sense, so that half a circle holds all.
    The area of a wedge is the share of its class of angles, on one scale for all roses, so that the circles draw
    together outwards (equal-area rose, Nemec 1988). Its colour shows how the middle of the class runs, and the
    tinted sectors are those of the orientations. Horizontal cracks leave no trace; their share is written out.
    Returns the figure.
    Raises InputError for missing variables, or labels that do not match.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=x, y=y)
    >>> rose = tl.damage.crack_rose(tl.damage.envelope(response).isel(depth=0))
    >>> figure = tl.plots.trace_rose(rose, ["plate"])
    >>> figure.axes[0].get_title(loc="left")
    'plate'
    """
    cases = _cases(roses)
    names = _names(cases, labels)
    columns = min(len(cases), _MOST_COLUMNS)
    rows = math.ceil(len(cases) / columns)
    figure = new_figure(max(4.2, columns * _WIDTH + 0.2), rows * _HEIGHT + 0.6)
    panels = list(figure.subplots(rows, columns, squeeze=False, subplot_kw={"projection": "polar"}).ravel())
    circles = _circles(max(float(case["trace_share"].max()) for case in cases))
    for ax, case, name in zip(panels, cases, names, strict=False):
        _draw_rose(ax, case, circles)
        headline(ax, name, _aside(case), _LETTERS)
    for ax in panels[len(cases) :]:
        ax.set_visible(False)
    handles = [Patch(color=ORIENTATION_COLOURS[code], label=ORIENTATIONS[code]) for code in (1, 3, 2)]
    figure.legend(
        handles=handles, title=f"wedges and circles: {_share_of(cases)}", title_fontsize=9,
        loc="outside lower center", ncols=3, columnspacing=1.4, handlelength=1.4,
    )  # fmt: skip
    figure.suptitle("Traces of the cracks to expect", **_TITLE)
    return figure


@figure("Verdict", name="rose")
def rose_of(verdict: Source, *, threshold: float | None = None, classes: int = 18) -> Figure:
    """The rose of an assessment's cracks, by area of road.

    verdict: with extension_strain, crack_angle and crack_dip (y, x). threshold: strain beyond which road counts;
    a fifth of the largest if left out. classes: of the angles, see `crack_rose`. Returns the figure.
    """
    data = fields_of(verdict, "extension_strain", "crack_angle", "crack_dip")
    least = max(0.0, _SIGNIFICANT * float(data["extension_strain"].max())) if threshold is None else threshold
    tolerance = float(data.attrs.get("oblique_tolerance", OBLIQUE_TOLERANCE))
    return trace_rose(crack_rose(data, threshold=least, classes=classes, oblique_tolerance=tolerance))


@styled
def orientation_shares(
    roses: Sequence[Source], labels: Sequence[str], *, notes: Sequence[str] | None = None, title: str = ""
) -> Figure:
    """Bars of how the cracks of several cases run: longitudinal, oblique, transverse, horizontal.

    roses: as `crack_rose` gives them. labels: a name each. notes: words right of each bar, such as the largest
    extension. title: left out, a plain one. Returns the figure. Raises InputError as `trace_rose`.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=x, y=y)
    >>> rose = tl.damage.crack_rose(tl.damage.envelope(response).isel(depth=0))
    >>> figure = tl.plots.orientation_shares([rose], ["plate"])
    >>> f"{max(bar.get_width() for bar in figure.axes[0].patches):.0%} transverse"
    '100% transverse'
    """
    cases = _cases(roses)
    names = _names(cases, labels)
    if notes is not None and len(notes) != len(cases):
        raise InputError(f"give a note for each case: got {len(notes)} notes for {len(cases)} cases")
    figure = new_figure(7.4, 0.42 * len(cases) + 1.45)
    ax = figure.add_subplot()
    order = [w for w in _ORDER if w in _ORDER[:3] or any(_by_word(case).get(w, 0.0) > 0 for case in cases)]
    for row, case in enumerate(cases):
        start = 0.0
        shares = _by_word(case)
        for word in order:
            share = shares.get(word, 0.0)
            colour = ORIENTATION_COLOURS[ORIENTATIONS.index(word)]
            ax.barh(row, share, left=start, height=0.68, color=colour, edgecolor=PAPER, linewidth=0.8)
            if share >= _NARROW:
                ax.text(
                    start + share / 2, row, f"{100 * share:.0f} %", ha="center", va="center", color=PAPER,
                    fontsize=8.5, fontweight="bold",
                )  # fmt: skip
            start += share
        if start == 0:
            ax.text(0.01, row, "no crack beyond the threshold", va="center", color=MUTED, fontsize=8.5)
        if notes is not None:
            ax.text(1.015, row, plain(notes[row]), va="center", fontsize=8.5, clip_on=False)
    ax.set_yticks(range(len(cases)), [plain(name) for name in names])
    ax.set_xticks(np.linspace(0, 1, 6), [f"{k} %" for k in range(0, 101, 20)])
    ax.set_xlim(0, 1)
    ax.set_ylim(len(cases) - 0.5, -0.5)
    ax.tick_params(axis="y", length=0)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.set_xlabel(_share_of(cases))
    figure.legend(
        handles=[Patch(color=ORIENTATION_COLOURS[ORIENTATIONS.index(word)], label=word) for word in order],
        loc="outside lower center", ncols=len(order), columnspacing=1.4, handlelength=1.4,
    )  # fmt: skip
    figure.suptitle(plain(title or "How the cracks run"), **_TITLE)
    return figure


def _draw_rose(ax: PolarAxes, case: xr.Dataset, circles: Array) -> None:
    tolerance = float(case.attrs.get("oblique_tolerance", OBLIQUE_TOLERANCE))
    high = math.sqrt(float(circles[-1]))
    # Clockwise from the right of the page: right of travel is down.
    ax.set_theta_direction(-1)
    ax.set_thetamin(-90)
    ax.set_thetamax(90)
    ax.set_ylim(0, high)
    square = math.pi / 2
    between = square - 2 * tolerance
    sectors = [(0.0, 2 * tolerance, 1), (square, 2 * tolerance, 2), (-square, 2 * tolerance, 2)]
    sectors += [(square / 2, between, 3), (-square / 2, between, 3)]
    for middle, width, code in sectors:
        ax.bar(middle, high, width=width, color=ORIENTATION_COLOURS[code], alpha=0.09, linewidth=0, zorder=0.5)
    angles, shares = case["trace_angle"].to_numpy(), case["trace_share"].to_numpy()
    codes = orientation(angles, np.full(angles.shape, square), tolerance + 1e-9)
    style: dict[str, Any] = {
        "width": math.pi / len(angles), "color": [ORIENTATION_COLOURS[code] for code in codes],
        "edgecolor": PAPER, "linewidth": 0.7, "zorder": 2.5,
    }  # fmt: skip
    # A class at 90° lies half on either end of the half circle.
    for turn in (0.0, -math.pi):
        ax.bar(angles + turn, np.sqrt(shares), gid="wedges", **style)
    ax.set_yticks(np.sqrt(circles), [""] * len(circles))
    for share in circles:
        ax.annotate(
            f"{100 * share:g} %", (-square, math.sqrt(share)), xytext=(-4, 0), textcoords="offset points",
            ha="right", va="center", fontsize=8, color=MUTED,
        )  # fmt: skip
    ax.set_thetagrids([-90, -45, 0, 45, 90], ["", "45° left", "", "45° right", ""])
    ax.tick_params(axis="x", pad=5)
    ax.grid(color=RULE, linewidth=0.6, zorder=1)
    ax.spines["polar"].set(color=MUTED, linewidth=0.7)
    ax.annotate(
        "", (0, high), xytext=(22, 0), textcoords="offset points",
        arrowprops={"arrowstyle": "<|-,head_width=0.26,head_length=0.5", "color": INK, "lw": 1.3,
                    "shrinkA": 0, "shrinkB": 2},
    )  # fmt: skip
    ax.annotate("travel", (0, high), xytext=(26, 0), textcoords="offset points", va="center", ha="left", fontsize=8.5)


def _circles(largest: float) -> Array:
    """Shares of the circles: the last the first round one at or beyond the largest share, then its parts."""
    outer = next((share for share in _ROUND if share >= largest - 1e-9), 1.0) if largest > 0 else _ROUND[3]
    return outer * np.array([0.1, 0.4, 1.0])


def _aside(case: xr.Dataset) -> str:
    shares = _by_word(case)
    if sum(shares.values()) == 0:
        return "no crack that far"
    flat = shares.get(ORIENTATIONS[HORIZONTAL], 0.0)
    return f"and {100 * flat:.0f} % horizontal, without a trace" if flat >= 0.005 else " "


def _by_word(case: xr.Dataset) -> dict[str, float]:
    """Share of each orientation."""
    return dict(zip(map(str, case["orientation"].values), case["orientation_share"].values.tolist(), strict=True))


def _share_of(cases: Sequence[xr.Dataset]) -> str:
    weights = {str(case.attrs.get("weight", "area")) for case in cases}
    thresholds = {float(case.attrs.get("threshold", 0.0)) for case in cases}
    what = "share of the damage of a pass" if weights == {"damage"} else "share of the road with tensile strain"
    if len(thresholds) == 1 and (least := thresholds.pop()) > 0:
        what += f" beyond {least * MICRO:.3g} microstrain"
    return what


def _cases(roses: Source | Sequence[Source]) -> list[xr.Dataset]:
    listed = list(roses) if isinstance(roses, Sequence) else [roses]
    return [fields_of(rose, "trace_share", "trace_angle", "orientation_share", "orientation") for rose in listed]


def _names(cases: Sequence[xr.Dataset], labels: Sequence[str] | None) -> list[str]:
    names = list(labels) if labels is not None else [""] * len(cases)
    if not cases or len(names) != len(cases):
        raise InputError(f"give a label for each rose: got {len(names)} labels for {len(cases)} roses")
    return names
