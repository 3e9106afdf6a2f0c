"""What does a load-deflection curve tell of a tire? One number of a belt, or the modulus of a half-space.

Calspan pressed a 335/65R22.5 at 40, 70 and 95 psi, two loads each. The same points are fitted by the sidewalls of a
tread on an inflated belt (one number), and by half-spaces: a modulus that inflation does not move, the paper's line
(equation 15) as printed and times a factor, and that line fitted anew, E = a p + b with a, b ≥ 0. The point at 40 psi
and 40 kN lies beyond the loads of the tire's own file at that pressure (23.8 kN): it is predicted, not fitted.

    python examples/belt/load_deflection.py [folder]
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import nnls

import treadload as tl
from treadload.calibration import Calibration
from treadload.footprint import Measured
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, open_axes, styled

DATA = Path(__file__).parent / "load_deflection_335_65R22_5_G275MSA.csv"
PSI = 6894.757
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
# The tire's file has a free radius of 498.7 mm, the mesh 504.5: shrunk to that, it bears 0.5 % less at a deflection.
BELTED = tl.Tire.from_scan(tl.example_mesh(), inflation_pressure=95 * PSI, belt=tl.tire.Belt())
SOLID = replace(BELTED, belt=None, material=tl.Elastic(3e6, 0.5))
LARGEST = 0.08  # m; the point beyond is not fitted


def measured() -> np.ndarray:
    """Rows of inflation pressure, Pa, deflection, m, and load, N; 60 psi is derived from the others and left out."""
    rows = np.loadtxt(DATA, delimiter=",", skiprows=2)
    rows = rows[(rows[:, 0] != 60) & (rows[:, 1] > 0)]
    rows[:, 0] *= PSI
    return rows


def load(tire: tl.Tire, approach: float, spacing: float) -> float:
    """Load, N, under which a standing tire sinks by this approach, m."""
    wheel = tl.Rolling(approach=approach, friction=0.0)
    return float(tl.solve_contact(tire, ROAD, wheel, spacing=spacing, tolerance=1e-4).dataset.normal_load)


def belted(inflation_pressure: float, foundation: float) -> tl.Tire:
    """The tire on a belt whose sidewalls have this foundation, 1/m."""
    return replace(BELTED, inflation_pressure=inflation_pressure, belt=replace(tl.tire.Belt(), foundation=foundation))


def on_belt(rows: np.ndarray, foundation: float, spacing: float) -> np.ndarray:
    """Loads at the points' pressures and deflections."""
    return np.array([load(belted(p, foundation), w, spacing) for p, w, _ in rows])


def rms(found: np.ndarray, loads: np.ndarray) -> float:
    """Of the differences over the measured loads."""
    return float(np.sqrt(np.mean((found / loads - 1) ** 2)))


def fit_belt(rows: np.ndarray, spacing: float) -> Calibration:
    """The foundation of the sidewalls from measured deflections, with its standard deviation."""
    data = [Measured(load=force, deflection=w, inflation_pressure=p) for p, w, force in rows.tolist()]
    return tl.calibrate(BELTED, ["foundation"], data, road=ROAD, spacing=spacing, tolerance=1e-6)


def scaled(shape: np.ndarray, fitted: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Loads of a model that is linear in its one number, with the best number."""
    relative = (shape / loads)[fitted]
    return shape * float(relative.sum() / (relative @ relative))


def growth(rows: np.ndarray) -> dict[tuple[int, int], tuple[float, float]]:
    """From pressure to pressure, psi: how the measured load grows at one deflection, and how the pressure does.

    Between the two points of a pressure the load is c w + d w², exact at both; compared at the larger deflection of
    the higher pressure.
    """
    curves = {}
    for p in np.unique(rows[:, 0]):
        own = rows[rows[:, 0] == p]
        c, d = np.linalg.solve(own[:, 1:2] ** [1, 2], own[:, 2])
        curves[p] = (np.polynomial.Polynomial([0.0, c, d]), own[:, 1].max())
    found = {}
    for below, above in pairwise(sorted(curves)):
        higher, at = curves[above]
        found[round(below / PSI), round(above / PSI)] = (float(higher(at) / curves[below][0](at)), above / below)
    return found


@styled
def draw(rows: np.ndarray, models: dict[str, Callable[[float, float], float]]) -> Figure:
    """Measured points and, for each pressure, the curve of each model: a panel a model."""
    figure = new_figure(8.8, 3.9)
    panels = figure.subplots(1, 2, sharey=True)
    for ax, (title, model) in zip(panels, models.items(), strict=True):
        for colour, p in zip(CASES, np.unique(rows[:, 0]), strict=False):
            own = rows[rows[:, 0] == p]
            deflections = np.linspace(0, own[:, 1].max() + 2e-3, 9)
            loads = [0.0, *(model(p, w) for w in deflections[1:])]
            ax.plot(1e3 * deflections, np.array(loads) / 1e3, color=colour, label=f"{p / PSI:.0f} psi")
            for part, face in ((own[:, 1] < LARGEST, colour), (own[:, 1] >= LARGEST, "none")):
                ax.plot(1e3 * own[part, 1], own[part, 2] / 1e3, "o", color=colour, mfc=face)
        ax.set_title(title)
        ax.set_xlabel("deflection (mm)")
    panels[0].set_ylabel("load (kN)")
    panels[0].legend(title="points: measured; open: not fitted", alignment="left", loc="upper left")
    open_axes(*panels)
    return figure


def main(folder: Path, spacing: float = 6e-3) -> dict[str, Any]:
    folder.mkdir(parents=True, exist_ok=True)
    rows = measured()
    pressures, deflections, loads = rows.T
    fitted = deflections < LARGEST
    calibration = fit_belt(rows[fitted], spacing)
    foundation = calibration.tire.belt.foundation
    # The load of a half-space at a deflection is linear in its modulus.
    solid = np.array([load(SOLID, w, spacing) for w in deflections]) / 3e6
    eq15 = np.array([tl.tire.modulus_from_inflation(p) for p in pressures])
    line = np.stack([solid * pressures, solid * 1e6], axis=1)
    (slope, offset), _ = nnls(line[fitted] / loads[fitted, None], np.ones(int(fitted.sum())))
    models = {
        "belt, default 3.6 /m": on_belt(rows, 3.6, spacing),
        f"belt, fitted {foundation:.2f} /m": on_belt(rows, foundation, spacing),
        "half-space, one E": scaled(solid, fitted, loads),
        "half-space, eq. 15 as printed": solid * eq15,
        "half-space, eq. 15 x factor": scaled(solid * eq15, fitted, loads),
        "half-space, eq. 15 anew": line @ [slope, offset],
    }
    errors = {name: rms(values[fitted], loads[fitted]) for name, values in models.items()}
    print(f"{'psi':31s}" + "".join(f"{p / PSI:8.0f}" for p in pressures) + "    rms of")
    print(f"{'deflection (mm)':31s}" + "".join(f"{1e3 * w:8.1f}" for w in deflections) + "   fitted,")
    print(f"{'measured load (kN)':31s}" + "".join(f"{one / 1e3:8.2f}" for one in loads) + "  % of load")
    for name, values in models.items():
        print(f"{name:31s}" + "".join(f"{one / 1e3:8.2f}" for one in values) + f"{100 * errors[name]:10.1f}")
    print("\n" + calibration.summary())
    print(f"\nequation 15 anew: E [MPa] = {slope:.2f}e-3 p [kPa] + {offset:.2f}; as printed: 2.70e-3, 0.70")
    alone = {}
    for p in np.unique(pressures):
        own = fit_belt(rows[fitted & (pressures == p)], spacing)
        alone[round(p / PSI)] = own.tire.belt.foundation
    wanted = ", ".join(f"{value:.2f} at {p} psi" for p, value in alone.items())
    print(f"sidewalls that each pressure alone asks for, 1/m: {wanted}")
    print("\nthe measured load at one deflection, from pressure to pressure:")
    for (low, high), (grown, inflated) in growth(rows).items():
        print(f"  {low} to {high} psi: load x {grown:.2f}, pressure x {inflated:.2f}")
    print(CONTRADICTION)

    def half_space(p: float, w: float) -> float:
        return load(SOLID, w, spacing) * (slope * p + offset * 1e6) / 3e6

    def belt(p: float, w: float) -> float:
        return load(belted(p, foundation), w, spacing)

    panels = {f"Tread on a belt, sidewalls {foundation:.2f} /m": belt, "Half-space, E = a p + b": half_space}
    save(draw(rows, panels), folder / "load_deflection.png")
    return {
        "foundation": foundation,
        "deviation": calibration.standard_deviation("foundation"),
        "alone": alone,
        "line": (float(slope), float(offset)),
        "growth": growth(rows),
        "rms": {name.partition(", fitted")[0]: value for name, value in errors.items()},
    }


CONTRADICTION = """
What the data contradict. What inflation holds grows with it, what sidewalls and rubber hold without it does not: at
one deflection the load must grow, but never faster than the pressure. From 40 to 70 psi it grows faster, from 70 to
95 psi half as much as it could. No tire does both: every model leaves some per cent at 70 psi, and a part of the
sidewalls that does not feel the inflation, fitted as a second number, ends at zero. A modulus proportional to the
pressure serves a half-space nearly as well: deflections tell how stiff a tire is, not what its footprint is like."""


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("load_deflection"))
