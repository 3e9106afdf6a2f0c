"""Names in the source say what a thing is in the field: none of them is a pronoun or a participle."""

import ast
from collections import Counter
from pathlib import Path

import pytest

import treadload

ROOT = Path(treadload.__file__).parent
SOURCES = sorted(ROOT.rglob("*.py"))
# Words that name nothing; in prose they may stand.
EMPTY = frozenset(
    "one own other others told asked found given held made said known some few heard loud".split()  # noqa: SIM905
)
# Uses that stand: a field of result files.
LEFT = {"damage/growth/solution.py": 1}


def empty_names(text):
    """Names of variables, parameters, functions, classes and attributes that are such words, with their counts."""
    names = Counter()
    for node in ast.walk(ast.parse(text)):
        for field in ("id", "arg", "name", "attr"):
            name = getattr(node, field, None)
            if isinstance(name, str) and not isinstance(node, ast.alias | ast.keyword):
                names[name] += name.strip("_").casefold() in EMPTY
    return +names


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_names_say_what_a_thing_is(path):
    assert path.stem.strip("_") not in EMPTY
    names = empty_names(path.read_text(encoding="utf-8"))
    assert names.total() <= LEFT.get(path.relative_to(ROOT).as_posix(), 0), dict(names)


def test_an_empty_name_is_seen():
    text = "def told(one): return [own for own in one.given if _known]\ntry: pass\nexcept OSError as found: pass"
    assert empty_names(text) == {"told": 1, "one": 2, "own": 2, "given": 1, "_known": 1, "found": 1}
    assert empty_names("said_at = layer(other=1)") == {}
