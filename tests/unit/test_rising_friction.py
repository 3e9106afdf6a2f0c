"""Friction that rises with slip, as rubber's does at first: Coulomb's law in every cell, work, limits, doors."""

from dataclasses import dataclass

import numpy as np
import pytest

import treadload as tl
from fuzz.direct_sums import DirectSums
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.friction import Anisotropic, Coulomb
from treadload.contact.friction.laws import FrictionLaw, Interface
from treadload.contact.solvers.normal import solve_normal
from treadload.contact.solvers.rolling import rigid_slip
from treadload.contact.solvers.slipping import solve_slipping
from treadload.errors import ConvergenceError, InputError
from treadload.kernels.half_space.rectangle import CombinedElasticity

N, DX, SPEED, LOAD = 14, 3e-3, 10.0, 60.0
X = DX * (np.arange(N) - (N - 1) / 2)
BODIES = CombinedElasticity(1e6, 0.45, 0.0)
PATCH = Influence((N, N), DX, DX, HalfSpaces(BODIES))
PRESSURE = solve_normal(PATCH, (X[None, :] ** 2 + X[:, None] ** 2) / 0.2, load=LOAD).pressure
SUMS = DirectSums((N, N), DX, DX, 1e6, 0.45, 0.0)
BY_SHEAR = SUMS.displacement(0.0)[0] - SUMS.displacement(DX)[0]


@dataclass(frozen=True)
class Rubber(FrictionLaw):
    """μ from `rest` towards `most` within some slip speed, m/s; with a peak, back again beyond it."""

    rest: float
    most: float
    speed: float
    peaks: bool = False

    @property
    def needs_speed(self):
        return True

    @property
    def largest(self):
        return max(self.rest, self.most)

    def coefficient(self, at):
        v = at.slip_speed / self.speed
        return self.rest + (self.most - self.rest) * (2 * v / (1 + v * v) if self.peaks else 1 - np.exp(-v))


def roll(law, creepages=(0.0, 0.0), forces=(None, None), spin=0.0):
    at = Interface(PRESSURE, np.zeros((2, N, N)), X, X, DX, SPEED)
    rigid = rigid_slip(X, X, DX, creepages, spin)
    return solve_slipping(PATCH, law, at, rigid, forces), rigid


@pytest.mark.parametrize(
    "law",
    [
        Rubber(0.5, 0.6, 0.01),
        Rubber(0.3, 0.7, 0.01),
        Rubber(0.1, 0.9, 0.1),
        Rubber(0.3, 0.8, 1.0, peaks=True),
        Anisotropic(1.2, 0.8, Rubber(0.3, 0.7, 0.05)),
    ],
)
@pytest.mark.parametrize(
    "asked",
    [
        {"creepages": (0.01, 0.0)},
        {"creepages": (0.05, -0.1), "spin": 1.0},
        {"forces": (-0.24 * LOAD * 0.3, 0.1 * LOAD * 0.3)},
    ],
)
def test_shear_is_the_coefficient_at_its_own_slip(law, asked):
    found, rigid = roll(law, **asked)
    q = found.tangential.shear
    # The slip by sums over pairs of cells, from the shear alone.
    slip = (BY_SHEAR @ q.ravel()).reshape(q.shape) / DX + rigid + np.array(found.tangential.rigid)[:, None, None]
    stretch = np.array(law.axes)[:, None, None]
    size = np.hypot(*(q / stretch))
    slips = (PRESSURE > 0) & ~found.tangential.stick
    bound = law.bound(Interface(PRESSURE, np.where(slips, slip, 0.0), X, X, DX, SPEED))
    scale = np.linalg.norm(bound)
    # Bound and slip are each known to 1e-6; where the coefficient rises steeply, that of the slip counts more.
    assert np.linalg.norm((size - bound)[slips]) <= 3e-5 * scale
    assert (size <= bound + 1e-4 * bound.max()).all()
    r = DX / PATCH.self_influence(rolls=True)
    assert np.linalg.norm(r * slip[:, found.tangential.stick]) <= 3e-6 * scale
    work = -(q * slip).sum(0)
    assert work[slips].min() >= -1e-9 * max(work.max(), 1e-6)
    assert slips.any()


def test_it_rises_between_its_limits():
    # Rising within no slip it is Coulomb's largest, within an endless one that at rest; the force lies between.
    def force(law):
        return -float(roll(law, (0.03, 0.0))[0].tangential.shear[0].sum()) * DX**2

    low, high = force(Coulomb(0.3)), force(Coulomb(0.7))
    between = [force(Rubber(0.3, 0.7, speed)) for speed in (1e4, 1.0, 0.1, 1e-2)]
    assert between[0] == pytest.approx(low, rel=1e-4)
    assert low < between[1] < between[2] < between[3] < high
    assert between[3] == pytest.approx(high, rel=0.1)


def test_slip_carries_what_rest_does_not():
    # A force of 1.2 times friction at rest; far beyond it all slides, and the creepage decides.
    law, rest = Rubber(0.3, 0.7, 0.01), 0.3 * LOAD
    found, _ = roll(law, forces=(-1.2 * rest, 0.0))
    np.testing.assert_allclose(found.tangential.shear.sum((1, 2)) * DX**2, (-1.2 * rest, 0.0), atol=1e-6 * rest)
    with pytest.raises(ConvergenceError, match=r"rises steeply .* 210 % of friction at rest: prescribe the creepage"):
        roll(law, forces=(-2.1 * rest, 0.0))


def test_a_tire_rolls_with_it_and_a_wrong_largest_is_refused():
    @dataclass(frozen=True)
    class Understated(Rubber):
        @property
        def largest(self):
            return self.rest

    tire = tl.Tire.from_height_map((X[None, :] ** 2 + X[:, None] ** 2) / 0.2, DX, material=tl.Elastic(3e6, 0.5))
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))

    def solve(law, **wheel):
        return tl.solve_contact(tire, road, tl.Rolling(normal_load=LOAD, friction=law, speed=SPEED, **wheel))

    contact = solve(Rubber(0.3, 0.7, 0.1), creepage_x=-0.05)
    assert 0.3 < float(contact.dataset.friction) < 0.7
    assert float(contact.dataset.friction_work_total) > 0
    with pytest.raises(InputError, match=r"0\.3\d+ at a slip of .* `largest` is 0\.3;"):
        solve(Understated(0.3, 0.7, 1e-3), creepage_x=-0.05)
    with pytest.raises(InputError, match=r"-0\.\d+ at a slip .* between 0 and its largest"):
        solve(Rubber(0.7, -0.1, 1e-3), creepage_x=-0.05)
    with pytest.raises(InputError, match="gross sliding"):
        solve(Rubber(0.3, 0.7, 0.1), tractive_force=0.75 * LOAD)
