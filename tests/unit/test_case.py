import copy
import math
import os
import pickle
import shutil
import tomllib
from pathlib import Path

import pytest

import treadload as tl
from cases import COARSE_CASE
from treadload.case import Case
from treadload.case.tire import TirePart


def changed(old, new):
    assert old in COARSE_CASE
    return COARSE_CASE.replace(old, new)


def test_a_case_holds_si_numbers_and_builds_its_parts():
    case = Case.from_text(COARSE_CASE)
    assert case.spacing == 0.012
    assert case.rolling.build() == tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
    assert case.pavement.build() == tl.Pavement([tl.Layer(tl.Elastic(5.4e9, 0.35), name="asphalt concrete")])
    tire = case.build_tire()
    # Eq. 15 of the paper: 2.7e-3 · 820 + 0.7 MPa.
    assert (tire.elastic.modulus, tire.elastic.poisson) == (pytest.approx(2.914e6), 0.5)


def test_toml_round_trip_is_exact():
    case = Case.from_text(COARSE_CASE)
    assert Case.from_text(case.to_toml()) == case


def test_paths_start_from_the_folder_of_the_case(tmp_path):
    (tmp_path / "tread.csv").write_text("\n".join(",".join("0.01" for _ in range(5)) for _ in range(4)))
    text = changed('profile = "315/80R22.5"', 'height_map = "tread.csv"\ncell = "5 mm"')
    (tmp_path / "case.toml").write_text(text)
    tire = Case.from_toml(tmp_path / "case.toml").build_tire()
    assert tire.fixed_grid.shape == (4, 5)
    assert tire.fixed_grid.dx == 0.005


def test_an_inline_profile_is_a_tread():
    text = changed('profile = "315/80R22.5"', "profile = { rolling_radius = 0.5, crown_radius = 1.0, width = 0.2 }")
    profile = Case.from_text(text).build_tire().surface.profile
    assert (profile.rolling_radius, profile.crown_radius, profile.width) == (0.5, 1.0, 0.2)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("friction       = 0.7", "frction = 0.7", r"unknown key 'rolling\.frction'; did you mean 'friction'"),
        ("friction       = 0.7", "", r"'rolling\.friction' is missing"),
        ("friction       = 0.7", "friction = -0.1", "friction must be >= 0, got -0.1"),
        ("friction       = 0.7", "friction = nan", "finite"),
        ('"32.5 kN"', '"0 kN"', "normal_load must be a positive number of N, got 0; a truck"),
        ('"32.5 kN"', '"32.5 kPa"', "cannot read '32.5 kPa'"),
        ("poisson = 0.35", "poisson = 0.6", r"poisson must lie in \(-1, 0.5\], got 0.6"),
        ('"5400 MPa"', '"-5400 MPa"', "modulus must be a positive"),
        ('profile = "315/80R22.5"', "", "exactly one of scan, profile and height_map, got none"),
        ('profile = "315/80R22.5"', 'profile = "a"\nscan = "b"', "got scan and profile"),
        ('profile = "315/80R22.5"', 'profile = "a"\nunits = "mm"', "units belongs to a scan"),
        ('"0 mm", "20 mm"', '"-1 mm"', "depths must be >= 0"),
        ('"0 mm", "20 mm"', '"1 mm", "1 mm"', "depths must differ"),
        ("slope = -0.2 }", 'slope = -0.2 }\ndepth = "10 mm"', "damage.depth 0.01 m is not one of"),
        ("slope = -0.2 }", 'slope = -0.2 }\nmean_over = "10 m"', r"mean_over must lie in \(0, 0.1\] m, got 10"),
        ("slope = -0.2 }", "slope = -0.2 }\ndepth = 0\nmean_over = 0.01", "depth reads points and mean_over a mean"),
        ('"120 microstrain"', "120", "1e-6|e-6"),
        ("slope = -0.2", "slope = 0.2", r"slope must lie in \(-1, 0\)"),
        ('kind = "elastic"', 'kind = "steel"', "elastic"),
        ('title   = "coarse"', "title = ", "not valid TOML"),
    ],
)
def test_bad_cases_say_what_is_wrong(old, new, message):
    with pytest.raises(tl.InputError, match=message) as caught:
        Case.from_text(changed(old, new), name="my.toml")
    assert str(caught.value).startswith("my.toml")


def test_a_case_is_frozen_and_comparable():
    case = Case.from_text(COARSE_CASE)
    with pytest.raises(ValueError, match="frozen"):
        case.spacing = 1.0
    assert case != Case.from_text(changed("0.7", "0.6"))


def test_a_case_goes_to_another_process_and_back(tmp_path):
    friction = 'friction = { law = "anisotropic", along = 0.8, across = 0.6, base = 0.5 }'
    case = Case.from_text(changed("friction       = 0.7", friction), folder=tmp_path)
    for again in (pickle.loads(pickle.dumps(case)), copy.deepcopy(case)):
        assert again == case
        assert again.folder == tmp_path
        assert again.to_toml() == case.to_toml()
        assert again.build_rolling() == case.build_rolling()


def test_missing_and_binary_files_are_refused(tmp_path):
    with pytest.raises(tl.InputError, match=r"cannot read .*toml: No such file"):
        Case.from_toml(tmp_path / "none.toml")
    (tmp_path / "b.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(tl.InputError, match="UTF-8"):
        Case.from_toml(tmp_path / "b.toml")


def test_the_demo_cases_are_valid():
    folder = Path(tl.__file__).parent / "demo"
    for name, force in (("free", 0.0), ("tractive", 10e3)):
        case = Case.from_toml(folder / f"{name}.toml")
        assert case.rolling.build().forces == (force, 0.0)
        assert math.isclose(case.spacing, 3e-3)


def test_a_step_that_is_none_is_not_asked_for():
    table = tomllib.loads(COARSE_CASE)
    bare = {key: value for key, value in table.items() if key != "damage"}
    assert Case.from_dict(bare | {"damage": None, "crossing": None}) == Case.from_dict(bare)


def test_a_scan_is_read_again_only_where_it_changed(tmp_path, monkeypatch):
    mesh = tmp_path / "wheel.obj"
    shutil.copy(tl.tire.example_mesh(), mesh)
    readings = []

    def from_scan(path, **options):
        readings.append(options["revolve"])
        return tl.Tire.from_profile("315/80R22.5", name=path.stem)

    monkeypatch.setattr(tl.Tire, "from_scan", from_scan)

    def tire(revolve, pressure):
        part = TirePart(scan="wheel.obj", revolve=revolve, inflation_pressure=pressure)
        return part.build(tmp_path)

    first, harder = tire(True, 7e5), tire(True, 8e5)
    assert (first.inflation_pressure, harder.inflation_pressure, harder.name) == (7e5, 8e5, "wheel")
    assert readings == [True]
    tire(False, 7e5)
    os.utime(mesh, ns=(1, 1))
    tire(False, 7e5)
    assert readings == [True, False, False]
