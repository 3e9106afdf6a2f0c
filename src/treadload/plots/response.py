"""Figures of a response: strain and its directions in plan, in a vertical section, against depth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.layers import name_layers
from treadload.plots.kit.plan import (
    MICRO,
    MM,
    Limits,
    Plan,
    at_depth,
    colour_bar,
    contact_mask,
    draw_cells,
    draw_outline,
    empty_note,
    fields_of,
    limits,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.kit.round_off import round_off
from treadload.plots.kit.section import Section, draw_section
from treadload.plots.kit.strokes import draw_strokes, strokes
from treadload.plots.kit.style import (
    MUTED,
    headline,
    measure,
    sequential,
    signed,
    styled,
    travel_arrow,
)
from treadload.response.fields import kind_of_points, layer_in_words

Strain = Literal["principal", "in-plane"]
VARIABLE = {"principal": "principal_strain_1", "in-plane": "in_plane_strain_1"}
_DIRECTION = {"principal": "principal_direction_1", "in-plane": "in_plane_angle_1"}
NAMES = {"principal": "three-dimensional", "in-plane": "in the horizontal plane"}
# Directions of strains below this share of the colour scale are left out.
_SIGNIFICANT = 0.2
# Width of a page of a report, inches of a figure.
_PAGE = 10.9


STRAINS: tuple[Strain, ...] = ("principal", "in-plane")
_HOLDS = ", which at the surface includes the shear of the tire itself"
DRAWN = {"principal": "the three-dimensional strain", "in-plane": "the strain in the horizontal plane"}
WHAT = {
    "principal": "Strokes lie along the largest tensile strain; where a principal stress is tensile a crack opens "
    "across them. A stroke shortens to a point where the tensile strain turns out of the page. White: no tensile "
    "strain.",
    "in-plane": "Strokes lie along the tensile strain; where a principal stress is tensile, vertical cracks open "
    "across them. White: no tensile strain in the plane.",
}


def _planes(data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> Iterator[Drawing]:
    """A map for each depth, two at the surface."""
    if kind_of_points(data) != "response":
        return
    for depth in np.atleast_1d(data["depth"].to_numpy()).tolist():
        # Without the tire's shear on it the plane's strain adds little: below the surface one map is enough.
        side = layer_in_words(at_depth(data, depth))
        deep = f"{place_in_words(depth)}, {side}" if side else place_in_words(depth)
        for strain in STRAINS if depth == 0 else STRAINS[:1]:
            holds = _HOLDS if depth == 0 and strain == "principal" else ""
            yield Drawing(
                {"depth": depth, "strain": strain, "contact": beside.get("contact")},
                f"Largest tensile strain {deep}, {NAMES[strain]}",
                f"Drawn: {DRAWN[strain]}{holds}. {WHAT[strain]}",
                round_off(at_depth(data, depth), VARIABLE[strain], over=data),
            )


def _sections(data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> Iterator[Drawing]:
    cuts = {"slice_along": ("along travel", "y"), "slice_across": ("across travel", "x")}
    cut = cuts.get(kind_of_points(data))
    if cut is not None:
        words, crossed = cut
        damage = beside.get("damage")
        deep = assessed_depth(assessed_plane(beside.get("response"), damage))
        at = data[crossed].to_numpy().ravel()
        is_worst = damage is not None and np.allclose(at, float(damage[f"worst_{crossed}"]), atol=1e-6)
        through = f"the worst point {deep}" if is_worst else "the largest strain of the shallowest map"
        caption = (
            f"Drawn: the three-dimensional strain through {through}; black bars: the tire touches. "
            "Strokes show the part of the direction that lies in the section."
        )
        yield Drawing(title=f"Vertical section {words}", caption=caption)


def assessed_plane(response: xr.Dataset | None, damage: xr.Dataset | None) -> xr.Dataset | None:
    """The map of a response at the depth of an assessment, or at its shallowest depth; None without a response."""
    if response is None:
        return None
    depths = np.atleast_1d(response["depth"].to_numpy())
    wanted = float(damage.attrs.get("depth", depths.min())) if damage is not None else float(depths.min())
    nearest = int(np.argmin(np.abs(depths - wanted)))
    return response.isel(depth=nearest) if "depth" in response.dims else response


def assessed_depth(plane: xr.Dataset | None) -> str:
    """Where the strains of a map at one depth are evaluated, in words."""
    if plane is None or "depth" not in plane.coords or float(plane["depth"]) == 0:
        return "at the surface"
    side = layer_in_words(plane)
    return f"{float(plane['depth']) * MM:g} mm deep{f', {side}' if side else ''}"


@figure(
    "Response", main=True, title="Largest tensile strain", order=0,
    when=_planes,
)  # fmt: skip
@styled
def strain_directions(
    response: Source,
    depth: float = 0.0,
    strain: Strain = "principal",
    *,
    contact: Source | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Largest extension strain in plan, microstrain, with strokes along its direction.

    response: with the strain and its direction over (depth, y, x). depth: one of its depths, m.
    strain: "principal", the three-dimensional one, whose strokes shorten to a point as the direction turns
    out of the horizontal; or "in-plane", the largest in the horizontal plane. contact: gives the outline of the
    contact; if left out the stress at the surface gives it, when it is there. ax: axes to draw into.
    Returns the figure. Raises InputError for a missing variable or depth or another word for strain.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=x, y=y)
    >>> figure = tl.plots.strain_directions(response, depth=0.15)
    >>> f"{figure.axes[0].collections[0].get_array().max():.0f} microstrain"
    '269 microstrain'
    """
    data = strain_plane(response, depth, strain)
    plan, values = Plan.of(data), plane(data, VARIABLE[strain]) * MICRO
    figure, ax = figure_and_axes(ax, 6.8, min(9.0, max(2.8, 5.0 * plan.aspect + 1.25)))
    scale = limits(values)
    mesh = draw_strain(ax, data, strain, scale, contact or response)
    colour_bar(mesh, ax, f"largest tensile strain, {NAMES[strain]} (microstrain)", scale)
    kind = "three-dimensional" if strain == "principal" else "horizontal plane"
    headline(ax, f"Largest tensile strain {place_in_words(depth)}, {kind}", strain_in_numbers(data, strain, scale))
    return figure


def strain_plane(response: Source, depth: float, strain: Strain) -> xr.Dataset:
    """The plane of a response that a strain map draws; InputError if it is not there."""
    if strain not in VARIABLE:
        raise InputError(f'strain must be "principal" or "in-plane", got {strain!r}')
    return at_depth(fields_of(response, VARIABLE[strain], _DIRECTION[strain], "x", "y"), depth)


def draw_strain(ax: Axes, data: xr.Dataset, strain: Strain, scale: Limits, outline: Source | None) -> QuadMesh:
    """Draw a strain map on a scale in microstrain: colours, strokes, outline of the contact, mark of the peak."""
    plan, values = Plan.of(data), plane(data, VARIABLE[strain]) * MICRO
    mesh = draw_cells(ax, plan, values, sequential("strain"), scale)
    draw_contact(ax, outline)
    row, column = peak_of(values)
    peak = float(values[row, column])
    if peak > 0:
        span = limits(values)
        along_x, along_y = horizontal(data, strain)
        draw_strokes(ax, strokes(values, along_x, along_y, plan.x, plan.y, _SIGNIFICANT * span.high))
        mark_peak(ax, float(plan.x[column]), float(plan.y[row]), measure(peak))
    else:
        empty_note(ax, "no tensile strain here")
    travel_arrow(ax)
    return mesh


def strain_in_numbers(data: xr.Dataset, strain: Strain, scale: Limits) -> str:
    """Peak of a strain map, which is that of a point, and its place; states when the colours stop below it."""
    plan, values = Plan.of(data), plane(data, VARIABLE[strain]) * MICRO
    row, column = peak_of(values)
    place = f"x = {signed(plan.x[column])}, y = {signed(plan.y[row])} mm"
    return f"peak {values[row, column]:.1f} microstrain at the point {place}" + (
        "; colours stop below" if scale.clipped else ""
    )


def place_in_words(depth: float) -> str:
    """A depth, m, in words for a title."""
    return "at the surface" if depth == 0 else f"{depth * MM:g} mm deep"


@figure(
    "Response", title="Vertical section", order=1, wide=True, when=_sections
)  # fmt: skip
@styled
def depth_slice(
    response: Source,
    along: Literal["travel", "across"] | None = None,
    at: float | None = None,
    *,
    ax: Axes | None = None,
) -> Figure:
    """Largest extension strain in a vertical section, microstrain, with strokes along its direction.

    response: with principal_strain_1 and principal_direction_1 over (depth, y, x), two depths or more; one of y and x
    may have a length of one. along: "travel", a section along x, or "across", along y; if left out the direction in
    which the dataset extends. at: y (or x) of the section, m, the nearest there is; if left out through the largest
    extension at the shallowest depth. ax: axes to draw into. Strokes show the direction's share in the section.
    Returns the figure. Raises InputError for a missing variable or fewer than two depths or points.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.02, 0.08, 0.149], x=x, y=y)
    >>> figure = tl.plots.depth_slice(response, "travel")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('x, direction of travel (mm)', 'depth (mm)')
    """
    section = Section.of(response, along, at)
    layered = len(section.layers.interfaces) > 0
    # As wide as a page: the section, the names of the layers, the colour bar.
    wide = _PAGE - 1.9 - 1.1 * layered
    figure, ax = figure_and_axes(ax, _PAGE, min(8.5, max(2.1, wide * section.aspect + 1.1)))
    scale = limits(section.values)
    mesh = draw_section(ax, section, scale)
    colour_bar(mesh, ax, "microstrain", scale, beyond=name_layers(ax, section.layers, section.bottom))
    title = "Section along travel" if section.name == "x" else "Section across travel"
    detail = (
        f"largest tensile strain, three-dimensional, at {section.cut_in_words}; peak at a point "
        f"{np.nanmax(section.values):.1f}"
    )
    detail += " microstrain" + ("; colours stop below" if scale.clipped else "")
    headline(ax, title, detail)
    return figure


def horizontal(data: xr.Dataset, strain: Strain) -> tuple[Array, Array]:
    """Components along x and y (ny, nx) of the direction of the largest extension."""
    if strain == "in-plane":
        angle = plane(data, "in_plane_angle_1")
        return np.cos(angle), np.sin(angle)
    direction = data["principal_direction_1"].transpose("y", "x", "component").to_numpy()
    return direction[..., 0], direction[..., 1]


def draw_contact(ax: Axes, source: Source | None) -> None:
    """Outline of the contact, where a source gives it."""
    if source is None:
        return
    data = fields_of(source)
    mask = contact_mask(data)
    if mask is not None:
        draw_outline(ax, mask, Plan.of(data), MUTED, 0.6)
