"""A crack that grows: its depth against years, and its stress intensity against depth."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from treadload.composing import Source
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, headline, legend_below, open_axes, plain, styled

_GROWS, _SCATTERS = "#d55e00", "#f3c39b"
_NAMES = {"I": "opening (mode I)", "II": "sliding (mode II)", "III": "tearing (mode III)"}


@figure(
    "Growth", name="depth", main=True, title="Depth of the crack against years", wide=True,
    caption="The first crack of the wheel path, from its initiation to the end of its way; the band holds what "
    "scatters in initiation and in growth.",
)  # fmt: skip
@styled
def crack_depth(growth: Source, *, ax: Axes | None = None) -> Figure:
    """Depth of the first crack against years, with what scatters and the end of the design life.

    growth: a Growth or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> law = tl.damage.ParisLaw(1e-7, 4.0)
    >>> growth = tl.life.grow_cracks(design, life, tl.damage.CrackGrowth("base", law=law, steps=3, points=20))
    >>> tl.plots.crack_depth(growth).axes[0].get_ylabel()
    'height above the bottom (mm)'
    """
    data = fields_of(growth, "reach_years", "risk_years")
    depth, years = 1e3 * data["crack_depth"].to_numpy(), data["reach_years"].to_numpy()
    spread, risks = data["risk_years"].to_numpy(), data["risk"].to_numpy()
    figure, ax = figure_and_axes(ax, 7.0, 4.0)
    design = data.attrs.get("design_years")
    dates = [*spread[np.isfinite(spread)], *years[np.isfinite(years)], *([float(design)] if design else [])]
    end = 1.15 * max(dates) if dates else 1.0
    low, high = np.minimum(spread[0], end), np.minimum(spread[-1], end)
    ax.fill_betweenx(depth, low, high, color=_SCATTERS, lw=0)
    middle = int(np.abs(risks - 0.5).argmin())
    lines = []
    if 0 < middle < len(risks) - 1:
        lines += ax.plot(spread[middle], depth, "--", color=_GROWS, lw=1.2, label="even odds")
    lines += ax.plot(years, depth, "-o", color=_GROWS, ms=3.5, label="by the laws as they are")
    # Before it starts there is none.
    ax.plot([years[0], years[0]], [0, depth[0]], ":", color=_GROWS, lw=1.2)
    handles = [*lines, Patch(color=_SCATTERS, label=f"{100 * risks[0]:g} to {100 * risks[-1]:g} % of such roads")]
    ax.set_xlim(0, end)
    ax.set_ylim(1.02 * depth[-1], 0)
    ax.axhline(depth[-1], color=INK, lw=1.0)
    if design:
        ax.axvline(float(design), color=INK, lw=1.2, ls=(0, (4, 2)))
        ax.annotate(
            f"design, {float(design):g} years", (float(design), 0.5), xycoords=("data", "axes fraction"), rotation=90,
            xytext=(-4, 0), textcoords="offset points", ha="right", va="center", fontsize=8.5,
        )  # fmt: skip
    open_axes(ax)
    ax.set_xlabel("years from the opening")
    upwards = str(data.attrs.get("grows", "")).startswith("up")
    ax.set_ylabel("height above the bottom (mm)" if upwards else "depth of the crack (mm)")
    if upwards:
        ax.invert_yaxis()
    headline(ax, "How deep the crack is, and when", plain(str(data.attrs.get("starts", ""))))
    legend_below(ax, handles, columns=3)
    return figure


@figure(
    "Growth", name="intensity", title="Stress intensity", wide=True,
    caption="Range of the stress intensity in a passage at the worst place with no wander, in the season where it is "
    "largest; faces close under pressure and rub.",
)  # fmt: skip
@styled
def crack_intensity(growth: Source) -> Figure:
    """Range of the stress intensity against depth by class of axles, mode by mode.

    growth: a Growth or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> law = tl.damage.ParisLaw(1e-7, 4.0)
    >>> growth = tl.life.grow_cracks(design, life, tl.damage.CrackGrowth("base", law=law, steps=3, points=20))
    >>> tl.plots.crack_intensity(growth).axes[0].get_xlabel()
    'range (MPa √m)'
    """
    data = fields_of(growth, "stress_intensity_range")
    depth = 1e3 * data["solved_depth"].to_numpy()
    ranges = 1e-6 * data["stress_intensity_range"].to_numpy()
    names = [plain(str(name)) for name in data["axle_class"].to_numpy()]
    figure = new_figure(9.6, 3.9)
    axes = figure.subplots(1, 3, sharex=True, sharey=True)
    largest = float(ranges[:, :, :3].max()) or 1.0
    lines = []
    for panel, (mode, ax) in enumerate(zip(_NAMES, axes, strict=True)):
        for k, name in enumerate(names):
            (line,) = ax.plot(ranges[k, :, panel], depth, "-o", ms=3, color=CASES[k % len(CASES)], label=name)
            lines += [line] if panel == 0 else []
        ax.set_xlim(0, 1.1 * largest)
        open_axes(ax)
        ax.set_title(_NAMES[mode], loc="left", fontsize=9.5)
        ax.set_xlabel("range (MPa √m)")
    upwards = str(data.attrs.get("grows", "")).startswith("up")
    axes[0].set_ylabel("height of the tip (mm)" if upwards else "depth of the tip (mm)")
    axes[0].set_ylim((0, 1.05 * depth[-1]) if upwards else (1.05 * depth[-1], 0))
    figure.suptitle("Stress intensity as the wheels pass", x=0.01, ha="left", fontweight="bold")
    legend_below(axes[1], lines, columns=min(3, len(lines)))
    return figure
