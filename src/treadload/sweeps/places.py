"""Where the cases of a study are solved: here, in threads, or in processes of this machine.

A place takes a question and its tasks, and yields records as they come, in any order. What a case raises is in its
record; what ends a place is raised.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from multiprocessing.connection import Connection
from multiprocessing.connection import wait as wait_for
from typing import Any

from treadload.errors import InputError, WorkersLost
from treadload.sweeps.record import Record
from treadload.sweeps.work import Question, Worker, solve_of

Task = tuple[int, Mapping[str, Any]]

# A process that dies takes its case along: once may be an accident, twice is the case. So it is while it starts.
_DEATHS = 2
# Exit code of a process that is to import the script that starts it, and would start others.
_UNGUARDED = 97
# Neighbours that stay with one worker, which keeps what they share.
_RUN = 16
# The first word of a process, which tells one that cannot start from one whose first case kills it.
_READY = "ready"
# Each process computes with one thread, or several would fight for the same cores.
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_GUARD = (
    "a script that asks for several processes needs 'if __name__ == \"__main__\":' around what it does, since each "
    "of them imports it; or use jobs=1"
)
DIED = (
    "the process that solved it was killed twice, perhaps for lack of memory; use a larger spacing, fewer processes "
    "or a machine with more memory"
)


def check_guard() -> None:
    """End this process if it only imports the script of a study that starts it; the study then states so."""
    # multiprocessing itself asks the same to refuse a start in a process that starts.
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise SystemExit(_UNGUARDED)


def try_start() -> None:
    """Start a process that does nothing. Raises InputError where that imports a script without a guard."""
    process = multiprocessing.get_context("spawn").Process(target=_nothing, daemon=True)
    process.start()
    process.join()
    if process.exitcode == _UNGUARDED:
        raise InputError(_GUARD)


def _nothing() -> None:
    """What such a process does."""


def here(question: Question, tasks: Sequence[Task]) -> Iterator[Record]:
    """One case after another in this process."""
    worker = Worker(question)
    for number, values in tasks:
        yield worker.solve(number, values)


def threads(question: Question, tasks: Sequence[Task], jobs: int, name: str) -> Iterator[Record]:
    """Several cases at once in threads of this process."""
    waiting = deque(tasks)
    pool = ThreadPoolExecutor(jobs)
    flying: set[Future[Record]] = set()
    try:
        while waiting or flying:
            while waiting and len(flying) < 2 * jobs:
                flying.add(pool.submit(solve_of, question, name, *waiting.popleft()))
            done, flying = wait(flying, return_when=FIRST_COMPLETED)
            for future in done:
                yield future.result()
    finally:
        # A thread cannot be stopped: after an interruption those that run end with their case.
        pool.shutdown(wait=True, cancel_futures=True)


def processes(question: Question, tasks: Sequence[Task], jobs: int) -> Iterator[Record]:
    """Several cases at once in processes of their own; one that dies is replaced, and its case tried once more."""
    runs = _runs(tasks, jobs)
    crew: list[_Process] = []
    deaths: dict[int, int] = {}
    again: deque[Task] = deque()
    try:
        crew.extend(_Process(question) for _ in range(min(jobs, len(tasks))))
        for process in crew:
            process.give(_next(process, crew, runs, again))
        while any(process.task for process in crew):
            busy = {process.pipe: process for process in crew if process.task}
            for pipe in wait_for(list(busy)):
                process = busy[pipe]  # type: ignore[index]
                task, record = process.task, process.take()
                assert task is not None
                if record == _READY:
                    continue
                if record is None:
                    if not process.has_begun:
                        process.start_again(len(crew))
                        process.give(task)
                        continue
                    deaths[task[0]] = deaths.get(task[0], 0) + 1
                    process.start()
                    if deaths[task[0]] < _DEATHS:
                        again.append(task)
                    else:
                        record = Record(task[0], 0.0, failure=DIED)
                if isinstance(record, Record):
                    yield record
                process.give(_next(process, crew, runs, again))
    finally:
        for process in crew:
            process.stop()


def _runs(tasks: Sequence[Task], jobs: int) -> list[deque[Task]]:
    """Tasks in runs of neighbours, at least four for each process so that none waits long at the end."""
    length = max(1, min(_RUN, -(-len(tasks) // (4 * jobs))))
    return [deque(tasks[start : start + length]) for start in range(0, len(tasks), length)][::-1]


def _next(process: _Process, crew: Sequence[_Process], runs: list[deque[Task]], again: deque[Task]) -> Task | None:
    """The next case of a process: of its own run, of a new one, or the last of what waits for another process."""
    if again:
        return again.popleft()
    if not process.run and runs:
        process.run = runs.pop()
    if process.run:
        return process.run.popleft()
    longest = max(crew, key=lambda process: len(process.run))
    return longest.run.pop() if longest.run else None


class _Process:
    """A process that solves one case after another. task: that it has; run: neighbours that wait for it."""

    def __init__(self, question: Question) -> None:
        self._question = question
        self.task: Task | None = None
        self.run: deque[Task] = deque()
        self.has_begun = False
        self._failed = 0
        self.start()

    def start(self) -> None:
        """Start it, or another in its place. Raises WorkersLost where the system starts no more."""
        self.has_begun = False
        # Whatever has threads or open files cannot be forked safely.
        context = multiprocessing.get_context("spawn")
        try:
            self.pipe, theirs = context.Pipe()
            with _one_thread():
                self._process = context.Process(target=_serve, args=(theirs, self._question), daemon=True)
                self._process.start()
            theirs.close()
        except OSError as error:
            raise WorkersLost(
                f"a process of the study cannot be started ({error.strerror or error}); use fewer processes, jobs=1 "
                "needs none"
            ) from error

    def start_again(self, jobs: int) -> None:
        """Start another in place of one that died before its first case.

        jobs: processes of the study. Raises WorkersLost for the second in a row, and InputError where the script that
        asks for processes starts itself again and again.
        """
        code = self._process.exitcode
        if code == _UNGUARDED:
            raise InputError(_GUARD)
        self._failed += 1
        if self._failed >= _DEATHS:
            raise WorkersLost(
                f"a process of the study {_end(code)} while it started, twice in a row{_remedy(code, jobs)}"
            )
        self.start()

    def give(self, task: Task | None) -> None:
        """Give it a case."""
        self.task = task
        if task is not None:
            # A pipe that broke is noticed when its record is taken.
            with contextlib.suppress(OSError):
                self.pipe.send(task)

    def take(self) -> Record | str | None:
        """Its record, or that it has started; None if it has died."""
        try:
            record: Record | str = self.pipe.recv()
        except (EOFError, OSError):
            self._process.join()
            self.pipe.close()
            return None
        self.has_begun, self._failed = True, 0
        return record

    def stop(self) -> None:
        """End it, whatever it does."""
        self.pipe.close()
        self._process.terminate()
        self._process.join()


def _end(code: int | None) -> str:
    """How a process ended, by its exit code."""
    if code is None or code >= 0:
        return f"ended with exit code {code}"
    names = {number.value: number.name for number in signal.Signals}
    return f"was killed by {names.get(-code, f'signal {-code}')}"


def _remedy(code: int | None, jobs: int) -> str:
    if code is not None and code < 0:
        return (
            f", perhaps for lack of memory; use fewer processes than {jobs}, or a machine with more memory; jobs=1 "
            "needs no other process"
        )
    return "; what it printed before states why, and jobs=1 solves the cases without other processes"


def _serve(pipe: Connection, question: Question) -> None:
    """What a process does until its pipe closes, which it also does when the study is killed."""
    # An interruption is for the study, which then ends its processes.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    worker = Worker(question)
    with contextlib.suppress(EOFError, OSError):
        pipe.send(_READY)
        while True:
            pipe.send(worker.solve(*pipe.recv()))


@contextlib.contextmanager
def _one_thread() -> Iterator[None]:
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
