"""Every writer in every place that refuses it, with and without an old file."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from faults.disks import SHARES, SIZES, Broken, attempt, before, file_system, in_fork, limited, made_by, read_only
from faults.writers import Writer, writers


def nothing() -> None:
    """No limit."""


def by_limit(writer: Writer, shares: tuple[float, ...] = SHARES, olds: tuple[bool, ...] = (False, True)) -> Counter:
    """A writer under limits of the size of a file."""
    words: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        sizes = made_by(writer, Path(name) / "scratch")
        for share in shares:
            for old in (False,) if writer.fresh else olds:
                with tempfile.TemporaryDirectory(dir=name) as folder:
                    before(writer, Path(folder), list(sizes), old=old)
                    largest = max(sizes.values())
                    limit = int(share * largest)
                    kind = attempt(writer, Path(folder), partial(limited, limit))
                    if kind == "done" and limit < largest and not writer.is_store:
                        raise Broken(f"wrote {largest} bytes under a limit of {limit}")
                    if kind == "refused" and limit > largest and writer.name != "a.xlsx":
                        raise Broken(f"refused {largest} bytes under a limit of {limit}")
                    words[kind] += 1
    return words


def by_size(writer: Writer, sizes: tuple[int, ...] = SIZES) -> Counter:
    """A writer on file systems of these sizes, kB; "not mounted" where that is not allowed."""
    words: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        made = made_by(writer, Path(name) / "scratch")
    for size in sizes:
        for old in (False,) if writer.fresh else (False, True):
            with file_system(size) as folder:
                if folder is None:
                    words["not mounted"] += 1
                    continue
                # In a process that ends: threads of a store that has no room go on writing for a moment.
                if in_fork(partial(before, writer, folder, list(made), old=old))[0] != "done":
                    # Not even the old files have room.
                    words["too small"] += 1
                    continue
                words[attempt(writer, folder, nothing)] += 1
    return words


@contextlib.contextmanager
def mounted_read_only(folder: Path) -> Iterator[bool]:
    """A file system that became read only, as a disk does that fails."""
    done = subprocess.run(["mount", "-o", "remount,ro", str(folder)], capture_output=True)
    yield done.returncode == 0


def by_right(writer: Writer) -> Counter:
    """A writer in places that cannot be written to."""
    words: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        made = made_by(writer, Path(name) / "scratch")
        for old in (False,) if writer.fresh else (False, True):
            folder = Path(name) / f"place {old}"
            folder.mkdir()
            before(writer, folder, list(made), old=old)
            with read_only(folder) as holds:
                words[attempt(writer, folder, nothing) if holds else "not for root"] += 1
            with file_system(20_000) as mounted:
                if mounted is None:
                    words["not mounted"] += 1
                    continue
                before(writer, mounted, list(made), old=old)
                with mounted_read_only(mounted) as holds:
                    words[attempt(writer, mounted, nothing) if holds else "not mounted"] += 1
    if "done" in words:
        raise Broken("wrote to a place that is read only")
    return words


def main(only: str | None) -> int:
    """All of it; prints a line for each writer."""
    broken = 0
    for name, writer in writers().items():
        if only and name != only:
            continue
        for place in (by_limit, by_size, by_right):
            try:
                print(f"{name:12} {place.__name__:9} {dict(place(writer))}", flush=True)
            except Broken as error:
                broken += 1
                print(f"{name:12} {place.__name__:9} BROKEN {error}", flush=True)
    print(f"{broken} broken", file=sys.stderr)
    return 1 if broken else 0
