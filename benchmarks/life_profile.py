"""Where the processor time of a life goes: `examples/design_life` with all its sensitivities, stage by stage.

    python benchmarks/life_profile.py [spacing in mm]

Of 9 classes, 11 roads and 18 changed questions. Seconds of one processor, on one busy machine of two cores, one
thread for each product of matrices; before roads and loads shared anything, 528 responses, under a profiler, and,
under a stopwatch, as they share what they can, then as well with single numbers and seasons told by the harm after
wander. Plain runs with the page took 262 s before and 48 s then:

    stage                       before   then    now   what changed
    contacts                        18      7      5   those of a changed input start from the life's own
    closed form of the top         133      6      3   once for all roads, for wheels on the same cells; single
    loads into wavenumbers          32      1      0   once for all roads; wheels behind each other are one
    functions of |k|                16      3      2   tabulated once for each road and depth, as many as are read
    products of both                12      3      1   only the components that are read, fewer wavenumbers; single
    back to points                  37      6      2   the same
    fields by their names           23      0      0   only what is read; roots of the cubic, no eigenvalue solver
    reading                         13      4      3   the crack at its worst instant alone
    rest                            13      8      7
    all                            297     38     23

On another machine that took 10.7 s, and 7.8 s once means over cubes of road were taken of functions, not of fields,
and contacts solved to 3e-5: contacts 1.8, closed form 0.7, waves 2.3, reading 1.5, rest 1.4.
"""

import os

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import sys  # noqa: E402
import threading  # noqa: E402
import time  # noqa: E402
from pathlib import Path  # noqa: E402

from timing import print_table  # noqa: E402

import treadload as tl  # noqa: E402
from treadload.kernels.layers import load_spectra, synthesis  # noqa: E402
from treadload.life import contacts, passage  # noqa: E402
from treadload.response import layered, several  # noqa: E402

DESIGN = Path(__file__).parents[1] / "examples" / "design_life" / "design.toml"
STAGES = (
    ("contacts", contacts, "contact_in_state"),
    ("closed form of the top", layered, "half_space_fields"),
    ("loads into wavenumbers", load_spectra.LoadSpectrum, "at"),
    ("functions of |k|", synthesis.ElasticPlane, "radial"),
    ("products of both", synthesis, "_waves"),
    ("back to points", synthesis, "_add"),
    ("fields by their names", several, "tensor_fields"),
    ("reading", passage, "_read"),
)


class Stopwatch:
    """Processor seconds of the stages, whichever thread they run in."""

    def __init__(self):
        self.spent, self.calls = {}, {}
        self._lock = threading.Lock()

    def around(self, stage, function):
        def timed(*given, **more):
            began = time.thread_time()
            try:
                return function(*given, **more)
            finally:
                spent = time.thread_time() - began
                with self._lock:
                    self.spent[stage] = self.spent.get(stage, 0.0) + spent
                    self.calls[stage] = self.calls.get(stage, 0) + 1

        return timed


def main(spacing=None):
    watch = Stopwatch()
    for stage, owner, name in STAGES:
        setattr(owner, name, watch.around(stage, getattr(owner, name)))
    case = tl.Case.from_toml(DESIGN)
    if spacing is not None:
        case = case.model_copy(update={"spacing": spacing})
    began = time.process_time()
    result = tl.run(case, workers=2)
    whole = time.process_time() - began
    rows = [(stage, watch.calls[stage], watch.spent[stage]) for stage, _, _ in STAGES]
    rows += [("rest", "", whole - sum(watch.spent.values())), ("all", "", whole)]
    print_table("Processor time of a life and its sensitivities", ("stage", "calls", "seconds"), rows)
    print(f"  {result.life.years(result.life.governing):.4g} years by {result.life.governing}\n")


if __name__ == "__main__":
    main(float(sys.argv[1]) / 1e3 if len(sys.argv) > 1 else None)
