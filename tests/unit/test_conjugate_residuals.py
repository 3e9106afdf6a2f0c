"""Conjugate residuals beside SciPy's GMRES and dense solves; what they do where the residual stays."""

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, gmres

from treadload.kernels.complementarity import conjugate_residuals

N, OTHERS = 40, 7
RNG = np.random.default_rng(5)
DENSE = np.eye(N) + 0.5 * RNG.normal(size=(N, N)) / np.sqrt(N)
NEARLY = np.linalg.inv(DENSE + 0.1 * RNG.normal(size=(N, N)) / np.sqrt(N))
OTHER = RNG.normal(size=(OTHERS, N))
RHS = RNG.normal(size=N)


def solve(dense, precondition=None, *, rhs=RHS, other=OTHER, rtol=1e-6, most=N):
    """Solution, L x and the number of products."""
    a, l, products = dense.astype(np.float32), other.astype(np.float32), []

    def product(z):
        products.append(z)
        return a @ z, l @ z

    def inverse(v):
        return v.copy() if precondition is None else precondition.astype(np.float32) @ v

    given = rhs.astype(np.float32)
    kept = given.copy()
    x, lx = conjugate_residuals.solve(given, product, inverse, size=len(other), rtol=rtol, most=most)
    np.testing.assert_array_equal(given, kept)
    return x, lx, len(products)


@pytest.mark.parametrize("precondition", [None, NEARLY])
def test_a_dense_system(precondition):
    x, lx, products = solve(DENSE, precondition)
    # A condition of 5 times the digits of single precision.
    np.testing.assert_allclose(x, np.linalg.solve(DENSE, RHS), atol=2e-5)
    np.testing.assert_allclose(lx, OTHER @ x, atol=2e-5)
    assert x.dtype == lx.dtype == np.float32
    assert products < (25 if precondition is None else 12)


@pytest.mark.parametrize("most", [1, 3, 6])
def test_the_residual_is_that_of_gmres(most):
    x, _, products = solve(DENSE, NEARLY, rtol=0.0, most=most)
    right = LinearOperator((N, N), matvec=lambda v: DENSE @ (NEARLY @ v), dtype=float)
    best = NEARLY @ gmres(right, RHS, rtol=0.0, restart=most, maxiter=1)[0]
    assert products == most
    mine, least = (np.linalg.norm(RHS - DENSE @ one) for one in (x, best))
    assert mine == pytest.approx(least, rel=1e-3, abs=1e-6)


def test_it_stops_where_asked():
    for rtol in (0.5, 1e-1, 1e-2, 1e-4):
        x, _, products = solve(DENSE, NEARLY, rtol=rtol)
        assert np.linalg.norm(RHS - DENSE @ x) <= 1.001 * rtol * np.linalg.norm(RHS)
        before, _, _ = solve(DENSE, NEARLY, rtol=rtol, most=products - 1)
        assert np.linalg.norm(RHS - DENSE @ before) > rtol * np.linalg.norm(RHS)


def test_a_residual_that_stays_until_the_last_direction():
    # Of a shift of all numbers by one no combination of fewer than all images is nearer to the right side than none.
    shift = np.roll(np.eye(12), 1, axis=0)
    first = np.eye(12)[0]
    x, _, products = solve(shift, rhs=first, other=np.eye(12), most=12)
    np.testing.assert_allclose(x, np.linalg.solve(shift, first), atol=1e-6)
    assert products == 12


def test_a_singular_system_ends():
    # Only what the images reach is made good.
    half = np.diag(np.r_[np.ones(N // 2), np.zeros(N - N // 2)])
    x, _, products = solve(half)
    np.testing.assert_allclose(x[: N // 2], RHS[: N // 2], rtol=1e-5)
    assert products <= 3
    assert np.isfinite(x).all()


@pytest.mark.parametrize("scale", [0.0, np.nan, np.inf])
def test_nothing_is_gained_where_products_are_none(scale):
    with np.errstate(invalid="ignore"):
        x, lx, _ = solve(scale * np.eye(N))
    assert not x.any()
    assert not lx.any()


def test_nothing_is_asked_of_no_right_side():
    x, lx, products = solve(DENSE, rhs=np.zeros(N))
    assert products == 0
    assert not x.any()
    assert not lx.any()
