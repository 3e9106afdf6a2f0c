"""Rubber on a road's texture: heights, pressure on peaks, real area, and which pressures carry the load."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import (
    MM,
    X_LABEL,
    Y_LABEL,
    Limits,
    Plan,
    colour_bar,
    draw_cells,
    edges,
    fields_of,
    frame_plan,
    limits,
    plane,
)
from treadload.plots.kit.style import (
    CASES,
    INK,
    MUTED,
    headline,
    legend_below,
    measure,
    open_axes,
    sequential,
    styled,
)

_MEGA, _KILO = 1e-6, 1e-3
# A patch is drawn with this many cells a side at most, so that a page stays small.
_CELLS = 400
# Of the colours of pressure: the share of the cells in contact whose values lie on them.
_SHOWN = 99.0


@figure(
    "TextureContact", name="patch", main=True, title="Rubber on texture", wide=True,
    caption="A patch that stands for the road: its heights, the pressure on its peaks, how much of it touches, and "
    "which pressures carry the load.",
)  # fmt: skip
@styled
def texture_contact(result: Source) -> Figure:
    """The patch of texture, the pressure on its peaks, real area against mean pressure, and who carries the load.

    result: a TextureContact or its dataset. A profile is drawn as a line with its pressure. Returns the figure.
    Raises InputError for missing variables.

    >>> from treadload.pavement.texture import self_affine
    >>> texture = self_affine(0.016, 0.001, hurst=0.8, shortest=0.004, rms_height=1e-4)
    >>> result = tl.contact.solve_texture(texture, tl.Elastic(6e6, 0.5), [1e5, 2e5])
    >>> [ax.get_title(loc="left") for ax in tl.plots.texture_contact(result).axes[:2]]
    ['Texture', 'Pressure on the peaks']
    """
    data = fields_of(
        result, "texture_height", "pressure", "real_area_ratio", "persson_area_ratio", "asperity_area_ratio",
        "load_share_above", "area_share_above", "mean_pressure", "local_pressure", "reference_pressure",
    )  # fmt: skip
    figure = new_figure(10.4, 8.6)
    axes = figure.subplots(2, 2)
    mean = float(data["reference_pressure"])
    if data.sizes["y"] == 1:
        _profile(axes[0, 0], axes[0, 1], data, mean)
    else:
        _maps(axes[0, 0], axes[0, 1], data, mean)
    _area(axes[1, 0], data)
    _shares(axes[1, 1], data)
    return figure


def _maps(left: Axes, right: Axes, data: xr.Dataset, mean: float) -> None:
    every = {axis: slice(None, None, max(1, data.sizes[axis] // _CELLS)) for axis in ("x", "y")}
    thin = data[["texture_height", "pressure"]].isel(every)
    x, y = (edges(thin[axis].to_numpy() * MM) for axis in ("x", "y"))
    height = thin["texture_height"].to_numpy() * MM
    mesh = left.pcolormesh(x, y, height, cmap="Greys_r", rasterized=True)
    colour_bar(mesh, left, "mm", Limits(float(height.min()), float(height.max())))
    rms = data.attrs.get("rms_height", np.nan) * MM
    headline(left, "Texture", f"rms height {rms:.2g} mm, slope {data.attrs.get('rms_slope', np.nan):.2g}", 34)
    pressure = np.where(thin["pressure"] > 0, thin["pressure"] * _MEGA, np.nan)
    whole = data["pressure"].to_numpy()
    high = float(np.percentile(whole[whole > 0], _SHOWN)) * _MEGA
    peak = float(whole.max()) * _MEGA
    mesh = right.pcolormesh(x, y, pressure, cmap=sequential("pressure"), vmin=0, vmax=high, rasterized=True)
    colour_bar(mesh, right, "MPa", Limits(0.0, high, peak > high))
    headline(right, "Pressure on the peaks", f"mean {measure(mean * _KILO)} kPa, highest {peak:.2g} MPa", 34)
    for ax in (left, right):
        ax.set_aspect("equal")
        ax.set_xlabel(X_LABEL)
        ax.set_ylabel(Y_LABEL)


def _profile(left: Axes, right: Axes, data: xr.Dataset, mean: float) -> None:
    x = data["x"].to_numpy() * MM
    left.plot(x, data["texture_height"].to_numpy()[0] * MM, color=INK, lw=0.8)
    left.set_ylabel("height (mm)")
    headline(left, "Texture", f"rms slope {data.attrs.get('rms_slope', np.nan):.2g}", 34)
    right.fill_between(x, data["pressure"].to_numpy()[0] * _MEGA, color=CASES[1], lw=0)
    right.set_ylabel("pressure (MPa)")
    right.set_ylim(bottom=0)
    headline(right, "Pressure on the peaks", f"mean {measure(mean * _KILO)} kPa", 34)
    for ax in (left, right):
        ax.set_xlabel(X_LABEL)
        open_axes(ax)


def _area(ax: Axes, data: xr.Dataset) -> None:
    p = data["mean_pressure"].to_numpy() * _KILO
    handles = []
    for name, colour, style, label in (
        ("real_area_ratio", CASES[0], "o-", "this texture"),
        ("persson_area_ratio", MUTED, "--", "Persson's theory"),
        ("asperity_area_ratio", MUTED, ":", "asperities alone"),
    ):
        handles += ax.plot(p, 100 * data[name].to_numpy(), style, color=colour, ms=4, label=label)
    ax.set_xlim(left=0)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("mean pressure (kPa)")
    ax.set_ylabel("share of the area that touches (%)")
    open_axes(ax)
    legend_below(ax, handles, columns=3)
    at = float(np.interp(float(data["reference_pressure"]) * _KILO, p, 100 * data["real_area_ratio"].to_numpy()))
    headline(ax, "Real contact", f"{at:.3g} % at {measure(float(data['reference_pressure']) * _KILO)} kPa", 34)


def _shares(ax: Axes, data: xr.Dataset) -> None:
    at_reference = data.sel(mean_pressure=float(data["reference_pressure"]), method="nearest")
    local = data["local_pressure"].to_numpy() * _MEGA
    load, area = (100 * at_reference[name].to_numpy() for name in ("load_share_above", "area_share_above"))
    handles = [
        *ax.plot(local, load, color=CASES[1], label="of the load"),
        *ax.plot(local, area, color=CASES[0], label="of the area"),
    ]
    ax.set_xlim(0, max(float(_last(local, load)), 1e-9))
    ax.set_ylim(0, 100)
    ax.set_xlabel("local pressure (MPa)")
    ax.set_ylabel("share above it (%)")
    open_axes(ax)
    legend_below(ax, handles, columns=2)
    half = float(np.interp(-50.0, -load, local))
    headline(ax, "Who carries the load", f"half of it above {half:.2g} MPa", 34)


def _last(local: Array, share: Array) -> float:
    """The pressure above which nothing worth drawing is left."""
    left = local[share > 0.05]
    return float(left[-1] if left.size else local[-1])


@figure(
    "Enveloped", name="pressure", main=True, title="Enveloped pressure",
    caption="The pressure on peaks, filtered over the enveloping length, with the same load.",
)  # fmt: skip
@styled
def enveloped_pressure(enveloped: Source, before: Source | None = None) -> Figure:
    """The enveloped pressure in plan, and the contact's own beside it.

    enveloped: an Enveloped or its dataset. before: the contact that it is of. Each has a scale of its own, since
    peaks are what goes. Returns the figure.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> enveloped = tl.contact.envelop(contact, length=0.012)
    >>> [ax.get_title(loc="left") for ax in tl.plots.enveloped_pressure(enveloped, contact).axes[:2]]
    ['Contact pressure', 'Enveloped pressure']
    """
    after = fields_of(enveloped, "pressure")
    shown = [("Enveloped pressure", after)]
    if before is not None:
        shown.insert(0, ("Contact pressure", fields_of(before, "pressure")))
    plan = Plan.of(after)
    figure = new_figure(0.6 + 5.4 * len(shown), min(8.0, 1.6 + 4.6 * plan.aspect))
    for ax, (title, data) in zip(figure.subplots(1, len(shown), squeeze=False)[0], shown, strict=True):
        values, patch_plan = plane(data, "pressure") * _KILO, Plan.of(data)
        scale = limits(values)
        mesh = draw_cells(ax, patch_plan, np.where(values > 0, values, np.nan), sequential("pressure"), scale)
        frame_plan(ax, plan)
        colour_bar(mesh, ax, "kPa", scale)
        length = after.attrs.get("enveloping_length")
        over = f"over {measure(length * MM)} mm, " if data is after and length is not None else ""
        headline(ax, title, f"{over}peak {measure(float(np.nanmax(values)))} kPa", 34)
    return figure
