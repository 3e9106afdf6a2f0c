"""Measured footprints from files: what is read, in which unit, and what is refused in a sentence."""

import numpy as np
import pytest
from PIL import Image

import treadload as tl
from footprints import ribbed, sensed, tekscan
from packages import build
from treadload.footprint import Footprint, read_footprint
from treadload.footprint.measures import measure

# One pound-force per square inch and one kilogram-force per square centimetre, Pa (BIPM, SI brochure, table 8).
PSI, KGF_CM2 = 6894.757293168, 98066.5
MAP = np.array([[0, 300, 500, 0], [200, 400, 600, 100], [0, 350, 550, 0.5]])


def written(tmp_path, text, name="print.asf"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode("utf-8"))
    return path


def said(*args, **kwargs):
    with pytest.raises(tl.InputError) as caught:
        read_footprint(*args, **kwargs)
    return str(caught.value)


@pytest.mark.parametrize(
    ("unit", "pascals"),
    [("kPa", 1e3), ("KPa", 1e3), ("MPa", 1e6), ("PSI", PSI), ("psi", PSI), ("kg/cm2", KGF_CM2), ("mmHg", 133.322387),
     ("N/cm^2", 1e4), ("bar", 1e5), ("kgf/cm²", KGF_CM2)],
)  # fmt: skip
def test_tekscan_in_every_unit(tmp_path, unit, pascals):
    found = read_footprint(written(tmp_path, tekscan([MAP], units=unit)))
    np.testing.assert_allclose(found.pressure, MAP * pascals, rtol=1e-6)
    assert found.pitch == (5e-3, 5e-3)
    assert found.normal_load == pytest.approx(MAP.sum() * pascals * 25e-6, rel=1e-6)
    assert f"values in {unit}" in found.source


@pytest.mark.parametrize(
    ("written_as", "metres"),
    [("0.5 cm", 5e-3), ("5 mm", 5e-3), ("5 milimeters", 5e-3), ("5 millimeters", 5e-3), ("0.005 meters", 5e-3),
     ("0.2 inches", 5.08e-3), ("0,5 cm", 5e-3), ("0.5 centimeters", 5e-3)],
)  # fmt: skip
def test_spacing_is_read_with_its_unit(tmp_path, written_as, metres):
    assert read_footprint(written(tmp_path, tekscan([MAP], pitch=written_as))).pitch == pytest.approx(
        (metres, metres)
    )


def test_what_a_real_header_says_of_its_calibration(tmp_path):
    """Sensor 4010N of I-Scan 5.90I: 0.00660538 * 255 ** 1.25278 = 6.836, its SATURATION_PRESSURE in MPa."""
    lines = ["SCALE_FACTOR 0.00660538", "EXPONENT 1.25278", "SATURATION_PRESSURE 6.83538 MPa", "NOISE_THRESHOLD 3"]
    raw = np.array([[0, 2, 40], [3, 255, 80], [10, 0, 120.0]])
    found = read_footprint(written(tmp_path, tekscan([raw], units="RAW", pitch="0.2 cm", lines=lines)))
    told = np.where(raw < 3, 0, 0.00660538e6 * raw**1.25278)
    np.testing.assert_allclose(found.pressure, told, rtol=1e-9)
    assert found.saturation == pytest.approx(6.83538e6, rel=2e-4)
    assert found.threshold == pytest.approx(0.00660538e6 * 3**1.25278)
    assert [text for text in found.warnings if "1 of 6 loaded sensels read the saturation" in text]
    # The same data in MPa: the threshold in counts is still one of pressure.
    lines[2] = "SATURATION_PRESSURE 6835.38 kPa"
    lines[0] = "SCALE_FACTOR 6.60538"
    found = read_footprint(written(tmp_path, tekscan([told / 1e6], units="MPa", pitch="0.2 cm", lines=lines)))
    np.testing.assert_allclose(found.pressure, told, rtol=1e-5)
    assert found.threshold == pytest.approx(6605.38 * 3**1.25278)


def test_counts_are_calibrated_or_refused(tmp_path):
    raw = np.array([[0, 20, 40], [30, 200, 80]])
    path = written(tmp_path, tekscan([raw], units="RAW"))
    assert "its values have no unit" in said(path)
    one = read_footprint(path, calibration="3.2 kPa")
    np.testing.assert_allclose(one.pressure, 3200 * raw)
    known = read_footprint(path, load="2 kN")
    assert known.normal_load == pytest.approx(2000)
    np.testing.assert_allclose(known.pressure / known.pressure.max(), raw / 200)
    # Full scale of 255 counts goes with the calibration.
    assert one.saturation == pytest.approx(3200 * 255)
    assert known.saturation == pytest.approx(known.pressure.max() * 255 / 200)
    assert "calibration= is for counts" in said(written(tmp_path, tekscan([MAP])), calibration=3.2)


def test_frames_are_chosen(tmp_path):
    frames = [MAP, 2 * MAP, 0.5 * MAP]
    path = written(tmp_path, tekscan(frames, movie=',0.01,"0:00:00.1","Raw Sum=12"'), "movie.csv")
    np.testing.assert_allclose(read_footprint(path).pressure, 2e3 * MAP)
    assert "frame 2 of 3, which carries most" in read_footprint(path).source
    np.testing.assert_allclose(read_footprint(path, frame=3).pressure, 500 * MAP)
    np.testing.assert_allclose(read_footprint(path, frame="mean").pressure, 3.5e3 / 3 * MAP)
    assert 'frame must be "peak", "mean" or one of 1 to 3' in said(path, frame=4)
    holes = [np.where(MAP == 600, np.nan, MAP), MAP]
    mean = read_footprint(written(tmp_path, tekscan(holes)), frame="mean")
    # A sensel counts in the frames in which it is there.
    np.testing.assert_allclose(mean.pressure, 1e3 * MAP)


def test_cells_without_a_sensel_are_no_zeros(tmp_path):
    found = read_footprint(written(tmp_path, tekscan([np.where(MAP == 0, np.nan, MAP)])))
    assert found.missing.sum() == 3
    assert not found.sensels[0, 0]
    assert found.normal_load == pytest.approx(1e3 * MAP.sum() * 25e-6)
    assert read_footprint(written(tmp_path, tekscan([MAP]))).missing is None


def test_european_decimals_and_semicolons(tmp_path):
    text = tekscan([MAP + 0.25])
    head, _, body = text.partition("ASCII_DATA")
    body = body.replace(",", ";").replace(".", ",")
    found = read_footprint(written(tmp_path, f"{head}ASCII_DATA{body}"))
    np.testing.assert_allclose(found.pressure, 1e3 * (MAP + 0.25))


def test_slow_and_fast_reading_agree(tmp_path):
    """Blanks and signs go the way of the reader of tables, which tells lines; numbers alone go a faster one."""
    plain, odd = tekscan([MAP]), tekscan([MAP]).replace("300,", "+3.0e2 ,")
    np.testing.assert_array_equal(
        read_footprint(written(tmp_path, plain)).pressure, read_footprint(written(tmp_path, odd, "b.asf")).pressure
    )


def test_travel_and_side_of_the_sensor(tmp_path):
    path = written(tmp_path, tekscan([MAP], pitch="5 mm", lines=["ROW_SPACING 7 mm"]))
    page = 1e3 * MAP
    assert read_footprint(path).pitch == (5e-3, 7e-3)
    up = read_footprint(path, travel="up")
    assert up.pitch == (7e-3, 5e-3)
    # Travel up the page: the last row is hindmost, the first column is leftmost.
    np.testing.assert_array_equal(up.pressure, page[::-1].T)
    np.testing.assert_array_equal(read_footprint(path, travel="left").pressure, page[::-1, ::-1])
    np.testing.assert_array_equal(read_footprint(path, travel="down").pressure, page.T[::-1])
    np.testing.assert_array_equal(read_footprint(path, seen_from="below").pressure, page[::-1])
    assert "travel up on the page" in up.source


def test_a_matrix_needs_its_unit_and_spacing(tmp_path):
    path = written(tmp_path, "0;300,5;500\n200;400;600\n", "m.csv")
    assert "pressure names no unit" in said(path, spacing="5 mm")
    assert 'needs spacing="5 mm"' in said(path, units="kPa")
    found = read_footprint(path, units="kg/cm2", spacing=("5 mm", "6 mm"))
    np.testing.assert_allclose(found.pressure, KGF_CM2 * np.array([[0, 300.5, 500], [200, 400, 600]]))
    assert found.pitch == (5e-3, 6e-3)
    assert "pressure in kg/cm2" in found.source
    # Under a known load no unit is needed.
    assert read_footprint(path, spacing=5e-3, load="1 kN").normal_load == pytest.approx(1000)
    assert read_footprint(path, spacing=5e-3, calibration="1 kPa").peak_pressure == pytest.approx(600e3)
    assert "'lb' is not a unit of pressure" in said(path, spacing=5e-3, units="lb")
    assert "'mPa' is 0.001 Pa, which no footprint is counted in; did you mean MPa" in said(
        path, spacing=5e-3, units="mPa"
    )


def test_a_table_of_three_directions(tmp_path):
    rows = ["x [mm],y [mm],pressure [kPa],traction_x [kPa],traction_y [kPa]"]
    rows += [f"{5 * i},{5 * j - 10},{100 + i + 10 * j},{-20 - i},{3 * j}" for i in range(3) for j in range(4)]
    path = written(tmp_path, "\n".join(rows), "sim.csv")
    found = read_footprint(path)
    assert found.grid.shape == (4, 3)
    assert (found.grid.x0, found.grid.y0) == pytest.approx((0.0, -0.01))
    np.testing.assert_allclose(found.load.traction_x[0], [-20e3, -21e3, -22e3])
    on_tire = read_footprint(path, shear_on="tire")
    np.testing.assert_allclose(on_tire.load.array[1:], -found.load.array[1:])
    short = written(tmp_path, "\n".join(["x [mm],y [mm],p [kPa],qx [kPa],qy [kPa]", *rows[1:]]), "short.csv")
    np.testing.assert_array_equal(read_footprint(short).load.array, found.load.array)
    assert "has axes of its own" in said(path, travel="up")
    assert "x names no unit" in said(written(tmp_path, "\n".join(["x,y,pressure [kPa]", "0,0,1"]), "t.csv"))


def test_a_saved_contact_is_a_footprint(tmp_path):
    load = ribbed()
    path = tl.save_results(Footprint(load), tmp_path / "one.nc")
    np.testing.assert_allclose(read_footprint(path).pressure, load.pressure)


PAIRS = [("#000000", 0), ("#0000ff", "200 kPa"), ("#00ff00", "500 kPa"), ("#ff0000", "1000 kPa")]


def picture(tmp_path, pixels, name="print.png"):
    path = tmp_path / name
    Image.fromarray(np.asarray(pixels, dtype=np.uint8)).save(path)
    return path


def test_a_picture_by_its_colours(tmp_path):
    pixels = np.zeros((3, 4, 3))
    pixels[1, 1], pixels[1, 2], pixels[0, 3] = (0, 0, 255), (128, 127, 0), (255, 0, 0)
    found = read_footprint(picture(tmp_path, pixels), colours=PAIRS, spacing="2 mm")
    # Half way from green to red; 255 steps leave half of one.
    wanted = np.zeros((3, 4))
    wanted[1, 1], wanted[1, 2], wanted[0, 3] = 200e3, 750e3, 1000e3
    np.testing.assert_allclose(found.pressure, wanted, atol=0.5 / 255 * 500e3)
    assert found.saturation == 1000e3
    pixels[2, 0] = (255, 0, 255)
    path = picture(tmp_path, pixels)
    told = said(path, colours=PAIRS, spacing="2 mm")
    assert "1 of 12 pixels (8.33 %)" in told
    assert "#ff00ff in row 3, column 1" in told
    assert read_footprint(path, colours=PAIRS, spacing="2 mm", unclear="missing").missing.sum() == 1
    assert "size of a pixel" in said(path, colours=PAIRS)
    assert "on the scale or fits two places" in said(path, colours=PAIRS, spacing=1e-3, steps=True)


@pytest.mark.parametrize("name", ["jet", "viridis", "gray", "hot"])
def test_a_picture_by_the_name_of_its_colour_map(tmp_path, name):
    import matplotlib as mpl

    values = np.linspace(0, 1, 300).reshape(15, 20)
    path = picture(tmp_path, np.round(255 * mpl.colormaps[name](values)[..., :3]))
    found = read_footprint(path, colours=name, scale=("0 kPa", "1200 kPa"), spacing="1 mm")
    # 256 colours of a map and 255 of a channel; jet shows one blue from 0.110 to 0.127, whose middle is taken.
    np.testing.assert_allclose(found.pressure, 1200e3 * values, atol=1200e3 * 2.7 / 255)


def test_a_picture_with_its_colour_bar(tmp_path):
    chart = np.zeros((20, 30, 3))
    chart[..., 0] = np.linspace(0, 240, 30)
    bar = np.zeros((20, 4, 3))
    bar[..., 0] = np.linspace(240, 0, 20)[:, None]
    path = picture(tmp_path, np.concatenate([chart, bar], axis=1))
    found = read_footprint(path, bar=(30, 0, 34, 20), crop=(0, 0, 30, 20), scale=(0, 8e5), spacing=1e-3)
    np.testing.assert_allclose(found.pressure[3], np.linspace(0, 8e5, 30), atol=8e5 / 240)
    assert "crop=, the box of the map" in said(path, bar=(30, 0, 34, 20), scale=(0, 8e5), spacing=1e-3)


def test_a_colour_that_means_two_pressures_is_refused(tmp_path):
    pixels = np.zeros((2, 2, 3))
    pixels[...] = (255, 0, 0)
    path = picture(tmp_path, pixels)
    ring = [("#ff0000", 1e5), ("#00ff00", 5e5), ("#0000ff", 8e5), ("#ff0000", 1e6)]
    assert "4 of 4 pixels (100 %)" in said(path, colours=ring, spacing=1e-3)
    assert read_footprint(path, colours=ring[:3], spacing=1e-3).peak_pressure == 1e5
    assert "no colour map 'jett'; did you mean 'jet'?" in said(path, colours="jett", scale=(0, 1e6), spacing=1e-3)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (tekscan([MAP], lines=["ROWS 4"]), "frame 1 has 3 rows, the header has ROWS 4"),
        (tekscan([MAP], lines=["COLS 5"]), "line 16: 4 values, the header has COLS 5"),
        (tekscan([MAP], lines=["ROWS 0"]), "frame 1 has 3 rows of 4 values; export a sensor with rows"),
        (tekscan([np.zeros((0, 4))], lines=["ROWS 0"]), "frame 1 has 0 rows"),
        (tekscan([MAP], lines=["END_FRAME 9"]), "announce 9 frames, the file holds 1"),
        (tekscan([MAP], lines=["SENSEL_AREA 40 mm2"]), "is 40 mm2, and ROW_SPACING times COL_SPACING 25 mm2"),
        (tekscan([MAP], lines=["SATURATION_PRESSURE 0.5 MPa"]), "the data hold 1.2 times as much; UNITS is kPa"),
        (tekscan([MAP], units="RAW"), "counts of 0 to 255, and frame 1 holds 600; one is wrong"),
        (tekscan([MAP / 10], units="RAW", movie=',"Raw Sum=999"'), "sums up to 300.05 and has Raw Sum=999"),
        (tekscan([MAP / 10], units="RAW", lines=["SCALE_FACTOR 1", "EXPONENT 1", "SATURATION_PRESSURE 9 MPa"]),
         "SATURATION_PRESSURE is 9 MPa, and SCALE_FACTOR * 255 ** EXPONENT 255; one of them is wrong"),
        (tekscan([MAP, MAP[:2]], without=["ROWS"]), "frame 2 has 2 x 4 values, the first frame 3 x 4"),
        (tekscan([MAP], units="furlong"), "UNITS is wrong: 'furlong' is not a unit of pressure"),
        (tekscan([MAP], without=["UNITS"]), "its values have no unit"),
        (tekscan([MAP], pitch="5"), "ROW_SPACING is '5', which needs a number and a unit"),
        (tekscan([MAP], without=["ROW_SPACING"]), "does not give the spacing of its sensels"),
        (tekscan([0 * MAP]), "nothing presses, no value lies above 0 Pa"),
        (tekscan([-MAP]), "row 2, column 3 has a pressure of -600000 Pa; compression counts positive"),
        (tekscan([np.where(MAP > 0, 500, 0)], lines=["SATURATION_PRESSURE 500 kPa"]),
         "all 9 loaded sensels read the saturation of 500 kPa"),
        (tekscan([MAP]).replace("300", "3O0"), "frame 1: the value is '3O0', not a number"),
        (tekscan([MAP]).replace("300", "030"), "with a zero in front"),
        (tekscan([MAP]).replace("Frame 1\r\n", ""), "values come before the first line Frame"),
        (tekscan([MAP]).partition("ASCII_DATA")[0], "no line ASCII_DATA"),
        (tekscan([MAP]).replace("300", "1e999"), "is infinite"),
    ],
)  # fmt: skip
def test_headers_and_data_at_odds_are_refused(tmp_path, text, words):
    told = said(written(tmp_path, text))
    assert words in told
    assert len(told.splitlines()) == 1


def test_closed_formats_and_files_that_are_none(tmp_path):
    assert "closed; export it from I-Scan as ASCII" in said(written(tmp_path, "x", "a.fsx"))
    assert "entry point 'xsn' of treadload.footprints" in said(written(tmp_path, "x", "a.xsn"))
    assert "export a plain matrix" in said(written(tmp_path, "x", "a.xsn"))
    assert "there is no file" in said(tmp_path / "none.csv")
    wide = picture(tmp_path, np.zeros((1, 4_000_001, 3)), "wide.png")
    assert "has 4000001 x 1 pixels, more than 4e+06; make it smaller" in said(wide, colours=PAIRS, spacing=1)
    assert "as a picture" in said(written(tmp_path, "no picture", "a.png"), colours=PAIRS, spacing=1)
    assert "knows no option 'colors'; did you mean 'colours'" in said(written(tmp_path, b"", "a.png"), colors="jet")
    assert "travel must be one of" in said(written(tmp_path, tekscan([MAP])), travel="north")


def test_dead_and_stuck_sensels_are_named_and_filled_when_asked(tmp_path):
    values = np.full((9, 9), 400.0)
    values[[0, 1, -1, -2], :], values[:, [0, 1, -1, -2]] = 0, 0
    values[4, 5] = 0
    values[1, 1] = 0
    lonely = np.pad(values, ((0, 0), (0, 4)))
    lonely[4, 11] = 90
    path = written(tmp_path, tekscan([lonely]))
    found = read_footprint(path)
    assert any("dead sensels, which read nothing amid loaded ones: row 5 column 6; left" in t for t in found.warnings)
    assert any("pressure amid empty ones, as stuck ones do: row 5 column 12" in text for text in found.warnings)
    assert found.missing[4, 5]
    assert found.pressure[4, 5] == 0
    filled = read_footprint(path, dead="fill")
    assert filled.missing is None
    assert filled.pressure[4, 5] == pytest.approx(400e3)
    assert any("filled from their neighbours" in text for text in filled.warnings)
    # The rest is as it was.
    others = np.ones(found.pressure.shape, dtype=bool)
    others[4, 5] = False
    np.testing.assert_array_equal(filled.pressure[others], found.pressure[others])


def test_a_line_across_travel_that_reads_nothing(tmp_path):
    values = np.zeros((8, 10))
    values[1:-1, 1:-1] = 500 + np.arange(48).reshape(6, 8)
    values[:, 4] = 0
    path = written(tmp_path, tekscan([values]))
    assert any("column 5 reads zero between loaded ones" in text for text in read_footprint(path).warnings)
    # Along travel it is a groove.
    assert not read_footprint(path, travel="up").warnings


def test_what_is_doubtful_is_told(tmp_path):
    pressing = np.zeros((8, 8))
    pressing[2:6, 2:6] = 8 + 0.01 * np.arange(16).reshape(4, 4)
    told = read_footprint(written(tmp_path, tekscan([pressing]))).warnings
    assert len(told) == 1
    assert "peaks at 8.15 kPa" in told[0]
    assert told[0].endswith("are its values in kgf/cm2 or bar?")
    flat = np.zeros((8, 8))
    flat[1:7, 1:7] = 500
    flat[2:4, 2:5] = 900
    assert (
        "6 sensels read the same largest pressure, 900 kPa"
        in read_footprint(written(tmp_path, tekscan([flat]))).warnings[0]
    )
    off = np.pad(500 + np.arange(36.0).reshape(6, 6), ((0, 2), (2, 2)))
    assert "goes on beyond the sensor" in read_footprint(written(tmp_path, tekscan([off]))).warnings[0]


def test_measures_of_a_print():
    load = ribbed()
    found = Footprint(load)
    loaded = load.pressure > 0
    assert found.net_area == pytest.approx(loaded.sum() * 5.4e-3**2)
    assert found.normal_load == pytest.approx(35e3)
    assert found.mean_pressure == pytest.approx(35e3 / found.net_area)
    x = load.grid.x[loaded.any(axis=0)]
    assert found.length == pytest.approx(x[-1] - x[0] + 5.4e-3)
    # The outline holds the grooves and no more than the box.
    assert found.net_area < found.gross_area < found.length * found.width
    weights = load.pressure / load.pressure.sum()
    assert found.centroid[0] == pytest.approx((weights * load.grid.x).sum())
    assert found.centroid[1] == pytest.approx((weights * load.grid.y[:, None]).sum())
    ribs = found.find_ribs()
    assert len(ribs) == 5
    shares = found.rib_shares()
    assert shares.sum() == pytest.approx(1)
    assert shares[0] == pytest.approx(weights[load.grid.y < ribs[1]].sum())
    np.testing.assert_allclose(found.rib_shares([-1, 0, 1]).sum(), 1)
    for text in ("load by rib", "net contact area", "footprint length"):
        assert text in found.summary()


def test_a_disc_and_a_square_measure_what_they_are():
    at = (np.arange(400) - 199.5) * 1e-3
    x, y = np.meshgrid(at, at)
    disc = measure(np.where(np.hypot(x, y) < 0.15, 1e5, 0.0), at, at, 1e-3, 1e-3)
    # A cell at the rim, of 150 across.
    assert disc.gross_area == pytest.approx(np.pi * 0.15**2, rel=0.015)
    assert disc.net_area == pytest.approx(np.pi * 0.15**2, rel=0.002)
    assert disc.spread_x == pytest.approx(0.075, rel=0.002)  # R / 2
    square = np.where((np.abs(x) < 0.1) & (np.abs(y) < 0.1), 1e5, 0.0)
    turned = measure(square, at, at, 1e-3, 1e-3, angle=np.pi / 4)
    assert turned.length == pytest.approx(0.2 * np.sqrt(2), abs=1.1e-3)
    assert turned.gross_area == pytest.approx(0.04, rel=1e-12)


def test_a_footprint_loads_the_road():
    load = ribbed(nx=24, ny=20, cell=12e-3)
    found = Footprint(load, missing=load.pressure == 0)
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    one, other = (tl.solve_response(given, road, depths=[0.02]).dataset for given in (found, load))
    np.testing.assert_array_equal(one.strain_xx, other.strain_xx)


def test_resampling_and_scaling_keep_what_they_should():
    found = Footprint(ribbed(), threshold=5e3, saturation=2e6)
    for size in ("7.1 mm", 2.3e-3):
        assert found.resampled(size).normal_load == pytest.approx(35e3, rel=1e-12)
    half = found.scaled_to("17.5 kN")
    assert (half.normal_load, half.threshold, half.saturation) == pytest.approx((17.5e3, 2.5e3, 1e6))
    assert found.moved(0.1, 0.2).centroid == pytest.approx(np.add(found.centroid, (0.1, 0.2)))
    assert found.mirrored().centroid == pytest.approx(np.multiply(found.centroid, (1, -1)))
    with pytest.raises(tl.InputError, match="saturation of a footprint must lie above its threshold"):
        Footprint(ribbed(), threshold=1e6, saturation=1e5)


def test_a_footprint_is_saved_and_opened(tmp_path):
    made = sensed(ribbed(), threshold=5e3, saturation=9e5)
    made = Footprint(made.load, None, 5e3, 9e5, made.pressure == 0, ("one",))
    opened = tl.open_results(tl.save_results(made, tmp_path / "f.nc")).contact
    assert isinstance(opened, Footprint)
    assert (opened.threshold, opened.saturation, opened.warnings) == (5e3, 9e5, ("one",))
    np.testing.assert_array_equal(opened.missing, made.missing)
    np.testing.assert_array_equal(opened.pressure, made.pressure)
    assert opened.summary() == made.summary()


def test_another_package_reads_another_format(tmp_path, monkeypatch):
    module = """
        import numpy as np
        from treadload.footprint import Frames

        def read(path, *, side=1):
            return Frames(np.full((1, 3, 3), float(side)), 1e-2, 1e-2, (1e5, 1.0), source="lab")
    """
    points = "[treadload.footprints]\nlab = lab_mats.mats:read\nfsx = lab_mats.mats:read\n"
    build(tmp_path, "lab_mats", points, mats=module)
    monkeypatch.syspath_prepend(str(tmp_path))
    # A format that is closed to this package may be open to another.
    assert read_footprint(written(tmp_path, "x", "one.fsx"), side=2).peak_pressure == 2e5
    path = written(tmp_path, "x", "one.lab")
    assert read_footprint(path, side=4).peak_pressure == 4e5
    assert "knows no option 'sides'; did you mean 'side'" in said(path, sides=4)


CASE = """
[footprint]
file = "print.asf"
{keys}

[[pavement.layers]]
name = "asphalt concrete"
material = {{ kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }}

[response]
depths = ["20 mm"]
"""


def test_a_case_reads_the_export_of_a_sensor(tmp_path):
    values = np.zeros((9, 8))
    values[2:6, 2:6] = 300 + 20 * np.arange(16).reshape(4, 4)
    values[3, 4] = 0
    written(tmp_path, tekscan([values, 0.5 * values], pitch="10 mm"))
    case = tl.Case.from_text(CASE.format(keys='travel = "up"\nload = "5 kN"'), folder=tmp_path)
    assert tl.Case.from_text(case.to_toml(), folder=tmp_path) == case
    result = tl.run(case)
    wanted = values[::-1].T
    np.testing.assert_allclose(result.footprint.pressure, wanted * 5e3 / (wanted.sum() * 1e-4))
    # What is doubtful about it is told with the result, and in its file.
    assert any("frame 1 of 2, which carries most" in line for line in result.summary().splitlines())
    assert any("dead sensels" in text for text in result.warnings)
    assert result.parts["contact"].road is not None
    saved = tl.open_results(tl.save_results(result, tmp_path / "r.nc"))
    assert saved.contact.warnings == result.footprint.warnings
    for keys, words in (
        ('missing = "zero"', "footprint.missing does not go with its file: print.asf is an export of a sensor"),
        ('calibration = "3 kPa"', "calibration= is for counts"),
    ):
        with pytest.raises(tl.InputError, match=words):
            tl.run(tl.Case.from_text(CASE.format(keys=keys), folder=tmp_path))
    (tmp_path / "print.asf").write_text("100,200.5\n300,400\n")
    with pytest.raises(
        tl.InputError, match=r"footprint\.travel does not go with its file: .* is a table or a matrix"
    ):
        tl.run(tl.Case.from_text(CASE.format(keys='travel = "up"\nspacing = 0.01'), folder=tmp_path))
