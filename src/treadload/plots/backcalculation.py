"""A backcalculation: deflections beside the fitted basin, and moduli with their error bars along the road."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array, IntArray
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, MUTED, RULE, headline, open_axes, plain, styled

_REFUSED = 2
_AXES = {
    "deflection": ("distance from the plate's axis (m)", "deflection, down (µm)"),
    "slope": ("ahead of the wheels (m)", "slope, down towards the wheels (µm/m)"),
}
# Basins whose curves one panel can carry.
_MOST = 8


@figure(
    "Backcalculation", name="basins", main=True, title="Measured and fitted basins", wide=True, order=0,
    caption="Left: measured deflections (dots) and the fitted basin (lines) of a few drops. Right: what every drop "
    "misses at every sensor.",
)  # fmt: skip
@styled
def fitted_basins(backcalculation: Source, *, stations: tuple[str, ...] = ()) -> Figure:
    """Measured deflections beside the fitted basins, and the misfit of all drops by sensor.

    backcalculation: a Backcalculation or its dataset. stations: to draw, at most eight drops; left out, those spread
    over the range of misfits. Returns the figure. Raises InputError if variables or stations are missing.

    >>> asphalt = tl.Layer(tl.Elastic(5e9, 0.35), 0.15, name="asphalt")
    >>> road = tl.Pavement([asphalt, tl.Layer(tl.Elastic(80e6, 0.4), name="soil")])
    >>> drop = tl.roads.Basins([[587e-6, 453e-6, 306e-6, 148e-6, 92e-6]], [0, 0.3, 0.6, 1.2, 1.8], [49.5e3], 0.15)
    >>> result = tl.backcalculate(drop, road, stiff_layer=None)
    >>> tl.plots.fitted_basins(result).axes[0].get_ylabel()
    'deflection, down (µm)'
    """
    data = fields_of(backcalculation, "basin_status", "basin_misfit")
    if "measured_history" in data:
        return _histories(data, stations)
    kind = "slope" if "measured_slope" in data else "deflection"
    data = fields_of(data, f"measured_{kind}", f"fitted_{kind}")
    axis, value = _AXES[kind]
    good = np.flatnonzero(data["basin_status"].to_numpy() != _REFUSED)
    if not len(good):
        raise InputError("no basin was fitted, so that there is nothing to draw; see the reasons of the drops")
    chosen = _chosen(data, good, stations)
    figure = new_figure(10.2, 4.6)
    left, right = figure.subplots(1, 2)
    offsets = data["sensor"].to_numpy()
    for number, drop in enumerate(chosen):
        at, color = data.isel(basin=drop), CASES[number % len(CASES)]
        load, misfit = float(at["plate_load"]) / 1e3, 100 * float(at["basin_misfit"])
        left.plot(offsets, 1e6 * at[f"fitted_{kind}"], color=color, lw=1.3)
        left.plot(
            offsets, 1e6 * at[f"measured_{kind}"], "o", ms=4, color=color,
            label=f"{plain(str(at['station'].item()))}, {load:.3g} kN: misfit {misfit:.2g} %",
        )  # fmt: skip
    if kind == "deflection":
        left.set_ylim(1.05 * left.get_ylim()[1], 0)
    else:
        left.axhline(0, color=MUTED, lw=0.8)
    left.set_xlim(left=min(0.0, -0.02 * float(offsets.max())))
    left.set_xlabel(axis)
    left.set_ylabel(value)
    left.legend(loc="lower right" if kind == "deflection" else "best", fontsize=7.5)
    open_axes(left)
    headline(left, "Basins", "dots: measured; lines: fitted")
    apart = _misfit(data, kind)[good]
    right.axhline(0, color=MUTED, lw=0.8)
    if len(good) > _MOST:
        spreads = [apart[:, k][np.isfinite(apart[:, k])] for k in range(len(offsets))]
        bands = np.array(
            [np.quantile(s, [0.05, 0.25, 0.5, 0.75, 0.95]) if len(s) else [np.nan] * 5 for s in spreads]
        ).T
        right.fill_between(offsets, bands[0], bands[4], color=CASES[0], alpha=0.18, lw=0, label="90 % of the drops")
        right.fill_between(offsets, bands[1], bands[3], color=CASES[0], alpha=0.35, lw=0, label="half of them")
        right.plot(offsets, bands[2], "o-", ms=4, color=CASES[0], label="median")
        right.legend(loc="best", fontsize=8)
    else:
        for number in range(len(good)):
            right.plot(offsets, apart[number], "o-", ms=4, color=CASES[number % len(CASES)])
    right.set_xlabel(axis)
    right.set_ylabel("fitted less measured (%)" if kind == "deflection" else "fitted less measured (% of the rms)")
    open_axes(right)
    headline(right, "Misfit by sensor", f"{len(good)} drops; a trend points at the structure, not at a sensor")
    return figure


@figure(
    "Backcalculation", name="moduli", title="Moduli along the road", wide=True, order=1,
    caption="Fitted moduli of every layer with their 90 % intervals. Hollow: flagged, or at a bound and without "
    "an interval.",
)  # fmt: skip
@styled
def moduli_along(backcalculation: Source, *, load: float | None = None) -> Figure:
    """Moduli of the layers with their 90 % intervals along the road, a panel for each layer.

    backcalculation: a Backcalculation or its dataset. load: N, of which drops within 12 % are drawn; left out, all
    of them, coloured by load. Returns the figure. Raises InputError if variables are missing and without any drop.

    >>> asphalt = tl.Layer(tl.Elastic(5e9, 0.35), 0.15, name="asphalt")
    >>> road = tl.Pavement([asphalt, tl.Layer(tl.Elastic(80e6, 0.4), name="soil")])
    >>> drop = tl.roads.Basins([[587e-6, 453e-6, 306e-6, 148e-6, 92e-6]], [0, 0.3, 0.6, 1.2, 1.8], [49.5e3], 0.15)
    >>> result = tl.backcalculate(drop, road, stiff_layer=None)
    >>> [ax.get_ylabel().split()[0] for ax in tl.plots.moduli_along(result).axes]
    ['asphalt', 'soil']
    """
    data = fields_of(backcalculation, "fitted_modulus", "modulus_low", "modulus_high", "basin_status", "plate_load")
    chosen = data["basin_status"].to_numpy() != _REFUSED
    loads = data["plate_load"].to_numpy()
    if load is not None:
        chosen &= np.abs(loads / load - 1) < 0.12
    if not chosen.any():
        raise InputError("no fitted drop has this load, so that there is nothing to draw")
    data = data.isel(basin=np.flatnonzero(chosen))
    places, label = _places(data)
    names = [str(name) for name in data["layer_name"].to_numpy()]
    figure = new_figure(10.2, 1.0 + 1.75 * len(names))
    axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    classes = _classes(data["plate_load"].to_numpy())
    width = float(np.min(np.diff(np.unique(places)), initial=np.inf)) if len(places) > 1 else 1.0
    for row, (ax, name) in enumerate(zip(axes, names, strict=True)):
        at = data.isel(layer_name=row)
        for number, (kilonewtons, drops) in enumerate(classes):
            shift = (
                0.0
                if len(classes) == 1 or not np.isfinite(width)
                else 0.16 * width * (number - (len(classes) - 1) / 2)
            )
            _marks(
                ax, places[drops] + shift, at.isel(basin=drops), CASES[number % len(CASES)], f"{kilonewtons:.3g} kN"
            )
        ax.set_yscale("log")
        _limits(ax, 1e-6 * at["fitted_modulus"].to_numpy())
        ax.set_ylabel(f"{plain(name)}\n(MPa)")
        ax.grid(True, which="major", color=RULE, lw=0.6)
        open_axes(ax)
    axes[-1].set_xlabel(label)
    if len(classes) > 1:
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower right", ncols=len(classes), fontsize=8)
    headline(axes[0], "Moduli along the road", "bars: 90 %; hollow: flagged")
    return figure


def _histories(data: xr.Dataset, stations: tuple[str, ...]) -> Figure:
    """Deflections over time of a drop, every sensor measured and fitted, and what each misses."""
    good = np.flatnonzero(data["basin_status"].to_numpy() != _REFUSED)
    at = data.isel(basin=_chosen(data, good, stations)[0])
    figure = new_figure(10.2, 4.6)
    left, right = figure.subplots(1, 2)
    time, sensors = 1e3 * data["history_time"].to_numpy(), data["sensor"].to_numpy()
    for number, sensor in enumerate(sensors):
        color = CASES[number % len(CASES)]
        measured, fitted = (
            1e6 * at[f"{kind}_history"].isel(sensor=number).to_numpy() for kind in ("measured", "fitted")
        )
        left.plot(time, measured, "o", ms=3, color=color, label=f"{sensor:g} m")
        left.plot(time, fitted, color=color, lw=1.2)
        right.plot(time, fitted - measured, color=color, lw=1.2)
    left.set_ylim(left.get_ylim()[::-1])
    left.legend(fontsize=7.5, ncols=2)
    for axes, value in ((left, "deflection, down (µm)"), (right, "fitted less measured (µm)")):
        axes.set_xlabel("time (ms)")
        axes.set_ylabel(value)
        open_axes(axes)
    headline(left, f"Drop {plain(str(at['station'].item()))}", "dots: measured; lines: fitted, without inertia")
    headline(right, "Misfit over time", "what comes late is inertia")
    return figure


def _misfit(data: xr.Dataset, kind: str) -> Array:
    """Fitted less measured, % of each deflection, or of the size of all slopes, which pass through zero."""
    measured, fitted = data[f"measured_{kind}"].to_numpy(), data[f"fitted_{kind}"].to_numpy()
    size = measured if kind == "deflection" else np.sqrt(np.nanmean(measured**2, axis=1, keepdims=True))
    return np.asarray(100 * (fitted - measured) / size)


def _chosen(data: xr.Dataset, good: IntArray, stations: tuple[str, ...]) -> list[int]:
    if stations:
        names = [str(name) for name in data["station"].to_numpy()]
        wrong = next((name for name in stations if name not in names), None)
        if wrong is not None:
            raise InputError(f"there is no station {wrong!r}; {nearest(wrong, dict.fromkeys(names))}")
        drops = [int(k) for k in good if names[k] in stations]
        return drops[:_MOST]
    order = good[np.argsort(data["basin_misfit"].to_numpy()[good])]
    count = min(len(good), 4)
    return [int(order[k]) for k in np.linspace(0, len(order) - 1, count).round().astype(int)]


def _places(data: xr.Dataset) -> tuple[Array, str]:
    """Where each drop stands, and what the axis counts: metres where all are known, else stations in their order."""
    along = data["drop_position"].to_numpy()
    if np.isfinite(along).all():
        return along, "along the road (m)"
    names = [str(name) for name in data["station"].to_numpy()]
    order = {name: number + 1 for number, name in enumerate(dict.fromkeys(names))}
    return np.array([float(order[name]) for name in names]), "station, in the order of the file"


def _classes(loads: Array) -> list[tuple[float, IntArray]]:
    order = np.argsort(loads)
    cuts = np.flatnonzero(np.diff(loads[order]) > 0.12 * loads[order][:-1]) + 1
    return [(float(np.median(loads[part])) / 1e3, np.sort(part)) for part in np.split(order, cuts)]


def _marks(ax: Axes, places: Array, at: xr.Dataset, color: str, label: str) -> None:
    moduli = 1e-6 * at["fitted_modulus"].to_numpy()
    low, high = 1e-6 * at["modulus_low"].to_numpy(), 1e-6 * at["modulus_high"].to_numpy()
    fine = np.isfinite(low) & np.isfinite(high) & np.isfinite(moduli)
    ax.errorbar(
        places[fine], moduli[fine], yerr=[(moduli - low)[fine], (high - moduli)[fine]], fmt="none", color=color,
        elinewidth=0.8, capsize=0, alpha=0.7, zorder=2,
    )  # fmt: skip
    solid = (at["basin_status"].to_numpy() == 0) & fine
    ax.plot(places[solid], moduli[solid], "o", ms=3.2, color=color, label=label, zorder=3)
    hollow = ~solid & np.isfinite(moduli)
    ax.plot(places[hollow], moduli[hollow], "o", ms=3.2, mfc="white", color=color, mew=0.8, zorder=3)
    if not solid.any():
        ax.plot([], [], "o", ms=3.2, color=color, label=label)


def _limits(ax: Axes, moduli: Array) -> None:
    """Over the moduli: bars of what is undecided leave the panel."""
    there = moduli[np.isfinite(moduli)]
    if len(there):
        low, high = np.quantile(there, [0.01, 0.99])
        ax.set_ylim(low / 2.5, high * 2.5)
    ax.tick_params(colors=INK)
