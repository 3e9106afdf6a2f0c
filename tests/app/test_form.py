"""The form is a case: what is typed, what the reader says of it, whose values they are."""

import tomllib

import pytest

from treadload.app import fields as keys
from treadload.app.engines import Engines
from treadload.app.form import Form
from treadload.app.session import MESHES, Session
from treadload.case import Case
from treadload.errors import InputError


def test_the_first_form_is_a_case_of_defaults(tmp_path):
    form = Form.first()
    checked = form.check(tmp_path)
    assert checked.case is not None
    assert checked.case.spacing == 3e-3
    assert not form.yours
    assert Case.from_text(form.to_toml(), folder=tmp_path) == checked.case


@pytest.mark.parametrize(
    ("field", "text", "value", "shown"),
    [
        (keys.LOAD, "40", 40e3, "40"),
        (keys.LOAD, "4000 N", 4e3, "4"),
        (keys.LOAD, "32,5", 32.5e3, "32.5"),
        (keys.FRICTION, "0.5", 0.5, "0.5"),
        (keys.SPACING, "6", 6e-3, "6"),
        (keys.SPEED, "72", 20.0, "72"),
    ],
)
def test_a_bare_number_is_in_the_unit_beside_it(tmp_path, field, text, value, shown):
    form = Form.first().with_text(field, text)
    case = form.check(tmp_path).case
    here = case
    for part in field.path.split("."):
        here = getattr(here, part)
    assert here == pytest.approx(value, rel=1e-14)
    assert field.shown(form.value(field.path)) == shown
    assert form.is_yours(field.path)
    assert not form.is_yours("tolerance")


def test_nothing_in_a_field_is_the_default(tmp_path):
    form = Form.first().with_text(keys.SPACING, "6").with_text(keys.SPACING, "")
    assert form.value("spacing") is None
    assert not form.is_yours("spacing")
    assert keys.default_of(keys.TOLERANCE, form.check(tmp_path).case) == "1e-06"


def test_depths_are_a_list(tmp_path):
    form = Form.first().with_text(keys.DEPTHS, "0, 20, 6 cm")
    assert form.check(tmp_path).case.response.depths == (0.0, 0.02, 0.06)
    assert keys.DEPTHS.shown(form.value("response.depths")) == "0 mm, 20 mm, 60 mm"


@pytest.mark.parametrize(
    ("field", "text", "said"),
    [
        (keys.LOAD, "-3", "normal_load"),
        (keys.LOAD, "3 mm", "not a unit of this kind"),
        (keys.FRICTION, "much", "number"),
        (keys.SPACING, "1,000 mm", "may mean"),
        (keys.TOLERANCE, "5", "1e-6 is the default"),
    ],
)
def test_the_sentence_of_the_reader_stands_at_its_field(tmp_path, field, text, said):
    form = Form.first().with_text(field, text)
    checked = form.check(tmp_path)
    assert checked.case is None
    known = {"rolling.normal_load", "rolling.friction", "spacing", "tolerance"}
    told = checked.at(field.path, known) or " ".join(checked.elsewhere(known))
    assert said in told
    # The same words as the command says.
    with pytest.raises(InputError, match=said):
        Case.from_dict(dict(form.table))


def test_choices_above_the_fields_are_of_the_case(tmp_path):
    form = Form.first()
    for state in keys.STATES:
        for by_force in (True, False):
            moved = form.with_state(state, by_force=by_force)
            assert moved.check(tmp_path).case is not None, (state, moved.check(tmp_path).wrong)
            assert moved.state == state
    assert form.with_state("braking", by_force=True).check(tmp_path).case.build_rolling().tractive_force == -10e3
    for road in keys.ROADS:
        assert form.with_road(road).check(tmp_path).case is not None
        assert form.with_road(road).road == road
    for surface in ("library", "profile", "example"):
        assert form.with_surface(surface).check(tmp_path).case is not None
        assert form.with_surface(surface).surface == surface
    assert form.surface == "library"


def test_a_file_makes_all_of_its_keys_the_users(tmp_path):
    form = Form.from_text(Form.first().to_toml(), "mine.toml", {})
    assert form.is_yours("rolling.normal_load")
    assert form.is_yours("pavement.layers.0.thickness")
    assert not form.is_yours("tolerance")
    with pytest.raises(InputError, match="valid TOML"):
        Form.from_text("tire = [", "mine.toml", {})
    with pytest.raises(InputError, match="treadload life"):
        Form.from_text("[traffic]\nfile = 'x'\n[[criteria]]\nlaw = 'x'", "mine.toml", {})


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
    form = Form.first().with_road("structure").with_text(keys.SPEED, "70 km/h")
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


def test_two_browsers_share_nothing():
    one, other = Session(Engines()), Session(Engines())
    try:
        run = one.new_run(one.forms["bench"], "mine", "bench")
        assert run.name not in other.runs
        assert one.folder != other.folder
        assert len(run.name) == 32
    finally:
        one.close()
        other.close()
