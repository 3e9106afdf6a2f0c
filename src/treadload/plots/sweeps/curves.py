"""Results of a study against one of its inputs: curves, panels of them, the slip curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter
from matplotlib.typing import ColorType

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.shown import Shown, numbers, shown
from treadload.plots.kit.style import (
    CASES,
    INK,
    MUTED,
    headline,
    legend_below,
    open_axes,
    sequential,
    styled,
)
from treadload.plots.sweeps.reading import View, main_readings
from treadload.plots.sweeps.scales import is_logarithmic, logarithmic_tick, solid
from treadload.plots.sweeps.titles import LETTERS, capital, under

# Lines of one figure, and of how many a legend tells each.
_LINES, _IN_LEGEND = 12, 6
# A range that spans so much is drawn in its logarithms where those are asked for.
_DECADES = 3.0
# Panels of a figure.
_PANELS = 6
# Share of sliding friction from which its limit is drawn.
_NEAR = 0.5


# Results of one page in curves, and inputs that they are drawn against.
_CURVES, _AGAINST = 4, 4


def _against_inputs(data: xr.Dataset) -> Iterator[Drawing]:
    """Panels of the main results, for each input."""
    view = View.of(data)
    names = main_readings(view, _CURVES)
    inputs = [*view.numeric, *(name for name in view.inputs if view.data[name].dtype.kind not in "fiu")]
    lines = (
        "A line for each value of a second input, the others in their middle" if view.is_product else "A dot a case"
    )
    for name in inputs[:_AGAINST] if names else ():
        yield Drawing(
            {"of": names, "against": name},
            f"Against {shown(view.data[name], name).words}",
            f"{lines}; crosses mark cases that failed.",
        )


def _slips(data: xr.Dataset) -> bool:
    try:
        slip_input(View.of(data))
    except InputError:
        return False
    return True


@figure("Sweep", name="curve")
@styled
def study_curve(
    study: Source,
    of: str,
    against: str = "",
    *,
    by: str | None = None,
    at: Mapping[str, object] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """A result of every case against one input, a line for each value of another; dots where cases were sampled.

    study: a Sweep or its dataset. of: name of the result. against: of the input; left out, that of most values. by:
    another input, or a dimension of the result such as depth; left out, the next input; "" for none. at: name → value
    of what is varied besides, SI, the nearest of which is drawn; left out, the middle one. ax: axes to draw into.
    Cases that failed leave gaps, a cross at the foot, and are counted. Returns the figure. Raises InputError.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> study = tl.sweep(case, {"normal_load": ["50 N", "100 N"]})
    >>> line = tl.plots.study_curve(study, "largest_pressure").axes[0].lines[0]
    >>> [f"{pressure:.0f} kPa" for pressure in line.get_ydata()]
    ['116 kPa', '148 kPa']
    """
    view = View.of(study)
    figure, ax = figure_and_axes(ax, 6.4, 4.1)
    handles, of_lines = _draw(ax, view, of, against, by, at)
    if of_lines is not None:
        _legend(ax, handles, of_lines)
    return figure


@figure(
    "Sweep", name="curves", title="Against an input", wide=True, order=0, when=_against_inputs
)  # fmt: skip
@styled
def study_curves(
    study: Source,
    of: Sequence[str] = (),
    against: str = "",
    *,
    by: str | None = None,
    at: Mapping[str, object] | None = None,
) -> Figure:
    """Panels of `study_curve`: several results against one input.

    of: names of results, six at most; left out, the first of those that differ between the cases. Returns the figure.
    Raises InputError.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> study = tl.sweep(case, {"normal_load": ["50 N", "100 N"]})
    >>> figure = tl.plots.study_curves(study, ["largest_pressure", "net_area"])
    >>> [ax.get_ylabel() for ax in figure.axes[:2]]
    ['peak pressure (kPa)', 'net contact area (mm²)']
    """
    view = View.of(study)
    names = list(of) or list(view.readings()[:_PANELS])
    if not names or len(names) > _PANELS:
        raise InputError(
            f"panels show 1 to {_PANELS} results, got {len(names)}; name some of {_listed(view.readings())}"
        )
    columns = min(len(names), 3 if len(names) in (3, 5, 6) else 2)
    rows = -(-len(names) // columns)
    figure = new_figure(3.7 * columns + 0.6, 3.35 * rows + 0.4)
    axes = figure.subplots(rows, columns, squeeze=False)
    by_words: dict[str, tuple[list[Line2D], Shown]] = {}
    for number, panel in enumerate(axes.flat):
        if number < len(names):
            handles, of_lines = _draw(panel, view, names[number], against, by, at, letters=34)
            if of_lines is not None:
                by_words.setdefault(of_lines.words, (handles, of_lines))
        else:
            panel.set_visible(False)
    if by_words:
        handles, of_lines = next(iter(by_words.values()))
        thinned = _thinned(handles)
        legend = figure.legend(handles=thinned, loc="outside lower center", ncols=len(thinned), title=of_lines.words)
        legend.get_title().set_fontsize(8.5)
    return figure


@figure(
    "Sweep", name="slip_curve", title="Slip curve", order=1,
    caption="Shear force over friction times load, against creepage.", when=_slips,
)  # fmt: skip
@styled
def study_slip_curve(
    study: Source, *, by: str | None = None, at: Mapping[str, object] | None = None, ax: Axes | None = None
) -> Figure:
    """Shear force over friction times load, Q/μP, against creepage, both as solved, a line for each of another input.

    study: a Sweep or its dataset that varies a creepage or a force. by, at: as in `study_curve`. Returns the figure.
    Raises InputError where neither was varied.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> study = tl.sweep(case, {"creepage_x": [0.0, 0.01]})
    >>> tl.plots.study_slip_curve(study).axes[0].get_ylabel()
    'Q/μP: shear force over friction × load (–)'
    """
    view = View.of(study)
    along, varied = slip_input(view)
    force = view.reading("tractive_force" if along == "x" else "lateral_force")
    creepage, friction, load = (view.reading(name) for name in (f"creepage_{along}", "friction", "normal_load"))
    share = (force / (friction * load)).rename("share")
    second = _by(view, share, varied, by)
    index, notes = view.chosen(share, [varied, *([second] if second else [])], at)
    figure, ax = figure_and_axes(ax, 6.4, 4.1)
    handles = []
    for look, label, place in _lines(view, second, share):
        x, y = (numbers(points.isel({**index, **place})) for points in (creepage, share))
        order = np.argsort(x)
        handles += ax.plot(x[order], y[order], "o-" if view.is_product else "o", ms=3.4, label=label, color=look)
    shares = np.concatenate([line.get_ydata() for line in handles])
    # A limit that no wheel comes near would squeeze the curves.
    for limit in (side for side in (-1.0, 1.0) if np.nanmax(side * shares) > _NEAR):
        ax.axhline(limit, color=MUTED, lw=0.8, ls=(0, (4, 2)))
        ax.annotate("whole contact slides", (0.99, limit), xycoords=("axes fraction", "data"), xytext=(0, 2),
                    textcoords="offset points", ha="right", va="bottom", fontsize=8, color=MUTED)  # fmt: skip
    ax.axhline(0, color=MUTED, lw=0.7)
    ax.axvline(0, color=MUTED, lw=0.7)
    open_axes(ax)
    ax.set_xlabel(f"creepage along {along} (–)")
    ax.set_ylabel("Q/μP: shear force over friction × load (–)")
    where = "negative creepage drives" if along == "x" else "force of the road, to the right"
    headline(ax, "Slip curve", under([*notes, where, view.counted()]))
    if second:
        _legend(ax, handles, shown(view.data[second], second))
    return figure


def slip_input(view: View) -> tuple[str, str]:
    """Along which axis a study slips, and the dimension that varies it. Raises InputError."""
    keys = {str(view.data[name].attrs["key"]): str(view.data[name].dims[0]) for name in view.numeric}
    for name, along in (
        ("creepage_x", "x"), ("creepage_y", "y"), ("tractive_force", "x"), ("lateral_force", "y"),
    ):  # fmt: skip
        if f"rolling.{name}" in keys:
            return along, keys[f"rolling.{name}"]
    raise InputError(
        "a slip curve needs a study that varies rolling.creepage_x, rolling.creepage_y or a force; this one varies "
        f"{', '.join(view.inputs)}"
    )


def _draw(
    ax: Axes,
    view: View,
    of: str,
    against: str,
    by: str | None,
    at: Mapping[str, object] | None,
    letters: int = LETTERS,
) -> tuple[list[Line2D], Shown | None]:
    """Lines of a result, and what distinguishes them; None where there is one."""
    field = view.reading(of)
    along = view.input(against) if against else next(iter((*view.numeric, *view.inputs)))
    dim = str(view.data[along].dims[0]) if view.data[along].dims else ""
    if dim not in field.dims or len(view.data[along].dims) != 1:
        raise InputError(f"{of} is not over {along}; take another input of {', '.join(view.inputs)}")
    if not view.is_product and view.data[along].dims != (along,):
        _dots(ax, view, field, along, by, at, letters)
        return [], None
    second = _by(view, field, along, by)
    index, notes = view.chosen(field, [dim, *([second] if second else [])], at)
    x, ticks = _axis(view.data[along])
    what, across = shown(field, of), shown(view.data[along], along)
    handles: list[Line2D] = []
    for number, (look, label, place) in enumerate(_lines(view, second, field)):
        values = what.factor * numbers(field.isel({**index, **place}))
        drawn = np.where(np.isfinite(values) & ((values > 0) | (not what.logarithmic)), values, np.nan)
        handles += ax.plot(
            across.factor * x, drawn, ls="" if ticks else "-", marker="o", ms=3.4 if len(x) < 40 else 0,
            color=look, label=label,
        )  # fmt: skip
        _cross(ax, across.factor * x[view.failed({**index, **place})], look, number)
    if ticks:
        ax.set_xticks(x, ticks, rotation=0 if max(map(len, ticks)) * len(ticks) < 48 else 20, ha="center")
        ax.margins(x=0.15)
    elif is_logarithmic(x):
        ax.set_xscale("log")
    _finish(ax, what, across, numbers(field))
    headline(ax, capital(what.words), under([*notes, view.counted()], letters), letters)
    return handles, shown(view.data[second], second) if second else None


def _dots(
    ax: Axes,
    view: View,
    field: xr.DataArray,
    along: str,
    by: str | None,
    at: Mapping[str, object] | None,
    letters: int,
) -> None:
    """A result of cases that stand in a list, against one of their inputs, coloured by another."""
    (dim,) = map(str, view.data[along].dims)
    index, notes = view.chosen(field, [dim], at)
    what, across = shown(field), shown(view.data[along], along)
    x, ticks = _axis(view.data[along])
    values = what.factor * numbers(field.isel(index))
    second = next((name for name in view.inputs if name != along), "") if by is None else by and view.input(by)
    small: dict[str, Any] = {"s": 18 if len(x) < 300 else 7, "linewidths": 0}
    good = np.isfinite(values)
    if second and view.data[second].dtype.kind in "fiu":
        how = shown(view.data[second], second)
        dots = ax.scatter(
            (across.factor * x)[good], values[good], c=how.factor * numbers(view.data[second])[good],
            cmap=solid("pressure"), **small,
        )  # fmt: skip
        bar = (ax.get_figure(root=True) or ax.figure).colorbar(dots, ax=ax, label=how.label, pad=0.015)
        bar.outline.set_visible(False)
    elif second:
        names = view.data[second].to_numpy().astype(str)
        for number, name in enumerate(dict.fromkeys(names)):
            here = good & (names == name)
            ax.scatter((across.factor * x)[here], values[here], color=CASES[number % len(CASES)], label=name, **small)
        ax.legend(title=shown(view.data[second], second).words)
    else:
        ax.scatter((across.factor * x)[good], values[good], color=CASES[0], **small)
    _cross(ax, across.factor * x[view.failed({})], INK)
    if ticks:
        ax.set_xticks(range(len(ticks)), ticks)
    _finish(ax, what, across, values)
    headline(ax, capital(what.words), under([*notes, view.counted()], letters), letters)


def _finish(ax: Axes, what: Shown, across: Shown, values: np.ndarray) -> None:
    open_axes(ax)
    ax.set_xlabel(across.label)
    endless = bool(np.isposinf(values).any())
    # Of lines that are drawn: others may lie decades away.
    drawn = [np.asarray(line.get_ydata(), dtype=float) for line in ax.get_lines() if line.get_marker() != "x"]
    seen = np.concatenate(drawn) if drawn else values
    positive = seen[np.isfinite(seen) & (seen > 0)]
    if what.logarithmic and positive.size and positive.max() > _DECADES * positive.min():
        ax.set_yscale("log")
        near = positive.max() < 100 * positive.min()
        ax.yaxis.set_major_locator(LogLocator(10, subs=(1.0, 2.0, 5.0) if near else (1.0,)))
        ax.yaxis.set_major_formatter(FuncFormatter(logarithmic_tick))
        ax.yaxis.set_minor_formatter(NullFormatter())
    else:
        ax.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 2.5, 5, 10]))
    ax.set_ylabel(f"{what.label}{', gaps: without end' if endless else ''}")


def _lines(view: View, second: str, field: xr.DataArray) -> list[tuple[ColorType, str, dict[str, int]]]:
    """Colour, label and place of every line; of more than a figure holds evenly some."""
    if not second:
        return [(CASES[0], "", {})]
    count = field.sizes[second]
    shown_ones = np.unique(np.linspace(0, count - 1, min(count, _LINES)).round().astype(int))
    axis = view.data[second]
    how = shown(axis, second)
    ordered = axis.dtype.kind in "fiu" and len(shown_ones) > 2
    colours = sequential("pressure")
    lines: list[tuple[ColorType, str, dict[str, int]]] = []
    for number, place in enumerate(shown_ones):
        colour = colours(0.25 + 0.75 * number / (len(shown_ones) - 1)) if ordered else CASES[number % len(CASES)]
        value = axis.to_numpy()[place]
        lines.append((colour, how.number(value.item() if hasattr(value, "item") else value), {second: int(place)}))
    return lines


def _legend(ax: Axes, handles: Sequence[Line2D], how: Shown) -> None:
    thinned = _thinned(handles)
    if len(handles) > 3 or max(len(str(handle.get_label())) for handle in thinned) > 14:
        legend_below(ax, thinned, columns=min(3, len(thinned)))
    else:
        ax.legend(handles=thinned)
    legend = ax.get_legend()
    assert legend is not None
    legend.set_title(how.words)
    legend.get_title().set_fontsize(8.5)


def _thinned(handles: Sequence[Line2D]) -> list[Line2D]:
    """As many lines as a legend shows, evenly of all."""
    most = min(len(handles), _IN_LEGEND)
    return [handles[k] for k in np.unique(np.linspace(0, len(handles) - 1, most).round().astype(int))]


def _by(view: View, field: xr.DataArray, along: str, by: str | None) -> str:
    """The dimension that distinguishes the lines; empty for a single line."""
    if by is not None:
        name = by if not by or by in field.dims else view.input(by)
        if name and (name not in field.dims or name == along):
            raise InputError(f"lines cannot be distinguished by {by}; take {_listed([str(d) for d in field.dims])}")
        return name
    if not view.is_product:
        return ""
    free = [str(dim) for dim in field.dims if dim != along and field.sizes[dim] > 1]
    varied = [dim for dim in free if dim in view.dims]
    return next(iter([*varied, *(dim for dim in free if field.sizes[dim] <= _IN_LEGEND)]), "")


def _axis(axis: xr.DataArray) -> tuple[np.ndarray, list[str]]:
    """Places on an axis, and texts for them where it has no numbers."""
    if axis.dtype.kind in "fiu":
        return numbers(axis), []
    names = [str(text) for text in axis.to_numpy()]
    distinct = list(dict.fromkeys(names))
    return np.array([distinct.index(name) for name in names], dtype=float), distinct


def _cross(ax: Axes, x: np.ndarray, colour: object, number: int = 0) -> None:
    """Crosses at the foot of the axes where cases of a line failed, those of the next line above."""
    if x.size:
        ax.plot(x, np.full(x.shape, 0.025 + 0.032 * number), "x", ms=4.5, mew=1.2, color=colour, clip_on=False,
                transform=ax.get_xaxis_transform(), zorder=5)  # fmt: skip


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:12]) or "none"
