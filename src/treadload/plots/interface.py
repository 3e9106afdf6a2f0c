"""Figures of the bond between layers: its utilisation and its sliding in plan, and the lives with it and without."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.damage.interface import interface_in_words
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import (
    MM,
    Limits,
    Plan,
    colour_bar,
    contact_mask,
    draw_cells,
    draw_outline,
    empty_note,
    fields_of,
    limits,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.kit.strokes import choose
from treadload.plots.kit.style import (
    CASES,
    INK,
    MUTED,
    headline,
    measure,
    plain,
    power_of_ten,
    sequential,
    signed,
    styled,
    thousands,
    travel_arrow,
)

# Inches of a map along travel; letters of a line over it.
_MAP = 4.3
_LETTERS = 38
# Arrows along the longer side of a map, the shear below which none is drawn over the largest, and the longest one
# over the distance between them.
_ALONG, _SIGNIFICANT, _LONGEST = 22, 0.1, 0.95
# A bar's share of its row; room right of the bars for their labels, decades.
_BAR, _ROOM = 0.26, 0.9


@figure(
    "BondVerdict", name="utilisation", main=True, title="Utilisation of the bonds", wide=True,
    caption="Share of the strength that the load uses up; arrows: shear of the upper layer on the lower.",
)  # fmt: skip
@styled
def bond_utilisation(verdict: Source, *, contact: Source | None = None) -> Figure:
    """Utilisation of the bond of every interface, in plan, with arrows of the shear.

    verdict: a BondVerdict or its dataset, with utilisation, interface_shear_x and interface_shear_y over
    (interface, y, x). contact: outlined, if given. One map for each interface with a strength, all on one scale; the
    bond fails where it is 1. An arrow is the shear that the upper layer exerts on the lower, longest at each map's
    own largest.
    Returns the figure. Raises InputError for what is missing.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.06), tl.Layer(tl.Elastic(100e6, 0.4))])
    >>> braking = tl.response.UniformRectangle(0.2, 0.2, 8e5, traction_x=4e5)
    >>> fields = tl.life.solve_interfaces(braking, road, x=[-0.1, 0.0, 0.1], y=[-0.1, 0.0, 0.1])
    >>> verdict = tl.damage.assess_bonds(fields, tl.damage.InterfaceStrength(1e6), tl.damage.ShearFatigue(-0.1))
    >>> tl.plots.bond_utilisation(verdict).axes[0].get_title(loc="left")
    'Interface 1, below layer 0'
    """
    data = fields_of(verdict, "utilisation", "interface_shear_x", "interface_shear_y")
    assessed = [
        k for k in range(data.sizes["interface"]) if not np.isnan(data["utilisation"].isel(interface=k)).all()
    ]
    if not assessed:
        raise InputError("this figure needs the utilisation of at least one interface; assess the bonds first")
    plan = Plan.of(data)
    size = (len(assessed) * (_MAP + 1.35), min(9.0, _MAP * plan.aspect + 1.5))
    figure = new_figure(*size, "compressed")
    scale = limits(data["utilisation"].to_numpy())
    for ax, k in zip(np.atleast_1d(figure.subplots(1, len(assessed))), assessed, strict=True):
        mesh = _map(ax, data.isel(interface=k), plan, scale, contact)
        if k != assessed[0]:
            ax.set_ylabel("")
        if k == assessed[-1]:
            colour_bar(mesh, ax, "utilisation of the bond", scale)
    return figure


def _map(ax: Axes, interface: xr.Dataset, plan: Plan, scale: Limits, contact: Source | None) -> QuadMesh:
    used = plane(interface, "utilisation")
    mesh = draw_cells(ax, plan, np.where(np.isinf(used), 2 * scale.high, used), sequential("shear"), scale)
    if contact is not None:
        mask = contact_mask(fields_of(contact))
        if mask is not None:
            draw_outline(ax, mask, Plan.of(fields_of(contact)), MUTED, 0.6)
    row, column = peak_of(used)
    peak = float(used[row, column])
    _arrows(ax, interface, plan)
    if peak > 0:
        mark_peak(ax, float(plan.x[column]), float(plan.y[row]), "parted" if math.isinf(peak) else f"{peak:.2g}")
    else:
        empty_note(ax, "no shear and no tension here")
    travel_arrow(ax)
    title = interface_in_words(int(interface["interface"]), str(interface["between"].item()))
    headline(ax, title[:1].upper() + title[1:], _in_numbers(interface, plan, row, column), _LETTERS)
    return mesh


def _in_numbers(interface: xr.Dataset, plan: Plan, row: int, column: int) -> str:
    place = f"x = {signed(plan.x[column])}, y = {signed(plan.y[row])} mm"
    shear, pressed = (plane(interface, f"interface_{name}")[row, column] / 1e3 for name in ("shear", "pressure"))
    text = f"{float(interface['depth']) * MM:g} mm deep; highest at {place}:\n"
    side = f"under {pressed:.0f} kPa" if pressed >= 0 else f"with {-pressed:.0f} kPa of tension"
    text += f"shear {shear:.0f} kPa {side}"
    text += _beyond(interface, plan)
    if "parting_passes" in interface:
        text += f"; fails after {power_of_ten(float(interface['parting_passes']))} load repetitions"
    return text


def _beyond(interface: xr.Dataset, plan: Plan) -> str:
    """Where the utilisation is largest if that lies beyond the map, which was solved further then."""
    if "parting_x" not in interface:
        return ""
    x, y = (MM * float(interface[f"parting_{name}"]) for name in "xy")
    if all(at[0] - 0.1 <= place <= at[-1] + 0.1 for at, place in ((plan.x, x), (plan.y, y))):
        return ""
    used = float(interface["largest_utilisation"])
    return f";\nlarger beyond this map: {used:.2g} at x = {signed(x)}, y = {signed(y)} mm"


@styled
def sliding(fields: Source, *, contact: Source | None = None) -> Figure:
    """How far the upper layer slides on the lower at every interface that slides, in plan.

    fields: of `solve_interfaces`, with jump_x, jump_y and interface_shear over (interface, y, x). contact: outlined,
    if given. Arrows show which way the upper layer slides, longest at each map's own largest. Returns the figure.
    Raises InputError for what is missing, and where nothing slides.

    >>> upper = tl.Layer(tl.Elastic(5e9, 0.35), 0.06, bond=tl.pavement.Bond(stiffness=1e9))
    >>> road = tl.Pavement([upper, tl.Layer(tl.Elastic(100e6, 0.4))])
    >>> braking = tl.response.UniformRectangle(0.2, 0.2, 8e5, traction_x=4e5)
    >>> fields = tl.life.solve_interfaces(braking, road, x=[-0.1, 0.0, 0.1], y=[-0.1, 0.0, 0.1])
    >>> figure = tl.plots.sliding(fields)
    >>> f"the upper layer slides by up to {figure.axes[0].collections[0].get_array().max():.0f} µm"
    'the upper layer slides by up to 33 µm'
    """
    data = fields_of(fields, "jump_x", "jump_y", "interface_shear", "interface_pressure")
    along, across = (data[f"jump_{name}"].transpose("interface", "y", "x").to_numpy() for name in "xy")
    size = np.hypot(along, across)
    slid = [k for k in range(len(size)) if (size[k] > 0).any()]
    if not slid:
        raise InputError(
            "nothing slides at these interfaces, or they are frictionless, whose sliding is not solved; "
            "give a layer bond=Parted(...) or Bond(stiffness=...)"
        )
    plan = Plan.of(data)
    figure = new_figure(len(slid) * (_MAP + 1.35), min(9.0, _MAP * plan.aspect + 1.5), "compressed")
    for ax, k in zip(np.atleast_1d(figure.subplots(1, len(slid))), slid, strict=True):
        interface, microns = data.isel(interface=k), 1e6 * size[k]
        scale = limits(microns)
        mesh = draw_cells(ax, plan, microns, sequential("shear"), scale)
        mask = None if contact is None else contact_mask(fields_of(contact))
        if contact is not None and mask is not None:
            draw_outline(ax, mask, Plan.of(fields_of(contact)), MUTED, 0.6)
        _strokes(ax, plan, -plane(interface, "jump_x"), -plane(interface, "jump_y"), "sliding")
        row, column = peak_of(microns)
        mark_peak(ax, float(plan.x[column]), float(plan.y[row]), f"{microns[row, column]:.2g} µm")
        travel_arrow(ax)
        title = interface_in_words(int(interface["interface"]), str(interface["between"].item()))
        shear, pressed = (float(plane(interface, f"interface_{name}").max()) / 1e3 for name in ("shear", "pressure"))
        text = (
            f"{float(interface['depth']) * MM:g} mm deep; the upper layer slides on the lower along the arrows;\n"
            f"largest shear {shear:.0f} kPa, largest pressure {pressed:.0f} kPa"
        )
        headline(ax, title[:1].upper() + title[1:], text, _LETTERS)
        colour_bar(mesh, ax, "sliding (µm)", scale)
    return figure


def _arrows(ax: Axes, interface: xr.Dataset, plan: Plan) -> None:
    # The upper layer's shear on the lower: the traction on the plane that faces up.
    _strokes(ax, plan, -plane(interface, "interface_shear_x"), -plane(interface, "interface_shear_y"), "shear")


def _strokes(ax: Axes, plan: Plan, along: Array, across: Array, name: str) -> None:
    size = np.hypot(along, across)
    largest = float(size.max())
    if largest == 0:
        return
    gap = plan.span / _ALONG
    rows, columns = choose(size, plan.x, plan.y, _SIGNIFICANT * largest, gap).T
    longest = _LONGEST * gap / largest
    arrows = ax.quiver(
        plan.x[columns], plan.y[rows], along[rows, columns] * longest, across[rows, columns] * longest, color=INK,
        angles="xy", scale_units="xy", scale=1.0, pivot="mid", width=0.0032, headwidth=4.2, headlength=4.6,
        headaxislength=4.2, minlength=0.5, zorder=3,
    )  # fmt: skip
    arrows.set_gid(name)


@figure(
    "BondComparison", name="lives", main=True, title="Life with and without the bond", wide=True,
    caption="Life by every criterion with the bond, without it, and with it until it fails.",
)  # fmt: skip
@styled
def bonded_and_parted(comparison: Source) -> Figure:
    """Bars of the life by every criterion: with the bond, without it, and with it until it fails.

    comparison: a BondComparison or its dataset, with life_years over (state, criterion) and parting_years.
    A dashed line marks when the bond fails. Years on a logarithmic scale. Returns the figure. Raises InputError for
    what is missing, and if no life ever ends.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> strength, fatigue = tl.damage.InterfaceStrength(3e6), tl.damage.ShearFatigue(slope=-0.2)
    >>> bond = tl.damage.Criterion.of_bond("bond", strength, fatigue)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1, "bottom")
    >>> asphalt, soil = tl.Elastic(5e9, 0.35), tl.Elastic(60e6, 0.4)
    >>> road = tl.Pavement([tl.Layer(asphalt, 0.02), tl.Layer(asphalt, 0.03), tl.Layer(soil)])
    >>> comparison = tl.life.compare_bonds(tl.Design(tire, road, traffic, climate, [bond, base], spacing=0.01))
    >>> tl.plots.bonded_and_parted(comparison).axes[0].get_xlabel()
    'life (years)'
    """
    data = fields_of(comparison, "life_years", "parting_years")
    data = data.isel(criterion=data["criterion"].to_numpy() != data.attrs.get("parts"))
    years = data["life_years"].transpose("criterion", "state").to_numpy()
    names = [str(name) for name in data["criterion"].to_numpy()]
    states = [str(state) for state in data["state"].to_numpy()]
    parting = float(data["parting_years"])
    shown = years[np.isfinite(years) & (years > 0)]
    ends = np.append(shown, parting) if 0 < parting < math.inf else shown
    if not ends.size:
        raise InputError("no criterion ever fails: there are no lives to compare")
    low, high = 10.0 ** math.floor(math.log10(ends.min() / 1.5)), 10.0 ** (math.log10(ends.max()) + _ROOM)
    figure = new_figure(8.0, 1.5 + 0.95 * len(names))
    ax = figure.add_subplot()
    for k, state in enumerate(states):
        at = np.arange(len(names)) + (k - (len(states) - 1) / 2) * _BAR
        ends_at = np.clip(years[:, k], low, high)
        ax.barh(at, ends_at - low, _BAR * 0.9, left=low, color=CASES[k], label=state, zorder=2)
        for place, end, life in zip(at, ends_at, years[:, k], strict=True):
            inside = math.isinf(life)
            ax.annotate(
                "never" if inside else _years(life), (end, place), xytext=(-4 if inside else 4, 0),
                textcoords="offset points", va="center", ha="right" if inside else "left", fontsize=8.5,
                color="white" if inside else INK, zorder=4,
            )  # fmt: skip
    if 0 < parting < math.inf:
        ax.axvline(parting, color=INK, lw=1.0, ls=(0, (4, 2)), zorder=3)
        ax.annotate(
            f"the bond fails, {_years(parting)}", (parting, 1), xycoords=ax.get_xaxis_transform(), xytext=(4, -3),
            textcoords="offset points", fontsize=8.5, ha="left", va="top", zorder=4,
        )  # fmt: skip
    ax.set_xscale("log")
    ax.xaxis.set_major_formatter(lambda value, _: f"{value:g}" if 1e-3 < value < 9e4 else power_of_ten(value))
    ax.set_xlim(low, high)
    ax.set_yticks(np.arange(len(names)), [plain(name) for name in names])
    ax.set_ylim(len(names) - 0.45, -0.85)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("life (years)")
    ax.grid(axis="x")
    ax.spines[["top", "right"]].set_visible(False)
    about = data.attrs
    details = (
        f"{interface_in_words(int(about.get('interface', 0)), str(about.get('between', '')))}; "
        f"{about.get('bond', '')} once debonded"
    )
    headline(ax, "Life with and without the bond", plain(details))
    figure.legend(loc="outside lower center", ncols=len(states))
    return figure


def _years(years: float) -> str:
    if years >= 1e4:
        return f"{power_of_ten(years)} years"
    return f"{thousands(years) if years >= 1000 else measure(years)} years"
