"""How much does a driving tire creep, and what does its tread change?

Traction against creepage for a ribbed and a smooth 315/80R22.5 tread at 32.5 kN, dry (μ = 0.7) and wet (0.35).
Every curve is one call, each point solved from the one before it.

    python examples/creep_curve.py [folder]
"""

import sys
from dataclasses import replace
from pathlib import Path

import treadload as tl
from treadload.plots import creep_curves, save

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
RUBBER = tl.Elastic(3e6, 0.5)
CREEPAGES = (-0.3, -0.2, -0.15, -0.1, -0.07, -0.05, -0.03, -0.015, 0.0, 0.015, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3)


def main(folder: Path, spacing: float = 4e-3, creepages: tuple[float, ...] = CREEPAGES) -> dict[str, float]:
    folder.mkdir(parents=True, exist_ok=True)
    ribs = tl.catalogue.tires["315/80R22.5"]
    treads = {"ribs": ribs, "smooth": replace(ribs, grooves=())}
    cases = [("ribs", 0.7), ("ribs", 0.35), ("smooth", 0.7)]
    curves, slopes = {}, {}
    for tread, friction in cases:
        name = f"{tread}, μ = {friction:g}"
        tire = tl.Tire.from_profile(treads[tread], material=RUBBER)
        state = tl.Rolling(normal_load=32.5e3, friction=friction)
        curves[name] = tl.contact.creep_curve(tire, ROAD, state, creepages, spacing=spacing)
        print(f"\n{name}\n{curves[name].summary()}")
        nearest = min((c for c in creepages if c < 0), key=abs)
        slopes[name] = float(curves[name].dataset.tractive_force.sel(creepage=nearest)) / -nearest
    print("\ncreep stiffness, N per unit of creepage:")
    for name, slope in slopes.items():
        print(f"  {name:18s} {slope:10.0f}")
    save(creep_curves(list(curves.values()), list(curves)), folder / "creep_curve.png")
    return slopes


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("creep_curve"))
