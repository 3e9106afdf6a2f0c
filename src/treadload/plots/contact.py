"""Figures of a contact: pressure, initial gap, shear, stick and slip, sections."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import Drawing, figure
from treadload.kernels.arrays import Array, BoolArray
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.plan import (
    KPA,
    MM,
    X_LABEL,
    Y_LABEL,
    Limits,
    Plan,
    colour_bar,
    draw_cells,
    draw_outline,
    empty_note,
    fields_of,
    limits,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.kit.strokes import choose
from treadload.plots.kit.style import (
    INK,
    MUTED,
    SLIP,
    STICK,
    halo,
    headline,
    legend_below,
    measure,
    sequential,
    signed,
    styled,
    thousands,
    travel_arrow,
)
from treadload.units import stress_in_words

_ARROWS = 22


def _shear_seen(data: xr.Dataset) -> Iterator[Drawing]:
    """The picture of the shear, or why there is none."""
    if "state" in data and {"traction_x", "traction_y"} <= set(data):
        bare = fields_of(data)
        note = str(bare.attrs.get("negligible_shear", ""))
        if not note and not _shear(bare).any():
            note = "no shear: the contact is frictionless, or no force or creepage acts along the road"
        yield Drawing(negligible=note)


@figure(
    "Contact", "Footprint", main=True, title="Contact pressure",
    caption="Seen from above, at true scale. The ring marks the largest pressure; pressure rises at the edges of "
    "ribs and blocks, and the more so the finer the grid.",
)  # fmt: skip
@styled
def pressure(contact: Source, *, ax: Axes | None = None) -> Figure:
    """Contact pressure in plan, true scale, kPa.

    contact: with pressure (y, x), Pa. ax: axes to draw into; a new figure if left out. Returns the figure.
    Raises InputError if the pressure is missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> figure = tl.plots.pressure(contact)
    >>> f"{figure.axes[0].collections[0].get_array().max():.0f} kPa"
    '212 kPa'
    """
    data = fields_of(contact, "pressure")
    plan, values = Plan.of(data), plane(data, "pressure") * KPA
    figure, ax = figure_and_axes(ax, 6.4, _height(plan, 6.4))
    scale = limits(values)
    mesh = draw_cells(ax, plan, _where(values > 0, values), sequential("pressure"), scale)
    draw_outline(ax, values > 0, plan, MUTED, 0.5)
    colour_bar(mesh, ax, "contact pressure (kPa)", scale)
    headline(ax, "Contact pressure", pressure_in_numbers(data))
    row, column = peak_of(values)
    if values[row, column] > 0:
        mark_peak(ax, plan.x[column], plan.y[row], stress_in_words(values[row, column] / KPA))
    else:
        empty_note(ax, "no contact")
    travel_arrow(ax)
    return figure


@figure(
    "Contact", "Footprint", title="Tread before loading",
    caption="Distance of the tread from the road at first contact; the line is the border of the contact under load.",
    # A footprint that was recorded has no tread and no friction.
    when=lambda data: "initial_gap" in data,
)  # fmt: skip
@styled
def height_map(contact: Source, *, ax: Axes | None = None) -> Figure:
    """Separation of tread and road before loading, in plan, mm.

    contact: with initial_gap (y, x), m, NaN where there is no tread; the outline of the contact is drawn if
    there is a pressure. ax: axes to draw into. Returns the figure.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> figure = tl.plots.height_map(contact)
    >>> f"{figure.axes[0].collections[0].get_array().max():.1f} mm at the corner of the map"
    '4.5 mm at the corner of the map'
    """
    data = fields_of(contact, "initial_gap")
    plan, values = Plan.of(data), plane(data, "initial_gap") * MM
    figure, ax = figure_and_axes(ax, 6.4, _height(plan, 6.4))
    finite = values[np.isfinite(values)]
    # Grooves far deeper than the contact reaches would use up the colours.
    high = float(np.quantile(finite, 0.98)) if finite.size else 1.0
    scale = Limits(0.0, high or 1.0, bool(finite.size and finite.max() > high * 1.001))
    mesh = draw_cells(ax, plan, values, sequential("height"), scale)
    colour_bar(mesh, ax, "initial gap (mm)", scale)
    details = f"largest gap {finite.max():.1f} mm" if finite.size else "no tread here"
    if "pressure" in data:
        draw_outline(ax, plane(data, "pressure") > 0, plan, SLIP, 1.0)
        details += "; outlined: the contact under load"
    headline(ax, "Tread before loading", details)
    travel_arrow(ax)
    return figure


@figure("Contact", "Footprint")
@styled
def stick_slip(contact: Source, *, ax: Axes | None = None) -> Figure:
    """Shear in plan with the zones that stick and slip, kPa.

    contact: with traction_x, traction_y (y, x), Pa, and state (y, x). The arrows are the shear exerted by the
    tire on the road, thinned. ax: axes to draw into. Returns the figure.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> wheel = tl.Rolling(normal_load=100.0, friction=0.7, tractive_force=-35.0)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> tl.plots.stick_slip(contact).axes[0].get_title(loc="left")
    'Shear on the road, stick and slip'
    """
    data = fields_of(contact, "traction_x", "traction_y", "state")
    plan = Plan.of(data)
    figure, ax = figure_and_axes(ax, 6.6, _height(plan, 6.6) + 0.25)
    scale = limits(_shear(data))
    draw_stick_slip(ax, data, plan, scale)
    headline(ax, "Shear on the road, stick and slip", shear_in_numbers(data))
    return figure


@figure(
    "Contact", "Footprint", title="Shear, stick and slip", wide=True,
    caption="Left: size of the shear in space. Right: the same from above; hatched cells slip, there the shear has "
    "reached friction times pressure. Arrows: shear exerted by the tire on the road.",
    when=_shear_seen,
)  # fmt: skip
@styled
def shear(contact: Source) -> Figure:
    """Shear as a surface in space, beside its plan with the zones that stick and slip, kPa.

    contact: with traction_x, traction_y (y, x), Pa, and state (y, x). Returns the figure.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> wheel = tl.Rolling(normal_load=100.0, friction=0.7, tractive_force=-35.0)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> [ax.get_title(loc="left").splitlines()[0] for ax in tl.plots.shear(contact).axes[:2]]
    ['Shear on the road', 'Stick and slip']
    """
    data = fields_of(contact, "traction_x", "traction_y", "state")
    if "negligible_shear" in data.attrs:
        return stick_slip(contact)
    plan, values = Plan.of(data), _shear(data)
    scale = limits(values)
    figure = new_figure(11.4, 5.3)
    solid = figure.add_subplot(1, 2, 1, projection="3d")
    flat = figure.add_subplot(1, 2, 2)
    x, y = np.meshgrid(plan.x, plan.y)
    solid.plot_surface(
        x, y, values, cmap=sequential("shear"), vmin=scale.low, vmax=scale.high, rcount=150, ccount=150,
        linewidth=0.12, edgecolor=(0, 0, 0, 0.16), antialiased=True, rasterized=True,
    )  # fmt: skip
    solid.set_xlim(plan.x_edges[0], plan.x_edges[-1])
    solid.set_ylim(plan.y_edges[-1], plan.y_edges[0])
    solid.set_zlim(0, max(float(np.nanmax(values)), 1e-9))
    solid.set_box_aspect((1, plan.aspect, 0.55), zoom=1.12)
    solid.xaxis.set_major_locator(MaxNLocator(4))
    solid.yaxis.set_major_locator(MaxNLocator(4))
    solid.view_init(elev=32, azim=-62)
    solid.set_xlabel("x, travel (mm)")
    solid.set_ylabel("y, right (mm)")
    solid.set_zlabel("shear (kPa)")
    for axis in (solid.xaxis, solid.yaxis, solid.zaxis):
        axis.set_pane_color((1, 1, 1, 0))
        axis._axinfo["grid"].update(color="#e4e7ec", linewidth=0.6)
    headline(solid, "Shear on the road", shear_in_numbers(data))
    draw_stick_slip(flat, data, plan, scale)
    headline(flat, "Stick and slip", _zones_in_numbers(data))
    return figure


@figure(
    "Contact", "Footprint", title="Sections through the largest pressure", wide=True,
    caption="Where the shear lies on the dashed line, friction times pressure, the tire slips.",
)  # fmt: skip
@styled
def profile(contact: Source) -> Figure:
    """Pressure and shear along travel and across it, through the largest pressure, kPa.

    contact: with pressure (y, x), Pa; shear, friction and state are drawn if they are there. Where the shear
    meets friction times pressure the tire slips. Returns the figure.
    """
    data = fields_of(contact, "pressure")
    plan, values = Plan.of(data), plane(data, "pressure") * KPA
    row, column = peak_of(values)
    figure = new_figure(10.9, 5.8)
    upper, lower = figure.subplots(2, 1, sharey=True)
    _section(upper, data, plan.x, (row, slice(None)))
    upper.set_xlabel(X_LABEL)
    headline(upper, "Along travel", f"through the largest pressure, y = {signed(plan.y[row])} mm")
    _section(lower, data, plan.y, (slice(None), column))
    lower.set_xlabel(Y_LABEL)
    headline(lower, "Across travel", f"through the largest pressure, x = {signed(plan.x[column])} mm")
    handles, labels = upper.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


def pressure_in_numbers(data: xr.Dataset) -> str:
    """Load, area and peak of a contact in one line."""
    plan, values = Plan.of(data), plane(data, "pressure") * KPA
    cell = np.outer(np.diff(plan.y_edges), np.diff(plan.x_edges))
    area = float(cell[values > 0].sum())
    load = float(data["normal_load"]) / 1e3 if "normal_load" in data else float((values * cell).sum()) * 1e-6
    if area == 0:
        return "no contact"
    return (
        f"{load:.4g} kN on {thousands(area)} mm², mean {load * 1e6 / area:.0f} kPa, peak {np.nanmax(values):.0f} kPa"
    )


def _section(ax: Axes, data: xr.Dataset, at: Array, cut: tuple[int | slice, int | slice]) -> None:
    values = plane(data, "pressure")[cut] * KPA
    ax.fill_between(at, values, step="mid", color=MUTED, alpha=0.16, linewidth=0)
    ax.step(at, values, where="mid", color=INK, lw=1.3, label="pressure")
    if "friction_coefficient" in data or "friction" in data:
        mu = plane(data, "friction_coefficient")[cut] if "friction_coefficient" in data else float(data["friction"])
        bound = mu * values
        ax.step(at, bound, where="mid", color=MUTED, lw=0.9, ls=(0, (3, 2)), label="friction × pressure")
    if "traction_x" in data and "traction_y" in data:
        q = _shear(data)[cut]
    if "traction_x" in data and "traction_y" in data and "negligible_shear" not in data.attrs:
        ax.step(at, q, where="mid", color=STICK, lw=1.4, label="shear, where it sticks")
        if "state" in data:
            slipping = np.where(plane(data, "state")[cut] == 2, q, np.nan)
            ax.step(at, slipping, where="mid", color=SLIP, lw=2.2, label="shear, where it slips")
    ax.set_xlim(at[0], at[-1])
    ax.set_ylim(bottom=0)
    ax.set_ylabel("kPa")
    ax.grid(axis="y")
    ax.spines[["top", "right"]].set_visible(False)


def draw_stick_slip(ax: Axes, data: xr.Dataset, plan: Plan, scale: Limits) -> None:
    """Draw shear, kPa, with its arrows and the zones that stick and slip, a colour bar and a legend."""
    values, state = _shear(data), plane(data, "state")
    if note := data.attrs.get("negligible_shear"):
        draw_cells(ax, plan, np.full_like(values, np.nan), sequential("shear"), scale)
        draw_outline(ax, state > 0, plan, MUTED, 1.0)
        empty_note(ax, textwrap.fill(note, 32))
        return
    mesh = draw_cells(ax, plan, _where(state > 0, values), sequential("shear"), scale)
    colour_bar(mesh, ax, "shear (kPa)", scale)
    slip, stick = state == 2, state == 1
    if slip.any():
        _hatch(ax, slip, plan)
    draw_outline(ax, stick, plan, STICK, 1.6)
    draw_outline(ax, slip, plan, SLIP, 1.1)
    if values.max(initial=0.0) > 0:
        _arrows(ax, data, plan, scale)
    else:
        empty_note(ax, "no shear")
    legend_below(
        ax,
        [
            Line2D([], [], color=STICK, lw=1.8, label="stick"),
            Patch(facecolor="none", edgecolor=SLIP, hatch="/////", label="slip"),
            Line2D([], [], color=INK, lw=1.2, marker=">", ms=4, label="shear of the tire on the road"),
        ],
    )
    travel_arrow(ax)


def _hatch(ax: Axes, mask: BoolArray, plan: Plan) -> None:
    """Hatch the cells of a mask: one path of a rectangle for each run of cells along x."""
    filled = np.pad(mask, ((0, 0), (1, 1))).astype(int)
    rows, starts = np.nonzero(np.diff(filled) == 1)
    _, ends = np.nonzero(np.diff(filled) == -1)
    x, y = plan.x_edges, plan.y_edges
    corners = [(x[starts], y[rows]), (x[ends], y[rows]), (x[ends], y[rows + 1]), (x[starts], y[rows + 1])]
    corners.append(corners[0])
    vertices = np.stack([np.stack(corner, axis=-1) for corner in corners], axis=1).reshape(-1, 2)
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(rows))
    ax.add_patch(PathPatch(Path(vertices, codes), facecolor="none", edgecolor=SLIP, hatch="////", lw=0, zorder=2.1))


def _arrows(ax: Axes, data: xr.Dataset, plan: Plan, scale: Limits) -> None:
    """Thinned arrows whose length follows the shear; the longest fill the distance between two."""
    values = _shear(data)
    apart = max(plan.span / _ARROWS, 2 * plan.cell)
    index = choose(values, plan.x, plan.y, 0.06 * scale.high, apart)
    rows, columns = index[:, 0], index[:, 1]
    shares = [plane(data, name)[rows, columns] * KPA / scale.high for name in ("traction_x", "traction_y")]
    length = np.hypot(*shares)
    cut = np.minimum(1.0, 1.25 / np.maximum(length, 1e-12))
    ax.quiver(
        plan.x[columns], plan.y[rows], shares[0] * cut, shares[1] * cut, angles="xy", scale_units="xy",
        scale=1 / (1.5 * apart), pivot="mid", color=INK, width=0.0034, headwidth=3.4, headlength=3.8,
        headaxislength=3.5, minlength=0.6, path_effects=halo(1.4), zorder=3,
    )  # fmt: skip


def _shear(data: xr.Dataset) -> Array:
    """Magnitude of the shear (ny, nx), kPa."""
    magnitude: Array = np.hypot(plane(data, "traction_x"), plane(data, "traction_y")) * KPA
    return magnitude


def shear_in_numbers(data: xr.Dataset) -> str:
    """Largest shear and the forces along the road in one line."""
    if "negligible_shear" in data.attrs:
        return "too small to draw"
    parts = [f"peak {measure(float(np.nanmax(_shear(data))))} kPa"]
    for name, symbol in (("tractive_force", "tractive"), ("lateral_force", "lateral")):
        if name in data and abs(float(data[name])) >= 0.5:
            parts.append(f"{symbol} force {float(data[name]) / 1e3:.3g} kN")
    if len(parts) == 1 and "tractive_force" in data:
        parts.append("no force along the road")
    return ", ".join(parts)


def _zones_in_numbers(data: xr.Dataset) -> str:
    state = plane(data, "state")
    touching = int((state > 0).sum())
    if not touching:
        return "no contact"
    slipping = 100 * float((state == 2).sum()) / touching
    return f"{slipping:.0f} % of the contact slips, {100 - slipping:.0f} % sticks"


def _where(mask: BoolArray, values: Array) -> Array:
    shown: Array = np.where(mask, values, np.nan)
    return shown


def _height(plan: Plan, width: float) -> float:
    """Height of a figure, inches, whose map of true scale fills it beside its colour bar."""
    return min(9.0, max(2.6, (width - 1.75) * plan.aspect + 1.15))
