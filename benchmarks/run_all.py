"""All benchmarks in one run, on one thread unless they say so: numbers that can be compared stand side by side.

    python benchmarks/run_all.py [--short] [name ...]

--short: small sizes, no peers and no chart, some three minutes; else about half an hour, the first time with the
environments of the peers to make. name: only these, as `life` for `benchmarks/life.py`. One that fails is told at the
end, and the others go on.
"""

import os

# Before numpy is loaded: one thread, or the floors and the solves would not be comparable.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse  # noqa: E402
import importlib  # noqa: E402
import platform  # noqa: E402
import sys  # noqa: E402
import time  # noqa: E402
import traceback  # noqa: E402

import numpy  # noqa: E402
import scipy  # noqa: E402

# Arguments of each where a run is short; None where it has no short one. The chain first, so that its cold figure is
# cold.
ALL = {
    "whole_chain": {},
    "normal_contact": {"sizes": (64, 128, 256)},
    "rolling_contact": {"disc_sizes": (100, 200), "tread_sizes": (64,), "shift_sizes": ((128, 0.15),)},
    "belt": {},
    "ribs": {"repeats": 2},
    "indentation": None,
    "peers": None,
    "scaling": None,
    "scans": None,
    "studies": {"cases": 200, "rolled": 20},
    "layered": {},
    "moving": {},
    "life": {},
    "year": {},
    "page": {"repeats": 2},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("names", nargs="*", metavar="name", help=f"of {', '.join(ALL)}; all if left out")
    parser.add_argument("--short", action="store_true", help="small sizes, no peers and no chart")
    asked = parser.parse_args()
    if unknown := [name for name in asked.names if name not in ALL]:
        parser.error(f"no benchmark {', '.join(unknown)}; there are {', '.join(ALL)}")
    print(f"Python {platform.python_version()}, numpy {numpy.__version__}, scipy {scipy.__version__}, one thread\n")
    failed, known = [], {}
    for name in asked.names or ALL:
        small = ALL[name]
        if asked.short and small is None:
            print(f"{name}: not in a short run\n")
            continue
        began = time.perf_counter()
        with_peers = {"peers": known["peers"]} if name == "scaling" and "peers" in known else {}
        try:
            known[name] = importlib.import_module(name).main(**(small if asked.short else with_peers))
        except Exception:
            traceback.print_exc()
            failed.append(name)
        print(f"  {name}: {time.perf_counter() - began:.0f} s\n", flush=True)
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
