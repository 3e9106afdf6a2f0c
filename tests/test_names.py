"""Names in the source say what a thing is in the field: none of them is a pronoun or a participle."""

from collections import Counter
from pathlib import Path

import treadload
from texts import code_in, code_of

ROOT = Path(treadload.__file__).parent
SOURCES = sorted(ROOT.rglob("*.py"))
# Words that name nothing; in prose they may stand.
EMPTY = frozenset(
    "one own other others told asked found given held made said known some few heard loud".split()  # noqa: SIM905
)
# Words that name nothing inside a longer name either: `own_rows`, `told_counts`.
EMPTY_PARTS = frozenset(("own", "told", "asked", "said"))
# Uses that stand: a field of result files, and what other packages override.
LEFT = {
    "damage/growth/solution.py": 1, "app/page_frame.py": 2, "app/network_page.py": 1, "app/study_page.py": 1,
}  # fmt: skip


def empty_names(names):
    """Those names of variables, parameters, functions, classes and attributes that are such words, counted."""
    return Counter(
        {
            name: count for name, count in names.items()
            if (plain := name.strip("_").casefold()) in EMPTY or EMPTY_PARTS & set(plain.split("_"))
        }
    )  # fmt: skip


def test_names_say_what_a_thing_is():
    empty = {}
    for path in SOURCES:
        names = empty_names(code_of(path)[2])
        names[path.name] += path.stem.strip("_") in EMPTY
        if names.total() > LEFT.get(path.relative_to(ROOT).as_posix(), 0):
            empty[path.relative_to(ROOT).as_posix()] = +names
    assert len(SOURCES) > 500
    assert empty == {}


def test_an_empty_name_is_seen():
    text = "def told(one): return [own for own in one.given if _known]\ntry: pass\nexcept OSError as found: pass"
    assert empty_names(code_in(text)[2]) == {"told": 1, "one": 2, "own": 2, "given": 1, "_known": 1, "found": 1}
    assert empty_names(code_in("said_at = layer(other=1)")[2]) == {"said_at": 1}
    assert empty_names(code_in("told_by, _own_rows = held_back(other=1)")[2]) == {"told_by": 1, "_own_rows": 1}
    assert empty_names(code_in("held_back = layer(other=1)")[2]) == {}
