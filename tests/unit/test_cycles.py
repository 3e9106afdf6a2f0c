"""Rainflow of a passage, against the counts of the standard and against sums that no pairing changes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadload.damage import FatigueLine
from treadload.damage.cycles import as_turns, harm_of, rainflow, turning_points

LAW = FatigueLine(100e-6, -0.2)


def cycles(line):
    tops, bottoms = rainflow(*turning_points(np.asarray(line, float)[None]))
    return sorted((t, b) for t, b in zip(tops[0], bottoms[0], strict=True) if t > 0)


def test_front_and_rear_hump_are_two_cycles():
    assert cycles([0, 2, 5, 1, 0, 0, 1, 4, 0]) == [(4, 0), (5, 0)]


def test_a_valley_that_does_not_reach_rest_closes_the_smaller_hump():
    assert cycles([0, 5, 2, 4, 0]) == [(4, 2), (5, 0)]
    assert cycles([0, 4, 2, 5, 0]) == [(4, 2), (5, 0)]


def test_the_example_of_the_standard():
    """ASTM E1049-85, figure 6, from its lowest point: -2 1 -3 5 -1 3 -4 4 -2, raised by 4; ranges 3 4 6 8 8 9.

    Rest is its lowest reading, so that the history is closed there: what the standard counts as halves pair up.
    """
    line = np.array([0, 2, 5, 1, 9, 3, 7, 0, 8, 2, 0]) * 1.0
    found = sorted(t - b for t, b in cycles(line))
    # 5-1, 7-3, 8-0, 9-0: rises 0-5 and 1-9 join to 0-9.
    assert found == [4, 4, 8, 9]


@given(arrays(float, 30, elements=st.floats(0.1, 1.0)))
def test_pairing_moves_no_sum_of_peaks_less_valleys(line):
    """Σ f(peak) - Σ f(valley) is the rise of f along the line, whatever cycles are made of it."""
    peaks, valleys = turning_points(line[None])
    tops, bottoms = rainflow(peaks, valleys)
    rises = np.maximum(np.diff(np.concatenate([[0.0], line**5, [0.0]])), 0.0).sum()
    assert (tops**5 - bottoms**5).sum() == pytest.approx(rises, rel=1e-9)
    assert (tops >= bottoms).all()
    assert tops.max() == line.max()


def test_what_is_level_is_one_turn():
    peaks, valleys = turning_points(np.array([[0, 3, 3, 1, 1, 2, 0], [0, 0, 0, 0, 0, 0, 0]], float))
    np.testing.assert_array_equal(peaks, [[3, 2], [0, 0]])
    np.testing.assert_array_equal(valleys, [[1], [0]])
    tops, bottoms = rainflow(peaks, valleys)
    assert list(zip(tops[0], bottoms[0], strict=True)) == [(2, 1), (3, 0)]


def test_turns_stand_with_what_does_most_first():
    turns = as_turns(np.array([[2.0, 4.0, 5.0]]), np.array([[1.0, 3.5, 0.0]]), 5, 5.0)
    np.testing.assert_array_equal(turns[:, 0], [5, 3.5, 4, 1, 2])
    # What is left out is added to the last, up to the first.
    three = as_turns(np.array([[2.0, 3.0, 5.0]]), np.array([[1.0, 0.0, 0.0]]), 3, 5.0)[:, 0]
    assert three == pytest.approx([5, 0, (3**5 + 2**5 - 1) ** 0.2], rel=1e-12)
    np.testing.assert_array_equal(as_turns(np.array([[2.0, 5.0]]), np.zeros((1, 2)), 1, 5.0), [[5]])


def test_a_law_of_cycles_takes_amplitude_and_mean():
    class Goodman(FatigueLine):
        def allowable_cycles(self, amplitude, mean):
            return self.allowable_passes(amplitude / (1 - mean / 400e-6))

    turns = 1e-6 * np.array([[100.0], [40.0], [60.0]])
    law = Goodman(100e-6, -0.2)
    amplitudes = np.array([50e-6 / (1 - 50 / 400), 10e-6 / (1 - 50 / 400)])
    assert harm_of(law, turns)[0] == pytest.approx((1 / law.allowable_passes(amplitudes)).sum(), rel=1e-12)
    # One without reads peaks.
    assert harm_of(LAW, turns)[0] == pytest.approx(1e-6 * (1 - 0.4**5 + 0.6**5), rel=1e-12)
