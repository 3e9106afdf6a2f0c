"""The page of a study: a slider for each dimension, the response along one of them, the map of a field."""

from __future__ import annotations

from typing import Any, ClassVar

from nicegui import background_tasks, ui

from treadload.app.elements import heading, with_attributes
from treadload.app.fielding import Uploads
from treadload.app.figures import Place
from treadload.app.right import Right
from treadload.app.session import STUDIES, Run, Session
from treadload.app.tab import Tab


class StudyPage(Tab):
    """A study that was uploaded, at the point where its sliders stand."""

    address: ClassVar[str] = "/study"
    room: ClassVar[str] = "study"
    solves: ClassVar[bool] = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._at: dict[str, int] = {}
        self._about: dict[str, Any] = {}
        self._asked = {"reading": "", "along": "", "field": ""}
        self._drawing = self._again = False
        self._moves = 0

    def inside(self) -> None:
        """The sliders, the figures, what was solved."""
        with ui.element("section").classes("left").props('aria-label="the study"'):
            self.left = Uploads(self.session)
            self.left.build()
            heading("Study").style("margin-top:4px")
            with ui.element("div").classes("line"):
                self.left.upload("open a study …", STUDIES, self._opened, "study")
            self._name = ui.label("").classes("note")
            self._sliders = ui.element("div").props('id="sliders"')
            self._summary = ui.element("div")
        with ui.element("section").classes("centre").props('aria-label="figures of the study"'):
            self._hint = ui.label(
                "Open what a study gave, as one file: tl.save_results(tl.sweep(…), 'study.nc'). Fields that it "
                "kept are drawn as maps."
            )
            self._hint.classes("note")
            self._tools = ui.element("div").classes("tools")
            self._places = {
                "curve": Place("curve", "the result along one input of the study"),
                "field": Place("field", "map of a field at this point of the study"),
            }
        with ui.element("section").classes("right").props('aria-label="the point"'):
            self.right = Right(lambda row: None, lambda kind: None, home={"csv": "tables, CSV", "html": "report"})
            self.right.build()

    async def started(self) -> None:
        """A study that was opened before is shown."""
        self.stage.text = "waiting for a study"
        self.state("idle")
        held = [run for run in self.session.runs.values() if run.room == self.room and run.ready]
        if held:
            await self._show(held[-1])

    async def _opened(self, kept: str) -> None:
        run = self.session.new_run(None, self.session.known_as(kept), self.room)
        answer = await self.last("open", run=run.name, file=kept, kind="study")
        if "error" in answer:
            self.session.runs.pop(run.name, None)
            return
        run.ready = True
        await self._show(run)

    async def _show(self, run: Run) -> None:
        answer = await self.last("study", run=run.name)
        if "error" in answer:
            return
        with self.client:
            self.now, self._about = run, answer
            self._name.text = run.title
            self._hint.set_visibility(False)
            self._at = {one["name"]: 0 for one in answer["dims"]}
            first = max(answer["dims"], key=lambda one: len(one["values"]))["name"]
            preferred = [name for name in ("largest_pressure", "largest_extension") if name in answer["readings"]]
            self._asked = {"reading": next(iter(preferred), next(iter(answer["readings"]))), "along": first,
                           "field": next(iter(answer["fields"]), "")}  # fmt: skip
            self._controls()
            self.stage.text = f"{run.title} is open"
        await self._draw()

    def _controls(self) -> None:
        """A slider for each dimension, and what is drawn."""
        self._sliders.clear()
        with self._sliders:
            for one in self._about["dims"]:
                with ui.element("div").classes("slide"):
                    with ui.element("div").classes("head"):
                        ui.label(one["words"])
                        said = with_attributes(ui.label(one["values"][0]), data_at=one["name"])
                    slider = ui.slider(min=0, max=max(1, len(one["values"]) - 1), step=1, value=0)
                    with_attributes(slider, aria_label=one["words"], data_dim=one["name"]).props("snap markers")
                    if len(one["values"]) < 2:
                        slider.disable()
                    slider.on_value_change(lambda event, one=one, said=said: self._moved(one, said, int(event.value)))
        self._summary.clear()
        with self._summary:
            heading("Summary")
            # Warnings stand at the right.
            for line in self._about["summary"].splitlines():
                if not line.startswith("warning: "):
                    ui.label(line).classes("note")
        self._tools.clear()
        with self._tools:
            for key, words, options in (
                ("reading", "result", self._about["readings"]),
                ("along", "along", {one["name"]: one["words"] for one in self._about["dims"]}),
                ("field", "map", self._about["fields"]),
            ):
                if options:
                    select = ui.select(dict(options), value=self._asked[key], label=words,
                                       on_change=lambda event, key=key: self._chosen(key, event.value))  # fmt: skip
                    with_attributes(select, data_choice=key).props("dense outlined options-dense")

    def _moved(self, one: dict[str, Any], said: Any, number: int) -> None:
        said.text = one["values"][min(number, len(one["values"]) - 1)]
        self._at[one["name"]] = min(number, len(one["values"]) - 1)
        background_tasks.create(self._draw())

    def _chosen(self, key: str, value: str) -> None:
        self._asked[key] = value
        background_tasks.create(self._draw())

    def redraw(self) -> None:
        """Draw the point once more."""
        background_tasks.create(self._draw())

    async def _draw(self) -> None:
        """Draw the point of now; while one is being drawn, only the last that was asked for follows."""
        if self.now is None:
            return
        if self._drawing:
            self._again = True
            return
        self._drawing = True
        try:
            while True:
                self._again = False
                await self._point(self.now)
                if not self._again:
                    return
        finally:
            self._drawing = False

    async def _point(self, run: Run) -> None:
        answer = await self.last("point", run=run.name, at=dict(self._at), theme=self.theme, width=self.width,
                                 **self._asked)  # fmt: skip
        if "error" in answer:
            return
        self._moves += 1
        with self.client:
            for name, text in answer["figures"].items():
                self._places[name].draw(text, f"{self._moves}")
            self.right.show(answer["rows"], answer["warnings"], run.name, done=True)
            self.left.unsay()
            self.state("shown", moves=str(self._moves))
