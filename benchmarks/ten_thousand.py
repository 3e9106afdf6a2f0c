"""A study of ten thousand cases with processes: memory of the study itself, its journal, a resume when it is done.

    python ten_thousand.py [cases] [processes]

Defaults: 10000 and 2; some minutes. Real: cases of a footprint on a half-space, milliseconds each, through processes,
journal and arrays. Repeated: the record of a real tire with its verdict, written as often through the same store,
since ten thousand tires take hours: their lines are longer, and memory and journal grow with lines. A resume is the
call of `sweep` in a fresh process; the imports of that process are listed beside it.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from timing import print_table

# The study itself, MB; its journal, MB; a resume when every case is solved, processor seconds.
MEMORY, JOURNAL, RESUME = 400, 20, 2.0

HEAD = """
import json, resource, sys, time
from pathlib import Path
import numpy as np
import treadload as tl

def told(began, **more):
    usage = resource.getrusage(resource.RUSAGE_SELF)
    processor = usage.ru_utime + usage.ru_stime
    print(json.dumps({"seconds": time.perf_counter() - began, "processor": processor,
                      "call": time.process_time() - ready, "memory": usage.ru_maxrss / 1e3, **more}))
began, ready = time.perf_counter(), time.process_time()
count, jobs = int(sys.argv[1]), int(sys.argv[2])
"""
REAL = (
    HEAD
    + """
if __name__ == "__main__":
    case = tl.Case.from_toml("small.toml")
    ready = time.process_time()
    vary = {"modulus": np.linspace(1e9, 1e10, count // 10), "poisson": np.linspace(0.1, 0.45, 10)}
    study = tl.sweep(case, vary, store="real.zarr", jobs=jobs)
    told(began, solved=study.stats["solved"], solving=study.stats["seconds"])
"""
)
REPEATED = (
    HEAD
    + """
from dataclasses import replace
from treadload.templates import first_case
from treadload.sweeps.design import product
from treadload.sweeps.places import processes
from treadload.sweeps.store import begun
from treadload.sweeps.sweep import _anchor
from treadload.sweeps.work import Question

if __name__ == "__main__":
    case = tl.Case.from_text(first_case("run"))
    vary = {"friction": np.linspace(0.5, 0.9, count // 100), "normal_load": np.linspace(22e3, 45e3, 100)}
    design = product(case, vary)
    # As `sweep` asks, so that the same command is a resume.
    question = Question(case.as_tables(), case.folder.resolve(), (), _anchor(case, design))
    if not Path("repeated.zarr").exists():
        # In a process of its own: the memory is that of the study alone.
        record = next(iter(processes(question, [(0, design.at(0))], 1)))
        with begun("repeated.zarr", case, design, question) as store:
            for number in range(design.count):
                store.append(replace(record, number=number))
    ready = time.process_time()
    study = tl.sweep(case, vary, store="repeated.zarr", jobs=jobs)
    told(began, solved=study.stats["solved"], solving=study.stats["seconds"])
"""
)
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
[damage]
fatigue = { epsilon_6 = "120 microstrain", slope = -0.2 }
"""


def ran(code, folder, *arguments):
    """What a fresh process says of itself."""
    script = folder / "study.py"
    script.write_text(code)
    command = [sys.executable, str(script), *map(str, arguments)]
    text = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True, env=os.environ).stdout
    return json.loads(text.splitlines()[-1])


def main(count=10_000, jobs=2):
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "print.csv").write_text(PRINT)
        (folder / "small.toml").write_text(SMALL)
        for kind, code in (("real", REAL), ("repeated", REPEATED)):
            first = ran(code, folder, count, jobs)
            journal = (folder / f"{kind}.zarr" / ".records.jsonl").stat().st_size / 1e6
            again = ran(code, folder, count, jobs)
            assert first["solved"] == again["solved"] == count
            kept = first["memory"] <= MEMORY and journal <= JOURNAL and again["call"] <= RESUME
            rows.append((kind, count, first["seconds"], first["processor"], first["memory"], journal,
                         again["call"], again["processor"], "kept" if kept else "MISSED"))  # fmt: skip
    header = ("cases", "count", "seconds", "processor", "memory, MB", "journal, MB", "resume, processor s",
              "with imports", f"bounds {MEMORY} MB, {JOURNAL} MB, {RESUME:g} s")  # fmt: skip
    print_table("A large study, the process of the study itself", header, rows)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
