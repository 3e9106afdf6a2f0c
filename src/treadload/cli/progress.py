"""Progress on stderr: a bar or a spinner in a terminal; in pipes, CI and notebooks a line now and then."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

# Work shorter than this says nothing where there is no terminal, s; no two lines are closer than it.
SHORT = 3.0
# A stage that goes on is reported again after this long, s.
AGAIN = 10.0


class _Rate(ProgressColumn):
    """How many a second, or how long each takes."""

    def render(self, task: Task) -> Text:
        """The rate of the last half minute."""
        rate = task.speed
        return Text("" if not rate else f"{rate:.2g}/s" if rate >= 1 else f"{1 / rate:.2g} s each")


Stage = Callable[[str], None]
Count = Callable[[int, int, str], None]


class Lines:
    """Lines that name the stage: once it has lasted a moment, and again at intervals, from a thread of their own."""

    def __init__(self, write: Callable[[str], None], began: float | None = None) -> None:
        self._write, self._short, self._again = write, SHORT, AGAIN
        self._began = self._last = time.monotonic() if began is None else began
        self._text, self._printed = "", False
        self._first: tuple[int, float] | None = None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def stage(self, text: str) -> None:
        """A stage begins, or the text of the present one changes."""
        self._text, self._printed = text, False

    def count(self, done: int, total: int, what: str) -> None:
        """So many of so many are done."""
        self._text = f"{done} of {total} {what}s{self._pace(done, total)}"

    def _pace(self, done: int, total: int) -> str:
        """Rate and time left, once both can be stated."""
        now = time.monotonic()
        if self._first is None or done < self._first[0]:
            self._first = (done, now)
        before, since = self._first
        if done - before < 2 or now - since < self._short:
            return ""
        rate = (done - before) / (now - since)
        left = (total - done) / rate
        often = f"{rate:.2g} a second" if rate >= 1 else f"{1 / rate:.2g} s each"
        return f", {often}, {f'{left:.0f} s' if left < 100 else f'{left / 60:.0f} min'} left"

    def tick(self, now: float) -> None:
        """Look at the clock, s, and write a line if it is time for one."""
        quiet = now - self._last
        if self._text and (quiet >= self._again or (quiet >= self._short and not self._printed)):
            self._write(f"{now - self._began:5.0f} s  {self._text}")
            self._last, self._printed = now, True

    def _run(self) -> None:
        while not self._over.wait(self._short / 8):
            self.tick(time.monotonic())

    def __enter__(self) -> Lines:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()


def _lines(console: Console) -> Lines:
    return Lines(lambda text: console.print(text, markup=False))


@contextlib.contextmanager
def stages(console: Console, *, quiet: bool) -> Iterator[Stage]:
    """What to call with the text of every stage. console: stderr. quiet: True to print nothing."""
    if quiet:
        yield lambda text: None
    elif console.is_terminal:
        with console.status("starting") as status:
            yield lambda text: status.update(text)
    else:
        with _lines(console) as lines:
            yield lines.stage


@contextlib.contextmanager
def counts(console: Console, *, quiet: bool) -> Iterator[Count]:
    """What to call with how many solves are done, of how many, and of what."""
    if quiet:
        yield lambda done, total, what: None
    elif console.is_terminal:
        with Progress(
            TextColumn("{task.description:10}"), BarColumn(), MofNCompleteColumn(), _Rate(), TimeRemainingColumn(),
            console=console, transient=True,
        ) as bar:  # fmt: skip
            task = bar.add_task("reading", total=None)
            yield lambda done, total, what: bar.update(task, completed=done, total=total, description=f"{what}s")
    else:
        with _lines(console) as lines:
            lines.stage("reading")
            yield lines.count
