"""Coefficients with memory against quadrature, and block pivoting against dense solutions."""

import functools
import itertools

import numpy as np
import pytest
from scipy.integrate import quad

from treadload.kernels.complementarity import active_set
from treadload.kernels.half_space import rectangle
from treadload.kernels.half_space.memory import fading
from treadload.kernels.half_space.rectangle import CombinedElasticity

BODY = CombinedElasticity(1.0, 0.3, 0.2)


def kernels(first, ny, nx, dx, dy):
    both = rectangle.tangential_by_shear, rectangle.coupling
    return np.concatenate([kernel(ny, nx, dx, dy, BODY, first) for kernel in both])


@pytest.mark.filterwarnings("ignore::scipy.integrate.IntegrationWarning")
@pytest.mark.parametrize("aspect", [0.1, 1.0, 1e4])
@pytest.mark.parametrize("length", [0.01, 0.3, 7.0, 1e3])
def test_fading_against_quadrature(aspect, length):
    dx, dy, behind, ahead = 1.0, aspect, 9, 4
    found = fading(lambda first, count: kernels(first, 2, count, dx, dy), behind, ahead, dx, [length])
    assert found.shape == (1, 5, 2, behind + 1 + ahead)
    size = np.abs(kernels(-dx, 2, 3, dx, dy)).max((1, 2))
    for i in (-9, -1, 0, 2):
        known = {-(i + 0.5), -(i - 0.5), 0.1 * length, length, 5 * length, 3.0, 30.0, 300.0}
        stops = [0.0, *sorted(s for s in known if 0 < s < 40 * length), 40 * length]

        # The components are integrated at nearly the same places.
        @functools.cache
        def at(s, i=i):
            return np.exp(-s / length) / length * kernels(i + s, 2, 1, dx, dy)[:, :, 0]

        for component, row in ((0, 0), (1, 1), (2, 1), (3, 0), (4, 1)):

            def integrand(s, at=at, component=component, row=row):
                return at(s)[component, row]

            exact = sum(quad(integrand, a, b, epsabs=1e-12)[0] for a, b in itertools.pairwise(stops))
            # Seven digits of the coefficient are said; most have ten.
            near = 5e-8 * max(size[component], abs(exact))
            assert found[0, component, row, i + behind] == pytest.approx(exact, abs=near)


def test_no_memory_is_the_kernel_itself():
    sample = lambda first, count: kernels(first, 3, count, 1.0, 1.0)  # noqa: E731
    found = fading(sample, 4, 3, 1.0, [1e-12])[0]
    np.testing.assert_allclose(found, sample(-4.0, 8), atol=1e-7)


def problem(seed, n=60):
    """A positive definite, strongly skew compliance, and a rough gap."""
    rng = np.random.default_rng(seed)
    x = np.arange(n)
    a = 1 / (1 + np.abs(x[:, None] - x[None, :]))
    a = a @ a.T + 0.1 * np.eye(n)
    skew = rng.normal(size=(n, n)) * 0.2
    a = a + skew - skew.T
    return a, (0.005 * (x - n / 2) ** 2 + rng.random(n)).reshape(6, -1)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("by_load", [False, True])
def test_block_pivoting_meets_the_conditions(seed, by_load):
    a, gap = problem(seed)
    given = {"total": 3.0} if by_load else {"level": 1.5}
    found = active_set.solve(
        lambda p: (a @ p.ravel()).reshape(p.shape),
        gap,
        np.ones_like(gap),
        **given,
        precondition=lambda r: r,
        tolerance=1e-9,
    )
    assert found.converged
    separation = (a @ found.pressure.ravel()).reshape(gap.shape) + gap - found.level
    assert (found.pressure >= 0).all()
    scale = found.level - gap.min()
    assert np.abs(separation[found.pressure > 0]).max() <= 1e-9 * scale
    assert separation[found.pressure == 0].min() >= -1e-9 * scale
    if by_load:
        assert found.pressure.sum() == pytest.approx(3.0, rel=1e-12)


def test_block_pivoting_where_nothing_can_act_or_touch():
    a, gap = problem(1)
    gap[0] = np.nan
    product = lambda p: (a @ p.ravel()).reshape(p.shape)  # noqa: E731
    found = active_set.solve(product, gap, np.ones_like(gap), total=1.0, precondition=lambda r: r)
    assert found.converged
    assert not found.pressure[0].any()
    apart = active_set.solve(product, gap, np.zeros_like(gap), level=-1.0, precondition=lambda r: r)
    assert apart.converged
    assert not apart.pressure.any()
    with pytest.raises(ValueError, match="either"):
        active_set.solve(product, gap, gap, precondition=lambda r: r)
