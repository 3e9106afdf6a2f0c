"""Memory of rolling on a large grid, in a process of its own."""

import os
import subprocess
import sys

import pytest

MOST = 1.5e9  # bytes, the house's bound at 1024²

RUN = """
from pathlib import Path
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.patches import paraboloid

bodies, cells = CombinedElasticity(1.0, 0.25, 0.0), 1024
load, spacing = 4 * bodies.contact_modulus / 3, 2.2 / cells
patch = paraboloid(bodies, (1.0, 1.0), load, (cells, cells), (spacing, spacing), tolerance=1e-6)
found = patch.roll(0.3, (0.5 * 0.3 * patch.load / 4.12, 0.0))
assert found.residual <= 1e-6
# ru_maxrss of a child begins with the memory of the process that started it.
status = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
print(1024 * int(status["VmHWM"].split()[0]))
"""


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc is of Linux")
def test_a_million_cells_fit():
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", RUN], capture_output=True, text=True, check=True, env=environment)
    assert float(done.stdout) < MOST
