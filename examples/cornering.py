"""A truck in a roundabout: what does the lateral force do to the road?

A 315/80R22.5 tire at 32.5 kN on a path of 20 m at growing speed: lateral force m V²/R from the load it carries,
turn slip 1/R, and camber if there is any. Aligning moment against slip angle, and the extension of the surface
with the cracks that it would open.

    python examples/cornering.py [folder]
"""

import math
import sys
from pathlib import Path

import treadload as tl
from treadload.plots import compare_strain, creep_curves, save

TIRE = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.5))
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
LINE = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
LOAD, FRICTION, RADIUS, GRAVITY = 32.5e3, 0.7, 20.0, 9.81


def main(
    folder: Path, spacing: float = 4e-3, speeds: tuple[float, ...] = (10.0, 20.0, 30.0)
) -> dict[float, tuple[float, str]]:
    folder.mkdir(parents=True, exist_ok=True)
    angles = (-0.1, -0.06, -0.03, -0.015, 0.0, 0.015, 0.03, 0.06, 0.1)
    straight = tl.Rolling(normal_load=LOAD, friction=FRICTION)
    curve = tl.contact.creep_curve(TIRE, ROAD, straight, angles, along="y", spacing=spacing)
    print("slip angle as lateral creepage")
    print(curve.summary())
    save(creep_curves([curve], ["32.5 kN, μ = 0.7"], along="y"), folder / "aligning_moment.png")

    found, responses = {}, {}
    print(f"\n{'km/h':>6s} {'Q_y, kN':>8s} {'slip angle, °':>14s} {'slip, %':>8s} {'microstrain':>12s}  crack")
    for speed in speeds:
        lateral = LOAD / GRAVITY * (speed / 3.6) ** 2 / RADIUS
        state = tl.Rolling(normal_load=LOAD, friction=FRICTION, lateral_force=lateral, spin=1 / RADIUS)
        contact = tl.solve_contact(TIRE, ROAD, state, spacing=spacing)
        response = tl.solve_response(contact, ROAD, depths=[0.0])
        verdict = tl.assess(response, LINE)
        strain = float(verdict.dataset.worst_strain) * 1e6
        angle = math.degrees(math.atan(float(contact.dataset.creepage_y)))
        slip = 100 * contact.slip_fraction
        print(f"{speed:6.0f} {lateral / 1e3:8.2f} {angle:14.2f} {slip:8.1f} {strain:12.1f}  {verdict.orientation}")
        found[speed] = (strain, verdict.orientation)
        responses[f"{speed:g} km/h"] = response
    save(compare_strain(list(responses.values()), list(responses)), folder / "strain.png")
    return found


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("cornering"))
