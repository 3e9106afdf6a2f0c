"""Basins from files: tables with and without a layout, PDDX and F25; and what is wrong with them."""

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.roads import BasinLayout, read_basins

PLAIN = """station,position [m],load [kN],D0 [µm],D300 [µm],D900 [µm],temperature [°C],thickness base [mm]
A1,0,50.2,412,250,90,18.5,300
A2,20,49.8,380,240,88,,280
"""
# Columns as the RIOHTrack table has them, with two of its rows.
TRACK = """section_id,station,actual_load_kN,thickness_AC_cm,pavement_temperature_C,offsets_cm,D0_mm,D23_mm,D153_mm
STR1,ZK0+220,50.96,12.0,9.3,"0,23,153",0.0487,0.039867,0.023367
STR1,ZK0+220,68.82,12.0,9.3,"0,23,153",0.061133,0.0537,0.0336
"""
PDDX = """[Pavement Deflection Data Exchange File]
PDDXVersionNumber = 1.0
DelimiterSymbol = ,
DecimalSymbol = .

[Units]
LoadPlateRadiusUnits = millimeter
LoadUnits = kilo-Newton
DeflectionUnits = micron
TemperatureUnits = Celsius
SensorLocationUnits = millimeter
TestLocationUnits = kilometer,meter,meter

[Device Configuration]
LoadPlateRadius = 150
NumberOfDeflectionSensors = 3
DeflectionSensorXAxisDistances = 0, 300, 900
NumberOfTemperatureSensors = 3
TemperatureSensorUse = air,surface,manual

[Test Location 1]
TestLocation = 1.200,0,0
TestTemperatures = 12.0,18.0,16.5
NumberOfDrops = 2
DropData_1 = 50.2,412.0,250.0,90.0
DropData_2 = 70.1,570.0,345.0,125.0

[Test Location 2]
TestLocation = 1.220,0,0
TestTemperatures = 12.0,18.5,17.0
DropData_1 = 49.8,380.0,240.0,88.0
"""
F25 = """5001,25.99,1,40, 3, 1,"tester       "
5002,"25SI ","0000    ","0000    "
5020,   150,     0,   300,   900,N0    ,N0
5021,   300,     0,     0,     0
5301,0,1,3,3,     20,1,1,        ,2024, 05, 06, 10, 30
5302, 0, 1, 8, 0, 0, 0, 0, 0, "          "
5303,0, 16.5, 18.0, 12.0
  1,   710, 412.0, 250.0,  90.0
  2,   990, 570.0, 345.0, 125.0
5301,0,1,3,3,     40,1,1,        ,2024, 05, 06, 10, 32
5303,0,   N0, 18.5, 12.0
  1,   704, 380.0, 240.0,  88.0
"""


def written(tmp_path, text, name="basins.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def test_columns_are_found_by_their_names(tmp_path):
    basins = read_basins(written(tmp_path, PLAIN))
    np.testing.assert_allclose(basins.offsets, [0, 0.3, 0.9])
    np.testing.assert_allclose(basins.deflection[0], [412e-6, 250e-6, 90e-6])
    np.testing.assert_allclose(basins.load, [50.2e3, 49.8e3])
    np.testing.assert_allclose(basins.thickness["base"], [0.3, 0.28])
    assert basins.station == ("A1", "A2")
    assert basins.position.tolist() == [0, 20]
    assert basins.temperature[0] == 18.5
    assert np.isnan(basins.temperature[1])


def test_a_layout_names_the_columns_of_any_table(tmp_path):
    layout = BasinLayout(
        deflections=("D0_mm", "D153_mm", "D23_mm"), offsets=(0.0, 1.53, 0.23), load="actual_load_kN",
        station="station", section="section_id", temperature="pavement_temperature_C",
        thickness={"AC": "thickness_AC_cm"},
    )  # fmt: skip
    basins = read_basins(written(tmp_path, TRACK), layout)
    # Sensors come out in the order of their offsets.
    np.testing.assert_allclose(basins.offsets, [0, 0.23, 1.53])
    np.testing.assert_allclose(basins.deflection[1], [61.133e-6, 53.7e-6, 33.6e-6])
    np.testing.assert_allclose(basins.load, [50.96e3, 68.82e3])
    np.testing.assert_allclose(basins.thickness["AC"], 0.12)
    assert basins.section == ("STR1", "STR1")


def test_units_come_from_the_layout_where_the_heading_has_none(tmp_path):
    text = PLAIN.replace("load [kN]", "load").replace("D0 [µm]", "D0")
    path = written(tmp_path, text)
    with pytest.raises(InputError, match=r"'D0' names no unit; write D0 \[mm\]"):
        read_basins(path)
    basins = read_basins(path, BasinLayout(units={"load": "kN", "D0": "mils"}))
    assert basins.deflection[0, 0] == pytest.approx(412 * 25.4e-6)


@pytest.mark.parametrize(
    ("text", "layout", "words"),
    [
        (PLAIN.replace("load", "force"), None, "no column 'load'"),
        (PLAIN, {"units": {"D0": "mm"}}, "names a unit of its own"),
        (PLAIN, {"units": {"D1": "mm"}}, "units names 'D1'"),
        (PLAIN, {"deflections": ("D0", "D300"), "offsets": (0.0,)}, "1 offsets for 2 columns"),
        (PLAIN.replace("µm", "kN"), None, "no unit like mm"),
        (
            PLAIN.replace("D0", "first").replace("D300", "second").replace("D900", "third"),
            None,
            "no column of a defl",
        ),
        (PLAIN.splitlines()[0], None, "a line of headings"),
        (PLAIN.replace("412", "x12"), None, "line 2: D0 .* 'x12', not a number"),
        (PLAIN, {"plate_radius": 0.35}, "300 mm lies inside the plate of radius 350 mm"),
    ],
)
def test_a_table_that_cannot_be_read_says_why(tmp_path, text, layout, words):
    with pytest.raises(InputError, match=words):
        read_basins(written(tmp_path, text), None if layout is None else BasinLayout(**layout))


def test_the_exchange_format_of_aashto(tmp_path):
    basins = read_basins(written(tmp_path, PDDX, "a.pddx"))
    assert basins.plate_radius == pytest.approx(0.15)
    np.testing.assert_allclose(basins.offsets, [0, 0.3, 0.9])
    np.testing.assert_allclose(basins.load, [50.2e3, 70.1e3, 49.8e3])
    np.testing.assert_allclose(basins.deflection[2], [380e-6, 240e-6, 88e-6])
    np.testing.assert_allclose(basins.position, [1200, 1200, 1220])
    np.testing.assert_allclose(basins.temperature, [16.5, 16.5, 17.0])
    assert basins.station == ("1", "1", "2")


def test_the_exchange_format_in_american_units(tmp_path):
    words = {
        "LoadPlateRadiusUnits = millimeter": "LoadPlateRadiusUnits = inches", "LoadPlateRadius = 150":
        "LoadPlateRadius = 5.9", "kilo-Newton": "pounds", "micron": "mils", "Celsius": "Fahrenheit",
        "SensorLocationUnits = millimeter": "SensorLocationUnits = inches", "0, 300, 900": "0, 12, 36",
    }  # fmt: skip
    text = PDDX
    for old, new in words.items():
        text = text.replace(old, new)
    basins = read_basins(written(tmp_path, text, "a.pddx"))
    assert basins.plate_radius == pytest.approx(5.9 * 0.0254)
    np.testing.assert_allclose(basins.offsets, [0, 0.3048, 0.9144])
    assert basins.load[0] == pytest.approx(50.2 * 4.4482216)
    assert basins.temperature[0] == pytest.approx((16.5 - 32) / 1.8)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("DeflectionUnits = micron", "DeflectionUnits = furlong", "DeflectionUnits is 'furlong'"),
        ("LoadPlateRadius = 150", "", "without LoadPlateRadius"),
        ("DropData_1 = 49.8,380.0,240.0,88.0", "DropData_1 = 49.8,380.0", "2 values where a load and 3"),
        ("DropData", "DropHistory", "without drops"),
        ("0, 300, 900", "0, 300", "2 distances for 3"),
        ("49.8,380.0", "49.8,x", "must be numbers"),
    ],
)
def test_an_exchange_file_that_cannot_be_read_says_why(tmp_path, old, new, words):
    with pytest.raises(InputError, match=words):
        read_basins(written(tmp_path, PDDX.replace(old, new), "a.pddx"))


def test_a_file_f25(tmp_path):
    path = written(tmp_path, F25, "a.F25")
    basins = read_basins(path)
    np.testing.assert_allclose(basins.offsets, [0, 0.3, 0.9])
    # 710 kPa on a plate of 300 mm are 50.2 kN.
    np.testing.assert_allclose(basins.load, np.array([710, 990, 704]) * 1e3 * np.pi * 0.15**2)
    np.testing.assert_allclose(basins.deflection[1], [570e-6, 345e-6, 125e-6])
    assert basins.position.tolist() == [20, 20, 40]
    assert basins.temperature.tolist() == [16.5, 16.5, 18.5]
    with pytest.raises(InputError, match="states its own layout"):
        read_basins(path, BasinLayout(load="P"))
    for old, new, words in (
        ("5020,", "5029,", "before the line 5020"),
        ("  1,   704, 380.0, 240.0,  88.0", "  1, 704, 380.0", "2 values where a pressure and 3"),
        ("412.0", "4x2", "'4x2' is not a number"),
    ):
        with pytest.raises(InputError, match=words):
            read_basins(written(tmp_path, F25.replace(old, new), "b.F25"))


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="cannot read"):
        read_basins(tmp_path / "none.csv")
