"""Compliance of a road's surface in contact against extended precision: contrasts of 1e6, thin layers, many."""

import mpmath as mp
import numpy as np
import pytest
from test_layered_extended_precision import reference

import treadload as tl
from treadload.contact.bodies.choose import road_surface
from treadload.pavement.stack import stack_of

# Modulus, Pa; Poisson's ratio; thickness, m.
ROADS = {
    "contrast 1e6": [(1e10, 0.3, 0.05), (1e4, 0.45, None)],
    "contrast 1e-6": [(1e4, 0.3, 0.05), (1e10, 0.2, None)],
    "1 mm soft": [(3e9, 0.35, 0.05), (1e6, 0.49, 1e-3), (2e7, 0.4, None)],
    "1 mm stiff on top": [(2e11, 0.3, 1e-3), (2e7, 0.4, None)],
    "1 mm soft on top": [(1e6, 0.49, 1e-3), (3e10, 0.3, None)],
    "sandwich of 1e6": [(1e10, 0.3, 0.01), (1e4, 0.49, 1e-3), (1e10, 0.3, 0.01), (1e4, 0.49, None)],
    "100 of 1 mm": [*[(1e9 if n % 2 else 1e6, 0.35, 1e-3) for n in range(100)], (5e7, 0.4, None)],
}


@pytest.mark.parametrize("name", [pytest.param(one, marks=[pytest.mark.slow] * ("100" in one)) for one in ROADS])
def test_against_extended_precision(name):
    layers = [tl.Layer(tl.Elastic(modulus, poisson), thick) for modulus, poisson, thick in ROADS[name]]
    road = tl.Pavement(layers)
    deep = sum(thick or 0.0 for *_, thick in ROADS[name])
    wavenumbers = [20.0, 100.0] if len(layers) > 50 else [2.0, 20.0, 100.0, 600.0, 3000.0]
    body = road_surface(road, "layers")
    for wavenumber, found in zip(wavenumbers, body.across(np.array(wavenumbers)).T, strict=True):
        with mp.workdps(90 + int(wavenumber * deep)):
            exact = reference(wavenumber, stack_of(road))[0]
        normal, coupling = abs(exact[1, 1]), abs(exact[0, 1])
        # What the images tell of themselves, `images_residual`, is at most 1e-6; found at most 2.5e-7.
        assert found[0] == pytest.approx(normal, rel=1e-6)
        assert abs(found[1]) == pytest.approx(coupling, abs=1e-6 * normal)
