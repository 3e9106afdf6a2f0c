"""A network of roads: service life along the road, and how many sections reach their end in the years to come."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullFormatter

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, MUTED, halo, headline, measure, open_axes, plain, styled
from treadload.units import LASTS

_SOLVED, _FAILED = 1, 2
_NEEDED = ("governing_years", "remaining_years", "section_age", "section_position", "section_status")
# Sections that are drawn with large marks.
_MANY = 120
# Years to come that are drawn.
_AHEAD = 30.0
# A life shorter than this is drawn there, years.
_SHORTEST = 0.1


@figure(
    "Network", name="stations", main=True, title="Service life along the road", wide=True, order=0,
    caption="Dots: service life from the opening, coloured by the governing criterion. Ticks: age of the section; "
    "a line up to the dot is the life that is left, one down to it means that none is. Triangles: longer. "
    "Crosses: sections that failed.",
)  # fmt: skip
@styled
def network_stations(network: Source, *, ax: Axes | None = None) -> Figure:
    """Service life and age of each section against its station, in the table's order where it has no places.

    network: a Network or its dataset. Returns the figure. Raises InputError if variables are missing and where no
    section was solved.

    >>> axle = {"name": "cart", "share": 1, "axle_load": "1 kN", "inflation_pressure": "8 bar"}
    >>> profile = {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}
    >>> mix, earth = ({"kind": "elastic", "modulus": modulus, "poisson": 0.35} for modulus in ("5 GPa", "60 MPa"))
    >>> top, soil = {"name": "asphalt", "thickness": "3 cm", "material": mix}, {"name": "soil", "material": earth}
    >>> case = {"tire": {"profile": profile}, "pavement": {"layers": [top, soil]}, "spacing": "1 cm"}
    >>> case |= {"traffic": {"passes_per_year": 1e7, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> line = {"law": "fatigue-line", "epsilon_6": "120 microstrain", "slope": -0.2}
    >>> case["criteria"] = [{"name": "base", "layer": "asphalt", "place": "bottom"} | line]
    >>> from pathlib import Path
    >>> _ = Path("network.csv").write_text('''section;age [years];thickness asphalt [mm]
    ... A;8;40
    ... B;1;30''')
    >>> network = tl.sweeps.solve_network(tl.Case.from_dict(case), "network.csv")
    >>> tl.plots.network_stations(network).axes[0].get_ylabel()
    'service life and age (years)'
    """
    data = _solved_of(network)
    figure, ax = figure_and_axes(ax, 10.2, 4.4)
    places, label = _places(data)
    status = data["section_status"].to_numpy()
    years, age = data["governing_years"].to_numpy(), data["section_age"].to_numpy()
    drawn = np.clip(years, _SHORTEST, LASTS)
    good = status == _SOLVED
    # Many sections stand close to each other.
    size = 4.0 if len(status) <= _MANY else 2.6
    over = good & (years < age)
    aged = bool(data.attrs["has_ages"])
    if aged:
        floor = np.maximum(age, _SHORTEST)
        for chosen, color in ((good & ~over, MUTED), (over, "#b4362c")):
            ax.vlines(places[chosen], floor[chosen], drawn[chosen], color=color, lw=0.9, alpha=0.75, zorder=1)
        ax.plot(places[good], floor[good], "_", color=INK, ms=1.25 * size, mew=0.25 * size, label="age", zorder=2)
    for name, color in colours_of(data).items():
        of_name = good & (data["governing_criterion"].to_numpy() == name)
        long = of_name & (years > LASTS)
        ax.plot(
            places[of_name & ~long], drawn[of_name & ~long], "o", ms=size, color=color, label=plain(name), zorder=3
        )
        ax.plot(places[long], drawn[long], "^", ms=1.15 * size, color=color, zorder=3)
    failed = places[status == _FAILED]
    if failed.size:
        ax.plot(failed, np.full(failed.shape, 0.02), "x", color=INK, ms=5, mew=1.1, clip_on=False,
                transform=ax.get_xaxis_transform(), label="failed")  # fmt: skip
    design = float(data.attrs.get("design_years", np.nan))
    if np.isfinite(design):
        ax.axhline(design, color=MUTED, lw=0.9, ls=(0, (5, 3)))
        ax.annotate(
            f"designed for {design:.3g} years", (0.995, design), xycoords=("axes fraction", "data"), xytext=(0, 2),
            textcoords="offset points", ha="right", va="bottom", fontsize=8, color=INK, path_effects=halo(),
        )  # fmt: skip
    ax.set_yscale("log")
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: measure(value)))
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.set_xlabel(label)
    ax.set_ylabel("service life and age (years)" if aged else "service life (years)")
    ax.grid(True, axis="y", which="major")
    open_axes(ax)
    ax.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), fontsize=8)
    count = int(over.sum())
    ended = f", {count} past their service life" if aged else ""
    headline(ax, "Service life along the road", f"{int(good.sum())} sections{ended}")
    return figure


@figure(
    "Network", name="due", title="Sections that reach the end of their life", wide=True, order=1,
    caption="How many sections have reached the end of their service life by a year from now, by the criterion that "
    "ends it.",
)  # fmt: skip
@styled
def network_due(network: Source, *, ax: Axes | None = None) -> Figure:
    """Sections whose service life ends within so many years from now, added up, by the governing criterion.

    network: a Network or its dataset. Returns the figure. Raises InputError if variables are missing and where no
    section was solved.

    >>> axle = {"name": "cart", "share": 1, "axle_load": "1 kN", "inflation_pressure": "8 bar"}
    >>> profile = {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}
    >>> mix, earth = ({"kind": "elastic", "modulus": modulus, "poisson": 0.35} for modulus in ("5 GPa", "60 MPa"))
    >>> top, soil = {"name": "asphalt", "thickness": "3 cm", "material": mix}, {"name": "soil", "material": earth}
    >>> case = {"tire": {"profile": profile}, "pavement": {"layers": [top, soil]}, "spacing": "1 cm"}
    >>> case |= {"traffic": {"passes_per_year": 1e7, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> line = {"law": "fatigue-line", "epsilon_6": "120 microstrain", "slope": -0.2}
    >>> case["criteria"] = [{"name": "base", "layer": "asphalt", "place": "bottom"} | line]
    >>> from pathlib import Path
    >>> _ = Path("network.csv").write_text('''section;age [years];thickness asphalt [mm]
    ... A;8;40
    ... B;1;30''')
    >>> network = tl.sweeps.solve_network(tl.Case.from_dict(case), "network.csv")
    >>> tl.plots.network_due(network).axes[0].get_xlabel()
    'years from now'
    """
    data = _solved_of(network)
    figure, ax = figure_and_axes(ax, 10.2, 3.8)
    remaining = data["remaining_years"].to_numpy()
    good = data["section_status"].to_numpy() == _SOLVED
    years = np.linspace(0.0, _AHEAD, 121)
    below = np.zeros(len(years))
    for name, color in colours_of(data).items():
        ends = remaining[good & (data["governing_criterion"].to_numpy() == name)]
        upper = below + (ends[:, None] <= years).sum(axis=0)
        ax.fill_between(years, below, upper, color=color, alpha=0.85, lw=0, label=plain(name), step="post")
        below = upper
    ax.set_xlim(0, _AHEAD)
    ax.set_ylim(0, max(1.0, 1.05 * float(below.max())))
    ax.yaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_xlabel("years from now")
    ax.set_ylabel("sections at their end")
    ax.grid(True, axis="y")
    open_axes(ax)
    ax.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), fontsize=8)
    headline(ax, "Sections that reach the end of their life", f"{int(below[0])} now, {int(below[-1])} of "
             f"{int(good.sum())} within {_AHEAD:g} years")  # fmt: skip
    return figure


def colours_of(data: xr.Dataset) -> dict[str, str]:
    """A colour for every governing criterion, in the order of the criteria; the rut stands behind them."""
    governing = dict.fromkeys(str(name) for name in data["governing_criterion"].to_numpy() if str(name))
    names = [str(name) for name in data["criterion"].to_numpy() if str(name) in governing]
    names += [name for name in governing if name not in names]
    return {name: CASES[number % len(CASES)] for number, name in enumerate(names)}


def _solved_of(network: Source) -> xr.Dataset:
    data = fields_of(network, *_NEEDED)
    if not (data["section_status"].to_numpy() == _SOLVED).any():
        raise InputError("no section was solved, so that there is nothing to draw; see the reasons of the sections")
    return data


def _places(data: xr.Dataset) -> tuple[Array, str]:
    """Where each section lies, and what the axis counts: km where all places are known, else the order."""
    along = data["section_position"].to_numpy()
    if np.isfinite(along[data["section_status"].to_numpy() == _SOLVED]).all():
        return along / 1e3, "station (km)"
    return np.arange(1.0, len(along) + 1), "section, in the order of the table"
