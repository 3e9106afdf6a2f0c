"""A calibration: data against the fitted tire, residuals, and how sure its numbers are."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, MUTED, RULE, headline, open_axes, styled

_NEEDED = ("measured_reading", "fitted_reading", "residual", "residual_before")
# Of a normal distribution between its 2.5 and 97.5 % quantiles, standard deviations on each side.
_TWO = 1.96
_OF_KINDS = {"rib_shares": "shares of ribs", "footprint": "shares of blocks", "pins": "shear of pins"}


@figure(
    "Calibration", name="fit", main=True, title="Data and fitted tire", wide=True, order=0,
    caption="Dots: measured, lines: fitted; residuals are counted in standard deviations of the readings.",
)  # fmt: skip
@styled
def calibration_fit(calibration: Source) -> Figure:
    """Load against deflection, measured and fitted, beside the residuals of all readings by their kind.

    calibration: a Calibration or its dataset; without deflections the residuals stand alone. Returns the figure.
    Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> loads = {100.0: 0.74e-3, 200.0: 1.18e-3}  # N: m
    >>> measured = [tl.footprint.Measured(load=load, deflection=depth) for load, depth in loads.items()]
    >>> calibration = tl.calibrate(tire, ["modulus"], measured, spacing=0.006)
    >>> [ax.get_title(loc="left") for ax in tl.plots.calibration_fit(calibration).axes]
    ['Load and deflection', 'Residuals']
    """
    data = fields_of(calibration, *_NEEDED)
    deflections = data.isel(reading=np.flatnonzero(data["kind"].to_numpy() == "deflection"))
    if not deflections.sizes["reading"]:
        figure = new_figure(6.4, 4.2)
        _residuals(figure.subplots(), data)
        return figure
    figure = new_figure(10.2, 4.4)
    left, right = figure.subplots(1, 2)
    _deflections(left, deflections)
    _residuals(right, data)
    return figure


def _deflections(ax: Axes, data: xr.Dataset) -> None:
    pressures = data["inflation_pressure"].to_numpy()
    distinct = sorted(set(pressures[np.isfinite(pressures)])) or [np.nan]
    for number, pressure in enumerate(distinct):
        here = np.flatnonzero((pressures == pressure) | np.isnan(pressure))
        row = data.isel(reading=here).sortby("wheel_load")
        loads = row["wheel_load"].to_numpy() / 1e3
        color = CASES[number % len(CASES)]
        label = "" if np.isnan(pressure) else f"{pressure / 1e3:.0f} kPa"
        ax.errorbar(
            1e3 * row["measured_reading"], loads, xerr=_TWO * 1e3 * row["reading_error"], fmt="o", ms=4.5,
            color=color, elinewidth=1, capsize=2, label=f"measured, {label}".rstrip(", "), zorder=3,
        )  # fmt: skip
        # From the origin, which every tire passes; between readings a guide to the eye.
        ax.plot(np.append(0, 1e3 * row["fitted_reading"]), np.append(0, loads), color=color, lw=1.4, label="_")
        ax.plot(
            np.append(0, 1e3 * row["reading_before"]), np.append(0, loads), color=color, lw=0.9, ls=":", label="_"
        )
    ax.plot([], [], color=INK, lw=1.4, label="fitted")
    ax.plot([], [], color=INK, lw=0.9, ls=":", label="before")
    ax.set_xlabel("deflection (mm)")
    ax.set_ylabel("vertical load (kN)")
    ax.set_xlim(left=0)
    ax.set_ylim(bottom=0)
    ax.legend(loc="upper left")
    open_axes(ax)
    headline(ax, "Load and deflection", "bars: 95 % of what the errors allow")


def _residuals(ax: Axes, data: xr.Dataset) -> None:
    kinds = data["kind"].to_numpy()
    distinct = list(dict.fromkeys(kinds))
    ax.axvspan(-_TWO, _TWO, color=RULE, alpha=0.45, lw=0)
    ax.axvline(0, color=MUTED, lw=0.8)
    for place, kind in enumerate(distinct):
        here = kinds == kind
        # Readings of a kind in the order of the data, one below the other.
        places = place + (np.linspace(-0.3, 0.3, int(here.sum())) if here.sum() > 1 else np.zeros(1))
        ax.plot(data["residual_before"].to_numpy()[here], places, ls="", marker="o", ms=3.5, mfc="none", color=MUTED)
        ax.plot(data["residual"].to_numpy()[here], places, ls="", marker="o", ms=4.5, color=CASES[place % len(CASES)])
    ax.plot([], [], ls="", marker="o", ms=4.5, color=INK, label="fitted")
    ax.plot([], [], ls="", marker="o", ms=3.5, mfc="none", color=MUTED, label="before")
    ax.legend(loc="upper right", ncols=2)
    ax.set_yticks(range(len(distinct)), [_OF_KINDS.get(kind, kind.replace("_", " ")) for kind in distinct])
    ax.set_ylim(len(distinct) - 0.4, -0.9)
    # What the search began with may lie far off; the fit rules the scale.
    most = max(3.0, 1.25 * float(np.abs(data["residual"]).max()))
    ax.set_xlim(-most, most)
    ax.set_xlabel("fitted less measured, over the error (–)")
    open_axes(ax)
    headline(ax, "Residuals", "band: 95 % of readings with the errors that were taken")


@figure(
    "Calibration", name="numbers", title="Numbers and their error bars", wide=True, order=1,
    caption="95 % intervals of the fitted numbers, and their correlations.",
)  # fmt: skip
@styled
def calibration_numbers(calibration: Source) -> Figure:
    """How sure the fitted numbers are, and which of them go together.

    calibration: a Calibration or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> loads = {100.0: 0.74e-3, 200.0: 1.18e-3}  # N: m
    >>> measured = [tl.footprint.Measured(load=load, deflection=depth) for load, depth in loads.items()]
    >>> calibration = tl.calibrate(tire, ["modulus"], measured, spacing=0.006)
    >>> [ax.get_title(loc="left") for ax in tl.plots.calibration_numbers(calibration).axes[:2]]
    ['How sure the numbers are', 'Correlation']
    """
    data = fields_of(calibration, "fitted_value", "standard_deviation", "number_correlation", "start_value")
    names = [str(name).replace("_", " ") for name in data["unknown"].to_numpy()]
    count = len(names)
    figure = new_figure(10.2, max(3.0, 1.6 + 0.55 * count))
    left, right = figure.subplots(1, 2, width_ratios=[1.5, 1])
    value = data["fitted_value"].to_numpy()
    size = np.where(value == 0, 1.0, np.abs(value))
    parts = _TWO * data["standard_deviation"].to_numpy() / size
    before = (data["start_value"].to_numpy() - value) / size
    left.axvline(0, color=MUTED, lw=0.8)
    finite = np.isfinite(parts)
    places = np.arange(count)
    left.errorbar(
        np.zeros(count)[finite], places[finite], xerr=100 * parts[finite], fmt="o", ms=5, capsize=3, color=CASES[0]
    )
    left.plot(100 * before, places, ls="", marker="|", ms=11, mew=1.6, color=MUTED, label="before")
    for place in places[~finite]:
        left.annotate(
            "not determined by these data", (0, place), xytext=(8, 6), textcoords="offset points", color=CASES[1]
        )
    left.set_yticks(places, names)
    left.set_ylim(count - 0.5, -0.5)
    left.set_xlabel("from the fitted number (%)")
    left.legend(loc="best")
    open_axes(left)
    headline(left, "How sure the numbers are", "bars: 95 %")
    matrix = data["number_correlation"].to_numpy()
    right.imshow(matrix, cmap="RdBu_r", vmin=-1, vmax=1)
    for i in range(count):
        for j in range(count):
            text = f"{matrix[i, j]:+.2f}" if np.isfinite(matrix[i, j]) else "–"
            dark = np.isfinite(matrix[i, j]) and abs(matrix[i, j]) > 0.6
            right.text(j, i, text, ha="center", va="center", color="white" if dark else INK, fontsize=8.5)
    right.set_xticks(places, names, rotation=30, ha="right")
    right.set_yticks(places, names if count > 1 else [""])
    right.tick_params(length=0)
    headline(right, "Correlation", "near ±1: only together are they known")
    return figure
