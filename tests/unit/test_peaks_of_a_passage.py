"""Peaks between the points of a passage: steady ones, and those where tension ends and the reading with it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadload.life.peaks import Strips, over_strips, peaks_and_valleys

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


@given(st.integers(0, 2**32 - 1), st.integers(3, 30), st.integers(1, 3))
def test_peaks_are_those_of_every_pair_of_points(seed, points, depths):
    """Pair by pair: the parabola with the mean curvature of both, up to where straight tension ends."""
    draw = np.random.default_rng(seed)
    x = np.arange(points) * STEP
    uncut, margin = (draw.normal(size=(depths, 1, points)).cumsum(axis=-1) for _ in range(2))
    found = peaks_and_valleys(x, uncut, margin, centres=x.mean(keepdims=True), turns=1, smooth=True)[0, 0]
    tensile = margin > 0
    largest = np.where(tensile, uncut, 0.0).max()
    if not largest > 0:
        return
    expected = largest
    for value, tension in zip(uncut[:, 0], margin[:, 0], strict=True):
        bends = np.diff(value, 2)
        bends = np.concatenate([bends[:1], 0.5 * (bends[1:] + bends[:-1]), bends[-1:]]) / 2
        for k in range(points - 1):
            if max(value[k : k + 2]) < 0.8 * largest or max(tension[k : k + 2]) <= 0:
                continue
            t = np.linspace(0, 1, 2001)
            parabola = value[k] + t * (value[k + 1] - value[k] - bends[k]) + bends[k] * t * t
            open_ = tension[k] + t * (tension[k + 1] - tension[k]) > 0
            expected = max(expected, parabola[open_].max())
    # Of 2000 places between two points, by the slope there; four depths of random walks bend by 10 at most.
    assert found == pytest.approx(expected, abs=2e-2)
    assert found >= expected - 1e-12


def test_strips_are_divided_where_readings_end_and_as_good_as_divided_everywhere():
    """Tension of 4 mm across, which ends between rows of 1.5 mm, in readings that vary over 40 mm."""
    rows, x = 1.5e-3 * np.arange(60), 3e-3 * np.arange(41)
    far = np.hypot(x - 0.06, rows[:, None] - 0.0441)
    uncut = np.exp(-((far / 0.04) ** 2))
    margin = np.broadcast_to((2.0e-3 - np.abs(rows[:, None] - 0.0441)) * 1e6, uncut.shape)
    strips = Strips.of(rows, rows, narrow=True)
    divided = replace(strips.narrow, narrow=strips.narrow)
    at = {"centres": np.array([0.06]), "turns": 1, "power": 5.0}
    coarse, adapted, fine = (
        over_strips(each, x, uncut, margin, **at)[0] for each in (replace(strips, narrow=None), strips, divided)
    )
    assert np.abs(adapted - fine).max() < 1e-4 * fine.max()
    assert np.abs(coarse - fine).max() > 0.02 * fine.max()
