"""The place of a largest value of a symmetric tire is chosen by a rule, and not by round-off."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.case import Case
from treadload.kernels.largest import index_of_largest
from treadload.plots.interactive import Cut
from treadload.steps.loaded import contact_of


def test_of_two_mirror_places_the_one_with_the_larger_y_is_named():
    field = np.array([[1.0, 2.0, 1.0], [0.0, 0.0, 0.0], [1.0, 2.0, 1.0]])
    for off in (-1e-9, 0.0, 1e-9):
        assert index_of_largest(field + off * (np.arange(3) == 0)[:, None]) == (2, 1)
    # Then the larger x.
    assert index_of_largest(np.array([[3.0, 1.0, 3.0]])) == (0, 2)
    # A difference that is no round-off decides.
    assert index_of_largest(field + 1e-5 * (np.arange(3) == 0)[:, None]) == (0, 1)


def test_of_equal_depths_the_shallowest_is_named():
    field = np.zeros((3, 4, 5))
    field[1:, 1, 2] = field[1:, 2, 2] = 7.0
    assert index_of_largest(field) == (1, 2, 2)
    section = np.array([[0.0, 0.0], [5.0, 5.0], [5.0, 5.0]])
    assert index_of_largest(section, horizontal=1) == (1, 1)


def test_negative_values_missing_values_and_none_at_all():
    assert index_of_largest(np.array([[-2.0, np.nan], [-1.0, -1.0 - 1e-9]])) == (1, 1)
    assert index_of_largest(np.full((2, 2), np.nan)) == (0, 0)
    assert index_of_largest(np.zeros((0, 3))) == (0, 0)
    assert index_of_largest(np.array([np.inf, 1.0])) == (0,)
    assert index_of_largest(np.array([3.0, 4.0, 4.0]), horizontal=1) == (2,)


GRID = tl.response.Grid.centred(0.24, 0.24, 0.008)
ROAD = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.1), tl.Layer(tl.Elastic(1e8, 0.35))])


def pressed(off):
    """Two patches of a symmetric tire, one of which is heavier by a part of `off`."""
    x, y = GRID.x[None, :], GRID.y[:, None]
    shape = np.exp(-((x / 0.05) ** 2) - ((np.abs(y) - 0.06) / 0.025) ** 2)
    return 1e6 * np.where(shape > 1e-3, shape, 0.0) * (1 + off * np.sign(y))


@pytest.mark.parametrize("off", [-1e-9, 1e-9])
def test_every_place_that_a_symmetric_tire_is_given_lies_on_one_side(off):
    """Before, each lay on the heavier side, here by 1e-9."""
    load = tl.response.GridLoad(GRID, pressed(off))
    response = tl.solve_response(load, ROAD, depths=[0.0, 0.1], x=GRID.x, y=GRID.y)
    places = [one.place for one in response.rows() if one.place is not None]
    assert places
    assert all(place.y > 0 for place in places)
    verdict = tl.assess(response, tl.FatigueLine(120e-6, -0.2), depth=0.1)
    assert float(verdict.dataset["worst_strain"]) > 1e-5
    assert float(verdict.dataset["worst_y"]) > 0
    means = tl.assess(response, tl.FatigueLine(120e-6, -0.2))
    assert float(means.dataset["worst_strain"]) > 1e-6
    assert float(means.dataset["worst_y"]) >= 0
    assert Cut.along(response).start[1] > 0
    fields = tl.damage.compute_quantities(response, ["von_mises_strain"])
    assert tl.damage.peak(fields, "von_mises_strain")["y"] > 0


@pytest.mark.parametrize("off", [-1e-9, 1e-9])
def test_the_largest_pressure_of_a_symmetric_contact(off):
    case = Case.from_text(COARSE_CASE)
    contact = contact_of(case, case.road(), lambda text: None)
    field = contact.dataset["pressure"]
    even = (field + field.to_numpy()[::-1]) / 2 * (1 + off * np.sign(field["y"]))
    rows = {one.key: one for one in replace(contact, dataset=contact.dataset.assign(pressure=even)).rows()}
    assert rows["largest_pressure"].place.y > 0
