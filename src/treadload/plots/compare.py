"""Cases side by side on one scale."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, comparison
from treadload.plots.contact import pressure_in_numbers
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import (
    KPA,
    MICRO,
    Limits,
    Plan,
    colour_bar,
    draw_cells,
    draw_outline,
    fields_of,
    limits,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.kit.style import MUTED, headline, measure, sequential, styled, travel_arrow
from treadload.plots.response import (
    DRAWN,
    NAMES,
    STRAINS,
    VARIABLE,
    WHAT,
    Strain,
    draw_strain,
    place_in_words,
    strain_in_numbers,
    strain_plane,
)

_MOST_COLUMNS = 3
# Width of a panel, inches.
_PANEL = 4.3
# Letters of a label in a line over a panel.
_LETTERS = 38


@comparison(
    "Contact", title="Contact pressure, side by side",
    caption="One colour scale for all cases, seen from above; rings mark the largest pressure.",
)  # fmt: skip
@styled
def compare_pressure(contacts: Sequence[Source], labels: Sequence[str]) -> Figure:
    """Contact pressures of several cases side by side on one colour scale, kPa.

    contacts: with pressure (y, x), Pa. labels: a name each. Returns the figure with one colour bar.
    Raises InputError for a missing pressure or labels that do not match.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> free = tl.solve_contact(tire, road, tl.Rolling(normal_load=50.0, friction=0.7), spacing=0.006)
    >>> figure = tl.plots.compare_pressure([contact, free], ["100 N", "50 N"])
    >>> [ax.get_title(loc="left") for ax in figure.axes[:2]]
    ['100 N', '50 N']
    """
    _check(contacts, labels)
    cases = [fields_of(contact, "pressure") for contact in contacts]
    values = [plane(data, "pressure") * KPA for data in cases]
    scale = limits(*values)
    plans = [Plan.of(data) for data in cases]

    def draw(ax: Axes, number: int) -> QuadMesh:
        plan, here = plans[number], values[number]
        mesh = draw_cells(ax, plan, np.where(here > 0, here, np.nan), sequential("pressure"), scale)
        draw_outline(ax, here > 0, plan, MUTED, 0.5)
        row, column = peak_of(here)
        mark_peak(ax, float(plan.x[column]), float(plan.y[row]), f"{measure(here[row, column])} kPa")
        travel_arrow(ax)
        headline(ax, labels[number], pressure_in_numbers(cases[number]), _LETTERS)
        return mesh

    return _side_by_side(plans, draw, "contact pressure (kPa)", scale)


def _strains(cases: Sequence[xr.Dataset]) -> Iterator[Drawing]:
    """Both strains at the shallowest depth that all cases have."""
    depths = [{round(float(depth), 9) for depth in np.atleast_1d(data["depth"].to_numpy())} for data in cases]
    for depth in sorted(set.intersection(*depths))[:1]:
        for strain in STRAINS:
            if all(VARIABLE[strain] in data for data in cases):
                yield Drawing(
                    {"depth": depth, "strain": strain},
                    f"Largest tensile strain, {NAMES[strain]}, side by side",
                    f"Drawn: {DRAWN[strain]}, {place_in_words(depth)}, on one colour scale; rings mark the peaks. "
                    f"{WHAT[strain]}",
                )


@comparison(
    "Response", title="Largest tensile strain, side by side", caption="", when=_strains, answers=True
)  # fmt: skip
@styled
def compare_strain(
    responses: Sequence[Source], labels: Sequence[str], *, depth: float = 0.0, strain: Strain = "principal"
) -> Figure:
    """Strain maps of several cases side by side on one colour scale.

    responses: with the strain and its direction over (depth, y, x). labels: a name each. depth: m.
    strain: "principal" (three-dimensional) or "in-plane". Returns the figure with one colour bar.
    Raises InputError for missing variables or depths, or labels that do not match.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> thick = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.25), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> responses = [tl.solve_response(plate, r, depths=[0.15], x=x, y=y) for r in (road, thick)]
    >>> figure = tl.plots.compare_strain(responses, ["150 mm", "250 mm"], depth=0.15)
    >>> [ax.get_title(loc="left") for ax in figure.axes[:2]]
    ['150 mm', '250 mm']
    """
    _check(responses, labels)
    planes = [strain_plane(response, depth, strain) for response in responses]
    name = "principal_strain_1" if strain == "principal" else "in_plane_strain_1"
    scale = limits(*(plane(data, name) * MICRO for data in planes))

    def draw(ax: Axes, number: int) -> QuadMesh:
        mesh = draw_strain(ax, planes[number], strain, scale, responses[number])
        headline(ax, labels[number], strain_in_numbers(planes[number], strain, Limits(0, scale.high)), _LETTERS)
        return mesh

    label = f"largest tensile strain {place_in_words(depth)}, {NAMES[strain]} (microstrain)"
    return _side_by_side([Plan.of(data) for data in planes], draw, label, scale)


def _check(sources: Sequence[Source], labels: Sequence[str]) -> None:
    if not sources or len(sources) != len(labels):
        raise InputError(f"give a label for each case: got {len(labels)} labels for {len(sources)} cases")


def _side_by_side(plans: Sequence[Plan], draw: Callable[[Axes, int], QuadMesh], label: str, scale: Limits) -> Figure:
    """Panels of equal millimetres, up to three in a row, beside one colour bar."""
    count = len(plans)
    columns = min(count, _MOST_COLUMNS)
    rows = math.ceil(count / columns)
    left, right = min(p.x_edges[0] for p in plans), max(p.x_edges[-1] for p in plans)
    top, bottom = min(p.y_edges[0] for p in plans), max(p.y_edges[-1] for p in plans)
    aspect = float((bottom - top) / (right - left))
    figure = new_figure(columns * _PANEL + 1.6, rows * min(8.0, (_PANEL - 0.35) * aspect + 1.0), "compressed")
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    panels: list[Axes] = list(grid.ravel())
    meshes = [draw(panels[number], number) for number in range(count)]
    for ax in panels[count:]:
        ax.set_visible(False)
    for number, ax in enumerate(panels[:count]):
        ax.set_xlim(left, right)
        ax.set_ylim(bottom, top)
        if number % columns:
            ax.set_ylabel("")
    colour_bar(meshes[0], panels[columns - 1], label, scale)
    return figure
