"""Influence operators against sums over all pairs of cells, and their signs."""

import numpy as np
import pytest

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence, forget_operators, operators
from treadload.kernels.gridding.convolution import Convolution
from treadload.kernels.half_space import rectangle
from treadload.kernels.half_space.rectangle import CombinedElasticity

BODIES = CombinedElasticity(2.0, 0.3, 0.07)
SHAPE, DX, DY = (4, 6), 0.7, 1.3
INFLUENCE = Influence(SHAPE, DX, DY, HalfSpaces(BODIES))


def matrix(quadrant, parity_x=1, parity_y=1, shift=0):
    """Dense matrix (field cell, load cell) of a kernel given at offsets 0, 1, 2, … both ways."""
    ny, nx = SHAPE
    j, i = np.divmod(np.arange(ny * nx), nx)
    di, dj = i[:, None] - i[None, :] + shift, j[:, None] - j[None, :]
    sign = np.where(di < 0, parity_x, 1) * np.where(dj < 0, parity_y, 1)
    return sign * quadrant[np.abs(dj), np.abs(di)]


def shears():
    return np.random.default_rng(6).normal(size=(2, *SHAPE))


def tangential(shift):
    xx, yy, xy = rectangle.tangential_by_shear(SHAPE[0], SHAPE[1] + 1, DX, DY, BODIES)
    cross = matrix(xy, -1, -1, shift)
    return np.block([[matrix(xx, shift=shift), cross], [cross, matrix(yy, shift=shift)]])


def coupling(shift):
    k_x, k_y = rectangle.coupling(SHAPE[0], SHAPE[1] + 1, DX, DY, BODIES)
    return matrix(k_x, -1, 1, shift), matrix(k_y, 1, -1, shift)


def displacement(padding, q):
    xx, yy, xy = INFLUENCE.tangential(padding)
    x, y = padding.forward(q)
    return padding.inverse(np.array([xx * x + xy * y, xy * x + yy * y]))


def test_normal():
    p = np.random.default_rng(7).random(SHAPE)
    dense = matrix(rectangle.normal_by_pressure(*SHAPE, DX, DY, BODIES))
    np.testing.assert_allclose(INFLUENCE.normal(p).ravel(), dense @ p.ravel(), rtol=1e-12)
    assert isinstance(INFLUENCE.normal, Convolution)


def test_tangential_and_rolling():
    q = shears()
    here, ahead = tangential(0) @ q.ravel(), tangential(1) @ q.ravel()
    u = displacement(INFLUENCE.padding, q)
    np.testing.assert_allclose(u.ravel(), here, atol=1e-12 * np.abs(here).max())
    # u(x) - u(x + dx): the point that enters the cell next was one cell ahead.
    u = displacement(INFLUENCE.rolling_padding, q)
    slip = (u[..., :-1] - u[..., 1:]).ravel()
    np.testing.assert_allclose(slip, here - ahead, atol=1e-12 * np.abs(here).max())
    assert INFLUENCE.self_influence(rolls=False) == pytest.approx(tangential(0)[0, 0])
    assert INFLUENCE.self_influence(rolls=True) == pytest.approx((tangential(0) - tangential(1))[0, 0])


def test_the_rolling_operator_is_monotone():
    dense = tangential(0) - tangential(1)
    assert np.linalg.eigvalsh(dense + dense.T).min() > 0


def test_the_shift_operator_is_symmetric_and_positive():
    dense = tangential(0)
    np.testing.assert_allclose(dense, dense.T, atol=1e-15)
    assert np.linalg.eigvalsh(dense).min() > 0


def test_coupling_by_shear_and_by_pressure():
    q, p = shears(), np.random.default_rng(8).random(SHAPE)
    k_x, k_y = coupling(0)
    opening = k_x @ q[0].ravel() + k_y @ q[1].ravel()
    np.testing.assert_allclose(INFLUENCE.gap_by_shear(q).ravel(), opening, atol=1e-13)
    ahead = coupling(1)
    slip = np.stack([-(k_x - ahead[0]) @ p.ravel(), -(k_y - ahead[1]) @ p.ravel()])
    np.testing.assert_allclose(INFLUENCE.slip_by_pressure(p).reshape(2, -1), slip, atol=1e-13)


def test_the_work_of_pressure_and_shear_on_each_other_is_equal():
    # Betti: q · u_t(p) = p · u_n(q), with u_t = -k ∗ p turned round by the odd kernel.
    q, p = shears(), np.random.default_rng(9).random(SHAPE)
    u = INFLUENCE.displacement(p, np.zeros_like(q))
    assert np.vdot(q, u[:2]) == pytest.approx(np.vdot(p, INFLUENCE.gap_by_shear(q)), rel=1e-10)


def test_displacement_is_the_sum_of_its_parts():
    q, p = shears(), np.random.default_rng(10).random(SHAPE)
    both = INFLUENCE.displacement(p, q)
    apart = INFLUENCE.displacement(p, 0 * q) + INFLUENCE.displacement(0 * p, q)
    np.testing.assert_allclose(both, apart, atol=1e-13)
    np.testing.assert_allclose(both[2], INFLUENCE.normal(p) + INFLUENCE.gap_by_shear(q), atol=1e-13)


def test_the_stiffness_symbol_inverts_the_compliance_of_a_wave():
    # A sinusoidal pressure of wave length 2π/k sinks by 2p/(E* k): Johnson (1985), section 13.2.
    n, dx = 64, 0.5
    symbol = Influence((n, n), dx, dx, HalfSpaces(CombinedElasticity(3.0 * 0.7, 0.3, 0.0))).normal_stiffness
    k = 2 * np.pi * 5 / (n * dx)
    assert symbol[0, 5] == pytest.approx(k * 3.0 / 2)
    assert symbol.min() > 0


def test_operators_on_few_cells_are_computed_once(monkeypatch):
    forget_operators()
    asked = []
    monkeypatch.setattr(rectangle, "coupling", lambda *at: asked.append(at) or np.ones((2, *at[:2])))
    pair = HalfSpaces(BODIES)
    for _ in range(2):
        both = operators(SHAPE, DX, DY, pair)
        both.gap_by_shear(shears())
        both.slip_by_pressure(shears()[0])
        both.gap_by_shear(shears())
    # Once in either padded space.
    assert len(asked) == 2
    # Rows of another place are the same to bodies without strips; one padded space serves several boxes.
    assert operators(SHAPE, DX, DY, pair, 0.1) is operators(SHAPE, DX, DY, pair, 0.2) is both
    Influence(SHAPE, DX, DY, pair).gap_by_shear(shears())
    assert len(asked) == 2
    assert operators(SHAPE, DX, 2 * DY, pair) is not both
    assert operators(SHAPE, DX, DY, HalfSpaces(CombinedElasticity(2.0, 0.3, 0.08))) is not both
    assert operators((500, 600), DX, DY, pair) is not operators((500, 600), DX, DY, pair)
    forget_operators()
    assert operators(SHAPE, DX, DY, pair) is not both
    forget_operators()


def test_a_body_that_cannot_be_told_from_others_has_operators_of_its_own():
    class Unhashable(HalfSpaces):
        __hash__ = None

    pair = Unhashable(BODIES)
    assert Influence(SHAPE, DX, DY, pair).gap_by_shear(shears()).any()
    assert operators(SHAPE, DX, DY, pair) is not operators(SHAPE, DX, DY, pair)
