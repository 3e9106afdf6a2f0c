"""The bench: the form at the left, linked maps in the middle, the verdict at the right, runs and slices below."""

from __future__ import annotations

import asyncio
import contextlib
import html
import itertools
import json
from pathlib import Path
from typing import Any

from nicegui import background_tasks, ui

from treadload.app.engines import EngineLost
from treadload.app.form import Form
from treadload.app.left import Left, plain
from treadload.app.right import Right
from treadload.app.session import Run, Session
from treadload.case import Case
from treadload.plots.interactive import link_script
from treadload.plots.interactive.view import CONFIG
from treadload.study.as_python import case_as_python

LOOK = Path(__file__).parent / "look"
# Of a line as plotly holds it.
_ENDS = ("x0", "y0", "x1", "y1")
_NOWHERE = {"visible": False}
_EMPTY: dict[str, Any] = {
    "data": [],
    "layout": {"height": 300, "margin": {"l": 0, "r": 0, "t": 0, "b": 0}, "xaxis": _NOWHERE, "yaxis": _NOWHERE,
               "paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)"},
}  # fmt: skip
_SECTIONS = {
    "principal_strain_1": "largest extension, in space", "in_plane_strain_1": "largest extension, in the plane",
    "strain_zz": "vertical strain", "von_mises_stress": "von Mises stress", "mean_stress": "mean stress",
    "stress_zz": "vertical stress",
}  # fmt: skip


def build(session: Session) -> None:
    """Put the bench of a session on the page of one of its tabs."""
    ui.add_head_html('<link rel="stylesheet" href="/look/bench.css">')
    ui.add_body_html(f"<script>{link_script()}</script><script type='module' src='/look/bench.js'></script>")
    bench = Bench(session)
    bench.build()
    background_tasks.create(bench.begin())


class Bench:
    """One tab. It draws what the process of its session sends."""

    def __init__(self, session: Session) -> None:
        self._session, self._client = session, ui.context.client
        self._theme, self._width = "light", 1100.0
        self._view: dict[str, Any] = {"left": "contact/pressure", "right": "response/principal_strain_1", "depth": 0}
        self._line: list[float] | None = None
        self._along = "x"
        self._section_of = "principal_strain_1"
        self._now: Run | None = None
        self._over: str | None = None
        self._pair: dict[str, Run] = {}
        self._comparing = False
        self._stamps = itertools.count(1)
        self._solving: asyncio.Task[None] | None = None
        self._depths: list[float] = []
        self._solves = 0

    # The page.

    def build(self) -> None:
        """Put everything on the page."""
        self._dark = ui.dark_mode(value=None)
        with ui.element("header").classes("bar"):
            ui.element("h1").props('innerHTML="treadload, the bench"')
            self._stage = ui.label("starting").classes("stage").props('role="status" aria-live="polite" id="stage"')
            self._cancel = plain("Cancel", self.cancel).props('id="cancel" disabled')
            plain("Solve", lambda: self.solve(self._session.form), main=True).props('id="solve"')
            plain("Light or dark", self._other_theme).props('id="theme"')
        self._root = ui.element("div").classes("bench").props('id="bench" data-state="starting" data-ready="0"')
        with self._root:
            with ui.element("nav").classes("left").props('aria-label="the case"'):
                self._left = Left(self._session, self.solve, self.opened)
                self._left.build()
            with ui.element("section").classes("centre").props('aria-label="maps and slices"'):
                self._centre()
            with ui.element("aside").classes("right").props('aria-label="the verdict"'):
                self._right = Right(self.fly, self.take_home)
                self._right.build()

    def _centre(self) -> None:
        with ui.element("div").classes("tools"):
            self._maps_of = {
                side: ui.select({self._view[side]: "…"}, value=self._view[side], label=f"{side} map",
                                on_change=lambda event, side=side: self._look(**{side: event.value}))
                .props(f'dense outlined options-dense data-map="{side}"') for side in ("left", "right")
            }  # fmt: skip
            self._depth = ui.select({0: "surface"}, value=0, label="depth of maps",
                                    on_change=lambda event: self._look(depth=event.value))  # fmt: skip
            self._depth.props('dense outlined options-dense data-map="depth"').style("max-width:150px")
            plain("whole contact", self._whole)
            plain("SVG", lambda: self._js("treadloadPicture('svg')"), label="take the maps home as SVG")
            plain("PNG", lambda: self._js("treadloadPicture('png')"), label="take the maps home as PNG")
        self._maps = self._plot(_EMPTY).classes("maps").props('role="img" aria-label="two linked maps of the result"')
        self._maps.on("plotly_relayout", lambda event: self._dragged(event.args or {}))
        with ui.element("div").classes("tools").props('role="group" aria-label="slice"'):
            ui.label("Slice: drag the line on the left map, or put it")
            plain("along travel", lambda: self._put("x")).props('id="along"')
            plain("across", lambda: self._put("y")).props('id="across"')
            self._at = ui.slider(min=-150, max=150, value=0, step=1, on_change=lambda event: self._moved(event.value))
            self._at.props('label aria-label="place of the slice, mm" id="place"').style("width:170px;flex:none")
            self._place = ui.label("0 mm").classes("place")
            section = ui.select(_SECTIONS, value=self._section_of, label="below the line",
                                on_change=lambda event: self._below(event.value))  # fmt: skip
            section.props("dense outlined options-dense")
        self._profile = self._plot(_EMPTY).classes("profile")
        self._profile.props('role="img" aria-label="profiles along the slice"')
        self._section = self._plot(_EMPTY).classes("section")
        self._section.props('role="img" aria-label="section of the road below the slice"')
        with ui.element("div").classes("tools"):
            ui.element("h2").props('innerHTML="Runs"').style("margin:8px 0")
            self._compare = plain("Compare A with B", self.compare).props('id="compare" disabled')
            plain("Tread in space", self._show_tread).props('id="tread"')
        self._runs = ui.element("div").classes("runs").props('id="runs" role="list" aria-label="runs"')
        self._space = ui.element("div").props('id="space"')

    def _plot(self, figure: dict[str, Any]) -> Any:
        return ui.plotly({**figure, "config": CONFIG})

    # What the browser is and wants.

    async def begin(self) -> None:
        """Wait for the browser, and show where its session stands."""
        with contextlib.suppress(Exception):
            await self._client.connected(timeout=60)
        with self._client:
            about = None
            with contextlib.suppress(TimeoutError):
                about = await ui.run_javascript(
                    "({width: document.querySelector('.centre').clientWidth - 26, "
                    "dark: matchMedia('(prefers-color-scheme: dark)').matches})", timeout=10,
                )  # fmt: skip
            if about:
                self._width = max(560.0, float(about["width"]))
                self._theme = "dark" if about["dark"] else "light"
                self._dark.value = bool(about["dark"])
            self._list_runs()
            await self._drop_stale()
            self.solve(self._session.form)

    async def _drop_stale(self) -> None:
        """A page that is loaded again leaves what it had begun."""
        await self._session.stop()

    def _other_theme(self) -> None:
        self._theme = "light" if self._theme == "dark" else "dark"
        self._dark.value = self._theme == "dark"
        self._space.clear()
        self._redraw()

    def _look(self, **view: Any) -> None:
        if all(self._view.get(key) == value for key, value in view.items()):
            return
        self._view.update(view)
        self._comparing = False
        self._redraw()

    def _whole(self) -> None:
        self._js("treadloadWhole()")

    def _js(self, code: str) -> None:
        with self._client:
            ui.run_javascript(code)

    def fly(self, x: float, y: float) -> None:
        """Show the maps around a place, m."""
        self._js(f"treadloadFly({x * 1e3:.3f}, {y * 1e3:.3f})")

    # Solving.

    def solve(self, form: Form) -> None:
        """Solve a form in the process of the session; what was being solved is left."""
        checked = form.check(self._session.folder)
        if checked.case is None:
            self._left.tell()
            return
        if self._solving is not None:
            self._solving.cancel()
        self._solving = background_tasks.create(self._solve(form))

    async def _solve(self, form: Form) -> None:
        with self._client:
            run = self._session.new_run(form, self._title(form))
            self._comparing = False
            self._state("solving")
            self._cancel.props(remove="disabled")
            self._stage.text = "waiting for the process that solves"
            try:
                await self._session.stop()
                view = {**self._view, "width": self._width, "line": self._line}
                asked = self._session.ask("solve", run=run.name, table=dict(form.table), theme=self._theme, view=view)
                async for answer in asked:
                    self._hear(run, answer)
            except EngineLost as error:
                # The process is ended where it does not stop of itself.
                self._failed(run, "cancelled" if self._solving is None else str(error))
            except asyncio.CancelledError:
                if not run.ready:
                    self._session.runs.pop(run.name, None)
                raise
            self._cancel.props("disabled")

    def _hear(self, run: Run, answer: dict[str, Any]) -> None:
        """Show what the process says of a run."""
        if "stage" in answer:
            self._stage.text = f"{answer['seconds']:.1f} s  {answer['stage']}"
        if "maps" in answer:
            run.rows, run.warnings = answer["rows"], answer["warnings"]
            self._now = run
            self._draw(answer)
            self._state("drawn", part=answer["part"], **{f"drawn-{answer['part']}": f"{answer['process']:.3f}"})
        if "ready" in answer:
            run.ready = True
            self._solves += 1
            self._right.show(run.rows, run.warnings, run.name, done=True)
            self._state("ready", ready=str(self._solves), seconds=f"{answer['seconds']:.3f}",
                        process=f"{answer['process']:.3f}", run=run.name)  # fmt: skip
            self._stage.text = f"solved in {answer['seconds']:.1f} s; slices follow"
            self._list_runs()
            background_tasks.create(self._thumb(run))
        if "done" in answer:
            self._stage.text = "solved"
            self._state("done")
            background_tasks.create(self._cut())
        if "error" in answer:
            self._failed(run, answer["error"])
        if "stopped" in answer and not run.ready:
            self._failed(run, "cancelled")

    def _failed(self, run: Run, why: str) -> None:
        if not run.ready:
            self._session.runs.pop(run.name, None)
            self._state("cancelled" if why == "cancelled" else "failed")
            self._stage.text = why if why == "cancelled" else "not solved"
            if why != "cancelled":
                self._left.say(why.removeprefix("case: "))
        self._cancel.props("disabled")

    async def cancel(self) -> None:
        """Leave what is being solved, or waits to be."""
        solving, self._solving = self._solving, None
        if solving is None or solving.done():
            return
        self._stage.text = "cancelling"
        await self._session.stop()
        solving.cancel()
        await asyncio.wait([solving])
        self._stage.text = "cancelled"
        self._cancel.props("disabled")
        # A run that was ready before its slices were cut stays; so does what another click began meanwhile.
        if self._solving is None and self._root.props.get("data-state") in ("solving", "drawn", "failed"):
            self._state("cancelled")

    def _title(self, form: Form) -> str:
        load, state = form.value("rolling.normal_load"), form.state
        return f"{load}, {state}" if load is not None else str(form.value("title") or "a case")

    def _state(self, state: str, **more: str) -> None:
        self._root.props["data-state"] = state
        for key, value in more.items():
            self._root.props[f"data-{key}"] = value
        self._root.update()

    # Drawing.

    def _draw(self, answer: dict[str, Any]) -> None:
        for name, plot in (("maps", self._maps), ("profile", self._profile), ("section", self._section)):
            if name in answer:
                figure = answer[name]
                figure["layout"]["meta"] = {"stamp": f"{next(self._stamps)}"}
                plot.update_figure({**figure, "config": CONFIG})
        if "choices" in answer:
            self._offer(answer["choices"], answer["depths"])
        if self._now is not None and "rows" in answer:
            self._right.show(self._now.rows, self._now.warnings, self._now.name, done=self._now.ready)

    def _offer(self, choices: dict[str, str], depths: list[float]) -> None:
        """Fill the lists of maps without asking for what they show already."""
        for side, select in self._maps_of.items():
            wanted = self._view[side]
            options = choices if wanted in choices else {**choices, wanted: "follows when it is solved"}
            if select.options != options:
                select.set_options(options, value=wanted)
        if depths and depths != self._depths:
            self._depths = depths
            named = {number: f"{depth * 1e3:g} mm" for number, depth in enumerate(depths)}
            self._view["depth"] = min(self._view["depth"], len(depths) - 1)
            self._depth.set_options(named, value=self._view["depth"])

    def _redraw(self) -> None:
        if self._comparing:
            background_tasks.create(self._draw_pair())
        elif self._now is not None:
            background_tasks.create(self._draw_run(self._now))

    async def _draw_run(self, run: Run) -> None:
        view = {**self._view, "width": self._width, "line": self._line}
        await self._shown("maps", run=run.name, theme=self._theme, view=view)
        await self._cut()

    async def _shown(self, do: str, **asked: Any) -> dict[str, Any]:
        """Ask for figures and draw them; what is wrong is said."""
        with self._client:
            try:
                answer = await self._session.last(do, **asked)
            except EngineLost as error:
                answer = {"error": str(error)}
            if "error" in answer:
                self._left.say(answer["error"])
            else:
                self._draw(answer)
            return answer

    # The slice.

    def _dragged(self, change: dict[str, Any]) -> None:
        """The line was dragged on the first map."""
        moved = {key.rpartition(".")[2]: value for key, value in change.items() if key.startswith("shapes[0].")}
        if not moved or self._now is None:
            return
        shapes = self._maps.figure["layout"].get("shapes") or [{}]
        with contextlib.suppress(TypeError, ValueError):
            ends = {key: float(moved.get(key, shapes[0].get(key, 0.0))) for key in _ENDS}
            self._line = [one / 1e3 for one in ends.values()]
            shapes[0].update(ends)
            background_tasks.create(self._cut())

    def _put(self, along: str) -> None:
        self._along = along
        self._moved(self._at.value)

    def _moved(self, place: float) -> None:
        """The line is put along travel or across it, at a place in mm."""
        half, at = 0.16, float(place) / 1e3
        self._place.text = f"{float(place):g} mm"
        self._line = [-half, at, half, at] if self._along == "x" else [at, -half, at, half]
        ends = {key: 1e3 * one for key, one in zip(_ENDS, self._line, strict=True)}
        shapes = self._maps.figure["layout"].get("shapes") or []
        told = {f"shapes[{number}].{key}": value for number in range(len(shapes)) for key, value in ends.items()}
        for shape in shapes:
            shape.update(ends)
        self._js(f"Plotly.relayout(document.querySelector('.maps'), {json.dumps(told)})")
        background_tasks.create(self._cut())

    def _below(self, name: str) -> None:
        self._section_of = name
        background_tasks.create(self._cut())

    async def _cut(self) -> None:
        if self._now is not None and self._now.name in self._session.runs:
            await self._shown("cut", run=self._now.name, theme=self._theme, line=self._line, name=self._section_of,
                              over=self._over)  # fmt: skip

    async def _show_tread(self) -> None:
        """Show the tread in space, or put it away."""
        if self._space.default_slot.children:
            self._space.clear()
            return
        if self._now is None:
            return
        with self._client:
            answer = await self._session.last("tread", run=self._now.name, theme=self._theme)
            if "error" in answer:
                self._left.say(answer["error"])
                return
            with self._space:
                self._plot(answer["tread"]).classes("tread").props('role="img" aria-label="the tread in space"')

    # Runs.

    def _list_runs(self) -> None:
        self._runs.clear()
        with self._runs:
            for run in reversed([one for one in self._session.runs.values() if one.ready]):
                self._card(run)
        if len(self._pair) == 2:
            self._compare.props(remove="disabled")
        else:
            self._compare.props("disabled")

    def _card(self, run: Run) -> None:
        now = self._now is not None and run.name == self._now.name
        with ui.element("div").classes("run now" if now else "run").props('role="listitem"'):
            if run.thumb:
                ui.element("img").props(f'src="{run.thumb}" alt="pressure of this run"')
            with ui.element("div").classes("say"):
                ui.html(f"<b>{html.escape(run.title)}</b>{html.escape(_first(run.rows))}", sanitize=False)
            with ui.element("div").classes("line"):
                plain("show", lambda: self._show(run), label=f"show the run {run.title}")
                for side in ("A", "B"):
                    chosen = self._pair.get(side) is run
                    button = plain(
                        side, lambda side=side: self._choose(side, run), label=f"take as {side} for a comparison"
                    )
                    button.classes("chosen" if chosen else "")

    def _show(self, run: Run) -> None:
        self._now, self._comparing = run, False
        if run.form is not None:
            self._left.take(run.form)
        self._list_runs()
        background_tasks.create(self._draw_run(run))

    def _choose(self, side: str, run: Run) -> None:
        self._pair[side] = run
        self._list_runs()

    def compare(self) -> None:
        """Show the two chosen runs and their difference."""
        if len(self._pair) == 2:
            self._comparing = True
            background_tasks.create(self._draw_pair())

    async def _draw_pair(self) -> None:
        first, second = self._pair["A"], self._pair["B"]
        await self._shown("difference", first=first.name, second=second.name, name=self._view["left"],
                          theme=self._theme, width=self._width, labels=["A", "B"])  # fmt: skip
        self._state("compared")

    async def _thumb(self, run: Run) -> None:
        with self._client:
            await asyncio.sleep(0.3)
            picture = None
            with contextlib.suppress(TimeoutError):
                picture = await ui.run_javascript("treadloadThumb()", timeout=10)
            if isinstance(picture, str) and picture.startswith("data:image/png;base64,") and len(picture) < 200_000:
                run.thumb = picture if picture.replace('"', "") == picture else ""
                self._list_runs()

    # Files.

    async def opened(self, kind: str, kept: str) -> None:
        """Show a result that was uploaded, or lay a measured footprint over the contact."""
        run = self._session.new_run(None, self._session.known_as(kept))
        with self._client:
            answer = await self._session.last("open", run=run.name, file=kept, kind=kind)
            if "error" in answer:
                self._session.runs.pop(run.name, None)
                self._left.say(answer["error"])
                return
            run.ready = True
            if kind == "footprint":
                self._over = run.name
                self._list_runs()
                await self._cut()
                return
            self._now, self._depths = run, []
            answer = await self._shown(
                "maps", run=run.name, theme=self._theme, view={**self._view, "width": self._width}
            )
            run.rows, run.warnings = answer.get("rows", []), answer.get("warnings", [])
            self._right.show(run.rows, run.warnings, run.name, done=True)
            self._list_runs()

    def take_home(self, kind: str) -> None:
        """Give the case as TOML or Python."""
        form = self._now.form if self._now is not None and self._now.form is not None else self._session.form
        toml = self._session.to_toml(form)
        with self._client:
            if kind == "toml":
                ui.download.content(toml, "case.toml", "application/toml")
            else:
                program = case_as_python(Case.from_text(toml))
                self._right.program(program)
                ui.run_javascript(f"treadloadCopy({json.dumps(program)})")


def _first(rows: list[dict[str, Any]]) -> str:
    told = {row["key"]: row["value"] for row in rows}
    return ", ".join(told[key] for key in ("peak", "extension", "passes") if key in told)
