"""Normal contact of the grooved truck tire beside compiled peers: the same cells, half-space and load, one thread.

All use zero-padded FFT with Love's coefficients. tamaas: Polonsky and Keer's method. aspher: nested grids, its FFT
operator and its preconditioner on the full grid. Each peer runs in an environment of its own that this script makes
below benchmarks/.peers; where that fails, the table says why. aspher builds from its source package and wants Eigen
3.4 where CMake finds it (Debian: libeigen3-dev). How far pressures lie from a solution to 1e-10 stands beside the
times: one solver's tolerance is not another's. aspher's is relative to the range of the gap, and so to the wall that
stands for a groove: 50 mm, near the approach of 39 mm that ours is relative to. A wall of 1 m asks for less.

    python benchmarks/peers.py            python benchmarks/peers.py 1024
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import time  # noqa: E402

import numpy as np  # noqa: E402
from timing import best_of, print_table  # noqa: E402

from treadload.contact.bodies.half_space import HalfSpaces, combined  # noqa: E402
from treadload.contact.bodies.influence import Influence  # noqa: E402
from treadload.contact.solvers.normal import solve_normal  # noqa: E402
from treadload.grid import Grid  # noqa: E402
from treadload.tire import Tire  # noqa: E402
from treadload.validation.pressing import ASPHALT, RUBBER  # noqa: E402

SIZE, LOAD = 0.34, 35e3
HOME = Path(__file__).parent / ".peers"
REQUIRED = {"tamaas": ["tamaas==2.9.0"], "aspher": ["--no-deps", "aspher==0.1.3.post1"]}
# Run by the environment of a peer: argument names a file of the gap and what else it needs; prints seconds.
TAMAAS = """
import json, sys, time
import numpy as np
import tamaas as tm
asked = json.loads(sys.argv[1])
gap, n = np.load(asked["gap"]), asked["n"]
tm.set_log_level(tm.LogLevel.error)
began = time.process_time()
model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [asked["size"]] * 2, [n, n])
model.E, model.nu = asked["modulus"], 0.0
tm.ModelFactory.registerNonPeriodic(model, "dcfft")
solver = tm.PolonskyKeerRey(model, -np.where(np.isnan(gap), asked["wall"], gap), asked["tolerance"])
solver.setIntegralOperator("dcfft")
solver.solve(asked["load"] / asked["size"] ** 2)
print(time.process_time() - began)
np.save(asked["out"], np.array(model.traction))
"""
ASPHER = """
import json, sys, time
import numpy as np
import aspher
asked = json.loads(sys.argv[1])
gap, n = np.load(asked["gap"]), asked["n"]
began = time.process_time()
found = aspher.solve_nested(
    grid_size=n, gap=np.where(np.isnan(gap), asked["wall"], gap).ravel(),
    p_nominal=asked["load"] / asked["size"] ** 2,
    domain_size=asked["size"], E_star=asked["modulus"], coarsest=64, tol=asked["tolerance"], backend="fft",
    precond_engine="fft", precision=asked["precision"],
)
print(time.process_time() - began)
np.save(asked["out"], np.asarray(found.pressure))
"""
# Name, peer, its program, what it is asked, the largest grid.
SAME = {"wall": 0.05, "tolerance": 1e-6, "precision": "double"}
RUNS = (
    ("tamaas", "tamaas", TAMAAS, {"wall": 1.0, "tolerance": 1e-7}, 256),
    ("aspher", "aspher", ASPHER, SAME, 1024),
    ("aspher, float then double", "aspher", ASPHER, {**SAME, "precision": "float_then_double"}, 1024),
    ("aspher, wall of 1 m", "aspher", ASPHER, {**SAME, "wall": 1.0}, 1024),
)


def environment(name):
    """The Python of a peer's environment, made if need be; or why there is none, in a sentence."""
    home = HOME / name
    python = home / "bin" / "python"
    if not (home / "installed").exists():
        steps = (
            [sys.executable, "-m", "venv", str(home)],
            [str(python), "-m", "pip", "install", "--quiet", "numpy", "scipy"],
            [str(python), "-m", "pip", "install", "--quiet", *REQUIRED[name]],
            [str(python), "-c", f"import {name}"],
        )
        for step in steps:
            done = subprocess.run(step, capture_output=True, text=True, check=False)
            if done.returncode:
                last = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
                return None, f"{name} cannot be had here: {last[:160]}"
        (home / "installed").touch()
    return python, ""


def ours(grid, gap, bodies, tolerance=1e-6):
    return solve_normal(
        Influence(grid.shape, grid.dx, grid.dy, HalfSpaces(bodies)), gap, load=LOAD, tolerance=tolerance
    )


def theirs(python, program, asked, folder, gap, modulus, repeats):
    """Seconds of the fastest run and the pressure."""
    out = Path(folder) / "pressure.npy"
    told = {
        **asked,
        "gap": str(Path(folder) / "gap.npy"),
        "out": str(out),
        "n": gap.shape[0],
        "size": SIZE,
        "load": LOAD,
        "modulus": modulus,
    }
    np.save(told["gap"], gap)
    runs = [
        subprocess.run([python, "-c", program, json.dumps(told)], capture_output=True, text=True, check=True).stdout
        for _ in range(repeats)
    ]
    return min(map(float, runs)), np.load(out)


def measured(sizes=(64, 256, 1024), repeats=2):
    """Rows (solver, cells, seconds, error, ratio to ours), and the sentences on peers that there are not."""
    pythons = {name: environment(name) for name in REQUIRED}
    rows, bodies = [], combined(RUBBER, ASPHALT)
    for n in sizes:
        grid = Grid.centred(SIZE, SIZE, SIZE / n)
        gap = Tire.from_profile("315/80R22.5").height_map(grid)
        exact = ours(grid, gap, bodies, 1e-10).pressure
        size = np.linalg.norm(exact)
        seconds, found = best_of(lambda g=grid, h=gap: ours(g, h, bodies), repeats, time.process_time)
        rows.append(("treadload", n, seconds, float(np.linalg.norm(found.pressure - exact) / size), 1.0))
        for name, peer, program, asked, largest in RUNS:
            python, _ = pythons[peer]
            if python is not None and n <= largest:
                with tempfile.TemporaryDirectory() as folder:
                    spent, p = theirs(python, program, asked, folder, gap, bodies.contact_modulus, repeats)
                rows.append((name, n, spent, float(np.linalg.norm(p - exact) / size), spent / seconds))
    return rows, [why for python, why in pythons.values() if python is None]


def main(sizes=(64, 256, 1024)):
    rows, missing = measured(sizes)
    header = ("solver", "cells", "processor, s", "error of pressure", "time over ours")
    table = [(name, f"{n} x {n}", *rest) for name, n, *rest in rows]
    print_table("Normal contact of a grooved tire beside compiled peers, one thread, one run", header, table)
    for why in missing:
        print(f"  {why}\n")
    return rows


if __name__ == "__main__":
    main(tuple(map(int, sys.argv[1:])) or (64, 256, 1024))
