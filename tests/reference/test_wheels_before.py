"""What the wheels before leave in a viscoelastic road, against all wheels solved at once."""

import numpy as np
import pytest

import treadload as tl
from treadload.damage.fields import compute_quantities
from treadload.damage.history import residual_after

MIX = tl.materials.Prony(2e10, ((0.3, 1e-3), (0.3, 1e-2), (0.2, 0.1), (0.15, 1.0)), 0.35)
ROAD = tl.Pavement([tl.Layer(MIX, 0.1), tl.Layer(tl.Elastic(1e8, 0.35))])
SPEED, DEPTH = 20.0, [0.09]


def solved(places, x):
    wheels = [tl.UniformRectangle(0.2, 0.25, 8e5, x=place) for place in places]
    return tl.solve_response(wheels, ROAD, depths=DEPTH, x=x, y=[0.0, 0.2], speed=SPEED)


@pytest.mark.slow
def test_the_sum_of_tails_is_the_row_of_wheels():
    x = np.concatenate([np.linspace(-4.5, -1, 36, endpoint=False), np.linspace(-1, 0.5, 61)])
    one = solved([0.0], x)
    found = residual_after(one, spacing=2.0, passes=2)
    before = solved([2.0, 4.0], found["x"].to_numpy())
    largest = float(abs(one.dataset["stress_xx"]).max())
    for component in ("xx", "yy", "zz", "xy", "xz", "yz"):
        left = found[f"residual_stress_{component}"].to_numpy()
        # The spline of the tail on 0.1 m, which fades over a metre: 1e-5 of its curvature, in parts of the peak.
        np.testing.assert_allclose(left, before.dataset[f"stress_{component}"], atol=1e-6 * largest)
    # It is not nothing: the mix still holds some of what the wheels did.
    assert float(abs(found["residual_stress_yy"]).max()) > 1e-3 * largest
    energy = compute_quantities(one)["dissipated_energy"]
    assert energy.dims == ("depth", "y")
    assert (energy > 0).all()
