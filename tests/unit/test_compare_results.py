"""The script that compares the examples of two revisions sees every number, and tells how far it moved."""

import math
import runpy
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "compare_results.py"
names = runpy.run_path(str(SCRIPT))
numbers_of, difference, compare, renamed = (
    names[name] for name in ("numbers_of", "difference", "compare", "renamed")
)


@dataclass
class Made:
    dataset: xr.Dataset
    stats: dict
    title: str = "words are not numbers"


@dataclass
class Both:
    first: Made
    sizes: tuple
    wears: bool


def test_every_number_of_a_result_is_seen():
    data = xr.Dataset({"p": ("x", [1.0, 2.0]), "word": ((), "b")}, {"x": [0.0, 0.5]}, {"dx": 0.5, "unit": "Pa"})
    made = Made(data, {"iterations": 7, "seconds": 0.3})
    seen = dict(numbers_of({"a": Both(made, (3, (4.0, None)), True), "tree": xr.DataTree.from_dict({"/in": data})}))
    assert {name: value.tolist() for name, value in seen.items()} == {
        "a/first/x": [0.0, 0.5],
        "a/first/p": [1.0, 2.0],
        "a/first/attrs/dx": 0.5,
        "a/first/stats/iterations": 7,
        "a/sizes/0": 3,
        "a/sizes/1/0": 4.0,
        "a/wears": True,
        "tree/in/x": [0.0, 0.5],
        "tree/in/p": [1.0, 2.0],
        "tree/in/attrs/dx": 0.5,
    }


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ([1.0, -200.0], [1.5, -200.0], 0.5 / 200),
        ([0.0, 0.0], [0.0, 0.0], 0.0),
        ([0.0], [1e-300], math.inf),
        ([1.0, math.nan], [1.0, math.nan], 0.0),
        ([1.0, math.inf], [1.0, -math.inf], math.inf),
        ([1.0, math.nan], [1.0, 2.0], math.inf),
        ([1.0], [1.0, 1.0], math.inf),
        ([3 + 4j], [3 + 3.5j], 0.1),
        ([True, False], [True, True], 1.0),
    ],
)
def test_a_difference_is_told_over_the_largest_size(before, after, expected):
    assert difference(np.array(before), np.array(after)) == pytest.approx(expected, rel=1e-15)


def test_what_is_missing_or_too_far_is_not_the_same():
    one, near, far = np.array([1.0]), np.array([1.0 + 2e-13]), np.array([1.0 + 1e-11])
    assert compare({"a": one, "b": one}, {"a": one, "b": near}, 1e-12)[1]
    lines, same = compare({"a": one, "b": one}, {"a": near, "b": far}, 1e-12)
    assert not same
    assert "b" in lines[0]
    assert "above the tolerance" in lines[0]
    assert "above" not in lines[1]
    lines, same = compare({"a": one, "old": one}, {"a": one, "new": one}, 1e-12)
    assert not same
    assert [line.strip() for line in lines[-2:]] == ["only before: old", "only after: new"]
    assert compare(renamed({"x/old": one}, {"old": "new"}), {"x/new": one}, 0.0)[1]


def test_all_functions_of_an_example_are_watched(tmp_path):
    script = tmp_path / "example.py"
    script.write_text(
        "import math\n\ndef double(x):\n    return 2 * x\n\n"
        "def main(folder):\n    return {'sum': double(1.5) + double(2.0) + math.sqrt(4)}\n"
    )
    main, found = names["watched"](script)
    assert main(tmp_path) == {"sum": 9.0}
    assert found == {"double": [3.0, 4.0]}


@pytest.mark.skipif(not (SCRIPT.parents[1] / ".git").exists(), reason="these sources are no checkout of git")
def test_a_revision_is_checked_out_and_nothing_is_left():
    with pytest.raises(names["Failed"], match="no revision 'nowhere'"), names["checked_out"]("nowhere"):
        pass
    trees = []

    def fail_in_the_middle():
        with names["checked_out"]("HEAD") as tree:
            trees.append(tree)
            assert (tree / "src" / "treadload" / "__init__.py").is_file()
            raise KeyError("an example that fails")

    with pytest.raises(KeyError, match="an example that fails"):
        fail_in_the_middle()
    assert not trees[0].exists()
    assert str(trees[0]) not in names["git"]("worktree", "list", why="no git")
