"""Errors that state what was wrong, the number, the bound and the remedy, in one line."""

from __future__ import annotations

import contextlib
import difflib
import math
import re
from collections.abc import Iterable, Iterator

# Characters of a word, and of a message, that a reader can still take in.
_WORD, _MESSAGE = 300, 1200


class TreadloadError(Exception):
    """Base of every error that treadload raises on purpose. Its message is one line of bounded length."""

    def __init__(self, message: str = "") -> None:
        super().__init__(one_line(message))


def one_line(text: str) -> str:
    """A text without line breaks and control characters, its endless words and itself cut in the middle.

    Messages quote what they were given, and the messages of other libraries about it.
    """
    text = re.sub(r"[\x00-\x08\x0e-\x1b\x7f-\x84\x86-\x9f]", "\ufffd", " ".join(text.splitlines()))
    text = re.sub(rf"\S{{{_WORD},}}", lambda word: f"{word[0][:100]}…{word[0][-20:]}", text)
    return text if len(text) <= _MESSAGE else f"{text[: _MESSAGE - 200]} … {text[-100:]}"


class InputError(TreadloadError, ValueError):
    """A value from the user is outside its bounds, missing, or cannot be read.

    >>> try:
    ...     tl.Elastic(-1.0, 0.3)
    ... except tl.InputError as error:
    ...     print(error)
    ...
    modulus must be a positive number of Pa, got -1; asphalt is near 5.4e9
    """


class WriteError(InputError):
    """A file cannot be written, because the disk is full, read-only or gone; nothing that was there is lost."""


class GeometryError(TreadloadError, ValueError):
    """A mesh, cloud or height map does not describe a usable tire surface."""


class WorkersLost(TreadloadError, RuntimeError):
    """The processes of a study cannot start; what was solved is kept."""


class ConvergenceError(TreadloadError, RuntimeError):
    """A solver stopped before it reached its tolerance; carries the residual reached."""

    def __init__(self, message: str, residual: float = float("nan")) -> None:
        super().__init__(message)
        self.residual = residual


def positive(name: str, value: float | str, unit: str = "", remedy: str = "") -> None:
    """Raise InputError unless a value is a finite number > 0; text is not one, and neither is True.

    name: what it is, in the sentence. unit: of the number, as in "Pa" or "metres". remedy: what is usual, or what to
    do, for the end of the sentence.
    """
    try:
        if not isinstance(value, bool | str) and math.isfinite(value) and value > 0:
            return
        shown = repr(value) if isinstance(value, bool | str) else f"{value:g}"
    except (TypeError, ValueError, OverflowError):
        shown = repr(value)
    of, end = f" of {unit}" if unit else "", f"; {remedy}" if remedy else ""
    raise InputError(f"{name} must be a positive number{of}, got {shown}{end}")


def within(name: str, value: float, low: float, high: float, unit: str = "", remedy: str = "") -> None:
    """Raise InputError unless low <= value <= high; NaN is not. name, unit, remedy: as for `positive`."""
    if low <= value <= high:
        return
    of, end = f" {unit}" if unit else "", f"; {remedy}" if remedy else ""
    raise InputError(f"{name} must lie between {low:g} and {high:g}{of}, got {value:g}{of}{end}")


def error_line(error: BaseException) -> str:
    """An error of another library in one short line."""
    words = " ".join(str(error).split())
    return f"{type(error).__name__}: {words if len(words) < 120 else words[:117] + '...'}"


@contextlib.contextmanager
def reading(file: str, kind: str, remedy: str = "it may be truncated, export or copy it again") -> Iterator[None]:
    """What another library stumbles on in a file becomes an InputError; our own errors pass, and so do interrupts.

    file: as in "scan file 'a.las'". kind: what it was read as. remedy: where the file may be at fault; a name that a
    library lacks is never the file's. Some libraries panic beside Exception.
    """
    try:
        yield
    except (TreadloadError, KeyboardInterrupt, SystemExit, GeneratorExit):
        raise
    except BaseException as error:
        if not isinstance(error, Exception) and "Panic" not in type(error).__name__:
            raise
        if isinstance(error, AttributeError | ImportError | NameError):
            remedy = "this points at the library that reads it, not at the file: install another version of it"
        raise InputError(f"{file} could not be read as {kind} ({error_line(error)}); {remedy}") from error


def how_to_install(extra: str) -> str:
    """What to run for a package of an extra, such as "scan": after an installation from an index, or in a clone."""
    return f"run  pip install 'treadload[{extra}]'  (in a clone  pip install '.[{extra}]')"


def meant(wanted: object, names: Iterable[str], cutoff: float = 0.6) -> str | None:
    """The known name that an unknown one is most likely to mean, whatever its capitals; None where none is like it.

    cutoff: least likeness, from 0 to 1.
    """
    by_letters = {name.casefold(): name for name in reversed(list(names))}
    near = difflib.get_close_matches(str(wanted).casefold(), by_letters, n=1, cutoff=cutoff)
    return by_letters[near[0]] if near else None


def nearest(name: object, candidates: Iterable[str], otherwise: str = "known are") -> str:
    """The message about an unknown name: "did you mean 'x'?", or all known names. otherwise: words before these."""
    names = list(candidates)
    near = meant(name, names)
    return f"{otherwise} {', '.join(names)}" if near is None else f"did you mean {near!r}?"
