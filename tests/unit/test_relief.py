"""A road that is no plane below a tire."""

from dataclasses import dataclass

import numpy as np
import pytest

import treadload as tl
from treadload.contact.relief import heights_on
from treadload.errors import InputError
from treadload.grid import Grid

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
WHEEL = tl.Rolling(approach=1e-3, friction=0.5)
RADIUS = 0.05


@dataclass(frozen=True)
class Ball:
    """The road's part of a ball: 1/R is shared between tire and road."""

    share: float
    rise: float = 0.0

    def height(self, x, y):
        return self.rise - self.share * (x[None, :] ** 2 + y[:, None] ** 2) / (2 * RADIUS)


def tire(share, cells=61, step=1e-3):
    at = step * (np.arange(cells) - cells // 2)
    gap = share * (at[None, :] ** 2 + at[:, None] ** 2) / (2 * RADIUS)
    return tl.Tire.from_height_map(gap, step, material=tl.Elastic(3e6, 0.5))


def test_gap_is_what_counts_not_who_is_curved():
    whole = tl.solve_contact(tire(1.0), ROAD, WHEEL)
    shared = tl.solve_contact(tire(0.25), ROAD, WHEEL, relief=Ball(0.75))
    # The same numbers in other sums: round-off of a gap of 10 mm in an approach of 1 mm, far below the solver's 1e-6.
    np.testing.assert_allclose(shared.dataset.pressure, whole.dataset.pressure, rtol=0, atol=1e-4)
    assert "road_height" in shared.dataset
    assert "road_height" not in whole.dataset
    assert shared.tire == tire(0.25)


def test_approach_counts_from_the_plane_of_the_road():
    load = tl.Rolling(normal_load=20.0, friction=0.5)
    flat, raised = (tl.solve_contact(tire(1.0), ROAD, load, relief=Ball(0.0, rise)) for rise in (0.0, 2e-3))
    assert float(flat.dataset.approach - raised.dataset.approach) == pytest.approx(2e-3, abs=1e-9)
    np.testing.assert_allclose(raised.dataset.pressure, flat.dataset.pressure, atol=1.0)


@dataclass(frozen=True)
class Holes:
    def height(self, x, y):
        return np.full((y.size, x.size), np.nan)


def test_relief_is_checked():
    with pytest.raises(InputError, match=r"relief must be a pavement\.Texture or have a method height"):
        tl.solve_contact(tire(1.0), ROAD, WHEEL, relief=0.01)
    with pytest.raises(InputError, match=r"not known at 3721 of 3721 places"):
        tl.solve_contact(tire(1.0), ROAD, WHEEL, relief=Holes())
    with pytest.raises(InputError, match=r"heights of shape \(1, 2\) for a grid of \(2, 2\)"):
        heights_on(type("Wrong", (), {"height": lambda self, x, y: np.zeros((1, 2))})(), Grid(2, 2, 1, 1, 0, 0))


def test_a_contact_on_relief_is_saved_and_opened_again(tmp_path):
    found = tl.solve_contact(tire(0.25), ROAD, WHEEL, relief=Ball(0.75, 1e-3))
    opened = tl.open_results(tl.save_results(found, tmp_path / "c.nc")).contact
    np.testing.assert_array_equal(opened.dataset.road_height, found.dataset.road_height)
    assert opened.tire == found.tire
    # The gap that was solved is that of the tread less the road's height.
    gap = tire(0.25).height_map(Grid(61, 61, 1e-3, 1e-3, -30e-3, -30e-3)) - found.dataset.road_height.to_numpy()
    np.testing.assert_allclose(opened.dataset.initial_gap, gap, atol=1e-15)
