"""The seam of the bodies: what a pair sums, what a particle feels ahead, and a body from somebody else's file."""

import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest

import treadload as tl
from treadload.contact.bodies import HalfSpaces, Influence, Offsets, Pair, Sum, Waves, surface_of
from treadload.contact.bodies.ahead import Ahead
from treadload.contact.bodies.layers import layered_road
from treadload.contact.bodies.viscoelastic import rolling_pair
from treadload.kernels.layers.layered import Stack
from treadload.registry import MATERIALS

RUBBER, ASPHALT = tl.Elastic(3e6, 0.45), tl.Elastic(5.4e9, 0.35)
SOLID = tl.materials.Prony.standard_linear_solid(4e6, 3e6, 5e-3, 0.45)
STACK = Stack([2.5e9, 1e8, 4e7], [0.35, 0.3, 0.45], [0.04, 0.1, math.inf], [1e9, math.inf])
TIRE = HalfSpaces.of(tl.Elastic(1e9, 0.3), None)
LAYERED = Sum.of(TIRE, layered_road(STACK))
AT = Offsets(5, 8, 0.01, 0.02)


def test_half_spaces_join_to_those_of_the_pair():
    joined = Sum.of(surface_of(RUBBER, is_tire=True), surface_of(ASPHALT, is_tire=False))
    both = HalfSpaces.of(RUBBER, ASPHALT)
    for name in ("shear_modulus", "poisson", "difference"):
        assert getattr(joined.elasticity, name) == pytest.approx(getattr(both.elasticity, name), rel=1e-14)
    assert not Influence(
        (3, 3), 1.0, 1.0, Sum.of(*(surface_of(RUBBER, is_tire=side) for side in (True, False)))
    ).coupled


@pytest.mark.parametrize("pair", [LAYERED, rolling_pair(SOLID, ASPHALT, 10.0)], ids=["layers", "memory"])
def test_a_sum_is_the_sum_of_its_parts(pair):
    assert len(pair.parts) == 2
    for name in ("normal", "tangential", "coupling"):
        parts = sum(getattr(part, name)(AT) for part in pair.parts)
        np.testing.assert_allclose(getattr(pair, name)(AT), parts, rtol=1e-14)
    waves = Waves((6, 8), 0.01, 0.02)
    np.testing.assert_allclose(pair.compliance(waves), sum(part.compliance(waves) for part in pair.parts), rtol=1e-14)


@pytest.mark.parametrize("cells", [1, 5, 20])
def test_ahead_on_layers_by_whole_cells_is_the_displacement_of_a_larger_grid(cells):
    rng = np.random.default_rng(2)
    shear, pressure = np.zeros((2, 13, 40)), np.zeros((13, 40))
    shear[..., :17], pressure[:, :17] = rng.normal(size=(2, 13, 17)), rng.random((13, 17))
    expected = Influence((13, 40), 0.02, 0.03, LAYERED).displacement(pressure, shear)[:2, :, cells : cells + 17]
    point = Ahead(Influence((13, 17), 0.02, 0.03, LAYERED), 0.02 * cells)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(point(shear[..., :17], pressure[:, :17]), expected, rtol=0, atol=1e-10 * scale)
    # The layers are what a half-space of the top one would leave out.
    top = HalfSpaces.of(tl.Elastic(1e9, 0.3), tl.Elastic(2.5e9 * 2.7, 0.35))
    plain = Ahead(Influence((13, 17), 0.02, 0.03, top), 0.02 * cells)(shear[..., :17], pressure[:, :17])
    assert np.abs(plain - expected).max() > 0.1 * scale


@pytest.mark.parametrize("quarter", [1, 3, 5, 7])
def test_ahead_on_layers_by_a_part_of_a_cell_is_the_displacement_of_finer_cells(quarter):
    rng = np.random.default_rng(3)
    coarse, pressure = rng.normal(size=(2, 13, 17)), rng.random((13, 17))
    # Centres of cells of half the size lie a quarter ahead of and behind those of the whole.
    fine, pressed = np.zeros((2, 13, 52)), np.zeros((13, 52))
    fine[..., :34], pressed[:, :34] = coarse.repeat(2, -1), pressure.repeat(2, -1)
    wide = Influence((13, 52), 0.01, 0.03, LAYERED).displacement(pressed, fine)
    expected = wide[:2, :, (quarter + 1) // 2 :: 2][..., :17]
    found = Ahead(Influence((13, 17), 0.02, 0.03, LAYERED), 0.005 * quarter)(coarse, pressure)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


@pytest.mark.slow
def test_a_history_on_layers_ends_in_steady_rolling_on_them():
    road = tl.Pavement([tl.Layer(tl.Elastic(7e9, 0.35), 0.01), tl.Layer(tl.Elastic(120e6, 0.35))])
    x = 2e-3 * (np.arange(20) - 9.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 0.1)
    tire = tl.Tire.from_height_map(gap, 2e-3, material=tl.Elastic(210e9, 0.3))
    wheel = tl.Rolling(normal_load=200.0, friction=0.5, tractive_force=50.0)
    steady = tl.solve_contact(tire, road, wheel, road_compliance="layers", tolerance=1e-8).dataset
    way = 2e-3 * np.arange(1, 41)
    end = tl.contact.solve_transient(tire, road, wheel, distances=way, road_compliance="layers", tolerance=1e-8)
    last = end.contact.dataset
    assert float(last.creepage_x) == pytest.approx(float(steady.creepage_x), rel=1e-5)
    np.testing.assert_allclose(last.traction_x, steady.traction_x, atol=1e-5 * float(np.abs(steady.traction_x).max()))
    # On a half-space of the top layer the creepage is another.
    plain = tl.solve_contact(tire, road, wheel, tolerance=1e-8).dataset
    assert abs(float(plain.creepage_x) / float(steady.creepage_x) - 1) > 0.05


def test_memory_is_refused_between_cells():
    with pytest.raises(tl.InputError, match=r"at whole cells, asked for -0.013 m .* material.glassy"):
        rolling_pair(SOLID, ASPHALT, 10.0).normal(Offsets(3, 3, 0.01, 0.01, -0.013))


# From here on: what somebody else writes in a file of their own, that of the plug-in which CONTRIBUTING shows.
_SPEC = importlib.util.spec_from_file_location(
    "brush_of_the_plugin", Path(__file__).parents[2] / "examples" / "plugin" / "road_laws" / "body.py"
)
_BODY = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(_BODY)
Brush = MATERIALS.register("brush")(_BODY.Brush)
BRUSH = Brush(4e7, 2e7)


STIFF = tl.Pavement.half_space(tl.Elastic(1e16, 0.35))
CELL, RADIUS = 2e-3, 0.5


def brush_tire(material=BRUSH):
    x = CELL * (np.arange(80) - 39.5)
    gap = np.broadcast_to(x[None, :] ** 2 / (2 * RADIUS), (12, 80)).copy()
    gap[[0, -1]] = np.nan
    return tl.Tire.from_height_map(gap, CELL, material=material), x


def test_a_body_from_outside_solves_normal_contact():
    """A bed of springs: p = k (δ - gap) where it touches, without any influence between cells."""
    tire, x = brush_tire()
    found = tl.solve_contact(tire, STIFF, tl.Rolling(approach=4e-3, friction=0.0))
    exact = 4e7 * np.maximum(4e-3 - (x**2 - x[39] ** 2) / (2 * RADIUS), 0.0)
    # The road is a millionth as compliant.
    np.testing.assert_allclose(found.dataset.pressure[5], exact, atol=1e-5 * exact.max())
    assert found.stats["road_share"] < 1e-6


def test_a_body_from_outside_rolls_as_the_brush_model_says():
    """Where a brush sticks its shear grows by k ξ dx a cell from the leading edge on."""
    tire, x = brush_tire()
    found = tl.solve_contact(
        tire, STIFF, tl.Rolling(approach=4e-3, creepage_x=-1e-3, friction=5.0), tolerance=1e-9
    ).dataset
    touching = found.pressure[5].values > 0
    leading = x[touching].max()
    # The bristle at the leading cell has travelled a whole cell, see `contact.solvers.rolling`.
    exact = np.where(touching, -2e7 * 1e-3 * (leading - x + CELL), 0.0)
    np.testing.assert_allclose(found.traction_x[5], exact, atol=1e-4 * np.abs(exact).max())


def test_a_body_from_outside_is_named_in_a_case(tmp_path):
    tire, _ = brush_tire()
    np.savetxt(tmp_path / "map.csv", tire.height_map(tire.fixed_grid), delimiter=",")
    (tmp_path / "case.toml").write_text(
        """
        [tire]
        height_map = "map.csv"
        cell = "2 mm"
        material = { kind = "brush", normal_stiffness = 4e7, shear_stiffness = 2e7 }
        [[pavement.layers]]
        material = { kind = "elastic", modulus = "1e10 MPa", poisson = 0.35 }
        [rolling]
        approach = "4 mm"
        friction = 0.5
        [response]
        depths = ["10 mm"]
        """
    )
    case = tl.Case.from_toml(tmp_path / "case.toml")
    assert case.build_tire().material == Brush(4e7, 2e7)


def test_a_material_without_a_body_is_refused():
    with pytest.raises(tl.InputError, match=r"no body is known for the material of the tire, a str; .* surface\("):
        surface_of("rubber", is_tire=True)
    with pytest.raises(tl.InputError, match="what makes a surface of its own"):
        brush_tire("rubber")


def test_a_pair_is_that_of_tire_and_road():
    tire, _ = brush_tire(RUBBER)
    pair = Pair.of(tire, tl.Pavement.half_space(ASPHALT)).both
    np.testing.assert_allclose(pair.normal(AT), HalfSpaces.of(RUBBER, ASPHALT).normal(AT), rtol=1e-13)
