"""Errors that say what was wrong, the number, the bound and the remedy, in one line."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable

# Characters of a word, and of a message, that a reader can still take in.
_WORD, _MESSAGE = 300, 1200


class TreadloadError(Exception):
    """Base of every error that treadload raises on purpose. Its message is one line of bounded length."""

    def __init__(self, message: str = "") -> None:
        super().__init__(one_line(message))


def one_line(text: str) -> str:
    """A text without line breaks and control characters, its endless words and itself cut in the middle.

    Messages quote what they were given, and what other libraries said of it.
    """
    text = re.sub(r"[\x00-\x08\x0e-\x1b\x7f-\x84\x86-\x9f]", "\ufffd", " ".join(text.splitlines()))
    text = re.sub(rf"\S{{{_WORD},}}", lambda word: f"{word[0][:100]}…{word[0][-20:]}", text)
    return text if len(text) <= _MESSAGE else f"{text[: _MESSAGE - 200]} … {text[-100:]}"


class InputError(TreadloadError, ValueError):
    """A value from the user is outside its bounds, missing, or cannot be read."""


class GeometryError(TreadloadError, ValueError):
    """A mesh, cloud or height map does not describe a usable tire surface."""


class ConvergenceError(TreadloadError, RuntimeError):
    """A solver stopped before it reached its tolerance; carries the residual reached."""

    def __init__(self, message: str, residual: float = float("nan")) -> None:
        super().__init__(message)
        self.residual = residual


def how_to_install(extra: str) -> str:
    """What to run for a package of an extra, such as "scan"; it works in a clone, which is all there is so far."""
    return f"in the folder of the clone, run  pip install '.[{extra}]'"


def nearest(asked: object, known: Iterable[str], otherwise: str = "known are", cutoff: float = 0.6) -> str:
    """What to say of an unknown name: "did you mean 'x'?", or all that are known. otherwise: words before these."""
    names = list(known)
    by_letters = {name.casefold(): name for name in reversed(names)}
    near = difflib.get_close_matches(str(asked).casefold(), by_letters, n=1, cutoff=cutoff)
    return f"did you mean {by_letters[near[0]]!r}?" if near else f"{otherwise} {', '.join(names)}"
