"""Fringe projection: phases, their order, heights, deviations, masks, files and what is refused."""

import math
import struct
import zlib
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from PIL import Image
from scipy import ndimage
from typer.testing import CliRunner

import treadload as tl
from treadload.cli import app
from treadload.errors import GeometryError, InputError
from treadload.tire import Groove, TreadProfile
from treadload.tire.fringes import (
    CameraProjector,
    Evaluation,
    Pattern,
    ReferencePlane,
    Rig,
    look,
    measure_fringes,
    pictures_of,
    planned_deviation,
    read_fringes,
)
from treadload.tire.fringes.gamma import gamma_of, phase_error, second_harmonic, without_gamma
from treadload.tire.fringes.mapping import TRAVEL, as_travelled
from treadload.tire.fringes.steps import even_shifts, solve_steps, wrapped
from treadload.tire.fringes.unwrapping import unwrap_by_periods, unwrap_over_picture

TURN = 2 * math.pi
PIXEL, TOP, ROWS, COLUMNS = 0.5e-3, 0.016, 110, 130
TREAD = TreadProfile(
    rolling_radius=0.52,
    crown_radius=1.2,
    width=0.3,
    grooves=(Groove(centre=-0.012, width=0.010, depth=0.012), Groove(centre=0.017, width=0.008, depth=0.008)),
)
LENSES = ReferencePlane(PIXEL, distance=0.5, baseline=0.2, period=1.2 * COLUMNS * PIXEL / 40)


def steps_of(phase, shifts, brightness=100.0, modulation=60.0):
    delta = np.asarray(shifts).reshape(-1, *[1] * np.ndim(phase))
    return brightness + modulation * np.cos(np.asarray(phase)[None] + delta)


@pytest.mark.parametrize("shifts", [even_shifts(3), even_shifts(4), even_shifts(7), np.array([0.1, 0.9, 2.5, 4.4])])
def test_steps_give_phase_modulation_and_brightness_for_any_known_shifts(shifts):
    phase = np.linspace(-3.1, 3.1, 40).reshape(4, 10)
    found = solve_steps(steps_of(phase, shifts), list(shifts))
    # Round-off of a least squares of four by three.
    assert np.allclose(found.phase, phase, atol=1e-12)
    assert np.allclose(found.modulation, 60, atol=1e-10)
    assert np.allclose(found.brightness, 100, atol=1e-10)


@pytest.mark.parametrize("count", [3, 4, 8])
def test_noise_of_the_phase_is_that_of_the_formula(count):
    """σ_φ = √2 σ_I/(√N B): 40 000 draws tell a standard deviation to 0.35 %, 1.5 % is four of these."""
    rng = np.random.default_rng(count)
    phase = rng.uniform(-math.pi, math.pi, (200, 200))
    grey = steps_of(phase, even_shifts(count)) + rng.normal(0, 1.5, (count, 200, 200))
    found = solve_steps(grey)
    spread = float(wrapped(found.phase - phase).std())
    assert spread == pytest.approx(planned_deviation(60.0, 1.5, count), rel=0.015)
    assert float(np.median(found.spread)) * 1.5 == pytest.approx(spread, rel=0.015)


def test_a_saturated_step_is_left_out_and_the_noise_told_without_it():
    rng = np.random.default_rng(5)
    phase = np.full((150, 150), 0.2)
    clean = np.minimum(steps_of(phase, even_shifts(6), 150.0, 120.0), 255.0)
    exact = solve_steps(clean, None, 255.0)
    assert (exact.used == 5).all()
    assert np.allclose(exact.phase, 0.2, atol=1e-12)
    assert np.abs(solve_steps(clean).phase - 0.2).max() > 1e-3
    noisy = solve_steps(np.where(clean < 255, clean + rng.normal(0, 2, clean.shape), 255.0), None, 255.0)
    # 22 500 draws: 0.5 %.
    assert float((noisy.phase - 0.2).std()) == pytest.approx(2 * float(np.median(noisy.spread)), rel=0.03)
    # Two steps left are too few.
    assert np.isnan(solve_steps(np.array([[[255.0]], [[255.0]], [[90.0]], [[80.0]]]), None, 255.0).phase).all()


def test_gamma_has_the_harmonics_of_its_series_and_more_steps_cancel_them():
    for gamma in (0.6, 1.0, 1.8, 2.4):
        assert second_harmonic(gamma) == pytest.approx((gamma - 1) / (gamma + 2), abs=2e-4)
        assert gamma_of(second_harmonic(gamma, 0.7), 0.7) == pytest.approx(gamma, abs=1e-4)
    rms = [float(np.sqrt((phase_error(None, count, 1.8) ** 2).mean())) for count in (3, 4, 5, 8)]
    assert all(later < 0.5 * before for before, later in pairwise(rms))
    # Left by three steps to first order: second over first harmonic, as a sine.
    assert rms[0] == pytest.approx(second_harmonic(1.8) / math.sqrt(2), rel=0.1)
    true = np.linspace(-3, 3, 500)
    seen = solve_steps(((1 + np.cos(true[None, None] + even_shifts(3)[:, None, None])) / 2) ** 1.8).phase[0]
    assert np.abs(wrapped(without_gamma(seen, None, 3, 1.8) - true)).max() < 1e-5


@pytest.mark.parametrize("fringes", [(1, 6, 40), (64, 63, 56), (0.5, 4, 30)])
def test_several_periods_tell_the_order_of_every_pixel_by_itself(fringes):
    place = np.linspace(0.02, 0.98, 3000)
    np.random.default_rng(1).shuffle(place)
    rng = np.random.default_rng(2)
    phases = [wrapped(TURN * count * place + rng.normal(0, 0.01, 3000)) for count in fringes]
    found = unwrap_by_periods(phases, fringes, [np.full(3000, 0.01)] * len(fringes))
    assert found.unsure == 0
    # Noise of 0.01 rad and nothing else: five deviations.
    assert np.abs(found.phase - TURN * max(fringes) * place).max() < 0.05
    assert found.margin < 0.1


def test_periods_that_tell_no_order_are_refused():
    with pytest.raises(InputError, match="leave the fringe of a pixel open"):
        unwrap_by_periods([np.zeros(3)] * 3, (16, 32, 64), [np.zeros(3)] * 3)
    with pytest.raises(InputError, match="give each once"):
        unwrap_by_periods([np.zeros(3)] * 2, (8, 8), [np.zeros(3)] * 2)


def test_over_the_picture_only_what_hangs_together_with_the_anchor_is_kept():
    true = np.linspace(0, 40, 60)[None, :] + np.linspace(0, 9, 50)[:, None]
    phase = wrapped(true)
    phase[:, 41] = np.nan
    found, gone = unwrap_over_picture(phase, (10, 10), float(true[10, 10]) + 2.0)
    assert gone == 50 * 18
    assert np.nanmax(np.abs(found - true)) < 1e-9
    assert np.isnan(found[:, 41:]).all()
    with pytest.raises(InputError, match="the anchor at row 10, column 41"):
        unwrap_over_picture(phase, (10, 41), 0.0)


# A tread under fringes ------------------------------------------------------------------------------------------


def surface(x, y):
    return ndimage.map_coordinates(surface.map, [(y + 0.06) / 1e-4, (x + 0.06) / 1e-4], order=1, mode="nearest")


surface.map = TOP - TREAD.gap(np.arange(-0.06, 0.06, 1e-4), np.arange(-0.06, 0.06, 1e-4))
RIG = Rig.above(PIXEL, ROWS, COLUMNS, distance=0.5, baseline=0.2)


@pytest.fixture(scope="module")
def seen():
    flat = {height: look(RIG, lambda x, y, h=height: h + 0 * x, -1e-3, 0.03) for height in (0.0, 0.01, 0.02)}
    return look(RIG, surface, TOP - 0.016, TOP), flat


def patterns(seen, rig, *, fringes=(1, 6, 40), steps=8, planes=(), seed=1):
    rng = np.random.default_rng(seed)
    tread, flat = seen
    return [
        Pattern(
            count,
            pictures_of(rig, tread, count, steps, rng),
            pictures_of(rig, flat[0.0], count, steps, rng),
            tuple(pictures_of(rig, flat[height], count, steps, rng) for height in planes),
        )
        for count in fringes
    ]


def error(scan, tread):
    found = scan.pixels["fringe_height"].to_numpy() - tread.height
    return found[np.isfinite(found)]


HARD = RIG.with_(noise=2.0, gamma=1.5, gain=350.0)


@pytest.mark.parametrize(
    ("calibration", "planes", "asked"),
    [
        (LENSES, (), Evaluation()),
        (ReferencePlane(PIXEL, heights=(0.01, 0.02), camera_distance=0.5), (0.01, 0.02), Evaluation()),
        (RIG.model, (), Evaluation(gamma="auto")),
    ],
    ids=["lenses", "planes", "projector"],
)
def test_a_known_tread_comes_back_within_a_tenth_of_a_millimetre(seen, calibration, planes, asked):
    """0.1 mm rms at pixels of 0.5 mm, under noise, gamma and saturation; what is found is 0.01 to 0.02 mm."""
    scan = measure_fringes(patterns(seen, HARD, planes=planes), calibration, asked)
    left = error(scan, seen[0])
    assert float(np.sqrt((left**2).mean())) < 0.03e-3
    assert np.abs(left).max() < 0.2e-3
    # The grooves run along the light, so that little lies in shadow; two rows at each of four walls are given up.
    assert scan.quality.kept > 0.85
    assert scan.quality.spared > 0.05
    assert scan.quality.gamma == pytest.approx(1.5, abs=0.05)
    assert scan.quality.noise == pytest.approx(2.0, rel=0.1)
    gap = scan.dataset["initial_gap"]
    assert float(gap.min()) == 0.0
    assert float(gap.max()) == pytest.approx(TOP - float(seen[0].height.min()), abs=2e-4)


def test_deviations_of_the_heights_are_those_that_noise_makes(seen):
    scan = measure_fringes(patterns(seen, RIG), LENSES)
    left, told = error(scan, seen[0]), scan.pixels["fringe_deviation"].to_numpy()
    told = told[np.isfinite(told)]
    # Over 13 000 pixels the ratio of both is known to 0.6 %; rounding to grey levels adds 4 % of variance.
    assert float(np.sqrt(np.mean((left / told) ** 2))) == pytest.approx(1.0, abs=0.05)


def test_few_steps_feel_gamma_and_are_told_so(seen):
    rig = RIG.with_(gamma=2.8, noise=0.5)
    pictures = patterns(seen, rig, steps=4)
    plain = measure_fringes(pictures, RIG.model)
    assert any('gamma = "auto"' in text for text in plain.quality.warnings)
    fixed = measure_fringes(pictures, RIG.model, Evaluation(gamma="auto"))
    assert not any("gamma" in text for text in fixed.quality.warnings)
    rms = [float(np.sqrt((error(scan, seen[0]) ** 2).mean())) for scan in (plain, fixed)]
    assert rms[1] < 0.5 * rms[0]


def test_one_pattern_is_unwrapped_over_the_picture_from_its_anchor(seen):
    one = patterns(seen, RIG, fringes=(8,))
    plane = ReferencePlane(PIXEL, distance=0.5, baseline=0.2, period=1.2 * COLUMNS * PIXEL / 8)
    row, column = 5, 65
    at = Evaluation(anchor=(row, column, float(seen[0].height[row, column]) + 1e-3))
    scan = measure_fringes(one, plane, at)
    # Five times wider fringes are five times less sharp; no pixel is a fringe (19 mm) off.
    assert np.abs(error(scan, seen[0])).max() < 0.5e-3
    with pytest.raises(InputError, match="give anchor"):
        measure_fringes(one, plane)
    with pytest.raises(InputError, match="add patterns"):
        measure_fringes(one, RIG.model)


def test_the_map_is_that_of_the_road_and_not_its_mirror_image(seen):
    """A camera below the tread looks up: with travel to the right of the picture, right of travel is its top."""
    for travel, (ahead, right) in TRAVEL.items():
        # Neither a stretch nor a mirror: the turn about the height.
        assert np.linalg.det(np.array([ahead, right])) == 1.0, travel
    x, y = as_travelled(np.array([1.0]), np.array([2.0]), "up")
    assert (x[0], y[0]) == (2.0, -1.0)
    scan = measure_fringes(patterns(seen, RIG), LENSES, Evaluation(spacing=1e-3))
    gap = scan.dataset["initial_gap"]
    deep = gap.where(gap > 10e-3).mean("x").notnull()
    # The frame's y points up, and so does the road's: the deep groove at y = -12 mm stays there.
    assert float(gap["y"][deep.to_numpy()].mean()) == pytest.approx(-0.012, abs=3e-3)
    tire = scan.tire(inflation_pressure=820e3)
    assert tire.fixed_grid.dx == 1e-3


def test_three_steps_say_that_the_noise_is_not_known(seen):
    scan = measure_fringes(patterns(seen, RIG, steps=3), LENSES)
    assert any("give noise" in text for text in scan.quality.warnings)
    assert math.isnan(scan.quality.deviation)
    given = measure_fringes(patterns(seen, RIG, steps=3), LENSES, Evaluation(noise=1.0))
    assert given.quality.deviation > 0


def test_an_all_saturated_picture_leaves_nothing(seen):
    with pytest.raises(GeometryError, match="100% are saturated"):
        measure_fringes(patterns(seen, RIG.with_(gain=5000.0, ambient=400.0)), LENSES)
    with pytest.raises(GeometryError, match="change the exposure"):
        measure_fringes(patterns(seen, RIG.with_(gain=3.0)), LENSES)


def test_a_camera_that_fills_before_its_file_does_is_pointed_at(seen):
    full = [
        Pattern(one.fringes, np.minimum(one.tread, 180).astype(np.uint16), one.reference.astype(np.uint16))
        for one in patterns(seen, RIG.with_(gain=300.0))
    ]
    scan = measure_fringes(full, LENSES, Evaluation(shadow=0.0005))
    assert any("give saturation = 180" in text for text in scan.quality.warnings)


# Files ----------------------------------------------------------------------------------------------------------

CASE = """spacing = "1 mm"
[[patterns]]
fringes = 1
tread = "tread_1.npy"
reference = "plane_1.npy"
[[patterns]]
fringes = 6
tread = "tread_6_*.png"
reference = "plane_6_*.png"
steps = 4
[[patterns]]
fringes = 40
tread = ["a1.tif", "a2.tif", "a3.tif", "a4.tif"]
reference = ["b1.tif", "b2.tif", "b3.tif", "b4.tif"]
shifts = ["0 deg", "90 deg", "180 deg", "270 deg"]
[reference_plane]
pixel = "0.5 mm"
distance = "0.5 m"
baseline = "20 cm"
period = "1.95 mm"
"""


@pytest.fixture
def folder(seen, tmp_path):
    for one in patterns(seen, RIG, steps=4):
        for name, letter, stack in (("tread", "a", one.tread), ("plane", "b", one.reference)):
            if one.fringes == 1:
                np.save(tmp_path / f"{name}_1.npy", stack)
            for step, grey in enumerate(stack, 1):
                if one.fringes == 6:
                    Image.fromarray(grey).save(tmp_path / f"{name}_6_{step}.png")
                elif one.fringes == 40:
                    Image.fromarray(grey).save(tmp_path / f"{letter}{step}.tif")
    (tmp_path / "fringes.toml").write_text(CASE, encoding="utf-8")
    return tmp_path


def test_the_command_writes_a_height_map_that_a_tire_is_made_of(folder, seen):
    file = folder / "tread.nc"
    args = ["scan", str(folder / "fringes.toml"), "-o", str(file), "-q"]
    done = CliRunner().invoke(app, args)
    assert done.exit_code == 0, done.output
    assert "pixels with a height" in done.output
    scan = read_fringes(folder / "fringes.toml")
    assert float(np.sqrt((error(scan, seen[0]) ** 2).mean())) < 0.03e-3
    written = xr.load_dataset(file, engine="h5netcdf")
    assert written["gap_deviation"].attrs["units"] == "m"
    tire = tl.Tire.from_height_map(file)
    assert np.array_equal(tire.surface.gap, scan.tire().surface.gap, equal_nan=True)
    refused = CliRunner().invoke(app, [*args, "--spacing", "2 mm"])
    assert refused.exit_code == 2
    assert "--spacing belongs to a scan of a tire" in " ".join(refused.output.split())


@pytest.mark.slow
def test_the_command_draws_what_was_done(folder):
    args = ["scan", str(folder / "fringes.toml"), "--figure", str(folder / "seen.png"), "-q"]
    done = CliRunner().invoke(app, args)
    assert done.exit_code == 0, done.output
    assert Image.open(folder / "seen.png").width > 500
    mesh = CliRunner().invoke(app, ["scan", str(tl.example_mesh()), "--figure", str(folder / "mesh.png"), "-q"])
    assert mesh.exit_code == 0, mesh.output
    assert Image.open(folder / "mesh.png").width > 500


def bomb(path, side=60_000):
    """A PNG whose head says so many pixels, and which holds next to nothing."""
    head = b"IHDR" + struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    data = b"IDAT" + zlib.compress(b"\0" * 100)
    parts = [
        struct.pack(">I", len(part) - 4) + part + struct.pack(">I", zlib.crc32(part))
        for part in (head, data, b"IEND")
    ]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(parts))


def small(path):
    Image.fromarray(np.zeros((4, 5), np.uint8)).save(path)


def colours(path):
    Image.fromarray(np.random.default_rng(0).integers(0, 255, (ROWS, COLUMNS, 3), dtype=np.uint8)).save(path)


@pytest.mark.parametrize(
    ("file", "change", "said"),
    [
        ("tread_6_2.png", bomb, "3600000000 pixels"),
        ("tread_6_2.png", lambda path: bomb(path, 6000), "36000000 pixels, more than 25000000"),
        ("tread_6_2.png", small, "5 x 4 pixels"),
        ("tread_6_2.png", colours, "colour picture"),
        ("tread_6_2.png", lambda path: path.unlink(), "step 2 of"),
        ("tread_6_4.png", lambda path: path.unlink(), "steps = 4"),
        ("tread_6_2.png", lambda path: path.write_bytes(path.read_bytes()[:900]), "cannot read"),
        ("tread_6_2.png", lambda path: path.write_text("no picture"), "cannot read"),
        ("a3.tif", lambda path: path.unlink(), "no picture"),
        ("a3.tif", lambda path: path.write_bytes(path.read_bytes()[:700]), "cannot read"),
        ("tread_1.npy", lambda path: path.write_bytes(path.read_bytes()[:700]), "cannot read"),
        ("tread_1.npy", lambda path: np.save(path, np.zeros((2, ROWS, COLUMNS))), "2 pictures of 130 x 110"),
        ("tread_1.npy", lambda path: np.save(path, np.full((4, ROWS, COLUMNS), np.nan)), "no finite numbers"),
        ("tread_1.npy", lambda path: np.save(path, np.array([["a"]])), "must hold numbers"),
        ("plane_1.npy", lambda path: np.save(path, np.zeros((4, 3, 3), np.uint8)), "the same steps"),
    ],
)
def test_bad_pictures_are_refused_in_one_sentence(folder, file, change, said):
    change(folder / file)
    with pytest.raises(InputError) as refused:
        read_fringes(folder / "fringes.toml")
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[reference_plane]", "[projectors]", "did you mean"),
        ('period = "1.95 mm"\n', "", "together"),
        ('pixel = "0.5 mm"', 'pixel = "-1 mm"', "pixel must be a positive"),
        ('spacing = "1 mm"', 'spacing = "0.1 mm"', "finer than the pixels"),
        ('spacing = "1 mm"', "gamma = 9", "gamma must lie between"),
        ('spacing = "1 mm"', 'travel = "north"', "travel"),
        ('"270 deg"', '"180 deg", "190 deg"', "4 pictures where steps = 5"),
        ('["0 deg", "90 deg", "180 deg", "270 deg"]', '["0 deg", "180 deg", "0 deg", "180 deg"]', "leave the phase"),
    ],
)
def test_bad_files_are_refused_in_one_sentence(folder, old, new, said):
    assert old in CASE
    (folder / "fringes.toml").write_text(CASE.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError) as refused:
        read_fringes(folder / "fringes.toml")
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_matrices_that_no_lens_has_are_refused():
    with pytest.raises(InputError, match="3 rows of 4"):
        CameraProjector(((1.0,),), RIG.model.projector, 1000.0)
    with pytest.raises(InputError, match="singular"):
        CameraProjector(((0.0,) * 4,) * 3, RIG.model.projector, 1000.0)
    with pytest.raises(InputError, match="are in one place"):
        CameraProjector(RIG.model.camera, RIG.model.camera, 1000.0)
    with pytest.raises(InputError, match="3 to 64 pictures"):
        solve_steps(np.zeros((2, 3, 3)))


@pytest.mark.parametrize("lengths", [{"distance": 5e-324}, {"baseline": 1e300}, {"period": 1e-12}])
def test_lengths_that_no_rig_has_are_refused(lengths):
    with pytest.raises(InputError, match="no rig has one beyond"):
        ReferencePlane(PIXEL, **({"distance": 0.5, "baseline": 0.2, "period": 4e-3} | lengths))
