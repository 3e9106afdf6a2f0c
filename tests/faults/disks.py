"""Writers on disks that end: a limit of the size of files, a small file system, a read-only one.

Each attempt runs in a fork, so that a crash ends the fork and is seen.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import subprocess
import tempfile
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from faults.writers import DESIGN, Writer, store
from treadload.errors import InputError
from treadload.sweeps import open_sweep

OLD = b"what was there before\n" * 40
# Shares of the largest file that a limit leaves, and sizes of a file system, kB; each the ten of the harness.
SHARES = (0.0, 0.001, 0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 0.9999, 2.0)
SIZES = (8, 16, 24, 40, 80, 160, 320, 640, 2000, 20000)
_HALF = DESIGN.count // 2


class Broken(Exception):
    """A crash, an error that is no sentence, or a file that was lost."""


def in_fork(act: Callable[[], Any]) -> tuple[str, str]:
    """How an act ends in a fork: "done", "refused" with its sentence, or "raw" with what it printed or its signal."""
    reading, writing = os.pipe()
    said, saying = os.pipe()
    child = os.fork()
    if child == 0:
        os.dup2(saying, 2)
        word = ("raw", "")
        try:
            act()
            word = ("done", "")
        except InputError as error:
            word = ("refused", str(error))
        except BaseException:
            word = ("raw", traceback.format_exc())
        finally:
            os.write(writing, json.dumps(word).encode())
            os._exit(0)
    os.close(writing)
    os.close(saying)
    with open(reading, "rb") as pipe, open(said, "rb") as errors:
        word, printed = pipe.read(), errors.read().decode()
    _, status = os.waitpid(child, 0)
    if status or not word:
        return "raw", f"ended with status {status}: {printed[-500:]}"
    if "Traceback" in printed or "Exception ignored" in printed:
        return "raw", printed[-1500:]
    kind, text = json.loads(word)
    return kind, text


def limited(count: int) -> None:
    """Let no file of this process become longer, bytes."""
    import resource

    resource.setrlimit(resource.RLIMIT_FSIZE, (count, count))


@contextlib.contextmanager
def file_system(kilobytes: int) -> Iterator[Path | None]:
    """A file system of a size in memory; None where mounting is not allowed."""
    folder = Path(tempfile.mkdtemp())
    command = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(folder)]
    try:
        if shutil.which("mount") is None or subprocess.run(command, capture_output=True).returncode:
            yield None
            return
        try:
            yield folder
        finally:
            subprocess.run(["umount", str(folder)], check=True)
    finally:
        folder.rmdir()


@contextlib.contextmanager
def read_only(folder: Path) -> Iterator[bool]:
    """A folder nothing can be written to, while it lasts; False where that cannot be had, as for root."""
    folder.chmod(0o555)
    try:
        yield not os.access(folder, os.W_OK)
    finally:
        folder.chmod(0o755)


def held(folder: Path) -> dict[str, bytes]:
    """All files of a folder but those of stores."""
    return {file.name: file.read_bytes() for file in sorted(folder.iterdir()) if file.is_file()}


def made_by(writer: Writer, scratch: Path) -> dict[str, int]:
    """Names and sizes of the files that a writer makes where there is room."""
    scratch.mkdir()
    kind, text = in_fork(lambda: writer.write(scratch / writer.name))
    if kind != "done":
        raise Broken(f"without a limit: {text}")
    sizes = {str(file.relative_to(scratch)): file.stat().st_size for file in scratch.rglob("*") if file.is_file()}
    shutil.rmtree(scratch)
    return sizes


def before(writer: Writer, folder: Path, names: list[str], *, old: bool) -> None:
    """What a writer finds in its folder."""
    if old and writer.is_store:
        store(folder / writer.name, _HALF)
    elif old:
        for name in names:
            (folder / name).write_bytes(OLD)


def attempt(writer: Writer, folder: Path, limit: Callable[[], None]) -> str:
    """Let a writer write under a limit and judge what is left; returns how it ended. Raises Broken."""
    was = held(folder)

    def act() -> None:
        limit()
        writer.write(folder / writer.name)

    kind, text = in_fork(act)
    now = held(folder)
    if kind == "raw":
        raise Broken(text)
    if kind == "refused" and (len(text.splitlines()) != 1 or not 20 < len(text) < 1500):
        raise Broken(f"refused in {text!r}")
    left = [str(file) for file in folder.rglob("*") if ".part" in file.name]
    if left:
        raise Broken(f"left {left}; {text}")
    if writer.is_store:
        _judge_store(folder / writer.name, kind, was_begun=bool(was) or (folder / writer.name).exists())
    elif kind == "refused" and now != was:
        raise Broken(f"{sorted(was)} became {sorted(now)}: {text}")
    elif kind == "done" and OLD in now.values():
        raise Broken("an old file stayed though all was written")
    return kind


def _judge_store(path: Path, kind: str, *, was_begun: bool) -> None:
    """A store opens, holds true numbers only, and what it held before."""
    if not (path / "study.json").exists():
        if kind == "done":
            raise Broken("no study was written")
        return
    found = open_sweep(path)
    truth = {record.number: record for record in _records()}
    solved = 0
    for number, status in enumerate(found.dataset["status"].to_numpy().ravel()):
        if status == 1:
            solved += 1
            for name, (_, value) in truth[number].numbers.items():
                got = found.dataset[name].to_numpy().reshape(DESIGN.count, -1)[number]
                if not (got == value).all():
                    raise Broken(f"case {number} says {name} = {got}, and it is {value}")
    if kind == "done" and solved < DESIGN.count:
        raise Broken(f"only {solved} of {DESIGN.count} cases are kept")


def _records() -> Any:
    from studies import records_of, wheel

    return records_of(DESIGN, wheel)
