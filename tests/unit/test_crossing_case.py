"""The table [crossing] of a case: run, kept, told, drawn, refused."""

import tomllib

import jsonschema
import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from cases import COARSE_CASE
from treadload.case.schema import json_schema
from treadload.cli import app
from treadload.pavement import RoadJoint, RoadPlate, RoadStep

# A bare half-space read at one depth, so that little but the wheel is solved; 0.024 m are two cells.
WHEEL = COARSE_CASE.replace('depths = ["0 mm", "20 mm"]', 'depths = ["0 mm"]').split("[damage]")[0]
CASE = f"""{WHEEL}
[crossing]
joint = {{ width = "24 mm", depth = "30 mm", chamfer = "12 mm" }}
positions = ["-96 mm", "-48 mm", "0 mm", "48 mm", "96 mm"]
"""
SHORT = CASE.replace('positions = ["-96 mm", "-48 mm", "0 mm", "48 mm", "96 mm"]', 'positions = ["0 mm"]')


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """What `treadload run` writes and prints."""
    folder = tmp_path_factory.mktemp("crossing")
    (folder / "case.toml").write_text(CASE)
    done = CliRunner().invoke(app, ["run", str(folder / "case.toml"), "-o", str(folder / "r.nc"), "-q"])
    assert done.exit_code == 0, done.output
    return folder, done.output


def test_the_history_of_a_case_is_that_of_its_objects(ran):
    folder, printed = ran
    opened = tl.open_results(folder / "r.nc")
    case = tl.Case.from_text(CASE)
    assert opened.case == case
    assert list(opened)[-1] == "crossing"
    crossing, data = opened.crossing, opened.crossing.dataset
    same = tl.contact.cross_obstacle(
        case.build_tire(), case.build_road(), tl.Rolling(normal_load=32.5e3, friction=0.0),
        RoadJoint(0.024, 0.03, 0.012), positions=[-0.096, -0.048, 0.0, 0.048, 0.096], spacing=12e-3,
    )  # fmt: skip
    np.testing.assert_array_equal(data.pressure, same.dataset.pressure)
    assert crossing.relief == RoadJoint(0.024, 0.03, 0.012)
    # The plain pressure is that of the wheel without friction on the same cells, and both edges bear more.
    plain = tl.solve_contact(
        case.build_tire(), case.build_road(), tl.Rolling(normal_load=32.5e3, friction=0.0), spacing=12e-3
    ).dataset
    peak, edge = float(data.largest_pressure.max()), float(data.edge_pressure.max())
    # On a wider grid: the solver's tolerance, 1e-6.
    assert float(data.plain_pressure) == pytest.approx(float(plain.pressure.max()), rel=1e-5)
    assert edge > 1.2 * float(data.plain_pressure)
    assert float(data.edge_work) > 1.2 * float(data.plain_work)
    times = peak / float(data.plain_pressure)
    rows = {row.key: row for row in crossing.rows()}
    for key, value, text in (
        ("largest_pressure", peak, f"{peak / 1e3:.0f} kPa"),
        ("plain_pressure", float(data.plain_pressure), f"{float(data.plain_pressure) / 1e3:.0f} kPa"),
        ("edge_work", float(data.edge_work), f"{float(data.edge_work) / 1e3:.3g} kJ/m²"),
        ("plain_work", float(data.plain_work), f"{float(data.plain_work) / 1e3:.3g} kJ/m²"),
    ):
        assert rows[key].value == value
        assert rows[key].text == text
        assert f"{rows[key].label:<30}  {rows[key].sentence}" in printed
    assert rows["largest_pressure"].note.endswith(f", {times:.3g} times that without the obstacle")
    assert "joint, 24 mm wide, 30 mm deep, chamfer of 12 mm" in printed


def test_its_figures_mark_the_obstacle_where_it_is(ran):
    """The grey is where the road lies lower, and the peak of the curve is the largest work, in kJ/m²."""
    (way,) = (one for one in tl.open_results(ran[0] / "r.nc").parts.values() if "closing_work" in one.dataset)
    data, strip = way.dataset, way.plot.contacts()
    lower = np.unique(np.argwhere(np.abs(data.road_height.transpose("y", "road_x").to_numpy()[0]) > 1e-9))
    x, half = data.road_x.to_numpy() * 1e3, 500 * float(np.diff(data.road_x).mean())
    (grey,) = (one.get_bbox() for one in strip.axes[0].patches)
    assert (grey.x0, grey.x1) == pytest.approx((x[lower[0]] - half, x[lower[-1]] + half))
    assert strip.axes[0].get_title(loc="left").startswith("\u2212")
    work = way.plot.history().axes[2]
    assert work.get_ylabel() == "largest work (kJ/m²)"
    assert max(work.get_lines()[0].get_ydata()) == pytest.approx(float(data.closing_work.max()) / 1e3)


@pytest.mark.slow
def test_a_report_shows_it(ran):
    folder, _ = ran
    page = tl.report(tl.open_results(folder / "r.nc"), folder / "r.html").read_text(encoding="utf-8")
    assert "Crossing of an obstacle" in page
    assert "Along the way" in page
    assert "times that without the obstacle" in page
    assert "could not be drawn" not in page


def test_the_plain_work_is_what_a_road_without_a_step_takes():
    tire = tl.Tire.from_profile(
        tl.tire.TreadProfile(rolling_radius=0.5, crown_radius=0.6, width=0.2), material=tl.Elastic(4e6, 0.5)
    )
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    at = 8e-3 * np.arange(-28, 29)
    data = tl.contact.cross_obstacle(
        tire, road, tl.Rolling(normal_load=8e3, friction=0.0), RoadStep(0.0), positions=at, spacing=8e-3
    ).dataset
    # At every cell a position, both are the same sums, in places that the whole contact has passed.
    passed = data.closing_work.sel(road_x=slice(-0.05, 0.05)).max("y")
    np.testing.assert_allclose(passed, float(data.plain_work), rtol=1e-6)
    assert float(data.largest_pressure.max()) == float(data.plain_pressure)


def test_sliding_takes_the_friction_and_the_forces_of_the_wheel():
    case = tl.Case.from_text(SHORT + "sliding = true\n")
    wheel = case.crossing.rolling(case.build_rolling())
    assert wheel == case.build_rolling()
    still = tl.Case.from_text(SHORT).crossing.rolling(case.build_rolling())
    assert (still.normal_load, still.law.largest, still.forces) == (32.5e3, 0.0, (0.0, 0.0))


def test_obstacles_by_name_and_the_schema_knows_them():
    wanted = {
        'step = { rise = "-5 mm" }': RoadStep(-5e-3),
        'plate = { rise = "5 mm", length = "0.6 m", round = true }': RoadPlate(5e-3, 0.6, round=True),
        'plate = { rise = "5 mm", length = "0.6 m", width = "0.5 m", chamfer = "5 mm" }': RoadPlate(
            5e-3, 0.6, 0.5, chamfer=5e-3
        ),
    }
    check = jsonschema.Draft202012Validator(json_schema("run"))
    for text, relief in wanted.items():
        whole = f"{WHEEL}[crossing]\n{text}\n"
        assert tl.Case.from_text(whole).crossing.build() == relief
        assert list(check.iter_errors(tomllib.loads(whole))) == []
    made = tl.Case.from_text(CASE)
    assert tl.Case.from_text(made.to_toml()) == made
    assert str(RoadStep(-5e-3)) == "step, 5 mm down, upright edges"
    assert str(RoadPlate(5e-3, 0.6, round=True)) == "plate, 5 mm up, 600 mm across, round, upright edges"


def test_a_dry_run_tells_the_way_and_python_keeps_it():
    case = tl.Case.from_text(SHORT)
    assert "crossing  joint, 24 mm wide, 30 mm deep, chamfer of 12 mm; 1 positions" in tl.plan(case)
    without = tl.Case.from_text(SHORT.replace('positions = ["0 mm"]', ""))
    assert "; about " in tl.plan(without)
    assert "tl.run(case)" in tl.steps.case_as_python(case)
    assert "crossing" in tl.steps.case_as_python(case)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("joint = {", "step = { rise = 0.005 }\njoint = {", "give one obstacle.*got step and joint"),
        ('joint = { width = "24 mm", depth = "30 mm", chamfer = "12 mm" }', "", "one obstacle.*got none"),
        ('width = "24 mm"', 'width = "0 mm"', "width of the joint must be a positive number"),
        ('chamfer = "12 mm"', 'chamfer = "40 mm"', "does not fit a joint"),
        ('width = "24 mm"', 'widht = "24 mm"', "did you mean 'width'"),
        ('positions = ["0 mm"]', 'positions = ["0 mm", "0 mm"]', "positions must ascend, got 0 m and then 0 m"),
        ('positions = ["0 mm"]', "positions = []", "give 1 to 400 positions, got 0"),
        ('positions = ["0 mm"]', 'hold = "wheel"', "hold"),
        ('positions = ["0 mm"]', 'spacing = 0', "spacing must be a positive number"),
        ('normal_load    = "32.5 kN"', 'approach = "20 mm"', r"\[crossing\] needs rolling.normal_load"),
    ],
)  # fmt: skip
def test_a_wrong_table_is_refused_in_a_sentence(old, new, words):
    assert old in SHORT
    with pytest.raises(tl.InputError, match=words) as caught:
        tl.Case.from_text(SHORT.replace(old, new, 1))
    assert len(str(caught.value).splitlines()) == 1


def test_a_tire_that_remembers_is_refused():
    rubber = '{ kind = "prony", modulus = "6 MPa", poisson = 0.5, terms = [[0.5, "1 s"]] }'
    text = SHORT.replace('inflation_pressure = "8.2 bar"', f"material = {rubber}").replace(
        "[response]", "speed = 20\n[response]"
    )
    with pytest.raises(tl.InputError, match=r"knows elastic tires only; give tire\.material"):
        tl.Case.from_text(text)


def test_friction_that_falls_with_slip_is_refused_where_sliding_is_asked_for():
    falls = 'friction = { law = "exponential", static = 0.9, kinetic = 0.5, reference_speed = 1 }\nspeed = 20'
    text = SHORT.replace("friction       = 0.7", falls)
    assert tl.Case.from_text(text).crossing.build()
    with pytest.raises(tl.InputError, match="does not follow friction that falls with slip"):
        tl.Case.from_text(text + "sliding = true\n")


def test_a_footprint_has_no_wheel_to_cross_with():
    text = CASE.split("[tire]")[0].replace('spacing = "12 mm"', "") + "[footprint]\nfile = 'f.csv'\n"
    text += "[[pavement.layers]]\nmaterial = { modulus = 5e9, poisson = 0.35 }\n[crossing]\nstep = { rise = 0.005 }\n"
    with pytest.raises(tl.InputError, match=r"\[crossing\] needs a wheel"):
        tl.Case.from_text(text)


def test_a_study_reads_a_crossing():
    """Numbers of /crossing stand beside those of the contact, and its fields can be asked for."""
    case = tl.Case.from_text(CASE)
    swept = tl.sweep(case, {"normal_load": ["20 kN", "32.5 kN"]}, fields=["max(crossing.closing_work)"]).dataset
    heavy, alone = swept.isel(normal_load=1), tl.run(case).crossing.dataset
    for name in ("plain_pressure", "plain_work", "edge_work"):
        assert float(heavy[name]) == pytest.approx(float(alone[name]), rel=1e-6)
    for name in ("largest_pressure", "edge_pressure"):
        assert float(heavy[f"max_{name}"]) == pytest.approx(float(alone[name].max()), rel=1e-6)
    assert float(heavy.max_closing_work) == pytest.approx(float(alone.closing_work.max()), rel=1e-6)
    # The largest of a contact is that of the plane.
    assert float(heavy.largest_pressure) < float(heavy.max_edge_pressure)
    assert float(heavy.edge_work) > 1.1 * float(swept.edge_work[0])
    assert swept.edge_work.attrs["units"] == "J/m^2"
