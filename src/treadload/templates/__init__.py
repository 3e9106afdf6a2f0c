"""Cases to start from: every key with its unit, its default and its reason."""

from __future__ import annotations

from pathlib import Path

from treadload.errors import InputError, nearest

KINDS = ("run", "life", "calibrate")
"""Kinds of cases, by the command that runs them."""
_HERE = Path(__file__).parent


def check_kind(name: str) -> None:
    """Raise InputError for what is not the command of a case, "run", "life" or "calibrate"."""
    if name not in KINDS:
        raise InputError(f"no kind of case {name!r}; {nearest(name, KINDS)}")


def first_case(name: str = "run") -> str:
    """TOML text of a case that runs as it is, each key explained.

    name: "run", "life" or "calibrate". Raises InputError.
    """
    check_kind(name)
    return (_HERE / f"{name}.toml").read_text(encoding="utf-8")
