import dataclasses
import math

import numpy as np
import pytest

from treadload.catalogue import tires
from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.tire import Groove, LateralGrooves, Tire, TreadProfile, equal_ribs

SMOOTH = TreadProfile(0.538, 2.0, 0.282, 0.010)


def test_smooth_crown_is_the_exact_revolved_arc():
    x, y = np.linspace(-0.2, 0.2, 41), np.linspace(-0.13, 0.13, 27)
    drop = 2.0 - np.sqrt(4.0 - y**2)
    exact = 0.538 - np.sqrt((0.538 - drop[:, None]) ** 2 - x[None, :] ** 2)
    np.testing.assert_allclose(SMOOTH.gap(x, y), exact, atol=1e-15)


def test_near_the_middle_it_is_the_paraboloid():
    x, y = np.array([0.01]), np.array([0.02])
    assert SMOOTH.gap(x, y)[0, 0] == pytest.approx(0.01**2 / 2 / 0.538 + 0.02**2 / 2 / 2.0, rel=2e-4)


def test_shoulder_is_tangent_to_crown_and_sidewall():
    start, half = 0.131, 0.141
    step = 1e-7
    slope = np.diff(SMOOTH.drop(np.array([start - step, start, start + step]))) / step
    assert slope[0] == pytest.approx(slope[1], abs=1e-4)
    end = SMOOTH.drop(np.array([half - 1e-9, half]))
    assert end[1] == pytest.approx(2 - math.sqrt(4 - half**2) + 0.010, abs=1e-9)
    assert (end[1] - end[0]) / 1e-9 > 1e3
    assert np.isnan(SMOOTH.drop(np.array([half + 1e-6, -half - 1e-6]))).all()


def test_beyond_the_wheel_there_is_nothing():
    gap = SMOOTH.gap(np.array([0.0, 0.53, 0.54]), np.array([0.0]))
    assert np.isfinite(gap[0, :2]).all()
    assert np.isnan(gap[0, 2])


def test_library_profile_has_five_ribs_and_four_grooves():
    profile = tires["315/80R22.5"]
    # The numbers that examples/paper/fit_profile.py found and wrote.
    assert (profile.rolling_radius, profile.width) == (0.538, 0.282)
    assert (profile.crown_radius, profile.shoulder_radius) == (1.678, 0.0088)
    equal = equal_ribs(0.282, 4, 0.0098, 0.015, edge_radius=0.0029)
    assert profile.grooves == tuple(dataclasses.replace(g, centre=round(g.centre, 5)) for g in equal)
    assert profile.source
    assert profile.notes
    y = np.linspace(-0.13, 0.13, 5201)
    smooth = dataclasses.replace(profile, grooves=())
    over = profile.drop(y) - smooth.drop(y) > 0.0149
    assert np.count_nonzero(np.diff(over.astype(int)) == 1) == 4
    assert over.mean() * 0.26 == pytest.approx(4 * 0.0098, abs=4e-4)


def test_library_tolerates_spelling_and_says_what_there_is():
    assert tires["315_80r22.5"] == tires["315/80 R22.5"]
    with pytest.raises(InputError, match=r"did you mean '315/80R22\.5'"):
        tires["315/70R22.5"]
    with pytest.raises(InputError, match=r"known are .*315/80R22\.5"):
        tires["bicycle"]


def test_the_map_is_symmetric_cell_by_cell():
    # The origin of the grid is not exact in binary: walls on cell centres must not care.
    tire = Tire.from_profile("315/80R22.5")
    for spacing in (1e-3, 1.2e-3, 3e-3, 6e-3):
        grid = Grid.centred(0.3, 0.3, spacing)
        gap = tire.height_map(grid)
        np.testing.assert_array_equal(np.isnan(gap), np.isnan(gap[::-1]))
        np.testing.assert_allclose(gap, gap[::-1, ::-1], atol=1e-14)
        assert np.nanmin(gap) >= 0
        assert np.nanmin(gap) < 2e-5


def test_a_groove_has_its_depth_walls_and_rounded_edges():
    angle, radius = 0.2, 0.002
    groove = Groove(0.0, 0.012, 0.010, angle, radius)
    profile = TreadProfile(0.538, 1e6, 0.2, grooves=(groove,))
    y = np.linspace(0, 0.02, 200001)
    depth = profile.drop(y)
    assert depth[0] == pytest.approx(0.010)
    # On the wall: 5 mm down the trench is narrower by 5 mm · tan(angle) on each side.
    assert np.interp(-0.005, -depth, y) == pytest.approx(0.006 - 0.005 * math.tan(angle), abs=2e-7)
    tangent = radius * math.tan((math.pi / 2 - angle) / 2)
    start = 0.006 + tangent
    assert np.interp(start + 1e-6, y, depth) == pytest.approx(0, abs=1e-9)
    # Points of the rounding lie on its circle, centred one radius below the tread.
    inside = (y < start) & (y > 0.006 - tangent * math.sin(angle))
    distance = np.hypot(y[inside] - start, depth[inside] - radius)
    np.testing.assert_allclose(distance, radius, atol=1e-9)
    # No kink: the slope jumps nowhere but at the floor.
    slope = np.gradient(depth, y)
    away = np.abs(y - (0.006 - 0.010 * math.tan(angle))) > 1e-6
    assert np.abs(np.diff(slope))[away[1:] & away[:-1]].max() < 0.02


def test_a_groove_on_the_crown_leaves_the_ribs_beside_it_touching():
    profile = dataclasses.replace(SMOOTH, grooves=(Groove(0.0, 0.020, 0.015),))
    gap = profile.gap(np.zeros(1), np.array([-0.01001, 0.0, 0.01001]))
    assert gap[[0, 2], 0] == pytest.approx([0, 0], abs=1e-6)
    assert gap[1, 0] == pytest.approx(0.015 - 0.01**2 / 2 / 2.0, abs=1e-6)


def test_lateral_grooves_repeat_and_slant():
    lugs = LateralGrooves(0.05, 0.010, 0.008, angle=0.3, y_range=(0.05, 0.141))
    profile = dataclasses.replace(SMOOTH, lateral=(lugs,))
    x = np.linspace(-0.1, 0.1, 4001)
    y = np.array([-0.1, 0.02, 0.06, 0.10])
    deep = profile.gap(x, y) - SMOOTH.gap(x, y) > 0.005
    assert not deep[:2].any()
    assert deep[2].mean() == pytest.approx(0.010 / math.cos(0.3) / 0.05, abs=0.02)

    def middle(row):
        starts = np.flatnonzero(np.diff(row.astype(int)) == 1)
        ends = np.flatnonzero(np.diff(row.astype(int)) == -1)
        ends = ends[ends > starts[0]]
        return 0.5 * (x[starts[: len(ends)]] + x[ends[: len(starts)]])

    arc = 0.538 * np.arcsin(middle(deep[2]) / 0.537)
    assert np.diff(arc) == pytest.approx(0.05, abs=1e-3)
    moved = middle(deep[3])[:, None] - middle(deep[2])[None, :]
    # Positive angle: further along travel on the right.
    assert np.abs(moved - 0.04 * math.tan(0.3)).min() < 1e-3


def test_lateral_grooves_under_the_axle_keep_the_plane_on_the_tread():
    profile = dataclasses.replace(SMOOTH, lateral=(LateralGrooves(0.06, 0.02, 0.010),))
    gap = profile.gap(np.linspace(-0.1, 0.1, 2001), np.linspace(-0.14, 0.14, 29))
    assert np.nanmin(gap) == pytest.approx(0, abs=2e-6)
    assert profile.gap(np.zeros(1), np.zeros(1))[0, 0] == pytest.approx(0.010, abs=2e-4)


def test_toml_round_trip(tmp_path):
    lugs = LateralGrooves(0.05, 0.008, 0.01, 0.1, 0.002, angle=0.4, y_range=(0.09, 0.141), offset=0.01)
    profile = dataclasses.replace(
        SMOOTH, grooves=equal_ribs(0.282, 3, 0.014, 0.015, 0.1, 0.001), lateral=(lugs,), name="mine", source="me"
    )
    path = tmp_path / "mine.toml"
    path.write_text(profile.to_toml(), encoding="utf-8")
    assert TreadProfile.from_toml(path) == profile
    assert TreadProfile.from_dict(profile.to_dict()) == profile
    assert hash(TreadProfile.from_toml(path)) == hash(profile)


def test_toml_faults_are_named(tmp_path):
    def read(text):
        path = tmp_path / "p.toml"
        path.write_text(text)
        return TreadProfile.from_toml(path)

    good = "rolling_radius = 0.5\ncrown_radius = 2\nwidth = 0.28\n"
    assert read(good).width == 0.28
    with pytest.raises(InputError, match="did you mean 'shoulder_radius'"):
        read(good + "shoulder_radus = 0.01\n")
    with pytest.raises(InputError, match=r"tread profile: 'grooves\.0\.depth' is missing"):
        read(good + "[[grooves]]\ncentre = 0\nwidth = 0.01\n")
    assert read(good.replace("0.28", "'282 mm'")).width == 0.282
    with pytest.raises(InputError, match="width: cannot read '282 kg'"):
        read(good.replace("0.28", "'282 kg'"))
    with pytest.raises(InputError, match="tread profile: 'width' is missing"):
        read(good.replace("width = 0.28", ""))
    with pytest.raises(InputError, match="not valid TOML"):
        read("rolling_radius = ")
    with pytest.raises(InputError, match="no tread profile file"):
        TreadProfile.from_toml(tmp_path / "none.toml")


@pytest.mark.parametrize(
    "change",
    [
        {"rolling_radius": 538.0},
        {"rolling_radius": math.nan},
        {"crown_radius": 0.1},
        {"width": 0.0},
        {"width": math.inf},
        {"shoulder_radius": -0.01},
        {"shoulder_radius": 0.2},
        {"grooves": (Groove(0.14, 0.012, 0.015),)},
        {"rolling_radius": 0.06, "crown_radius": 0.15, "grooves": (Groove(0, 0.012, 0.015),)},
    ],
)
def test_profiles_out_of_bounds_are_refused(change):
    with pytest.raises(InputError, match="tread profile"):
        dataclasses.replace(SMOOTH, **change)


@pytest.mark.parametrize(
    "numbers",
    [
        (0, -0.012, 0.015),
        (0, 0.012, 0.0),
        (0, 12.0, 15.0),
        (math.nan, 0.012, 0.015),
        (0, 0.012, 0.015, 1.0),
        (0, 0.012, 0.015, -0.1),
        (0, 0.012, 0.015, 2.0),
        (0, 0.012, 0.015, 0.0, -1e-3),
        (0, 0.012, 0.004, 0.0, 0.005),
    ],
)
def test_grooves_out_of_bounds_are_refused(numbers):
    with pytest.raises(InputError, match="groove"):
        Groove(*numbers)


@pytest.mark.parametrize(
    "numbers",
    [{"pitch": 0.01}, {"angle": 1.5}, {"y_range": (0.1, 0.05)}, {"pitch": math.inf}, {"edge_radius": 0.02}],
)
def test_lateral_grooves_out_of_bounds_are_refused(numbers):
    with pytest.raises(InputError, match="lateral groove"):
        LateralGrooves(**{"pitch": 0.05, "width": 0.01, "depth": 0.008, **numbers})


def test_equal_ribs_are_equal():
    grooves = equal_ribs(0.282, 4, 0.012, 0.015)
    assert [g.centre for g in grooves] == pytest.approx([-0.0882, -0.0294, 0.0294, 0.0882])


def test_no_rib_left_is_refused():
    with pytest.raises(InputError, match="no rib"):
        equal_ribs(0.1, 10, 0.012, 0.015)


def test_a_grid_beside_the_tire_is_refused():
    with pytest.raises(GeometryError, match="no cell"):
        Tire.from_profile(SMOOTH).height_map(Grid(5, 5, 1e-3, 1e-3, 0.0, 1.0))
