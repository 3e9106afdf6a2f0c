"""Steps of other packages that cannot work: each is refused in a sentence with the name of the package."""

import subprocess
import sys
from pathlib import Path

import pytest

import treadload as tl
from cases import COARSE_CASE
from packages import build, forget
from treadload.app.form import Form
from treadload.case import Case
from treadload.composing import BaseResult

SOURCE = str(Path(tl.__file__).parents[1])

STEP = '''
"""A step that counts the cells that touch."""
from dataclasses import dataclass
from typing import ClassVar

import xarray as xr

from treadload.composing import BaseResult
from treadload.rows import row
from treadload.steps import Step
from treadload.variables import Display


@dataclass(frozen=True, eq=False, repr=False)
class CountOf{name}(BaseResult, group="{name}"):
    dataset: xr.Dataset

    def rows(self):
        return (row("cells", float(self.dataset["cells"]), display=Display("cells that touch", "", ".0f")),)


class Step_{name}(Step, name="{name}"):
    """`[{name}]`: how many cells touch.

    least: pressure of a cell that counts, Pa.
    """

    after: ClassVar = {after}

    least: float = 0.0

    def solve(self, scene):
        cells = scene.result("contact").dataset["pressure"] > self.least
        return CountOf{name}(xr.Dataset({{"cells": cells.sum()}}))
'''


def step_text(name, *after):
    return STEP.format(name=name, after=after or ("contact",))


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Build packages with one step each: name of the package → its entry points and the text of its module."""
    installed = []

    def build_all(**packages):
        for name, (points, text) in packages.items():
            declared = "[treadload.steps]\n" + "".join(f"{key} = {place}\n" for key, place in points.items())
            build(tmp_path / name, name, declared, step=text)
            monkeypatch.syspath_prepend(str(tmp_path / name))
            installed.append(name)
        return tmp_path

    yield build_all
    for name in installed:
        forget(name)


# A wheel on a road, without stress, strain and damage.
PRESSED = COARSE_CASE.partition("[response]")[0].replace("12 mm", "24 mm").replace('"10 kN"', "0")


def case_with(*tables):
    return PRESSED + "".join(f"\n[{table}]\n" for table in tables)


def refusal(text):
    with pytest.raises(tl.InputError) as refused:
        Case.from_text(text)
    message = str(refused.value)
    assert "\n" not in message
    return message


def test_a_package_whose_import_fails_is_named_where_a_case_names_its_table(install):
    install(torn_steps=({"torn": "torn_steps.step:Torn"}, "import nowhere_at_all\n"))
    message = refusal(case_with("torn"))
    assert "the package torn-steps 1.2 brings 'torn'" in message
    assert "ModuleNotFoundError(\"No module named 'nowhere_at_all'\")" in message
    assert "repair that package or remove it" in message
    # It stops nobody who does not ask for it.
    assert Case.from_text(COARSE_CASE).steps[0].name == "contact"
    assert Form.first().parts(Path())


def test_what_is_no_class_of_a_step_is_named_with_its_package(install):
    install(odd_steps=({"odd": "odd_steps.step:odd"}, "def odd():\n    return 1\n"))
    message = refusal(case_with("odd"))
    assert "the step 'odd' of the package odd-steps 1.2 must be a class of treadload.steps.Step" in message


def test_two_packages_with_one_table_are_both_named(install):
    install(
        first_steps=({"cells": "first_steps.step:Step_cells"}, step_text("cells")),
        second_steps=({"cells": "second_steps.step:Step_cells"}, step_text("cells")),
    )
    message = refusal(case_with("cells"))
    assert "the step 'cells' comes from the package" in message
    assert "first-steps 1.2" in message
    assert "second-steps 1.2" in message
    assert "rename one of them, or remove a package" in message


@pytest.mark.parametrize("table", ["crossing", "damage", "contact"])
def test_a_table_of_ours_that_a_package_takes_is_refused_with_its_name(install, table):
    install(greedy_steps=({table: "greedy_steps.step:Greedy"}, "Greedy = None\n"))
    message = refusal(COARSE_CASE)
    assert f"the step {table!r} comes from treadload and from the package greedy-steps 1.2" in message
    assert "rename one of them, or remove a package" in message


@pytest.mark.parametrize("key", ["tire", "rolling", "title"])
def test_a_key_of_a_case_that_a_package_takes_is_refused_with_its_name(install, key):
    install(greedy_steps=({key: f"greedy_steps.step:Step_{key}"}, step_text(key)))
    message = refusal(COARSE_CASE)
    assert (
        f"the step {key!r} of the package greedy-steps 1.2 has the name of a key of every case; rename it" in message
    )


def test_a_circle_of_steps_is_refused_with_their_packages(install):
    install(
        left_steps=({"left": "left_steps.step:Step_left"}, step_text("left", "right")),
        right_steps=({"right": "right_steps.step:Step_right"}, step_text("right", "left")),
    )
    message = refusal(case_with("left", "right"))
    assert "'left' of the package left-steps 1.2" in message
    assert "'right' of the package right-steps 1.2" in message
    assert "their `after` is a circle; leave one of them out" in message


def test_a_step_that_needs_what_nobody_makes_is_refused_with_its_package(install):
    install(hungry_steps=({"hungry": "hungry_steps.step:Step_hungry"}, step_text("hungry", "lunch")))
    message = refusal(case_with("hungry"))
    assert "[hungry] of the package hungry-steps 1.2 comes after 'lunch', which no step of this case makes" in message
    assert "it has contact, " in message


def test_a_step_that_returns_no_result_is_named_with_its_package(install):
    solved = 'return CountOfcells(xr.Dataset({"cells": cells.sum()}))'
    text = step_text("cells")
    assert solved in text
    text = text.replace(solved, "return 3")
    install(loose_steps=({"cells": "loose_steps.step:Step_cells"}, text))
    with pytest.raises(tl.InputError) as refused:
        tl.run(Case.from_text(case_with("cells")))
    assert "'cells' of the package loose-steps 1.2" in str(refused.value)
    assert "got int" in str(refused.value)


@pytest.mark.slow
def test_a_file_whose_step_is_not_installed_opens_as_data_and_names_the_package(install, tmp_path):
    install(my_steps=({"cells": "my_steps.step:Step_cells"}, step_text("cells")))
    result = tl.run(Case.from_text(case_with("cells")))
    count = float(result.cells.dataset["cells"])
    path = tl.save_results(result, tmp_path / "x.nc")
    assert isinstance(tl.open_results(path).cells, BaseResult)
    code = (
        "import treadload as tl; r = tl.open_results('x.nc'); "
        "print(float(r.cells.dataset['cells'])); print(*r.cells.warnings); print(r.contact.title)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env={"PYTHONPATH": SOURCE, "PATH": ""},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    first, warning, title = done.stdout.splitlines()
    assert float(first) == count
    assert "CountOfcells" in warning
    assert "my-steps 1.2" in warning
    assert title == "Contact"
