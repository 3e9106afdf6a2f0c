"""The JSON schema of a case, and the case to start from."""

import functools
import json
import re
import tomllib
from pathlib import Path

import jsonschema
import pytest

import treadload as tl
from treadload.case import Case
from treadload.case.schema import json_schema
from treadload.errors import InputError
from treadload.templates import first_case
from treadload.units import Unit, quantity

ROOT = Path(__file__).parents[2]
KINDS = {"run": Case, "life": Case, "calibrate": Case}
FILES = [*(ROOT / "examples").rglob("*.toml"), *(ROOT / "src/treadload/demo").glob("*.toml")]
CASES = sorted(path for path in FILES if path.name != "pyproject.toml")


@functools.cache
def validator(kind):
    return jsonschema.Draft202012Validator(json_schema(kind))


def tables(schema):
    """Every table of a schema: its keys by name."""
    if isinstance(schema, dict):
        if "properties" in schema:
            yield schema
        for one in schema.values():
            yield from tables(one)
    elif isinstance(schema, list):
        for one in schema:
            yield from tables(one)


@pytest.mark.parametrize("kind", KINDS)
def test_a_schema_is_one_of_its_draft_and_refers_to_what_it_defines(kind):
    schema = json_schema(kind)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    text = json.dumps(schema)
    named = set(re.findall(r'"\$ref": "#/\$defs/([^"]+)"', text))
    assert named == set(schema["$defs"])
    # Nothing of the machinery, and no null, which TOML does not have.
    assert "treadload/" not in text
    assert "null" not in text


def test_texts_of_quantities_have_a_pattern():
    """An editor marks text that no reader takes; what the reader takes, the pattern does, too."""
    pattern = re.compile(Unit("N").__get_pydantic_json_schema__(None, None)["pattern"])
    assert pattern.pattern in json.dumps(json_schema("run")).encode().decode("unicode_escape")
    for right in ("32.5 kN", "32,5 kN", "1 000 kN", "1.2e6 N", "-5 kN", ".5 kN", " 20kN"):
        quantity(right, "N")
        assert pattern.search(right), right
    for wrong in ("kN", "", "about 20 kN", "20", "1 000", "-"):
        with pytest.raises(InputError):
            quantity(wrong, "N")
        assert not pattern.search(wrong), wrong
    share = re.compile(Unit("").__get_pydantic_json_schema__(None, None)["pattern"])
    assert all(share.search(word) for word in ("0.7", "5 %", "120 microstrain"))
    assert not share.search("high")


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_says_what_it_is_and_in_which_unit(kind):
    found = list(tables(json_schema(kind)))
    assert len(found) > 30
    for table in found:
        assert table["additionalProperties"] is False
        for key, one in table["properties"].items():
            said = one.get("description", "")
            assert said, (table["description"], key)
            assert not said.startswith("A number"), (table["description"], key)
            if one.get("type") == ["number", "string"]:
                assert "A number" in said, (table["description"], key)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.name)
def test_the_examples_are_cases_of_their_schema(path):
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    kind = "life" if "traffic" in table else "run"
    assert list(validator(kind).iter_errors(table)) == []
    KINDS[kind].from_toml(path)


@pytest.mark.parametrize(
    ("kind", "old", "new", "word"),
    [
        ("run", "friction = 0.7", "frction = 0.7", "frction"),
        ("run", "friction = 0.7", 'friction = { law = "exponental", static = 1 }', "oneOf|not valid"),
        ("run", 'epsilon_6 = "120 microstrain"', "epsilon_6 = true", "True is not of type"),
        ("run", 'profile = "315/80R22.5"', 'profile = "315/80R22.5"\nscan = "x"', "valid under each of"),
        ("life", 'law = "french-subgrade"', 'law = "french-subgrad"', "not valid|oneOf"),
        ("life", "share = 0.6 ", "share = [0.6] ", "is not of type"),
    ],
)
def test_what_the_reader_refuses_the_schema_refuses(kind, old, new, word):
    text = first_case(kind)
    assert old in text
    wrong = text.replace(old, new, 1)
    errors = [error.message for error in validator(kind).iter_errors(tomllib.loads(wrong))]
    assert any(re.search(word, error) for error in errors), errors
    with pytest.raises(tl.InputError):
        Case.from_text(wrong)


def test_values_that_the_schema_takes_as_text_are_numbers_with_units():
    load = json_schema("run")["properties"]["rolling"]["properties"]["normal_load"]
    assert load["type"] == ["number", "string"]
    assert load["description"].endswith('A number in N, or text such as "32.5 kN".')


@pytest.mark.parametrize("kind", KINDS)
def test_the_first_case_is_one_and_names_every_key_of_its_tables(kind):
    text = first_case(kind)
    case = Case.from_text(text)
    assert Case.from_text(case.to_toml()) == case
    table = tomllib.loads(text)
    assert list(validator(kind).iter_errors(table)) == []
    schema = json_schema(kind)
    here, shown = schema, {}
    for line in text.splitlines():
        heading = re.match(r"\[+([a-z_.]+)\]", line)
        if heading:
            here = schema
            for part in heading[1].split("."):
                here = here["properties"][part]
                here = here.get("items", here)
                here = schema["$defs"][here["$ref"].rsplit("/", 1)[1]] if "$ref" in here else here
        key = re.match(r"#?([a-z_0-9]+) = ", line)
        if key:
            arms = here.get("oneOf", ()) if "properties" not in here else (here,)
            assert any(key[1] in arm["properties"] for arm in arms), line
            before = shown.setdefault(here.get("description", "criteria"), set())
            # Each key says what it is for where it first stands, unit, default and reason.
            assert "#" in line[1:] or key[1] in before, line
            before.add(key[1])
    for words, keys in shown.items():
        missing = next(
            (set(one["properties"]) - keys for one in tables(schema) if one.get("description") == words), set()
        )
        # Tables of their own, and the footprint, stand under their headings; a tire's rest in the case of a wheel.
        rest = {"tire", "pavement", "rolling", "footprint", "response", "damage", "layers", "traffic", "climate"}
        rest |= {"criteria", "classes", "calibration", "data", "passes", "aggregates", "reliability", "growth"}
        rest |= {"texture", "crossing", "uniform", "pitch", "remedies", "field_shift"}
        rest |= {"indentation", "drum", "rutting", "modulus_correlation", "from", "overlay"}
        if not (kind != "run" and "[tire]" in words):
            assert missing <= rest, (words, missing)


@pytest.mark.slow
def test_the_first_cases_run(tmp_path):
    result = tl.run(Case.from_text(first_case("run")))
    assert result.verdict is not None
    life = tl.run(Case.from_text(first_case("life")), leave_out=("sensitivity",))
    assert len(life.life.criteria) == 3


@pytest.mark.parametrize("kind", ["run", "life", "calibrate"])
def test_a_schema_has_every_default_and_warns_of_none(kind, recwarn):
    json_schema(kind)
    assert [str(one.message) for one in recwarn] == []


def test_an_unknown_kind_is_told():
    with pytest.raises(tl.InputError, match="no kind of case 'live'; did you mean 'life'"):
        json_schema("live")


def test_a_road_may_come_from_a_backcalculation():
    schema = json_schema("life")
    road = next(
        table for table in tables(schema) if "structure" in table["properties"] and "from" in table["properties"]
    )
    checks = jsonschema.Draft202012Validator({**road, "$defs": schema["$defs"]})
    assert checks.is_valid({"from": "moduli.nc#km 1.2"})
    assert checks.is_valid({"from": "moduli.nc#km 1.2", "overlay": {"mix": "EB-BBSG3", "thickness": "60 mm"}})
    assert not checks.is_valid({"from": "moduli.nc"})
    assert not checks.is_valid({"from": "moduli.nc#km 1.2", "structure": "6 BBSG3 / PF3"})
