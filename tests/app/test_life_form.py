"""The form of a life: what its fields read and write is the case that `treadload life` takes."""

import pytest

from treadload.app import life_form as own
from treadload.app.form import Form
from treadload.app.life_form import LifeForm
from treadload.case import LifeCase
from treadload.errors import InputError


def fields_of(form):
    """All fields of traffic, climate, criteria and reliability that the page shows of a form."""
    yield from own.PASSES
    for number, row in enumerate(form.rows("traffic.classes")):
        yield from own.class_fields(number, row)
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
