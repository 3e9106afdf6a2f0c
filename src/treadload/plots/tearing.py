"""The picture of tearing: where a wheel shears and slides on the road, and how the road is stretched there."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.plots.contact import draw_stick_slip, shear_in_numbers
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import KPA, MICRO, Plan, colour_bar, fields_of, limits, plane
from treadload.plots.kit.style import INK, RULE, SLIP, headline, plain, styled
from treadload.plots.response import VARIABLE, Strain, draw_strain, place_in_words, strain_in_numbers, strain_plane

# Inches of a map along travel. Place and width of the curve beside it, in widths of the map.
_MAP = 3.6
_BESIDE, _WIDE = 1.27, 0.42
_SAME_PLACE = 1e-9
_LETTERS = 34


@styled
def tearing(
    contact: Source, response: Source, *, depth: float = 0.0, strain: Strain = "in-plane", title: str = ""
) -> Figure:
    """Shear and slip beside the extension of the road, each with what a strip of road meets as the wheel rolls by.

    contact: with pressure, traction_x, traction_y, state and, where the wheel rolls, friction_work over (y, x).
    response: of the road below over (depth, y, x), on the contact's y. depth: of the extension, m. strain:
    "principal", the largest in space, or "in-plane", in the horizontal plane. title: of all.
    Beside the map of shear stands the work of sliding that one passage leaves on each strip along the road, J/m²,
    or the largest shear of the strip, kPa, where the wheel does not roll; beside the map of extension the largest
    of each strip. Grey bands are the ribs. Returns the figure. Raises InputError for what is missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> wheel = tl.Rolling(normal_load=100.0, friction=0.7, tractive_force=-35.0)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> response = tl.solve_response(contact, road, depths=[0.0])
    >>> tl.plots.tearing(contact, response).axes[0].get_title(loc="left")
    'Shear on the road'
    """
    data = fields_of(contact, "pressure", "traction_x", "traction_y", "state")
    below = strain_plane(response, depth, strain)
    y = data["y"].to_numpy()
    if below.sizes["y"] != len(y) or np.abs(below["y"].to_numpy() - y).max() > _SAME_PLACE:
        raise InputError(
            "the response has other y coordinates than the contact; solve it without y=, on the contact's"
        )
    plan = Plan.of(data)
    figure = new_figure(2 * _MAP * 1.95 + 0.9, _MAP * plan.aspect + 1.9)
    left, right = figure.subplots(1, 2)
    shear = np.hypot(plane(data, "traction_x"), plane(data, "traction_y")) * KPA
    draw_stick_slip(left, data, plan, limits(shear))
    headline(left, "Shear on the road", shear_in_numbers(data), _LETTERS)
    extension = plane(below, VARIABLE[strain]) * MICRO
    scale = limits(extension)
    mesh = draw_strain(right, below, strain, scale, contact)
    colour_bar(mesh, right, "microstrain", scale)
    title_of_map = f"Largest tensile strain {place_in_words(depth)}" + (
        ", horizontal" if strain == "in-plane" else ""
    )
    headline(right, title_of_map, strain_in_numbers(below, strain, scale), _LETTERS)
    if "friction_work" in data:
        # Over the length of contact, the work per area and length travelled is the work per area of road.
        work = plane(data, "friction_work").sum(axis=1) * (plan.x_edges[1] - plan.x_edges[0]) / 1e3
        _beside(left, data, plan, work, "Work of sliding", "J/m² per passage", SLIP)
    else:
        _beside(left, data, plan, shear.max(axis=1), "Largest shear", "kPa", SLIP)
    _beside(
        right, data, plan, np.maximum(np.nanmax(extension, axis=1), 0.0), "Largest of each strip", "microstrain", INK
    )
    if title:
        figure.suptitle(plain(title), x=0.01, ha="left", fontsize=12.5, fontweight="bold")
    return figure


def _beside(ax: Axes, data: xr.Dataset, plan: Plan, values: Array, title: str, unit: str, colour: str) -> None:
    """A curve over y (ny,) beside a map, as high as the map, with bands where ribs touch."""
    beside = ax.inset_axes((_BESIDE, 0.0, _WIDE, 1.0))
    touches = (plane(data, "pressure") > 0).any(axis=1)
    steps = np.flatnonzero(np.diff(np.pad(touches, 1).astype(int)))
    for low, high in steps.reshape(-1, 2):
        beside.axhspan(plan.y_edges[low], plan.y_edges[high], color=RULE, alpha=0.35, linewidth=0)
    beside.fill_betweenx(plan.y, values, step="mid", color=colour, alpha=0.18, linewidth=0)
    beside.stairs(values, plan.y_edges, orientation="horizontal", color=colour, linewidth=1.3)
    beside.set_ylim(ax.get_ylim())
    beside.set_xlim(0, 1.06 * float(values.max()) or 1.0)
    beside.tick_params(labelleft=False)
    beside.set_xlabel(unit)
    beside.grid(axis="x")
    beside.spines[["top", "right"]].set_visible(False)
    beside.set_title(title, loc="left", fontsize=9.5, fontweight="normal", pad=5)
