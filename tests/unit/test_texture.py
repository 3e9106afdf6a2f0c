"""The description of a texture, surfaces from a spectrum, and what is done to a measured one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.errors import InputError
from treadload.pavement import texture as tx

MADE = {"hurst": 0.8, "shortest": 0.01, "roll_off": 0.05, "rms_slope": 0.3}


def test_same_surface_on_finer_points():
    coarse, fine = (tx.self_affine(0.1, 0.1 / n, seed=5, **MADE) for n in (64, 256))
    # Waves up to a tenth of the size: both grids hold all of them, so that common points differ by round-off alone.
    np.testing.assert_allclose(fine.heights[::4, ::4], coarse.heights, atol=1e-15)
    assert fine.rms_height == pytest.approx(coarse.rms_height, rel=1e-12)


def test_shorter_waves_leave_the_longer_ones():
    rough = tx.self_affine(0.1, 0.1 / 256, seed=5, hurst=0.8, shortest=0.0025, rms_height=1e-3)
    smooth = tx.self_affine(0.1, 0.1 / 256, seed=5, hurst=0.8, shortest=0.01, rms_height=1e-3)
    filtered = tx.band_pass(rough, shortest=0.01)
    # The same phases: but for its size the filtered surface is the smooth one.
    scale = filtered.rms_height / smooth.rms_height
    np.testing.assert_allclose(filtered.heights, scale * smooth.heights, atol=1e-9)


@pytest.mark.parametrize("hurst", [0.3, 0.8])
def test_slope_height_and_spectrum_are_those_asked_for(hurst):
    one = tx.self_affine(1.0, 1 / 512, hurst=hurst, shortest=1 / 64, rms_slope=0.25, seed=1)
    assert one.rms_slope == pytest.approx(0.25, rel=1e-12)
    assert tx.self_affine(1.0, 1 / 64, rms_height=2e-3, hurst=hurst, shortest=0.1).rms_height == pytest.approx(2e-3)
    power = np.abs(np.fft.rfft2(one.heights)) ** 2
    k = np.hypot(np.fft.rfftfreq(512, 1 / 512)[None], np.fft.fftfreq(512, 1 / 512)[:, None])
    band = (k > 2) & (k < 60)
    slope = np.polyfit(np.log(k[band]), np.log(power[band]), 1)[0]
    # Amplitudes are not random: the exponent of the spectrum is exact.
    assert slope == pytest.approx(-2 - 2 * hurst, abs=1e-6)


def test_seeds_differ_and_repeat():
    one, again, other = (tx.self_affine(0.1, 0.1 / 64, seed=seed, **MADE) for seed in (1, 1, 2))
    assert one == again
    assert hash(one) == hash(again)
    assert one != other


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"hurst": 1.2}, "hurst must lie in"),
        ({"rms_height": 1e-3}, "either rms_slope or rms_height"),
        ({"shortest": 0.004}, "needs four points"),
        ({"roll_off": 0.2}, "roll_off must lie between"),
        ({"seed": -1}, "seed must be a whole number"),
        ({"spacing": 0.0031}, "a whole number of them"),
    ],
)
def test_spectrum_is_checked(change, told):
    asked = {"size": 0.1, "spacing": 0.1 / 64, "seed": 0, **MADE, **change}
    with pytest.raises(InputError, match=told):
        tx.self_affine(**asked)


@pytest.mark.parametrize(
    ("heights", "told"),
    [
        ([[np.nan, np.nan]], "all 2 heights of the texture are NaN"),
        ([[0.0, np.inf]], "1 infinite heights"),
        ([[0.0, 3.0]], "differ by 3 m"),
        ([[0.0]], "two points or more"),
        (np.zeros((2, 2, 2)), r"array \(ny, nx\)"),
    ],
)
def test_heights_are_checked(heights, told):
    with pytest.raises(InputError, match=told):
        tx.Texture(heights, 1e-3, 1e-3)


def test_heights_between_and_beyond_the_points():
    flat = tx.Texture([[0.0, 2e-3, 4e-3]], 1e-3, 1e-3)
    at = flat.height(np.array([-1e-3, -0.5e-3, 1e-3, 1.5e-3, 2e-3]), np.array([0.0, 5.0]))
    # Mirrored in the last point: 1.5 mm stands for 0.5 mm.
    np.testing.assert_allclose(at, [[0, 1e-3, 4e-3, 3e-3, 2e-3]] * 2, atol=1e-15)
    round_about = tx.Texture(1e-3 * np.arange(12.0).reshape(3, 4), 1e-3, 1e-3, periodic=True)
    x, y = round_about.x, round_about.y
    np.testing.assert_allclose(round_about.height(x + 4e-3, y - 3e-3), round_about.heights, atol=1e-14)
    holes = tx.Texture([[0.0, np.nan]], 1e-3, 1e-3)
    with pytest.raises(InputError, match="1 of 2 are not known"):
        holes.height(np.zeros(1), np.zeros(1))


def test_dropouts_are_filled_between_their_neighbours():
    one = tx.fill_dropouts(tx.Texture([[np.nan, 1e-3, np.nan, 3e-3, 4e-3]], 1e-3, 1e-3), most=0.4)
    np.testing.assert_allclose(one.heights, [[1e-3, 1e-3, 2e-3, 3e-3, 4e-3]])
    assert one.treated == ("2 drop-outs (40.0 %) filled between their neighbours",)
    with pytest.raises(InputError, match=r"40.0 % of the texture's heights are missing"):
        tx.fill_dropouts(tx.Texture([[np.nan, 1e-3, np.nan, 3e-3, 4e-3]], 1e-3, 1e-3))


def test_an_empty_row_is_taken_from_its_neighbours():
    rows = np.array([[0.0, 0, 0], [np.nan] * 3, [2e-3, 2e-3, 2e-3]])
    np.testing.assert_allclose(tx.fill_dropouts(tx.Texture(rows, 1e-3, 1e-3), most=0.5).heights[1], 1e-3)


def test_outliers_go_and_nothing_else():
    clean = tx.self_affine(0.1, 0.1 / 128, hurst=0.8, shortest=0.005, rms_slope=0.2, seed=3)
    heights = clean.heights.copy()
    where = (np.array([10, 60, 100]), np.array([20, 70, 3]))
    heights[where] += 20e-3
    found = tx.remove_outliers(tx.Texture(heights, clean.dx, clean.dy))
    assert np.isnan(found.heights[where]).all()
    # A spike takes its neighbours along x with it, as ISO 13473-1 has it.
    assert found.dropouts <= 9
    restored = tx.fill_dropouts(found)
    # Linear over three points of waves of 5 mm: far below the rms height.
    assert np.abs(restored.heights - clean.heights).max() < 0.2 * clean.rms_height
    assert tx.remove_outliers(clean) is clean


@given(st.tuples(*[st.floats(-1e-2, 1e-2)] * 3), st.integers(0, 2))
@settings(max_examples=20, deadline=None)
def test_levelling_takes_planes_out(plane, order):
    base = tx.level(tx.self_affine(0.1, 0.1 / 32, hurst=0.8, shortest=0.02, rms_height=1e-4, seed=1), order=2)
    x, y = np.meshgrid(np.linspace(-1, 1, 32), np.linspace(-1, 1, 32))
    tilted = tx.Texture(base.heights + plane[0] + (plane[1] * x + plane[2] * y) * (order > 0), base.dx, base.dy)
    np.testing.assert_allclose(tx.level(tilted, order=order).heights, base.heights, atol=1e-12)


def test_band_pass_keeps_what_lies_between():
    x = np.arange(256) / 256
    whole = tx.Texture(1e-3 * (np.cos(8 * np.pi * x) + np.cos(64 * np.pi * x))[None], 1 / 256, 1 / 256, periodic=True)
    kept = tx.band_pass(whole, shortest=0.1)
    np.testing.assert_allclose(kept.heights[0], 1e-3 * np.cos(8 * np.pi * x), atol=1e-15)
    assert kept.finest_wave == pytest.approx(0.1)
    measured = tx.Texture(whole.heights, whole.dx, whole.dy)
    # Mirrored at its ends: whole cosines stay whole but for half a point.
    assert np.abs(tx.band_pass(measured, shortest=0.1).heights[0] - kept.heights[0]).max() < 1e-4
    for asked, told in (({}, "give the shortest"), ({"shortest": 2.0, "longest": 1.0}, "must be below"),
                        ({"longest": 1e-4}, "no wave of the texture lies")):  # fmt: skip
        with pytest.raises(InputError, match=told):
            tx.band_pass(whole, **asked)


def test_cut_takes_a_piece_about_a_place():
    line = tx.Texture(1e-3 * np.arange(100.0)[None] / 10, 1e-3, 1e-3)
    piece = tx.cut(line, length=10e-3, x=line.x[0] + 25e-3)
    np.testing.assert_allclose(piece.heights, line.heights[:, 20:30])
    with pytest.raises(InputError, match="does not lie in the texture"):
        tx.cut(line, length=0.2)


def test_it_says_what_it_is_and_what_was_done():
    one = tx.level(tx.self_affine(0.1, 0.1 / 64, seed=2, **MADE))
    assert "64 x 64 points every 1.562 x 1.562 mm" in str(one)
    assert one.summary().endswith("- levelled: plane taken out")
