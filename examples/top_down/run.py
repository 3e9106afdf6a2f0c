"""Where does a crack start, by which mechanism, and when is it how deep: a motorway, an exit curve, a bus stop.

Each place is a design case, a TOML file beside this one, with its traffic, its climate and its criteria; each is
solved under the tire as a half-space of rubber, as a tread without grooves on an inflated belt, and as ribs with free
sides on that belt. The crack that the surface criterion starts grows down through the wearing course, told by the
load repetitions of 5, 50 and 95 % of such roads: in years most of them lie beyond any road. Traffic and temperatures
are assumed.

    python examples/top_down/run.py [folder]

One of them without Python: treadload life bus_stop.toml -o life.nc; treadload report life.nc -o life.html
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import treadload as tl
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, MUTED, open_axes, styled

HERE = Path(__file__).parent
PLACES = {"motorway": "Motorway", "exit_curve": "Exit curve", "bus_stop": "Bus stop"}
TIRES = {
    "half-space": {},
    "belt": {"belt": "315/80R22.5"},
    "ribs": {"belt": "315/80R22.5", "tread": "ribs"},
}
DEEP = 0.04
# Load repetitions at which the figure ends.
_NEVER = 1e13


def case_of(place: str, tire: str, spacing: float | None = None) -> tl.Case:
    """The design case of a place, on one of the two tires."""
    case = tl.Case.from_toml(HERE / f"{place}.toml")
    part = case.tire.model_copy(update=TIRES[tire])
    return case.model_copy(update={"tire": part, "spacing": spacing or case.spacing})


def main(
    folder: Path, spacing: float | None = None, workers: int | None = None, places: Sequence[str] = tuple(PLACES)
) -> dict[tuple[str, str], tl.steps.Result]:
    folder.mkdir(parents=True, exist_ok=True)
    results = {}
    for place in places:
        for tire in TIRES:
            result = tl.run(case_of(place, tire, spacing), workers=workers)
            results[place, tire] = result
            tl.save_results(result, folder / f"{place}_{tire}.nc")
            tl.report(result, folder / f"{place}_{tire}.html")
    tell(results)
    check(results)
    save(depths(results), folder / "depth_against_years.png")
    print(f"\nthe pages and the figure: {folder}")
    return results


def tell(results: dict[tuple[str, str], tl.steps.Result]) -> None:
    """The table: what governs, and the load repetitions of the crack from the surface at 5, 50 and 95 % of roads."""
    print(f"{'':26s}{'governs first':24s}{'years':>7s}   surface crack, load repetitions at 5 / 50 / 95 % of roads")
    print(f"{'':57s}   {'started':31s}{'40 mm deep':31s}")
    for (place, tire), result in results.items():
        life, growth = result.life, result.growth
        start, deep = (_repetitions(result, growth.risk_years_to(depth)) for depth in (growth.depths[0], DEEP))
        print(
            f"{PLACES[place] + ', ' + tire:26s}{life.governing:24s}{_years(life.years(life.governing)):>7s}   "
            f"{start:31s}{deep:31s}"
        )


def _repetitions(result: tl.steps.Result, at: dict[float, float]) -> str:
    """Load repetitions until the years at each risk."""
    traffic = result.life.traffic
    return " / ".join("never" if np.isinf(at[risk]) else f"{traffic.passes(at[risk]):.1e}" for risk in sorted(at))


def _years(years: float) -> str:
    return "never" if np.isinf(years) else f"{years:.3g}" if years < 1000 else "> 1000"


def check(results: dict[tuple[str, str], tl.steps.Result]) -> None:
    """What must hold whatever the numbers."""
    for result in results.values():
        growth = result.growth
        reach, risk = growth.dataset["reach_years"].to_numpy(), growth.dataset["risk_years"].to_numpy()
        # A crack is no deeper earlier, and more roads have it later.
        assert (np.diff(reach[np.isfinite(reach)]) >= 0).all()
        assert (risk[1:] >= risk[:-1]).all()
        # The first crack of any place starts with its criterion; where it is through first it may start later.
        first = float(growth.dataset["earliest_years"])
        assert abs(first / result.life.years("surface, top-down") - 1) < 0.02
        assert reach[0] >= first


@styled
def depths(results: dict[tuple[str, str], tl.steps.Result]) -> Figure:
    """Depth of the crack against load repetitions: half of the roads, between 5 and 95 % of them."""
    figure = new_figure(10.5, 4.2)
    places = list(dict.fromkeys(place for place, _ in results))
    axes = figure.subplots(1, len(places), sharey=True, squeeze=False)[0]
    for axis, place in zip(axes, places, strict=True):
        open_axes(axis)
        # Narrower lines lie on wider ones, so that those of tires that coincide are all seen.
        for colour, tire, width in zip(CASES, TIRES, (4.5, 2.8, 1.2), strict=False):
            growth, traffic = results[place, tire].growth, results[place, tire].life.traffic
            years = growth.dataset["risk_years"].to_numpy()
            low, half, high = ([traffic.passes(year) if year < 1e9 else _NEVER for year in row] for row in years)
            axis.fill_betweenx(1e3 * growth.depths, low, high, color=colour, alpha=0.2, linewidth=0)
            axis.plot(half, 1e3 * growth.depths, color=colour, linewidth=width, label=tire)
        axis.axvline(traffic.passes(traffic.years), color=MUTED, linewidth=0.8, linestyle=":")
        axis.set_xscale("log")
        axis.set_xlim(1e6, _NEVER)
        axis.set_title(PLACES[place], loc="left")
        axis.set_xlabel("load repetitions")
    axes[0].invert_yaxis()
    axes[0].set_ylabel("depth of the crack (mm)")
    axes[0].legend(loc="center", frameon=False)
    told = "half of the roads, shaded 5 to 95 %, dotted those of the design life"
    figure.suptitle(f"How deep a crack from the surface is: {told}", x=0.01, ha="left", fontweight="bold")
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("top_down"))
