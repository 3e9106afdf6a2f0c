"""A crack from the surface beside what Washington State saw: where its growth slows, and when it starts.

Prints, for a wearing course of 50 mm on asphalt, how the rate of growth rises with depth in a crack through both
courses, and what the solver states of a crack that ends at the interface, bonded or sliding.

    python examples/washington/run.py
"""

from pathlib import Path

import numpy as np

import treadload as tl

CASE = Path(__file__).parent / "wearing_course.toml"
SEEN_YEARS, SEEN_DEPTH = (3.0, 8.0), 0.05
THROUGH = "through both courses"
# Cracks, and how the case changes for them.
CRACKS = {
    THROUGH: [],
    "to the interface, bonded": ["growth.layers=1"],
    "to the interface, sliding": ["growth.layers=1", 'pavement.layers.0.bond="frictionless"'],
}


def rises(growth):
    """Depths between the solved ones, m, and d ln rate / d ln depth there, at the place that is reached first."""
    data = growth.dataset
    y = int(np.abs(data["y"].to_numpy() - float(data["worst_y"])).argmin())
    depth, rate = data["solved_depth"].to_numpy(), data["growth_rate"].to_numpy()[:, y]
    return np.sqrt(depth[1:] * depth[:-1]), np.diff(np.log(rate)) / np.diff(np.log(depth))


def main(changes=(), cracks=tuple(CRACKS)):
    """The table. changes: of the case, as `treadload --set` takes them. cracks: names of those that are solved.

    Returns the life and the growth by name.
    """
    results = {}
    for name in cracks:
        case = tl.Case.from_toml(CASE, changes=[*changes, *CRACKS[name]])
        results[name] = tl.run(case, leave_out=("sensitivity", "equivalents"))
        depths, powers = rises(results[name].growth)
        print(f"\n{name}: power with which the rate of growth rises with depth")
        print("  ".join(f"{1e3 * depth:.0f} mm: {power:.1f}" for depth, power in zip(depths, powers, strict=True)))
        for text in results[name].growth.warnings:
            if "interface" in text:
                print(f"  {text}")
    if THROUGH in results:
        print_start(results[THROUGH].life.dataset)
    return results


def print_start(life):
    """When cracks start by both lines of the surface, and how much sooner they are seen."""
    fresh, aged = (float(life[f"life_years_{line}_line"][0]) for line in ("fresh", "aged"))
    print(f"\ncracks start after {fresh:.0f} years by the fresh line and {aged:.0f} by the aged line;")
    early, late = SEEN_YEARS
    print(f"in Washington after {early:g} to {late:g}: {aged / late:.0f} to {fresh / early:.0f} times sooner")


if __name__ == "__main__":
    main()
