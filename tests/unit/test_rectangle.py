"""Influence coefficients of a loaded rectangle against quadrature of the point-load solutions."""

import numpy as np
import pytest

from treadload.kernels.half_space import rectangle
from treadload.kernels.half_space.rectangle import CombinedElasticity

DX, DY = 0.7, 1.3
BODIES = CombinedElasticity(2.0, 0.3, 0.07)
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(60)


def over_the_cell(f, x, y):
    """∫ f(x - s, y - t) ds dt over the cell |s| < dx/2, |t| < dy/2, split at a singular point inside."""
    total = 0.0
    for s0, s1 in zip((-DX / 2, 0.0), (0.0, DX / 2), strict=True):
        for t0, t1 in zip((-DY / 2, 0.0), (0.0, DY / 2), strict=True):
            s, t = s0 + (s1 - s0) * (POINTS + 1) / 2, t0 + (t1 - t0) * (POINTS + 1) / 2
            values = f(x - s[None, :], y - t[:, None])
            total += (s1 - s0) * (t1 - t0) / 4 * (values * WEIGHTS[:, None] * WEIGHTS).sum()
    return total


def table(f, ny=3, nx=4):
    return np.array([[over_the_cell(f, i * DX, j * DY) for i in range(nx)] for j in range(ny)])


def away(values):
    """All but the cell itself, where quadrature of a singular kernel is poor."""
    return values.ravel()[1:]


def test_normal_displacement_by_pressure():
    scale = (1 - BODIES.poisson) / (np.pi * BODIES.shear_modulus)
    expected = table(lambda x, y: scale / np.hypot(x, y))
    # 60 Gauss points a half side, half a cell off the singular point: 1e-9.
    np.testing.assert_allclose(away(rectangle.normal_by_pressure(3, 4, DX, DY, BODIES)), away(expected), rtol=1e-9)


def test_tangential_displacement_by_shear():
    nu, scale = BODIES.poisson, 1 / (np.pi * BODIES.shear_modulus)
    found = rectangle.tangential_by_shear(3, 4, DX, DY, BODIES)

    def u_xx(x, y):
        r = np.hypot(x, y)
        return scale * ((1 - nu) / r + nu * x**2 / r**3)

    expected = (table(u_xx), table(lambda x, y: np.vectorize(u_xx)(y, x)))
    for one, other in zip(found[:2], expected, strict=True):
        np.testing.assert_allclose(away(one), away(other), rtol=1e-8)
    cross = table(lambda x, y: scale * nu * x * y / np.hypot(x, y) ** 3)
    np.testing.assert_allclose(away(found[2]), away(cross), atol=1e-8 * cross.max())
    assert found[2][0, 0] == 0.0


def test_coupling():
    scale = BODIES.difference / (np.pi * BODIES.shear_modulus)
    k_x, k_y = rectangle.coupling(3, 4, DX, DY, BODIES)
    along = table(lambda x, y: scale * x / (x**2 + y**2))
    across = table(lambda x, y: scale * y / (x**2 + y**2))
    np.testing.assert_allclose(away(k_x), away(along), atol=1e-9 * np.abs(along).max())
    np.testing.assert_allclose(away(k_y), away(across), atol=1e-9 * np.abs(across).max())


@pytest.mark.parametrize("first", [0.3 * DX, -2.5 * DX, -1.5 * DX, 3 * DX])
@pytest.mark.parametrize("kernel", [rectangle.normal_by_pressure, rectangle.tangential_by_shear, rectangle.coupling])
def test_ahead_of_the_cell_the_forms_are_the_same(kernel, first):
    """At any distance ahead, corners on x = 0 among them: a cell is the sum of its tenths, and so is what it does."""
    found = kernel(2, 4, DX, DY, BODIES, first)
    assert np.isfinite(found).all()
    tenths = kernel(2, 40, DX / 10, DY, BODIES, first - 0.45 * DX)
    sums = np.stack([tenths[..., 10 * i : 10 * i + 10].sum(-1) for i in range(4)], -1)
    # Round-off of the functions of the corners, ten times those of the sum.
    np.testing.assert_allclose(found, sums, rtol=0, atol=1e-13 * np.abs(found).max())


@pytest.mark.parametrize("kernel", [rectangle.normal_by_pressure, rectangle.tangential_by_shear, rectangle.coupling])
def test_whole_cells_ahead_are_the_lattice_itself_and_behind_is_its_mirror(kernel):
    lattice = kernel(2, 6, DX, DY, BODIES)
    # Round-off of where the corners stand.
    np.testing.assert_allclose(kernel(2, 3, DX, DY, BODIES, 3 * DX), lattice[..., 3:], rtol=1e-13, atol=1e-16)
    parity = {"normal_by_pressure": 1, "tangential_by_shear": [[[1]], [[1]], [[-1]]], "coupling": [[[-1]], [[1]]]}
    behind = kernel(2, 6, DX, DY, BODIES, -5 * DX)[..., ::-1]
    np.testing.assert_allclose(np.multiply(behind, parity[kernel.__name__]), lattice, rtol=1e-13, atol=1e-16)


def test_the_cell_on_itself_has_its_closed_form():
    # Love (1929): the middle of a unit square sinks by 4 ln(1 + √2) (1 - ν)/(πG).
    bodies = CombinedElasticity(1.0, 0.28, 0.0)
    found = rectangle.normal_by_pressure(1, 1, 1.0, 1.0, bodies)[0, 0]
    assert found == pytest.approx(0.72 / np.pi * 4 * np.log(1 + np.sqrt(2)), rel=1e-14)
    # The value that CONTACT prints.
    assert found == pytest.approx(0.807984, abs=5e-7)
    xx, yy, xy = rectangle.tangential_by_shear(1, 1, 1.0, 1.0, bodies)
    # Half (1 - ν) and half 1: a square is the same along x and y.
    assert xx[0, 0] == pytest.approx((1.72 / 2) / 0.72 * found, rel=1e-13)
    assert yy[0, 0] == pytest.approx(xx[0, 0], rel=1e-14)
    assert xy[0, 0] == 0.0


def test_a_cell_is_the_sum_of_its_parts():
    coarse = rectangle.normal_by_pressure(1, 3, 3.0, 3.0, BODIES)[0, 2]
    # The same cell, 6 m away, as 3 x 3 cells of 1 m.
    fine = rectangle.normal_by_pressure(2, 9, 1.0, 1.0, BODIES)
    parts = sum(fine[abs(j), 6 + i] for j in (-1, 0, 1) for i in (-1, 0, 1))
    assert parts == pytest.approx(coarse, rel=1e-13)


def test_far_away_a_cell_is_a_point_load():
    bodies = CombinedElasticity(1.0, 0.4, 0.0)
    found = rectangle.normal_by_pressure(1, 2001, 1.0, 1.0, bodies)[0, 2000]
    # The next term of the expansion is (1/24)/2000².
    assert found == pytest.approx(0.6 / np.pi / 2000, rel=1e-7)


def test_combined_elasticity():
    same = CombinedElasticity.of(3.0, 0.3, 3.0, 0.3)
    assert (same.shear_modulus, same.poisson, same.difference) == pytest.approx((3.0, 0.3, 0.0))
    assert same.contact_modulus == pytest.approx(3.0 / 0.7)
    one, other = CombinedElasticity.of(1.0, 0.2, 5.0, 0.4), CombinedElasticity.of(5.0, 0.4, 1.0, 0.2)
    assert one.difference == pytest.approx(-other.difference)
    assert one.contact_modulus == pytest.approx(other.contact_modulus)
    # 1/E* = (1 - ν1²)/E1 + (1 - ν2²)/E2 with E = 2G(1 + ν).
    assert 1 / one.contact_modulus == pytest.approx((1 - 0.2) / (2 * 1.0) + (1 - 0.4) / (2 * 5.0))
    # Dundurs' β = K/(1-ν): an incompressible body on a rigid one is decoupled, ν = 0 has the largest β.
    rigid, soft = (CombinedElasticity.of(1.0, poisson, float("inf"), 0.3) for poisson in (0.0, 0.5))
    assert rigid.difference / (1 - rigid.poisson) == pytest.approx(0.5)
    assert soft.difference / (1 - soft.poisson) == pytest.approx(0.0)
