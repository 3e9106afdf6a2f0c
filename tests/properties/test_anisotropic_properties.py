"""What holds on a half-space of any anisotropy: waves cost work, loads work on each other alike, forces balance."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadload as tl
from treadload.contact.bodies import Offsets, surface_of
from treadload.kernels.anisotropy.symbol import surface_symbol

MODULUS = st.floats(0.3e9, 3e9)
ANGLE = st.floats(-3.1, 3.1)
RATIO = st.floats(-0.25, 0.25)


@st.composite
def solids(draw):
    """Orthotropic solids of contrast up to ten, turned and tilted."""
    three = [tuple(draw(one) for _ in range(3)) for one in (MODULUS, st.floats(0.15e9, 1.2e9), RATIO)]
    return tl.materials.Orthotropic(*three).rotated(*(draw(ANGLE) for _ in range(3)))


@settings(max_examples=8, deadline=None, derandomize=True)
@given(solid=solids())
def test_every_wave_of_traction_costs_work_and_turning_the_scene_changes_nothing(solid):
    symbol = surface_symbol(solid.stiffness)
    angle = np.linspace(0, np.pi, 25)
    values = symbol(angle)
    assert np.linalg.eigvalsh(values).min() > 0
    # The bound of the symbol.
    np.testing.assert_allclose(symbol(angle + np.pi), values.conj(), rtol=0, atol=1e-12 * np.abs(values).max())
    turned = surface_symbol(solid.rotated(yaw=0.7).stiffness)(angle + 0.7)
    np.testing.assert_allclose(turned[:, 2, 2], values[:, 2, 2], rtol=0, atol=1e-12 * np.abs(values).max())


@settings(max_examples=10, deadline=None, derandomize=True)
@given(solid=solids(), is_tire=st.booleans())
def test_loads_on_two_cells_work_on_each_other_alike(solid, is_tire):
    body = surface_of(solid, is_tire=is_tire)
    at = Offsets(5, 5, 0.01, 0.013, -0.02, -0.026)
    normal = body.normal(at)
    size = 1e-12 * normal.max()
    np.testing.assert_allclose(normal[::-1, ::-1], normal, rtol=0, atol=size)
    tilted = body.tilted(at)
    np.testing.assert_allclose(tilted[:, ::-1, ::-1], [[[-1]], [[1]], [[1]]] * tilted, rtol=0, atol=size)
    np.testing.assert_allclose(body.coupling(at)[:, ::-1, ::-1], -body.coupling(at), rtol=0, atol=size)


@pytest.mark.slow
@settings(max_examples=6, deadline=None, derandomize=True)
@given(solid=solids(), depth=st.floats(0.05, 0.4))
def test_a_plane_below_carries_the_load_of_the_cell(solid, depth):
    """∫ σ_zz and ∫ σ_xz over a wide plane: what lies beyond falls with the square of its width."""
    cell = tl.response.GridLoad(
        tl.response.Grid(1, 1, 0.2, 0.2, 0.0, 0.0), *(part * np.ones((1, 1)) for part in (8e5, 1e5, -2e5))
    )
    force = np.array([8e5, 1e5, -2e5]) * 0.04
    carried = []
    for reach in (4.0, 8.0):
        # Points that thin out with distance, and their weights.
        t = np.linspace(-1, 1, 81)
        x, weight = reach * t**3, 3 * reach * t**2 * (t[1] - t[0])
        found = tl.solve_response(cell, tl.Pavement.half_space(solid), depths=[depth], x=np.unique(x), y=np.unique(x))
        weights = weight[np.unique(x, return_index=True)[1]]
        plane = [found.dataset[f"stress_{name}"].values[0] for name in ("zz", "xz", "yz")]
        carried.append([-(weights @ one @ weights) for one in plane])
    one, other = np.array(carried)
    # The tail falls as 1/reach at least; extrapolated it is the load.
    assert np.abs(2 * other - one - force).max() < 0.05 * force.max()
