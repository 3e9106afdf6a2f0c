"""Tables told apart by their `kind`: one of ours, or an error that says which are."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Any


def known_kind(value: Any, kinds: Iterable[str], noun: str, default: str | None = None) -> Any:
    """The table if its kind is one of `kinds`; `default`: of a table that names none.

    Raises ValueError that names the nearest kind, or all of them.
    """
    kind = value.get("kind", default) if isinstance(value, dict) else getattr(value, "kind", default)
    known = list(kinds)
    if kind not in known:
        near = difflib.get_close_matches(str(kind), known, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}"
        named = f"a {noun} needs its kind, kind = …" if kind is None else f"no {noun} of the kind {kind!r}"
        raise ValueError(f"{named}; {hint}")
    return value
