"""A long list of basins in parts: solved in processes, each kept in a file of its own, so that a run goes on."""

from __future__ import annotations

import dataclasses
import hashlib
import io
import json
import os
import signal
import zipfile
import zlib
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import numpy as np

from treadload.errors import InputError, WorkersLost
from treadload.files import write_whole
from treadload.roads.basins import Measured
from treadload.roads.solve import Fits, solve
from treadload.roads.station_loads import StationLoads
from treadload.roads.uncertainty import SensorError
from treadload.roads.unknowns import Unknowns

Progress = Callable[[int, int, str], None]
"""(done, of how many, what)."""
# Drops of a part, and stations whose layers depend on stress: some seconds of work, so that a kill loses no more.
PART = 250
_STATIONS = 10
_QUESTION = "question.json"


def solve_in_parts(
    basins: Measured,
    unknowns: Unknowns,
    error: SensorError,
    *,
    jobs: int,
    state: str | os.PathLike[str] | None,
    progress: Progress | None,
) -> tuple[Fits, int]:
    """The fits of all drops, and how many of them were kept before. Arguments as those of `backcalculate`."""
    together = isinstance(basins, StationLoads)
    size = _STATIONS if together else PART
    starts = range(0, len(basins), size)
    kept = None if state is None else _Kept(Path(state), _fingerprint(basins, unknowns, error))
    parts: dict[int, Fits] = {}
    for start in starts:
        before = None if kept is None else kept.read(start, min(size, len(basins) - start))
        if before is not None:
            parts[start] = before
    finished_before = sum(len(part.status) for part in parts.values())
    done = finished_before
    tasks = {
        start: basins.rows(np.arange(start, min(start + size, len(basins)))) for start in starts if start not in parts
    }
    for start, fits in _solved(tasks, unknowns, error, basins.usual, jobs):
        parts[start] = fits
        if kept is not None:
            kept.write(start, fits)
        done += len(fits.status)
        if progress is not None:
            progress(done, len(basins), "station" if together else "basin")
    names = [entry.name for entry in dataclasses.fields(Fits)]
    joined = Fits(*(np.concatenate([getattr(parts[start], name) for start in starts]) for name in names))
    return joined, finished_before


def _solved(
    tasks: dict[int, Measured], unknowns: Unknowns, error: SensorError, usual: float, jobs: int
) -> Iterator[tuple[int, Fits]]:
    if jobs == 1 or len(tasks) < 2:
        for start, rows in tasks.items():
            yield start, solve(rows, unknowns, error, usual)
        return
    pool = ProcessPoolExecutor(min(jobs, len(tasks)), initializer=_begin)
    try:
        flying = {pool.submit(solve, rows, unknowns, error, usual): start for start, rows in tasks.items()}
        for future in as_completed(flying):
            yield flying[future], future.result()
    except BrokenProcessPool as broken:
        raise WorkersLost(
            f"a process of the backcalculation was killed, perhaps for lack of memory; use fewer than {jobs}, jobs=1 "
            "needs none; with state= what was solved is kept"
        ) from broken
    except BaseException:
        for process in list(pool._processes.values()):
            process.terminate()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _begin() -> None:
    # An interruption is for the caller, which then ends its processes.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


class _Kept:
    """Parts in a folder."""

    def __init__(self, folder: Path, fingerprint: str) -> None:
        self._folder = folder
        if folder.exists() and not folder.is_dir():
            raise InputError(f"state must be a folder, and {folder} is a file; name another")
        try:
            folder.mkdir(parents=True, exist_ok=True)
            written = (folder / _QUESTION).read_text(encoding="utf-8") if (folder / _QUESTION).exists() else ""
        except OSError as error:
            raise InputError(f"cannot use the folder {folder}: {error.strerror or error}") from error
        if written:
            try:
                same = json.loads(written)["backcalculation"] == fingerprint
            except (ValueError, KeyError, TypeError) as error:
                raise InputError(f"the state {folder} is damaged; remove it to start again") from error
            if not same:
                raise InputError(
                    f"the state {folder} belongs to another backcalculation: basins, structure or options differ; "
                    "remove it, or name another folder"
                )
        elif any(folder.iterdir()):
            raise InputError(f"the folder {folder} is not empty and no state of a backcalculation; name another")
        else:
            write_whole(folder / _QUESTION, json.dumps({"backcalculation": fingerprint}))

    def write(self, start: int, fits: Fits) -> None:
        content = io.BytesIO()
        arrays = {entry.name: getattr(fits, entry.name) for entry in dataclasses.fields(Fits)}
        np.savez(content, **{name: a.astype(str) if a.dtype == object else a for name, a in arrays.items()})
        write_whole(self._folder / f"{start}.npz", content.getvalue(), sync=False)

    def read(self, start: int, count: int) -> Fits | None:
        """A part; None where it is missing or damaged."""
        try:
            with np.load(self._folder / f"{start}.npz", allow_pickle=False) as archive:
                arrays = {entry.name: archive[entry.name] for entry in dataclasses.fields(Fits)}
        except (OSError, zipfile.BadZipFile, zlib.error, EOFError, ValueError, LookupError, NotImplementedError):
            return None
        fits = Fits(**{name: a.astype(object) if a.dtype.kind == "U" else a for name, a in arrays.items()})
        return fits if len(fits.status) == count else None


def _fingerprint(basins: Measured, unknowns: Unknowns, error: SensorError) -> str:
    digest = hashlib.sha256()
    for values in (*basins.numbers, *basins.thickness.values()):
        digest.update(np.ascontiguousarray(values).tobytes())
    digest.update(repr((*basins.conditions, list(basins.thickness), unknowns, error)).encode())
    return digest.hexdigest()
