"""What do stones do to the tension that tears the mastic below the edge of a rib?

The case in aggregates.toml looks at 36 mm of wearing course below the rear edge of a braking wheel's shoulder rib,
stone by stone. Here the same window is filled anew from several seeds, to see what depends on where single stones
stand, and once with a mortar that is half as stiff, as a few degrees make it: the stones carry more.

    python examples/aggregates/run.py [folder]
"""

import sys
from pathlib import Path

import numpy as np

import treadload as tl
from treadload.plots import save

CASE = Path(__file__).parent / "aggregates.toml"
SEEDS = (1, 2, 3)


def filled(case: tl.Case, loads, road: tl.Pavement, seed: int, mortar: float, spacing: float):
    """The window of the case with stones from a seed, in a mortar of a modulus, Pa."""
    asked = case.aggregates.model_copy(update={"seed": seed})
    window = asked.window
    top = tl.Layer(tl.Elastic(mortar, 0.35), road.layers[0].thickness)
    return tl.response.compute_heterogeneous(
        loads, tl.Pavement([top, *road.layers[1:]]), asked.build(), window=(window.length, window.width),
        depth=window.depth, at=(window.x, window.y), spacing=spacing, bond_strength=asked.bond_strength,
    )  # fmt: skip


def main(folder: Path, seeds: tuple[int, ...] = SEEDS, spacing: float = 1e-3, cells: float | None = None):
    folder.mkdir(parents=True, exist_ok=True)
    case = tl.Case.from_toml(CASE)
    road = case.build_road()
    contact = tl.solve_contact(case.build_tire(), road, case.build_rolling(), spacing=cells or case.spacing)
    asked = [(f"3 GPa, seed {seed}", seed, 3e9) for seed in seeds] + [(f"1.5 GPa, seed {seeds[0]}", seeds[0], 1.5e9)]
    found = {name: filled(case, contact, road, seed, mortar, spacing) for name, seed, mortar in asked}
    print(f"{'mortar':18s} tension, 99 %: mastic / mortar alone   factor of strain   stones carry   ravelling")
    table = {}
    for name, window in found.items():
        data = window.dataset.sel(percentile=99)
        row = {
            "mastic": float(data.mastic_tension), "alone": float(data.homogeneous_tension),
            "factor": window.factor(99), "carried": float(data.stone_over_mastic),
            "ravelling": float(data.ravelling_index),
        }  # fmt: skip
        table[name] = row
        print(
            f"{name:18s} {row['mastic'] / 1e6:16.3f} / {row['alone'] / 1e6:.3f} MPa {row['factor']:20.2f}"
            f" {row['carried']:14.2f} {row['ravelling']:11.2f}"
        )
    spread = np.std([table[name]["factor"] for name, seed, mortar in asked if mortar == 3e9])
    print(f"the factor differs by {spread:.2f} (standard deviation) from seed to seed")
    first = found[asked[0][0]]
    save(first.plot.section(along="travel"), folder / "stones.png")
    tl.save_results(first, folder / "stones.nc")
    return table


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
