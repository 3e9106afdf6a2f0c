"""Roads side by side under one tire: bonded against debonded, cold against hot."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.layers import Layers, draw_interfaces, name_layers
from treadload.plots.kit.places import load_centre
from treadload.plots.kit.plan import MICRO, MM, Limits, colour_bar, fields_of, limits
from treadload.plots.kit.section import Section, draw_section
from treadload.plots.kit.style import CASES, INK, headline, measure, plain, signed, styled
from treadload.plots.profile import COMPONENTS, Component, draw_profile, frame_profile, nearest

# Width of a section's panel, by the panels in a row, and of the profile's, inches; letters of a line over a panel.
_PANEL = {1: 5.5, 2: 3.7, 3: 3.0}
_PROFILE = 2.9
_LETTERS = 32
# Letters of a layer's name beside its bars.
_NAME = 26
# A section flatter than this stands below the next one, not beside it.
_FLAT = 0.45


@styled
def compare_roads(
    responses: Sequence[Source],
    labels: Sequence[str],
    *,
    along: str | None = None,
    at: float | None = None,
    strain: Component | None = None,
    place: float | None = None,
) -> Figure:
    """Vertical sections of several roads on one colour scale, beside them one strain of all against depth.

    responses: of the same load, with principal_strain_1 and principal_direction_1 over (depth, y, x), two depths or
    more; `both_sides` shows what happens at an interface. labels: a name each. along, at: the section, as for
    `depth_slice`. strain: of the profile, "xx", "yy", "zz", "in-plane" or "principal"; if left out
    the horizontal one in the section. place: of the profile along the section, m; if left out under the centre of
    the first road's load. Returns the figure, microstrain.
    Raises InputError for missing variables, sections in different directions or labels that do not match.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> thick = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.25), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> responses = [tl.solve_response(plate, r, depths=[0.02, 0.15], x=x, y=y) for r in (road, thick)]
    >>> figure = tl.plots.compare_roads(responses, ["150 mm", "250 mm"])
    >>> [ax.get_title(loc="left") for ax in figure.axes[:2]]
    ['150 mm', '250 mm']
    """
    if not responses or len(responses) != len(labels):
        raise InputError(f"give a label for each road: got {len(labels)} labels for {len(responses)} roads")
    sections = [Section.of(response, along, at) for response in responses]
    first = sections[0]
    if any(section.name != first.name for section in sections):
        raise InputError("the roads' sections must all lie along travel or all across it; give along=...")
    component = _component(strain or ("xx" if first.name == "x" else "yy"))
    position = place if place is not None else _under_load(responses[0], first.data, first.name)
    scale = limits(*(section.values for section in sections))
    aspect = max(section.aspect for section in sections)
    columns = 1 if aspect < _FLAT else 2 if len(sections) in (2, 4) else min(len(sections), 3)
    rows = math.ceil(len(sections) / columns)
    panel = _PANEL[columns]
    height = rows * (panel * min(aspect, 2.0) + 1.0)
    figure = new_figure(columns * (panel + 0.4) + _PROFILE + 2.3, max(height, 3.4), "compressed")
    grid = figure.add_gridspec(rows, columns + 1, width_ratios=[*[panel] * columns, _PROFILE])
    panels: list[Axes] = []
    for number, (section, label) in enumerate(zip(sections, labels, strict=True)):
        row, column = divmod(number, columns)
        ax = figure.add_subplot(grid[row, column])
        mesh = draw_section(ax, section, scale)
        headline(ax, label, "largest tensile strain " * (columns == 1) + _in_numbers(section, scale), _LETTERS)
        if column:
            ax.set_ylabel("")
        if row < rows - 1 and number + columns < len(sections):
            ax.set_xlabel("")
        panels.append(ax)
    # Beside one flat section there is room for the unit only.
    words = "microstrain" if columns == 1 else "largest tensile strain (microstrain)"
    colour_bar(mesh, panels[columns - 1], words, scale)
    ax = figure.add_subplot(grid[:, columns])
    if rows == 1:
        ax.set_box_aspect(aspect * panel / _PROFILE)
    _, title, words = COMPONENTS[component]
    _profiles(ax, [s.data for s in sections], labels, CASES, component, (first.name, position))
    axis = f"{first.name} = {signed(position * MM)} mm"
    headline(ax, title, f"{words} under {axis}", 30)
    ax.set_ylabel("")
    figure.legend(
        handles=[
            Line2D([], [], color=CASES[k % len(CASES)], lw=2, label=plain(label)) for k, label in enumerate(labels)
        ],
        loc="outside lower right", ncols=min(len(labels), 3),
    )  # fmt: skip
    return figure


@styled
def compare_temperatures(
    responses: Sequence[Source],
    temperatures: Sequence[float],
    *,
    strain: Component = "principal",
    place: tuple[float, float] | None = None,
) -> Figure:
    """Strain against depth of one road at several temperatures, and the largest strain in each of its layers.

    responses: of the same load, with the strain over (depth, y, x), two depths or more. temperatures: °C, one
    each, in any order. strain: "xx", "yy", "zz", "in-plane" or "principal". place: x and y of the profile, m; if
    left out under the centre of the first road's load. The largest strain is that of all the response's points.
    Returns the figure, microstrain. Raises InputError for missing variables or temperatures that do not match.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> warm = tl.Pavement([tl.Layer(tl.Elastic(2e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> responses = [tl.solve_response(plate, r, depths=[0.02, 0.15], x=x, y=y) for r in (road, warm)]
    >>> figure = tl.plots.compare_temperatures(responses, [10.0, 30.0])
    >>> [f"{line.get_xdata().max():.0f} microstrain" for line in figure.axes[0].lines[:2]]
    ['269 microstrain', '522 microstrain']
    """
    if not responses or len(responses) != len(temperatures):
        raise InputError(f"give a temperature for each response: got {len(temperatures)} for {len(responses)}")
    if not np.isfinite(temperatures).all():
        raise InputError(f"temperatures must be finite numbers of °C, got {list(temperatures)}")
    name, title, words = COMPONENTS[_component(strain)]
    order = np.argsort(temperatures, kind="stable")
    data = [fields_of(responses[k], name, "depth").sortby("depth") for k in order]
    degrees = [float(temperatures[k]) for k in order]
    if any(case.sizes.get("depth", 1) < 2 for case in data):
        raise InputError("a profile needs at least two depths; solve the responses at more depths")
    x, y = place if place is not None else _worst_place(data[-1], name)
    colours, labels = _warmth(degrees), [f"{signed(t, 0 if t == round(t) else 1)} °C" for t in degrees]
    peaks = [_largest_in_layers(case, name) for case in data]
    height = max(4.6, 0.22 * len(degrees) * len(peaks[0]) + 1.4)
    figure = new_figure(9.6, min(height, 12.0))
    left, right = figure.subplots(1, 2, width_ratios=[1.15, 1.0])
    here = [case.isel(y=[nearest(case, "y", y)]) for case in data]
    _profiles(left, here, labels, colours, strain, ("x", x))
    point = here[0].isel(x=nearest(here[0], "x", x), y=0)
    at = f"x = {signed(float(point['x']) * MM)}, y = {signed(float(point['y']) * MM)} mm"
    headline(left, f"{title}, by temperature", f"{words} at {at}", 34)
    _bars(right, peaks, labels, colours)
    headline(right, "Largest in each layer", f"{words}, at all points computed", 34)
    figure.legend(
        handles=[Line2D([], [], color=c, lw=2.4, label=label) for c, label in zip(colours, labels, strict=True)],
        loc="outside lower center", ncols=min(len(labels), 8),
    )  # fmt: skip
    return figure


@dataclass(frozen=True)
class _Peak:
    """The largest strain, microstrain, of a layer and its depth, mm."""

    layer: str
    strain: float
    depth: float


def _component(strain: str) -> str:
    if strain not in COMPONENTS:
        raise InputError(f"strain must be one of {', '.join(COMPONENTS)}, got {strain!r}")
    return strain


def _worst_place(data: xr.Dataset, name: str) -> tuple[float, float]:
    """X and y, m, of the largest strain below the shallowest depth."""
    strain = data[name].isel(depth=slice(1, None)).max("depth").transpose("y", "x")
    row, column = index_of_largest(strain.to_numpy())
    return float(strain["x"][column]), float(strain["y"][row])


def _under_load(response: Source, section: xr.Dataset, name: str) -> float:
    """Coordinate along a section, m, of the centre of the load; of the largest strain if the load is unknown."""
    try:
        return load_centre(response)[0 if name == "x" else 1]
    except InputError:
        strain = section["principal_strain_1"].transpose("depth", name).to_numpy()
        return float(section[name][index_of_largest(strain, horizontal=1)[1]])


def _profiles(
    ax: Axes,
    cases: Sequence[xr.Dataset],
    labels: Sequence[str],
    colours: Sequence[str],
    component: str,
    place: tuple[str, float],
) -> None:
    """Curves of several roads at one place, with the layers of the first."""
    variable, (name, value) = COMPONENTS[component][0], place
    reach = np.zeros(1)
    for number, (case, label) in enumerate(zip(cases, labels, strict=True)):
        here = fields_of(case, variable)[variable].isel({name: nearest(case, name, value)})
        down = case["depth"].to_numpy() * MM
        values = here.to_numpy().reshape(len(down)) * MICRO
        draw_profile(ax, values, down, Layers.of(case), color=colours[number % len(colours)], label=plain(label))
        reach = down if down[-1] > reach[-1] else reach
    frame_profile(ax, reach)
    layers = Layers.of(cases[0])
    draw_interfaces(ax, layers, float(reach[-1]))
    name_layers(ax, layers, float(reach[-1]))
    ax.set_xlabel("microstrain")


def _in_numbers(section: Section, scale: Limits) -> str:
    peak, deeper = float(np.nanmax(section.values)), section.values[section.down > section.down[0]]
    text = f"at {section.cut_in_words}; peak {measure(peak)}"
    if deeper.size and np.nanmax(deeper) < peak:
        text += f", deeper {measure(float(np.nanmax(deeper)))}"
    return text + ("; colours stop below" if scale.clipped and peak > scale.high else "")


def _warmth(degrees: Sequence[float]) -> list[str]:
    """A colour for each temperature, from cold to hot, as far apart as the temperatures are."""
    low, high = min(degrees), max(degrees)
    shares = [(t - low) / (high - low) if high > low else 0.5 for t in degrees]
    return [mpl.colors.to_hex(mpl.colormaps["plasma"](0.02 + 0.8 * share)) for share in shares]


def _largest_in_layers(data: xr.Dataset, name: str) -> list[_Peak]:
    field = data[name].transpose("depth", "y", "x").to_numpy() * MICRO
    down, layers = data["depth"].to_numpy() * MM, Layers.of(data)
    largest: Array = np.nanmax(field, axis=(1, 2))
    peaks = []
    for layer, rows in zip(layers.names, layers.pieces(down), strict=True):
        if rows.stop > rows.start:
            k = rows.start + int(np.argmax(largest[rows]))
            peaks.append(_Peak(layer, float(largest[k]), float(down[k])))
    return peaks


def _short(name: str) -> str:
    return textwrap.shorten(name, _NAME, placeholder=" …") if " " in name else name[:_NAME]


def _bars(ax: Axes, peaks: Sequence[Sequence[_Peak]], labels: Sequence[str], colours: Sequence[str]) -> None:
    """A group of bars for each layer, the top one first; in it a bar for each temperature with its number."""
    names = [peak.layer for peak in peaks[0]]
    if any([peak.layer for peak in case] != names for case in peaks):
        raise InputError("the responses must have depths in the same layers")
    group = len(peaks) + 1.0
    for number, (case, label, colour) in enumerate(zip(peaks, labels, colours, strict=True)):
        places = [group * layer + number for layer in range(len(names))]
        ax.barh(places, [peak.strain for peak in case], height=0.86, color=colour, label=label)
        for place, peak in zip(places, case, strict=True):
            ax.annotate(
                signed(peak.strain, 0), (max(peak.strain, 0.0), place), xytext=(3, 0), textcoords="offset points",
                ha="left", va="center", fontsize=8, color=INK,
            )  # fmt: skip
    middle = (len(peaks) - 1) / 2
    ticks = [group * layer + middle for layer in range(len(names))]
    depths = [sorted({round(case[layer].depth) for case in peaks}) for layer in range(len(names))]
    where = [f"{deep[0]:g}" if len(deep) == 1 else f"{deep[0]:g} to {deep[-1]:g}" for deep in depths]
    words = [f"{plain(_short(name))}\n{deep} mm deep" for name, deep in zip(names, where, strict=True)]
    ax.set_yticks(ticks, words)
    ax.set_ylim(group * len(names) - 1, -1)
    ax.tick_params(axis="y", length=0)
    ax.axvline(0, color=INK, lw=0.7)
    ax.margins(x=0.12)
    ax.set_xlabel("microstrain")
    ax.grid(axis="x")
    ax.spines[["top", "right", "left"]].set_visible(False)
