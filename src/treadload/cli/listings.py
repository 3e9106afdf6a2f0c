"""What commands list, from files that travel with the package: computing it loads all of the program, for a second.

    python -m treadload.cli.listings

computes the files again, after a change of a law, a quantity, the catalogue or a key of a case;
`tests/cli/test_listings.py` fails where one is out of date. Where another package brings something, what a command
asks for is computed, and no more: a broken package stops no one who does not ask for it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path
from typing import TypedDict

from treadload.templates import KINDS

FOLDER = Path(__file__).parent / "lists"
SHELVES = ("structures", "mixes", "materials", "tires", "belts")


class Shelf(TypedDict):
    """A part of the catalogue. rows: name, what it is, notes. about: texts of names, but for those with a path."""

    use: str
    rows: list[tuple[str, str, list[str]]]
    about: dict[str, str]


def criteria() -> dict[str, dict[str, str]]:
    """Texts of all "quantities" and "laws" of criteria, by name."""
    if _others_bring():
        return _criteria()
    texts: dict[str, dict[str, str]] = json.loads(_kept("criteria"))
    return texts


def criterion(name: str) -> str:
    """The text of one quantity or law. Raises InputError for a word that is neither."""
    for texts in () if _others_bring() else criteria().values():
        if name in texts:
            return texts[name]
    import treadload.case  # noqa: F401  its rooms register what they have
    from treadload.damage import listed

    return str(listed(name))


def catalogue(names: Iterable[str] = SHELVES) -> list[Shelf]:
    """Shelves of the catalogue, of `SHELVES`."""
    if _others_bring():
        return [_shelf(name) for name in names]
    shelves: dict[str, Shelf] = json.loads(_kept("catalogue"))
    return [shelves[name] for name in names]


def about(shelf: str, name: str) -> str:
    """The text about one thing on a shelf. Raises InputError for a name that is not there."""
    texts = {} if _others_bring() else catalogue([shelf])[0]["about"]
    if name in texts:
        return texts[name]
    from treadload import catalogue as catalogues

    return str(getattr(catalogues, shelf).about(name))


def tables() -> list[tuple[str, str]]:
    """Keys of tables of a case, and what they can be, with the package that brings it where it is not treadload."""
    if _others_bring():
        return _tables()
    rows: list[tuple[str, str]] = json.loads(_kept("tables"))
    return rows


def schema(kind: str) -> str:
    """The JSON schema of a case of `KINDS`, as text."""
    return text_of(_schema(kind)) if _others_bring() else _kept(f"schema_{kind}")


def computed() -> dict[str, object]:
    """What each file has, by its name."""
    schemas = {f"schema_{kind}": _schema(kind) for kind in KINDS}
    shelves = {name: _shelf(name) for name in SHELVES}
    return {"criteria": _criteria(), "catalogue": shelves, "tables": _tables(), **schemas}


def text_of(content: object) -> str:
    """What is listed, as its file has it."""
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def _others_bring() -> bool:
    return any(group.startswith("treadload.") for group in metadata.entry_points().groups)


def _kept(name: str) -> str:
    return (FOLDER / f"{name}.json").read_text(encoding="utf-8")


def _criteria() -> dict[str, dict[str, str]]:
    import treadload.case  # noqa: F401  its rooms register what they have
    from treadload.damage import laws_listed, quantities_listed

    return {
        "quantities": {row.name: str(row) for row in quantities_listed()},
        "laws": {row.name: str(row) for row in laws_listed()},
    }


def _shelf(name: str) -> Shelf:
    from treadload import catalogue as catalogues

    shelf = getattr(catalogues, name)
    rows = [
        (name, words, [text for text in (thing.source, *thing.caveats) if text])
        for name, words, thing in shelf.rows()
    ]
    texts = {name: shelf.about(name) for name, _, _ in rows}
    # A file of the package has another place in each installation.
    about_things = {name: text for name, text in texts.items() if str(FOLDER.parents[1]) not in text}
    return {"use": shelf.use, "rows": rows, "about": about_things}


def _tables() -> list[tuple[str, str]]:
    import treadload.case  # these register what they have
    import treadload.footprint
    import treadload.tire.scan.cloud_file  # noqa: F401
    from treadload.registry import ALL

    rows = []
    for registry in ALL:
        named = ", ".join(f"{name} ({package})" if package else name for name, package in registry.packages().items())
        if named:
            rows.append((f"{registry.noun}, {registry.key} = …" if registry.key else registry.noun, named))
    return rows


def _schema(kind: str) -> object:
    from treadload.case.schema import json_schema

    return json_schema(kind)


def write() -> None:
    """Compute the files again."""
    from treadload.files import write_whole

    for name, content in computed().items():
        write_whole(FOLDER / f"{name}.json", text_of(content))


if __name__ == "__main__":
    write()
