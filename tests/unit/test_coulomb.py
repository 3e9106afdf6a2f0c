"""The tangential problem: two solvers against each other and against a dense variational inequality."""

from dataclasses import replace

import numpy as np
import pytest

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.kernels.complementarity import coulomb_newton
from treadload.kernels.complementarity.coulomb import CoulombProblem, project_disc
from treadload.kernels.complementarity.coulomb_splitting import split
from treadload.kernels.half_space.rectangle import CombinedElasticity

BODIES = CombinedElasticity(1.0, 0.3, 0.0)
SHAPE = (8, 10)


def dome(shape=SHAPE):
    y, x = np.meshgrid(np.linspace(-1.1, 1.1, shape[0]), np.linspace(-1.1, 1.1, shape[1]), indexing="ij")
    return np.sqrt(np.maximum(0, 1 - x**2 - y**2))


def problem(kind="rolling", rigid=(0.05, -0.03), totals=(None, None), bound=None):
    bound = dome() if bound is None else bound
    influence = Influence(bound.shape, 0.2, 0.25, HalfSpaces(BODIES))
    rolls = kind == "rolling"
    padding = influence.rolling_padding if rolls else influence.padding
    return CoulombProblem(
        padding=padding,
        compliance=influence.tangential(padding),
        rolls=rolls,
        self_influence=influence.self_influence(rolls=rolls),
        bound=bound,
        rigid=np.stack([np.full(bound.shape, w) for w in rigid]),
        travel=0.2,
        totals=totals,
        precondition=lambda slip, mask: slip,
    )


def solve_by_splitting(given):
    """Splitting alone, with the state of the point that it found."""
    q, xi, _ = split(given, np.zeros_like(given.rigid), np.zeros(2), tolerance=1e-9, max_iterations=50_000)
    # Its stop measures the change of shear; forces count a hundredfold in the residual.
    return coulomb_newton.solve(given, q, xi, tolerance=1e-7, max_iterations=0)


def check(found, given, tolerance=1e-6):
    """The conditions of the problem themselves, on the returned fields."""
    size, slip = np.hypot(*found.shear), np.hypot(*found.slip)
    scale = np.linalg.norm(given.bound)
    assert (size <= given.bound * (1 + 1e-9)).all()
    inside = given.bound > 0
    # Natural residual in the units of shear: slip over the self-influence.
    sticking = inside & found.stick
    assert np.linalg.norm(slip[sticking]) / given.self_influence <= 10 * tolerance * scale
    sliding = inside & ~found.stick
    opposed = found.slip * given.bound + found.shear * slip
    assert np.linalg.norm(opposed[:, sliding]) / given.self_influence <= 100 * tolerance * scale
    np.testing.assert_allclose(found.slip, given.slip(found.shear, found.xi), atol=1e-12)


@pytest.mark.parametrize("kind", ["rolling", "shift"])
@pytest.mark.parametrize("rigid", [(0.05, -0.03), (0.5, 0.2), (3.0, 0.0), (0.0, 1e-3)])
def test_newton_and_splitting_agree(kind, rigid):
    given = problem(kind, rigid)
    fast = coulomb_newton.solve(given, tolerance=1e-9)
    slow = solve_by_splitting(given)
    assert fast.converged
    assert slow.converged
    check(fast, given, 1e-9)
    # The shift has no lower bound on its operator but that of the grid: 1e-9 grows by its conditioning.
    np.testing.assert_allclose(fast.shear, slow.shear, atol=1e-6 * given.bound.max())


@pytest.mark.parametrize("totals", [(6.0, None), (None, -5.0), (6.0, -4.0), (0.0, 0.0)])
def test_newton_and_splitting_agree_under_forces(totals):
    given = problem(rigid=(0.02, 0.05), totals=totals)
    fast = coulomb_newton.solve(given, tolerance=1e-9)
    slow = solve_by_splitting(given)
    assert fast.converged
    assert slow.converged
    check(fast, given, 1e-9)
    np.testing.assert_allclose(fast.shear, slow.shear, atol=1e-6)
    np.testing.assert_allclose(fast.xi, slow.xi, atol=1e-6)
    for component, total in enumerate(totals):
        if total is not None:
            assert fast.shear[component].sum() == pytest.approx(total, abs=1e-8 * given.bound.sum())
        else:
            assert fast.xi[component] == 0.0


def test_a_dense_fixed_point_gives_the_same():
    """Projection steps q ← P(q - r S q - r w) with a dense S and a step short enough to contract."""
    given = problem(rigid=(0.08, 0.05))
    n = SHAPE[0] * SHAPE[1]
    unit = np.eye(2 * n).reshape(2 * n, 2, *SHAPE)
    dense = np.array([given.apply(e).ravel() for e in unit]).T
    symmetric = np.linalg.eigvalsh((dense + dense.T) / 2)
    # Strongly monotone with constant m and Lipschitz with L: the step m/L² contracts by √(1 - m²/L²).
    step = symmetric[0] / np.linalg.norm(dense, 2) ** 2
    q = np.zeros((2, *SHAPE))
    for _ in range(40_000):
        new = project_disc(q - step * ((dense @ q.ravel()).reshape(q.shape) + given.rigid), given.bound)
        if np.abs(new - q).max() < 1e-13:
            break
        q = new
    found = coulomb_newton.solve(given, tolerance=1e-10)
    np.testing.assert_allclose(found.shear, new, atol=1e-6)


def test_project_disc_is_the_nearest_point():
    rng = np.random.default_rng(12)
    q, bound = rng.normal(size=(2, 50)), rng.random(50)
    p = project_disc(q, bound)
    assert (np.hypot(*p) <= bound * (1 + 1e-15)).all()
    inside = np.hypot(*q) <= bound
    np.testing.assert_array_equal(p[:, inside], q[:, inside])
    angle = rng.random((200, 50)) * 2 * np.pi
    others = bound * rng.random((200, 50)) * np.stack([np.cos(angle), np.sin(angle)])
    assert (np.hypot(*(others - q[:, None])) >= np.hypot(*(p - q)) - 1e-12).all()


def test_no_rigid_slip_no_shear():
    found = coulomb_newton.solve(problem(rigid=(0.0, 0.0)))
    assert not found.shear.any()
    assert found.stick[dome() > 0].all()


def test_a_small_creepage_sticks_everywhere_and_solves_the_linear_problem():
    given = problem(rigid=(1e-3, 0.0), bound=np.where(dome() > 0, 10.0, 0.0))
    # What is left of the slip may be the tolerance times the bound, which is large here.
    found = coulomb_newton.solve(given, tolerance=1e-12)
    inside = given.bound > 0
    assert found.stick[inside].all()
    # S q + w = 0 on the contact.
    assert np.abs(found.slip[:, inside]).max() < 1e-7 * 1e-3


def test_a_large_creepage_slides_against_itself_everywhere():
    given = problem(rigid=(50.0, -20.0))
    found = coulomb_newton.solve(given)
    inside = given.bound > 0
    assert not found.stick[inside].any()
    direction = np.array([-50.0, 20.0]) / np.hypot(50, 20)
    # The elastic slip is at most S q ~ 1 beside a rigid slip of 54.
    np.testing.assert_allclose(
        found.shear[:, inside] / given.bound[inside], direction[:, None] * np.ones(inside.sum()), atol=0.05
    )


def test_no_contact_no_work():
    given = problem(bound=np.zeros(SHAPE))
    found = coulomb_newton.solve(given)
    assert found.converged
    assert not found.shear.any()
    assert solve_by_splitting(given).converged


def test_the_start_does_not_change_the_answer():
    given = problem(totals=(5.0, 2.0))
    rng = np.random.default_rng(13)
    one = coulomb_newton.solve(given, tolerance=1e-9)
    two = coulomb_newton.solve(given, rng.normal(size=(2, *SHAPE)), np.array([0.3, -0.2]), tolerance=1e-9)
    assert one.converged
    assert two.converged
    np.testing.assert_allclose(two.shear, one.shear, atol=1e-6)


@pytest.mark.filterwarnings("error")
def test_a_start_that_slides_everywhere_along_the_force():
    """No creepage changes the force there: Newton's step is singular, and splitting has to move on."""
    given = replace(problem(totals=(6.0, None)), rigid=np.zeros((2, *SHAPE)))
    start = np.stack([given.bound, 0 * given.bound])
    found = coulomb_newton.solve(given, start, np.array([-50.0, 0.0]), tolerance=1e-9)
    assert found.converged
    assert found.splitting > 0
    np.testing.assert_allclose(found.shear, coulomb_newton.solve(given, tolerance=1e-9).shear, atol=1e-6)


def test_it_says_when_it_stops_short():
    found = coulomb_newton.solve(problem(rigid=(0.5, 0.3)), tolerance=1e-12, max_iterations=1)
    assert not found.converged
    assert found.residual > 1e-12
    assert found.newton == 1


def test_mirrored_across_travel():
    given = problem(rigid=(0.05, -0.03))
    mirrored = replace(given, rigid=given.rigid * np.array([1, -1])[:, None, None])
    one, other = coulomb_newton.solve(given, tolerance=1e-9), coulomb_newton.solve(mirrored, tolerance=1e-9)
    np.testing.assert_allclose(other.shear[0], one.shear[0, ::-1], atol=1e-7)
    np.testing.assert_allclose(other.shear[1], -one.shear[1, ::-1], atol=1e-7)
