"""`examples/washington`: growth slows at the interface of the wearing course, where cracks are seen to stop."""

import runpy
from pathlib import Path

import numpy as np
import pytest

import treadload as tl

EXAMPLE = Path(__file__).parents[2] / "examples" / "washington"


def test_its_case_can_be_read():
    case = tl.Case.from_toml(EXAMPLE / "wearing_course.toml")
    assert case.road().interfaces[0] == pytest.approx(0.05)


@pytest.mark.slow
def test_growth_slows_at_the_interface(capsys):
    example = runpy.run_path(str(EXAMPLE / "run.py"))
    results = example["main"](["spacing=0.012"])
    depths, powers = example["rises"](results["through both courses"].growth)
    # The rise of the rate with depth dips in the one step that holds the interface, and nowhere else.
    at = int(np.abs(depths - example["SEEN_DEPTH"]).argmin())
    assert depths[at] == pytest.approx(0.044, rel=0.05)
    assert powers[at] == powers.min()
    assert powers[at] < 0.6 * min(powers[at - 1], powers[at + 1])
    _, bonded = example["rises"](results["to the interface, bonded"].growth)
    assert bonded[-1] < 0.7 * bonded[0]
    _, sliding = example["rises"](results["to the interface, sliding"].growth)
    assert sliding[-1] > 2 * sliding[0]
    said = capsys.readouterr().out
    assert "in Washington after 3 to 8:" in said
    assert "K falls" in said
    assert "a crack may turn along it" in said
