"""Commands that are killed, ended or interrupted at a random moment: what stands is whole, and a study goes on.

A command runs in a fork of a process that has loaded everything, so that the moment falls into its work.
"""

from __future__ import annotations

import contextlib
import os
import random
import re
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import treadload as tl
from cases import BASE_AND_SOIL, ONE_AXLE
from faults.disks import OLD, Broken
from treadload.files import write_all
from treadload.sweeps import open_sweep

SIGNALS = {"kill": signal.SIGKILL, "term": signal.SIGTERM, "interrupt": signal.SIGINT}
_CODES = {signal.SIGTERM: 143, signal.SIGINT: 130}
# How long a command may take to end after it was asked to, s.
_PATIENCE = 60.0
_COARSE = (Path(__file__).parent / "case.toml").read_text(encoding="utf-8")
CALIBRATION = """
spacing = "16 mm"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
belt = "315/80R22.5"
[calibration]
parameters = ["foundation"]
load_deflection = [["20 kN", "19.6 mm"], ["40 kN", "35.5 mm"]]
errors = { deflection = "0.2 mm" }
"""


@dataclass(frozen=True)
class Command:
    """A command. line: its arguments. output: what it writes. goes_on: from where it was stopped."""

    line: str
    output: str
    goes_on: bool = False


COMMANDS = {
    "run": Command("run case.toml -q -o out.nc", "out.nc"),
    "tables": Command("run case.toml -q -o out.csv", "out.csv"),
    "life": Command("life life.toml -q --workers 2 -o out.nc", "out.nc"),
    "sweep": Command(
        "sweep case.toml -q --vary friction=0.5:0.8:3 --vary normal_load='20 kN:22 kN:2' --field pressure "
        "-o out.zarr", "out.zarr", goes_on=True,
    ),
    "calibrate": Command("calibrate cal.toml -q --state state.json -o out.nc", "out.nc", goes_on=True),
    "report": Command("report result.nc -q -o out.html", "out.html"),
}  # fmt: skip


def warm(folder: Path) -> None:
    """Load what the commands load, so that forks have it, and make what they read."""
    from treadload.cli.commands import app  # noqa: F401

    _folder(folder)
    case = tl.Case.from_toml(folder / "case.toml")
    result = tl.run(case)
    tl.save_results(result.to_tree(), folder / "result.nc")
    tl.results.write_csv(result.to_tree(), folder / "warm.csv")
    tl.open_results(folder / "result.nc")
    tl.plots.save(result.contact.plot.pressure(), folder / "warm.png")


def start(line: str, folder: Path) -> int:
    """Run a command in a fork, in a group of its own; returns its number. What it says goes into files."""
    import shlex

    sys.stdout.flush()
    ready, begins = os.pipe()
    child = os.fork()
    if child:
        os.close(begins)
        # What comes before the command is this file's, and a signal to it says nothing about the command.
        os.read(ready, 1)
        os.close(ready)
        return child
    status = 70
    try:
        os.setsid()
        os.chdir(folder)
        for number, name in ((1, "said"), (2, "errors")):
            os.dup2(os.open(name, os.O_CREAT | os.O_WRONLY | os.O_TRUNC), number)
        # Capturing test runners put their own in place.
        sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
        for number in SIGNALS.values():
            with contextlib.suppress(OSError):
                signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
        sys.argv = ["treadload", *shlex.split(line)]
        from treadload.cli import main

        os.close(ready)
        os.close(begins)
        main()
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else 0
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        with contextlib.suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(status)


def wait(child: int) -> int:
    """The exit code of a fork, or less than 0 for a signal. Raises Broken for one that does not end."""
    until = time.monotonic() + _PATIENCE
    while time.monotonic() < until:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.01)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    raise Broken(f"did not end within {_PATIENCE:g} s")


def attack(
    name: str, signals: str, draw: random.Random, files: Path, truth: Any, seconds: float, *, old: bool
) -> str:
    """Stop a command at a moment of its work and judge what is left. files: its inputs. truth: of `kept`."""
    command, number = COMMANDS[name], SIGNALS[signals]
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        _folder(folder)
        os.link(files / "result.nc", folder / "result.nc")
        if old and not command.goes_on:
            (folder / command.output).write_bytes(OLD)
        child = start(command.line, folder)
        time.sleep(draw.uniform(0, 1.1 * seconds))
        with contextlib.suppress(ProcessLookupError):
            # Ctrl-C reaches all processes of a terminal, others the one that is named.
            (os.killpg if number == signal.SIGINT else os.kill)(child, number)
        code = wait(child)
        _judge(command, number, folder, code, truth, old=old)
        if command.goes_on and code:
            again = start(command.line, folder)
            code = wait(again)
            if code or not same(kept(command, folder), truth):
                raise Broken(f"{name} did not go on: exit code {code}, {(folder / 'errors').read_text()[-800:]}")
            return "stopped"
        return "stopped" if code else "done"


def _judge(command: Command, number: int, folder: Path, code: int, truth: Any, *, old: bool) -> None:
    said = (folder / "errors").read_text() if (folder / "errors").exists() else ""
    left = [str(file) for file in folder.rglob("*") if ".part" in file.name]
    if number == signal.SIGKILL:
        if code not in (-number, 0):
            raise Broken(f"exit code {code}: {said[-800:]}")
    else:
        if code not in (_CODES[number], 0):
            raise Broken(f"exit code {code}: {said[-1500:]}")
        if left:
            raise Broken(f"left {left} after {said}")
        if "Traceback" in said or "Exception ignored" in said:
            raise Broken(said[-1500:])
        if code and not re.search(
            r"^error: interrupted; .*the same command (starts again|goes on)", said, re.MULTILINE
        ):
            raise Broken(f"stopped with {said!r}")
    output = folder / command.output
    if command.goes_on and output.suffix == ".nc" and not output.exists():
        return
    if output.suffix == ".zarr":
        if (output / "study.json").exists():
            open_sweep(output).summary()
        return
    now = output.read_bytes() if output.exists() else None
    if (now is None and not old) or (now == OLD and old):
        return
    if now is None or not same(kept(command, folder), truth):
        raise Broken(f"{output.name} is neither the old nor the new one, exit code {code}")


def kept(command: Command, folder: Path) -> Any:
    """What a command has written, in a form to compare."""
    output = folder / command.output
    if output.suffix == ".zarr":
        return open_sweep(output).dataset.load().drop_vars("seconds")
    if output.suffix == ".nc":
        return tl.open_results(output).tree
    if output.suffix == ".csv":
        return {file.name: file.read_bytes() for file in sorted(folder.glob("out*.csv"))}
    # A page says when it was written.
    return re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d UTC", "", output.read_text(encoding="utf-8"))


def same(one: Any, other: Any) -> bool:
    """Whether two have the same numbers, to the last digit; attributes tell of times."""
    return bool(one == other) if isinstance(one, str | dict) else bool(one.equals(other))


def _folder(folder: Path) -> None:
    (folder / "case.toml").write_text(_COARSE, encoding="utf-8")
    (folder / "cal.toml").write_text(CALIBRATION, encoding="utf-8")
    (folder / "life.toml").write_text(ONE_AXLE + BASE_AND_SOIL, encoding="utf-8")


def kills(count: int, names: list[str], seed: int, tell: Callable[[str], None] = print) -> int:
    """Attack commands so often with each signal; returns how many broke."""
    broken = 0
    with tempfile.TemporaryDirectory() as place:
        files = Path(place)
        warm(files)
        for name in names:
            began = time.monotonic()
            if wait(start(COMMANDS[name].line, files)):
                raise Broken(f"{name} without a signal: {(files / 'errors').read_text()}")
            seconds = time.monotonic() - began
            truth = kept(COMMANDS[name], files)
            for signals in SIGNALS:
                words: Counter[str] = Counter()
                for index in range(count):
                    draw = random.Random(f"{name} {signals} {seed} {index}")
                    try:
                        words[attack(name, signals, draw, files, truth, seconds, old=index % 2 == 0)] += 1
                    except Broken as error:
                        broken += 1
                        tell(f"{name} {signals} {index}: BROKEN {error}")
                tell(f"{name:10} {signals:10} {dict(words)} of {count}, {seconds:.1f} s each")
    return broken


def stopped_while_writing(signals: str, count: int, seed: int = 0) -> Counter:
    """Stop a process that does nothing but write three files together, so often; returns how it ended.

    Raises Broken for half a file, and for a temporary one after an orderly end.
    """
    words: Counter[str] = Counter()
    number, draw = SIGNALS[signals], random.Random(f"writing {signals} {seed}")
    contents = [letter * 300_000 for letter in (b"a", b"b")]
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        paths = [folder / f"{name}.bin" for name in range(3)]
        for _ in range(count):
            for path in paths:
                path.unlink(missing_ok=True)
            child = _writing(paths, contents)
            while not all(path.exists() for path in paths):
                time.sleep(1e-3)
            time.sleep(draw.uniform(0, 0.1))
            os.kill(child, number)
            code = wait(child)
            if code != _CODES.get(number, -number):
                raise Broken(f"ended with {code} on {signals}")
            if any(path.read_bytes() not in contents for path in paths):
                raise Broken("half a file")
            left = [path for path in folder.iterdir() if path not in paths]
            if left and number != signal.SIGKILL:
                raise Broken(f"left {left}")
            words["left a temporary file" if left else "clean"] += 1
            for path in left:
                path.unlink()
    return words


def _writing(paths: list[Path], contents: list[bytes]) -> int:
    """A fork that writes files together, again and again, as a command of ours does."""
    child = os.fork()
    if child:
        return child
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        for one in SIGNALS.values():
            with contextlib.suppress(OSError):
                signal.signal(one, signal.SIG_DFL)
        from treadload.cli import ending

        with ending.orderly():
            while True:
                for content in contents:
                    write_all((path, content) for path in paths)
    except SystemExit as end:
        os._exit(int(end.code or 0))
    finally:
        os._exit(70)
