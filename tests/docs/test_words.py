"""Words of the field: terms that pages, messages, labels, help texts and docstrings avoid, and what to write instead.

The terms are those of the project's style: results do not act, and a thing has the name that the field gives it.
"""

import re
from functools import cache

import pytest

from texts import CLONE, PAGES, ROOT, docstrings, prose, sentences
from treadload import variables

# Term, and what to write instead.
EVERYWHERE = {
    r"\b(?:tells?|told|telling)\b": "states, shows, determines, distinguishes",
    r"\b(?:says?|said|saying)\b": "states, shows, predicts",
    r"\b(?:feels?|felt)\b": "depends on, is affected by",
    r"\b(?:bears|borne)\b": "carries; reaches",
    r"\bdoubts?\b|\bdoubted\b": "caveat",
    r"\banew\b": "again",
    r"\bto be had\b": "available",
    r"\bwho does it\b|\bby whom\b": "governing criterion",
    r"\b(?:[Ff]orces?|[Cc]reepages?) aside\b": "lateral force, lateral creepage",
    r"\bno end\b": "infinite; no limit",
    r"\bpasses it bears\b": "allowable load repetitions",
    r"\b(?:laid|[Ll]ay it) beside\b": "compared with",
    r"\b[Ff]rom memory\b": "the source; or: as commonly quoted, not checked against the source; or: estimated",
}
# Physical things stand, and a model stands for something; numbers, sentences and keys are.
STANDS = {
    r"\b[Ss]t(?:ands?|ood) (?:in (?!for\b)|under|behind|beside|below|between|twice|alone|outermost|at the\b)": (
        "is, is given in"
    ),
}
PAGES_ALONE = STANDS | {
    r"\brefused in a sentence\b|, each in a sentence\b": "raises an `InputError` that explains why",
    r"\b[Rr]oads? with a grain\b": "cross-anisotropic layers",
    r"\b[Ww]hen layers part\b": "interface debonding",
    r"\b[Yy]ears with a probability\b": "reliability of the service life",
    r"\bstones in mortar\b": "aggregate-scale model",
    r"\bthe house\b|\b(?:its|the) rooms?\b": "architecture, subpackages",
    r"\b[Vv]erdicts?\b": "assessment",
    r"\bthe road extends\b": "the tensile strain reaches",
}
# Of a docstring as well, where the name of an argument or a class may stand.
DOCSTRINGS = EVERYWHERE | {
    r"\b[Rr]oads? with a grain\b": "cross-anisotropic layers",
    r"\b[Ww]hen layers part\b": "interface debonding",
    r"\b[Yy]ears with a probability\b": "reliability of the service life",
    r"\bstones in mortar\b": "aggregate-scale model",
    r"\bof the house\b|\bthe house's\b": "package",
    r"\b(?:[Aa]n?|[Tt]he|[Ii]ts) verdicts?\b": "assessment",
    r"\bthe road extends\b": "the tensile strain reaches",
}


def faults(text, terms):
    """Terms that a text has, each with what to write instead."""
    text = " ".join(text.split())
    if not any_of(tuple(terms)).search(text):
        return []
    return [f"{found[0]!r}: write {better}" for term, better in terms.items() if (found := re.search(term, text))]


@cache
def any_of(terms):
    """One pattern for all terms: nearly all texts have none."""
    return re.compile("|".join(terms))


def faults_of(paths, texts, terms, root=ROOT):
    """Faults of the texts of files, by file."""
    assert paths
    found = {
        path.relative_to(root).as_posix(): [fault for text in texts(path) for fault in faults(text, terms)]
        for path in paths
    }
    return {name: wrong for name, wrong in found.items() if wrong}


MODULES = sorted(ROOT.rglob("*.py"))


def test_pages_have_the_words_of_the_field():
    assert faults_of(PAGES, lambda page: [prose(page)], EVERYWHERE | PAGES_ALONE, CLONE) == {}


def test_labels_have_the_words_of_the_field():
    texts = [
        *(row[1] for row in variables.VARIABLES.values()),
        *(variables.display_of(name).label for name in variables.VARIABLES),
    ]
    assert len(texts) > 500
    assert faults("; ".join(texts), EVERYWHERE) == []


def test_messages_have_the_words_of_the_field():
    assert faults_of(MODULES, sentences, EVERYWHERE | STANDS) == {}


def test_docstrings_have_the_words_of_the_field():
    # The pages of the browser have no public names.
    assert faults_of([path for path in MODULES if path.parent.name != "app"], docstrings, DOCSTRINGS) == {}


def test_docstrings_are_found():
    texts = list(docstrings(ROOT / "materials" / "elastic.py"))
    assert len(texts) > 3
    assert any("Isotropic" in text or "isotropic" in text for text in texts)


@pytest.mark.parametrize("path", sorted((ROOT / "templates").glob("*.toml")), ids=lambda path: path.name)
def test_templates_have_the_words_of_the_field(path):
    comments = re.findall(r"#.*", path.read_text("utf-8"))
    assert len(comments) > 10
    assert faults(" ".join(comments), EVERYWHERE | {r"\bverdicts?\b": "assessment"}) == []


# Caveats and sources of the catalogue are shown to users, and examples are read by them.
@pytest.mark.parametrize(
    "path",
    sorted(
        path
        for folder, kinds in (
            (ROOT / "catalogue" / "data", ("toml", "md")),
            (CLONE / "examples", ("py", "toml", "md")),
        )
        for kind in kinds
        for path in folder.rglob(f"*.{kind}")
    ),
    ids=lambda path: path.relative_to(path.parents[2]).as_posix(),
)
def test_catalogue_and_examples_name_their_sources(path):
    source = {term: better for term, better in EVERYWHERE.items() if "memory" in term}
    assert len(source) == 1
    assert faults(path.read_text("utf-8").replace("\n#", "\n"), source) == []


def test_a_fault_is_found():
    assert faults("What it\ntells", EVERYWHERE) == ["'tells': write states, shows, determines, distinguishes"]
    assert faults("a verdict on roads with a grain", PAGES_ALONE) != []
    assert faults("its constants are from\nmemory", EVERYWHERE) != []
    assert faults("the report states the storytelling", EVERYWHERE | PAGES_ALONE) == []
