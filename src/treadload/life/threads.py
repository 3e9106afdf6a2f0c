"""Threads that share the cores of a machine: one for each, and none besides that a library starts."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

import threadpoolctl

_lock = threading.Lock()
_inside = 0
_limits: Any = None


def how_many(workers: int | None) -> int:
    """Threads for a number of workers; all cores if left out."""
    return workers or os.cpu_count() or 1


@contextmanager
def pool_of(workers: int | None) -> Iterator[ThreadPoolExecutor]:
    """A pool of threads, each of which multiplies matrices by itself.

    Small products on threads of their own, started from several threads at once, wait for each other: a life takes
    twice the time and three times the processor's. The limit is the process's and ends with the last pool.
    """
    _enter()
    try:
        pool = ThreadPoolExecutor(how_many(workers))
        try:
            yield pool
        finally:
            # After an error or an interruption nobody waits for what has not begun.
            pool.shutdown(cancel_futures=True)
    finally:
        _leave()


def _enter() -> None:
    global _inside, _limits
    with _lock:
        if not _inside:
            _limits = threadpoolctl.threadpool_limits(1, "blas")
        _inside += 1


def _leave() -> None:
    global _inside
    with _lock:
        _inside -= 1
        if not _inside:
            # The thread that set the limit may be another, and gone.
            let_go()
            _limits.restore_original_limits()
            let_go()


def let_go() -> None:
    """Let any thread set the limit: threadpoolctl keeps that to the thread that was first."""
    clear = getattr(getattr(threadpoolctl, "OpenBLASController", None), "clear_controlling_thread", None)
    if clear is not None:
        clear(force=True)
