"""Strain against depth: under the worst point, and under places that one names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, TypedDict, Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.layers import Layers, draw_interfaces, name_layers
from treadload.plots.kit.places import places_under
from treadload.plots.kit.plan import DEPTH_LABEL, MICRO, MM, contact_mask, fields_of, peak_of, plane
from treadload.plots.kit.style import CASES, INK, MUTED, halo, headline, legend_below, signed, styled
from treadload.response.fields import kind_of_points

Component = Literal["xx", "yy", "zz", "in-plane", "principal"]
COMPONENTS: dict[str, tuple[str, str, str]] = {
    "xx": ("strain_xx", "Along travel", r"strain $\varepsilon_{xx}$"),
    "yy": ("strain_yy", "Across travel", r"strain $\varepsilon_{yy}$"),
    "zz": ("strain_zz", "Vertical", r"strain $\varepsilon_{zz}$"),
    "in-plane": ("in_plane_strain_1", "Largest tensile strain, horizontal", "strain in the horizontal plane"),
    "principal": ("principal_strain_1", "Largest tensile strain", "three-dimensional strain"),
}
_WORST: dict[str, tuple[str, str]] = {
    "principal": ("principal_strain_1", "three-dimensional"),
    "in-plane": ("in_plane_strain_1", "in the horizontal plane"),
}
# Up to so many depths each is marked.
_MARKED = 15


def _epsilon_6(beside: Mapping[str, xr.Dataset]) -> float | None:
    """Strain at a million load repetitions by the fatigue line of a case, where it has one."""
    damage = beside.get("damage")
    return float(damage.attrs["epsilon_6"]) if damage is not None and "epsilon_6" in damage.attrs else None


def _layered(data: xr.Dataset | None) -> bool:
    return data is not None and bool(Layers.of(data).interfaces)


def _under_tire(beside: Mapping[str, xr.Dataset]) -> bool:
    """Whether the section across travel passes below the tire: one through a peak ahead of it has no ribs above."""
    across, response = beside.get("slice_across"), beside.get("response")
    if across is None:
        return False
    loaded = contact_mask(response) if response is not None and response.sizes.get("x", 1) > 1 else None
    if response is None or loaded is None:
        return True
    x = response["x"].to_numpy()[loaded.any(axis=0)]
    return bool(x.min() <= float(np.ravel(across["x"])[0]) <= x.max())


def _under_one_place(data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> Iterator[Drawing]:
    """Of the section along travel, or of the map without one, where layers need no places across the tire."""
    kinds = ("slice_along",) if "slice_along" in beside else ("response",)
    layered = _layered(beside.get("slice_across")) and _under_tire(beside)
    if kind_of_points(data) in kinds and not layered and data.sizes.get("depth", 1) > 2:
        yield Drawing({"epsilon_6": _epsilon_6(beside)})


def _under_places(data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> Iterator[Drawing]:
    if kind_of_points(data) == "slice_across" and _layered(data) and _under_tire(beside):
        # The section has the stress of the surface, but perhaps not that under the load's centre.
        response = beside.get("response")
        load = response if response is not None and 0.0 in response["depth"] else data
        yield Drawing({"contact": load, "epsilon_6": _epsilon_6(beside)})


@figure(
    "Response", title="Strain against depth", order=2,
    caption="Both strains under the worst point of the surface; dashed: the largest anywhere in the section.",
    when=_under_one_place,
)  # fmt: skip
@styled
def profile(
    response: Source,
    strain: Literal["principal", "in-plane"] = "principal",
    *,
    epsilon_6: float | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Strain against depth under the worst point, microstrain.

    response: with principal_strain_1 and in_plane_strain_1 over (depth, y, x). strain: the one whose largest
    value at the shallowest depth is the worst point. epsilon_6: strain at a million passes, drawn if given.
    ax: axes to draw into. Interfaces of layers are drawn and named, and the strain jumps there.
    Returns the figure. Raises InputError for a missing variable or another word for strain.
    """
    if strain not in _WORST:
        raise InputError(f'strain must be "principal" or "in-plane", got {strain!r}')
    data = fields_of(response, *(name for name, _ in _WORST.values()), "depth").sortby("depth")
    row, column = peak_of(plane(data.isel(depth=0), _WORST[strain][0]))
    down, layers = data["depth"].to_numpy() * MM, Layers.of(data)
    figure, ax = figure_and_axes(ax, 6.4 + 1.1 * (len(layers.interfaces) > 0), 4.8)
    for (variable, words), colour in zip(_WORST.values(), CASES, strict=False):
        field = data[variable].transpose("depth", "y", "x").to_numpy() * MICRO
        draw_profile(ax, field[:, row, column], down, layers, color=colour, label=f"{words}, under the point")
        reach = np.nanmax(field, axis=(1, 2))
        thin: LineStyle = {"color": colour, "lw": 0.9, "ls": (0, (3, 2)), "label": f"{words}, largest at that depth"}
        draw_profile(ax, reach, down, layers, False, **thin)
    _draw_line(ax, epsilon_6)
    frame_profile(ax, down)
    draw_interfaces(ax, layers, float(down[-1]))
    name_layers(ax, layers, float(down[-1]))
    ax.set_xlabel("largest tensile strain (microstrain)")
    handles, _ = ax.get_legend_handles_labels()
    legend_below(ax, handles, columns=2)
    x, y = float(data["x"][column]) * MM, float(data["y"][row]) * MM
    headline(
        ax,
        "Strain against depth",
        f"under the worst point at the shallowest depth, x = {signed(x)}, y = {signed(y)} mm",
    )
    return figure


@figure(
    "Response", title="Strain against depth", wide=True, order=2,
    caption="Extension along travel, across it and the largest in space, under places across the tire; strain jumps "
    "where a layer ends.",
    when=_under_places,
)  # fmt: skip
@styled
def strain_profiles(
    response: Source,
    places: Mapping[str, tuple[float, float]] | None = None,
    *,
    strains: Sequence[Component] = ("xx", "yy", "principal"),
    contact: Source | None = None,
    epsilon_6: float | None = None,
) -> Figure:
    """Strain against depth under several places, a panel for each strain, on one scale in microstrain.

    response: with the strains over (depth, y, x); `both_sides` of two responses shows the jump at an interface
    to its full height. places: name to x and y in m, the nearest points of the response are taken; if left out
    the tire's centre, a rib's middle and its edge, taken from the contact or from the stress at the surface.
    strains: "xx", "yy", "zz", "in-plane", "principal". epsilon_6: strain at a million passes, drawn with the
    largest extensions. Returns the figure. Raises InputError for missing variables, depths or an unknown strain.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.0, 0.1, 0.149], x=x, y=y)
    >>> figure = tl.plots.strain_profiles(response, {"centre": (0.0, 0.0)}, strains=["xx"])
    >>> f"{figure.axes[0].lines[0].get_xdata().max():.0f} microstrain"
    '265 microstrain'
    """
    unknown = [name for name in strains if name not in COMPONENTS]
    if unknown or not strains:
        raise InputError(f"strains must be of {', '.join(COMPONENTS)}, got {', '.join(unknown) or 'none'}")
    data = fields_of(response, *(COMPONENTS[name][0] for name in strains), "depth").sortby("depth")
    if data.sizes.get("depth", 1) < 2:
        raise InputError("a profile needs at least two depths, the response has 1; solve the response at more depths")
    named = dict(places) if places is not None else places_under(contact if contact is not None else response)
    if not named:
        raise InputError("give at least one place, a name with its x and y in m")
    down, layers = data["depth"].to_numpy() * MM, Layers.of(data)
    width = 2.75 * len(strains) + 1.6 + 1.0 * (len(layers.interfaces) > 0)
    figure = new_figure(width, 5.0)
    panels: list[Axes] = list(figure.subplots(1, len(strains), sharex=True, sharey=True, squeeze=False)[0])
    handles = []
    for number, (name, (x, y)) in enumerate(named.items()):
        colour = CASES[number % len(CASES)]
        here = data.isel(x=nearest(data, "x", x), y=nearest(data, "y", y))
        for ax, component in zip(panels, strains, strict=True):
            values = here[COMPONENTS[component][0]].to_numpy() * MICRO
            draw_profile(ax, values, down, layers, color=colour, label=name)
        at = f"x = {signed(float(here['x']) * MM)}, y = {signed(float(here['y']) * MM)} mm"
        handles.append(Line2D([], [], color=colour, lw=1.8, label=f"{name}: {at}"))
    for ax, component in zip(panels, strains, strict=True):
        frame_profile(ax, down)
        ax.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
        draw_interfaces(ax, layers, float(down[-1]))
        if component in _WORST:
            _draw_line(ax, epsilon_6)
        _, title, words = COMPONENTS[component]
        headline(ax, title, words, 24)
        ax.set_xlabel("microstrain")
    for ax in panels[1:]:
        ax.set_ylabel("")
    name_layers(panels[-1], layers, float(down[-1]))
    figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), len(strains)))
    return figure


class LineStyle(TypedDict, total=False):
    """How a line is drawn, see `matplotlib.lines.Line2D`."""

    color: str
    label: str
    lw: float
    ls: str | tuple[float, tuple[float, ...]]


def draw_profile(
    ax: Axes, values: Array, down: Array, layers: Layers, marked: bool = True, **style: Unpack[LineStyle]
) -> None:
    """A strain (nz,), microstrain, against increasing depths (nz,), mm: a line in each layer, a jump at interfaces.

    Where both sides of an interface are known a thin line joins them. marked: show the depths if they are few.
    """
    label = style.pop("label", None)
    marker = "o" if marked and len(down) < _MARKED else ""
    last: int | None = None
    for rows in layers.pieces(down):
        if rows.stop <= rows.start:
            continue
        ax.plot(values[rows], down[rows], marker=marker, ms=4, label=label, **style)
        label = None
        # Depths a hair apart are the two sides of an interface.
        if last is not None and down[rows.start] - down[last] < 0.01:
            joint: dict[str, Any] = {**style, "lw": 0.9, "ls": (0, (1, 1.2)), "zorder": 2.7}
            ax.plot(values[[last, rows.start]], down[[last, rows.start]], marker="o", ms=3, **joint)
        last = rows.stop - 1


def frame_profile(ax: Axes, down: Array) -> None:
    """Depth down the page, mm, from the surface; a line at no strain."""
    ax.axvline(0, color=MUTED, lw=0.7)
    low = 0.0 if len(down) > 1 else down[0] - 1
    ax.set_ylim(max(down[-1], low + 1), min(low, down[0]))
    ax.set_ylabel(DEPTH_LABEL)
    ax.grid(True)
    ax.spines[["top", "right"]].set_visible(False)


def nearest(data: xr.Dataset, name: str, value: float) -> int:
    """Index of the point nearest to a coordinate, m."""
    return int(np.argmin(np.abs(data[name].to_numpy() - value)))


def _draw_line(ax: Axes, epsilon_6: float | None) -> None:
    if epsilon_6 is not None:
        ax.axvline(epsilon_6 * MICRO, color=INK, lw=0.9, ls=":")
        ax.annotate(
            f"ε₆ = {epsilon_6 * MICRO:g}", (epsilon_6 * MICRO, 0.02), xycoords=ax.get_xaxis_transform(),
            xytext=(-3, 0), textcoords="offset points", rotation=90, ha="right", va="bottom", fontsize=8.5,
            path_effects=halo(),
        )  # fmt: skip
