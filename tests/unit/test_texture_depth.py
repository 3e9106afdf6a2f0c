"""Mean profile depth and mean texture depth."""

from pathlib import Path

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.pavement import texture as tx

DATA = Path(__file__).parents[1] / "data" / "texture"


def aylesbury():
    """The whole measured profile between its steel plates, whose places are those of captif-slp's tests."""
    with np.load(DATA / "aylesbury_station_0.npz") as file:
        height, place = file["height_um"].astype(float), np.cumsum(file["step_um"].astype(int)) * 1e-3
    height[height == -32768] = np.nan
    road = (place >= 62.32) & (place < 1870.351)
    return tx.Texture(1e-6 * height[road], 1e-3 * np.ptp(place) / (place.size - 1), 1e-3)


def test_mpd_of_a_measured_profile_is_the_published_one():
    found = tx.mean_profile_depth(aylesbury(), spike_slope=6)
    assert found.valid == 17
    # captif-slp, tests/test_process.py. It takes the distances as they were recorded, to 1 µm; here they are even.
    assert found.mean == pytest.approx(3.2777511e-3, rel=1e-3)


def test_mpd_of_a_cosine():
    x = 0.5e-3 * np.arange(2000)
    cosine = tx.Texture(1e-3 * np.cos(2 * np.pi * x / 20e-3), 0.5e-3, 0.5e-3)
    # Waves of 20 mm pass a filter at 2.4 mm (1 / (1 + (2.4/20)^4)): both halves of a segment reach 1 mm; levelling
    # a segment tilts it by some 3 µm, since a line through whole cosines is not quite flat.
    assert tx.mean_profile_depth(cosine).mean == pytest.approx(1e-3, rel=5e-3)
    short = tx.Texture(1e-3 * np.cos(2 * np.pi * x / 2.4e-3), 0.5e-3, 0.5e-3)
    # Both ways at the cut-off: half is left; points every 0.5 mm see nearly the whole of it.
    assert tx.mean_profile_depth(short, spike_slope=100).mean == pytest.approx(0.5e-3, rel=0.06)


def test_a_slope_is_no_depth():
    x = 0.5e-3 * np.arange(2000)
    assert tx.mean_profile_depth(tx.Texture(0.01 * x, 0.5e-3, 0.5e-3)).mean == pytest.approx(0, abs=2e-6)


def test_segments_with_too_many_dropouts_do_not_count():
    x = 0.5e-3 * np.arange(800)
    heights = 1e-3 * np.cos(2 * np.pi * x / 20e-3)
    heights[10:60] = np.nan
    found = tx.mean_profile_depth(tx.Texture(heights, 0.5e-3, 0.5e-3))
    assert found.valid == 3
    assert np.isnan(found.segments[0])
    with pytest.raises(InputError, match="no segment of 100 mm is valid"):
        tx.mean_profile_depth(tx.Texture(heights[:190], 0.5e-3, 0.5e-3))
    with pytest.raises(InputError, match=r"samples every 0.5 or 1 mm, and this texture has points every 3 mm"):
        tx.mean_profile_depth(tx.Texture(heights, 3e-3, 3e-3))


def test_depth_of_squares_lies_above_that_of_lines():
    road = tx.self_affine(0.2, 0.2 / 256, hurst=0.8, shortest=4e-3, roll_off=20e-3, rms_height=0.5e-3, seed=4)
    squares, lines = tx.map_profile_depth(road), tx.mean_profile_depth(road).mean
    assert 1.1 * lines < squares < 2 * lines
    with pytest.raises(InputError, match="a profile has no depth of squares"):
        tx.map_profile_depth(tx.Texture(road.heights[:1], road.dx, road.dy))


def test_volumetric_depth_of_grooves_and_of_an_egg_box():
    x = 1e-3 * np.arange(200)
    # The same from either end of a patch, so that levelling turns nothing; half of it 2 mm deep.
    grooves = np.where(np.cos(2 * np.pi * (np.arange(200) - 49.5) / 20) > 0, 0.0, -2e-3)
    assert tx.mean_texture_depth(tx.Texture(grooves, 1e-3, 1e-3)) == pytest.approx(1e-3, rel=1e-6)
    box = 1e-3 * np.cos(2 * np.pi * x / 20e-3)[None] * np.cos(2 * np.pi * x / 20e-3)[:, None]
    # A plate on the peaks at 1 mm: 1 mm on the mean.
    assert tx.mean_texture_depth(tx.Texture(box, 1e-3, 1e-3)) == pytest.approx(1e-3, rel=0.02)
    with pytest.raises(InputError, match="the texture depth needs every height"):
        tx.mean_texture_depth(tx.Texture([0.0, np.nan], 1e-3, 1e-3))
