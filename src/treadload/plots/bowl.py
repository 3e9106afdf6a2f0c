"""The deflection bowl of a wheel that moves over a road, and how far it lags behind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.places import load_centre
from treadload.plots.kit.plan import MM, X_LABEL, fields_of
from treadload.plots.kit.style import CASES, INK, MUTED, headline, measure, plain, signed, styled, travel_arrow
from treadload.plots.profile import nearest
from treadload.response.fields import kind_of_points

# Deflections below so many mm are given in µm.
_FINE = 0.1


@dataclass(frozen=True)
class Bowl:
    """Deflection along travel.

    x: (n,), mm. deflection: (n,), mm, down. deepest: x and deflection of the lowest point between the points, mm.
    lag: how far that lies behind the load, mm. speed: m/s, or None.
    """

    x: Array
    deflection: Array
    deepest: tuple[float, float]
    lag: float
    speed: float | None

    @classmethod
    def of(cls, response: Source, y: float, load: float) -> Bowl:
        """The bowl of a response at its shallowest depth and the y nearest to one, m, under a load at an x, m."""
        data = fields_of(response, "displacement_z", "x", "y")
        if data.sizes["x"] < 3:
            raise InputError(
                f"a deflection bowl needs at least three points along travel, the response has {data.sizes['x']}"
            )
        if "depth" in data.dims:
            data = data.isel(depth=int(np.argmin(data["depth"].to_numpy())))
        data = data.sortby("x").isel(y=nearest(data, "y", y))
        x, down = data["x"].to_numpy() * MM, data["displacement_z"].to_numpy() * MM
        if not np.isfinite(down).all():
            raise InputError("the deflection is not finite everywhere: this road does not carry the load")
        at, depth = _vertex(x, down, int(np.argmax(down)))
        speed = data.attrs.get("speed")
        return cls(x, down, (at, depth), load * MM - at, None if speed is None else float(speed))

    @property
    def words(self) -> str:
        """Depth and lag in words."""
        deep = f"{self.deepest[1] * 1e3:.1f} µm" if self.deepest[1] < _FINE else f"{self.deepest[1]:.3f} mm"
        if abs(self.lag) < 0.05:
            return f"{deep}, under the load"
        late = f"{abs(self.lag):.1f} mm"
        if self.speed:
            # mm over m/s are ms.
            late += f" = {measure(abs(self.lag) / self.speed)} ms"
        return f"{deep}, {late} {'behind' if self.lag > 0 else 'ahead of'} the load"


@styled
def deflection_bowl(
    responses: Sequence[Source],
    labels: Sequence[str],
    *,
    y: float = 0.0,
    load: float | None = None,
) -> Figure:
    """Deflection along travel under one or several loads that move, each with its lowest point and its lag.

    responses: with displacement_z over (depth, y, x), m, the shallowest depth is drawn; the attribute `speed`, m/s,
    turns a lag into a time. labels: a name each. y: of the line, m, the nearest there is. load: x of the load's
    centre, m; if left out the centre of each response's stress at the surface. Returns the figure.
    Raises InputError for missing variables, an unknown load or labels that do not match.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> x = [0.1 * k for k in range(-9, 10)]
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.0], x=x, y=[0.0])
    >>> figure = tl.plots.deflection_bowl([response], ["plate"])
    >>> f"{figure.axes[0].lines[0].get_ydata().max():.2f} mm"
    '0.71 mm'
    """
    if not responses or len(responses) != len(labels):
        raise InputError(f"give a label for each response: got {len(labels)} labels for {len(responses)} responses")
    centres = [load_centre(response)[0] if load is None else load for response in responses]
    bowls = [Bowl.of(response, y, centre) for response, centre in zip(responses, centres, strict=True)]
    deepest = max(bowl.deepest[1] for bowl in bowls)
    factor, unit = (1e3, "µm") if deepest < _FINE else (1.0, "mm")
    figure = new_figure(8.4, 4.9)
    ax = figure.add_subplot()
    for number, (bowl, label) in enumerate(zip(bowls, labels, strict=True)):
        colour = CASES[number % len(CASES)]
        ax.plot(bowl.x, bowl.deflection * factor, color=colour, label=f"{plain(label)}: {bowl.words}")
        at, depth = bowl.deepest[0], bowl.deepest[1] * factor
        ax.plot([at, at], [depth, 10 * depth], color=colour, lw=0.9, ls=(0, (1, 1.5)), zorder=1.6, scaley=False)
        ax.plot([at], [depth], "v", ms=7, color=colour, mec="white", mew=0.9, zorder=4)
    low, high = min(float(b.deflection.min()) for b in bowls) * factor, deepest * factor
    # A bowl cut near its bottom would be a flat line below the level road.
    top = min(0.0, low) if low < 0.5 * high else low
    ax.set_ylim(high + 0.10 * (high - top), top - 0.16 * (high - top))
    ax.set_xlim(min(b.x[0] for b in bowls), max(b.x[-1] for b in bowls))
    _mark_loads(ax, sorted({round(centre * MM, 3) for centre in centres}))
    ax.axhline(0, color=MUTED, lw=0.7)
    ax.set_xlabel(X_LABEL)
    ax.set_ylabel(f"deflection, down ({unit})")
    ax.grid(True)
    ax.spines[["top", "right"]].set_visible(False)
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower left", ncols=1)
    travel_arrow(ax)
    data = fields_of(responses[0])
    line = float(data["y"].to_numpy()[nearest(data, "y", y)]) * MM
    headline(ax, "Deflection bowl", f"along travel at y = {signed(line)} mm; triangles: the lowest points", 60)
    return figure


def _bowls(data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> Iterator[Drawing]:
    if kind_of_points(data) == "bowl":
        caption = "Deflection of the surface along travel under the wheel."
        if "speed" in beside.get("response", data).attrs:
            caption += " A viscoelastic road is still deflected behind the wheel: its lowest point lags."
        yield Drawing({"label": str(beside["case"].attrs["label"])} if "case" in beside else {}, caption=caption)


@figure("Response", name="bowl", title="Deflection bowl", when=_bowls, wide=True, order=3)
def bowl_of(response: Source, *, y: float | None = None, label: str = "load") -> Figure:
    """Deflection along travel under one load that moves, with its lowest point and its lag.

    response: with displacement_z over (depth, y, x), m. y: of the line, m, the nearest there is; left out, its only
    one, or the middle. label: of the load. Returns the figure. Raises InputError as `deflection_bowl`.
    """
    data = fields_of(response, "displacement_z")
    line = y if y is not None else float(data["y"][0]) if data.sizes.get("y", 1) == 1 else 0.0
    return deflection_bowl([response], [label], y=line, load=data.attrs.get("load_x"))


def _vertex(x: Array, values: Array, k: int) -> tuple[float, float]:
    """Place and size of the maximum of the parabola through the largest value and its neighbours."""
    if k in (0, len(x) - 1):
        return float(x[k]), float(values[k])
    fit = np.polynomial.Polynomial.fit(x[k - 1 : k + 2], values[k - 1 : k + 2], 2)
    root = fit.deriv().roots()
    at = float(root[0].real) if root.size and x[k - 1] <= root[0].real <= x[k + 1] else float(x[k])
    return at, float(fit(at))


def _mark_loads(ax: Axes, centres: Sequence[float]) -> None:
    for centre in centres:
        line = ax.axvline(centre, color=INK, lw=0.9, ls=(0, (4, 2)), zorder=1.5)
        line.set_gid("load")
    ax.annotate(
        "centre of the load", (centres[-1], 1), xycoords=ax.get_xaxis_transform(), xytext=(5, -5),
        textcoords="offset points", ha="left", va="top", fontsize=8.5, color=INK,
    )  # fmt: skip
