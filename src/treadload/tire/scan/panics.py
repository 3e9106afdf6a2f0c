"""What a library in Rust prints when it stumbles over a file: it reaches the terminal past Python's own streams."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator

_STDERR = 2


@contextlib.contextmanager
def without_backtrace() -> Iterator[None]:
    """Leave out what a panic prints to stderr; whoever catches its exception states what is wrong.

    The file descriptor itself is turned for that time, as the library knows no other. What was printed without a
    panic follows at the end. Does nothing where the process has no stderr.
    """
    try:
        terminal = os.dup(_STDERR)
    except OSError:
        yield
        return
    with tempfile.TemporaryFile() as printed:
        panicked = False
        os.dup2(printed.fileno(), _STDERR)
        try:
            yield
        except BaseException as error:
            panicked = "Panic" in type(error).__name__
            raise
        finally:
            os.dup2(terminal, _STDERR)
            os.close(terminal)
            printed.seek(0)
            if not panicked and (text := printed.read()):
                with contextlib.suppress(OSError):
                    os.write(_STDERR, text)
