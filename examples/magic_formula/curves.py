"""A maker's .tir file beside a solved tire: forces along and across, and the aligning moment, under two loads.

The file is the textbook set of a 315/80R22.5 at 800 kPa; the solved tire is the catalogue's tread of that size on its
belt, whose stiffnesses were chosen after the same set. What the two share is the slope at small slip; friction is one
number in the solve, and falls with the load in the file.

    python examples/magic_formula/curves.py [folder]
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import treadload as tl
from treadload.contact import creep_curve
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled

FILE = Path(__file__).parent / "315_80R22_5_textbook.tir"
LOADS = (17.5e3, 35e3)
SLIPS = np.array([0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.2])
ANGLES = np.radians([0.5, 1, 2, 3.5, 5, 7, 10])
Curves = dict[float, dict[str, np.ndarray]]


def from_file() -> tl.tire.MagicFormula:
    """The textbook tire. The file does not state its signs; those of PAC2002 are ISO."""
    return tl.tire.MagicFormula.from_file(FILE, signs="ISO")


def solved(friction: float, spacing: float) -> Curves:
    """Forces over the load and moments of the solved tire, by load."""
    belt = tl.tire.Belt.from_library("315/80R22.5")
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=800e3, belt=belt)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    curves: Curves = {}
    for load in LOADS:
        wheel = tl.Rolling(normal_load=load, friction=friction)
        # κ is counted from free rolling, creepage from the radius of the unloaded tread.
        free = float(tl.solve_contact(tire, road, wheel, spacing=spacing).dataset.creepage_x)
        along = creep_curve(tire, road, wheel, free - (1 - free) * SLIPS, along="x", spacing=spacing).dataset
        across = creep_curve(tire, road, wheel, np.tan(ANGLES), along="y", spacing=spacing).dataset
        curves[load] = {
            "tractive_force": along.tractive_force.to_numpy() / load,
            "lateral_force": -across.lateral_force.to_numpy() / load,
            "aligning_moment": across.aligning_moment.to_numpy(),
        }
    return curves


def of_formula(tire: tl.tire.MagicFormula, slips: np.ndarray, angles: np.ndarray) -> Curves:
    """The same of the file: the mean of both sides, so that its ply steer and conicity drop out."""
    curves: Curves = {}
    for load in LOADS:
        along = [sign * tire.forces(load, slip=sign * slips).tractive_force for sign in (-1, 1)]
        sides = [tire.forces(load, slip_angle=sign * angles) for sign in (-1, 1)]
        across = [-sign * side.lateral_force for sign, side in zip((-1, 1), sides, strict=True)]
        moment = [sign * side.aligning_moment for sign, side in zip((-1, 1), sides, strict=True)]
        curves[load] = {
            "tractive_force": np.mean(along, axis=0) / load,
            "lateral_force": np.mean(across, axis=0) / load,
            "aligning_moment": np.mean(moment, axis=0),
        }
    return curves


@styled
def draw(ours: Curves, fine: Curves, slips: np.ndarray, angles: np.ndarray) -> Figure:
    """Lines of the file, points of the solves."""
    figure = new_figure(10.5, 3.6)
    panels = figure.subplots(1, 3)
    names = ("tractive_force", "lateral_force", "aligning_moment")
    words = ("Along travel", "Across travel", "Aligning moment")
    labels = ("tractive force over the load (–)", "lateral force over the load (–)", "moment (N m)")
    for axes, name, word, label in zip(panels, names, words, labels, strict=True):
        at, points = (slips, SLIPS) if name == "tractive_force" else (np.degrees(angles), np.degrees(ANGLES))
        for number, load in enumerate(LOADS):
            look = {"color": CASES[number]}
            axes.plot(at, fine[load][name], label=f"file, {load / 1e3:g} kN", **look)
            axes.plot(points, ours[load][name], "o", ms=4, label=f"solved, {load / 1e3:g} kN", **look)
        axes.axhline(0, color=MUTED, lw=0.7)
        axes.set_xlabel("slip κ (–)" if name == "tractive_force" else "slip angle (°)")
        axes.set_ylabel(label)
        headline(axes, word, "")
    open_axes(*panels)
    panels[0].legend()
    return figure


def main(folder: str | Path = ".", spacing: float = 6e-3) -> dict[str, float]:
    """Draws the curves and returns slopes of both at the nominal load, over the load, and the trail in m."""
    tire = from_file()
    print(tire.summary())
    # The file's friction at 35 kN, the mean of along and across.
    ours = solved(float(np.mean(tire.friction(35e3))), spacing)
    slips, angles = np.linspace(0, 0.2, 201), np.radians(np.linspace(0, 10, 201))
    save(draw(ours, of_formula(tire, slips, angles), slips, angles), Path(folder) / "tir_curves.png")
    coarse = of_formula(tire, SLIPS, ANGLES)
    found = {}
    for load in LOADS:
        for name in ("tractive_force", "lateral_force"):
            off = float(np.sqrt(np.mean((ours[load][name] - coarse[load][name]) ** 2)))
            found[f"{name} {load / 1e3:g} kN"] = off
            print(f"{name:16s} {load / 1e3:5.1f} kN: rms of solve less file {100 * off:.1f} % of the load")
    return found


if __name__ == "__main__":
    main(*sys.argv[1:2])
