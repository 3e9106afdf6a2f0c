"""Anisotropic half-spaces as bodies of a contact: no parity along x and y is left, and the operators still hold."""

from dataclasses import dataclass

import numpy as np
import pytest
from tests.grain import STRAIGHT, TILTED

import treadload as tl
from treadload.contact.bodies import Body, HalfSpaces, Influence, Offsets, Sum, Waves, surface_of
from treadload.contact.bodies.ahead import Ahead
from treadload.contact.bodies.anisotropic import AnisotropicHalfSpace
from treadload.contact.bodies.layers import layered_road
from treadload.contact.solvers.normal import solve_normal
from treadload.kernels.anisotropy.stiffness import rotated
from treadload.kernels.anisotropy.symbol import surface_symbol
from treadload.kernels.complementarity.coulomb import four
from treadload.kernels.layers.layered import Stack

STEEL, RUBBER = tl.Elastic(210e9, 0.3), tl.Elastic(3e9, 0.4)
SHAPE, DX, DY = (5, 6), 0.01, 0.013
AT = Offsets(5, 8, 0.01, 0.02, 0.003)
EQUAL = tl.materials.Orthotropic([2.3e9] * 3, [2.3e9 / 2.6] * 3, [0.3] * 3)


def pair(tire, road):
    return Sum.of(surface_of(tire, is_tire=True), surface_of(road, is_tire=False))


PAIRS = {
    "road": pair(RUBBER, TILTED),
    "tire": pair(TILTED, RUBBER),
    "both": pair(TILTED, TILTED),
    "turned": pair(RUBBER, STRAIGHT.rotated(yaw=0.5)),
    "layers": Sum.of(
        surface_of(TILTED, is_tire=True),
        layered_road(Stack([2.5e9, 1e8], [0.35, 0.3], [0.04, np.inf], [1e9])),
    ),
}


def dense(body, shape=SHAPE):
    """Matrix from (q_x, q_y, p) to (u_x, u_y, u_n) over all pairs of cells, by kernels at each offset."""
    (ny, nx), n = shape, shape[0] * shape[1]
    at = Offsets(2 * ny - 1, 2 * nx - 1, DX, DY, -(nx - 1) * DX, -(ny - 1) * DY)
    normal, (xx, yy, xy) = body.normal(at), body.tangential(at)
    (k_x, k_y), (a, e_x, e_y) = body.coupling(at), body.tilted(at)
    blocks = [[xx, xy + a, e_x - k_x], [xy - a, yy, e_y - k_y], [k_x + e_x, k_y + e_y, normal]]
    j, i = np.divmod(np.arange(n), nx)
    rows, columns = j[:, None] - j[None, :] + ny - 1, i[:, None] - i[None, :] + nx - 1
    return np.block([[kernel[rows, columns] for kernel in line] for line in blocks])


@pytest.mark.parametrize("body", PAIRS.values(), ids=PAIRS)
def test_operators_are_sums_over_pairs_of_cells_and_reciprocal(body):
    assert not body.mirrored
    assert body.symmetric
    influence, matrix = Influence(SHAPE, DX, DY, body), dense(body)
    # Images of layers are closed forms that cancel against each other.
    largest, tolerance = np.abs(matrix).max(), 1e-10 if body is PAIRS["layers"] else 1e-12
    # Loads work on each other's displacements alike, and never give work.
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=tolerance * largest)
    assert np.linalg.eigvalsh(matrix).min() > 0
    rng = np.random.default_rng(1)
    load = rng.normal(size=(3, *SHAPE))
    expected = (matrix @ load.ravel()).reshape(3, *SHAPE)
    size = tolerance * np.abs(expected).max()
    shear, pressure = load[:2], load[2]
    np.testing.assert_allclose(influence.displacement(pressure, shear), expected, rtol=0, atol=size)
    apart = influence.normal(pressure) + influence.gap_by_shear(shear)
    np.testing.assert_allclose(apart, expected[2], rtol=0, atol=size)
    here = Ahead(influence, 0.0)
    np.testing.assert_allclose(here(shear, pressure), expected[:2], rtol=0, atol=size)
    np.testing.assert_allclose(here.gap(shear) + influence.normal(pressure), expected[2], rtol=0, atol=size)
    single = influence.normal_on(SHAPE, np.float32)(pressure.astype(np.float32))
    np.testing.assert_allclose(single, influence.normal(pressure), rtol=0, atol=1e-5 * np.abs(single).max())


@pytest.mark.parametrize("cells", [1, 3])
def test_ahead_by_whole_cells_and_the_step_of_rolling(cells):
    rng = np.random.default_rng(2)
    shear, pressure = np.zeros((2, 5, 12)), np.zeros((5, 12))
    shear[..., :6], pressure[:, :6] = rng.normal(size=(2, 5, 6)), rng.random((5, 6))
    wide = Influence((5, 12), DX, DY, PAIRS["road"]).displacement(pressure, shear)[:2]
    small = Influence((5, 6), DX, DY, PAIRS["road"])
    found = Ahead(small, cells * DX)(shear[..., :6], pressure[:, :6])
    np.testing.assert_allclose(found, wide[..., cells : cells + 6], rtol=0, atol=1e-12 * np.abs(wide).max())
    padding = small.rolling_padding
    xx, yy, xy, yx = four(small.tangential(padding))
    x, y = padding.forward(shear[..., :6])
    u = padding.inverse(np.array([xx * x + xy * y, yx * x + yy * y]))
    step = u[..., :-1] - u[..., 1:] + small.slip_by_pressure(pressure[:, :6])
    np.testing.assert_allclose(step, wide[..., :6] - wide[..., 1:7], rtol=0, atol=1e-12 * np.abs(wide).max())


def test_an_isotropic_one_is_the_half_space():
    for is_tire in (True, False):
        found = AnisotropicHalfSpace.of(EQUAL.stiffness, is_tire=is_tire)
        same = HalfSpaces.of(*((STEEL, None) if is_tire else (None, STEEL)))
        scale = 210 / 2.3
        assert found.mirrored
        for name in ("normal", "tangential", "coupling"):
            one, other = getattr(found, name)(AT), getattr(same, name)(AT) * scale
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-14 * same.normal(AT).max() * scale)
        waves = Waves((6, 8), 0.01, 0.02)
        one, other = found.compliance(waves), same.compliance(waves) * scale
        np.testing.assert_allclose(one[:, 1:], other[:, 1:], rtol=0, atol=1e-13 * np.abs(other).max())
        np.testing.assert_allclose(found.across(waves.along[0]), scale * same.across(waves.along[0]), rtol=1e-12)
    # Along its own axes a material keeps the parities, and the plans of the transforms with them.
    assert surface_of(STRAIGHT, is_tire=False).mirrored
    assert surface_of(STRAIGHT.rotated(yaw=np.pi / 2), is_tire=False).mirrored
    assert not surface_of(STRAIGHT.rotated(pitch=0.01), is_tire=False).mirrored
    # Coupling over normal compliance, in the direction where it is largest, is that of the symbol.
    values = surface_symbol(TILTED.stiffness)(np.pi / 480 * np.arange(480))
    size = np.linalg.norm(values[:, :2, 2], axis=1) / values[:, 2, 2].real
    rigid = Influence(SHAPE, DX, DY, pair(tl.Elastic(1e20, 0.3), TILTED))
    assert rigid.dundurs == pytest.approx(size.max(), rel=2e-3)
    turned = STRAIGHT.rotated(yaw=0.5)
    assert Influence(SHAPE, DX, DY, pair(turned, turned)).dundurs == 0
    # Tires and roads of half-spaces that differ couple as such, whatever stands for them.
    one = AnisotropicHalfSpace.of(EQUAL.stiffness, is_tire=True).towards(np.ones(2), 0.4)
    other = HalfSpaces.of(tl.Elastic(2.3e9, 0.3), None).towards(np.ones(2), 0.4)
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-13 * np.abs(other).max())
    like = Influence(SHAPE, DX, DY, pair(STRAIGHT, STRAIGHT))
    assert like.dundurs == pytest.approx(0, abs=1e-15)


def test_a_tire_is_the_road_upside_down():
    """Turned by 180° about x the tire becomes the road: y and z change sign, and who moves whom."""
    over = rotated(TILTED.stiffness, np.diag([1.0, -1.0, -1.0]))
    tire = AnisotropicHalfSpace.of(TILTED.stiffness, is_tire=True)
    road = AnisotropicHalfSpace.of(over, is_tire=False)
    up, down = Offsets(7, 8, 0.01, 0.02, -0.03, -0.06), slice(None, None, -1)
    size = 1e-14 * tire.normal(up).max()
    turned = {name: getattr(road, name)(up)[..., down, :] for name in ("normal", "tangential", "coupling", "tilted")}
    np.testing.assert_allclose(turned["normal"], tire.normal(up), rtol=0, atol=size)
    signs = np.array([1, 1, -1])[:, None, None]
    np.testing.assert_allclose(turned["tangential"] * signs, tire.tangential(up), rtol=0, atol=size)
    np.testing.assert_allclose(turned["coupling"] * [[[-1]], [[1]]], tire.coupling(up), rtol=0, atol=size)
    np.testing.assert_allclose(turned["tilted"] * [[[-1]], [[-1]], [[1]]], tire.tilted(up), rtol=0, atol=size)


@dataclass(frozen=True)
class Springs(Body):
    """Side by side, Pa/m: a body of somebody else's, written before there was a grain."""

    stiffness: float

    def normal(self, at):
        assert at.first_y == 0
        return np.outer(np.abs(at.y) < at.dy / 2, np.abs(at.x) < at.dx / 2) / self.stiffness

    def tangential(self, at):
        own = self.normal(at)
        return np.array([own, own, 0 * own])

    def coupling(self, at):
        return np.zeros((2, at.ny, at.nx))

    def compliance(self, waves):
        return np.array([waves.k / self.stiffness] * 3 + [0 * waves.k])

    def across(self, k):
        return np.array([k / self.stiffness, 0 * k])


def test_a_body_that_knows_no_grain_meets_one():
    """It is asked for y ≥ 0 alone, and adds its own cell."""
    road = surface_of(TILTED, is_tire=False)
    both, alone = Sum.of(Springs(4e12), road), dense(road)
    assert not both.mirrored
    found = dense(both) - alone
    np.testing.assert_allclose(found, np.eye(len(alone)) / 4e12, rtol=0, atol=1e-13 * np.abs(alone).max())
    load = np.random.default_rng(5).normal(size=(3, *SHAPE))
    moved = Influence(SHAPE, DX, DY, both).displacement(load[2], load[:2])
    expected = ((alone + np.eye(len(alone)) / 4e12) @ load.ravel()).reshape(3, *SHAPE)
    np.testing.assert_allclose(moved, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_both_ways_through_the_transforms_agree():
    """A straight grain by parities, and the same as if it had none."""
    folded = AnisotropicHalfSpace.of(STRAIGHT.stiffness, is_tire=False)
    whole = AnisotropicHalfSpace.of(STRAIGHT.stiffness, is_tire=False)
    whole.__dict__["mirrored"] = False
    load = np.random.default_rng(6).normal(size=(3, *SHAPE))
    one, other = (Influence(SHAPE, DX, DY, body) for body in (folded, whole))
    expected = one.displacement(load[2], load[:2])
    size = 1e-12 * np.abs(expected).max()
    np.testing.assert_allclose(other.displacement(load[2], load[:2]), expected, rtol=0, atol=size)
    for ahead in (0.004, DX):
        near, full = Ahead(one, ahead), Ahead(other, ahead)
        np.testing.assert_allclose(full(load[:2], load[2]), near(load[:2], load[2]), rtol=0, atol=size)
        np.testing.assert_allclose(full.gap(load[:2]), near.gap(load[:2]), rtol=0, atol=size)
    gap = np.add.outer(np.linspace(-1, 1, 40) ** 2, np.linspace(-1, 1, 36) ** 2) * 1e-3
    pressed, again = (
        solve_normal(Influence(gap.shape, DX, DY, body), gap, load=1e5, tolerance=1e-10).pressure
        for body in (folded, whole)
    )
    np.testing.assert_allclose(again, pressed, rtol=0, atol=1e-7 * pressed.max())
