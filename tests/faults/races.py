"""Files that change while they are read, and two writers at once."""

from __future__ import annotations

import os
import signal
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr

from faults.disks import Broken, in_fork
from faults.writers import store
from treadload.errors import InputError
from treadload.files import read_tree, write_whole
from treadload.results import save_results


def _beside(act: Callable[[], None]) -> int:
    """Let something happen again and again in a fork; returns its number."""
    child = os.fork()
    if not child:
        try:
            while True:
                act()
        finally:
            os._exit(1)
    return child


def _two(folder: Path) -> list[bytes]:
    """Two files of unlike lengths."""
    made = []
    for number, size in ((1.0, 3000), (2.0, 9000)):
        save_results(xr.Dataset({"a": ("x", np.full(size, number))}), folder / "one.nc")
        made.append((folder / "one.nc").read_bytes())
    return made


def read_while_replaced(count: int, *, whole: bool) -> Counter:
    """Read a file that another process writes all the time. whole: by our door; else it truncates it and goes on."""
    words: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "a.nc"
        contents = _two(Path(place))
        path.write_bytes(contents[0])

        def change() -> None:
            for content in contents:
                if whole:
                    write_whole(path, content, sync=False)
                else:
                    with path.open("wb") as stream:
                        for start in range(0, len(content), 10_000):
                            stream.write(content[start : start + 10_000])
                            stream.flush()
                            time.sleep(1e-4)
                time.sleep(2e-3)

        child = _beside(change)
        try:
            for _ in range(count):
                try:
                    values = read_tree(path, "NetCDF-4")["a"].to_numpy()
                except InputError as error:
                    if whole or len(str(error).splitlines()) > 1:
                        raise Broken(f"a whole file was refused: {error}") from error
                    words["refused"] += 1
                    continue
                if (len(values), set(values.tolist())) not in ((3000, {1.0}), (9000, {2.0})):
                    raise Broken(f"read {len(values)} values {set(values.tolist())}")
                words["read"] += 1
        finally:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
    return words


def two_writers_of_a_file(count: int) -> None:
    """Two processes write one file; what stands is of one of them, and nothing else is left."""
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "a.nc"
        contents = [b"a" * 100_000, b"b" * 200_000]
        children = [_beside(lambda content=content: write_whole(path, content)) for content in contents]
        try:
            while not path.exists():
                time.sleep(1e-3)
            for _ in range(count):
                if path.read_bytes() not in contents:
                    raise Broken("a file of two writers")
        finally:
            for child in children:
                os.kill(child, signal.SIGTERM)
                os.waitpid(child, 0)


def two_writers_of_a_store() -> str:
    """The sentence for who comes second to a store; the first one goes on."""
    with tempfile.TemporaryDirectory() as place:
        path, begun = Path(place) / "a.zarr", Path(place) / "begun"

        def hold() -> None:
            import faults.writers as ours

            made = ours.records_of

            def slowly(*asked):
                for record in made(*asked):
                    yield record
                    begun.touch()
                    time.sleep(0.2)

            ours.records_of = slowly
            store(path)
            os._exit(0)

        child = _beside(hold)
        while not begun.exists():
            time.sleep(1e-2)
        kind, text = in_fork(lambda: store(path))
        _, status = os.waitpid(child, 0)
        if kind != "refused" or status:
            raise Broken(f"the second writer ended with {kind}: {text}; the first one with {status}")
        kind, after = in_fork(lambda: store(path))
        if kind != "done":
            raise Broken(after)
    return text
