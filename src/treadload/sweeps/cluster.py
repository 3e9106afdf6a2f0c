"""A study on a cluster: workers of Dask, here or behind any scheduler."""

from __future__ import annotations

import contextlib
import logging
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Future
from multiprocessing import resource_tracker
from types import ModuleType
from typing import Protocol, Self, cast

from treadload.errors import InputError, TreadloadError, WorkersLost, how_to_install, one_line
from treadload.sweeps.places import Task, try_start
from treadload.sweeps.record import Record
from treadload.sweeps.work import Question, solve_of

LOCAL = "local"
"""Stands for a cluster of Dask on this machine."""
# Cases that are on their way to each worker, so that none waits for the next.
_AHEAD = 3
_LOST = "the scheduler went away"
# How often a silent scheduler is asked whether it still lives, s, and how long one may take to answer at first.
_LOOK, _REACH = 1.0, 20
_ENDING = ("SIGINT", "SIGTERM", "SIGHUP")
_NOTHING = logging.CRITICAL + 1


class TaskFuture(Protocol):
    """A case on its way, `distributed.Future`."""

    status: str

    def result(self, timeout: float) -> Record:
        """The record, s after which none is there at the latest."""

    def release(self) -> None:
        """Let the scheduler forget it."""


class Client(Protocol):
    """A client of a scheduler, `distributed.Client`."""

    status: str

    def __enter__(self) -> Self: ...
    def __exit__(self, *error: object) -> None: ...
    def nthreads(self) -> dict[str, int]:
        """Threads of each worker."""

    def as_current(self) -> contextlib.AbstractContextManager[object]:
        """The client that tasks inside use."""

    def submit(self, solve: Callable[..., Record], *values: object, key: str, pure: bool) -> TaskFuture:
        """Send a case."""


class SchedulerLost(TreadloadError, RuntimeError):
    """The scheduler of a study went away; what was solved is kept.

    >>> try:
    ...     raise tl.sweeps.SchedulerLost("the scheduler at tcp://host:8786 does not answer")
    ... except RuntimeError as error:
    ...     print(error)
    the scheduler at tcp://host:8786 does not answer
    """


def cluster(question: Question, tasks: Sequence[Task], scheduler: object, jobs: int, name: str) -> Iterator[Record]:
    """Cases on the workers of a Dask scheduler.

    scheduler: its address ("tcp://host:8786"), "local" for `jobs` processes here, or a `distributed.Client`.
    Raises InputError without Dask, for a scheduler that cannot be reached and for workers without treadload, and
    SchedulerLost.
    """
    distributed = _distributed()
    with contextlib.ExitStack() as stack:
        stack.enter_context(_quietly())
        client = _client(distributed, scheduler, jobs, stack)
        stack.enter_context(client.as_current())
        waiting = deque(tasks)
        flying: dict[TaskFuture, int] = {}
        while waiting or flying:
            try:
                room = _AHEAD * max(1, sum(client.nthreads().values()))
                while waiting and len(flying) < room:
                    number, values = waiting.popleft()
                    key = f"treadload-{name}-{number}"
                    flying[client.submit(solve_of, question, name, number, values, key=key, pure=False)] = number
                done = _done(distributed, list(flying))
                if client.status != "running" or any(future.status == "cancelled" for future in done):
                    raise SchedulerLost(_LOST)
                records = {future: _record(distributed, future, flying[future]) for future in done}
            except (OSError, CancelledError) as error:
                raise SchedulerLost(f"{_LOST} ({type(error).__name__})") from error
            for future, record in records.items():
                if record is not None:
                    del flying[future]
                    yield record
                    future.release()


@contextlib.contextmanager
def _quietly() -> Iterator[None]:
    """Dask prints what ends a connection as a traceback; here it is one sentence."""
    loggers = [logging.getLogger(name) for name in ("distributed", "distributed.client")]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(_NOTHING)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)


@contextlib.contextmanager
def _interrupted_later() -> Iterator[None]:
    """Put an interruption off to the end of the block, and keep it from processes that start there.

    A cluster that is interrupted while it starts leaves tracebacks behind and cannot be closed.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    numbers = [getattr(signal, name) for name in _ENDING if hasattr(signal, name)]
    before = {number: signal.signal(number, lambda late, frame: came.append(late)) for number in numbers}
    # Threads and processes that start here take over the mask, which the start of this helper would lift. Dask
    # ends its processes by SIGTERM, which is not masked.
    resource_tracker.ensure_running()
    mask = getattr(signal, "pthread_sigmask", None)
    masked = None if mask is None else mask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        if mask is not None:
            mask(signal.SIG_SETMASK, masked)
        for number, handler in before.items():
            signal.signal(number, handler)
        if came:
            signal.raise_signal(came[0])


def _done(distributed: ModuleType, futures: list[TaskFuture]) -> set[TaskFuture]:
    """Futures that are done by now, or within a moment."""
    try:
        done: set[TaskFuture] = distributed.wait(futures, timeout=_LOOK, return_when="FIRST_COMPLETED").done
    except TimeoutError:
        return set()
    return done


def _record(distributed: ModuleType, future: TaskFuture, number: int) -> Record | None:
    """The record of a case; None where it was lost with its worker and is solved again."""
    try:
        record: Record = future.result(timeout=_REACH)
    except TimeoutError:
        return None
    except distributed.KilledWorker:
        return Record(number, 0.0, failure=(
            "every worker that solved it died, perhaps for lack of memory; use a larger spacing or workers with more "
            "memory"
        ))  # fmt: skip
    except (ImportError, AttributeError) as error:
        raise InputError(
            f"the workers cannot run treadload ({one_line(str(error))}); install the same version there"
        ) from error
    return record


def _client(distributed: ModuleType, scheduler: object, jobs: int, stack: contextlib.ExitStack) -> Client:
    if isinstance(scheduler, distributed.Client):
        return cast("Client", scheduler)
    if scheduler == LOCAL:
        try:
            with _interrupted_later():
                local = distributed.LocalCluster(
                    n_workers=jobs, threads_per_worker=1, dashboard_address=None, silence_logs=_NOTHING
                )
        except (RuntimeError, OSError) as error:
            try_start()
            raise WorkersLost(
                f"the Dask cluster on this machine cannot start ({one_line(str(error))}); use fewer workers than "
                f"{jobs}, or --jobs without --scheduler"
            ) from error
        scheduler = stack.enter_context(local)
    try:
        return stack.enter_context(_connected(distributed, scheduler))
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"no scheduler answers at {scheduler}: {one_line(str(error)) or type(error).__name__}; start one with "
            "`dask scheduler`, or use --scheduler local"
        ) from error


def _connected(distributed: ModuleType, scheduler: object) -> Client:
    """A client of a scheduler; an interruption leaves it to its thread, for half a client cannot be closed."""
    future: Future[Client] = Future()
    left = threading.Event()

    def connect() -> None:
        try:
            client = distributed.Client(scheduler, timeout=_REACH, set_as_default=False)
        except BaseException as error:
            future.set_exception(error)
            return
        future.set_result(client)
        if left.is_set():
            client.close()

    threading.Thread(target=connect, daemon=True).start()
    try:
        return future.result()
    except KeyboardInterrupt:
        left.set()
        raise


def _distributed() -> ModuleType:
    try:
        import distributed
    except ImportError as error:
        raise InputError(f"a cluster needs Dask, which is not installed; {how_to_install('cluster')}") from error
    return distributed
