"""Citations as BibTeX."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from typing import Any

from treadload._version import __version__
from treadload.case import Case
from treadload.citations import REFERENCES, references
from treadload.deferred import xarray as xr
from treadload.results.schema import read_json

# "Love, A. E. H. (1929). The stress produced ... Phil. Trans. R. Soc. A 228, 377-420."
_WHOLE = re.compile(r"(?P<authors>.+?) \((?P<year>\d{4})\)\. (?P<title>.+?)(?:\. (?P<where>.+?))?\.?$")
_JOURNAL = re.compile(r"(?P<journal>.+?),? (?P<volume>\d+(?:-\d+)?), (?P<pages>[\w-]+)$")
_PUBLISHED = re.compile(r"(?:.*\. )?(?P<publisher>[^.:]*?(?:Press|Kluwer|Holden-Day|Wiley|Springer)[^.:,]*)")
_AUTHOR = re.compile(r"[^,]+, (?:[A-ZÀ-Ý]\.[ -]?)+")


def bibtex(citations: Iterable[str]) -> str:
    """BibTeX of citations as results hold them, behind that of the program itself. Each key once, in order.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> entries = tl.results.bibtex(contact.cites())
    >>> f"{sum(line.startswith('@') for line in entries.splitlines())} entries, that of treadload first"
    '9 entries, that of treadload first'
    """
    taken: set[str] = set()
    entries = [_entry("software", "treadload", {
        "title": "{treadload: what a tire does to a road}", "author": "{The treadload developers}",
        "version": __version__, "year": "2026",
    })]  # fmt: skip
    published = {reference.prose: reference for reference in REFERENCES.values()}
    for text in dict.fromkeys(citations):
        if text in published:
            reference = published[text]
            kind, key, fields = reference.kind, reference.key, {**reference.fields}
            fields["title"] = f"{{{fields['title']}}}"
        else:
            kind, fields = _parsed(text)
            key = _key(fields)
        while key in taken:
            key += "b"
        taken.add(key)
        entries.append(_entry(kind, key, fields))
    return "\n\n".join(entries) + "\n"


def citations_of(source: Case | xr.DataTree) -> list[str]:
    """Citations of the methods that a case will use, or that the tree of a result states it used."""
    if isinstance(source, Case):
        return references(source.cites())
    keys = read_json(source.attrs.get("citations", "[]"), [])
    return [str(key) for key in keys]


def _parsed(text: str) -> tuple[str, dict[str, str]]:
    """Kind and fields of a reference that a law brings as prose; what has no known form stands whole in a note."""
    match = _WHOLE.match(text)
    if match is None:
        return "misc", {"note": text}
    title, where = match["title"], match["where"] or ""
    # A title ends at its first point; the rest is where it was published.
    fields = {"author": _authors(match["authors"]), "year": match["year"], "title": f"{{{title}}}"}
    journal = _JOURNAL.match(where)
    if journal is not None:
        pages = journal["pages"].replace("-", "--")
        return "article", {**fields, "journal": journal["journal"], "volume": journal["volume"], "pages": pages}
    published = _PUBLISHED.match(where)
    if published is not None:
        rest = where[published.end("publisher") :].lstrip(",.: ")
        return "book", {**fields, "publisher": published["publisher"].strip(), **({"note": rest} if rest else {})}
    return "misc", {**fields, **({"note": where} if where else {})}


def _authors(text: str) -> str:
    names = [name.strip(" ,") for name in _AUTHOR.findall(text)]
    return " and ".join(names) if names else f"{{{text}}}"


def _key(fields: dict[str, str]) -> str:
    first = fields.get("author", fields.get("journal", fields.get("note", "source"))).strip("{}")
    words = re.findall(r"[a-z]+", _plain(first.split(",")[0]).lower()) or ["source"]
    return "".join(words[:3])[:24] + fields.get("year", "")


def _plain(text: str) -> str:
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


def _entry(kind: str, key: str, fields: dict[str, Any]) -> str:
    lines = "".join(f"  {name} = {{{_safe(str(value))}}},\n" for name, value in fields.items())
    return f"@{kind}{{{key},\n{lines}}}"


def _safe(text: str) -> str:
    """Letters that TeX reads as commands."""
    return re.sub(r"(?<!\\)([&%#$_])", r"\\\1", text) if "10.3390" not in text else text
