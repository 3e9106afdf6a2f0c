"""Peaks between the points of a passage: steady ones, and those where tension ends and the reading with it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadload.study.peaks import peaks_and_valleys

STEP = 3e-3


def passage(offset, edge, *, top=0.0, width=0.02, step=STEP):
    """A bump of a width, m, at top; tension before edge. Peaks (turns, ny) of its points, whose lattice is moved."""
    x = offset * step + step * np.arange(-40, 41)
    uncut = np.exp(-0.5 * ((x - top) / width) ** 2)[None]
    margin = None if edge is None else (edge - x)[None] * 1e6
    return float(peaks_and_valleys(x, uncut, margin, centres=np.zeros(1), turns=1, smooth=True)[0, 0])


@given(st.floats(0, 1))
def test_a_steady_peak_is_found_between_points(offset):
    # Parabolas leave the fourth derivative: 3 (h/w)^4 / 64 of the peak.
    assert passage(offset, None) == pytest.approx(1.0, abs=5e-5)


@given(st.floats(0, 1), st.floats(-0.02, -0.002))
def test_a_reading_that_ends_with_tension_is_read_up_to_there(offset, edge):
    """On the rising side, where the largest reading stands at the very end of tension, wherever the points lie."""
    assert passage(offset, edge) == pytest.approx(np.exp(-0.5 * (edge / 0.02) ** 2), rel=5e-4)


def test_the_end_of_tension_is_met_at_third_order():
    steps = STEP / 2.0 ** np.arange(4)
    errors = [
        max(abs(passage(k / 16, -0.011, step=step) - np.exp(-0.5 * (0.011 / 0.02) ** 2)) for k in range(16))
        for step in steps
    ]
    assert np.diff(np.log2(errors)).max() < -2.5


def test_nothing_is_read_where_nothing_is_tensile():
    assert passage(0.3, -1.0) == 0.0


def test_of_several_depths_the_largest_counts():
    x = STEP * np.arange(-20, 21)
    low, high = (part * np.exp(-0.5 * (x / 0.02) ** 2) for part in (0.5, 1.0))
    uncut = np.stack([high, low])[:, None]
    margin = np.stack([-0.004 - x, 1.0 + 0 * x])[:, None]
    ends = np.exp(-0.5 * (0.004 / 0.02) ** 2)
    assert peaks_and_valleys(x, uncut, margin, centres=np.zeros(1), turns=1, smooth=True)[0, 0] == pytest.approx(
        ends, rel=5e-4
    )
    # Where the upper depth is closed everywhere the lower one is what is left.
    margin[0] = -1.0
    assert peaks_and_valleys(x, uncut, margin, centres=np.zeros(1), turns=1, smooth=True)[0, 0] == pytest.approx(
        0.5, rel=1e-4
    )
