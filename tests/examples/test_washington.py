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


def solved(name):
    """The script's functions, the growth of a crack by its name, and depths and powers of its growth."""
    example = runpy.run_path(str(EXAMPLE / "run.py"))
    growth = example["main"](["spacing=0.012"], [name])[name].growth
    return example, *example["rises"](growth)


# A test for each crack: of the three together one took more than 900 s on a machine that other programs shared.
@pytest.mark.slow
def test_growth_slows_at_the_interface(capsys):
    example, depths, powers = solved("through both courses")
    # The rise of the rate with depth dips in the one step that holds the interface, and nowhere else.
    at = int(np.abs(depths - example["SEEN_DEPTH"]).argmin())
    assert depths[at] == pytest.approx(0.044, rel=0.05)
    assert powers[at] == powers.min()
    assert powers[at] < 0.6 * min(powers[at - 1], powers[at + 1])
    assert "in Washington after 3 to 8:" in capsys.readouterr().out


@pytest.mark.slow
def test_growth_to_a_bonded_interface_slows(capsys):
    _, _, powers = solved("to the interface, bonded")
    assert powers[-1] < 0.7 * powers[0]
    assert "K falls" in capsys.readouterr().out


@pytest.mark.slow
def test_growth_to_a_sliding_interface_speeds_up(capsys):
    _, _, powers = solved("to the interface, sliding")
    assert powers[-1] > 2 * powers[0]
    assert "a crack may turn along it" in capsys.readouterr().out
