"""A wheel over a step, a joint or a plate: pressures along the way, contacts in a row, work at the edge."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import KPA, MM, Limits, colour_bar, fields_of, limits
from treadload.plots.kit.style import CASES, MUTED, headline, measure, open_axes, sequential, signed, styled

_KJ = 1e-3
_GROUND = "#e4e7ec"
# Contacts that a strip shows.
_SHOWN = 5


@figure(
    "Crossing", name="history", main=True, title="Along the way", wide=True,
    caption="Peak pressures, shares of the load, and the work that each place of the road takes.",
)  # fmt: skip
@styled
def crossing_history(crossing: Source) -> Figure:
    """Largest pressure, at an edge and anywhere, the shares of the load, and work per place of the road.

    crossing: a Crossing or its dataset. Returns the figure.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> step, free = tl.pavement.RoadStep(0.001), tl.Rolling(normal_load=100.0, friction=0.0)
    >>> crossing = tl.contact.cross_obstacle(tire, road, free, step, positions=[-0.06, 0.06], spacing=0.006)
    >>> [ax.get_ylabel() for ax in tl.plots.crossing_history(crossing).axes[:2]]
    ['largest pressure (kPa)', 'share of the load (%)']
    """
    names = ("largest_pressure", "edge_pressure", "share_before", "share_beyond", "closing_work", "road_height")
    data = fields_of(crossing, *names, "position", "road_x")
    at, place = data["position"].to_numpy() * MM, data["road_x"].to_numpy() * MM
    figure = new_figure(7.4, 7.4)
    upper, middle, lower = figure.subplots(3, 1)
    upper.plot(at, data["largest_pressure"] * KPA, color=CASES[0], label="anywhere")
    upper.plot(at, data["edge_pressure"] * KPA, color=CASES[1], label="at an edge")
    if "plain_pressure" in data:
        upper.axhline(float(data["plain_pressure"]) * KPA, color=MUTED, lw=0.9, ls="--", label="without the obstacle")
    upper.set_ylabel("largest pressure (kPa)")
    upper.set_ylim(bottom=0)
    upper.legend()
    before, beyond = data["share_before"].to_numpy() * 100, data["share_beyond"].to_numpy() * 100
    shares = (before, 100 - before - beyond, beyond)
    for share, label, colour in zip(shares, ("before", "between the edges", "beyond"), CASES, strict=False):
        middle.plot(at, share, color=colour, label=label)
    middle.set_ylabel("share of the load (%)")
    middle.set_xlabel("place of the axle along the road (mm)")
    middle.legend()
    work = data["closing_work"].transpose("y", "road_x").to_numpy().max(axis=0) * _KJ
    lower.plot(place, work, color=CASES[0], label="closing")
    if "plain_work" in data:
        lower.axhline(
            float(data["plain_work"]) * _KJ, color=MUTED, lw=0.9, ls="--", label="closing, without the obstacle"
        )
    if "friction_work_density" in data:
        rubbed = data["friction_work_density"].transpose("y", "road_x").to_numpy().max(axis=0) * _KJ
        lower.plot(place, rubbed, color=CASES[1], label="sliding")
    lower.set_ylabel("largest work (kJ/m²)")
    lower.set_xlabel("place along the road (mm)")
    # Within, letters would lie on the road.
    lower.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)
    road = lower.twinx()
    road.plot(place, _middle(data) * MM, color=MUTED, lw=0.9)
    road.set_ylabel("height of the road (mm)")
    open_axes(upper, middle, lower)
    high = float(data["largest_pressure"].max()) * KPA
    headline(upper, "Across the obstacle", f"at most {measure(high)} kPa")
    return figure


def _middle(data: xr.Dataset) -> Array:
    """Height of the road along the middle of the wheel, m."""
    row = int(np.abs(data["y"].to_numpy()).argmin())
    return np.asarray(data["road_height"].transpose("y", "road_x").to_numpy()[row], dtype=float)


def _off_the_road_before(data: xr.Dataset) -> Array:
    """From where to where (k, 2) the road does not lie as high as before the obstacle, m; borders of cells."""
    height, place = _middle(data), data["road_x"].to_numpy()
    borders = np.append(place, 2 * place[-1] - place[-2]) - 0.5 * np.diff(place).mean()
    changes = np.flatnonzero(np.diff(np.pad(np.abs(height - height[0]) > 1e-9, 1)))
    return np.asarray(borders[changes].reshape(-1, 2))


@figure("Crossing", name="contacts", title="Contacts", caption="Each at its place on the road.", wide=True)
@styled
def crossing_contacts(crossing: Source) -> Figure:
    """A strip of contacts from the first position to the last, kPa, each where it stands on the road.

    crossing: a Crossing or its dataset. Returns the figure.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> step, free = tl.pavement.RoadStep(0.001), tl.Rolling(normal_load=100.0, friction=0.0)
    >>> crossing = tl.contact.cross_obstacle(tire, road, free, step, positions=[-0.06, 0.06], spacing=0.006)
    >>> tl.plots.crossing_contacts(crossing).axes[0].get_title(loc="left")
    '−60 mm'
    """
    data = fields_of(crossing, "pressure", "position", "x", "y", "road_x", "road_height")
    x, y = data["x"].to_numpy() * MM, data["y"].to_numpy() * MM
    at = data["position"].to_numpy() * MM
    shown = sorted({round(number) for number in np.linspace(0, len(at) - 1, min(_SHOWN, len(at)))})
    values = data["pressure"].transpose("position", "y", "x").to_numpy()[shown] * KPA
    scale: Limits = limits(values)
    obstacle = _off_the_road_before(data) * MM
    figure = new_figure(min(2.1 * len(shown) + 1.2, 12.0), 4.4)
    axes = np.atleast_1d(figure.subplots(1, len(shown), sharey=True))
    for ax, number, here in zip(axes, shown, values, strict=True):
        mesh = ax.pcolormesh(
            x + at[number], y, np.where(here > 0, here, np.nan), cmap=sequential("pressure"), vmin=scale.low,
            vmax=scale.high, shading="nearest", rasterized=True,
        )  # fmt: skip
        ax.set_aspect("equal")
        for start, stop in obstacle:
            ax.axvspan(start, stop, color=_GROUND, lw=0, zorder=-1)
        # As wide as the others, also where the middle of the obstacle lies outside.
        ax.set_xlim(x[0] + at[number], x[-1] + at[number])
        headline(ax, f"{signed(float(at[number]), 0)} mm", f"peak {measure(float(here.max()))} kPa", 24)
        ax.set_xlabel("road (mm)")
    axes[len(axes) // 2].set_xlabel("road (mm); grey: the obstacle")
    axes[0].invert_yaxis()
    axes[0].set_ylabel("y, right of travel (mm)")
    colour_bar(mesh, axes[-1], "contact pressure (kPa)", scale)
    return figure
