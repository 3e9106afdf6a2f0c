"""Shear that a freely rolling tire puts on a road: ribs with free sides against a layer without grooves.

Run it with `python run.py [FOLDER]`. It writes `ribs.png` and prints the ratios of shear and pressure over load,
pressure, friction and wear, and beside them what was published about free rolling truck tires.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import treadload as tl
from treadload.plots import new_figure, save
from treadload.plots.kit.style import styled
from treadload.validation.ribs import shear_of_ribs

NAME, ROAD = "315/80R22.5", tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
STRUCTURE = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
RUBBER, LAYER = tl.Elastic(5.5e6, 0.495), tl.Elastic(5.5e6, 0.47)

PUBLISHED = """
Published, pressure : lateral : longitudinal, the largest of each: de Beer and others, pins under a free rolling truck
tire, 10 : 3.6 : 1.4 (from memory, not checked here); the Illinois contact model takes 0.40 times the vertical stress
as lateral (from memory, not checked here).
"""


def tire(tread: str = "ribs", *, pressure: float = 820e3, worn: float = 0.0) -> tl.Tire:
    """315/80R22.5 on its belt. tread: "ribs" or "layer". pressure: of inflation, Pa. worn: off the tread, m."""
    profile = tl.catalogue.tires[NAME]
    belt = replace(tl.tire.Belt.from_library(NAME), tread=RUBBER if tread == "ribs" else LAYER)
    if worn:
        grooves = tuple(replace(groove, depth=groove.depth - worn) for groove in profile.grooves)
        profile = replace(profile, grooves=grooves, rolling_radius=profile.rolling_radius - worn)
        belt = replace(belt, tread_thickness=belt.tread_thickness - worn, arm=belt.arm - worn)
    return tl.Tire.from_profile(profile, inflation_pressure=pressure, belt=belt, tread=tread)


def ratios(contact: tl.contact.Contact) -> list[float]:
    """Lateral and longitudinal shear over pressure, the largest of each, times ten."""
    peaks = [float(np.abs(contact.dataset[name]).max()) for name in ("pressure", "traction_y", "traction_x")]
    return [10 * peak / peaks[0] for peak in peaks[1:]]


def shear(spacing: float) -> dict[str, dict[str, Any]]:
    """Shear of the outer less the inner third of the middle, second and shoulder rib, and largest ratios, a case."""
    cases: dict[str, tuple[tl.Tire, float, float]] = {
        "layer": (tire("layer"), 35e3, 0.7),
        "ribs": (tire(), 35e3, 0.7),
        "20 kN": (tire(), 20e3, 0.7),
        "50 kN": (tire(), 50e3, 0.7),
        "600 kPa": (tire(pressure=600e3), 35e3, 0.7),
        "friction 0.3": (tire(), 35e3, 0.3),
        "worn by 6 mm": (tire(worn=0.006), 35e3, 0.7),
    }
    table = {}
    print("case             middle second shoulder   10 : q_y : q_x")
    for name, (wheel, load, friction) in cases.items():
        rolling = tl.Rolling(normal_load=load, friction=friction)
        contact = tl.solve_contact(wheel, ROAD, rolling, spacing=spacing)
        ribbed = contact if wheel.ribs else replace(contact, tire=tire())
        amplitude, largest = shear_of_ribs(ribbed)[2:], ratios(contact)
        table[name] = {"amplitude": amplitude, "ratios": largest, "contact": contact}
        print(f"{name:15s}" + "".join(f"{value:8.3f}" for value in (*amplitude, *largest)))
    print(PUBLISHED)
    return table


def in_plane(contact: tl.contact.Contact, road: tl.Pavement) -> float:
    """Largest tensile strain in the plane of the surface, microstrain, as a mean over cubes of 10 mm."""
    data = tl.solve_response(contact, road, depths=[0.0], mean_over=10e-3).dataset
    along, across, sheared = (data[f"strain_{name}"].to_numpy() for name in ("xx", "yy", "xy"))
    return 1e6 * float((0.5 * (along + across) + np.hypot(0.5 * (along - across), sheared)).max())


def surface(layer: tl.contact.Contact, ribs: tl.contact.Contact) -> dict[str, tuple[float, float]]:
    """Largest tensile strain in the plane of the surface under the layer and the ribs, mean over cubes of 10 mm."""
    roads = {"half-space of 5.4 GPa": ROAD}
    roads |= {f"French structure, {t:g} °C": STRUCTURE.at_temperature(t) for t in (15.0, 40.0)}
    strains = {}
    for name, road in roads.items():
        strains[name] = (in_plane(layer, road), in_plane(ribs, road))
        print(f"{name:30s} layer {strains[name][0]:6.1f}  ribs {strains[name][1]:6.1f} microstrain")
    return strains


@styled
def draw(layer: tl.contact.Contact, ribs: tl.contact.Contact, file: Path) -> None:
    """Pressure and lateral shear across the middle of the contact, layer and ribs."""
    figure = new_figure(9.0, 3.4)
    axes = figure.subplots(1, 2, sharey=True)
    for ax, contact, title in zip(
        axes, (layer, ribs), ("layer without grooves", "ribs with free sides"), strict=True
    ):
        line = contact.dataset.sel(x=0.0, method="nearest")
        ax.step(1e3 * line.y, 1e-3 * line.pressure, where="mid", label="pressure")
        ax.step(1e3 * line.y, 1e-3 * line.traction_y, where="mid", label="lateral shear on the road")
        ax.set(title=title, xlabel="to the right of the middle (mm)")
    axes[0].set_ylabel("kPa")
    axes[1].legend(loc="upper right", fontsize="small")
    save(figure, file)


def main(folder: Path, spacing: float = 3e-3) -> dict[str, Any]:
    folder.mkdir(parents=True, exist_ok=True)
    table = shear(spacing)
    contacts = table["layer"]["contact"], table["ribs"]["contact"]
    draw(*contacts, folder / "ribs.png")
    return {"shear": table, "surface": surface(*contacts)}


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("ribs"))
