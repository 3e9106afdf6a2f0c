"""Where the methods of treadload were published: `references.bib`, as data and as prose.

The field `keywords` of an entry is the key of the method, by which results and steps name it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import resources

# An entry and a field of `references.bib`, which has a field a line.
_ENTRY = re.compile(r"^@(\w+)\{(\w+),\n(.*?)^\}", re.MULTILINE | re.DOTALL)
_FIELD = re.compile(r"^  (\w+) = \{(.*)\},$", re.MULTILINE)


@dataclass(frozen=True)
class Reference:
    """An entry of BibTeX. kind: article, book, ... key: of the entry. fields: by name, in order."""

    kind: str
    key: str
    fields: Mapping[str, str]

    @property
    def prose(self) -> str:
        """The reference as a line of a list."""
        entry = {name: value.strip("{}").replace("--", "-") for name, value in self.fields.items()}
        issue = entry.get("volume", "") + (f"({entry['number']})" if "number" in entry else "")
        if "author" not in entry:
            where = f"{entry['journal']} {entry['year']}, {issue}, {entry['pages']}. {entry['title']}."
            return f"{where} doi:{entry['doi']}"
        place = {
            "article": f"{entry.get('journal')} {issue}, {entry.get('pages')}",
            "inproceedings": f"{entry.get('booktitle')}, {entry.get('pages')}",
            "book": entry.get("publisher", ""),
        }.get(self.kind, "")
        where = ", ".join(part for part in (place, entry.get("note", "")) if part)
        parts = (f"{entry['author'].replace(' and ', ', ')} ({entry['year']})", entry["title"], where)
        return ". ".join(part for part in parts if part) + "."


def _read() -> dict[str, Reference]:
    text = resources.files("treadload").joinpath("references.bib").read_text(encoding="utf-8")
    entries = {}
    for kind, key, lines in _ENTRY.findall(text):
        fields = dict(_FIELD.findall(lines))
        entries[fields.pop("keywords")] = Reference(kind, key, fields)
    return entries


REFERENCES = _read()
"""Entries by the key of their method."""
CITATIONS = {method: reference.prose for method, reference in REFERENCES.items()}
"""The same as prose."""

COMMONLY_QUOTED = "as commonly quoted, not checked against the source"
"""What caveats state of a number in common use for which no document and no program was found that prints it."""

SOLVED_WHOLE = ("influence", "convolution", "normal", "preconditioner", "rolling", "newton", "stress")
"""Methods of a wheel on a road, from the contact to the stresses."""
DENTS = ("influence", "convolution", "normal", "preconditioner", "eigenstrain", "dents", "mixing")
PASSES = ("eigenstrain", "passes", "mixing")
BLOCKS = ("blocks", "coupling", "mixing")
STONES = ("equivalence", "inclusions", "eigenstrain")
TEXTURE = ("endless", "normal", "persson")


def references(keys: Iterable[str]) -> list[str]:
    """References of methods, each once, behind that of the method as a whole.

    keys: of `CITATIONS`; any other text is a whole reference.
    """
    return [CITATIONS.get(key, key) for key in dict.fromkeys(("chain", *keys))]
