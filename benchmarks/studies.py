"""Studies: what a case costs besides its solve, the memory of ten thousand of them, and two processes beside one.

    python studies.py [cases of a footprint] [cases of a tire]

Defaults: 1000 and 40, in a minute or two; the numbers in the documentation are of 10000 and 200.
"""

import resource
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from timing import print_table

import treadload as tl
from treadload.templates import first_case

# Two processes against one, where two hundred cases have their verdict.
GOAL = 1.7

PRINT = "\n".join(";".join(["400000"] * 6) for _ in range(6))
SMALL = """
[footprint]
file = "print.csv"
spacing = "30 mm"
units = { pressure = "Pa" }
[[pavement.layers]]
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }
[response]
depths = ["20 mm"]
"""
# Contact and road alone; and the case that `treadload init` writes, with its verdict.
LIGHT = """
spacing = "3 mm"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
[[pavement.layers]]
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }
[rolling]
normal_load = "32.5 kN"
tractive_force = "5 kN"
friction = 0.7
[response]
depths = ["20 mm"]
"""


def small(folder, count):
    """A case of milliseconds, many times: what remains is the study itself."""
    (folder / "print.csv").write_text(PRINT)
    case = tl.Case.from_text(SMALL, folder=folder)
    vary = {"modulus": np.linspace(1e9, 1e10, count // 10), "poisson": np.linspace(0.1, 0.45, 10)}
    began, spent = time.perf_counter(), time.process_time()
    study = tl.sweep(case, vary, store=folder / "small.zarr")
    seconds, processor = time.perf_counter() - began, time.process_time() - spent
    solving = study.stats["seconds"]
    size = sum(file.stat().st_size for file in (folder / "small.zarr").rglob("*")) / 1e6
    began = time.perf_counter()
    tl.sweeps.open_sweep(folder / "small.zarr")
    opening = time.perf_counter() - began
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    row = (study.stats["solved"], seconds, processor, 1e3 * (seconds - solving) / count, memory, size, opening)
    header = (
        "cases",
        "seconds",
        "processor",
        "ms besides a solve",
        "memory, MB",
        "store, MB",
        "opens in, s",
    )
    print_table("Many small cases, one process", header, [row])


def tires(folder, count):
    """A rolling tire at many loads and frictions, in one process and in two."""
    vary = {"normal_load": np.linspace(22e3, 45e3, count // 10), "friction": np.linspace(0.5, 0.9, 10)}
    rows = []
    for number, (name, text) in enumerate((("contact and road", LIGHT), ("with its verdict", first_case("run")))):
        case, first = tl.Case.from_text(text), None
        for jobs in (1, 2):
            began = time.perf_counter()
            study = tl.sweep(case, vary, store=folder / f"tires{number}{jobs}.zarr", jobs=jobs)
            seconds = time.perf_counter() - began
            first = first or seconds
            solved = study.stats["solved"]
            goal = "" if jobs == 1 or not number or count < 200 else "kept" if first / seconds >= GOAL else "MISSED"
            rows.append((name, jobs, solved, seconds / solved, seconds, first / seconds, goal))
    header = ("a rolling tire", "processes", "cases", "s a case", "seconds", "times", f"goal {GOAL} of 200")
    print_table("Processes, with their start", header, rows)


def main(cases=1000, rolled=40):
    folder = Path(tempfile.mkdtemp())
    try:
        small(folder, cases)
        tires(folder, rolled)
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
