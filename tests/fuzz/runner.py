"""Runs attacks one after the other and gathers what they break."""

from __future__ import annotations

import contextlib
import gc
import importlib
import random
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from treadload.errors import GeometryError, InputError

# One attack: draws its input from the generator, writes its files into the folder, and returns a word for the tally.
Attack = Callable[[random.Random, Path], str]

TAKEN, REFUSED = "taken", "refused"
# Of the processor that an attack may take: others may keep the machine busy. A life with a crack that grows under
# tridems solves a few hundred roads: 25 to 55 s.
SECONDS, SECONDS_OF_A_LIFE = 30, 180
_LONGEST = 1500  # characters of a sentence that still fits a screen
_COLLECT = 50  # attacks between two rounds of the garbage collector


class WrongAnswer(Exception):
    """An input was taken and means something else than it says, or was refused though it is right."""


class _TooSlow(BaseException):
    """An attack took longer than it may; no `except Exception` swallows it."""


@dataclass
class Failure:
    """An attack that broke something. index: of the attack in its seed. what: type and place. story: traceback."""

    index: int
    what: str
    story: str


@dataclass
class Tally:
    """What a run of attacks came to."""

    kind: str
    words: Counter[str] = field(default_factory=Counter)
    failures: list[Failure] = field(default_factory=list)
    seconds: float = 0.0

    def add(self, other: Tally) -> None:
        """Count another run of the same kind."""
        self.words += other.words
        self.failures += other.failures
        self.seconds += other.seconds

    def __str__(self) -> str:
        counted = ", ".join(f"{count} {word}" for word, count in sorted(self.words.items()))
        lines = [f"{self.kind}: {counted}; {len(self.failures)} failures; {self.seconds:.0f} s of work"]
        groups: dict[str, list[Failure]] = {}
        for failure in self.failures:
            groups.setdefault(failure.what, []).append(failure)
        for what, members in sorted(groups.items(), key=lambda group: -len(group[1])):
            lines.append(f"\n{len(members)} x {what}, attacks {', '.join(str(one.index) for one in members[:8])}")
            lines.append(members[0].story)
        return "\n".join(lines)


def attack_of(kind: str) -> Attack:
    """The attack of a kind."""
    module = importlib.import_module(f"fuzz.{kind}")
    if hasattr(module, "prepare"):
        module.prepare()
    made: Attack = module.attack
    return made


def batch(work: tuple[str, int, range, Path]) -> Tally:
    """Run the attacks of a kind, a seed and these indices; here, where other processes find it."""
    kind, seed, indices, keep = work
    return run(kind, attack_of(kind), seed, indices, keep)


def run(kind: str, attack: Attack, seed: int, indices: range, keep: Path | None = None) -> Tally:
    """Run the attacks of these indices. keep: folder for the files of those that break something."""
    tally = Tally(kind)
    began = time.perf_counter()
    loose: list[str] = []
    with tempfile.TemporaryDirectory() as name, _unraisable(loose):
        for index in indices:
            folder = Path(name) / "attack"
            folder.mkdir()
            try:
                tally.words[one(kind, attack, seed, index, folder)] += 1
            except Exception as error:
                tally.failures.append(Failure(index, _place(error), _story(error)))
            except _TooSlow:
                tally.failures.append(Failure(index, f"slower than {_seconds(kind)} s", traceback.format_exc()))
            if index % _COLLECT == 0:
                gc.collect()
            tally.failures += [Failure(index, story.splitlines()[0], story) for story in loose]
            if keep is not None and tally.failures and tally.failures[-1].index == index:
                shutil.copytree(folder, keep / f"{kind}-{seed}-{index}", dirs_exist_ok=True)
            loose.clear()
            shutil.rmtree(folder)
    tally.seconds = time.perf_counter() - began
    return tally


def _seconds(kind: str) -> int:
    return SECONDS_OF_A_LIFE if kind == "solved_lives" else SECONDS


def one(kind: str, attack: Attack, seed: int, index: int, folder: Path) -> str:
    """Run one attack, with every warning an error and a limit of time."""
    with warnings.catch_warnings(), _limited(_seconds(kind)):
        warnings.simplefilter("error")
        return attack(random.Random(f"{kind} {seed} {index}"), folder)


def ask(question: Callable[[], Any]) -> Any:
    """The answer, or the sentence of the refusal as a `Refusal`. Raises WrongAnswer for one that is no sentence."""
    try:
        return question()
    except (InputError, GeometryError) as error:
        said = str(error)
        if not said.strip() or len(said.splitlines()) > 1:
            raise WrongAnswer(f"refused in {len(said.splitlines())} lines: {said!r}") from error
        if len(said) > _LONGEST:
            raise WrongAnswer(f"refused in {len(said)} characters: {said[:300]!r}") from error
        return Refusal(said)


class Refusal(str):
    """The sentence of a refusal."""

    __slots__ = ()


def _place(error: Exception) -> str:
    """Type of an exception and the last line of the package that it passed."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [frame for frame in frames if "treadload" in Path(frame.filename).parts] or frames
    if isinstance(error, WrongAnswer):
        return f"WrongAnswer: {str(error)[:60]}"
    return f"{type(error).__name__} at {Path(ours[-1].filename).name}:{ours[-1].lineno}"


def _story(error: Exception) -> str:
    return "".join(traceback.format_exception(error)[-12:])[-2500:]


@contextlib.contextmanager
def _unraisable(found: list[str]) -> Iterator[None]:
    """Gather what Python prints as "Exception ignored in", as readers of files do when they are closed."""
    before = sys.unraisablehook

    def note(event: Any) -> None:
        place = "".join(traceback.format_exception(event.exc_type, event.exc_value, event.exc_traceback)[-4:])
        found.append(f"ignored {event.exc_type.__name__}\n{event.err_msg} {event.object!r}\n{place}")

    sys.unraisablehook = note
    try:
        yield
    finally:
        sys.unraisablehook = before


@contextlib.contextmanager
def _limited(seconds: int) -> Iterator[None]:
    def stop(*_: Any) -> None:
        raise _TooSlow

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
