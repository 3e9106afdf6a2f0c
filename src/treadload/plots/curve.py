"""Creep curves: force and moment against creepage."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from treadload.errors import InputError
from treadload.plots.figure import new_figure
from treadload.plots.plan import Source, fields_of
from treadload.plots.style import CASES, MUTED, headline, styled

_FORCE = {"x": ("tractive_force", "tractive force over μP"), "y": ("lateral_force", "lateral force over μP")}


@styled
def creep_curves(curves: Sequence[Source], labels: Sequence[str], *, along: str = "x") -> Figure:
    """Force over friction times load, and the share of the contact that slips, against creepage.

    curves: with forces, friction, normal_load and slip_fraction over `creepage`. labels: a name each.
    along: "x" or "y". Returns the figure; for "y" with the aligning moment in the second panel.
    Raises InputError if labels do not match or variables are missing.
    """
    force, name = _FORCE[along]
    cases = [fields_of(curve, force, "friction", "normal_load", "slip_fraction") for curve in curves]
    if len(cases) != len(labels) or not cases:
        raise InputError(f"give a label for each curve: got {len(labels)} labels for {len(cases)} curves")
    figure = new_figure(8.6, 3.9)
    left, right = figure.subplots(1, 2)
    for number, (case, label) in enumerate(zip(cases, labels, strict=True)):
        data, colour = case.sortby("creepage"), CASES[number % len(CASES)]
        limit = (data.friction * data.normal_load).values
        left.plot(data.creepage, data[force].values / limit, "o-", ms=3, color=colour, label=label)
        right.plot(data.creepage, _second(data, along), "o-", ms=3, color=colour, label=label)
    for ax in (left, right):
        ax.axhline(0, color=MUTED, lw=0.7)
        ax.axvline(0, color=MUTED, lw=0.7)
        ax.grid(True)
        ax.spines[["top", "right"]].set_visible(False)
        ax.set_xlabel(f"creepage along {along}")
    left.set_ylabel(name)
    headline(left, "Creep curve", "negative creepage drives" if along == "x" else "force of the road, to the right")
    right.set_ylabel("share of the contact that slips (%)" if along == "x" else "aligning moment (N m)")
    if along == "x":
        headline(right, "Slip zone", "all of the contact slips in gross sliding")
    else:
        headline(right, "Aligning moment", "about the vertical through the origin, of the road on the tire")
    if len(cases) > 1:
        left.legend()
    return figure


def _second(data: xr.Dataset, along: str) -> np.ndarray:
    values: np.ndarray = 100 * data.slip_fraction.values if along == "x" else data.aligning_moment.values
    return values
