"""A truck wheel over a joint and over a manhole frame that stands 5 mm high: what do their edges bear?

Pressures, load and work at every position of the axle, without inertia. The road is a half-space below its edges: its
own free edge is not in the pressures, so that they are what the tire brings and not all that the edge bears.

    python examples/joint/run.py [folder]
"""

import math
import sys
from pathlib import Path

import treadload as tl
from treadload.pavement import RoadJoint, RoadPlate
from treadload.plots import crossing_contacts, crossing_history, save

CELL = 6e-3


def main(folder: Path, cell: float = CELL) -> dict[str, float]:
    """Solve, print, draw; returns the numbers that are checked."""
    folder.mkdir(parents=True, exist_ok=True)
    tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=850e3)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    wheel = tl.Rolling(normal_load=32.5e3, friction=0.0)
    found = {}
    for name, relief, far in (("joint", RoadJoint(0.018, 0.03, 0.006), 0.15), ("frame", RoadPlate(5e-3, 0.6), 0.45)):
        # Four cells apart: further, and places between two positions would miss their share of the work.
        count = math.ceil(far / (2 * cell))
        way = [far * (2 * k / count - 1) for k in range(count + 1)]
        crossing = tl.contact.cross_obstacle(tire, road, wheel, relief, positions=way, spacing=cell)
        print(crossing.summary(), end="\n\n")
        save(crossing_history(crossing), folder / f"{name}.png")
        save(crossing_contacts(crossing), folder / f"{name}_contacts.png")
        tl.save_results(crossing, folder / f"{name}.nc")
        data = crossing.dataset
        found |= {
            f"{name}_load": float(abs(data.normal_load - 32.5e3).max()),
            f"{name}_before": float(data.largest_pressure[0]),
            f"{name}_edge": float(data.edge_pressure.max()),
            f"{name}_rise": float(data.approach.max() - data.approach.min()),
        }
    return found


if __name__ == "__main__":
    numbers = main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("joint"))
    print(numbers)
    # The load is met at every position, both edges bear more than the plane does, and the axle rises by the frame.
    assert max(numbers["joint_load"], numbers["frame_load"]) < 1.0, numbers
    assert numbers["joint_edge"] > numbers["joint_before"], numbers
    assert numbers["frame_edge"] > 1.5 * numbers["frame_before"], numbers
    assert 4.5e-3 < numbers["frame_rise"] < 5.5e-3, numbers
