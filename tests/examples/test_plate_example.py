"""The plate test ends in moduli that Ritz's method confirms."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from punch import flat_punch_stiffness
from treadload.kernels.layers.images import surface_compliance
from treadload.kernels.layers.layered import Stack

EXAMPLE = Path(__file__).parents[2] / "examples" / "plate_test.py"


def test_plate_test(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLE))["main"](tmp_path, diameters=(0.3, 0.6), cells=32)
    shear = [modulus / 2.7 for modulus in (300e6, 120e6, 45e6)]
    stack = Stack(shear, [0.35] * 3, [0.25, 0.4, np.inf], [np.inf] * 2)
    for diameter, modulus in found["modulus"].items():
        stiffness = flat_punch_stiffness(
            lambda k: surface_compliance(k, stack)[0], 0.65 / shear[0], 0.25, diameter / 2
        )
        # 32 cells across make the disc 1 % smaller than it is.
        assert modulus == pytest.approx((1 - 0.35**2) * stiffness / diameter / 1e6, rel=0.02)
    assert found["modulus"][0.6] == pytest.approx(99, rel=0.02)
    # On a half-space: s = (1 - ν²) P / (2 a E).
    alone = (1 - 0.35**2) * 0.25e6 * np.pi * 0.6 / 4 / 300e6 * 1e3
    assert found["settlement"]["half_space"] == pytest.approx(alone, rel=0.02)
    assert found["settlement"]["layers"] > 2.5 * alone
    share = list(found["share"].values())
    assert share == sorted(share)
    assert share[0] < 2
    assert share[-1] > 99
    assert "modulus read" in capsys.readouterr().out
    assert (tmp_path / "plate_test.png").stat().st_size > 10_000
