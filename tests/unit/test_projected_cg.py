"""The bound-constrained solver against a dense active-set solution."""

import numpy as np
import pytest
from scipy.optimize import nnls

from treadload.kernels.complementarity import projected_cg

RNG_SEEDS = range(6)


def problem(seed, n=40):
    """A dense compliance like that of a contact: positive, symmetric, decaying; and a rough gap."""
    rng = np.random.default_rng(seed)
    x = np.sort(rng.random(n)) * 10
    a = 1 / (0.3 + np.abs(x[:, None] - x[None, :]))
    a = a @ a.T / n + 0.2 * np.eye(n)
    gap = 0.05 * (x - 5) ** 2 + 0.3 * rng.random(n)
    return a, gap.reshape(5, -1)


def product(a):
    return lambda p: (a @ p.ravel()).reshape(p.shape)


def dense(a, gap, level):
    """min ½ p·A p + p·(h - level), p ≥ 0, by Lawson and Hanson on A = L Lᵀ."""
    lower = np.linalg.cholesky(a)
    p, _ = nnls(lower.T, np.linalg.solve(lower, level - gap.ravel()))
    return p.reshape(gap.shape)


@pytest.mark.parametrize("seed", RNG_SEEDS)
def test_prescribed_approach_equals_the_dense_solution(seed):
    a, gap = problem(seed)
    level = 1.0
    found = projected_cg.solve(
        product(a), gap, np.ones_like(gap), level=level, precondition=lambda r: r, tolerance=1e-10
    )
    assert found.converged
    exact = dense(a, gap, level)
    assert (exact > 0).any()
    assert (exact == 0).any()
    # Conditioning of A is near 1e3: 1e-10 on the gap is 1e-7 on the pressure.
    np.testing.assert_allclose(found.pressure, exact, atol=1e-7 * exact.max())


@pytest.mark.parametrize("seed", RNG_SEEDS)
def test_prescribed_total_finds_the_approach_that_carries_it(seed):
    a, gap = problem(seed)
    exact = dense(a, gap, 0.9)
    found = projected_cg.solve(
        product(a), gap, np.ones_like(gap), total=exact.sum(), precondition=lambda r: r, tolerance=1e-10
    )
    assert found.converged
    assert found.level == pytest.approx(0.9, rel=1e-8)
    assert found.pressure.sum() == pytest.approx(exact.sum(), rel=1e-12)
    np.testing.assert_allclose(found.pressure, exact, atol=1e-7 * exact.max())


def test_the_start_does_not_change_the_answer():
    a, gap = problem(1)
    rng = np.random.default_rng(11)
    answers = [
        projected_cg.solve(product(a), gap, start, total=3.0, precondition=lambda r: r, tolerance=1e-10).pressure
        for start in (np.ones_like(gap), np.zeros_like(gap), rng.random(gap.shape), np.eye(5, 8))
    ]
    for other in answers[1:]:
        np.testing.assert_allclose(other, answers[0], atol=1e-7 * answers[0].max())


def test_a_preconditioner_changes_the_count_and_not_the_answer():
    a, gap = problem(2)
    inverse = np.linalg.inv(a)
    kwargs = {"total": 3.0, "tolerance": 1e-10}
    plain = projected_cg.solve(product(a), gap, np.ones_like(gap), precondition=lambda r: r, **kwargs)
    better = projected_cg.solve(product(a), gap, np.ones_like(gap), precondition=product(inverse), **kwargs)
    assert better.iterations < plain.iterations
    np.testing.assert_allclose(better.pressure, plain.pressure, atol=1e-7 * plain.pressure.max())


def test_cells_without_material_carry_nothing():
    a, gap = problem(3)
    gap[1, 2:5] = np.nan
    found = projected_cg.solve(
        product(a), gap, np.ones_like(gap), total=3.0, precondition=lambda r: r, tolerance=1e-10
    )
    assert found.converged
    assert (found.pressure[1, 2:5] == 0).all()


def test_one_cell_takes_the_whole_load():
    found = projected_cg.solve(
        lambda p: 2.0 * p, np.array([[0.1]]), np.zeros((1, 1)), total=5.0, precondition=lambda r: r
    )
    assert found.pressure[0, 0] == 5.0
    assert found.level == pytest.approx(0.1 + 10.0)
    assert found.converged


def test_an_approach_that_touches_nothing_gives_no_pressure():
    a, gap = problem(4)
    found = projected_cg.solve(
        product(a), gap, np.ones_like(gap), level=float(gap.min()) - 0.1, precondition=lambda r: r
    )
    assert not found.pressure.any()


def test_it_says_when_it_stops_short():
    a, gap = problem(5)
    found = projected_cg.solve(
        product(a), gap, np.ones_like(gap), total=3.0, precondition=lambda r: r, tolerance=1e-12, max_iterations=2
    )
    assert not found.converged
    assert found.iterations == 2
    assert found.residual > 1e-12


@pytest.mark.parametrize("given", [{}, {"total": 1.0, "level": 1.0}])
def test_either_total_or_level(given):
    with pytest.raises(ValueError, match="either total or level"):
        projected_cg.solve(lambda p: p, np.zeros((2, 2)), np.ones((2, 2)), precondition=lambda r: r, **given)
