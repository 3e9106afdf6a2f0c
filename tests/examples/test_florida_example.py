"""`examples/florida`: test roads of a report as cases, and strains where the report had gauges."""

import runpy
from pathlib import Path

import numpy as np
import pytest

import treadload as tl

EXAMPLE = Path(__file__).parents[2] / "examples" / "florida"


@pytest.mark.parametrize(("road", "inches"), [("pit", 3.0), ("track", 4.0)])
def test_layers_are_those_of_the_report(road, inches):
    """Thickness of the asphalt, 10.5 in of limerock, 12 in stabilised; k₁ θ^k₂ at 40, 18 and 11 psi."""
    layers = tl.Case.from_toml(EXAMPLE / f"{road}.toml").road().layers
    assert sum(layer.thickness for layer in layers[:-3]) == pytest.approx(inches * 0.0254)
    assert [layer.thickness for layer in layers[-3:-1]] == pytest.approx([10.5 * 0.0254, 12 * 0.0254])
    psi = 6894.757293168361
    for layer, constants in zip(
        layers[-3:], ((3297, 0.5752, 40), (4079, 0.5244, 18), (3687, 0.5193, 11)), strict=True
    ):
        k_1, k_2, bulk = constants
        # Four digits of the exponents: 0.1 % of the modulus.
        assert layer.material.modulus == pytest.approx(k_1 * bulk**k_2 * psi, rel=2e-3)


@pytest.mark.slow
def test_strains_fade_from_the_wheel_and_follow_the_load(capsys):
    results = runpy.run_path(str(EXAMPLE / "run.py"))["main"](("pit",), (6, 12))
    assert "measured: not public" in capsys.readouterr().out
    for row in (0, 1):
        light, heavy = results["pit", 6][row], results["pit", 12][row]
        assert (light > 0).all()
        # Away from the footprint strains follow the load; its shape is another.
        np.testing.assert_allclose(heavy[2:] / light[2:], 2.0, rtol=0.1)
    assert results["pit", 12][2] == pytest.approx(2 * results["pit", 6][2], rel=0.25)
