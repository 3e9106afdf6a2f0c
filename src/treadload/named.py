"""Named things from data files, ours and those that other packages bring along."""

from __future__ import annotations

import html
import sys
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from importlib import metadata
from pathlib import Path
from typing import Protocol, TypeVar

from treadload.errors import InputError, meant
from treadload.registry import declared_points

_DATA = Path(__file__).parent / "catalogue" / "data"
# Letters of a line of `repr`.
_LINE = 118


class Entry(Protocol):
    """What a catalogue holds."""

    @property
    def name(self) -> str:
        """In the catalogue."""

    @property
    def source(self) -> str:
        """Where its numbers are from."""

    @property
    def caveats(self) -> tuple[str, ...]:
        """What is not certain about them, a sentence each."""


Item = TypeVar("Item", bound=Entry)


class UnknownName(InputError, KeyError):
    """A catalogue has nothing of this name."""

    __str__ = Exception.__str__


class Catalogue(Mapping[str, Item]):
    """Things by name, a read-only mapping: ours in the order of their files, then those of other packages.

    Names are matched whatever their case, spaces and prefix, and with "_" for "/".

    noun: one of them in words. kinds: their classes. folder: of our data files, in `catalogue/data`. read: gives the
    things of one file. words: what one is, in a line. use: how a case names one. prefix: of names, which may be left
    out. group: of entry points; an entry point is a function without arguments that returns an iterable of more.

    >>> "GB3" in tl.catalogue.mixes
    True
    >>> tl.catalogue.tires["315/80R22.5"].name
    '315/80R22.5'
    """

    def __init__(
        self,
        noun: str,
        kinds: tuple[type, ...],
        *,
        folder: str,
        read: Callable[[Path], Iterable[Item]],
        words: Callable[[Item], str],
        group: str,
        use: str,
        prefix: str = "",
    ) -> None:
        self.noun, self.kinds, self.use, self.group = noun, kinds, use, group
        self._folder, self._read, self._words, self._prefix = folder, read, words, prefix

    def __getitem__(self, name: str) -> Item:
        """The one of this name. Raises UnknownName, an InputError and a KeyError, that names the nearest."""
        if not isinstance(name, str):
            raise UnknownName(f"the name of a {self.noun} must be text, got {name!r}")
        # Ours first: a broken package of others stops no one.
        item = self._among(self._built_in, name)
        if item is None:
            everything = self._all()
            item = self._among(everything, name)
        if item is None:
            short = [name.removeprefix(self._prefix) for name in everything]
            near = meant(name, [*everything, *short], cutoff=0.5)
            hint = f"known are {', '.join(everything)}" if near is None else f"did you mean {near!r}?"
            raise UnknownName(f"no {self.noun} {name!r}; {hint}")
        return item

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __hash__(self) -> int:
        return id(self)

    def rows(self) -> list[tuple[str, str, Item]]:
        """Name, what it is in a line, and the thing itself, of all."""
        return [(name, self._words(item), item) for name, item in self._all().items()]

    def about(self, name: str) -> str:
        """All that is known of one of them: its numbers, its source and its caveats. Raises InputError."""
        item = self[name]
        caveats = [f"caveat: {caveat}" for caveat in item.caveats]
        return "\n".join([f"{item.name}: {self._words(item)}", repr(item), f"source: {item.source or '–'}", *caveats])

    def __repr__(self) -> str:
        rows = self.rows()
        width = max((len(name) for name, *_ in rows), default=0)
        lines = [f"  {name:{width}}  {words}" for name, words, _ in rows]
        lines = [line if len(line) <= _LINE else f"{line[: _LINE - 1].rstrip()}…" for line in lines]
        several = f"{self.noun}{'es' if self.noun.endswith('x') else 's'}"
        return "\n".join([f"<catalogue of {len(rows)} {several}; {self.use}>", *lines])

    def _repr_html_(self) -> str:
        def row(cells: Iterable[str], cell: str = "td") -> str:
            left = f"<{cell} style='text-align: left'>"
            return f"<tr>{''.join(f'{left}{text}</{cell}>' for text in cells)}</tr>"

        body = "".join(
            row(html.escape(text) for text in (name, words, item.source, " ".join(item.caveats)))
            for name, words, item in self.rows()
        )
        head = row(("name", "what it is", "source", "caveats"), "th")
        return f"<table><caption>{html.escape(self.use)}</caption><thead>{head}</thead><tbody>{body}</tbody></table>"

    def _among(self, items: Mapping[str, Item], name: str) -> Item | None:
        by_key = {_key(name): item for name, item in items.items()}
        return by_key.get(_key(name)) or by_key.get(_key(self._prefix + name))

    @cached_property
    def _built_in(self) -> dict[str, Item]:
        files = sorted((_DATA / self._folder).glob("*.toml"))
        return {item.name: item for file in files for item in self._read(file)}

    def _all(self) -> dict[str, Item]:
        """All by name. Raises InputError for an entry point that cannot be loaded, or a name that stands twice."""
        entries = dict(self._built_in)
        taken = {_key(name): "treadload" for name in entries}
        for point in sorted(declared_points(self.group, tuple(sys.path)), key=lambda point: point.name):
            for item in self._loaded(point):
                before = taken.setdefault(_key(item.name), point.name)
                if item.name in entries or before != point.name:
                    raise InputError(
                        f"the entry point {point.name!r} ({point.value}) brings the {self.noun} {item.name!r}, which "
                        f"{before} has already; rename one of them"
                    )
                entries[item.name] = item
        return entries

    def _loaded(self, point: metadata.EntryPoint) -> list[Item]:
        about = f"the entry point {point.name!r} ({point.value}) of the group {self.group}"
        try:
            items = list(point.load()())
        # Whatever a foreign package raises is reported as its failure.
        except Exception as error:
            raise InputError(f"{about} fails: {error!r}; repair that package or remove it") from error
        for item in items:
            if not isinstance(item, self.kinds):
                kinds = ", ".join(kind.__name__ for kind in self.kinds)
                raise InputError(f"{about} must return {kinds}, got {type(item).__name__}")
        return items


def read_tables(path: Path) -> dict[str, object]:
    """Tables of a TOML file. Raises InputError."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from error


def sentence(text: str) -> str:
    """A text of several lines as one."""
    return " ".join(text.split())


def _key(name: str) -> str:
    return "".join(name.casefold().replace("_", "/").split())
