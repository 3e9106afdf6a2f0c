"""What does the grain that rollers leave in a road do to its strains and its life?

Compacted asphalt is stiffer along than down, unbound stone stiffer down than along. The case in compaction.toml gives
both their grain; here the same road is solved without it, too: the asphalt at its horizontal modulus, which bending
and indirect tension measure, the stone at its vertical one, which plates and triaxial tests measure. Between the two
stand the roads of which one layer alone has its grain.

    python examples/compaction_anisotropy/run.py [folder]
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import treadload as tl
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled

CASE = Path(__file__).parent / "compaction.toml"
SPACING_OF_DUALS = 0.35
DEPTHS = np.array([0.005, *np.arange(0.01, 0.7, 0.01)])


def roads(grained: tl.Pavement) -> dict[str, tl.Pavement]:
    """The road without a grain, with that of either layer, and with both."""
    asphalt, stone, soil = grained.layers
    even_asphalt = replace(
        asphalt, material=tl.Elastic(asphalt.material.horizontal, asphalt.material.poisson_horizontal)
    )
    even_stone = replace(stone, material=tl.Elastic(stone.material.vertical, stone.material.poisson_vertical))
    return {
        "isotropic": tl.Pavement([even_asphalt, even_stone, soil]),
        "grain in asphalt": tl.Pavement([asphalt, even_stone, soil]),
        "grain in stone": tl.Pavement([even_asphalt, stone, soil]),
        "grain in both": grained,
    }


def lives(case: tl.Case, variants: dict[str, tl.Pavement]) -> dict[str, tl.damage.Life]:
    """The life of each road under the same traffic; the contact feels none of it and is solved once."""
    given = case.build_tire(), case.build_traffic(), case.build_climate(), case.build_criteria()
    tire, traffic, climate, criteria = given
    return {
        name: tl.solve_life(tl.Design(tire, road, traffic, climate, criteria, spacing=case.spacing))
        for name, road in variants.items()
    }


def below_a_wheel(case: tl.Case, variants: dict[str, tl.Pavement]) -> dict[str, dict[str, np.ndarray]]:
    """Strain along travel and down below the middle of one of two wheels, over depth."""
    wheel = tl.Rolling(normal_load=113e3 / 4, friction=0.7)
    contact = tl.solve_contact(case.build_tire(), variants["isotropic"], wheel, spacing=case.spacing)
    wheels = tl.response.dual_wheels(contact, SPACING_OF_DUALS)
    found = {}
    for name, road in variants.items():
        depths = np.sort([*DEPTHS, *road.interfaces])
        depths = depths[np.diff(depths, prepend=-1) > 1e-6]
        asked = {"depths": depths, "x": [0.0], "y": [SPACING_OF_DUALS / 2]}
        # Both sides of every interface: strains jump there.
        above, below = (tl.solve_response(wheels, road, side=side, **asked).dataset for side in ("above", "below"))
        fields = {f: np.stack([above[f].to_numpy().ravel(), below[f].to_numpy().ravel()], axis=1).ravel()
                  for f in ("strain_xx", "strain_zz")}  # fmt: skip
        found[name] = {"depth": np.repeat(depths, 2), **fields}
    return found


def main(folder: Path, spacing: float | None = None) -> dict[str, dict[str, float]]:
    folder.mkdir(parents=True, exist_ok=True)
    case = tl.Case.from_toml(CASE)
    if spacing is not None:
        case = case.model_copy(update={"spacing": spacing})
    variants = roads(case.build_road())
    solved, profiles = lives(case, variants), below_a_wheel(case, variants)
    names = [criterion.name for criterion in case.build_criteria()]
    table = {}
    print(f"{'':18s}" + "".join(f"{name:>34s}" for name in names))
    for road, life in solved.items():
        strain = {name: float(life.dataset["largest_reading"].sel(criterion=name).max()) for name in names}
        table[road] = {name: life.years(name) for name in names}
        cells = "".join(f"{1e6 * strain[name]:15.0f} µm/m {life.years(name):8.1f} years" for name in names)
        print(f"{road:18s}{cells}")
    save(figure(profiles, table, case.build_road()), folder / "compaction_anisotropy.png")
    tl.save_results(solved["grain in both"], folder / "grain.nc")
    return table


@styled
def figure(profiles, table, road) -> Figure:
    drawn = new_figure(11.0, 4.4)
    axes = drawn.subplots(1, 3, width_ratios=(1, 1, 1.15))
    open_axes(*axes)
    shown = ("isotropic", "grain in both")
    for ax, field, words in zip(axes, ("strain_xx", "strain_zz"), ("along travel", "down"), strict=False):
        for name, colour in zip(shown, CASES, strict=False):
            ax.plot(1e6 * profiles[name][field], 1e3 * profiles[name]["depth"], color=colour, label=name)
        for depth in road.interfaces:
            ax.axhline(1e3 * depth, color=MUTED, lw=0.8, ls="--")
        ax.axvline(0, color=MUTED, lw=0.8)
        ax.set(xlabel=f"strain {words} (µm/m)", ylim=(700, 0))
    axes[0].set_ylabel("depth (mm)")
    axes[0].legend(loc="lower left")
    headline(axes[0], "Strain below a wheel", "dual wheels, driven axle of 113 kN")
    headline(axes[1], "", "dashed: bottoms of asphalt and stone")
    for row, (criterion, colour) in enumerate(zip(next(iter(table.values())), CASES[2:], strict=False)):
        base = table["isotropic"][criterion]
        values = [table[name][criterion] / base for name in table]
        place = np.arange(len(table)) + 0.36 * (row - 0.5)
        axes[2].barh(place, values, height=0.32, color=colour, label=f"{criterion} ({base:.3g} years)")
        for at, value in zip(place, values, strict=True):
            axes[2].annotate(f"{value:.2f}", (value, at), (3, 0), textcoords="offset points", va="center", fontsize=8)
    axes[2].set_yticks(np.arange(len(table)), list(table))
    axes[2].invert_yaxis()
    axes[2].set(xlabel="life over that of the isotropic road", xlim=(0, 2.1))
    axes[2].legend(loc="lower right", fontsize=8, title="isotropic road", title_fontsize=8)
    headline(axes[2], "Life", "same traffic, same tire")
    return drawn


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("compaction_anisotropy"))
