"""The page killed, ended or interrupted at a random moment: no process stays, no folder, and the next start serves.

All starts share one folder of temporary files, so each is also the next start after the one before it. A visitor
without a window loads the page and solves its first case meanwhile.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import treadload as tl
from app.load import Visitor
from faults.disks import Broken
from page_visits import Serving

# Exit codes of a page that was asked to end, as of other commands; by the signal itself where it came once more.
CODES = {signal.SIGKILL: {-9}, signal.SIGTERM: {143, -15}, signal.SIGINT: {130, -2}}
# How long the page may take to end and its processes to notice, and to start, s: on a machine that others use, too.
_ENDS, _STARTS = 60.0, 240.0
# A folder that a killed server left is removed by the next one after a minute: it is made older by so much, s.
_AGE = 120.0


def run_page(folder: Path) -> subprocess.Popen[str]:
    """A server in a group of its own; what it prints goes into files of the folder."""
    source = str(Path(tl.__file__).parents[1])
    env = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}
    env |= {"OMP_NUM_THREADS": "1", "TMPDIR": str(folder), "PYTHONPATH": source}
    with (folder / "said").open("w") as said, (folder / "errors").open("w") as errors:
        return subprocess.Popen(
            [sys.executable, "-m", "treadload", "app", "--no-open"],
            stdout=said, stderr=errors, text=True, env=env, cwd=folder, start_new_session=True,
            # Shells let what they run in the background ignore Ctrl-C, which the page then does, too.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )  # fmt: skip


def serving(process: subprocess.Popen[str], folder: Path) -> Serving | None:
    """The server once it has printed its address; None if it ended before. Raises Broken if it does neither."""
    until = time.monotonic() + _STARTS
    while time.monotonic() < until:
        printed = re.search(
            r"^treadload app: (http://127\.0\.0\.1:\S+)\n", (folder / "said").read_text(), re.MULTILINE
        )
        if printed:
            return Serving(process, folder, printed[1])
        if process.poll() is not None:
            return None
        time.sleep(0.02)
    raise Broken(f"the page did not start within {_STARTS:g} s")


def processes_of(folder: Path) -> list[int]:
    """Processes with this folder of temporary files, but for this one."""
    return list(_those(f"TMPDIR={folder}".encode()))


def _those(mark: bytes) -> Iterator[int]:
    for place in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            # What has ended and is not waited for yet has no environment any more.
            if mark in (place / "environ").read_bytes().split(b"\0") and int(place.name) != os.getpid():
                yield int(place.name)


class Visit(threading.Thread):
    """A visitor who solves the first case, until it is stopped. states: of the page that were seen."""

    def __init__(self, process: subprocess.Popen[str], folder: Path) -> None:
        super().__init__(daemon=True)
        self._process, self._folder = process, folder
        self._loop = asyncio.new_event_loop()
        self._task: asyncio.Task[None] | None = None
        self.states: list[str] = []

    def run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._task = self._loop.create_task(self._solve())
        # A server that ends breaks its connections in many ways.
        with contextlib.suppress(Exception, asyncio.CancelledError):
            self._loop.run_until_complete(self._task)

    async def _solve(self) -> None:
        server = await asyncio.to_thread(serving, self._process, self._folder)
        if server is None:
            return
        self.states.append("serves")
        async with Visitor(server) as visitor:
            self.states.append("visited")
            self.states.append(await visitor.until("ready", "done", "failed"))

    def stop(self) -> None:
        """End the visit, whatever it waits for."""
        if self._task is not None:
            self._loop.call_soon_threadsafe(self._task.cancel)
        self.join(_ENDS)


def attack(signals: str, draw: random.Random, folder: Path, seconds: float) -> str:
    """Stop the page at a moment of its first `seconds`, and judge what is left; returns what it had come to."""
    number = {"kill": signal.SIGKILL, "term": signal.SIGTERM, "interrupt": signal.SIGINT}[signals]
    left_before = list(folder.glob("treadload-app-*"))
    process = run_page(folder)
    visit = Visit(process, folder)
    visit.start()
    visit.join(draw.uniform(0, seconds))
    came_to = visit.states[-1] if visit.states else "starts"
    ended = process.poll()
    if ended is not None:
        raise Broken(f"the page ended of itself with {ended}: {(folder / 'errors').read_text()[-800:]}")
    # Ctrl-C reaches all processes of a terminal, others the one that is named.
    (os.killpg if number == signal.SIGINT else os.kill)(process.pid, number)
    try:
        code = process.wait(_ENDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        raise Broken(f"the page did not end within {_ENDS:g} s, it {came_to}") from None
    finally:
        visit.stop()
    _judge(number, code, folder, came_to)
    if came_to != "starts" and any(path.exists() for path in left_before):
        raise Broken(f"what a killed page left is still there: {left_before}")
    for path in folder.glob("treadload-app-*"):
        os.utime(path, (time.time() - _AGE,) * 2)
    return came_to


def _judge(number: int, code: int, folder: Path, came_to: str) -> None:
    said = (folder / "errors").read_text()
    if code not in CODES[signal.Signals(number)]:
        raise Broken(f"exit code {code} on signal {number}, it {came_to}: {said[-800:]}")
    # One that loads when the page is killed notices once it has loaded.
    until = time.monotonic() + _STARTS
    while processes := processes_of(folder):
        if time.monotonic() > until:
            for one in processes:
                os.kill(one, signal.SIGKILL)
            raise Broken(f"{len(processes)} processes stayed, it {came_to}")
        time.sleep(0.05)
    parts = [path for path in folder.rglob("*") if ".part" in path.name]
    if number != signal.SIGKILL:
        # While Python itself loads the package, no handler of ours is set yet: that traceback is Python's.
        loads = (
            came_to == "starts" and "runpy" in said and "treadload/cli" not in said and "KeyboardInterrupt" in said
        )
        if not loads and ("Traceback" in said or "Exception ignored" in said):
            raise Broken(said[-1500:])
        # Before the first lines are loaded, no folder of its own is there that could be older than this start.
        own = [path for path in folder.glob("treadload-app-*") if time.time() - path.stat().st_mtime < _AGE / 2]
        if own or parts:
            raise Broken(f"left {[*own, *parts]}, it {came_to}")


def stopped_pages(count: int, seed: int, tell: Callable[[str], None] = print) -> int:
    """Stop the page so often by each signal, and once more start it and solve; returns how many broke."""
    broken = 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        seconds = _whole(folder)
        for signals in ("kill", "term", "interrupt"):
            words: Counter[str] = Counter()
            for index in range(count):
                try:
                    words[attack(signals, random.Random(f"app {signals} {seed} {index}"), folder, seconds)] += 1
                except Broken as error:
                    broken += 1
                    tell(f"app {signals} {index}: BROKEN {error}")
            tell(f"{'app':10} {signals:10} {dict(words)} of {count}, {seconds:.1f} s each")
        _whole(folder)
    return broken


def _whole(folder: Path) -> float:
    """How long the page takes to start and to solve its first case, s. Raises Broken where it does not."""
    began = time.monotonic()
    process = run_page(folder)
    visit = Visit(process, folder)
    visit.start()
    visit.join(_STARTS)
    seconds = time.monotonic() - began
    process.terminate()
    process.wait(_ENDS)
    visit.stop()
    if visit.states[-1:] not in (["ready"], ["done"]):
        raise Broken(f"the page came to {visit.states}: {(folder / 'errors').read_text()[-800:]}")
    return seconds
