"""A tire's Magic Formula beside the solved curves that it was fitted to."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.footprint import FittedFormula
from treadload.footprint.slip_curves import SlipCurve
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled

# Points of a line between the ends of a curve.
_FINE = 301
# Opacity of curves at other inflation pressures than the nominal one.
_PALE = 0.35


@styled
def tir_fit(fit: FittedFormula) -> Figure:
    """Forces over the load and moments of solves (points) and of the fitted formula (lines), by load.

    Curves at other inflation pressures than the nominal one are pale.

    Panels: along travel, across, aligning moment, and both slips together. Returns the figure.
    """
    figure = new_figure(9.6, 7.4)
    (along, across), (moment, combined) = figure.subplots(2, 2)
    loads = sorted({curve.normal_load for curve in fit.curves})
    for curve in fit.curves:
        color = CASES[loads.index(curve.normal_load) % len(CASES)]
        label = "" if curve.inflation_pressure else f"{curve.normal_load / 1e3:g} kN"
        if curve.kind == "across":
            _draw(across, fit, curve, "lateral_force", color, label)
            _draw(moment, fit, curve, "aligning_moment", color, label)
        else:
            _draw(along if curve.kind == "along" else combined, fit, curve, "tractive_force", color, label)
            if curve.kind == "combined":
                _draw(combined, fit, curve, "lateral_force", color, "", "--")
    angles = sorted({float(np.degrees(curve.slip_angle[0])) for curve in fit.curves if curve.kind == "combined"})
    for ax, title, text, label in (
        (along, "Along travel", "points: solved; lines: fitted", "tractive force over the load (–)"),
        (across, "Across travel", "against the slip", "lateral force over the load (–)"),
        (moment, "Aligning moment", "of the road on the tire, about the vertical", "moment (N m)"),
        (
            combined,
            "Combined slip",
            f"at {' and '.join(f'{angle:g}°' for angle in angles)}; solid: along, dashed: across",
            "force over the load (–)",
        ),
    ):
        ax.axhline(0, color=MUTED, lw=0.7)
        ax.set_xlabel("slip κ (–)" if ax in (along, combined) else "slip angle (°)")
        ax.set_ylabel(label)
        headline(ax, title, text)
    open_axes(along, across, moment, combined)
    across.legend()
    return figure


def _draw(
    ax: Axes, fit: FittedFormula, curve: SlipCurve, variable: str, color: str, label: str, dash: str = "-"
) -> None:
    """A curve and its fit."""
    slip, angle = curve.slip, curve.slip_angle
    start = 0.0 if curve.kind == "across" else slip.min()
    fine = {
        "slip": np.linspace(start, slip.max(), _FINE),
        "slip_angle": np.linspace(0.0 if curve.kind == "across" else angle.min(), angle.max(), _FINE),
    }
    # The force of the road acts against the slip to the right.
    scale = 1.0 if variable == "aligning_moment" else curve.normal_load * (-1 if variable == "lateral_force" else 1)
    over = ("slip_angle", np.degrees(angle)) if curve.kind == "across" else ("slip", slip)
    at = np.degrees(fine[over[0]]) if over[0] == "slip_angle" else fine[over[0]]
    pressure = curve.inflation_pressure
    line = getattr(fit.formula.forces(curve.normal_load, **fine, inflation_pressure=pressure), variable)
    alpha = 1.0 if pressure is None else _PALE
    ax.plot(at, line / scale, label=label or None, lw=1.3, ls=dash, color=color, alpha=alpha)
    ax.plot(over[1], getattr(curve, variable) / scale, "o", ms=3.5, mew=0, color=color, alpha=alpha)
