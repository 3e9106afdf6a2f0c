"""What the page says of a verdict."""

import numpy as np
import pytest

import treadload as tl
from treadload.app.result_rows import rows_of


@pytest.mark.parametrize(("epsilon_6", "told"), [(1e-4, "e+"), (1e-2, "over 10¹⁰")])
def test_passes_are_told_by_number_as_far_as_a_road_bears_them(epsilon_6, told):
    load = tl.UniformRectangle(0.2, 0.2, 0.8e6, traction_x=0.4e6)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    response = tl.solve_response(load, road, depths=[0.0], x=np.linspace(-0.2, 0.2, 41), y=[0.0])
    verdict = tl.assess(response, tl.FatigueLine(epsilon_6, -0.2))
    rows = {one["label"]: one["value"] for one in rows_of({"damage": verdict})}
    assert told in rows["Allowable load repetitions"]
