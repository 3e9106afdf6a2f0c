"""Contact of ribs on a window of the grid: as on the whole grid, and on the whole grid where it does not stay."""

import numpy as np
import pytest

import treadload as tl
from treadload.contact.solvers import coupling, window
from treadload.kernels.gridding.strips import shortened
from treadload.tire import TreadProfile
from treadload.tire.grooves import Groove

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
NARROW = TreadProfile(
    0.5, 0.8, 0.12, grooves=(Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015)), shoulder_radius=0.005
)
TIRE = tl.Tire.from_profile(
    NARROW,
    inflation_pressure=820e3,
    belt=tl.tire.Belt(tread=tl.Elastic(5.5e6, 0.495), bending=(80, 100, 150)),
    tread="ribs",
)
WHEEL = tl.Rolling(normal_load=8e3, friction=0.6, tractive_force=1e3)


def rolled():
    return tl.solve_contact(TIRE, ROAD, WHEEL, spacing=5e-3)


@pytest.fixture
def windows(monkeypatch):
    """What `_in_window` returned, call by call."""
    solved, whole = [], coupling._in_window

    def noted(*arguments, **options):
        solved.append(whole(*arguments, **options))
        return solved[-1]

    monkeypatch.setattr(coupling, "_in_window", noted)
    return solved


# The first contact runs on a window, the second has none; the third has one that is too small.
@pytest.mark.slow
def test_the_window_changes_nothing(windows, monkeypatch):
    on_window = rolled()
    assert [solved is not None for solved in windows] == [True]
    monkeypatch.setattr(window, "_MARGIN", -3)
    monkeypatch.setattr(window, "_MULTIPLE", 1)
    grown = rolled()
    assert windows[1] is None
    monkeypatch.setattr(coupling.Window, "of", lambda *arguments: None)
    on_grid = rolled()
    assert len(windows) == 2
    # The tolerance of 1e-6 is of the approach, some tens of times what a rib is pressed together.
    for contact in (on_window, grown):
        for name in ("pressure", "traction_x", "traction_y", "gap"):
            field, reference = (c.dataset[name].values for c in (contact, on_grid))
            np.testing.assert_array_equal(np.isnan(field), np.isnan(reference))
            assert np.nanmax(np.abs(field - reference)) <= 1e-4 * np.nanmax(np.abs(reference)), name
        assert contact.stats["normal_residual"] <= 1e-6


def test_a_shorter_block_has_the_kernel_of_the_longer():
    rng = np.random.default_rng(3)
    whole, length = 24, 16
    kernel = rng.normal(size=(whole // 2 + 1, 6, 6))
    short = shortened(kernel, whole, length, odd=False)
    assert short.shape == (length // 2 + 1, 6, 6)
    # u_y by q_y, the frame apart: loads on half the length see the same.
    long_kernel, short_kernel = (np.fft.irfft(k[:, 3, 3], n) for k, n in ((kernel, whole), (short, length)))
    np.testing.assert_allclose(short_kernel[: length // 2], long_kernel[: length // 2], atol=1e-14)
    np.testing.assert_allclose(short_kernel[-length // 2 + 1 :], long_kernel[-length // 2 + 1 :], atol=1e-14)
    # What is odd along travel stays odd: in the frame the block is real.
    assert not np.iscomplexobj(short)
    assert not np.iscomplexobj(shortened(kernel, whole, length, odd=True))
