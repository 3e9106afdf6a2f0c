"""A depth on an interface is met within round-off, on the side that was asked for, and the result says which."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.kernels.layers.depths import SAME_DEPTH, layers_at, on_interface, snapped
from treadload.plots.kit.layers import Layers

STIFF, SOFT = tl.Elastic(5e9, 0.35), tl.Elastic(1e8, 0.35)
DISC = tl.UniformDisc(0.125, 6.62e5)
# 19 times 0.02 m sum up to 0.38000000000000006 m, and 0.06 + 0.10 + 0.25 m to 0.41000000000000003 m.
COURSES = tl.Pavement(
    [tl.Layer(STIFF if k % 2 else tl.Elastic(6e9, 0.35), 0.02, f"course {k + 1}") for k in range(19)]
    + [tl.Layer(SOFT, name="soil")]
)
DESIGN = tl.Pavement(
    [
        tl.Layer(tl.Elastic(1.512e9, 0.35), 0.06, "BBSG"),
        tl.Layer(tl.Elastic(2.588e9, 0.35), 0.10, "GB3"),
        tl.Layer(tl.Elastic(2e8, 0.35), 0.25, "unbound"),
        tl.Layer(tl.Elastic(5e7, 0.35), name="soil"),
    ]
)
WHEELS = [tl.UniformDisc(0.125, 6.62e5, y=y) for y in (-0.1875, 0.1875)]


def at(road, depth, side, **more):
    loads = more.pop("loads", DISC)
    return tl.solve_response(loads, road, depths=[depth], x=[0.0], y=[0.0], side=side, **more)


@pytest.mark.parametrize("depth", [0.38, 0.38 + 1e-15, 0.38 - 4e-10, math.fsum([0.02] * 19)])
def test_a_depth_is_on_an_interface_within_round_off(depth):
    """Far above the round-off of a sum, far below any grain: the sides differ by the jump of the modulus."""
    exact = float(COURSES.interfaces[18])
    for side, name in (("above", "bottom of course 19"), ("below", "top of soil")):
        found, wanted = at(COURSES, depth, side), at(COURSES, exact, side)
        for name_ in ("stress_xx", "strain_zz", "displacement_z"):
            # 4e-10 m of 0.38 m.
            assert found.dataset[name_].item() == pytest.approx(wanted.dataset[name_].item(), rel=1e-8), name_
        # What was asked for, not what it was taken for.
        assert found.dataset.depth.item() == depth
        assert f"depth 380 mm ({name})" in found.summary()
    above, below = (at(COURSES, depth, side).dataset.stress_xx.item() for side in ("above", "below"))
    assert above > 0.1e6
    assert abs(below) < 0.1 * above


def test_a_printed_design_is_read_on_top_of_the_soil():
    """0.06 + 0.10 + 0.25 m is not 0.41 m: the strain down in the soil is nearly twice that in the layer above."""
    assert DESIGN.interfaces[2] != 0.41
    points = {"loads": WHEELS, "road": DESIGN, "depths": [0.41], "x": [0.0], "y": [0.0, 0.1875]}
    above, below = (tl.solve_response(side=side, **points).dataset for side in ("above", "below"))
    for data, modulus in ((above, 2e8), (below, 5e7)):
        strain = (data.stress_zz - 0.35 * (data.stress_xx + data.stress_yy)) / modulus
        # Hooke's law with the modulus of the layer that was asked for.
        assert np.allclose(data.strain_zz, strain, rtol=1e-9, atol=0)
    assert np.allclose(above.stress_zz, below.stress_zz, rtol=1e-9, atol=0)
    assert float(below.strain_zz.min()) < 1.8 * float(above.strain_zz.min())
    assert [data.layer.item() for data in (above, below)] == [2, 3]


def test_neighbours_of_one_material_keep_the_interfaces_of_all():
    """Two courses of one mix are one layer to the solver, whose interfaces then sum in another order."""
    rows = [tl.Layer(STIFF, 0.1), tl.Layer(STIFF, 0.2), tl.Layer(STIFF, 0.3), tl.Layer(SOFT)]
    road = tl.Pavement([tl.Layer(SOFT, 0.7), *rows])
    ends = road.interfaces
    for side, young in (("above", 5e9), ("below", 1e8)):
        data = at(road, float(ends[-1]), side).dataset
        modulus = (data.stress_xx - 0.35 * (data.stress_yy + data.stress_zz)) / data.strain_xx
        assert modulus.item() == pytest.approx(young, rel=1e-9)


def test_the_rigid_base_is_met_within_round_off():
    road = tl.Pavement([tl.Layer(STIFF, 0.1), tl.Layer(SOFT, 0.2), tl.Layer(STIFF, 0.3)], rigid_base=True)
    base = float(road.interfaces[-1])
    assert base != 0.6
    for depth in (0.6, 0.6 + 2e-16, base, base + 5e-10):
        data = at(road, depth, "above").dataset
        assert abs(data.displacement_z.item()) < 1e-15
    with pytest.raises(tl.InputError, match=r"below the rigid base at 0.6 m"):
        at(road, 0.6 + 1e-8, "above")
    assert road.layer_at(0.6, "below") == 2


def test_under_a_moving_load_too():
    asphalt = tl.materials.Prony(5e9, ((0.3, 1e-3), (0.3, 0.1)), 0.35)
    road = tl.Pavement([tl.Layer(asphalt, 0.02) for _ in range(19)] + [tl.Layer(SOFT)])
    exact = float(road.interfaces[18])
    found = [at(road, depth, "below", speed=10.0).dataset.stress_xx.item() for depth in (0.38, exact)]
    assert found[0] == pytest.approx(found[1], rel=1e-12)


def test_the_layer_of_a_depth():
    assert [DESIGN.layer_at(z, "above") for z in (0.0, 0.03, 0.06, 0.16, 0.41, 2.0)] == [0, 0, 0, 1, 2, 3]
    assert [DESIGN.layer_at(z, "below") for z in (0.0, 0.03, 0.06, 0.16, 0.41, 2.0)] == [0, 0, 1, 2, 3, 3]
    assert DESIGN.layer_at(0.41 + 2e-9, "above") == 3
    assert DESIGN.layer_at(0.41 - 2e-9, "below") == 2
    with pytest.raises(tl.InputError, match="depth must be >= 0"):
        DESIGN.layer_at(-1.0)


def test_depths_that_round_off_alone_tells_apart_are_one():
    with pytest.raises(tl.InputError, match=r"distinct by more than round-off, got 0.41 m, an interface, 2 times"):
        tl.solve_response(DISC, DESIGN, depths=[0.41, DESIGN.interfaces[2]], x=[0.0], y=[0.0])


def test_figures_cut_where_the_solver_does():
    """A response at the round depth is drawn in the layer that it was solved in."""
    for side, number in (("above", 2), ("below", 3)):
        data = tl.solve_response(DISC, DESIGN, depths=[0.0, 0.2, 0.41, 0.6], x=[0.0, 0.1], y=[0.0], side=side).dataset
        rows = Layers.of(data).pieces(data.depth.to_numpy() * 1e3)
        assert data.layer.values.tolist() == [
            next(k for k, piece in enumerate(rows) if piece.start <= row < piece.stop) for row in range(4)
        ]
        assert data.layer.values[2] == number


def test_the_nearest_of_two_interfaces_serves():
    """A film thinner than the tolerance: each of its sides is met by its own number."""
    ends = np.array([0.1, 0.1 + 4e-10, 0.3])
    assert snapped(ends, ends).tolist() == ends.tolist()
    assert snapped([0.0, 0.2, 0.3 + SAME_DEPTH / 2], ends).tolist() == [0.0, 0.2, 0.3]
    assert layers_at(ends, ends, False).tolist() == [0, 1, 2]
    assert layers_at(ends, ends, True).tolist() == [1, 2, 3]
    assert layers_at(ends, ends, [True, False, True]).tolist() == [1, 1, 3]
    assert on_interface([0.2, 0.3 - SAME_DEPTH / 2], ends).tolist() == [False, True]
