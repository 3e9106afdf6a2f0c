"""The life of a road: 12 temperatures, 10 classes of axles, 3 maneuvers on three layers, and how few are solved.

Two threads. The error of the interpolation over the climate is measured on every class, against all combinations
solved, on coarse cells: `python life.py --check` does that too.
"""

import os
import sys
import time

import numpy as np
from timing import print_table

import treadload as tl
from treadload.life import solve_passages

GOAL = 8.0
TIRE = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ROAD = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
CRITERIA = (
    tl.damage.Criterion("surface, top-down", tl.FatigueLine(100e-6, -0.2), 0, "top", "principal"),
    tl.damage.Criterion("base, bottom-up", tl.FatigueLine(90e-6, -0.2), 1),
    tl.damage.Criterion("platform", tl.damage.FrenchSubgrade(), -1, "top"),
)
CLIMATE = tl.damage.Climate.equal_parts([2.0, 3.0, 7.0, 11.0, 16.0, 21.0, 24.0, 23.0, 18.0, 12.0, 6.0, 3.5])
MANEUVERS = (
    ("straight", tl.contact.Maneuver(), 0.90),
    ("braking", tl.contact.Maneuver.braking(2.0), 0.07),
    ("turning", tl.contact.Maneuver.turning(40.0, 8.0), 0.03),
)
SINGLE, DUAL = ((0.0, 0.0),), ((0.0, -0.17), (0.0, 0.17))
TANDEM = tuple((x, y) for x in (-0.655, 0.655) for _, y in DUAL)
TRIDEM = ((-1.31, 0.0), (0.0, 0.0), (1.31, 0.0))
# Name, load of a wheel (N), inflation pressure (Pa), wheels.
AXLES = (
    ("front 60 kN", 30e3, 8.0e5, SINGLE),
    ("front 70 kN", 35e3, 8.3e5, SINGLE),
    ("front 80 kN", 40e3, 9.0e5, SINGLE),
    ("driven 80 kN", 20e3, 7.5e5, DUAL),
    ("driven 100 kN", 25e3, 7.8e5, DUAL),
    ("driven 115 kN", 28.75e3, 8.2e5, DUAL),
    ("tandem 160 kN", 20e3, 7.8e5, TANDEM),
    ("tandem 190 kN", 23.75e3, 8.2e5, TANDEM),
    ("tridem 210 kN", 35e3, 9.0e5, TRIDEM),
    ("tridem 270 kN", 45e3, 9.0e5, TRIDEM),
)


def traffic():
    rows = tuple(
        tl.damage.AxleClass(f"{name}, {word}", share / len(AXLES), load, pressure, wheels, maneuver)
        for name, load, pressure, wheels in AXLES
        for word, maneuver, share in MANEUVERS
    )
    return tl.damage.Traffic(rows, 1e6, growth=0.02, wander=tl.damage.Wander.normal(0.25), years=20)


def check():
    """Largest error of readings and lives that the interpolation leaves, over all classes; cells of 12 mm."""
    asked = {"spacing": 12e-3}
    exact = solve_passages(tl.Design(TIRE, ROAD, traffic(), CLIMATE, CRITERIA, tolerance=0.0, **asked), workers=2)
    few = solve_passages(tl.Design(TIRE, ROAD, traffic(), CLIMATE, CRITERIA, **asked), workers=2)
    largest = exact.readings.max(("turn", "y"))
    apart = abs(few.readings.max(("turn", "y")) - largest) / largest
    lives = [
        tl.solve_life(tl.Design(TIRE, ROAD, traffic(), CLIMATE, CRITERIA, tolerance=t, **asked), workers=2)
        .dataset["life_years"]
        .to_numpy()
        for t in (0.0, 5e-3)
    ]
    rows = [
        (name, float(apart[k].max()), float(abs(lives[1][k] / lives[0][k] - 1)))
        for k, name in enumerate(exact.readings["criterion"].to_numpy())
    ]
    title = f"Interpolated over the climate, {few.responses} responses in place of {exact.responses}"
    print_table(title, ("criterion", "error of the largest reading", "error of the life"), rows)


def main():
    began, spent = time.perf_counter(), time.process_time()
    life = tl.solve_life(tl.Design(TIRE, ROAD, traffic(), CLIMATE, CRITERIA), workers=2)
    seconds, processor = time.perf_counter() - began, time.process_time() - spent
    stats = life.stats
    row = (
        stats["combinations"],
        stats["contacts"],
        stats["responses"],
        seconds,
        processor,
        GOAL,
        "kept" if seconds <= GOAL else "MISSED",
        stats["interpolation_error"],
    )
    header = ("combinations", "contacts", "responses", "seconds", "processor", "goal", "", "interpolation")
    print_table(f"Life of a road, two threads of {os.cpu_count()} cores", header, [row])
    years = {c.name: life.years(c.name) for c in CRITERIA}
    assert all(np.isfinite(list(years.values())))
    print("  " + ", ".join(f"{name}: {value:.3g} years" for name, value in years.items()) + "\n")


if __name__ == "__main__":
    main()
    if "--check" in sys.argv:
        check()
