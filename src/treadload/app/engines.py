"""Processes that solve and draw, one for each page of a browser, and one kept warm for the next; never too many."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import os
import sys
import time
from collections.abc import AsyncIterator
from pathlib import Path

from treadload.app.answers import SOLVES, Answer
from treadload.app.service import Limits
from treadload.us_units import in_us_units

# A figure of many cells is one line.
_LONGEST_LINE = 2**28
_ENDS = ("done", "error", "stopped")
# How long a solve may take to stop of itself, s; then its process ends.
_PATIENCE = 0.4
# When the next process is started after one was taken, s: not while the first case of a browser is solved.
_LATER = 12.0
MOST_PROCESSES = 8
"""Processes of one server, 250 to 475 MB each; the one that has been idle for longest ends for another."""
_ENDED = "the process that solves has ended"


class EngineLost(Exception):
    """The process ended before it answered."""


class Engine:
    """A process, see `treadload.app.engine`. Questions and answers are told apart by numbers."""

    def __init__(self, process: asyncio.subprocess.Process, seconds: float | None = None) -> None:
        self._process, self._seconds = process, seconds
        self._numbers = itertools.count(1)
        self._waiting: dict[int, asyncio.Queue[Answer | None]] = {0: asyncio.Queue()}
        # Solves that the process has not ended yet, whether anybody still waits for them or not.
        self._solving: set[int] = set()
        self._reading = asyncio.create_task(self._read())
        self._killed = False
        self.used = time.monotonic()

    @classmethod
    async def start(cls, limits: Limits = Limits()) -> Engine:  # noqa: B008
        """A process that has loaded what it needs. limits: of its memory, and of the time of a request."""
        memory = [] if limits.memory is None else [str(limits.memory)]
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-P", "-m", "treadload.app.engine", *memory, limit=_LONGEST_LINE,
            stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
            # Ctrl-C is for the page, which ends its processes; one that still loads would print where it was.
            start_new_session=True,
            env={
                **os.environ,
                "OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS", "1"),
                "TREADLOAD_UNITS": "us" if in_us_units() else "si",
            },
        )  # fmt: skip
        engine = cls(process, limits.time)
        if await engine._waiting[0].get() is None:
            raise EngineLost("the process that solves did not start; its reason is in the terminal")
        return engine

    @property
    def lives(self) -> bool:
        """False once it ended."""
        return not self._killed and self._process.returncode is None and not self._reading.done()

    @property
    def is_idle(self) -> bool:
        """True where nobody waits for an answer, and nothing is being solved."""
        return not self._solving and len(self._waiting) == 1

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    async def ask(self, do: str, **question: object) -> AsyncIterator[Answer]:
        """Answers as they come; the last holds "done", "error" or "stopped".

        Raises EngineLost where the process ends before it, as it does by the limit of time.
        """
        number, queue = next(self._numbers), asyncio.Queue[Answer | None]()
        self._waiting[number] = queue
        if do in SOLVES:
            self._solving.add(number)
        self.used = time.monotonic()
        until = None if self._seconds is None else asyncio.get_running_loop().time() + self._seconds
        try:
            if not self.lives:
                raise EngineLost(_ENDED)
            await self._send({"id": number, "do": do, **question})
            while True:
                try:
                    async with asyncio.timeout_at(until):
                        answer = await queue.get()
                except TimeoutError:
                    self.kill()
                    raise EngineLost(
                        f"this took longer than {self._seconds:g} s, the most that this server allows; use larger "
                        "cells, or solve it by the command line"
                    ) from None
                if answer is None:
                    raise EngineLost(_ENDED)
                yield answer
                if any(end in answer for end in _ENDS):
                    return
        finally:
            del self._waiting[number]

    async def last(self, do: str, **question: object) -> Answer:
        """The last answer to a question."""
        answer: Answer = {}
        async for answer in self.ask(do, **question):  # noqa: B007
            pass
        return answer

    async def stop(self) -> bool:
        """Ask for the end of what is being solved; False, and no process any more, where that takes too long."""
        if not self._solving or not self.lives:
            return self.lives
        await self._send({"id": 0, "do": "stop"})
        for _ in range(20):
            await asyncio.sleep(_PATIENCE / 20)
            if not self._solving:
                return True
        self.kill()
        return False

    def kill(self) -> None:
        """End the process at once, and say so to all who wait for it: a child of it may keep its output open."""
        self._killed = True
        self._leave()
        with contextlib.suppress(ProcessLookupError):
            self._process.kill()

    def _leave(self) -> None:
        """Tell all who wait that no answer will come."""
        for queue in self._waiting.values():
            queue.put_nowait(None)

    async def _send(self, question: dict[str, object]) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(question).encode() + b"\n")
            await self._process.stdin.drain()
        except (ConnectionError, RuntimeError) as error:
            raise EngineLost(_ENDED) from error

    async def _read(self) -> None:
        assert self._process.stdout is not None
        try:
            while line := await self._process.stdout.readline():
                answer = json.loads(line)
                if any(end in answer for end in _ENDS):
                    self._solving.discard(answer["id"])
                queue = self._waiting.get(answer["id"])
                if queue is not None:
                    queue.put_nowait(answer)
        finally:
            # Who asks from here on is told that it has ended, and does not wait for what nobody reads any more.
            self.kill()
            await self._process.wait()


class Engines:
    """Starts processes ahead of need. limits: of each."""

    def __init__(self, limits: Limits = Limits()) -> None:  # noqa: B008
        self._limits = limits
        self._spare: asyncio.Task[Engine] | None = None
        self._later: asyncio.TimerHandle | None = None
        self._all: list[Engine] = []
        self._starting = 0

    def warm(self) -> None:
        """Have one ready for whoever asks next."""
        if self._spare is None or (self._spare.done() and (self._spare.cancelled() or self._spare.exception())):
            self._spare = asyncio.create_task(self._start())

    async def _start(self) -> Engine:
        self._make_room()
        self._starting += 1
        try:
            engine = await Engine.start(self._limits)
        finally:
            self._starting -= 1
        self._all.append(engine)
        return engine

    def _make_room(self) -> None:
        """End what has been idle for longest, where there are too many. Raises EngineLost where all of them solve."""
        self._all = [engine for engine in self._all if engine.lives]
        if len(self._all) + self._starting < MOST_PROCESSES:
            return
        idle = [engine for engine in self._all if engine.is_idle]
        if not idle:
            raise EngineLost(
                f"{MOST_PROCESSES} cases are being solved at once, the most of this server; solve again when one of "
                "them is done, or cancel one"
            )
        min(idle, key=lambda engine: engine.used).kill()

    async def take(self, folder: Path) -> Engine:
        """A process for the browser with this folder."""
        self.warm()
        assert self._spare is not None
        spare, self._spare = self._spare, None
        try:
            # Who leaves while it starts leaves it to the next.
            engine = await asyncio.shield(spare)
        except asyncio.CancelledError:
            if self._spare is None:
                self._spare = spare
            else:
                spare.add_done_callback(_end)
            raise
        if not engine.lives:
            engine = await self._start()
        engine.used = time.monotonic()
        try:
            await engine.last("folder", folder=str(folder))
        except BaseException:
            # It knows a folder, or is no more: nobody else can take it.
            engine.kill()
            raise
        if self._later is not None:
            self._later.cancel()
        self._later = asyncio.get_running_loop().call_later(_LATER, self._warm_later)
        return engine

    def _warm_later(self) -> None:
        """Have one ready for the next, where it takes the place of none."""
        self._all = [engine for engine in self._all if engine.lives]
        if len(self._all) + self._starting < MOST_PROCESSES:
            self.warm()

    def close(self) -> None:
        """End all processes."""
        if self._later is not None:
            self._later.cancel()
        if self._spare is not None:
            self._spare.cancel()
        for engine in self._all:
            engine.kill()


def _end(started: asyncio.Task[Engine]) -> None:
    """End a process that nobody takes."""
    if not started.cancelled() and started.exception() is None:
        started.result().kill()
