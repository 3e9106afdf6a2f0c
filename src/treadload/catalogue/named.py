"""Named things from data files, ours and those that other packages bring along."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from treadload.errors import InputError

_DATA = Path(__file__).parent / "data"


class _Named(Protocol):
    @property
    def name(self) -> str: ...


Item = TypeVar("Item", bound=_Named)


@dataclass(frozen=True)
class Catalogue(Generic[Item]):
    """Things found by name.

    what: one of them in a word. kinds: their classes. own: gives those of this package. group: of entry points; an
    entry point is a function without arguments that returns an iterable of more.
    """

    what: str
    kinds: tuple[type, ...]
    own: Callable[[], Iterable[Item]]
    group: str

    def find(self, name: str) -> Item:
        """The one of this name; case and spaces do not count. Raises InputError that names the nearest."""
        if not isinstance(name, str):
            raise InputError(f"the name of a {self.what} must be a text, got {name!r}")
        # Ours first: a broken package of others stops no one.
        own = {_key(item.name): item for item in self.own()}
        if _key(name) in own:
            return own[_key(name)]
        known = self.all()
        found = {_key(item.name): item for item in known.values()}
        if _key(name) in found:
            return found[_key(name)]
        near = difflib.get_close_matches(_key(name), found, n=1, cutoff=0.5)
        hint = f"did you mean {found[near[0]].name!r}?" if near else f"known are {', '.join(known)}"
        raise InputError(f"no {self.what} {name!r}; {hint}")

    def all(self) -> dict[str, Item]:
        """All by name: ours, then those of other packages.

        Raises InputError for an entry point that cannot be loaded, and for a name that stands twice.
        """
        found = {item.name: item for item in self.own()}
        taken = {_key(name): "treadload" for name in found}
        for point in sorted(metadata.entry_points(group=self.group), key=lambda point: point.name):
            for item in self._loaded(point):
                before = taken.setdefault(_key(item.name), point.name)
                if item.name in found or before != point.name:
                    raise InputError(
                        f"the entry point {point.name!r} ({point.value}) brings the {self.what} {item.name!r}, which "
                        f"{before} has already; rename one of them"
                    )
                found[item.name] = item
        return found

    def _loaded(self, point: metadata.EntryPoint) -> list[Item]:
        about = f"the entry point {point.name!r} ({point.value}) of the group {self.group}"
        try:
            items = list(point.load()())
        # Whatever a foreign package raises is told as its own failure.
        except Exception as error:
            raise InputError(f"{about} fails: {error!r}; repair that package or remove it") from error
        for item in items:
            if not isinstance(item, self.kinds):
                kinds = ", ".join(kind.__name__ for kind in self.kinds)
                raise InputError(f"{about} must return {kinds}, got {type(item).__name__}")
        return items


def data(kind: str, pattern: str = "*.toml") -> list[Path]:
    """Files that come with the package, sorted: of kind mixes, structures, viscoelastic, treads or tires."""
    return sorted((_DATA / kind).glob(pattern))


def read_tables(path: Path) -> dict[str, Any]:
    """Tables of a TOML file. Raises InputError."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from error


def _key(name: str) -> str:
    return "".join(name.casefold().split())
