"""Lines of a profile laser: a wheel that turned before it, a piece that it passed over, and what is refused."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from laser_lines import AXLE, TREAD, profiles, write_points, write_rows
from treadload.cli import app
from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.tire import Tire
from treadload.tire.scan.laser import piece_of_lines, wheel_of_lines

ROAD = Grid.centred(0.12, 0.18, 3e-3)
EXACT = TREAD.gap(ROAD.x, ROAD.y)
# Cells that a wall of a groove goes through.
WALLS = np.array([np.abs(np.abs(ROAD.y - g.centre) - 0.5 * g.width) < 4e-3 for g in TREAD.grooves]).any(axis=0)
WHEEL = 'encoder = "deg"\naxle = "310 mm"'
SMALL = {"lines": 400, "columns": 161}


def rms(tire):
    error = (tire.height_map(ROAD) - EXACT)[~WALLS]
    assert np.isfinite(error).all()
    return float(np.sqrt(np.mean(error**2)))


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [360, 120])
def test_a_wheel_comes_back_from_lines_with_jitter_dropouts_and_tilt(tmp_path, degrees):
    """0.1 mm of noise, encoder readings a fifth of a step off, 3 % of the points missing, a tilt of 1.1°."""
    encoder, x, z = profiles(degrees=degrees, lines=int(2.5 * degrees), tilt=0.02)
    about = f'{WHEEL}\ntilt = "0.02 rad"\ninvalid = [-999]'
    tire = Tire.from_scan(write_rows(tmp_path, encoder, x, z, about, mark=";", missing="-999"))
    quality = tire.quality
    assert quality.crown_radius == pytest.approx(0.5, abs=0.1e-3)
    assert quality.noise == pytest.approx(0.1e-3, rel=0.2)
    assert [g.depth for g in quality.grooves] == pytest.approx([12e-3] * 3, abs=0.2e-3)
    assert [g.centre for g in quality.grooves] == pytest.approx([g.centre for g in TREAD.grooves], abs=0.2e-3)
    assert quality.coverage > 0.995
    # Three grooves, 12 mm wide at the top and 3 mm down 2 x 3 mm tan 8° narrower, in a tread of 200 mm. The shoulders
    # that the laser saw beside it, 15 mm each, rise above the drop of 30 mm for all of them.
    grooved = 3 * (12 - 2 * 3 * math.tan(math.radians(8)))
    assert quality.land_ratio == pytest.approx(1 - grooved / 230, abs=0.02)
    # The noise of the laser, as cells of 3 mm hold some ten points and take one ray each; 0.075 mm was measured.
    assert rms(tire) < 0.1e-3


@pytest.mark.slow
def test_a_tilt_that_is_not_told_stays_in_the_tread(tmp_path):
    encoder, x, z = profiles(**SMALL, tilt=0.02)
    told, silent = (
        Tire.from_scan(write_rows(tmp_path, encoder, x, z, about, name=name))
        for about, name in ((f"{WHEEL}\ntilt = 0.02", "told.csv"), (WHEEL, "silent.csv"))
    )
    assert rms(told) < 0.12e-3
    # A tilt of 0.02 makes a cone: 0.02 of the width over the tread.
    low, high = (np.interp(at, silent.surface.across, silent.surface.meridian) for at in (-0.08, 0.08))
    assert low - high == pytest.approx(0.02 * 0.16, abs=0.3e-3)


def test_points_and_rows_are_the_same_wheel(tmp_path):
    encoder, x, z = profiles(**SMALL)
    rows = wheel_of_lines(write_rows(tmp_path, encoder, x, z, WHEEL))[0]
    points = wheel_of_lines(write_points(tmp_path, encoder, x, z, WHEEL))[0]
    np.testing.assert_allclose(points, rows, atol=1e-6)


@pytest.mark.parametrize("way", ["forward", "backward", "left", "distance", "counts"])
def test_what_leads_on_the_wheel_leads_on_the_road(tmp_path, way):
    """A knob 10° on and 40 mm to the right stands there, however the encoder, x and z were counted."""
    at = (math.radians(10), 0.04)
    encoder, x, z = profiles(**SMALL, noise=0.0, jitter=0.0, dropouts=0.0, bump=at)
    about, unit, ahead = WHEEL, 180 / math.pi, 0.0
    if way == "backward":
        encoder, about = -encoder, f"{WHEEL}\nbackward = true"
    elif way == "left":
        x, z, about = -x[::-1], z[:, ::-1], f"{WHEEL}\nleft = true"
    elif way == "distance":
        # From a laser whose zero is 200 mm from the axle beyond the tread.
        z, about = 0.4 - z, 'encoder = "deg"\naxle = "710 mm"\ntowards = "axle"'
    elif way == "counts":
        # A counter that goes from -16 384 to 16 384 and begins again amid the turn.
        unit, about = 32768 / (2 * math.pi), 'encoder = "count"\ncounts_per_turn = 32768\naxle = "310 mm"'
        ahead = -2.0
        encoder = (encoder + ahead + math.pi) % (2 * math.pi) - math.pi
    path = write_rows(tmp_path, encoder, x, z, about, unit=unit)
    grid = Grid.centred(0.2, 0.16, 2e-3)
    gap = Tire.from_scan(path, outliers="keep", rotation=at[0] + ahead).height_map(grid)
    row, column = np.unravel_index(np.nanargmin(gap), gap.shape)
    assert abs(grid.x[column]) < 6e-3
    assert grid.y[row] == pytest.approx(0.04, abs=5e-3)


@pytest.mark.slow
def test_several_turns_are_averaged_and_a_standing_wheel_is_one_line(tmp_path):
    one = profiles(**SMALL, dropouts=0.0)
    more = [profiles(**SMALL, dropouts=0.0, seed=seed) for seed in (2, 3, 4)]
    encoder = np.concatenate([one[0], *(each[0] + 2 * math.pi * (k + 1) for k, each in enumerate(more))])
    z = np.concatenate([one[2], *(each[2] for each in more)])
    single, several = (
        Tire.from_scan(write_rows(tmp_path, turn, one[1], each, WHEEL)).quality.noise
        for turn, each in ((one[0], one[2]), (encoder, z))
    )
    assert several == pytest.approx(single / 2, rel=0.2)
    stood = np.r_[one[0], np.full(50, one[0][-1])], np.concatenate([one[2], np.repeat(one[2][-1:], 50, 0)])
    assert len(wheel_of_lines(write_rows(tmp_path, stood[0], one[1], stood[1], WHEEL))[0]) == pytest.approx(
        400 * 161, rel=0.1
    )


def piece(tmp_path, *, about="", tilt=(0.01, -0.02), dropouts=0.03):
    """A block of 60 by 80 mm with a groove across travel, 10 mm wide and 8 mm deep, under tilted lines."""
    random = np.random.default_rng(3)
    way, x = np.arange(0, 0.06, 0.4e-3), np.linspace(-0.04, 0.04, 161)
    x_at, y_at = way[:, None] - 0.03, x[None]
    z = 5e-3 - 8e-3 * (np.abs(x_at - 0.01) < 5e-3) + tilt[0] * x_at + tilt[1] * y_at
    z = z + random.normal(scale=0.03e-3, size=z.shape)
    z[random.random(z.shape) < dropouts] = np.nan
    way = way + random.normal(scale=0.05e-3, size=way.shape)
    return write_rows(tmp_path, way, x, z, f'encoder = "mm"\n{about}', unit=1e3)


def test_a_piece_is_levelled_and_keeps_its_groove(tmp_path):
    found = piece_of_lines(piece(tmp_path, about='spacing = "1 mm"'))
    assert found.slopes == pytest.approx((0.01, -0.02), abs=2e-4)
    assert found.dropouts == pytest.approx(0.03, abs=0.005)
    gap = found.dataset.initial_gap
    assert gap.attrs["units"] == "m"
    assert float(gap.sel(x=0.01, method="nearest").median()) == pytest.approx(8e-3, abs=0.15e-3)
    tops = gap.sel(x=slice(-0.029, 0.003))
    assert float(tops.std()) < 0.03e-3
    assert float(tops.max()) < 0.25e-3
    tire = Tire.from_height_map(gap, inflation_pressure=800e3)
    assert np.isfinite(tire.height_map(tire.fixed_grid)).all()
    assert "by +0.57° along travel and -1.15° across" in found.summary()


def test_the_command_takes_wheels_pieces_and_fringes_apart(tmp_path):
    run = CliRunner()
    encoder, x, z = profiles(**SMALL)
    wheel = write_rows(tmp_path, encoder, x, z, WHEEL, name="wheel.csv")
    done = run.invoke(app, ["scan", str(wheel), "--smooth", "auto", "-q"])
    assert done.exit_code == 0, done.output
    assert "crown radius 500.0 mm" in done.output
    made, drawn = tmp_path / "tread.nc", tmp_path / "piece.png"
    done = run.invoke(app, ["scan", str(piece(tmp_path)), "-o", str(made), "--figure", str(drawn), "-q"])
    assert done.exit_code == 0, done.output
    assert "150, 3.1% of their points not measured" in done.output
    assert drawn.read_bytes().startswith(b"\x89PNG")
    assert tl.Tire.from_height_map(made, inflation_pressure=8e5).fixed_grid is not None
    done = run.invoke(app, ["scan", str(piece(tmp_path)), "--units", "mm"])
    assert done.exit_code == 2
    assert "--units belongs to a scan of a tire" in " ".join(done.output.split())
    (tmp_path / "fringes.toml").write_text("[[patterns]]\n")
    done = run.invoke(app, ["scan", str(tmp_path / "fringes.toml")])
    assert done.exit_code == 2
    assert "patterns" in done.output


def test_a_case_names_the_lines(tmp_path):
    encoder, x, z = profiles(**SMALL)
    write_rows(tmp_path, encoder, x, z, WHEEL)
    case = tl.Case.from_text(
        '[tire]\nscan = "lines.toml"\ninflation_pressure = "8 bar"\n[[pavement.layers]]\n'
        'material = { kind = "elastic", modulus = "5 GPa", poisson = 0.35 }\n'
        '[rolling]\nnormal_load = "20 kN"\nfriction = 0.5\n[response]\ndepths = ["0 mm"]\n',
        folder=tmp_path,
    )
    assert case.build_tire().outer_radius == pytest.approx(0.5, abs=0.2e-3)


LINE = "\n".join(["e,-10,0,10"] + [f"{k},1,2,3" for k in range(20)])


@pytest.mark.parametrize(
    ("about", "text", "said"),
    [
        ('encoder = "deg"', LINE, "needs axle"),
        ('encoder = "mm"\naxle = "1 m"', LINE, "axle is of a wheel"),
        (f'{WHEEL}\nspacing = "1 mm"', LINE, "spacing is of the map of a piece"),
        ('encoder = "count"\naxle = "310 mm"', LINE, "needs counts_per_turn, or count"),
        (f"{WHEEL}\ncounts_per_turn = 100", LINE, "no other encoder has them"),
        ('encoder = "count"\ncounts_per_turn = 9\ncount = "1 mm"\naxle = "1 m"', LINE, "not both"),
        ('encoder = "quux"', LINE, "no unit such as mm or m"),
        ('encoder = "deg"\naxle = "-1 mm"', LINE, "axle must be more than 0"),
        (f"{WHEEL}\ntilt = 1.0", LINE, "tilt must lie within"),
        (f"{WHEEL}\nmaker = 1", LINE, "maker"),
        (WHEEL, LINE.replace("5,1", "5"), "unlike length"),
        (WHEEL, LINE.replace("5,1", "5,x"), "no number"),
        (WHEEL, LINE.replace("5,1", "5,inf"), "infinite"),
        (WHEEL, LINE.replace("\n5,", "\n,"), "without a reading of the encoder"),
        (WHEEL, LINE.replace("-10,0,10", "a,b,c"), "places x of the columns"),
        (WHEEL, LINE.replace("-10,0,10", "0,10,0"), "rise, or fall, throughout"),
        (f"{WHEEL}\ninvalid = [1, 2, 3]", LINE, "has no height"),
        (WHEEL, LINE.replace("5,1", "5,1e300"), "beyond all that a laser measures"),
        (WHEEL, "e,-10,0,10\n", "the least"),
        (WHEEL, "\0" * 200, "least"),
    ],
)
def test_what_is_no_measurement_is_refused_in_a_sentence(tmp_path, about, text, said):
    (tmp_path / "lines.csv").write_text(text)
    path = tmp_path / "lines.toml"
    path.write_text(f'[laser]\nfile = "lines.csv"\nlayout = "rows"\nx = "mm"\nz = "mm"\n{about}\n')
    with pytest.raises((InputError, GeometryError)) as told:
        Tire.from_scan(path)
    assert said in str(told.value)
    assert "\n" not in str(told.value)


def test_wheels_and_pieces_are_not_mistaken(tmp_path):
    encoder, x, z = profiles(**SMALL)
    with pytest.raises(InputError, match="turned before its laser"):
        piece_of_lines(write_rows(tmp_path, encoder, x, z, WHEEL))
    with pytest.raises(InputError, match="moved over a piece of tread"):
        Tire.from_scan(piece(tmp_path))
    with pytest.raises(GeometryError, match="1 lines at different readings"):
        wheel_of_lines(write_rows(tmp_path, 0 * encoder, x, z, WHEEL))
    (tmp_path / "lines.toml").write_text("[laser]\n[other]\n")
    with pytest.raises(InputError, match="nothing besides but a title"):
        Tire.from_scan(tmp_path / "lines.toml")
    assert AXLE == 0.31
