"""Spelling of pages, messages and docstrings: the words of pyspellchecker's English list, and the terms of the field.

A word that is right and not in the list belongs into `docs/spelling_terms.txt`.
"""

import re

import pytest

from texts import CLONE, PAGES, ROOT, docstrings, prose, sentences

TERMS = CLONE / "docs" / "spelling_terms.txt"
# Its columns are French and German.
OTHER_LANGUAGES = {"words.md"}
# Targets of links, formulas, roles and HTML are no prose.
NO_PROSE = re.compile(r"\]\([^)]*\)|\$[^$]*\$|\w+:\S+|\{[^}]*\}|<[^>]*>|https?://\S+")
# Names of files, attributes and units in products have a mark beside them.
WORD = re.compile(r"(?<![\w/.\\@-])[A-Za-zÀ-ɏ]+(?:['’][a-z]+)?(?![\w/\\@(=]|\.\w)")
# Abbreviations and symbols are shorter.
SHORTEST = 4


@pytest.fixture(scope="module")
def known():
    checker = pytest.importorskip("spellchecker").SpellChecker(distance=1)
    checker.word_frequency.load_words(terms())
    return checker


def terms():
    """The terms of the field, each with its plural."""
    lines = [line.partition("#")[0].split() for line in TERMS.read_text("utf-8").splitlines()]
    words = [word.lower() for line in lines for word in line]
    return [*words, *(f"{word}s" for word in words)]


def unknown(text, checker):
    """Words of a text that are neither English nor terms of the field, in order of the alphabet."""
    words = {re.sub(r"['’]s?$", "", word) for word in WORD.findall(NO_PROSE.sub(" ", text))}
    # Abbreviations are in capitals, names of code in both.
    plain = {word.lower() for word in words if len(word) >= SHORTEST and word[1:].islower()}
    return sorted(checker.unknown(plain))


@pytest.mark.parametrize(
    "page",
    [page for page in PAGES if page.name not in OTHER_LANGUAGES],
    ids=lambda page: page.relative_to(CLONE).as_posix(),
)
def test_pages_are_spelt_well(page, known):
    assert unknown(prose(page), known) == []


@pytest.mark.parametrize(
    "folder", sorted({path.parent for path in ROOT.rglob("*.py")}), ids=lambda path: path.relative_to(ROOT).as_posix()
)
def test_messages_and_docstrings_are_spelt_well(folder, known):
    for path in sorted(folder.glob("*.py")):
        assert unknown("\n".join([*sentences(path), *docstrings(path)]), known) == [], path.name


def test_a_misspelt_word_is_found(known):
    text = "The tyer's viscoelastic presure at [a lnik](to/nowhree.md) of the `Case.presure`, creepages"
    assert unknown(text, known) == ["lnik", "presure", "tyer"]


def test_each_term_is_stated_once():
    words = [line for line in TERMS.read_text("utf-8").splitlines() if line and not line.startswith("#")]
    assert len(words) == len(set(words)) > 300
    assert all(len(word.split()) == 1 for word in words)
