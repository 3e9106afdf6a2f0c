"""The form is a case: what is typed, what the reader says of it, whose values they are."""

import asyncio
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest

import treadload.case
from treadload.app.case_schema import CaseSchema
from treadload.app.engines import Engines
from treadload.app.field_errors import at_fields
from treadload.app.form import Form
from treadload.app.form_field import Field
from treadload.app.form_parts import Absent, Choosing, Group, Rows, parts_in
from treadload.app.session import MESHES, Session
from treadload.app.unsolved import left_out, unsolved
from treadload.case import Case
from treadload.case.step import Source
from treadload.contact import Maneuver
from treadload.errors import InputError
from treadload.templates import first_case

ROOT = Path(__file__).parents[2]
CASES = [
    *sorted(path for path in (ROOT / "examples").rglob("*.toml") if path.name != "pyproject.toml"),
    *(Path(treadload.__file__).parent / "templates" / f"{command}.toml" for command in ("run", "life")),
]


def form_of(path):
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    return Form(table, command="life" if "traffic" in table else "run")


def named(path):
    return path.parent.name + "/" + path.name


def fields_of(form, folder="."):
    """All fields of a form by their paths, those of keys that it does not give as well."""
    return {part.path: part for part in parts_in(form.parts(Path(folder))) if isinstance(part, Field)}


def typed(form, path, text):
    """The form with a text in the field of a path."""
    return form.with_text(fields_of(form)[path], text)


def leaves(table, before=""):
    for key, value in enumerate(table) if isinstance(table, list) else table.items():
        if isinstance(value, Mapping | list):
            yield from leaves(value, f"{before}{key}.")
        else:
            yield f"{before}{key}"


@pytest.mark.parametrize("path", CASES, ids=named)
def test_every_value_of_a_case_has_a_field_of_its_own(path):
    """No key is lost, no list or table is shown as a text, and typing what stands there changes nothing."""
    form = form_of(path)
    case = form.check(path.parent).case
    assert case is not None
    parts = list(parts_in(form.parts(path.parent)))
    shown = {part.path for part in parts if isinstance(part, Field | Choosing)}
    lists = {part.path for part in parts if isinstance(part, Field) and part.kind == "list"}
    for leaf in leaves(form.table):
        table, _, last = leaf.rpartition(".")
        kinds = {f"{table}.{key}" for key in ("kind", "law", "quantity")}
        assert leaf in shown or (last.isdigit() and table in lists) or (leaf in kinds and table in shown), leaf
    typed_again = form
    for field in fields_of(form, path.parent).values():
        text = field.shown(form.value(field.path))
        assert not set("{[") & set(text)
        if text:
            typed_again = typed_again.with_text(field, text)
    # One check of all fields: a check each takes minutes for the examples with a climate.
    assert typed_again.check(path.parent).case == case


@pytest.mark.parametrize("path", CASES, ids=named)
def test_every_table_of_an_example_is_solved_or_named(path):
    case = form_of(path).check(path.parent).case
    if case.command == "life":
        # A life is solved whole.
        assert unsolved(case) == []
        return
    solved = {step.name for step in case.steps if step.is_quick or isinstance(step, Source)}
    described = set(case.source.uses)
    for table in case.model_fields_set - {"folder"}:
        assert table in described or table in solved or f"[{table}]" in unsolved(case), table
    assert {step.name for step in case.steps} == solved | set(left_out(case))


def test_the_first_form_is_a_case_of_defaults(tmp_path):
    form = Form.first()
    checked = form.check(tmp_path)
    assert checked.case is not None
    assert checked.case.spacing == 3e-3
    assert not form.yours
    assert Case.from_text(form.to_toml(), folder=tmp_path) == checked.case


@pytest.mark.parametrize(
    ("path", "text", "value", "shown"),
    [
        ("rolling.normal_load", "40", 40e3, "40"),
        ("rolling.normal_load", "4000 N", 4e3, "4"),
        ("rolling.normal_load", "32,5", 32.5e3, "32.5"),
        ("rolling.friction", "0.5", 0.5, "0.5"),
        ("spacing", "6", 6e-3, "6"),
        ("rolling.speed", "72", 20.0, "72"),
    ],
)
def test_a_bare_number_is_in_the_unit_beside_it(tmp_path, path, text, value, shown):
    form = Form.first()
    field = fields_of(form)[path]
    form = form.with_text(field, text)
    here = form.check(tmp_path).case
    for part in path.split("."):
        here = getattr(here, part)
    assert here == pytest.approx(value, rel=1e-14)
    assert field.shown(form.value(path)) == shown
    assert form.is_yours(path)
    assert not form.is_yours("tolerance")


def test_nothing_in_a_field_is_the_default(tmp_path):
    form = typed(typed(Form.first(), "spacing", "6"), "spacing", "")
    assert form.value("spacing") is None
    assert not form.is_yours("spacing")
    assert form.default_of(fields_of(form)["tolerance"], form.check(tmp_path).case) == "1e-06"


def test_depths_are_a_list(tmp_path):
    form = typed(Form.first(), "response.depths", "0, 20, 6 cm")
    assert form.check(tmp_path).case.response.depths == (0.0, 0.02, 0.06)
    field = fields_of(Form.first())["response.depths"]
    assert (field.shown(form.value("response.depths")), field.unit) == ("0, 20, 60", "mm")


@pytest.mark.parametrize(
    ("path", "text", "said"),
    [
        ("rolling.normal_load", "-3", "normal_load"),
        ("rolling.normal_load", "3 mm", "not a unit of this kind"),
        ("rolling.friction", "much", "number"),
        ("spacing", "1,000 mm", "may mean"),
        ("tolerance", "5", "got 5; leave it out for"),
    ],
)
def test_the_sentence_of_the_reader_stands_at_its_field(tmp_path, path, text, said):
    form = typed(Form.first(), path, text)
    checked = form.check(tmp_path)
    assert checked.case is None
    assert said in " ".join(checked.wrong.values())
    assert path in errors_of(form, tmp_path)[0]
    # The same words as the command says.
    with pytest.raises(InputError, match=said):
        Case.from_dict(dict(form.table))


# A key that is added, in one of its forms, and what stands there then.
ADDED = [
    ("run", "tire.profile", "table", "tire.profile.rolling_radius", "522 mm"),
    ("run", "tire.scan", "", "tire.scan", "example"),
    ("run", "tire.undertread", "", "tire.undertread", "5 mm"),
    ("run", "pavement.structure", "", "pavement.temperature", 15),
    ("run", "pavement.layers.0.mix", "", "pavement.temperature", 15),
    ("run", "rolling.creepage_x", "", "rolling.tractive_force", None),
    ("run", "rolling.approach", "", "rolling.normal_load", None),
    ("run", "rolling.friction", "law:pressure", "rolling.friction.law", "pressure"),
    ("run", "pavement.layers.0.bond", "kind:parted", "pavement.layers.0.bond.friction", 0.6),
    ("run", "crossing", "", "crossing.step.rise", "10 mm"),
    ("run", "aggregates", "", "aggregates.window.depth", "12 mm"),
    ("life", "climate.temperature", "", "climate.months", None),
    ("life", "climate.air", "", "climate.air.daily_range", "10 K"),
    ("life", "climate.seasons", "", "climate.seasons.1.temperature", 20),
    ("life", "traffic.classes.0.wheel_load", "", "traffic.classes.0.axle_load", None),
    ("life", "traffic.classes.0.maneuver", "kind:braking", "traffic.classes.0.maneuver.deceleration", "2.5 m/s^2"),
    ("life", "traffic.classes.1.maneuver", "=locked", "traffic.classes.1.maneuvers", None),
    ("life", "traffic.classes.0.maneuvers", "", "traffic.classes.0.maneuvers.0.share", 0.9),
    ("life", "traffic.classes.1.maneuvers.1", "kind:uphill", "traffic.classes.1.maneuvers.1.share", 0.1),
    ("life", "growth", "", "growth.steps", 8),
]


@pytest.mark.parametrize(("command", "path", "shape", "key", "value"), ADDED)
def test_a_key_that_is_added_makes_a_case(tmp_path, command, path, shape, key, value):
    """It begins with something that the reader takes, and what it stands in place of gives way."""
    form = Form.first(command).with_added(path, tmp_path, shape=shape)
    checked = form.check(tmp_path)
    assert checked.case is not None, checked.wrong
    assert form.value(key) == value
    back = form.without(path, tmp_path)
    assert back.value(path) != form.value(path)


@pytest.mark.parametrize(
    ("shape", "maneuver"),
    [
        ("=straight", Maneuver()), ("=locked", Maneuver.braking()), ("kind:braking", Maneuver.braking(2.5)),
        ("kind:uphill", Maneuver.uphill(0.05, 0.25)), ("kind:turning", Maneuver.turning(25, 25 / 3.6)),
    ],
)  # fmt: skip
def test_a_class_does_what_is_chosen(tmp_path, shape, maneuver):
    """As its only maneuver, and as one of several that keeps its name and share."""
    form = Form.first("life").with_added("traffic.classes.0.maneuver", tmp_path, shape=shape)
    several = Form.first("life").with_added("traffic.classes.1.maneuvers.1", tmp_path, shape=shape)
    assert several.value("traffic.classes.1.maneuvers.1.share") == 0.1
    for changed, name in ((form, "front axle"), (several, "driven axle, braking")):
        classes = {one.name: one.maneuver for one in changed.check(tmp_path).case.build_traffic().classes}
        found = classes[name]
        assert (found.tractive, found.lateral, found.spin, found.locked) == pytest.approx(
            (maneuver.tractive, maneuver.lateral, maneuver.spin, maneuver.locked)
        )


def test_rows_come_and_go(tmp_path):
    form = Form.first("life").with_row("traffic.classes", tmp_path).with_row("criteria", tmp_path)
    assert len(form.value("traffic.classes")) == 3
    assert form.check(tmp_path).case is not None
    names = [one.name for one in form.without("criteria.0", tmp_path).check(tmp_path).case.criteria]
    assert names == ["surface, top-down", "platform, rutting", "another criterion"]
    # The soil stays the last of the layers.
    layers = Form.first().with_row("pavement.layers", tmp_path).value("pavement.layers")
    assert [layer["name"] for layer in layers] == ["wearing course", "base", "layer", "soil"]
    road = Form.first("life").with_added("pavement.layers", tmp_path)
    assert "temperature" not in road.table["pavement"]


def test_numbers_of_a_life_are_in_the_unit_of_their_field(tmp_path):
    form = Form.first("life")
    months = "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12"
    for path, text in (("traffic.wander.deviation", "300"), ("traffic.classes.1.axle_load", "120"),
                       ("traffic.years", "30"), ("climate.months", months)):  # fmt: skip
        form = typed(form, path, text)
    case = form.check(tmp_path).case
    traffic, climate = case.build_traffic(), case.build_climate()
    assert traffic.wander.deviation == pytest.approx(0.3)
    # Two wheels on each side of the axle of 120 kN.
    assert traffic.classes[1].wheel_load == pytest.approx(30e3)
    assert traffic.years == 30
    assert [season.temperature for season in climate.seasons] == list(range(1, 13))
    shown = {path: field.shown(Form.first("life").value(path)) for path, field in fields_of(form).items()}
    assert shown["traffic.passes_per_year"] == "60000"
    assert shown["traffic.classes.0.axle_load"] == "70"
    assert shown["reliability.risks"] == "0.05, 0.5, 0.95"


def errors_of(form, folder):
    """Sentences by the path of their field, and those above the form."""
    fields = fields_of(form)
    return at_fields(form.check(folder).wrong, fields, {path: form.value(path) for path in fields})


def test_a_wrong_axle_load_is_named_at_its_field(tmp_path):
    """By the key that the case gives, in its unit; the load of a wheel is made of it."""
    for number in (0, 1):
        path = f"traffic.classes.{number}.axle_load"
        placed, elsewhere = errors_of(typed(Form.first("life"), path, "-5"), tmp_path)
        assert list(placed) == [path]
        assert "Axle load of" in placed[path]
        assert "must be a positive number of kN, got -5; a truck's axle carries 40 to 130" in placed[path]
        assert elsewhere == []


def test_a_sum_of_shares_is_named_at_each_of_the_shares(tmp_path):
    form = Form.first("life")
    classes = {f"traffic.classes.{number}.share" for number in (0, 1)}
    maneuvers = {f"traffic.classes.1.maneuvers.{number}.share" for number in (0, 1)}
    for path, wrong, total in (("traffic.classes.0.share", classes, "0.9"),
                               ("traffic.classes.1.maneuvers.0.share", maneuvers, "0.6")):  # fmt: skip
        placed, elsewhere = errors_of(typed(form, path, "0.5"), tmp_path)
        assert set(placed) == wrong
        assert all(f"must sum to 1, got {total}" in text for text in placed.values())
        assert elsewhere == []


def test_a_layer_is_chosen_among_those_of_the_road():
    field = fields_of(Form.first("life"))["criteria.0.layer"]
    assert list(field.choices) == ["", "EB-BBSG3", "EB-GB3", "PF3"]


def test_parts_of_a_wrong_case_are_shown_as_they_stand(tmp_path):
    """A key that is not known, a table where a number belongs, a list in a list."""
    form = Form({**Form.first().table, "spacing": {"a": [1, {"b": 2}]}, "strange": {"x": {"y": "z"}}})
    parts = list(parts_in(form.parts(tmp_path)))
    paths = {part.path for part in parts if isinstance(part, Field)}
    assert {"spacing.a.0", "spacing.a.1.b", "strange.x.y"} <= paths
    placed, elsewhere = errors_of(form, tmp_path)
    assert "unknown key" in str(placed) + str(elsewhere)


def test_every_table_of_the_schema_can_be_asked_for():
    whole = Form.first().parts(Path())
    tables = {part.path for part in (*whole.parts, *whole.rest) if isinstance(part, Group | Rows | Absent)}
    known = CaseSchema.of("run").root["properties"]
    assert tables == {key for key in known if key not in ("title", "spacing", "tolerance", "road_compliance")}
    assert all(part.words for part in parts_in(whole) if isinstance(part, Field) and "." in part.path)


def test_a_package_that_cannot_be_loaded_is_left_out_and_named(monkeypatch):
    from treadload import registry
    from treadload.case.schema import json_schema

    class Point:
        name, value, group = "gone", "no_such_package:Law", registry.FRICTION.group
        dist = type("Dist", (), {"name": "gone-laws", "version": "1.0"})

        def load(self):
            raise ModuleNotFoundError("no_such_package")

    real = registry.declared_points
    monkeypatch.setattr(
        registry, "declared_points", lambda group, path: (Point(),) if group == Point.group else real(group, path)
    )
    broken = []
    schema = json_schema(broken=broken)
    assert any("gone-laws 1.0" in sentence for sentence in broken)
    assert "friction-law" in schema["$defs"]
    with pytest.raises(InputError, match=r"gone-laws 1\.0"):
        json_schema()


def test_a_file_makes_all_of_its_keys_the_users(tmp_path):
    form = Form.from_text(Form.first().to_toml(), "mine.toml", {})
    assert form.is_yours("rolling.normal_load")
    assert form.is_yours("pavement.layers.0.thickness")
    assert not form.is_yours("tolerance")
    with pytest.raises(InputError, match="valid TOML"):
        Form.from_text("tire = [", "mine.toml", {})
    with pytest.raises(InputError, match="treadload life"):
        Form.from_text(first_case("life"), "mine.toml", {})


@pytest.mark.parametrize(
    "line",
    [
        'height_map = "/etc/passwd"', 'scan = "../../secret.obj"', 'scan = "~/x.obj"', r'scan = "C:\\x.obj"',
        r'scan = "\\\\host\\x.obj"', 'profile = "/etc/x.toml"', 'scan = "a/../../x.obj"',
    ],
)  # fmt: skip
def test_no_path_of_a_browser_is_opened(tmp_path, line):
    table = {**Form.first().table, "tire": tomllib.loads(line)}
    with pytest.raises(InputError, match="no page may open"):
        Form.from_text(Form(table).to_toml(), "mine.toml", {})
    # Nor where it is typed into a field.
    checked = Form(table).check(tmp_path)
    assert checked.case is None
    assert "no page may open" in checked.wrong[""]


def test_units_with_a_slash_are_no_paths(tmp_path):
    form = typed(Form.first().with_added("pavement.structure", tmp_path), "rolling.speed", "70 km/h")
    assert form.check(tmp_path).case is not None


def test_uploaded_files_are_kept_under_names_of_ours():
    session = Session(Engines())
    try:
        kept = session.keep("../../../tmp/evil.obj", b"v 0 0 0", MESHES)
        assert kept.startswith("upload_")
        assert (session.folder / kept).read_bytes() == b"v 0 0 0"
        assert session.folder.stat().st_mode & 0o077 == 0
        assert session.files == {"evil.obj": kept}
        with pytest.raises(InputError, match="none of the files"):
            session.keep("evil.gltf", b"{}", MESHES)
        # A case names it as its user does, and takes it home under that name.
        table = {**Form.first().table, "tire": {"scan": "evil.obj"}}
        form = Form.from_text(Form(table).to_toml(), "mine.toml", session.files)
        assert form.value("tire.scan") == kept
        assert 'scan = "evil.obj"' in session.to_toml(form)
    finally:
        session.close()
    assert not session.folder.exists()


def test_the_case_of_a_wheel_is_no_life_and_no_file_of_the_machine_is_named(tmp_path):
    with pytest.raises(InputError, match="treadload run"):
        Form.from_text(Form.first().to_toml(), "mine.toml", {}, "life")
    weather = Form.first("life").with_values({"climate": {"file": "/etc/passwd"}})
    with pytest.raises(InputError, match="no page may open"):
        Form.from_text(weather.to_toml(), "mine.toml", {}, "life")
    placed, _ = errors_of(typed(Form.first("life"), "traffic.classes.0.axle_load", "3 mm"), tmp_path)
    assert "3 mm" in placed["traffic.classes.0.axle_load"]


def test_two_browsers_share_nothing():
    one, other = Session(Engines()), Session(Engines())
    try:
        run = one.new_run(Form.first(), "mine", "/")
        assert run.name not in other.runs
        assert one.folder != other.folder
        assert len(run.name) == 32
    finally:
        one.close()
        other.close()


def test_what_a_first_form_waits_for_is_read_once(monkeypatch):
    """Pages that are asked for at the same time wait for the same reading; a page without a form waits for none."""
    server = pytest.importorskip("treadload.app.server")
    read = []

    class Counted:
        @staticmethod
        def first(command):
            read.append(command)
            return Form.first(command)

    monkeypatch.setattr(server, "Form", Counted)

    async def several():
        forms = server.FirstForms()
        await asyncio.gather(*(forms.ready(command) for command in ("run", "", "run", "life", "run")))

    asyncio.run(several())
    assert read == ["run", "life"]
