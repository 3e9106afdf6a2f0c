"""The process that solves and draws for one browser: a line of JSON in, lines of JSON out.

A case is solved in a thread, part by part, and each part is shown as soon as it is there; requests for figures are
answered meanwhile from what is held in memory. Results are NetCDF files in the folder of the browser, so that another
process goes on where this one was stopped. `python -m treadload.app.engine` starts it, with the most memory that it
may use, MB, where there is a limit.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
import shutil
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

from treadload.app import map_figures
from treadload.app.answers import SOLVES, View
from treadload.app.basin_points import about_basins, basin_figures, basin_rows, basins_of
from treadload.app.opened_files import check_opened
from treadload.app.pictures import picture_of, pictures_for, pictures_of, titles_of
from treadload.app.result_rows import allowed_rows, page_rows, rows_of, warnings_of
from treadload.app.stored_run import Stopped, StoredRun, StoredRuns
from treadload.app.study_points import about_study, point_of, point_rows, study_of
from treadload.app.study_solver import rank_sections, ranked_sections, solve_study
from treadload.app.unsolved import left_out
from treadload.app.verdict_card import card_of
from treadload.case import Case
from treadload.composing import BaseResult
from treadload.damage import Verdict
from treadload.damage.life import Life
from treadload.errors import TreadloadError
from treadload.files import parse_toml
from treadload.results import open_results, save_results, to_tree
from treadload.steps.allowed import passes_allowed
from treadload.steps.chain import result_of
from treadload.steps.chain import run as run_case
from treadload.steps.footprint import FootprintStep
from treadload.steps.loaded import contact_of
from treadload.steps.scene import Options, Progress, Scene, stream
from treadload.sweeps.network import Network
from treadload.templates import first_case
from treadload.us_units import display_units

# Depths of the block of road below the maps, from which slices along any line are cut.
_BLOCK_DEPTHS = 12
# Progress is told so often at most, s.
_SELDOM = 0.2

Say = Callable[..., None]


class Engine:
    """What one process holds. memory: the most that it may use, MB; 0 without a limit. units: of what it shows."""

    def __init__(self, write: Callable[[str], None], memory: int = 0, units: str = "si") -> None:
        self._write, self._lock, self._memory, self._units = write, threading.Lock(), memory, units
        self.runs = StoredRuns()
        self._stop = threading.Event()
        self._solving: threading.Thread | None = None

    def answer(self, request: dict[str, object]) -> None:
        """Do what a request asks for; whatever is wrong goes back as a sentence."""
        do = str(request.pop("do"))
        say = self._say_of(request.pop("id"))
        if do == "stop":
            self._stop.set()
            return
        if do in SOLVES:
            self._wait()
            self._stop.clear()
            many: dict[str, Callable[..., None]] = {"sweep": self._sweep, "network": self._network}
            solves = many.get(do, self._solve if do == "run" else self._life)
            self._solving = threading.Thread(target=self._guarded, args=(say, solves, request), daemon=True)
            self._solving.start()
            return
        answers: dict[str, Callable[..., None]] = {
            "folder": self._take_folder, "maps": self._maps, "cut": self._cut, "difference": self._difference,
            "tread": self._tread, "export": self._export, "section": self._section, "open": self._open,
            "study": self._study, "point": self._point, "shares": self._shares, "pictures": self._pictures,
            "gallery": self._gallery, "picture": self._picture, "basins": self._basins, "basin": self._basin,
            "ranked": self._ranked,
        }  # fmt: skip
        self._guarded(say, answers[do], request)

    def _wait(self) -> None:
        if self._solving is not None:
            self._stop.set()
            self._solving.join()

    def _say_of(self, number: object) -> Say:
        def say(figures: dict[str, object] | None = None, **answer: object) -> None:
            # Figures are JSON already, which the browser alone reads.
            if figures:
                answer["figures"] = {name: map_figures.as_text(figure) for name, figure in figures.items()}
            whole = json.dumps({"id": number, **answer}, default=float)
            with self._lock:
                self._write(f"{whole}\n")

        return say

    def _guarded(self, say: Say, do: Callable[..., None], request: dict[str, object]) -> None:
        try:
            # A thread starts without the units of the one that started it.
            with display_units(self._units):
                do(say, **request)
        except Stopped:
            say(stopped=True)
        except TreadloadError as error:
            say(error=str(error))
        except MemoryError:
            most = f"the {self._memory} MB that this server allows a case" if self._memory else "this machine"
            say(error=f"out of memory: the grid is too fine for {most}; use larger cells")
        except Exception as error:
            print(f"treadload app: {type(error).__name__}: {error}", file=sys.stderr)
            say(error=f"the program failed: {type(error).__name__}: {error}")

    def _take_folder(self, say: Say, folder: str) -> None:
        self.runs.folder = Path(folder)
        say(done=True)

    # Solving.

    def _solve(self, say: Say, run: str, table: dict[str, object], theme: str, view: View) -> None:
        began = time.monotonic()
        used = time.process_time()
        case = Case.from_dict(table, folder=self.runs.folder, name="case")
        stored = StoredRun(case)

        def tell(text: str) -> None:
            if self._stop.is_set():
                raise Stopped
            say(stage=text, seconds=time.monotonic() - began)

        def shown(stage: str) -> None:
            self.runs.keep(run, stored)
            drawn = (
                map_figures.places(stored.parts, theme=theme)
                if stage == "damage" and not map_figures.shows_damage(**view)
                else map_figures.maps(stored.parts, theme=theme, **view)
            )
            if stage == "contact":
                drawn |= map_figures.along(stored.parts, None, view.get("line"), theme=theme, with_source=False)
            say(drawn, part=stage, rows=rows_of(stored.parts),
                warnings=warnings_of(*stored.parts.values()), choices=map_figures.choices_of(stored.parts),
                depths=map_figures.depths_of(stored.parts), card=card_of(stored.parts),
                seconds=time.monotonic() - began, process=time.process_time() - used)  # fmt: skip

        tell("reading the case")
        # A body that dents its road is refused when its road is asked for.
        touch = contact_of if case.tire is None else functools.partial(contact_of, tire=self.runs.tire(case, tell))
        scene = Scene(case, Progress(tell), Options(leave_out=left_out(case), touch=touch))
        stored.load = scene.loaded
        for name, part in stream(scene):
            stored.parts[name] = part
            shown(name)
        say(ready=True, seconds=time.monotonic() - began, process=time.process_time() - used)
        # The page is at work again; what follows makes slices along any line quick, and the run outlast this process.
        self.runs.save(run, stored)
        tell("slices through the road")
        bottom = case.response.slices_to(stored.load.road.interfaces.tolist(), rigid_base=stored.load.road.rigid_base)
        stored.block = stored.load.solve(
            map_figures.block_depths(bottom, stored.load.road.interfaces.tolist(), _BLOCK_DEPTHS)
        )
        tell("passes by criterion")
        say(done=True, seconds=time.monotonic() - began, **self._allowed(stored))

    def _life(self, say: Say, run: str, table: dict[str, object], theme: str) -> None:
        began, used, last_sent = time.monotonic(), time.process_time(), 0.0
        case = Case.from_dict(table, folder=self.runs.folder, name="case")
        stored = StoredRun(case)

        def tell(done: int, total: int, what: str) -> None:
            nonlocal last_sent
            if self._stop.is_set():
                raise Stopped
            now = time.monotonic()
            if now - last_sent > _SELDOM or done == total:
                last_sent = now
                say(stage=f"{what} {done} of {total}", seconds=now - began)

        def shown(name: str, part: BaseResult) -> None:
            stored.parts[name] = part
            self.runs.keep(run, stored)
            say(part=name, pictures=pictures_of(name, stored.parts), **self._details(stored),
                seconds=time.monotonic() - began, process=time.process_time() - used)  # fmt: skip

        say(stage="reading the case", seconds=0.0)
        result = run_case(case, progress=Progress(count=tell), shown=shown)
        self.runs.keep(run, stored)
        save_results(result.to_tree(), self.runs.folder / f"{run}.nc")
        say(ready=True, seconds=time.monotonic() - began, process=time.process_time() - used)
        say(done=True)

    def _sweep(self, say: Say, run: str, table: dict[str, object], varied: list[str]) -> None:
        counts = self._counts(say, "case")
        solve_study(table, varied, self.runs.folder, self.runs.folder / f"{run}.nc", counts)
        say(done=True)

    def _network(self, say: Say, run: str, table: dict[str, object], file: str, shown: str) -> None:
        folder, counts = self.runs.folder, self._counts(say, "section")
        network = rank_sections(table, folder / file, shown, folder, folder / f"{run}.nc", counts)
        self.runs.keep(run, StoredRun(None, {"network": network}))
        say(done=True)

    def _counts(self, say: Say, what: str) -> Callable[[int, int, str], None]:
        """Progress of many cases, which ends where the user does not want the rest."""
        began = time.monotonic()
        say(stage=f"reading what differs from {what} to {what}", seconds=0.0)

        def tell(done: int, total: int, _: str) -> None:
            if self._stop.is_set():
                raise Stopped
            say(stage=f"{what} {done} of {total}", seconds=time.monotonic() - began)

        return tell

    def _ranked(self, say: Say, run: str) -> None:
        network = self.runs.run_of(run).parts["network"]
        assert isinstance(network, Network)
        say(sections=ranked_sections(network), rows=page_rows(network.rows(), "Network"),
            warnings=warnings_of(network), done=True)  # fmt: skip

    def _details(self, stored: StoredRun, criterion: str = "") -> dict[str, object]:
        """Rows, warnings and criteria of a life."""
        names = [str(name) for name in stored.parts["life"].dataset["criterion"].to_numpy()]
        return {
            "rows": rows_of(stored.parts, criterion),
            "warnings": warnings_of(*stored.parts.values()),
            "criteria": names,
            "card": card_of(stored.parts),
        }

    def _shares(self, say: Say, run: str, criterion: str) -> None:
        stored = self.runs.run_of(run)
        life = stored.parts["life"]
        assert isinstance(life, Life)
        details = self._details(stored, criterion)
        drawn = pictures_for("life", stored.parts, criterion or life.governing_criterion)
        say(pictures=drawn, **details, done=True)

    def _pictures(self, say: Say, run: str) -> None:
        stored = self.runs.run_of(run)
        drawn = {key: picture for name in stored.parts for key, picture in pictures_of(name, stored.parts).items()}
        say(pictures=drawn, **self._details(stored), done=True)

    def _gallery(self, say: Say, run: str) -> None:
        say(titles=titles_of(self.runs.run_of(run).parts), done=True)

    def _picture(self, say: Say, run: str, key: str) -> None:
        say(picture=picture_of(key, self.runs.run_of(run).parts), done=True)

    # Drawing.

    def _maps(self, say: Say, run: str, theme: str, view: View) -> None:
        stored = self.runs.run_of(run)
        say(map_figures.maps(stored.parts, theme=theme, **view), rows=rows_of(stored.parts), done=True,
            warnings=warnings_of(*stored.parts.values()), choices=map_figures.choices_of(stored.parts),
            depths=map_figures.depths_of(stored.parts), card=card_of(stored.parts), run=run)  # fmt: skip

    def _cut(
        self, say: Say, run: str, theme: str, line: list[float] | None, over: str | None = None, name: str = ""
    ) -> None:
        stored = self.runs.run_of(run)
        overlaid = None if over is None else self.runs.run_of(over).parts.get("contact")
        # Where this process goes on with the run of one that gave way, or was stopped before it came to the road
        # below, that is solved on request.
        is_solving = self._solving is not None and self._solving.is_alive()
        say(map_figures.along(stored.parts, stored.block, line, theme=theme, name=name, over=overlaid), done=True,
            lacks_section=stored.block is None and not is_solving)  # fmt: skip

    def _section(self, say: Say, run: str) -> None:
        """Solve the block of road below a run that was opened from its file."""
        stored = self.runs.run_of(run)
        if stored.block is None:
            load = self.runs.loaded(stored)
            faces = load.road.interfaces.tolist()
            bottom = load.case.response.slices_to(faces, rigid_base=load.road.rigid_base)
            stored.block = load.solve(map_figures.block_depths(bottom, faces, _BLOCK_DEPTHS))
        say(done=True, **self._allowed(stored))

    def _allowed(self, stored: StoredRun) -> dict[str, object]:
        """Load repetitions by criterion below a run, and the card that states which of them governs."""
        verdict = stored.parts.get("damage")
        allowed = passes_allowed(self.runs.loaded(stored), verdict if isinstance(verdict, Verdict) else None)
        return {
            "allowed": {"rows": allowed_rows(allowed), "notes": list(allowed.without)},
            "card": card_of(stored.parts, allowed),
        }

    def _difference(self, say: Say, first: str, second: str, name: str, theme: str, width: float,
                    labels: list[str]) -> None:  # fmt: skip
        left, right = self.runs.run_of(first), self.runs.run_of(second)
        say(map_figures.difference(left.parts, right.parts, name, theme=theme, width=width, labels=labels), done=True)

    def _tread(self, say: Say, run: str, theme: str) -> None:
        say(map_figures.tread(self.runs.run_of(run).parts, theme=theme), done=True)

    def _open(self, say: Say, run: str, file: str, kind: str) -> None:
        """Take an uploaded file as a run: a result, or a measured footprint."""
        path = self.runs.folder / file
        if kind == "footprint":
            parts: dict[str, BaseResult] = {FootprintStep.makes[0]: FootprintStep(file=file).read(self.runs.folder)}
            self.runs.keep(run, StoredRun(None, parts))
            save_results(to_tree(parts), self.runs.folder / f"{run}.nc")
        else:
            check_opened(kind, open_results(path).parts)
            shutil.copyfile(path, self.runs.folder / f"{run}.nc")
        say(done=True)

    def _study(self, say: Say, run: str) -> None:
        say(**about_study(study_of(self.runs.run_of(run).parts)), done=True)

    def _point(self, say: Say, run: str, at: dict[str, int], reading: str, along: str, field: str, theme: str,
               width: float) -> None:  # fmt: skip
        study = study_of(self.runs.run_of(run).parts)
        say(point_of(study, at, reading, along, field, theme, width), rows=point_rows(study, at),
            warnings=warnings_of(study), done=True)  # fmt: skip

    def _basins(self, say: Say, run: str) -> None:
        say(**about_basins(basins_of(self.runs.run_of(run).parts)), done=True)

    def _basin(self, say: Say, run: str, drop: int, theme: str) -> None:
        result = basins_of(self.runs.run_of(run).parts)
        say(
            basin_figures(result, drop, theme),
            rows=basin_rows(result, drop),
            warnings=warnings_of(result),
            done=True,
        )

    # Taking home.

    def _export(self, say: Say, run: str, kind: str) -> None:
        from treadload.app.export_files import write_export

        stored = self.runs.run_of(run)

        def whole() -> object:
            if stored.case is None or stored.case.command == "life":
                return open_results(self.runs.folder / f"{run}.nc")
            load = self.runs.loaded(stored)
            scene = Scene(load.case, options=Options(contact=load.contact))
            for _ in stream(scene):
                pass
            return result_of(scene)

        say(done=True, file=write_export(stored.parts, whole, kind, self.runs.folder, run))


def warm() -> None:
    """Load what the first request would wait for."""
    case = Case.from_dict({**parse_toml(first_case("run"), "case"), "spacing": "16 mm"})
    contact = contact_of(case, case.road(), lambda text: None)
    map_figures.maps({case.source.makes[0]: contact}, theme="light")["maps"].to_json()


def _limit(memory: int) -> None:
    """Let allocations beyond so many MB fail with MemoryError. Linux counts data, not files that are mapped."""
    import resource

    resource.setrlimit(resource.RLIMIT_DATA, (memory * 10**6, resource.RLIM_INFINITY))


def main() -> None:
    """Answer requests until there are no more."""
    memory = int(sys.argv[1]) if len(sys.argv) > 1 else 0
    if memory:
        _limit(memory)
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

    engine = Engine(write, memory, os.environ.get("TREADLOAD_UNITS", "si"))
    warm()
    write('{"id": 0, "warm": true}\n')
    with contextlib.suppress(KeyboardInterrupt):
        for line in sys.stdin:
            engine.answer(json.loads(line))
    # What is being solved is for nobody, and threads that write could hold the end of Python up.
    os._exit(0)


if __name__ == "__main__":
    main()
