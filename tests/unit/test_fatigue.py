"""The fatigue line."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadload.damage import FatigueLine
from treadload.errors import InputError

LINE = FatigueLine(epsilon_6=120e-6, slope=-0.2)


def test_the_line_passes_through_its_point():
    # Round-off of a power.
    assert LINE.allowable_passes(120e-6) == pytest.approx(1e6, rel=1e-12)
    assert LINE.allowable_strain(1e6) == pytest.approx(120e-6, rel=1e-12)


def test_half_the_strain_bears_thirty_two_times_the_passes():
    assert LINE.allowable_passes(60e-6) == pytest.approx(32e6, rel=1e-12)


@given(st.floats(1e-6, 1e-3), st.floats(-0.5, -0.05), st.floats(1e-7, 1e-3))
def test_round_trip(epsilon_6, slope, strain):
    line = FatigueLine(epsilon_6, slope)
    # Round-off, amplified by the exponent of at most 20 on numbers up to 10^60.
    assert line.allowable_strain(line.allowable_passes(strain)) == pytest.approx(strain, rel=1e-11)


def test_no_extension_no_end():
    passes = LINE.allowable_passes(np.array([-1e-4, 0.0, 120e-6, np.nan, 1e-300]))
    np.testing.assert_array_equal(passes[[0, 1, 4]], np.inf)
    assert passes[2] == pytest.approx(1e6, rel=1e-12)
    assert math.isnan(passes[3])
    assert LINE.allowable_passes(-1.0) == math.inf


def test_a_number_gives_a_number_and_an_array_an_array():
    assert type(LINE.allowable_passes(1e-4)) is float
    assert type(LINE.allowable_strain(10.0)) is float
    assert LINE.allowable_passes(np.full((2, 3), 1e-4)).shape == (2, 3)
    assert LINE.allowable_strain(np.array([1.0, 10.0])).shape == (2,)


@pytest.mark.parametrize(
    ("epsilon_6", "slope", "message"),
    [
        (120, -0.2, '120e-6 or "120 microstrain"'),
        (0.0, -0.2, "positive"),
        (-1e-4, -0.2, "positive"),
        (math.nan, -0.2, "positive"),
        (1e-4, 0.2, r"\(-1, 0\), got 0.2"),
        (1e-4, -1.0, r"\(-1, 0\)"),
        (1e-4, math.nan, r"\(-1, 0\)"),
    ],
)
def test_refusals(epsilon_6, slope, message):
    with pytest.raises(InputError, match=message):
        FatigueLine(epsilon_6, slope)


@pytest.mark.parametrize("passes", [0.0, -5.0, math.nan])
def test_passes_must_be_positive(passes):
    with pytest.raises(InputError, match="passes must be positive"):
        LINE.allowable_strain(passes)


def test_it_prints_in_microstrain():
    assert str(LINE) == "fatigue line, ε₆ = 120 microstrain, slope -0.2"
