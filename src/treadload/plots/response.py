"""Figures of a response: strain and its directions in plan, in a vertical section, against depth."""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.plots.plan import (
    DEPTH_LABEL,
    MICRO,
    MM,
    X_LABEL,
    Y_LABEL,
    Limits,
    Plan,
    Source,
    at_depth,
    colour_bar,
    contact_mask,
    draw_cells,
    draw_outline,
    edges,
    empty_note,
    fields_of,
    limits,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.strokes import draw_strokes, strokes
from treadload.plots.style import (
    CASES,
    INK,
    MUTED,
    figure_and_axes,
    headline,
    legend_below,
    measure,
    sequential,
    signed,
    styled,
    travel_arrow,
)

Strain = Literal["principal", "in-plane"]
_VARIABLE = {"principal": "principal_strain_1", "in-plane": "in_plane_strain_1"}
_DIRECTION = {"principal": "principal_direction_1", "in-plane": "in_plane_angle_1"}
NAMES = {"principal": "three-dimensional", "in-plane": "in the horizontal plane"}
# Directions of strains below this share of the colour scale are left out.
_SIGNIFICANT = 0.2


@styled
def strain_directions(
    response: Source,
    *,
    depth: float = 0.0,
    strain: Strain = "principal",
    contact: Source | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Largest extension strain in plan, microstrain, with strokes along its direction.

    response: with the strain and its direction over (depth, y, x). depth: one of its depths, m.
    strain: "principal", the three-dimensional one, whose strokes shorten to a point as the direction turns
    out of the horizontal; or "in-plane", the largest in the horizontal plane. contact: gives the outline of the
    contact; if left out the stress at the surface tells it, when it is there. ax: axes to draw into.
    Returns the figure. Raises InputError for a missing variable or depth or another word for strain.
    """
    data = strain_plane(response, depth, strain)
    plan, values = Plan.of(data), plane(data, _VARIABLE[strain]) * MICRO
    figure, ax = figure_and_axes(ax, 6.8, min(9.0, max(2.8, 5.0 * plan.aspect + 1.25)))
    scale = limits(values)
    mesh = draw_strain(ax, data, strain, scale, contact or response)
    colour_bar(mesh, ax, f"largest extension, {NAMES[strain]} (microstrain)", scale)
    kind = "three-dimensional" if strain == "principal" else "horizontal plane"
    headline(ax, f"Largest extension {place_in_words(depth)}, {kind}", strain_in_numbers(data, strain, scale))
    return figure


def strain_plane(response: Source, depth: float, strain: Strain) -> xr.Dataset:
    """The plane of a response that a strain map draws; InputError if it is not there."""
    if strain not in _VARIABLE:
        raise InputError(f'strain must be "principal" or "in-plane", got {strain!r}')
    return at_depth(fields_of(response, _VARIABLE[strain], _DIRECTION[strain], "x", "y"), depth)


def draw_strain(ax: Axes, data: xr.Dataset, strain: Strain, scale: Limits, outline: Source | None) -> QuadMesh:
    """Draw a strain map on a scale in microstrain: colours, strokes, outline of the contact, mark of the peak."""
    plan, values = Plan.of(data), plane(data, _VARIABLE[strain]) * MICRO
    mesh = draw_cells(ax, plan, values, sequential("strain"), scale)
    _outline(ax, outline)
    row, column = peak_of(values)
    peak = float(values[row, column])
    if peak > 0:
        own = limits(values)
        along_x, along_y = _horizontal(data, strain)
        draw_strokes(ax, strokes(values, along_x, along_y, plan.x, plan.y, _SIGNIFICANT * own.high))
        mark_peak(ax, float(plan.x[column]), float(plan.y[row]), measure(peak))
    else:
        empty_note(ax, "nothing extends here")
    travel_arrow(ax)
    return mesh


def strain_in_numbers(data: xr.Dataset, strain: Strain, scale: Limits) -> str:
    """Peak of a strain map and its place; says when the colours stop below it."""
    plan, values = Plan.of(data), plane(data, _VARIABLE[strain]) * MICRO
    row, column = peak_of(values)
    place = f"x = {signed(plan.x[column])}, y = {signed(plan.y[row])} mm"
    return f"peak {values[row, column]:.1f} microstrain at {place}" + (
        "; colours stop below" if scale.clipped else ""
    )


def place_in_words(depth: float) -> str:
    """A depth, m, in words for a title."""
    return "at the surface" if depth == 0 else f"{depth * MM:g} mm deep"


@styled
def depth_slice(
    response: Source,
    *,
    along: Literal["travel", "across"] | None = None,
    at: float | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Largest extension strain in a vertical section, microstrain, with strokes along its direction.

    response: with principal_strain_1 and principal_direction_1 over (depth, y, x), two depths or more; one of y
    and x may have a length of one. along: "travel", a section along x, or "across", along y; if left out the way
    the dataset reaches. at: y (or x) of the section, m, the nearest there is; if left out through the largest
    extension at the least depth. ax: axes to draw into. Strokes show the direction's share in the section.
    Returns the figure. Raises InputError for a missing variable or fewer than two depths or points.
    """
    data = fields_of(response, "principal_strain_1", "principal_direction_1", "depth")
    name, other = _section_axis(data, along)
    if data.sizes.get("depth", 1) < 2 or data.sizes[name] < 2:
        raise InputError(
            f"a section needs two depths and two points at least, the response has {data.sizes.get('depth', 1)} "
            f"and {data.sizes[name]}; solve the response at more depths"
        )
    data = data.sortby("depth")
    section = data.isel({other: _position(data, other, at)})
    values = section["principal_strain_1"].transpose("depth", name).to_numpy() * MICRO
    direction = section["principal_direction_1"].transpose("depth", name, "component").to_numpy()
    across, down = (data[key].to_numpy() * MM for key in (name, "depth"))
    aspect = float(np.ptp(down) / np.ptp(across))
    figure, ax = figure_and_axes(ax, 6.8, min(7.5, max(2.1, 5.2 * aspect + 1.1)))
    scale = limits(values)
    mesh = ax.pcolormesh(
        across, down, values, cmap=sequential("strain"), vmin=scale.low, vmax=scale.high, shading="gouraud",
        rasterized=True,
    )  # fmt: skip
    colour_bar(mesh, ax, "microstrain", scale)
    ax.set_aspect("equal")
    ax.set_xlim(across[0], across[-1])
    ax.set_ylim(down[-1], down[0])
    ax.set_xlabel(X_LABEL if name == "x" else Y_LABEL)
    ax.set_ylabel(DEPTH_LABEL)
    row, column = peak_of(values)
    if values[row, column] > 0:
        in_section = direction[..., 0 if name == "x" else 1]
        apart = max(float(np.ptp(across)) / 42, float(np.ptp(down)) / 24)
        draw_strokes(
            ax, strokes(values, in_section, direction[..., 2], across, down, _SIGNIFICANT * scale.high / 2, apart)
        )
        mark_peak(ax, float(across[column]), float(down[row]), measure(float(values[row, column])))
    cut = f"{other} = {signed(float(section[other]) * MM)} mm"
    title = "Section along travel" if name == "x" else "Section across travel"
    detail = f"largest extension, three-dimensional, at {cut}; peak {np.nanmax(values):.1f} microstrain"
    if scale.clipped:
        detail += "; colours stop below"
    headline(ax, title, detail)
    _loaded_strip(ax, section, name, across)
    return figure


@styled
def profile(
    response: Source,
    *,
    strain: Strain = "principal",
    epsilon_6: float | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Strain against depth under the worst point, microstrain.

    response: with principal_strain_1 and in_plane_strain_1 over (depth, y, x). strain: the one whose largest
    value at the least depth is the worst point. epsilon_6: strain of a million passes, drawn if given.
    ax: axes to draw into. Returns the figure.
    """
    if strain not in _VARIABLE:
        raise InputError(f'strain must be "principal" or "in-plane", got {strain!r}')
    data = fields_of(response, *_VARIABLE.values(), "depth").sortby("depth")
    row, column = peak_of(plane(data.isel(depth=0), _VARIABLE[strain]))
    down = data["depth"].to_numpy() * MM
    figure, ax = figure_and_axes(ax, 6.4, 4.8)
    marker = "o" if len(down) < 15 else ""
    for name, colour in zip(_VARIABLE, (CASES[0], CASES[1]), strict=True):
        field = data[_VARIABLE[name]].transpose("depth", "y", "x").to_numpy() * MICRO
        ax.plot(
            field[:, row, column], down, color=colour, marker=marker, ms=4, label=f"{NAMES[name]}, under the point"
        )
        reach = np.nanmax(field, axis=(1, 2))
        ax.plot(reach, down, color=colour, lw=0.9, ls=(0, (3, 2)), label=f"{NAMES[name]}, largest at that depth")
    ax.axvline(0, color=MUTED, lw=0.7)
    if epsilon_6 is not None:
        ax.axvline(epsilon_6 * MICRO, color=INK, lw=0.9, ls=":", label=f"ε₆ = {epsilon_6 * MICRO:g}")
    low = 0.0 if len(down) > 1 else down[0] - 1
    ax.set_ylim(max(down[-1], low + 1), min(low, down[0]))
    ax.set_xlabel("largest extension (microstrain)")
    ax.set_ylabel(DEPTH_LABEL)
    ax.grid(True)
    ax.spines[["top", "right"]].set_visible(False)
    handles, _ = ax.get_legend_handles_labels()
    legend_below(ax, handles, columns=2)
    x, y = float(data["x"][column]) * MM, float(data["y"][row]) * MM
    headline(
        ax, "Strain against depth", f"under the worst point at the least depth, x = {signed(x)}, y = {signed(y)} mm"
    )
    return figure


def _horizontal(data: xr.Dataset, strain: Strain) -> tuple[Array, Array]:
    """Components along x and y (ny, nx) of the direction of the largest extension."""
    if strain == "in-plane":
        angle = plane(data, "in_plane_angle_1")
        return np.cos(angle), np.sin(angle)
    direction = data["principal_direction_1"].transpose("y", "x", "component").to_numpy()
    return direction[..., 0], direction[..., 1]


def _outline(ax: Axes, source: Source | None) -> None:
    if source is None:
        return
    data = fields_of(source)
    mask = contact_mask(data)
    if mask is not None:
        draw_outline(ax, mask, Plan.of(data), MUTED, 0.6)


def _section_axis(data: xr.Dataset, along: str | None) -> tuple[str, str]:
    if along not in (None, "travel", "across"):
        raise InputError(f'along must be "travel" or "across", got {along!r}')
    if along is None:
        along = "across" if data.sizes["x"] < data.sizes["y"] and data.sizes["x"] == 1 else "travel"
    return ("x", "y") if along == "travel" else ("y", "x")


def _position(data: xr.Dataset, name: str, at: float | None) -> int:
    """Index along `name` of a section at a coordinate, m, or through the largest extension."""
    if at is not None:
        return int(np.argmin(np.abs(data[name].to_numpy() - at)))
    row, column = peak_of(plane(data.isel(depth=0), "principal_strain_1"))
    return row if name == "y" else column


def _loaded_strip(ax: Axes, section: xr.Dataset, name: str, across: Array) -> None:
    """A bar on the surface where the tire touches."""
    if "stress_zz" not in section or abs(float(section["depth"][0])) > 0:
        return
    pressed = -section["stress_zz"].isel(depth=0).to_numpy()
    if not pressed.max(initial=0.0) > 0:
        return
    sides = edges(across)
    touching = np.pad(pressed > 5e-3 * pressed.max(), 1).astype(int)
    starts, ends = np.nonzero(np.diff(touching) == 1)[0], np.nonzero(np.diff(touching) == -1)[0]
    for start, end in zip(starts, ends, strict=True):
        ax.plot([sides[start], sides[end]], [0, 0], color=INK, lw=4, solid_capstyle="butt", clip_on=False, zorder=4)
