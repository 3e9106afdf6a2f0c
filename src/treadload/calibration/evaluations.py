"""Evaluations of a model: each point once, several at a time, and kept in a file from which a search goes on."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from treadload.calibration.problem import Model, Problem
from treadload.errors import InputError, WorkersLost
from treadload.files import check_writable, write_whole
from treadload.kernels.arrays import Array

Progress = Callable[[int, int, str], None]
"""(done, of how many, what) of the solves; how many are needed is a guess until the search ends."""
Point = tuple[float, ...]
Task = tuple[Point, int]

# Of a search, each with its slopes; for the first guess of how many contacts there will be.
_USUAL_STEPS = 5
# The model of a process that works for another.
_MODEL: list[Model] = []


class Evaluations:
    """Readings of a problem at points, all of which are kept.

    jobs: processes. state: file of the points, read at the start and written whole after every round. progress:
    called after every solve.
    """

    def __init__(
        self, problem: Problem, *, jobs: int, state: str | os.PathLike[str] | None, progress: Progress | None
    ) -> None:
        self.problem, self.jobs = problem, jobs
        self._state = None if state is None else Path(state)
        self._model = Model(problem)
        self._pool: ProcessPoolExecutor | None = None
        self._tell = progress or (lambda done, total, what: None)
        self.solved = 0
        self.expected = _USUAL_STEPS * (len(problem.sought) + 1) * len(problem.data)
        self.readings_by_task: dict[Task, Array] = {}
        if self._state is not None:
            check_writable(self._state)
            if self._state.exists():
                self.readings_by_task = _read(self._state, problem)
        self.evaluated_before = len(self.readings_by_task)

    @contextmanager
    def open(self) -> Iterator[Evaluations]:
        """Processes, while they are needed."""
        if self.jobs == 1:
            yield self
            return
        pool = self._pool = ProcessPoolExecutor(self.jobs, initializer=_begin, initargs=(self.problem,))
        try:
            yield self
        except BaseException:
            # Nobody waits for a contact that is being solved.
            for process in list(pool._processes.values()):
                process.terminate()
            raise
        finally:
            self._pool = None
            pool.shutdown(cancel_futures=True)

    def at(self, points: Sequence[Point]) -> list[Array]:
        """All readings at each point, SI."""
        rows = range(len(self.problem.data))
        tasks = [(point, row) for point in dict.fromkeys(points) for row in rows]
        new = [task for task in tasks if task not in self.readings_by_task]
        self.expected = max(self.expected, self.solved + len(new))
        solved = map(self._solve, new) if self._pool is None else self._pool.map(_work, new)
        try:
            for task, values in zip(new, solved, strict=True):
                self.readings_by_task[task] = values
                self.solved += 1
                self._tell(self.solved, self.expected, "contact")
        except BrokenProcessPool as error:
            kept = "" if self._state is None else f"; {len(self.readings_by_task)} contacts are kept in {self._state}"
            raise WorkersLost(
                "a process of the calibration was killed, perhaps for lack of memory; use a larger spacing or fewer "
                f"processes than {self.jobs}, jobs=1 needs none{kept}"
            ) from error
        finally:
            # What was found before an error or an interruption is not lost.
            if new and self._state is not None:
                self._write(self._state)
        return [np.concatenate([self.readings_by_task[point, row] for row in rows]) for point in points]

    def _solve(self, task: Task) -> Array:
        return self._model.readings(*task)

    def _write(self, path: Path) -> None:
        points = [
            {"at": list(point), "row": row, "readings": values.tolist()}
            for (point, row), values in self.readings_by_task.items()
        ]
        content = {"calibration": self.problem.fingerprint, "points": points}
        write_whole(path, json.dumps(content))


def _begin(problem: Problem) -> None:
    # An interruption is for the search, which then ends its processes; what it does on a signal is not for them.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _MODEL[:] = [Model(problem)]


def _work(task: Task) -> Array:
    return _MODEL[0].readings(*task)


def _read(path: Path, problem: Problem) -> dict[Task, Array]:
    """Points of a file. Raises InputError for a broken file and for one of another question."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        same = content["calibration"] == problem.fingerprint
        values_by_task = {
            (tuple(float(value) for value in entry["at"]), int(entry["row"])): np.array(
                entry["readings"], dtype=float
            )
            for entry in content["points"]
        }
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise InputError(
            f"the state {path} cannot be read as points of a calibration ({type(error).__name__}); remove it to "
            "start again"
        ) from error
    sizes = [sum(1 for reading in problem.readings if reading[0] == row) for row in range(len(problem.data))]
    fits = all(
        len(at) == len(problem.sought) and 0 <= row < len(sizes) and values.shape == (sizes[row],)
        for (at, row), values in values_by_task.items()
    )
    if not (same and fits):
        raise InputError(
            f"the state {path} belongs to another calibration: its tire, data, unknowns or cells differ; remove it, "
            "or name another file"
        )
    return values_by_task
