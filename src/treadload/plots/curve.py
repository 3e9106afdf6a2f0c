"""Creep curves: force and moment against creepage."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled

_FORCE = {"x": ("tractive_force", "tractive force over μP (–)"), "y": ("lateral_force", "lateral force over μP (–)")}

_LINES = ("-", "-", (0, (3, 1.5)))


@styled
def creep_curves(curves: Sequence[Source], labels: Sequence[str], *, along: str = "x") -> Figure:
    """Force over friction times load, and the share of the contact that slips, against creepage.

    curves: with forces, friction, normal_load and slip_fraction over `creepage`. labels: a name each.
    along: "x" or "y". Returns the figure; for "y" with the aligning moment in the second panel.
    Raises InputError if labels do not match or variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> curve = tl.contact.creep_curve(tire, road, wheel, [0.5], spacing=0.006)
    >>> figure = tl.plots.creep_curves([curve], ["ball"])
    >>> f"Q = {abs(figure.axes[0].lines[0].get_ydata()).max():.2f} μP where all slides"
    'Q = 1.00 μP where all slides'
    """
    force, name = _FORCE[along]
    cases = [fields_of(curve, force, "friction", "normal_load", "slip_fraction") for curve in curves]
    if len(cases) != len(labels) or not cases:
        raise InputError(f"give a label for each curve: got {len(labels)} labels for {len(cases)} curves")
    figure = new_figure(8.6, 3.9)
    left, right = figure.subplots(1, 2)
    for number, (case, label) in enumerate(zip(cases, labels, strict=True)):
        data, look = case.sortby("creepage"), _look(number, len(cases))
        limit = (data.friction * data.normal_load).values
        left.plot(data.creepage, data[force].values / limit, label=label, **look)
        right.plot(data.creepage, _second(data, along), label=label, **look)
    open_axes(left, right)
    for ax in (left, right):
        ax.axhline(0, color=MUTED, lw=0.7)
        ax.axvline(0, color=MUTED, lw=0.7)
        ax.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        ax.set_xlabel(f"creepage along {along} (–)")
    left.set_ylabel(name)
    headline(left, "Creep curve", "negative creepage drives" if along == "x" else "force of the road, to the right")
    right.set_ylabel("share of the contact that slips (%)" if along == "x" else "aligning moment (N m)")
    if along == "x":
        headline(right, "Slip zone", "all of the contact slips in gross sliding")
    else:
        headline(right, "Aligning moment", "of the road on the tire, about the vertical")
    if len(cases) > 1:
        left.legend()
    return figure


@figure(
    "CreepCurve", main=True, title="Force against creepage", wide=True,
    caption="Force over friction times load, and the share of the contact that slips, against creepage.",
)  # fmt: skip
def forces(curve: Source, *, along: str = "") -> Figure:
    """Force and slip of one curve against creepage.

    curve: a CreepCurve or its dataset. along: "x" or "y"; left out, that of the curve. Returns the figure. Raises
    InputError as `creep_curves`.
    """
    data = dataset_of(curve)
    prescribed = data["creepage_y"].to_numpy() if "creepage_y" in data else np.empty(0)
    sideways = prescribed.size and bool((abs(prescribed - data["creepage"].to_numpy()) < 1e-12).all())
    direction = along or str(getattr(curve, "along", "")) or ("y" if sideways else "x")
    return creep_curves([curve], [f"along {direction}"], along=direction)


def _look(number: int, count: int) -> dict[str, object]:
    """Line of a curve among several: each thinner than the one under it, so that coinciding curves all show."""
    share = number / max(1, count - 1)
    return {
        "color": CASES[number % len(CASES)],
        "lw": 1.6 if count == 1 else 3.4 - 2.2 * share,
        "ls": _LINES[number % len(_LINES)] if count > 1 else "-",
        "marker": "o",
        "ms": 3.0 if count == 1 else 4.6 - 1.8 * share,
        "mew": 0,
        "zorder": 2 + 0.1 * number,
    }


def _second(data: xr.Dataset, along: str) -> np.ndarray:
    values: np.ndarray = 100 * data.slip_fraction.values if along == "x" else data.aligning_moment.values
    return values
