"""Stores of studies whose files are damaged, then opened and resumed.

What counts: a refusal in one sentence, or the numbers of the undamaged study, with a sentence where something was
solved again or made anew. A case that an opened store does not hold is waiting, never another number.
"""

from __future__ import annotations

import atexit
import random
import shutil
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import treadload as tl
from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from sweeps import small_case
from treadload.sweeps import open_sweep

VARY = {"modulus": [1e9, 2e9, 4e9], "poisson": [0.25, 0.35]}
FIELDS = ("stress_zz",)
# Of the store's state: solved to the end, or stopped after so many cases.
_STATES = ("whole", "whole", "without fields", "stopped", "stopped without fields")
_STOPPED = 4


@cache
def _studies() -> tuple[Path, xr.Dataset]:
    """A folder with a store of each state, and the numbers of the undamaged study."""
    folder = Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    case = small_case(folder)

    def stop(done: int, total: int, what: str) -> None:
        if done == _STOPPED:
            raise KeyboardInterrupt

    for state in set(_STATES):
        fields = () if "without" in state else FIELDS
        try:
            tl.sweep(case, VARY, fields=fields, store=folder / f"{state}.zarr",
                     progress=stop if "stopped" in state else None)  # fmt: skip
        except KeyboardInterrupt:
            continue
    return folder, tl.sweep(case, VARY, fields=FIELDS).dataset.load()


def prepare() -> None:
    """Make the studies before the time of an attack counts."""
    _studies()


def damage(rng: random.Random, store: Path) -> str:
    """Damage a file of a store, or exchange two; returns what was done."""
    files = sorted(file for file in store.rglob("*") if file.is_file())
    # As often a file of ours as one of zarr.
    ours = [file for file in files if file.parent.name == ".fields" or file.parent == store]
    file = rng.choice(rng.choice((files, ours)))
    data = file.read_bytes()
    how = rng.choice(("flip", "flip", "cut", "delete", "remove", "swap", "empty", "fill", "grow"))
    at = rng.randrange(len(data)) if data else 0
    if how == "flip" and data:
        file.write_bytes(data[:at] + bytes([data[at] ^ (1 << rng.randrange(8))]) + data[at + 1 :])
    elif how == "cut":
        file.write_bytes(data[:at])
    elif how == "delete":
        file.unlink()
    elif how == "remove":
        file.write_bytes(data[:at] + data[at + rng.randint(1, 200) :])
    elif how == "swap":
        other = rng.choice(files)
        file.write_bytes(other.read_bytes())
        other.write_bytes(data)
        how = f"swap {other.relative_to(store)}"
    elif how == "empty":
        file.write_bytes(b"")
    elif how == "fill":
        file.write_bytes(rng.randbytes(len(data)))
    elif how == "grow":
        file.write_bytes(data[:at] + rng.randbytes(rng.randint(1, 200)) + data[at:])
    return f"{how} {file.relative_to(store)} at {at}"


def attack(rng: random.Random, folder: Path) -> str:
    """Damage a copy of a store, open it, resume it and open it again."""
    studies, truth = _studies()
    state = rng.choice(_STATES)
    path = folder / "study.zarr"
    shutil.copytree(studies / f"{state}.zarr", path)
    # The case reads its footprint beside it.
    for name in ("case.toml", "print.csv"):
        shutil.copy(studies / name, folder)
    done = damage(rng, path)
    fields = () if "without" in state else FIELDS
    before = _STOPPED if "stopped" in state else truth["status"].size
    first = ask(lambda: _loaded(path))
    if not isinstance(first, Refusal):
        _judge(first, truth, fields, before, f"{done}, opened")
    case = tl.Case.from_toml(folder / "case.toml")
    solved: list[int] = []
    told = ask(
        lambda: tl.sweep(
            case, VARY, fields=fields, store=path, progress=lambda done, total, what: solved.append(done)
        )
    )
    if isinstance(told, Refusal):
        return REFUSED
    again = truth["status"].size - solved[0] if solved else 0
    if again > truth["status"].size - before and not told.warnings:
        raise WrongAnswer(f"{done}: {again} cases were solved again without a word")
    for study in (told.dataset.load(), _loaded(path)):
        if not (study["status"].to_numpy() == 1).all() or not set(truth.data_vars) >= set(study.data_vars):
            raise WrongAnswer(f"{done}: resumed with status {study['status'].to_numpy().tolist()}")
        if set(fields) - set(study.data_vars):
            raise WrongAnswer(f"{done}: resumed without {set(fields) - set(study.data_vars)}")
        _judge(study, truth, fields, truth["status"].size, f"{done}, resumed")
    return TAKEN


def _loaded(path: Path) -> xr.Dataset:
    study = open_sweep(path)
    if not study.summary().strip():
        raise WrongAnswer("an empty summary")
    return study.dataset.load()


def _judge(study: xr.Dataset, truth: xr.Dataset, fields: Any, cases: int, what: str) -> None:
    solved = study["status"].to_numpy() == 1
    for name in truth.coords:
        if name in study.coords and not np.array_equal(study[name], truth[name]):
            raise WrongAnswer(f"{what}: other places along {name}")
    for name, values in truth.data_vars.items():
        if name == "seconds" or (name in fields and name not in study):
            continue
        if name not in study:
            if name not in FIELDS and solved.any():
                raise WrongAnswer(f"{what}: {name} is missing")
            continue
        now, then = study[name].to_numpy()[solved], values.to_numpy()[solved]
        if now.shape != then.shape or not (
            np.array_equal(now, then, equal_nan=True) if then.dtype.kind == "f" else (now == then).all()
        ):
            raise WrongAnswer(f"{what}: {name} is {now.ravel()[:4]} in place of {then.ravel()[:4]}")
    lost = solved.sum() < cases or any(name not in study for name in fields)
    if lost and not study.attrs.get("damage"):
        raise WrongAnswer(
            f"{what}: {solved.sum()} of {cases} cases, fields {set(study.data_vars) & set(FIELDS)}, no word"
        )
