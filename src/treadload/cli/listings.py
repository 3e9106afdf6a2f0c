"""What commands list, from files that travel with the package: computing it loads all of the program, for a second.

    python -m treadload.cli.listings

computes the files again, after a change of a law, a quantity, the catalogue or a key of a case;
`tests/cli/test_listings.py` fails where one is out of date. Where another package brings something, all is computed.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import TypedDict, TypeVar

Content = TypeVar("Content")

FOLDER = Path(__file__).parent / "lists"
SHELVES = ("structures", "mixes", "materials", "tires", "belts")
KINDS = ("run", "life", "calibrate")


class Shelf(TypedDict):
    """A part of the catalogue. rows: name, what it is, and notes. about: a text of each name."""

    use: str
    rows: list[tuple[str, str, list[str]]]
    about: dict[str, str]


def criteria() -> dict[str, dict[str, str]]:
    """Texts of all "quantities" and "laws" of criteria, by name."""
    return _listing("criteria", _criteria)


def catalogue() -> dict[str, Shelf]:
    """The shelves of the catalogue, by `SHELVES`."""
    return _listing("catalogue", _catalogue)


def tables() -> list[tuple[str, str]]:
    """Keys of tables of a case, and what they can be, with the package that brings it where it is not treadload."""
    return _listing("tables", _tables)


def schema(kind: str) -> object:
    """The JSON schema of a case of `KINDS`."""
    return _listing(f"schema_{kind}", partial(_schema, kind))


def computed() -> dict[str, object]:
    """What each file has, by its name."""
    schemas = {f"schema_{kind}": _schema(kind) for kind in KINDS}
    return {"criteria": _criteria(), "catalogue": _catalogue(), "tables": _tables(), **schemas}


def text_of(content: object) -> str:
    """A listing as its file has it, and as a schema is printed."""
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def _listing(name: str, compute: Callable[[], Content]) -> Content:
    if any(group.startswith("treadload.") for group in metadata.entry_points().groups):
        return compute()
    content: Content = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    return content


def _criteria() -> dict[str, dict[str, str]]:
    import treadload.case  # noqa: F401  its rooms register what they have
    from treadload.damage import laws_listed, quantities_listed

    return {
        "quantities": {row.name: str(row) for row in quantities_listed()},
        "laws": {row.name: str(row) for row in laws_listed()},
    }


def _catalogue() -> dict[str, Shelf]:
    from treadload import catalogue

    shelves: dict[str, Shelf] = {}
    for kind in SHELVES:
        shelf = getattr(catalogue, kind)
        rows = [
            (name, words, [text for text in (item.source, *item.caveats) if text])
            for name, words, item in shelf.rows()
        ]
        shelves[kind] = {"use": shelf.use, "rows": rows, "about": {name: shelf.about(name) for name, _, _ in rows}}
    return shelves


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
