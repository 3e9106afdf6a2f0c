"""Do the examples still give the same numbers? Another revision's, run by its own code, beside those of this tree.

    python benchmarks/compare_results.py main~5
    python benchmarks/compare_results.py f05996c --examples demo paper --coarse --renamed old_name=new_name

The revision is checked out in a temporary worktree of git. In both trees each example runs in a process of its own,
and every number of its results is kept: those that its files and its functions give. For every variable the largest
difference is told, over the largest size of that variable before. The exit code is 1 where one is above the tolerance
or a variable is missing, and 2 where an example or git fails. Nothing is left behind.
"""

from __future__ import annotations

import argparse
import dataclasses
import os
import runpy
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
TOLERANCE = 1e-12
Arrays = dict[str, np.ndarray]


class Failed(Exception):
    """Why the comparison cannot be made, in a sentence."""


# What a tree gives. All below runs in that tree's process, with its own treadload.


def numbers_of(thing: Any, name: str = "") -> Iterator[tuple[str, np.ndarray]]:
    """(name, array) of all numbers in a result: datasets, what holds one, mappings, lists and dataclasses of them.

    Without texts, and without what depends on the machine: seconds.
    """
    if isinstance(thing, bool | int | float | np.ndarray | np.number):
        array = np.asarray(thing)
        if array.dtype.kind in "biufc" and "second" not in name.rpartition("/")[2]:
            yield name, array
    elif hasattr(thing, "data_vars"):
        parts = {str(key): value.values for key, value in {**thing.coords, **thing.data_vars}.items()}
        yield from numbers_of({**parts, "attrs": dict(thing.attrs)}, name)
        yield from numbers_of(dict(getattr(thing, "children", {})), name)
    elif hasattr(thing, "dataset"):
        yield from numbers_of(thing.dataset, name)
        yield from numbers_of(dict(getattr(thing, "stats", {})), f"{name}/stats")
    elif hasattr(thing, "coords") and hasattr(thing, "values"):
        yield from numbers_of(
            {**{str(key): value.values for key, value in thing.coords.items()}, "": thing.values}, name
        )
    elif isinstance(thing, Mapping):
        for key, value in thing.items():
            yield from numbers_of(value, f"{name}/{key}" if name else str(key))
    elif isinstance(thing, list | tuple):
        for number, value in enumerate(thing):
            yield from numbers_of(value, f"{name}/{number}")
    elif dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        yield from numbers_of({field.name: getattr(thing, field.name) for field in dataclasses.fields(thing)}, name)


def files_in(folder: Path) -> Iterator[tuple[str, np.ndarray]]:
    """Numbers of the results in NetCDF that an example wrote."""
    import xarray as xr

    for path in sorted(folder.glob("*.nc")):
        with xr.open_datatree(path, engine="h5netcdf") as tree:
            yield from numbers_of(tree.load(), path.stem)


def watched(script: Path) -> tuple[Callable[..., Any], dict[str, list[Any]]]:
    """The `main` of an example, and what each of its functions will have returned, in the order of the calls."""
    sys.path.insert(0, str(script.parent))
    main = runpy.run_path(str(script))["main"]
    names, found = main.__globals__, {}

    def watch(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*args: Any, **options: Any) -> Any:
            value = function(*args, **options)
            found.setdefault(name, []).append(value)
            return value

        return call

    for name, value in list(names.items()):
        if callable(value) and getattr(value, "__globals__", None) is names and name != "main":
            names[name] = watch(name, value)
    return main, found


def run_demo(tree: Path, folder: Path, coarse: bool) -> dict[str, np.ndarray]:
    from treadload.demo import run_demo

    run_demo(folder)
    return dict(files_in(folder))


def run_script(name: str, coarse_spacing: float | None) -> Callable[[Path, Path, bool], Arrays]:
    def run(tree: Path, folder: Path, coarse: bool) -> Arrays:
        main, found = watched(tree / "examples" / name)
        own = main(folder, coarse_spacing) if coarse and coarse_spacing is not None else main(folder)
        return {**dict(numbers_of(own, "main")), **dict(numbers_of(found)), **dict(files_in(folder))}

    return run


EXAMPLES: Mapping[str, Callable[[Path, Path, bool], Arrays]] = {
    "demo": run_demo,
    "paper": run_script("paper/reproduce.py", None),
    "design_life": run_script("design_life/run.py", 12e-3),
    "roundabout": run_script("roundabout/run.py", 4e-3),
    "top_down": run_script("top_down/run.py", 12e-3),
    "joint": run_script("joint/run.py", 4e-3),
    "rutting": run_script("rutting/run.py", 12e-3),
}


def collect(name: str, tree: Path, out: Path, coarse: bool) -> None:
    """Run an example of a tree, and keep its numbers in a file."""
    with tempfile.TemporaryDirectory() as folder:
        arrays = EXAMPLES[name](tree, Path(folder), coarse)
    if not arrays:
        raise Failed(f"the example {name} gave no numbers")
    # Names of an archive cannot be any text.
    np.savez(out, names=np.array(list(arrays)), **{f"a{k}": value for k, value in enumerate(arrays.values())})


# The comparison.


@contextmanager
def checked_out(revision: str) -> Iterator[Path]:
    """A worktree of the revision in a temporary folder."""
    commit = git(
        "rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}", why=f"no revision {revision!r}"
    ).strip()
    with tempfile.TemporaryDirectory(prefix="treadload-") as folder:
        tree = Path(folder) / "before"
        git("worktree", "add", "--quiet", "--detach", str(tree), commit, why=f"cannot check out {revision}")
        try:
            yield tree
        finally:
            git("worktree", "remove", "--force", str(tree), why=f"cannot remove the worktree {tree}")


def git(*arguments: str, why: str) -> str:
    done = subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True)
    if done.returncode:
        raise Failed(f"{why}: git {arguments[0]} says {done.stderr.strip() or 'nothing'}")
    return done.stdout


def numbers(name: str, tree: Path, folder: Path, label: str, coarse: bool) -> Arrays:
    """All numbers of an example, run in a tree with that tree's own code."""
    began, out = time.perf_counter(), folder / f"{label}-{name}.npz"
    print(f"{name:12s} {label:6s} ", end="", flush=True)
    environment = {**os.environ, "PYTHONPATH": str(tree / "src"), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, __file__, "--collect", name, str(tree), str(out), *(["--coarse"] if coarse else [])]
    done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        print("failed")
        raise Failed(f"the example {name} fails {label}:\n{done.stderr.strip()[-2000:]}")
    with np.load(out) as found:
        arrays = {str(key): found[f"a{k}"] for k, key in enumerate(found["names"])}
    print(f"{time.perf_counter() - began:5.0f} s  {len(arrays)} variables", flush=True)
    return arrays


def difference(before: np.ndarray, after: np.ndarray) -> float:
    """Largest difference over the largest size before; infinite where shapes or places without a number differ."""
    if before.shape != after.shape:
        return np.inf
    kind = np.complex128 if "c" in (before.dtype.kind, after.dtype.kind) else np.float64
    a, b = before.astype(kind).ravel(), after.astype(kind).ravel()
    finite = np.isfinite(a)
    if not np.array_equal(finite, np.isfinite(b)) or not np.array_equal(a[~finite], b[~finite], equal_nan=True):
        return np.inf
    apart = np.abs(a[finite] - b[finite]).max(initial=0.0)
    size = np.abs(a[finite]).max(initial=0.0)
    return 0.0 if apart == 0 else float(apart / size) if size else np.inf


def compare(before: Arrays, after: Arrays, tolerance: float) -> tuple[list[str], bool]:
    """A line a variable that differs, the largest first, and whether all is within the tolerance."""
    rows = {name: difference(value, after[name]) for name, value in before.items() if name in after}
    lines = [
        f"  {value:10.2e}  {name}{'' if value <= tolerance else '   <-- above the tolerance'}"
        for name, value in sorted(rows.items(), key=lambda row: -row[1])
        if value
    ]
    lines.append(f"  {sum(value == 0 for value in rows.values())} of {len(rows)} variables are equal in every digit")
    lines += [f"  only before: {name}" for name in before if name not in after]
    lines += [f"  only after: {name}" for name in after if name not in before]
    return lines, before.keys() == after.keys() and all(value <= tolerance for value in rows.values())


def renamed(arrays: Arrays, pairs: Mapping[str, str]) -> Arrays:
    """The arrays with parts of their names (between slashes) changed, old → new."""
    return {"/".join(pairs.get(part, part) for part in name.split("/")): value for name, value in arrays.items()}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("revision", metavar="REV", help="of git, to compare this tree with")
    parser.add_argument("--examples", nargs="+", choices=list(EXAMPLES), default=list(EXAMPLES), metavar="NAME")
    parser.add_argument("--coarse", action="store_true", help="coarse cells where an example has a choice")
    parser.add_argument("--tolerance", type=float, default=TOLERANCE, help=f"relative; {TOLERANCE:g} if left out")
    parser.add_argument("--renamed", nargs="+", default=[], metavar="OLD=NEW", help="parts of names that changed")
    chosen = parser.parse_args()
    wrong = [pair for pair in chosen.renamed if pair.count("=") != 1]
    if wrong:
        parser.error(f"--renamed takes OLD=NEW, got {wrong[0]!r}")
    pairs = dict(pair.split("=") for pair in chosen.renamed)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    good = True
    try:
        with tempfile.TemporaryDirectory(prefix="treadload-") as scratch, checked_out(chosen.revision) as tree:
            for name in chosen.examples:
                before = renamed(numbers(name, tree, Path(scratch), "before", chosen.coarse), pairs)
                after = numbers(name, ROOT, Path(scratch), "after", chosen.coarse)
                lines, same = compare(before, after, chosen.tolerance)
                good &= same
                print("\n".join(lines), flush=True)
    except Failed as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print("the same" if good else f"NOT the same to {chosen.tolerance:g}")
    return 0 if good else 1


if __name__ == "__main__":
    if sys.argv[1:2] == ["--collect"]:
        example, where, target = sys.argv[2:5]
        collect(example, Path(where), Path(target), "--coarse" in sys.argv[5:])
    else:
        sys.exit(main())
