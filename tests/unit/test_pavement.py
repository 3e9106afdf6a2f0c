"""Pavement: layers from the top, the last one without thickness."""

import math

import pytest

from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement

ASPHALT, SOIL = Elastic(5.4e9, 0.35), Elastic(8e7, 0.4)


def test_half_space():
    road = Pavement.half_space(ASPHALT, name="wearing course")
    assert road.surface_material == ASPHALT
    assert road.is_homogeneous
    assert road.layers[0].thickness is None
    assert road.layers[0].name == "wearing course"


def test_layers():
    road = Pavement([Layer(ASPHALT, 0.08), Layer(SOIL)])
    assert road.surface_material == ASPHALT
    assert not road.is_homogeneous
    assert Pavement([Layer(SOIL, 0.1), Layer(SOIL)]).is_homogeneous
    assert road == Pavement((Layer(ASPHALT, 0.08), Layer(SOIL)))


@pytest.mark.parametrize("thickness", [0.0, -0.1, math.nan, math.inf])
def test_thickness_must_be_positive(thickness):
    with pytest.raises(InputError, match="thickness"):
        Layer(ASPHALT, thickness, name="top")


@pytest.mark.parametrize(
    ("layers", "message"),
    [
        ([], "at least one layer"),
        ([Layer(ASPHALT), Layer(SOIL)], "layer 1"),
        ([Layer(ASPHALT, 0.1), Layer(SOIL, 1.0)], "must have no thickness"),
    ],
)
def test_refusals(layers, message):
    with pytest.raises(InputError, match=message):
        Pavement(layers)
