"""How the command line ends: signals as an orderly end, pipes that nobody reads, codes for scripts."""

from __future__ import annotations

import collections
import contextlib
import io
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from typing import IO, Any

from treadload.spelling import SPELT

DONE, FAILED, WRONG = 0, 1, 2
NOTHING = "no file was changed but those listed as written; the same command starts again"
"""What an interruption keeps of a command that has no message of its own."""

# Signals that ask a process to end: Ctrl-C, `kill` and schedulers, a terminal that was closed.
_ASKING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
# A second signal ends the process at once, s after the first: launchers send the same one twice.
_PATIENCE = 1.0


class _Signal:
    """The first signal that came. number: of it; since: when, s; is_answered: True once the user has its sentence."""

    number: int = signal.SIGINT
    since: float | None = None
    is_answered = False


def interrupted(kept: str = "") -> tuple[str, int]:
    """The sentence of an interruption and its exit code: 130 for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP.

    kept: what it keeps and how to go on, `NOTHING` if left out. The codes are those of shells, 128 and the signal.
    """
    _Signal.is_answered = True
    return f"interrupted; {kept or NOTHING}", 128 + _Signal.number


@contextlib.contextmanager
def orderly() -> Iterator[None]:
    """The whole of a command: signals end it as Ctrl-C does; a last message names what could not be printed."""
    # A command before it in the same process, as in tests, may have been interrupted.
    _Signal.since, _Signal.is_answered = None, False
    _LOST.clear()
    status: Any = DONE
    try:
        # An interruption may come as soon as the first signal has its handler.
        _prepare()
        yield
    except SystemExit as end:
        # A page of help that is not read to its end is no failure: the libraries that print it end with 1.
        status = DONE if isinstance(end.__context__, BrokenPipeError) else end.code
    except KeyboardInterrupt:
        _Signal.since = _Signal.since or 0.0
    except Exception:
        # Libraries in other languages may wrap an interruption into an error of theirs, as pydantic's core does.
        if _Signal.since is None:
            raise
    if _Signal.since is not None and not _Signal.is_answered:
        # It came while commands were loaded or read.
        text, status = interrupted()
        say(f"error: {text}\n", sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        say("", stream)
    lost = next((error for error in _LOST if not isinstance(error, BrokenPipeError)), None)
    if lost is not None:
        say(f"error: what was printed could not be written: {lost.strerror or lost}\n", sys.stderr)
        status = status or FAILED
    _forget()
    raise SystemExit(status)


def _forget() -> None:
    """Let Python end with the status that it is given.

    An interruption in a text that is executed, as classes of data and named tuples make them while they are loaded,
    is remembered though it was caught, and the process would end by SIGINT; the next text, here of a
    tuple, resets that.
    """
    collections.namedtuple("Nothing", "")


def _prepare() -> None:
    """Encodings of what is printed; handlers of the signals that end a command."""
    for stream in (sys.stdout, sys.stderr):
        set_encoding(stream, ascii_only=os.environ.get("TREADLOAD_ASCII", "0") not in ("", "0"))
    if threading.current_thread() is threading.main_thread():
        for number in _ASKING:
            # `nohup` and shells hand on what is to be ignored.
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
                signal.signal(number, _interrupt)
        sys.unraisablehook = _again


# Why a stream took no more.
_LOST: list[OSError] = []


def set_encoding(stream: IO[str] | None, *, ascii_only: bool = False) -> None:
    """What a stream of the command line writes: UTF-8 into files and pipes, else what its terminal can show.

    A terminal keeps its encoding, and so does a stream whose encoding is set by PYTHONIOENCODING; characters that it
    lacks are spelt. ascii_only: nothing but ASCII is written.
    """
    if not isinstance(stream, io.TextIOWrapper):
        return
    encoding = stream.encoding
    if ascii_only:
        encoding = "ascii"
    elif not stream.isatty() and not os.environ.get("PYTHONIOENCODING"):
        encoding = "utf-8"
    stream.reconfigure(encoding=encoding, errors=SPELT)


def set_ascii(ascii_only: bool) -> bool:
    """Print nothing but ASCII from now on, where it is asked for; serves as the callback of the option."""
    if ascii_only:
        for stream in (sys.stdout, sys.stderr):
            set_encoding(stream, ascii_only=True)
    return ascii_only


def say(text: str, stream: IO[str] | None) -> None:
    """Write to stdout or stderr as it is; whoever stopped reading misses the rest, and the command goes on."""
    if stream is None:
        return
    try:
        stream.write(text)
        stream.flush()
    except OSError as error:
        let_go(stream, error)


def let_go(stream: IO[str], error: OSError) -> None:
    """Lead a stream that takes no more to nowhere, so that neither the next line nor its end fails once more."""
    _LOST.append(error)
    with contextlib.suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        stream.flush()


def _interrupt(number: int, frame: object) -> None:
    now = time.monotonic()
    if _Signal.since is None:
        _Signal.number, _Signal.since = number, now
        raise KeyboardInterrupt
    if now - _Signal.since > _PATIENCE:
        os._exit(128 + number)


def _again(event: sys.UnraisableHookArgs) -> None:
    """An interruption that fell where Python drops errors, as while an object goes, comes once more.

    After it, objects that were half made fail as they go: nothing that a user could act on.
    """
    if _Signal.since is not None and issubclass(event.exc_type, KeyboardInterrupt):
        _Signal.since = None
        # Not from here, where it would be dropped, too.
        threading.Timer(0.05, _send, (_Signal.number,)).start()
    elif _Signal.since is None:
        sys.__unraisablehook__(event)


def _send(number: int) -> None:
    """Send a signal to the main thread, which may be waiting."""
    main = threading.main_thread().ident
    if hasattr(signal, "pthread_kill") and main is not None:
        signal.pthread_kill(main, number)
    else:
        signal.raise_signal(number)
