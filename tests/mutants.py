"""Mutants: small faults put into contact, response, damage and study, each given to the tests that reach it.

    python tests/mutants.py map                        # which tests run which lines; kept outside the repository
    python tests/mutants.py run --seed 1 --count 200   # draw, run, print what survived
    python tests/mutants.py run --only damage/miner.py:120:4

A draw is told by its seed and the sources. Rooms share the mutants by their lines, and within a room every place
where a fault can sit is drawn alike. The nearest tests of a mutant are those that run its line (of a constant of a
module: the lines that name it), the fastest first, two of the parameters of one test, as many as `_RINGS` allow: a
first ring, and for what it leaves alive a second. What takes five times the processor's time that it should dies.

What came of seed 11, 200 mutants, drawn from the sources of revision 3658e89 with splitting counted over all rounds.
The first ring alone killed 164: contact 58 of 67, response 30 of 37, damage 50 of 66, study 26 of 30. With the tests
written for its survivors, or those of a second ring, 190 are dead: contact 63, response 34, damage 65, study 28. The
ten left are no fault that a result could show:

    contact/solvers/tangential.py:117, strict=True of a zip of equal lengths
    contact/solvers/marching.py:212, contact/bodies/body.py:85, another start, another preconditioner: the same answer
    contact/bodies/influence.py:160, the sign of an odd kernel in the row where it is zero
    damage/miner.py:295, life/climate.py:48, response/moving.py:266, an equality of reals
    response/moving.py:223, the lower end of a bisection; response/material.py:30, one sample more of a cell's cover
    life/delamination.py:170, no traffic over 1 or over 1.5

What the draw found: a criterion could not read the energy of a passage, a history above a frictionless interface was
refused without friction too, and steps of splitting were counted of the last round alone.

mutmut 3 writes a mutated copy of the whole package and mutates all of it, with no draw; cosmic-ray starts the whole
command of the tests anew for each mutant and knows no map of tests. Here one process has numpy, xarray and the rooms
below read in once, and forks for each mutant, which costs a second instead of ten.
"""

from __future__ import annotations

import argparse
import ast
import difflib
import importlib
import importlib.abc
import importlib.machinery
import importlib.util
import json
import os
import random
import resource
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "treadload"
ROOMS = ("contact", "response", "damage", "life")
CACHE = Path(tempfile.gettempdir()) / "treadload-mutants"

# Tests of one mutant, at most, and their time under the tracer, s: the nearest, and for what these leave the next.
_RINGS = (24, 20.0), (60, 90.0)
# A test that runs longer than this under the tracer is not near to anything, s.
_LONGEST = 20.0
_PATIENCE, _IDLE = 5.0, 10.0
# Rooms that no mutated room is imported by; read in once, before the forks.
_BELOW = ("units", "errors", "variables", "grid", "kernels", "catalogue", "materials", "tire", "pavement")
_THIRD = (
    "numpy", "scipy.fft", "scipy.interpolate", "scipy.linalg", "scipy.optimize", "scipy.special", "scipy.sparse",
    "scipy.integrate", "scipy.ndimage", "scipy.signal", "scipy.spatial", "xarray", "pydantic", "pint", "h5netcdf",
    "hypothesis", "matplotlib.pyplot", "mpmath",
)  # fmt: skip

_COMPARED = {
    ast.Lt: (ast.LtE, ast.GtE), ast.LtE: (ast.Lt, ast.Gt), ast.Gt: (ast.GtE, ast.LtE), ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,), ast.Is: (ast.IsNot,), ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,), ast.NotIn: (ast.In,),
}  # fmt: skip
_COMPUTED = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.MatMult: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
_CALLED = {
    "min": "max", "max": "min", "maximum": "minimum", "minimum": "maximum", "argmax": "argmin", "argmin": "argmax",
    "sin": "cos", "cos": "sin", "any": "all", "all": "any", "floor": "ceil", "ceil": "floor", "nanmax": "nanmin",
    "cumsum": "asarray", "abs": "float", "sqrt": "abs",
}  # fmt: skip


@dataclass(frozen=True)
class Mutant:
    """A fault. path: below the package. line: of the node. number: among the faults of the module. what: in words."""

    path: str
    line: int
    number: int
    what: str

    @property
    def name(self) -> str:
        return f"{self.path}:{self.line}:{self.number}"

    @property
    def module(self) -> str:
        return "treadload." + self.path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def faults(tree: ast.AST) -> Iterator[tuple[ast.AST, str, Any]]:
    """Places of a module where a fault can sit: node, what it becomes in words, and what puts it there."""
    silent = set()
    for node in ast.walk(tree):
        # Words, annotations and what stands in a raise move no number.
        if isinstance(node, (ast.JoinedStr, ast.Raise)):
            silent.update(map(id, ast.walk(node)))
        for name in ("annotation", "returns", "decorator_list"):
            part = getattr(node, name, None)
            for one in part if isinstance(part, list) else [part] if part is not None else []:
                silent.update(map(id, ast.walk(one)))
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            silent.update(map(id, ast.walk(node)))
        if isinstance(node, ast.BinOp) and any(
            isinstance(side, ast.Constant) and isinstance(side.value, str) for side in (node.left, node.right)
        ):
            silent.update(map(id, ast.walk(node)))
        # Unions of types that are aliases.
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr) and ast.unparse(node)[0].isupper():
            silent.update(map(id, ast.walk(node)))
    for node in ast.walk(tree):
        if id(node) not in silent:
            yield from _faults_of(node)


def _faults_of(node: ast.AST) -> Iterator[tuple[ast.AST, str, Any]]:
    def put(name: str, value: Any) -> Any:
        return lambda target: setattr(target, name, value)

    def under(operator: ast.unaryop, name: str) -> Any:
        return lambda target: setattr(target, name, ast.UnaryOp(operator, getattr(target, name)))

    if isinstance(node, ast.Compare):
        for k, operator in enumerate(node.ops):
            for other in _COMPARED[type(operator)]:
                yield (
                    node,
                    f"{type(operator).__name__} → {other.__name__}",
                    (lambda target, k=k, other=other: target.ops.__setitem__(k, other())),
                )
    elif isinstance(node, (ast.BinOp, ast.AugAssign)) and type(node.op) in _COMPUTED:
        other = _COMPUTED[type(node.op)]
        yield node, f"{type(node.op).__name__} → {other.__name__}", put("op", other())
    elif isinstance(node, ast.BoolOp):
        other = ast.Or if isinstance(node.op, ast.And) else ast.And
        yield node, f"{type(node.op).__name__} → {other.__name__}", put("op", other())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield node, "- → +", put("op", ast.UAdd())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield node, "not dropped", under(ast.Not(), "operand")
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield node, f"{node.value} → {not node.value}", put("value", not node.value)
    elif isinstance(node, ast.Constant) and isinstance(node.value, int):
        yield node, f"{node.value} → {node.value + 1}", put("value", node.value + 1)
    elif isinstance(node, ast.Constant) and isinstance(node.value, float):
        value = 1.5 * node.value if node.value else 1.0
        yield node, f"{node.value:g} → {value:g}", put("value", value)
    elif isinstance(node, ast.Call):
        name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        if name in _CALLED:
            where = "id" if isinstance(node.func, ast.Name) else "attr"
            yield (
                node,
                f"{name} → {_CALLED[name]}",
                (lambda target, where=where, name=name: setattr(target.func, where, _CALLED[name])),
            )
    elif isinstance(node, (ast.If, ast.IfExp, ast.While)):
        yield node, "condition turned round", under(ast.Not(), "test")
    if isinstance(node, ast.Return) and isinstance(node.value, (ast.BinOp, ast.Call)):
        yield node, "sign of what is returned", under(ast.USub(), "value")
    elif isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp):
        yield node, "sign of what is assigned", under(ast.USub(), "value")
    elif isinstance(node, ast.Dict):
        for k, value in enumerate(node.values):
            if isinstance(value, ast.BinOp):
                yield (
                    node,
                    f"sign of the value {k}",
                    (lambda target, k=k: target.values.__setitem__(k, ast.UnaryOp(ast.USub(), target.values[k]))),
                )


def mutated(path: str, number: int) -> ast.Module:
    """The module with one fault."""
    tree = ast.parse((SOURCE / path).read_text())
    node, _, put = list(faults(tree))[number]
    put(node)
    return ast.fix_missing_locations(tree)


def modules(rooms: Sequence[str]) -> list[str]:
    return sorted(str(path.relative_to(SOURCE)) for room in rooms for path in (SOURCE / room).rglob("*.py"))


def mutants_of(path: str) -> list[Mutant]:
    tree = ast.parse((SOURCE / path).read_text())
    return [
        Mutant(path, node.lineno, number, f"{what}   [{_text(node)}]")  # type: ignore[attr-defined]
        for number, (node, what, _) in enumerate(faults(tree))
    ]


def _text(node: ast.AST) -> str:
    text = " ".join(ast.unparse(node).split())
    return text if len(text) < 90 else text[:87] + "..."


def draw(seed: int, count: int, rooms: Sequence[str]) -> list[Mutant]:
    """Mutants of `rooms`; all rooms share by their lines, and each has its own order, which no other moves."""
    lines = {room: sum(len((SOURCE / path).read_text().splitlines()) for path in modules([room])) for room in ROOMS}
    share = {room: count * lines[room] / sum(lines.values()) for room in ROOMS}
    numbers = {room: int(share[room]) for room in ROOMS}
    for room in sorted(ROOMS, key=lambda room: numbers[room] - share[room])[: count - sum(numbers.values())]:
        numbers[room] += 1
    drawn = []
    for room in rooms:
        every = [one for path in modules([room]) for one in mutants_of(path)]
        random.Random(f"{seed} {room}").shuffle(every)
        drawn += every[: numbers[room]]
    return drawn


# ---------------------------------------------------------------------------------------------- which tests run what


class Tracer:
    """A plugin of pytest: the lines of the rooms that each test runs, with its fixtures."""

    def __init__(self) -> None:
        self.lines: set[tuple[str, int]] = set()
        self.left: dict[Any, set[int | None]] = {}
        self.found: dict[str, Any] = {}
        self.prefixes = tuple(str(SOURCE / room) + os.sep for room in ROOMS)

    def _call(self, frame: Any, event: str, argument: Any) -> Any:
        name = frame.f_code.co_filename
        if not name.startswith(self.prefixes):
            return None
        self.lines.add((name, frame.f_lineno))
        left = self.left.setdefault(frame.f_code, {line for *_, line in frame.f_code.co_lines()} - {None})
        # What has been seen whole is left alone: lines of a loop would be told a million times.
        return self._line if left else None

    def _line(self, frame: Any, event: str, argument: Any) -> Any:
        if event == "line":
            self.lines.add((frame.f_code.co_filename, frame.f_lineno))
            self.left[frame.f_code].discard(frame.f_lineno)
        return self._line

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any, nextitem: Any) -> Any:
        self.lines, self.left, self.passed, start = set(), {}, False, time.process_time()
        sys.settrace(self._call)
        threading.settrace(self._call)
        # The processor's time: others may be at work on this machine.
        signal.signal(signal.SIGVTALRM, _too_long)
        signal.setitimer(signal.ITIMER_VIRTUAL, _LONGEST)
        try:
            return (yield)
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            sys.settrace(None)
            threading.settrace(None)  # type: ignore[arg-type]
            by_file: dict[str, list[int]] = {}
            for name, line in sorted(self.lines):
                by_file.setdefault(str(Path(name).relative_to(SOURCE)), []).append(line)
            seconds = time.process_time() - start
            if self.passed and by_file:
                self.found[item.nodeid] = {"seconds": seconds, "lines": by_file}

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.when == "call":
            self.passed = report.passed


def _too_long(*_: Any) -> None:
    raise pytest.fail.Exception("too long to be near")


def make_map(files: Sequence[str]) -> None:
    """Fill the cache: a file of JSON for each file of tests that has none or has changed, with the sources then."""
    CACHE.mkdir(exist_ok=True)
    preload()
    for file in files:
        kept = CACHE / (file.replace("/", "_") + ".json")
        text = (ROOT / file).read_text()
        if kept.exists() and json.loads(kept.read_text())["text"] == text:
            continue
        child = os.fork()
        if not child:
            _speak_into(CACHE / "last.txt")
            tracer = Tracer()
            pytest.main(["-q", "-m", "not slow", "-p", "no:cacheprovider", "--hypothesis-seed=0", file], [tracer])
            sources = {path: (SOURCE / path).read_text().splitlines() for path in modules(ROOMS)}
            kept.write_text(json.dumps({"file": file, "text": text, "tests": tracer.found, "sources": sources}))
            os._exit(0)
        start = time.perf_counter()
        os.waitpid(child, 0)
        near = len(json.loads(kept.read_text())["tests"]) if kept.exists() else 0
        print(f"{file}: {near} tests in {time.perf_counter() - start:.0f} s", flush=True)


class Near:
    """Tests near to a line, by the map."""

    def __init__(self) -> None:
        every = [json.loads(path.read_text()) for path in sorted(CACHE.glob("*.json"))]
        # A test that is gone would fail, and be taken for a witness.
        self.maps = [kept for kept in every if _is_fresh(kept)]
        if len(self.maps) < len(every):
            stale = {kept["file"] for kept in every if not _is_fresh(kept)}
            print(f"changed since their map was made, and left out: {', '.join(sorted(stale))}")
        self.was: dict[tuple[int, str], dict[int, int]] = {}

    def _lines(self, k: int, path: str, now: Sequence[str]) -> dict[int, int]:
        """Lines of today → lines when the map was made."""
        if (k, path) not in self.was:
            before = self.maps[k]["sources"].get(path, [])
            blocks = difflib.SequenceMatcher(None, before, now, autojunk=False).get_matching_blocks()
            self.was[k, path] = {b + n + 1: a + n + 1 for a, b, size in blocks for n in range(size)}
        return self.was[k, path]

    def tests(self, mutant: Mutant, most: int, seconds: float) -> list[tuple[str, float]]:
        text = (SOURCE / mutant.path).read_text()
        for wanted in _places(ast.parse(text), mutant.line):
            reached = []
            for k, kept in enumerate(self.maps):
                was = self._lines(k, mutant.path, text.splitlines())
                old = {was[line] for line in wanted if line in was}
                for test, run in kept["tests"].items():
                    if old & set(run["lines"].get(mutant.path, ())):
                        reached.append((test, run["seconds"]))
            if reached:
                break
        chosen: list[tuple[str, float]] = []
        of_one: dict[str, int] = {}
        for test, spent in sorted(reached, key=lambda pair: pair[1]):
            name = test.split("[")[0]
            if of_one.get(name, 0) < 2 and len(chosen) < most and sum(s for _, s in chosen) + spent <= seconds:
                of_one[name] = of_one.get(name, 0) + 1
                chosen.append((test, spent))
        return chosen


def _is_fresh(kept: dict[str, Any]) -> bool:
    path = ROOT / kept["file"]
    return path.exists() and path.read_text() == kept["text"]


def _places(tree: ast.Module, line: int) -> Iterator[set[int]]:
    """Lines that stand for a line: itself, its statement, its function, or those that name what it defines."""
    inside = [node for node in ast.walk(tree) if getattr(node, "lineno", 0) <= line <= getattr(node, "end_lineno", 0)]
    functions = [node for node in inside if isinstance(node, (ast.FunctionDef, ast.Lambda))]
    if functions and not (isinstance(functions[-1], ast.FunctionDef) and line < functions[-1].body[0].lineno):
        yield {line}
        statement = [node for node in inside if isinstance(node, ast.stmt)][-1]
        yield set(range(statement.lineno, (statement.end_lineno or line) + 1))
        yield set(range(functions[0].lineno, (functions[0].end_lineno or line) + 1))
    elif functions:
        # A default: whoever runs the function.
        yield set(range(functions[0].body[0].lineno, (functions[0].end_lineno or line) + 1))  # type: ignore[index]
    else:
        defining = [node for node in inside if isinstance(node, (ast.Assign, ast.AnnAssign))]
        parts = [part for node in defining for part in ast.walk(node)]
        names = {part.id for part in parts if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store)}
        read = [node for node in ast.walk(tree) if isinstance(getattr(node, "ctx", None), ast.Load)]
        yield {node.lineno for node in read if getattr(node, "id", getattr(node, "attr", None)) in names}  # type: ignore[attr-defined]
        for node in reversed([node for node in inside if isinstance(node, ast.ClassDef)]):
            yield set(range(node.lineno, (node.end_lineno or line) + 1))
    yield set(range(1, 10**5))


# ------------------------------------------------------------------------------------------------------ run a mutant


def preload() -> None:
    """Read in once what no mutant touches."""
    os.environ["OMP_NUM_THREADS"] = "1"
    os.environ["MPLBACKEND"] = "agg"
    for name in _THIRD:
        try:
            importlib.import_module(name)
        except ImportError:
            print(f"without {name}")
    for name in _BELOW:
        importlib.import_module(f"treadload.{name}")
        for path in (SOURCE / name).glob("**/*.py"):
            importlib.import_module("treadload." + ".".join(path.relative_to(SOURCE).with_suffix("").parts))
    early = [name for name in sys.modules if name.startswith(tuple(f"treadload.{room}" for room in ROOMS))]
    assert not early, f"read in before the fork: {early}"


class _Faulty(importlib.abc.MetaPathFinder):
    """Imports one module with its fault."""

    def __init__(self, module: str, code: Any) -> None:
        self.module, self.code = module, code

    def find_spec(self, name: str, path: Any, target: Any = None) -> Any:
        if name != self.module:
            return None
        spec = importlib.machinery.PathFinder.find_spec(name, path)
        assert spec is not None
        spec.loader.get_code = lambda name: self.code  # type: ignore[attr-defined]
        return spec


def _speak_into(path: Path) -> None:
    log = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)


def run(mutant: Mutant, tests: Sequence[str], seconds: float) -> str:
    """killed, survived or timeout. seconds: of the processor; several times as many by the clock."""
    code = compile(mutated(mutant.path, mutant.number), str(SOURCE / mutant.path), "exec")
    child = os.fork()
    if not child:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 5))
        _speak_into(CACHE / f"last{os.getppid()}.txt")
        sys.meta_path.insert(0, _Faulty(mutant.module, code))
        status = pytest.main(
            ["-x", "-q", "--no-header", "--tb=no", "-p", "no:cacheprovider", "--hypothesis-seed=0", *tests]
        )
        sys.stdout.flush()
        os._exit(min(int(status), 99))
    until = time.monotonic() + _IDLE * seconds
    while time.monotonic() < until:
        done, status = os.waitpid(child, os.WNOHANG)
        if done and os.WIFSIGNALED(status):
            return "timeout"
        if done:
            return "survived" if status == 0 else "killed"
        time.sleep(0.05)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return "timeout"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verb", choices=["map", "run", "list"])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--rooms", nargs="*", default=list(ROOMS))
    parser.add_argument("--only", nargs="*", help="names of mutants, as printed")
    parser.add_argument("--tests", nargs="*", help="map: files of tests; run: these tests instead of the nearest")
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--rings", type=int, default=len(_RINGS), help="of nearest tests, at most")
    given = parser.parse_args()
    sys.path[:0] = [str(ROOT / "src"), str(ROOT / "tests")]
    os.chdir(ROOT)
    if given.verb == "map":
        every = sorted(ROOT.glob("tests/unit/test_*.py")) + sorted(ROOT.glob("tests/[pr]*/test_*.py"))
        return make_map(given.tests or [str(path.relative_to(ROOT)) for path in every])
    drawn = draw(given.seed, given.count, given.rooms)
    if given.only:
        wanted = {name.split(":")[0]: [] for name in given.only}
        every_of = [one for path in wanted for one in mutants_of(path)]
        drawn = [one for one in every_of if one.name in given.only]
    if given.verb == "list":
        for one in drawn:
            print(one.name, one.what)
        return None
    preload()
    near, counts = Near(), {"killed": 0, "survived": 0, "timeout": 0}
    for place, one in enumerate(drawn[given.first :], given.first):
        ended, tests, before = "survived", [], set()
        for most, seconds in _RINGS[: given.rings]:
            ring = [(test, 30.0) for test in given.tests] if given.tests else near.tests(one, most, seconds)
            tests = [pair for pair in ring if pair[0] not in before]
            before |= {test for test, _ in tests}
            if tests and ended == "survived":
                ended = run(one, [test for test, _ in tests], 30 + _PATIENCE * sum(spent for _, spent in tests))
        counts[ended] += 1
        print(f"{place} {ended} by {len(before)} tests: {one.name} {one.what}", flush=True)
    total = sum(counts.values())
    print(f"seed {given.seed}: {total} mutants, " + ", ".join(f"{n} {what}" for what, n in counts.items()), end="; ")
    print(f"{(total - counts['survived']) / max(total, 1):.1%} killed")
    return None


if __name__ == "__main__":
    main()
