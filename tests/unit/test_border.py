"""A largest value on the border of a map is named; one inside is not."""

import numpy as np
import pytest

from treadload import assess
from treadload.damage import FatigueLine
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import UniformDisc, solve_response

ROAD = Pavement([Layer(Elastic(5e9, 0.35), 0.15), Layer(Elastic(120e6, 0.35))])
DISC = UniformDisc(0.12, 0.7e6)


def said_of_the_border(reach):
    x = np.linspace(-reach, reach, 25)
    response = solve_response(DISC, ROAD, depths=[0.0], x=x, y=x)
    verdict = assess(response, FatigueLine(100e-6, -0.2))
    return [text for text in verdict.warnings if "lies at its end" in text], verdict


@pytest.mark.parametrize("reach", [0.35, 1.8])
def test_the_surface_ahead_of_a_disc_is_named_where_the_map_ends_before_it(reach):
    texts, verdict = said_of_the_border(reach)
    data = verdict.dataset
    if reach > 1:
        assert texts == []
        assert 0.4 < np.hypot(data["worst_x"], data["worst_y"]) < 1.2
    else:
        (text,) = texts
        assert "350 mm" in text
        assert "1.5 m for the whole basin" in text


def test_the_larger_value_is_beyond_that_border():
    near, far = (float(said_of_the_border(reach)[1].dataset["worst_strain"]) for reach in (0.35, 1.8))
    # Measured: 20.4 microstrain in the corner of the small map, 21.1 beyond.
    assert far > 1.02 * near


def test_a_line_of_places_has_no_border():
    response = solve_response(DISC, ROAD, depths=[0.0], x=np.linspace(-1.8, 1.8, 61), y=[0.0])
    assert not any("lies at its end" in text for text in assess(response, FatigueLine(100e-6, -0.2)).warnings)
