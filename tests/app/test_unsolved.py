"""What a case asks for and the page does not solve is named, whatever the case may learn besides."""

import pytest

from treadload.app import unsolved as module
from treadload.app.form import Form
from treadload.app.life_form import LifeForm
from treadload.app.unsolved import said_of, unsolved
from treadload.case import Case
from treadload.case.crossing import CrossingPart
from treadload.case.model import DamagePart
from treadload.case.passes import PassesPart
from treadload.case.response import ResponsePart
from treadload.case.texture import TexturePart

# Tables of a case whose results the page shows.
SOLVED = {"tire", "pavement", "rolling", "footprint", "response", "damage"}


def case_with(**tables):
    return Case.from_dict({**Form.first().table, **tables})


def test_the_first_case_is_solved_whole():
    assert unsolved(Case.from_dict(dict(Form.first().table))) == []
    assert said_of(LifeForm.first().check(".").case) == ""
    assert said_of(None) == ""


@pytest.mark.parametrize("name", sorted(set(Case.own_tables) - SOLVED))
def test_every_table_of_the_schema_that_the_page_does_not_solve_is_named(name):
    case = Case.model_construct(
        {name}, **{name: PassesPart() if name != "texture" else TexturePart.model_construct()}
    )
    assert unsolved(case) == [f"[{name}]"]


def test_a_key_that_the_schema_gets_is_named_until_the_page_solves_it():
    """Of both tables that are solved in part, all keys are either solved or named."""
    for name, part in (("response", ResponsePart), ("damage", DamagePart)):
        table = part.model_construct(set(part.model_fields), **dict.fromkeys(part.model_fields, True))
        case = Case.model_construct({name}, **{name: table})
        told = {one.removeprefix(f"{name}.") for one in unsolved(case)}
        assert told | module._KEYS[name] == set(part.model_fields)
        assert not told & module._KEYS[name]
    assert set(Case.model_fields) >= module._WHOLE


def test_an_error_estimate_is_named_and_its_absence_is_not():
    damage = dict(Form.first().table["damage"])
    assert unsolved(case_with(damage={**damage, "error_estimate": True})) == ["damage.error_estimate"]
    assert unsolved(case_with(damage={**damage, "error_estimate": False})) == []


def test_a_texture_under_the_tire_is_solved_and_a_patch_is_not():
    spectrum = {"size": "20 mm", "spacing": "1 mm", "hurst": 0.8, "shortest": "4 mm", "rms_height": "0.2 mm"}
    resolved = case_with(texture={**spectrum, "resolved": True})
    assert unsolved(resolved) == []
    rubber = {"kind": "elastic", "modulus": "3 MPa", "poisson": 0.5}
    assert unsolved(case_with(texture={**spectrum, "rubber": rubber})) == ["[texture]"]


def test_the_sentence_names_the_tables_and_the_command():
    case = case_with(crossing={"step": {"rise": "10 mm"}})
    assert isinstance(case.crossing, CrossingPart)
    said = said_of(case)
    assert "[crossing]" in said
    assert "`treadload run case.toml`" in said
    damage = {**Form.first().table["damage"], "error_estimate": True}
    assert "damage.error_estimate and [crossing]" in said_of(
        case_with(crossing={"step": {"rise": "10 mm"}}, damage=damage)
    )
