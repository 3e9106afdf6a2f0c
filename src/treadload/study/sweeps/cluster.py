"""A study on a cluster: workers of Dask, here or behind any scheduler."""

from __future__ import annotations

import contextlib
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

from treadload.errors import InputError, TreadloadError, how_to_install, one_line
from treadload.study.sweeps.places import Task
from treadload.study.sweeps.record import Record
from treadload.study.sweeps.work import Question, solve_of

LOCAL = "local"
"""Stands for a cluster of Dask on this machine."""
# Cases that are on their way to each worker, so that none waits for the next.
_AHEAD = 3
# How often a silent scheduler is asked whether it still lives, s, and how long one may take to answer at first.
_LOOK, _REACH = 1.0, 20


class SchedulerLost(TreadloadError, RuntimeError):
    """The scheduler of a study went away; what was solved is kept."""


def cluster(question: Question, tasks: Sequence[Task], scheduler: Any, jobs: int, name: str) -> Iterator[Record]:
    """Cases on the workers of a Dask scheduler.

    scheduler: its address ("tcp://host:8786"), "local" for `jobs` processes here, or a `distributed.Client`.
    Raises InputError without Dask, for a scheduler that cannot be reached and for workers without treadload, and
    SchedulerLost.
    """
    distributed = _distributed()
    with contextlib.ExitStack() as stack:
        client = _client(distributed, scheduler, jobs, stack)
        waiting = deque(tasks)
        flying: dict[Any, int] = {}
        while waiting or flying:
            room = _AHEAD * max(1, sum(client.nthreads().values()))
            while waiting and len(flying) < room:
                number, values = waiting.popleft()
                future = client.submit(
                    solve_of, question, name, number, values, key=f"treadload-{name}-{number}", pure=False
                )
                flying[future] = number
            try:
                done = distributed.wait(list(flying), timeout=_LOOK, return_when="FIRST_COMPLETED").done
            except TimeoutError:
                done = set()
            except Exception as error:
                raise SchedulerLost(_lost(error)) from error
            if client.status != "running" or any(future.status == "cancelled" for future in done):
                raise SchedulerLost(_lost())
            for future in done:
                yield _record(distributed, future, flying.pop(future))
                future.release()


def _record(distributed: Any, future: Any, number: int) -> Record:
    try:
        record: Record = future.result(timeout=60)
    except distributed.KilledWorker:
        return Record(number, 0.0, failure=(
            "every worker that solved it died, perhaps for lack of memory; use a larger spacing or workers with more "
            "memory"
        ))  # fmt: skip
    except (ImportError, AttributeError) as error:
        raise InputError(
            f"the workers cannot run treadload ({one_line(str(error))}); install the same version there"
        ) from error
    except Exception as error:
        raise SchedulerLost(_lost(error)) from error
    return record


def _lost(error: Exception | None = None) -> str:
    return f"the scheduler went away{f' ({type(error).__name__})' if error is not None else ''}"


def _client(distributed: Any, scheduler: Any, jobs: int, stack: contextlib.ExitStack) -> Any:
    if isinstance(scheduler, distributed.Client):
        return scheduler
    if scheduler == LOCAL:
        local = distributed.LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None)
        scheduler = stack.enter_context(local)
    try:
        return stack.enter_context(distributed.Client(scheduler, timeout=_REACH, set_as_default=False))
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"no scheduler answers at {scheduler}: {one_line(str(error)) or type(error).__name__}; start one with "
            "`dask scheduler`, or use --scheduler local"
        ) from error


def _distributed() -> Any:
    try:
        import distributed
    except ImportError as error:
        raise InputError(f"a cluster needs Dask, which is not installed; {how_to_install('cluster')}") from error
    return distributed
