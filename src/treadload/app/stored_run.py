"""The runs that the process of a browser keeps, and the signal that the user does not want the rest."""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from treadload.case import Case
from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.errors import InputError
from treadload.results import open_results, save_results, to_tree
from treadload.steps.loaded import Loaded, load_case
from treadload.tire import Tire

# Runs and tires in memory; others are read from their files again.
_IN_MEMORY = 4


class Stopped(Exception):
    """The user did not want the rest."""


@dataclass
class StoredRun:
    """What is known of one run. parts: by their names in a file. load: of the case, to be read elsewhere."""

    case: Case | None
    parts: dict[str, BaseResult] = field(default_factory=dict)
    load: Loaded | None = None
    block: Any = None


class StoredRuns:
    """The runs of a process: the last in memory, all as files in the folder of the browser; and the last tires."""

    def __init__(self) -> None:
        self.folder = Path()
        self._runs: OrderedDict[str, StoredRun] = OrderedDict()
        self._tires: OrderedDict[str, Tire] = OrderedDict()

    def tire(self, case: Case, tell: Callable[[str], None]) -> Tire:
        """The tire of a case; reading a scan takes longer than a small solve."""
        assert case.tire is not None
        files = [self.folder / name for name in (case.tire.scan, case.tire.height_map) if name]
        stamps = [os.stat(file).st_mtime_ns for file in files if file.is_file()]
        key = f"{case.tire.model_dump_json()} {stamps}"
        if key not in self._tires:
            tell("reading the tire")
            self._tires[key] = case.build_tire()
            while len(self._tires) > _IN_MEMORY:
                self._tires.popitem(last=False)
        self._tires.move_to_end(key)
        return self._tires[key]

    def keep(self, run: str, stored: StoredRun) -> None:
        """Keep a run in memory, in place of the one that was used the longest time ago."""
        self._runs[run] = stored
        self._runs.move_to_end(run)
        while len(self._runs) > _IN_MEMORY:
            self._runs.popitem(last=False)

    def save(self, run: str, stored: StoredRun) -> None:
        """Write a run to its file."""
        road = None if stored.load is None else stored.load.road
        save_results(to_tree(stored.parts, case=stored.case, road=road), self.folder / f"{run}.nc")

    def run_of(self, run: str) -> StoredRun:
        """A run that is loaded, or that of its file. Raises InputError where it is not there."""
        if run not in self._runs:
            opened = open_results(self.folder / f"{run}.nc")
            case = opened.case
            self.keep(run, StoredRun(case if isinstance(case, Case) else None, dict(opened.parts)))
        return self._runs[run]

    def loaded(self, stored: StoredRun) -> Loaded:
        """The road of a run under its wheels. Raises InputError for a run without a case."""
        if stored.load is None:
            if stored.case is None or stored.case.command == "life":
                raise InputError("this result holds no case of a wheel, so its road cannot be read again")
            # The case in a file has lost the folder that its tire stands in.
            case = Case.from_dict(stored.case.as_tables(), folder=self.folder)
            contact = stored.parts.get("contact")
            stored.load = load_case(
                case, lambda text: None, contact=contact if isinstance(contact, Contact) else None
            )
        return stored.load
