"""From small to large: time and memory of normal contact, rolling, layers and a life, 64 to 2048 cells a side.

Each solve runs in a process of its own, one thread, and tells its processor time, that of one padded convolution of
its grid just before (the unit: what every such method pays), and the most memory it held. A chart of both goes to
docs/images/benchmarks.png. About five minutes on a quiet core.

    python benchmarks/scaling.py            python benchmarks/scaling.py 4096     normal contact of 4096 x 4096 cells
"""

import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

CHART = Path(__file__).parents[1] / "docs" / "images" / "benchmarks.png"
# What is solved, how the chart calls it, and cells a side.
SERIES = (
    ("normal", "normal contact of a grooved tire", (64, 128, 256, 512, 1024, 2048)),
    ("rolling", "rolling disc with its normal contact", (64, 128, 256, 512)),
    ("layers", "stress and strain in three layers, 3 depths", (64, 128, 256, 512)),
    ("life", "life of a road, 3 classes, 3 temperatures", (17, 34, 68)),
)
SIDE = 0.34


def normal(n):
    from treadload.contact.bodies.half_space import HalfSpaces, combined
    from treadload.contact.bodies.influence import Influence
    from treadload.contact.solvers.normal import solve_normal
    from treadload.grid import Grid
    from treadload.tire import Tire
    from treadload.validation.pressing import ASPHALT, RUBBER

    grid = Grid.centred(SIDE, SIDE, SIDE / n)
    gap = Tire.from_profile("315/80R22.5").height_map(grid)
    influence = Influence(grid.shape, grid.dx, grid.dy, HalfSpaces(combined(RUBBER, ASPHALT)))
    return lambda: solve_normal(influence, gap, load=35e3)


def rolling(n):
    import numpy as np
    from rolling_contact import disc

    from treadload.contact.solvers.normal import solve_normal
    from treadload.contact.solvers.rolling import solve_rolling

    gap, influence = disc(n)

    def solve():
        pressure = solve_normal(influence, gap, load=1.0).pressure
        return solve_rolling(influence, 0.3 * pressure, np.zeros((2, n, n)), (0.43 * 0.3, 0.0))

    return solve


def layers(n):
    import numpy as np
    from layered import ROAD, footprint

    from treadload.grid import Grid
    from treadload.response import layered

    grid = Grid.centred(0.3, 0.3, 0.3 / n)
    load = footprint(grid)
    depths = np.array([0.0, 0.06, 0.21])
    return lambda: layered.layered_response([load], ROAD, depths, grid.x, grid.y, below=False)


def life(n):
    from dataclasses import replace

    import life as benchmark

    import treadload as tl

    traffic = benchmark.traffic()
    three = traffic.classes[:3]
    share = sum(each.share for each in three)
    few = replace(traffic, classes=tuple(replace(each, share=each.share / share) for each in three))
    climate = tl.damage.Climate.equal_parts([3.0, 12.0, 24.0])
    parts = benchmark.TIRE, benchmark.ROAD, few, climate, benchmark.CRITERIA
    return lambda: tl.solve_life(tl.Design(*parts, spacing=SIDE / n), workers=1)


def one(what, n):
    """Seconds of a solve and of a convolution of its grid, and the most memory, MiB, as JSON."""
    from floors import normal_product

    from treadload.contact.bodies.half_space import HalfSpaces, combined
    from treadload.contact.bodies.influence import Influence
    from treadload.validation.pressing import ASPHALT, RUBBER

    solve = {"normal": normal, "rolling": rolling, "layers": layers, "life": life}[what](n)
    floor = normal_product(
        Influence((n, n), SIDE / n, SIDE / n, HalfSpaces(combined(RUBBER, ASPHALT))), time.process_time
    )
    began = time.process_time()
    solve()
    spent = time.process_time() - began
    print(json.dumps([spent, floor, held()]))


def held():
    """The most memory that this process held, MiB."""
    try:
        # What `getrusage` tells on Linux counts what the parent held when it started this one.
        lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
        return next(int(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def told(what, n):
    run = subprocess.run(
        [sys.executable, __file__, "one", what, str(n)],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parent,
    )
    if run.returncode:
        raise SystemExit(f"{what} on {n} x {n} cells: {run.stderr.strip().splitlines()[-1]}")
    return json.loads(run.stdout.splitlines()[-1])


def chart(series, peers):
    """Seconds, units and memory over cells a side; peers: rows of `peers.measured`."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(12.5, 4.3), layout="constrained")
    for _, label, rows in series:
        cells = [row[0] for row in rows]
        for axis, values in zip(
            axes, ([r[1] for r in rows], [r[1] / r[2] for r in rows], [r[3] for r in rows]), strict=True
        ):
            axis.plot(cells, values, "o-", ms=4, lw=1.6, label=label)
    for name, mark in (("tamaas", "x"), ("aspher", "s")):
        rows = [row for row in peers if row[0] == name]
        if rows:
            axes[0].plot(
                [r[1] for r in rows], [r[2] for r in rows], mark, color="0.35", label=f"{name}, normal contact"
            )
    for axis, title in zip(
        axes, ("processor time, s", "in convolutions of the same grid", "most memory, MiB"), strict=True
    ):
        axis.set(xscale="log", title=title, xlabel="cells a side")
        axis.set_yscale("log")
        axis.set_xticks([16, 64, 256, 1024], ["16", "64", "256", "1024"])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
        axis.spines[["top", "right"]].set_visible(False)
    axes[2].set_yticks([128, 256, 512, 1024], ["128", "256", "512", "1024"])
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    figure.savefig(CHART, dpi=110)


def main(peers=()):
    from timing import print_table

    series = []
    for what, label, sizes in SERIES:
        rows = [(n, *told(what, n)) for n in sizes]
        series.append((what, label, rows))
        table = [(f"{n} x {n}", spent, spent / floor, memory) for n, spent, floor, memory in rows]
        print_table(label, ("cells", "processor, s", "convolutions", "most memory, MiB"), table)
    chart(series, peers)
    print(f"  chart: {CHART}\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["one"]:
        one(sys.argv[2], int(sys.argv[3]))
    elif sys.argv[1:]:
        for n in map(int, sys.argv[1:]):
            spent, floor, memory = told("normal", n)
            said = f"{spent:.1f} s, {spent / floor:.0f} convolutions, {memory / 1024:.2f} GiB"
            print(f"normal contact of {n} x {n} cells: {said}")
    else:
        from peers import measured

        main(measured()[0])
