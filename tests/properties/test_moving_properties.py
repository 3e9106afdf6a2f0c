"""Moving loads: what holds for any road, load and speed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadload as tl
from treadload.grid import Grid
from treadload.response import GridLoad

GRID = Grid(3, 2, 0.06, 0.05, -0.06, -0.025)
SOIL = tl.Elastic(6e7, 0.4)
KINDS = [f"{kind}_{c}" for kind in ("stress", "strain") for c in ("xx", "yy", "zz", "xy", "xz", "yz")]
KINDS += [f"displacement_{c}" for c in "xyz"]
ODD = {f"{kind}_{c}" for kind in ("stress", "strain") for c in ("xy", "yz")} | {"displacement_y"}

solids = st.builds(
    lambda shares, slow, poisson: tl.materials.Prony(
        9e9, tuple(zip(0.95 * np.array(shares) / max(1.0, sum(shares)), (slow, 9 * slow), strict=True)), poisson
    ),
    st.tuples(st.floats(0.05, 0.9), st.floats(0.05, 0.9)),
    st.floats(1e-4, 1e2),
    st.floats(0.0, 0.49),
)
loads = st.builds(
    lambda seed: GridLoad(
        GRID,
        np.random.default_rng(seed).uniform(0, 1e6, GRID.shape),
        *np.random.default_rng(seed + 1).uniform(-3e5, 3e5, (2, *GRID.shape)),
    ),
    st.integers(0, 2**30),
)


@settings(max_examples=4, deadline=None)
@given(solid=solids, load=loads, speed=st.floats(0.1, 50.0))
def test_energy_is_lost_never_won(solid, load, speed):
    road = tl.Pavement([tl.Layer(solid, 0.12), tl.Layer(SOIL)])
    solved = tl.solve_response(load, road, depths=[0.06, 0.12], x=[0.0], y=[-0.3, 0.0, 0.04], speed=speed).dataset
    assert (solved["dissipated_energy"] >= 0).all()


@settings(max_examples=2, deadline=None)
@given(solid=solids, load=loads, speed=st.floats(0.1, 50.0))
def test_a_mirrored_load_gives_the_mirrored_field(solid, load, speed):
    road = tl.Pavement([tl.Layer(solid, 0.12), tl.Layer(SOIL)])
    mirrored = GridLoad(GRID, load.pressure[::-1], load.traction_x[::-1], -load.traction_y[::-1])
    points = {"depths": [0.0, 0.12], "x": [-0.2, 0.013], "y": [-0.04, 0.04], "speed": speed}
    one, other = tl.solve_response(load, road, **points).dataset, tl.solve_response(mirrored, road, **points).dataset
    for name in KINDS:
        flipped = other[name].to_numpy()[:, ::-1] * (-1 if name in ODD else 1)
        # Round-off.
        assert np.abs(one[name].to_numpy() - flipped).max() <= 1e-9 * np.abs(flipped).max(), name


@pytest.mark.slow
@settings(max_examples=2, deadline=None)
@given(solid=solids, first=loads, speed=st.floats(0.1, 50.0))
def test_loads_add_up(solid, first, speed):
    road = tl.Pavement([tl.Layer(solid, 0.12), tl.Layer(SOIL)])
    second = tl.UniformDisc(0.07, 5e5, x=-0.3, y=0.02)
    points = {"depths": [0.05, 0.2], "x": [-0.3, 0.013], "y": [0.0], "speed": speed}
    parts = [tl.solve_response(load, road, **points).dataset for load in (first, second)]
    both = tl.solve_response([first, second], road, **points).dataset
    for name in KINDS:
        added = parts[0][name] + parts[1][name]
        # Panels for another reach.
        assert (
            np.abs(both[name] - added).max()
            <= 1e-8 * np.abs(parts[0][name]).max() + 1e-8 * np.abs(parts[1][name]).max()
        ), name
