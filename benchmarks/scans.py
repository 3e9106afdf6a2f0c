"""A large scan becomes a map of 3 mm cells: processor time and memory of half a million and two million triangles.

    python benchmarks/scans.py

Each in a process of its own, so that the memory is its own. A ribbed tire with 0.3 mm of noise, 30 % of the triangles
turned over. Goals: 5 s and 20 s, 2 GB.
"""

import math
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from timing import print_table

GOALS = {500_000: 5.0, 2_000_000: 20.0}


def measure(triangles):
    """Seconds and the largest memory, GB, of this process."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
    from tire_meshes import tire_mesh, write
    from treadload.grid import Grid
    from treadload.tire import Tire

    across = round(math.sqrt(triangles / 6.4))
    with tempfile.TemporaryDirectory() as folder:
        mesh = tire_mesh(around=round(triangles / 2 / (across + 55)), across=across, noise=0.3e-3, flipped=0.3)
        path = write(Path(folder) / "tire.ply", *mesh)
        del mesh
        began = time.process_time()
        Tire.from_scan(path, units="m").height_map(Grid.centred(0.3, 0.3, 3e-3))
        seconds = time.process_time() - began
    # Kibibytes on Linux.
    return seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def main():
    rows = []
    for triangles, goal in GOALS.items():
        told = subprocess.run([sys.executable, __file__, str(triangles)], capture_output=True, text=True, check=True)
        seconds, memory = map(float, told.stdout.split())
        rows.append((triangles, seconds, goal, seconds / triangles * 1e6, memory))
    print_table(
        "A scan read, turned and laid on cells of 3 mm",
        ("triangles", "processor s", "goal s", "s a million", "largest memory GB"),
        rows,
    )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(*measure(int(sys.argv[1])))
    else:
        main()
