"""Shear that a freely rolling tire puts on a road: ribs with free sides against a layer without grooves.

Run it with `python run.py [FOLDER]`. It writes `ribs.png` and prints the ratios of shear and pressure over load,
pressure, friction and wear, and beside them what was published about free rolling truck tires.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import treadload as tl
from treadload.catalogue import structures
from treadload.validation.ribs import shear_of_ribs, surface_strain

NAME, ROAD = "315/80R22.5", tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
RUBBER, LAYER = tl.Elastic(5.5e6, 0.495), tl.Elastic(5.5e6, 0.47)

PUBLISHED = """
Published, pressure : lateral : longitudinal, the largest of each: de Beer and others, pins under a free rolling truck
tire, 10 : 3.6 : 1.4 (from memory, not checked here); the Illinois contact model takes 0.40 times the vertical stress
as lateral (from memory, not checked here).
"""


def tire(tread: str = "ribs", *, pressure: float = 820e3, worn: float = 0.0) -> tl.Tire:
    """315/80R22.5 on its belt. tread: "ribs" or "layer". pressure: of inflation, Pa. worn: off the tread, m."""
    profile = tl.tire.tires[NAME]
    belt = replace(tl.tire.Belt.from_library(NAME), tread=RUBBER if tread == "ribs" else LAYER)
    if worn:
        grooves = tuple(replace(groove, depth=groove.depth - worn) for groove in profile.grooves)
        profile = replace(profile, grooves=grooves, rolling_radius=profile.rolling_radius - worn)
        belt = replace(belt, tread_thickness=belt.tread_thickness - worn, arm=belt.arm - worn)
    return tl.Tire.from_profile(profile, inflation_pressure=pressure, belt=belt, tread=tread)


def ratios(contact: tl.Contact) -> list[float]:
    """Lateral and longitudinal shear over pressure, the largest of each, times ten."""
    peaks = [float(np.abs(contact.dataset[name]).max()) for name in ("pressure", "traction_y", "traction_x")]
    return [10 * peak / peaks[0] for peak in peaks[1:]]


def shear(spacing: float) -> dict[str, dict[str, Any]]:
    """Shear of the outer less the inner thirds of the middle, second and shoulder rib, and largest ratios, by case."""
    cases: dict[str, tuple[tl.Tire, float, float]] = {
        "layer": (tire("layer"), 35e3, 0.7),
        "ribs": (tire(), 35e3, 0.7),
        "20 kN": (tire(), 20e3, 0.7),
        "50 kN": (tire(), 50e3, 0.7),
        "600 kPa": (tire(pressure=600e3), 35e3, 0.7),
        "friction 0.3": (tire(), 35e3, 0.3),
        "worn by 10 mm": (tire(worn=0.01), 35e3, 0.7),
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


def surface(layer: tl.Contact, ribs: tl.Contact) -> dict[str, tuple[float, float]]:
    """Largest tensile strain in the plane of the surface under the layer and the ribs, mean over 10 x 10 mm."""
    french = structures["6 BBSG3 / 15 GB3 / PF3"].pavement if "6 BBSG3 / 15 GB3 / PF3" in structures else None
    roads = {"5.4 GPa": ROAD}
    if french is not None:
        roads |= {f"French structure, {t:g} °C": french.at(t) for t in (15.0, 40.0)}
    strains = {}
    for name, road in roads.items():
        strains[name] = (1e6 * surface_strain(layer, road), 1e6 * surface_strain(ribs, road))
        print(f"{name:30s} layer {strains[name][0]:6.1f}  ribs {strains[name][1]:6.1f} microstrain")
    return strains
