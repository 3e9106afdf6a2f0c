"""What roads show: shares cracked by age, who is left at the first survey, the power of the mechanics, folds."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.life.field.fit import DROP
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, MUTED, PAPER, headline, legend_below, open_axes, plain, styled

_MODEL, _PLAIN, _SEEN = CASES[0], CASES[1], INK
_OLDEST = 30.0


def _share_error(share: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Standard error of a share of so many sections, binomial; the variance of a section is 0.05 at least."""
    return np.asarray(np.sqrt(np.clip(share * (1 - share), 0.05, None) / np.maximum(count, 1)))


@figure(
    "FieldBench", name="shares", main=True, title="Share of roads that have cracked", wide=True, order=1,
    caption="All roads built, by the fit with its 95 % interval and by the plain fit; shares that surveys saw.",
)  # fmt: skip
@styled
def field_shares(bench: Source, *, ax: Axes | None = None) -> Figure:
    """Share of roads that have cracked against age: all roads built, the plain fit, and what surveys saw.

    bench: a FieldBench or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> bench = tl.open_results("field_bench.nc").field_bench  # of tl.life.field_bench("LTPP"), which takes 10 s
    >>> tl.plots.field_shares(bench).axes[0].get_xlabel()
    'age (years)'
    """
    data = fields_of(bench, "cracked_share", "seen_share", "cell_sections", "cell_age")
    figure, ax = figure_and_axes(ax, 7.6, 4.4)
    age = data["age"].to_numpy()
    low, high = (100 * data[f"cracked_share_{end}"].to_numpy() for end in ("low", "high"))
    band = ax.fill_between(age, low, high, color=_MODEL, alpha=0.18, lw=0, label="its 95 % interval")
    (line,) = ax.plot(
        age, 100 * data["cracked_share"], color=_MODEL, lw=2, label="all roads built, by the fit with overlays"
    )
    (naive,) = ax.plot(
        age, 100 * data["cracked_share_plain"], "--", color=_PLAIN, label="plain fit, as if none were overlaid"
    )
    middles = data["cell_age"].to_numpy()
    at = ~np.isnan(middles)
    error = 100 * data["share_error"].to_numpy()[at]
    shares = 100 * data["seen_share"].to_numpy()[at]
    seen = ax.errorbar(middles[at], shares, error, fmt="o", ms=5, color=_SEEN, mec=PAPER, elinewidth=0.9, capsize=2,
                       label="seen by surveys: roads that are left")  # fmt: skip
    for x, y, count in zip(
        middles[at], data["seen_share"].to_numpy()[at], data["cell_sections"].to_numpy()[at], strict=True
    ):
        ax.annotate(
            f"{count:.0f}", (x, 100 * y), xytext=(6, -9), textcoords="offset points", fontsize=7.5, color=MUTED
        )
    (guess,) = ax.plot(middles[at], 100 * data["predicted_share"].to_numpy()[at], "s", ms=5, mfc="none", color=_MODEL,
                       label="predicted for them, unseen")  # fmt: skip
    ax.set_xlim(0, _OLDEST)
    ax.set_ylim(0, 100)
    open_axes(ax)
    ax.set_xlabel("age (years)")
    ax.set_ylabel("roads with a first crack (%)")
    names = f"{data.attrs['table']}, {int(data.attrs['sections'])} sections; numbers: sections in each class"
    headline(ax, "Share of roads that have cracked", names)
    handles: list[Any] = [line, band, naive, seen, guess]
    legend_below(ax, handles, columns=2)
    return figure


@figure(
    "FieldBench", name="survivors", title="Who is left at the first survey", wide=True, order=2,
    caption="Share of sections cracked at their first survey: roads that cracked early are not there any more.",
)  # fmt: skip
@styled
def field_survivors(bench: Source, *, ax: Axes | None = None) -> Figure:
    """Share cracked at the first survey against the age there: seen, by the fit with overlays, by the plain fit.

    bench: a FieldBench or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> bench = tl.open_results("field_bench.nc").field_bench  # of tl.life.field_bench("LTPP"), which takes 10 s
    >>> tl.plots.field_survivors(bench).axes[0].get_xlabel()
    'age at the first survey (years)'
    """
    data = fields_of(bench, "entry_age", "entry_seen", "entry_predicted", "entry_plain")
    figure, ax = figure_and_axes(ax, 7.6, 4.2)
    age, seen, count = (data[name].to_numpy() for name in ("entry_age", "entry_seen", "entry_sections"))
    handles: list[Any] = [
        ax.errorbar(age, 100 * seen, 100 * _share_error(seen, count), fmt="o", ms=5,
                    color=_SEEN, mec=PAPER, elinewidth=0.9, capsize=2, label="seen"),
        *ax.plot(age, 100 * data["entry_predicted"], "s-", ms=5, mfc="none", color=_MODEL, label="fit with overlays"),
        *ax.plot(age, 100 * data["entry_plain"], "^--", ms=5, mfc="none", color=_PLAIN, label="plain fit"),
    ]  # fmt: skip
    for x, number, level in zip(age, count, data["entry_level"].to_numpy(), strict=True):
        label = f"{number:.0f} sections\nmedian {level:.2g}"
        ax.annotate(
            label, (x, 0.99), xycoords=("data", "axes fraction"), ha="center", va="top", fontsize=7.5, color=MUTED
        )
    ax.set_ylim(0, 100)
    ax.set_xlim(0, float(age.max()) * 1.2)
    open_axes(ax)
    ax.set_xlabel("age at the first survey (years)")
    ax.set_ylabel("cracked at the first survey (%)")
    headline(
        ax,
        "Who is left at the first survey",
        "median in years: by the plain likelihood, of the sections of a class alone",
    )
    legend_below(ax, handles, columns=3)
    return figure


@figure(
    "FieldBench", name="power", title="How far the mechanics can be trusted", order=3,
    when=lambda data: "power_profile" in data,
    caption="Log likelihood at a power of the mechanics, the rest fitted: 1 trusts them, 0 leaves them out.",
)  # fmt: skip
@styled
def field_power(bench: Source, *, ax: Axes | None = None) -> Figure:
    """Profile of the power with which predicted ages enter, and its 95 % interval.

    bench: a FieldBench or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> import numpy as np
    >>> import xarray as xr
    >>> powers = np.linspace(0.0, 1.0, 11)
    >>> profile = xr.Dataset({"power_profile": ("power", -20 * (powers - 0.4) ** 2)}, {"power": powers})
    >>> profile.attrs.update(power=0.4, power_low=0.1, power_high=0.7)
    >>> tl.plots.field_power(profile).axes[0].get_xlabel()
    'power of the mechanics, g'
    """
    data = fields_of(bench, "power_profile")
    figure, ax = figure_and_axes(ax, 6.2, 3.8)
    power, drop = data["power"].to_numpy(), data["power_profile"].to_numpy()
    low, high = (float(data.attrs[f"power_{end}"]) for end in ("low", "high"))
    ax.axvspan(low, high, color=_MODEL, alpha=0.15, lw=0)
    ax.plot(power, drop, color=_MODEL, lw=2)
    for at, text in ((0.0, "mechanics know\nnothing"), (1.0, "mechanics\ntrusted")):
        ax.axvline(at, color=MUTED, lw=0.8, ls=(0, (4, 3)))
        ax.annotate(text, (at, 0.03), xycoords=("data", "axes fraction"), xytext=(4, 0), textcoords="offset points",
                    fontsize=8, color=MUTED)  # fmt: skip
    trusted = float(np.interp(1.0, power, drop))
    ax.plot([1.0], [trusted], "o", color=_PLAIN, ms=6)
    ax.annotate(f"{trusted:.0f} nats", (1.0, trusted), xytext=(6, 6), textcoords="offset points", ha="left",
                va="bottom", fontsize=8.5, color=_PLAIN)  # fmt: skip
    ax.axhline(-DROP, color=MUTED, lw=0.6)
    open_axes(ax)
    ax.set_ylim(1.15 * float(drop.min()), -0.06 * float(drop.min()))
    ax.set_xlim(float(power.min()), float(power.max()))
    ax.set_xlabel("power of the mechanics, g")
    ax.set_ylabel("log likelihood less the maximum (nats)")
    headline(
        ax,
        "How far the mechanics can be trusted",
        f"fitted {float(data.attrs['power']):z.2f}, 95 % {low:.2f} to {high:.2f}",
    )
    return figure


@figure(
    "FieldBench", name="transform", title="Unseen sections in their intervals", order=4,
    caption="Each bar is a section that the fit had not seen: its crack lies in this part of the prediction.",
)  # fmt: skip
@styled
def field_transform(bench: Source, *, ax: Axes | None = None) -> Figure:
    """Probability transform of every section's interval, by fits that have not seen it, and the middle 90 %.

    bench: a FieldBench or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> bench = tl.open_results("field_bench.nc").field_bench  # of tl.life.field_bench("LTPP"), which takes 10 s
    >>> tl.plots.field_transform(bench).axes[0].get_xlabel()
    'predicted share of roads cracked by then (%)'
    """
    data = fields_of(bench, "transform_low", "transform_high")
    figure, ax = figure_and_axes(ax, 6.2, 4.6)
    low, high = data["transform_low"].to_numpy(), data["transform_high"].to_numpy()
    order = np.lexsort((high, low))
    colours = [_PLAIN if high[k] < 0.05 or low[k] > 0.95 else _MODEL for k in order]
    ax.hlines(np.arange(len(order)), 100 * low[order], 100 * high[order], colors=colours, lw=1.1)
    for edge in (5, 95):
        ax.axvline(edge, color=INK, lw=0.8, ls=(0, (4, 3)))
    ax.set_xlim(0, 100)
    ax.set_ylim(-1, len(order))
    ax.set_yticks([])
    open_axes(ax)
    ax.set_xlabel("predicted share of roads cracked by then (%)")
    ax.set_ylabel(f"{len(order)} sections")
    covered, outside = (100 * float(data.attrs[name]) for name in ("covered_mass", "surely_outside"))
    headline(
        ax, "Unseen sections in their intervals", f"{covered:.0f} % inside 5 to 95 %, {outside:.1f} % surely outside"
    )
    return figure


@figure(
    "FieldLook", name="shares", main=True, title="Share of sections that have cracked so far",
    caption="By class of age, as surveys saw it; sections that were overlaid before are missing.",
)  # fmt: skip
@styled
def field_look_shares(look: Source, *, ax: Axes | None = None) -> Figure:
    """Share of sections that have cracked so far by class of age, of every event.

    look: a FieldLook or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> look = tl.life.field_look("LTPP")
    >>> tl.plots.field_look_shares(look).axes[0].get_ylabel()
    'cracked so far (%)'
    """
    data = fields_of(look, "seen_share", "cell_sections", "cell_age")
    figure, ax = figure_and_axes(ax, 6.8, 3.8)
    middles, counts = data["cell_age"].to_numpy(), data["cell_sections"].to_numpy()
    handles: list[Any] = []
    for number, event in enumerate(map(str, data["event"].to_numpy())):
        share = data["seen_share"].to_numpy()[number]
        error = _share_error(share, counts[number])
        shift = 0.2 * (number - 0.5)
        drawn = ax.errorbar(middles + shift, 100 * share, 100 * error, fmt="o", ms=5, color=CASES[number], mec=PAPER,
                            elinewidth=0.9, capsize=2, label=plain(event))  # fmt: skip
        handles.append(drawn)
    ax.set_ylim(0, 105)
    ax.set_xlim(0, 40)
    open_axes(ax)
    ax.set_xlabel("age (years)")
    ax.set_ylabel("cracked so far (%)")
    headline(
        ax,
        "Share of sections that have cracked so far",
        f"{data.attrs['table']}, {int(data.attrs['sections'])} sections",
    )
    legend_below(ax, handles, columns=2)
    return figure


def _has_years(data: xr.Dataset) -> bool:
    return bool(np.isfinite(data["field_years"]).any())


@figure(
    "FieldYears", name="years", main=True, title="Years of roads and of the mechanics", when=_has_years,
    caption="Bars: 5 to 95 % of roads by the field shift, dot: half of them; diamond: the mechanics alone.",
)  # fmt: skip
@styled
def field_years_range(years: Source, *, ax: Axes | None = None) -> Figure:
    """Years at 5, 50 and 95 % of roads by the field shift beside those of the mechanics alone, by criterion.

    years: a FieldYears or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1.5e6), tl.damage.Climate.constant(15.0)
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> top = tl.damage.Criterion("top", tl.damage.AgedLine(), 0, "top")
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [top], spacing=0.03))
    >>> years = tl.life.field_years(life, road, tl.damage.field_shifts["LTPP"])
    >>> tl.plots.field_years_range(years).axes[0].get_xlabel()
    'years, logarithmic'
    """
    data = fields_of(years, "field_years", "mechanics_years")
    names = [plain(str(name)) for name in data["criterion"].to_numpy()]
    figure, ax = figure_and_axes(ax, 6.8, 1.7 + 0.5 * len(names))
    rows = np.arange(len(names))[::-1]
    low, middle, high = data["field_years"].to_numpy().T
    handles = [
        ax.hlines(rows, low, high, color=_MODEL, lw=5, alpha=0.5, label="5 to 95 % of roads"),
        *ax.plot(middle, rows, "o", color=_MODEL, ms=7, mec=PAPER, label="half of roads"),
        *ax.plot(data["mechanics_years"], rows, "D", color=_PLAIN, ms=6, label="mechanics alone"),
    ]
    ax.set_xscale("log")
    ax.set_yticks(rows, names)
    ax.set_ylim(-0.6, len(names) - 0.4)
    open_axes(ax)
    ax.set_xlabel("years, logarithmic")
    headline(
        ax,
        "Years of roads and of the mechanics",
        "the order of roads is the mechanics', which field data do not support",
    )
    legend_below(ax, handles, columns=3)
    return figure
