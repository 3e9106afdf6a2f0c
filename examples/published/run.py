"""Printed designs as case files: what this program has beside what the guideline prints.

`answers.csv` of each shelf names its cases and the printed numbers. Read where the guideline reads, below a tire and
between both, the largest horizontal strain or the vertical compression; the larger of the places counts.

    python examples/published/run.py
"""

import csv
from pathlib import Path

import numpy as np

import treadload as tl

FOLDER = Path(__file__).parent
# Half the distance of the tires, m.
HALF = 0.155


def answers(shelf):
    """Rows of a shelf: name of the case, what is read, the printed number in microstrain."""
    with (FOLDER / shelf / "answers.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file, delimiter=";"):
            yield row["case"], row["quantity"], float(row["printed [microstrain]"])


def strain(path, quantity):
    """The strain of a case, microstrain."""
    case = tl.Case.from_toml(path)
    data = tl.run(case).response.dataset.isel(depth=0)
    below = data.sel(x=0.0, y=[-HALF, 0.0], method="nearest")
    if quantity == "vertical strain":
        return -1e6 * float(below["strain_zz"].min())
    xx, yy, xy = (below[f"strain_{part}"].to_numpy() for part in ("xx", "yy", "xy"))
    return 1e6 * float((0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), xy)).max())


def main():
    """The table, and the lives of example III.1 by the laws of the guideline."""
    for shelf in sorted(path.parent.name for path in FOLDER.glob("*/answers.csv")):
        for name, quantity, printed in answers(shelf):
            found = strain(FOLDER / shelf / name, quantity)
            print(
                f"{shelf}/{name:28s} {quantity:16s} {found:8.1f}  printed {printed:7.1f}  {found / printed - 1:+.2%}"
            )
    fatigue = tl.damage.IrcFatigue(3000e6, air_voids=0.035, binder_volume=0.115)
    rutting = tl.damage.IrcRutting()
    print(f"III.1, 175 microstrain: {fatigue.allowable_passes(175e-6) / 1e6:.1f} million passes, printed 53")
    print(f"III.1, 278 microstrain: {rutting.allowable_passes(278e-6) / 1e6:.1f} million passes, printed 187")


if __name__ == "__main__":
    main()
