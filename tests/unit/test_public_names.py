"""The names at the top: stated once, in the stub, and what else is where."""

import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import treadload as tl
from treadload import variables
from treadload.contact.bodies import influence

ROOT = Path(tl.__file__).parent
CLONE = Path(__file__).parents[2]
STUB = (ROOT / "__init__.pyi").read_text(encoding="utf-8")
ROOMS = (
    *("catalogue", "contact", "damage", "footprint", "life", "materials", "pavement"),
    *("plots", "response", "results", "roads", "steps", "sweeps", "tire"),
)


def test_the_stub_states_every_public_name_once():
    # Each statement of the stub makes one public name, and nothing else does.
    statements = [line for line in STUB.partition('"""\n\n')[2].splitlines() if line]
    stated = [re.fullmatch(r"from treadload[\w.]* import (\w+) as \1", line)[1] for line in statements]
    assert sorted(stated) == sorted(set(stated)) == dir(tl) == tl.__all__
    assert all(getattr(tl, name) is not None for name in stated)
    own = (ROOT / "__init__.py").read_text(encoding="utf-8")
    assert not [name for name in stated if re.search(rf"\b{name}\b", own.rpartition('"""')[2])]


def test_at_most_forty_names_rooms_included():
    rooms = [name for name in dir(tl) if isinstance(getattr(tl, name), ModuleType)]
    assert rooms == list(ROOMS)
    assert len([name for name in dir(tl) if not name.startswith("_")]) <= 40
    # What a completion shows is the user's, not the machinery's.
    assert not {"Any", "importlib", "annotations", "TYPE_CHECKING"} & set(dir(tl))


@pytest.mark.parametrize("room", ROOMS)
def test_rooms_say_what_they_offer(room):
    module = getattr(tl, room)
    assert sorted(module.__all__) == sorted(set(module.__all__))
    assert all(hasattr(module, name) for name in module.__all__)
    assert module.__doc__


def test_friction_laws_can_be_reached():
    wheel = tl.Rolling(normal_load=1e3, friction=tl.contact.friction.Anisotropic(along=0.8, across=0.6))
    assert wheel.friction.along == 0.8


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("Prony", "materials.Prony"),
        ("AxleClass", "damage.AxleClass"),
        ("creep_curve", "contact.creep_curve"),
        ("write_csv", "results.write_csv"),
        ("life_sensitivity", "life.life_sensitivity"),
        ("TreadProfile", "tire.TreadProfile"),
        ("structures", "catalogue.structures"),
        ("plan_sweep", "sweeps.plan_sweep"),
        ("CalibrationStep", "steps.CalibrationStep"),
    ],
)
def test_names_of_a_room_tell_where_they_are(name, place):
    with pytest.raises(AttributeError, match=rf"^treadload\.{name} is treadload\.{place}$"):
        getattr(tl, name)
    # The place that is told exists.
    found = tl
    for part in place.split("."):
        found = getattr(found, part)


def test_a_name_that_is_nowhere():
    with pytest.raises(AttributeError, match="no attribute 'solve_contacts'; did you mean 'solve_contact'"):
        _ = tl.solve_contacts
    with pytest.raises(AttributeError, match="no attribute 'SOLVE_CONTACT'; did you mean 'solve_contact'"):
        _ = tl.SOLVE_CONTACT
    with pytest.raises(AttributeError, match=r"no attribute 'zzz'$"):
        _ = tl.zzz


def test_notebooks_that_look_for_hidden_names_load_nothing():
    code = (
        "import sys, treadload; hasattr(treadload, '_repr_html_'), dir(treadload);"
        "print(*[name for name in sys.modules if name.startswith(('treadload.', 'numpy', 'xarray', 'matplotlib'))])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == {"treadload._public"}


def test_what_the_readme_and_the_examples_name_exists():
    pages = [CLONE / "README.md", *(CLONE / "docs").rglob("*.md"), *(CLONE / "examples").rglob("*.py")]
    pages += (CLONE / "benchmarks").glob("*.py")
    # It tells names that moved.
    pages.remove(CLONE / "docs" / "development_history.md")
    named = {name for page in pages for name in re.findall(r"\btl((?:\.[A-Za-z_]\w*)+)", page.read_text("utf-8"))}
    assert len(named) > 40
    for name in named:
        found = tl
        for part in name[1:].split("."):
            found = getattr(found, part)


def test_the_first_block_of_the_readme_needs_the_top_only():
    code = re.findall(r"```python\n(.*?)```", (CLONE / "README.md").read_text("utf-8"), re.DOTALL)[0]
    assert len(code.partition("\n\n")[2].splitlines()) == 5
    assert set(re.findall(r"\btl\.(\w+)", code)) <= set(dir(tl)) - set(ROOMS)


def test_the_glossary_names_what_there_is():
    text = (CLONE / "docs" / "explanation" / "glossary.md").read_text("utf-8")
    rows = [line.split(" | ") for line in text.splitlines() if line.startswith("| ")]
    assert len(rows) > 40
    assert {len(row) for row in rows} == {6}
    homes = [tl, *(getattr(tl, room) for room in ROOMS), influence, tl.materials.Prony, tl.Tire]
    for row in rows:
        for name in re.findall(r"`\.?([A-Za-z][\w.]*[a-z\w])`", row[4]):
            first, _, rest = name.partition(".")
            known = [getattr(home, first) for home in homes if first in dir(home)]
            assert known or name in variables.VARIABLES, name
            assert not rest or hasattr(known[0], rest) or rest in known[0].__annotations__, name


@pytest.mark.slow
def test_a_type_checker_sees_the_types(tmp_path):
    # mypy takes the stub for the package: names have their types, others are errors.
    pytest.importorskip("mypy")
    (tmp_path / "use.py").write_text(
        "import treadload as tl\n"
        "reveal_type(tl.solve_contact)\nreveal_type(tl.contact.friction.Coulomb(0.7))\n"
        "reveal_type(tl.catalogue.mixes)\ntl.Prony\n"
    )
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--follow-imports=silent", "use.py"],
        cwd=tmp_path, capture_output=True, text=True, env={"MYPYPATH": str(ROOT.parent)},
    )  # fmt: skip
    said = done.stdout
    assert "-> treadload.contact.solution.Contact" in said
    assert 'Revealed type is "treadload.contact.friction.laws.Coulomb"' in said
    assert "treadload.named.Catalogue[treadload.materials.mixture.Mix" in said
    assert 'Module has no attribute "Prony"' in said
