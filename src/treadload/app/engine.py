"""The process that solves and draws for one browser: a line of JSON in, lines of JSON out.

A case is solved in a thread, part by part, and each part is shown as soon as it is there; requests for figures are
answered meanwhile from what is held in memory. Results are NetCDF files in the folder of the browser, so that another
process goes on where this one was stopped. `python -m treadload.app.engine` starts it.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import sys
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from treadload.app import drawing
from treadload.app.life_telling import life_rows, pictures_of, shares_of
from treadload.app.studies import about_study, point_of, point_rows
from treadload.app.telling import allowed_told, rows_of
from treadload.case import Case, LifeCase
from treadload.case.file import FilePart
from treadload.case.first import first_case
from treadload.case.loading import FootprintPart
from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.damage import Verdict
from treadload.damage.miner import Life
from treadload.errors import InputError, TreadloadError
from treadload.files import parse_toml
from treadload.results import open_results, save_results, to_tree
from treadload.study.allowed import passes_allowed
from treadload.study.loaded import Loaded, contact_of, judge, load_case
from treadload.study.run import read_loaded
from treadload.study.run_life import run_life
from treadload.study.sweeps import Sweep
from treadload.tire import Tire

# Results held in memory; others are read from their files again.
_HELD = 4
# Depths of the block of road below the maps, from which slices along any line are cut.
_BLOCK_DEPTHS = 12
# Progress is told so often at most, s.
_SELDOM = 0.2

Say = Callable[..., None]


class Stopped(Exception):
    """The user did not want the rest."""


@dataclass
class Held:
    """What is known of one run. parts: by their names in a file. load: of the case, to be read elsewhere."""

    case: FilePart | None
    parts: dict[str, BaseResult] = field(default_factory=dict)
    load: Loaded | None = None
    block: Any = None


class Engine:
    """What one process holds. folder: of the browser's files."""

    def __init__(self, write: Callable[[str], None]) -> None:
        self._write, self._lock = write, threading.Lock()
        self._runs: OrderedDict[str, Held] = OrderedDict()
        self._tires: OrderedDict[str, Tire] = OrderedDict()
        self._folder = Path()
        self._stop = threading.Event()
        self._solving: threading.Thread | None = None

    def answer(self, request: dict[str, Any]) -> None:
        """Do what a request asks for; whatever is wrong goes back as a sentence."""
        number, do = request.pop("id"), request.pop("do")
        say = self._said(number)
        if do == "stop":
            self._stop.set()
            return
        if do in ("solve", "life"):
            self._wait()
            self._stop.clear()
            solves = self._solve if do == "solve" else self._life
            self._solving = threading.Thread(target=self._guarded, args=(say, solves, request), daemon=True)
            self._solving.start()
            return
        made: dict[str, Callable[..., None]] = {
            "folder": self._take_folder, "maps": self._maps, "cut": self._cut, "difference": self._difference,
            "tread": self._tread, "export": self._export, "section": self._section, "open": self._open,
            "study": self._study, "point": self._point, "shares": self._shares, "pictures": self._pictures,
        }  # fmt: skip
        self._guarded(say, made[do], request)

    def _wait(self) -> None:
        if self._solving is not None:
            self._stop.set()
            self._solving.join()

    def _said(self, number: int) -> Say:
        def say(figures: dict[str, Any] | None = None, **told: Any) -> None:
            # Figures are JSON already, which the browser alone reads.
            if figures:
                told["figures"] = {name: drawing.as_text(one) for name, one in figures.items()}
            whole = json.dumps({"id": number, **told}, default=float)
            with self._lock:
                self._write(f"{whole}\n")

        return say

    def _guarded(self, say: Say, do: Callable[..., None], request: dict[str, Any]) -> None:
        try:
            do(say, **request)
        except Stopped:
            say(stopped=True)
        except TreadloadError as error:
            say(error=str(error))
        except MemoryError:
            say(error="out of memory: the grid is too fine for this machine; use larger cells")
        except Exception as error:
            print(f"treadload app: {type(error).__name__}: {error}", file=sys.stderr)
            say(error=f"the program failed: {type(error).__name__}: {error}")

    def _take_folder(self, say: Say, folder: str) -> None:
        self._folder = Path(folder)
        say(done=True)

    # Solving.

    def _solve(self, say: Say, run: str, table: dict[str, Any], theme: str, view: dict[str, Any]) -> None:
        began = time.monotonic()
        used = time.process_time()
        case = Case.from_dict(table, folder=self._folder, name="case")
        held = Held(case)

        def tell(text: str) -> None:
            if self._stop.is_set():
                raise Stopped
            say(stage=text, seconds=time.monotonic() - began)

        def shown(stage: str) -> None:
            self._keep(run, held)
            warnings = [text for part in held.parts.values() for text in part.warnings]
            drawn = (
                drawing.places(held.parts, theme=theme)
                if stage == "verdict" and not drawing.shows_damage(**view)
                else drawing.maps(held.parts, theme=theme, **view)
            )
            if stage == "contact":
                drawn |= drawing.along(held.parts, None, view.get("line"), theme=theme, held=False)
            say(drawn, part=stage, rows=rows_of(held.parts),
                warnings=list(dict.fromkeys(warnings)), choices=drawing.choices_of(held.parts),
                depths=drawing.depths_of(held.parts),
                seconds=time.monotonic() - began, process=time.process_time() - used)  # fmt: skip

        tell("reading the case")
        if case.footprint is None and not case.dents:
            road = case.pavement.build()
            contact = contact_of(case, road, tell, tire=self._tire(case, tell))
            held.parts["contact"] = contact
            held.load = load_case(case, tell, contact=contact)
        else:
            # Which refuses a body that dents its road, and says what solves it.
            held.load = load_case(case, tell)
            assert held.load.footprint is not None
            held.parts["contact"] = held.load.footprint
        shown("contact")
        response = held.load.solve(case.response.depths)
        held.parts["response"] = response
        tell("drawing")
        shown("response")
        if case.damage is not None:
            tell("verdict")
            held.parts["damage"] = judge(held.load, response)
            shown("verdict")
        say(ready=True, seconds=time.monotonic() - began, process=time.process_time() - used)
        # The page is at work again; what follows makes slices along any line quick, and the run outlast this process.
        self._save(run, held)
        tell("slices through the road")
        bottom = case.response.slices_to(held.load.road.interfaces.tolist(), rigid_base=held.load.road.rigid_base)
        held.block = held.load.solve(drawing.block_depths(bottom, held.load.road.interfaces.tolist(), _BLOCK_DEPTHS))
        tell("passes by criterion")
        verdict = held.parts.get("damage")
        allowed = passes_allowed(held.load, verdict if isinstance(verdict, Verdict) else None)
        say(done=True, seconds=time.monotonic() - began, allowed=allowed_told(allowed))

    def _life(self, say: Say, run: str, table: dict[str, Any], theme: str) -> None:
        began, used, told = time.monotonic(), time.process_time(), 0.0
        case = LifeCase.from_dict(table, folder=self._folder, name="case")
        held = Held(case)

        def tell(done: int, total: int, what: str) -> None:
            nonlocal told
            if self._stop.is_set():
                raise Stopped
            now = time.monotonic()
            if now - told > _SELDOM or done == total:
                told = now
                say(stage=f"{what} {done} of {total}", seconds=now - began)

        def shown(name: str, part: BaseResult) -> None:
            held.parts[name] = part
            self._keep(run, held)
            say(part=name, pictures=pictures_of(name, part), **self._told(held),
                seconds=time.monotonic() - began, process=time.process_time() - used)  # fmt: skip

        say(stage="reading the case", seconds=0.0)
        result = run_life(case, progress=tell, shown=shown)
        self._keep(run, held)
        save_results(result.to_tree(), self._folder / f"{run}.nc")
        say(ready=True, seconds=time.monotonic() - began, process=time.process_time() - used)
        say(done=True)

    def _told(self, held: Held, criterion: str = "") -> dict[str, Any]:
        """Rows, warnings and criteria of a life."""
        warnings = [text for part in held.parts.values() for text in part.warnings]
        names = [str(name) for name in held.parts["life"].dataset["criterion"].to_numpy()]
        return {
            "rows": life_rows(held.parts, criterion),
            "warnings": list(dict.fromkeys(warnings)),
            "criteria": names,
        }

    def _shares(self, say: Say, run: str, criterion: str) -> None:
        held = self._held(run)
        life = held.parts["life"]
        assert isinstance(life, Life)
        told = self._told(held, criterion)
        say(pictures=shares_of(life, criterion or life.governing_criterion), **told, done=True)

    def _pictures(self, say: Say, run: str) -> None:
        held = self._held(run)
        drawn = {key: url for name, part in held.parts.items() for key, url in pictures_of(name, part).items()}
        say(pictures=drawn, **self._told(held), done=True)

    def _tire(self, case: Case, tell: Callable[[str], None]) -> Tire:
        """The tire of a case; reading a scan takes longer than a small solve."""
        assert case.tire is not None
        files = [self._folder / name for name in (case.tire.scan, case.tire.height_map) if name]
        stamps = [os.stat(file).st_mtime_ns for file in files if file.is_file()]
        key = f"{case.tire.model_dump_json()} {stamps}"
        if key not in self._tires:
            tell("reading the tire")
            self._tires[key] = case.build_tire()
            while len(self._tires) > _HELD:
                self._tires.popitem(last=False)
        self._tires.move_to_end(key)
        return self._tires[key]

    def _keep(self, run: str, held: Held) -> None:
        self._runs[run] = held
        self._runs.move_to_end(run)
        while len(self._runs) > _HELD:
            self._runs.popitem(last=False)

    def _save(self, run: str, held: Held) -> None:
        road = None if held.load is None else held.load.road
        save_results(to_tree(held.parts, case=held.case, road=road), self._folder / f"{run}.nc")

    def _held(self, run: str) -> Held:
        """A run, from memory or from its file. Raises InputError where it is not there."""
        if run not in self._runs:
            opened = open_results(self._folder / f"{run}.nc")
            case = opened.case
            self._keep(run, Held(case if isinstance(case, FilePart) else None, dict(opened.parts)))
        return self._runs[run]

    def _loaded(self, held: Held) -> Loaded:
        """The road of a run under its wheels. Raises InputError for a run without a case."""
        if held.load is None:
            if not isinstance(held.case, Case):
                raise InputError("this result holds no case of a wheel, so its road cannot be read anew")
            # The case in a file has lost the folder that its tire stands in.
            case = Case.from_dict(held.case.given(), folder=self._folder)
            contact = held.parts.get("contact")
            held.load = load_case(case, lambda text: None, contact=contact if isinstance(contact, Contact) else None)
        return held.load

    # Drawing.

    def _maps(self, say: Say, run: str, theme: str, view: dict[str, Any]) -> None:
        held = self._held(run)
        warnings = [text for part in held.parts.values() for text in part.warnings]
        say(drawing.maps(held.parts, theme=theme, **view), rows=rows_of(held.parts), done=True,
            warnings=list(dict.fromkeys(warnings)), choices=drawing.choices_of(held.parts),
            depths=drawing.depths_of(held.parts), run=run)  # fmt: skip

    def _cut(
        self, say: Say, run: str, theme: str, line: list[float] | None, over: str | None = None, name: str = ""
    ) -> None:
        held = self._held(run)
        overlaid = None if over is None else self._held(over).parts.get("contact")
        say(drawing.along(held.parts, held.block, line, theme=theme, name=name, over=overlaid), done=True,
            block=held.block is not None)  # fmt: skip

    def _section(self, say: Say, run: str) -> None:
        """Solve the block of road below a run that was opened from its file."""
        held = self._held(run)
        if held.block is None:
            load = self._loaded(held)
            faces = load.road.interfaces.tolist()
            bottom = load.case.response.slices_to(faces, rigid_base=load.road.rigid_base)
            held.block = load.solve(drawing.block_depths(bottom, faces, _BLOCK_DEPTHS))
        say(done=True)

    def _difference(self, say: Say, first: str, second: str, name: str, theme: str, width: float,
                    labels: list[str]) -> None:  # fmt: skip
        one, other = self._held(first), self._held(second)
        say(drawing.difference(one.parts, other.parts, name, theme=theme, width=width, labels=labels), done=True)

    def _tread(self, say: Say, run: str, theme: str) -> None:
        say(drawing.tread(self._held(run).parts, theme=theme), done=True)

    def _open(self, say: Say, run: str, file: str, kind: str) -> None:
        """Take an uploaded file as a run: a result, or a measured footprint."""
        path = self._folder / file
        if kind == "footprint":
            footprint = FootprintPart(file=file).read(self._folder)
            self._keep(run, Held(None, {"contact": footprint}))
            save_results(to_tree({"contact": footprint}), self._folder / f"{run}.nc")
        elif kind == "study":
            opened = open_results(path)
            about_study(_study_of(opened.parts))
            shutil.copyfile(path, self._folder / f"{run}.nc")
        else:
            opened = open_results(path)
            drawing.maps(dict(opened.parts), theme="light")
            shutil.copyfile(path, self._folder / f"{run}.nc")
        say(done=True)

    def _study(self, say: Say, run: str) -> None:
        say(**about_study(_study_of(self._held(run).parts)), done=True)

    def _point(self, say: Say, run: str, at: dict[str, int], reading: str, along: str, field: str, theme: str,
               width: float) -> None:  # fmt: skip
        study = _study_of(self._held(run).parts)
        say(point_of(study, at, reading, along, field, theme, width), rows=point_rows(study, at),
            warnings=list(study.warnings), done=True)  # fmt: skip

    # Taking home.

    def _export(self, say: Say, run: str, kind: str, view: dict[str, Any] | None = None) -> None:
        from treadload.app.takehome import write_export

        held = self._held(run)

        def whole() -> Any:
            if not isinstance(held.case, Case):
                return open_results(self._folder / f"{run}.nc")
            load = self._loaded(held)
            return read_loaded(load)

        say(done=True, file=write_export(held.parts, whole, kind, self._folder, run, view or {}))


def _study_of(parts: Mapping[str, BaseResult]) -> Sweep:
    """The study among the results of a file. Raises InputError."""
    found = next((part for part in parts.values() if isinstance(part, Sweep)), None)
    if found is None:
        raise InputError(f"this file holds {', '.join(parts)} and no study; results of one case open on the bench")
    return found


def warm() -> None:
    """Load what the first request would wait for."""
    case = Case.from_dict({**parse_toml(first_case("run"), "case"), "spacing": "24 mm"})
    contact = contact_of(case, case.pavement.build(), lambda text: None)
    drawing.maps({"contact": contact}, theme="light")["maps"].to_json()


def main() -> None:
    """Answer requests until there are no more."""
    # What libraries print must not mix with the answers.
    out = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())

    def write(line: str) -> None:
        try:
            out.write(line)
            out.flush()
        except BrokenPipeError:
            # The page has ended, and nobody is left to be told.
            os._exit(0)

    engine = Engine(write)
    warm()
    write('{"id": 0, "warm": true}\n')
    with contextlib.suppress(KeyboardInterrupt):
        for line in sys.stdin:
            engine.answer(json.loads(line))


if __name__ == "__main__":
    main()
