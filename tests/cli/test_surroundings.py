"""Whatever surrounds the program, a case gives the same numbers and no raw error."""

import os
import subprocess
import sys

import numpy as np
import pytest

import treadload as tl
from sweeps import small_case

LONG = "Straße 工程 " + "ä" * 60
WORLDS = {
    "no home": ({"HOME": None}, ""),
    "a long path": ({"LC_ALL": "C"}, f"{LONG}/{'b' * 150}/{'c' * 150}"),
}


@pytest.mark.slow
@pytest.mark.parametrize("world", WORLDS)
def test_the_same_numbers_everywhere(tmp_path, world):
    changes, path = WORLDS[world]
    folder = tmp_path / path
    folder.mkdir(parents=True, exist_ok=True)
    case = small_case(folder)
    environment = {name: value for name, value in {**os.environ, **changes}.items() if value is not None}
    command = [sys.executable, "-m", "treadload", "run", "case.toml", "--quiet"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    here = tl.study.run_case(case).to_tree()["response"]["stress_zz"].to_numpy()
    assert np.array_equal(tl.open_results(folder / "case.nc").response.dataset["stress_zz"].to_numpy(), here)
