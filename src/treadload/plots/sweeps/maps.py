"""Results of a study over two of its inputs, and its fields as small multiples."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import Colormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.plan import edges, limits
from treadload.plots.kit.shown import Shown, numbers, shown
from treadload.plots.kit.style import INK, MUTED, RULE, figure_of, halo, headline, ink_on, measure, sequential, styled
from treadload.plots.sweeps.reading import PLANE, View, main_readings, place_in_words
from treadload.plots.sweeps.scales import is_logarithmic, logarithmic_tick, solid
from treadload.plots.sweeps.titles import capital, under

# Maps of small multiples, across and down.
_ACROSS, _DOWN = 5, 4
# Part of the largest value below which a field is not looked at when maps are cut to what they show.
_LEAST = 0.02
# Values of a map that are written into it.
_WRITTEN = 64


# Results and fields of one page in maps.
_MAPS, _FIELDS = 2, 2


def _main_maps(data: xr.Dataset) -> Iterator[Drawing]:
    view = View.of(data)
    for name in main_readings(view, _MAPS) if len(view.numeric) > 1 else ():
        yield Drawing({"of": name}, capital(shown(view.reading(name), name).words))


def _fields(data: xr.Dataset) -> Iterator[Drawing]:
    fields = [str(name) for name, variable in data.data_vars.items() if {"x", "y"} <= set(variable.dims)]
    for name in fields[:_FIELDS]:
        yield Drawing({"of": name}, capital(shown(data[name], name).words))


@figure(
    "Sweep", name="map", title="Over two inputs", order=2,
    caption="Over the two inputs of most values; what is varied besides is at its middle value.",
    when=_main_maps,
)  # fmt: skip
@styled
def study_map(
    study: Source,
    of: str,
    x: str = "",
    y: str = "",
    *,
    at: Mapping[str, object] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """A result over two inputs, in colour; dots where cases were sampled.

    study: a Sweep or its dataset. of: name of the result. x, y: of inputs that are numbers; left out, those of most
    values. at: name → value of what is varied besides, SI; left out, the middle. Passes and years have a logarithmic
    scale; cases that failed are crossed out. Returns the figure. Raises InputError.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> study = tl.sweep(case, {"normal_load": ["50 N", "100 N"], "friction": [0.5, 0.7]})
    >>> tl.plots.study_map(study, "largest_pressure").axes[0].get_xlabel()
    'normal load (kN)'
    """
    view = View.of(study)
    field = view.reading(of)
    first, second = _pair(view, x, y)
    dims = tuple(dict.fromkeys(str(view.data[name].dims[0]) for name in (first, second)))
    if len(dims) == 1 and dims[0] not in field.dims:
        raise InputError(f"{of} is not over {first} and {second}")
    index, notes = view.chosen(field, dims, at)
    sheet = field.isel(index)
    what = shown(field, of)
    across, up = shown(view.data[first], first), shown(view.data[second], second)
    values = what.factor * numbers(sheet.transpose(*dims[::-1]))
    figure, ax = figure_and_axes(ax, 6.2, 4.3)
    norm = _norm(what, values)
    colours = solid("strain" if what.unit == "microstrain" else "pressure")
    seen = np.where(np.isfinite(values), values, np.nan)
    x_values, y_values = (how.factor * numbers(view.data[name]) for how, name in ((across, first), (up, second)))
    failed = view.failed(index)
    if len(dims) == 1:
        good = np.isfinite(seen)
        drawn: Any = ax.scatter(
            x_values[good], y_values[good], c=seen[good], cmap=colours, norm=norm, s=30 if len(seen) < 300 else 11,
            linewidths=0.3, edgecolors=RULE,
        )  # fmt: skip
        ax.plot(x_values[failed], y_values[failed], "x", ms=5, color=INK, mew=1.1)
        ax.grid(True)
    else:
        failed = failed.T if list(dims) == [d for d in view.dims if d in dims] else failed
        drawn = _cells(ax, x_values, y_values, seen, failed, colours, norm, what)
    bar = figure_of(ax).colorbar(drawn, ax=ax, label=what.label, pad=0.015, aspect=28)
    if isinstance(norm, LogNorm):
        bar.locator = LogLocator(10, subs=(1.0,) if np.nanmax(seen) > 100 * np.nanmin(seen) else (1.0, 2.0, 5.0))
        bar.formatter = FuncFormatter(logarithmic_tick)
        bar.minorformatter = NullFormatter()
        bar.update_ticks()
    bar.outline.set(edgecolor=RULE, linewidth=0.7)
    ax.set_xlabel(across.label)
    ax.set_ylabel(up.label)
    ax.spines[["top", "right"]].set_visible(False)
    headline(ax, capital(what.words), under([*notes, view.counted()]))
    return figure


def _cells(
    ax: Axes, x: np.ndarray, y: np.ndarray, values: np.ndarray, failed: np.ndarray, colours: Colormap,
    norm: Normalize, what: Shown,
) -> QuadMesh:  # fmt: skip
    """Cells of a product, each with its number where there are few, else with lines of equal values."""
    columns, rows = np.argsort(x), np.argsort(y)
    x, y, values, failed = x[columns], y[rows], values[np.ix_(rows, columns)], failed[np.ix_(rows, columns)]
    across, up = (
        np.exp(edges(np.log(values), 1.0)) if is_logarithmic(values) else edges(values, max(abs(values[0]), 1.0))
        for values in (x, y)
    )
    mesh = ax.pcolormesh(across, up, np.ma.masked_invalid(values), cmap=colours, norm=norm, rasterized=True)
    for row, column in zip(*np.nonzero(failed), strict=True):
        ax.add_patch(
            Rectangle(
                (across[column], up[row]), across[column + 1] - across[column], up[row + 1] - up[row],
                fill=False, hatch="xxx", edgecolor=MUTED, lw=0,
            )
        )  # fmt: skip
    if values.size <= _WRITTEN:
        for row, column in np.ndindex(*values.shape):
            if np.isfinite(values[row, column]):
                ax.text(x[column], y[row], _number(values[row, column], what), ha="center", va="center", fontsize=8,
                        color=ink_on(mesh.cmap(norm(values[row, column]))))  # fmt: skip
    elif np.isfinite(values).all():
        lines = ax.contour(x, y, values, colors=INK, linewidths=0.7, norm=norm, levels=7)
        for text in ax.clabel(lines, fontsize=8, fmt=lambda value: _number(value, what)):
            text.set_path_effects([*halo(2)])
    for scale, centres in ((ax.set_xscale, x), (ax.set_yscale, y)):
        if is_logarithmic(centres):
            scale("log")
    return mesh


@figure(
    "Sweep", name="multiples", title="Fields", wide=True, order=3,
    caption="In plan, one colour scale for all cases shown.", when=_fields,
)  # fmt: skip
@styled
def study_multiples(
    study: Source, of: str, across: str = "", down: str = "", *, at: Mapping[str, object] | None = None
) -> Figure:
    """A field of every case in plan: small maps on one scale, an input across the page, another down.

    study: a Sweep or its dataset with a field over y and x. of: its name. across, down: inputs; left out, those of
    most values. at: name → value of depths and of what is varied besides, SI. Of more than 5 x 4 cases evenly some
    are shown. Returns the figure. Raises InputError for what is no field.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> study = tl.sweep(case, {"normal_load": ["50 N", "100 N"]}, fields=["pressure"])
    >>> figure = tl.plots.study_multiples(study, "pressure")
    >>> [f"{ax.collections[0].get_array().max():.0f} kPa" for ax in figure.axes[:2]]
    ['116 kPa', '148 kPa']
    """
    view = View.of(study)
    field = view.reading(of)
    if not set(PLANE) <= set(field.dims):
        over = ", ".join(map(str, field.dims))
        raise InputError(f"maps are drawn of a field over y and x, {of} is over {over}; draw its curve")
    first, second = _two(view, across, down)
    dims = [first, *([second] if second else [])]
    index, chosen = view.chosen(field, [*dims, *PLANE], at)
    columns, rows = _spread(field.sizes[first], _ACROSS), _spread(field.sizes[second], _DOWN) if second else [0]
    maps = {
        (row, column): np.asarray(
            field.isel({**index, first: column, **({second: row} if second else {})}).transpose(*PLANE).to_numpy()
        )
        for row in rows
        for column in columns
    }
    what = shown(field, of)
    scale = limits(*(what.factor * sheet for sheet in maps.values()))
    box = _box(np.stack([np.nan_to_num(np.abs(sheet)) for sheet in maps.values()]).max(axis=0))
    x, y = (1e3 * numbers(view.data[dim]) for dim in ("x", "y"))
    x_edges, y_edges = edges(x[box[1]]), edges(y[box[0]])
    size = 10.4 / max(3, len(columns))
    high = size * min(2.2, max(0.45, float(np.ptp(y_edges) / np.ptp(x_edges))))
    figure = new_figure(size * len(columns) + 1.2, high * len(rows) + 1.5, layout="compressed")
    axes = figure.subplots(len(rows), len(columns), squeeze=False, sharex=True, sharey=True)
    failed = view.failed(index)
    order = [dim for dim in view.dims if dim in dims]
    mesh = None
    for (r, row), (c, column) in ((a, b) for a in enumerate(rows) for b in enumerate(columns)):
        ax, values = axes[r, c], what.factor * maps[row, column][box]
        ax.set_aspect("equal")
        place = tuple({first: column, second: row}[dim] for dim in order)
        if np.isfinite(values).any():
            drawn = ax.pcolormesh(
                x_edges, y_edges, np.ma.masked_invalid(values), vmin=scale.low, vmax=scale.high, rasterized=True,
                cmap=sequential("strain" if what.unit == "microstrain" else "pressure"),
            )  # fmt: skip
            mesh = mesh or drawn
        else:
            ax.text(0.5, 0.5, "failed" if failed[place] else "not solved", transform=ax.transAxes, ha="center",
                    va="center", color=MUTED)  # fmt: skip
        ax.set_xlim(x_edges[0], x_edges[-1])
        ax.set_ylim(y_edges[-1], y_edges[0])
        if r == 0:
            ax.set_title(
                place_in_words(view.data[first], column, first), fontsize=9, fontweight="normal", loc="center"
            )
        if c == 0:
            ax.set_ylabel((f"{place_in_words(view.data[second], row, second)}\n" if second else "") + "y (mm)")
        if r == len(rows) - 1:
            ax.set_xlabel("x, travel (mm)")
    if mesh is not None:
        bar = figure.colorbar(mesh, ax=axes, label=what.label, extend=scale.extend, pad=0.01, aspect=34)
        bar.outline.set(edgecolor=RULE, linewidth=0.7)
    notes = under([*chosen, view.counted(view.data["status"])], 90)
    figure.suptitle(capital(what.words), x=0.01, ha="left", fontsize=11.5, fontweight="bold")
    if notes:
        figure.supxlabel(notes, x=0.01, ha="left", fontsize=8.5, color=MUTED)
    return figure


def _pair(view: View, x: str, y: str) -> tuple[str, str]:
    """Two inputs that are numbers. Raises InputError."""
    fixed = [view.input(name) for name in (x, y) if name]
    wrong = next((name for name in fixed if name not in view.numeric), None)
    free = [name for name in view.numeric if name not in fixed]
    needed = 2 - len(fixed)
    if wrong is not None or len(free) < needed or len(set(fixed)) < len(fixed):
        raise InputError(
            f"a map needs two inputs that are numbers and have several values; this study has "
            f"{', '.join(view.numeric) or 'none'}"
        )
    first = view.input(x) if x else free.pop(0)
    return first, view.input(y) if y else free.pop(0)


def _two(view: View, across: str, down: str) -> tuple[str, str]:
    """Dimensions of small multiples: one or two."""
    fixed = [str(view.data[view.input(name)].dims[0]) for name in (across, down) if name]
    free = sorted((dim for dim in view.dims if dim not in fixed), key=lambda dim: -view.data.sizes[dim])
    first = fixed.pop(0) if across else free.pop(0)
    second = fixed.pop(0) if down else next((dim for dim in free if view.data.sizes[dim] > 1), "")
    return first, second


def _norm(what: Shown, values: np.ndarray) -> Normalize:
    finite = values[np.isfinite(values)]
    if what.logarithmic and (finite > 0).any() and finite.max() > 3 * finite[finite > 0].min():
        return LogNorm(float(finite[finite > 0].min()), float(finite.max()))
    if not finite.size:
        return Normalize(0.0, 1.0)
    low, high = float(finite.min()), float(finite.max())
    return Normalize(low, high if high > low else low + 1.0)


def _number(value: float, what: Shown) -> str:
    if what.logarithmic and abs(value) >= 1e4:
        return f"{value:.1e}".replace("e+0", "e").replace("e+", "e")
    return f"{value:.2g}" if abs(value) < 1 else measure(value).replace("-", "\u2212")


def _spread(count: int, most: int) -> list[int]:
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int)).tolist()  # type: ignore[no-any-return]


def _box(largest: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns in which something is to be seen, with one more on each side."""
    seen = largest > _LEAST * largest.max()
    if not seen.any():
        return slice(None), slice(None)
    spans = []
    for axis in (1, 0):
        places = np.flatnonzero(seen.any(axis=axis))
        spans.append(slice(max(0, int(places[0]) - 1), int(places[-1]) + 2))
    return spans[0], spans[1]
