"""The form of a life: what its fields read and write is the case that `treadload life` takes."""

import pytest

import treadload as tl
from treadload.app import life_form as own
from treadload.app import maneuvers
from treadload.app.form import Form
from treadload.app.life_form import LifeForm
from treadload.case import LifeCase
from treadload.errors import InputError


def fields_of(form):
    """All fields of traffic, climate, criteria and reliability that the page shows of a form."""
    yield from own.PASSES
    for number, row in enumerate(form.rows("traffic.classes")):
        yield from own.class_fields(number, row)
        before, held = f"traffic.classes.{number}", maneuvers.several(row)
        yield from maneuvers.maneuver_fields(f"{before}.maneuver", row.get("maneuver"))
        for which, told in enumerate(held):
            yield from maneuvers.maneuver_fields(f"{before}.maneuvers.{which}", told)
    yield from own.climate_fields(form.climate, len(form.rows("climate.seasons")))
    for number, row in enumerate(form.rows("criteria")):
        yield from own.criterion_fields(number, row, ["EB-BBSG3", "EB-GB3", "PF3"])
    yield from own.RELIABILITY


@pytest.mark.parametrize("climate", ["months", "temperature", "air", "seasons"])
def test_what_a_field_shows_it_reads_again(climate, tmp_path):
    """Typing what stands there changes nothing of the case, in whatever unit the field has."""
    form = LifeForm.first().with_climate(climate)
    before = form.check(tmp_path).case
    assert isinstance(before, LifeCase)
    shown = {field.path: field.shown(form.value(field.path)) for field in fields_of(form)}
    assert shown["traffic.passes_per_year"] == "60000"
    assert shown["traffic.classes.0.axle_load"] == "70"
    assert shown["reliability.risks"] == "0.05, 0.5, 0.95"
    for field in fields_of(form):
        if shown[field.path]:
            form = form.with_text(field, shown[field.path])
            assert form.is_yours(field.path)
    assert form.check(tmp_path).case == before


def test_numbers_are_in_the_unit_of_their_field(tmp_path):
    form = LifeForm.first()
    typed = {"traffic.wander.deviation": "300", "traffic.classes.1.axle_load": "120", "traffic.years": "30",
             "climate.months": "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12"}  # fmt: skip
    for field in fields_of(form):
        if field.path in typed:
            form = form.with_text(field, typed[field.path])
    case = form.check(tmp_path).case
    traffic, climate = case.build_traffic(), case.build_climate()
    assert traffic.wander.deviation == pytest.approx(0.3)
    # Two wheels on each side of the axle of 120 kN.
    assert traffic.classes[1].wheel_load == pytest.approx(30e3)
    assert traffic.years == 30
    assert [season.temperature for season in climate.seasons] == list(range(1, 13))


def test_rows_come_and_go(tmp_path):
    form = LifeForm.first().with_more("traffic.classes").with_more("criteria")
    assert len(form.rows("traffic.classes")) == 3
    assert form.check(tmp_path).case is not None
    less = form.without("criteria", 0)
    names = [one.name for one in less.check(tmp_path).case.criteria]
    assert names == ["surface, top-down", "platform, rutting", "another criterion"]
    # A road of one's own takes the temperatures of the climate.
    for road in ("layers", "structure"):
        assert "temperature" not in form.with_road(road).table["pavement"]


@pytest.mark.parametrize("kind", maneuvers.KINDS)
def test_a_class_does_what_is_chosen(kind, tmp_path):
    """One maneuver, several, one again: each as `Maneuver` has it, and each field reads back."""
    made = {
        "straight": tl.Maneuver(), "braking": tl.Maneuver.braking(2.5), "locked": tl.Maneuver.braking(),
        "uphill": tl.Maneuver.uphill(0.05, 0.25), "turning": tl.Maneuver.turning(25, 25 / 3.6),
    }[kind]  # fmt: skip
    form = maneuvers.with_kind(LifeForm.first(), 0, kind)
    (only,) = moves_of(form, tmp_path, 0)
    assert (only.tractive, only.lateral, only.spin, only.locked) == pytest.approx(
        (made.tractive, made.lateral, made.spin, made.locked)
    )
    for field in fields_of(form):
        if ".maneuver." in field.path and form.value(field.path) is not None:
            assert form.with_text(field, field.shown(form.value(field.path))).check(tmp_path).case is not None
    two = maneuvers.with_another(form, 0)
    assert [one.tractive for one in moves_of(two, tmp_path, 0)] == pytest.approx(
        [made.tractive, tl.Maneuver.braking(2.5).tractive]
    )
    three = maneuvers.with_another(two, 0)
    assert len(moves_of(three, tmp_path, 0)) == 3
    assert two.value("traffic.classes.0.maneuvers.0.share") == 0.9
    climbs = maneuvers.with_kind(two, 0, "uphill", 1)
    assert moves_of(climbs, tmp_path, 0)[1].tractive == pytest.approx(0.2)
    assert climbs.value("traffic.classes.0.maneuvers.1.share") == 0.1
    assert moves_of(maneuvers.without_one(two, 0, 1), tmp_path, 0) == [only]


def moves_of(form, folder, number):
    """Maneuvers of a class as the reader of the case makes them."""
    case = form.check(folder).case
    assert case is not None, form.check(folder).wrong
    name = form.value(f"traffic.classes.{number}.name")
    return [one.maneuver for one in case.build_traffic().classes if one.name.split(",")[0] == name]


def test_a_wrong_number_is_said_at_its_field(tmp_path):
    form = LifeForm.first()
    load = next(one for one in fields_of(form) if one.path.endswith("0.axle_load"))
    checked = form.with_text(load, "3 mm").check(tmp_path)
    assert checked.case is None
    assert "3 mm" in checked.at(load.path, {load.path})
    missing = form.with_values({"criteria": [{"name": "a", "law": "french-bituminous", "layer": "chalk"}]})
    assert "chalk" in " ".join(missing.check(tmp_path).wrong.values())


def test_the_case_of_a_wheel_is_no_life_and_no_file_of_the_machine_is_named():
    with pytest.raises(InputError, match="treadload run"):
        LifeForm.from_text(Form.first().to_toml(), "mine.toml", {})
    with pytest.raises(InputError, match="treadload life"):
        Form.from_text(LifeForm.first().to_toml(), "mine.toml", {})
    weather = LifeForm.first().with_climate("file", "/etc/passwd")
    with pytest.raises(InputError, match="no page may open"):
        LifeForm.from_text(weather.to_toml(), "mine.toml", {})
