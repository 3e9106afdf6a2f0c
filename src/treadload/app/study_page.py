"""The page of a study: a slider for each dimension, the response along one of them, the map of a field."""

from __future__ import annotations

from typing import ClassVar

from nicegui import background_tasks, ui

from treadload.app.answers import Answer, Dimension
from treadload.app.elements import heading, with_attributes
from treadload.app.figure_place import Place
from treadload.app.form import Form
from treadload.app.gallery import Gallery
from treadload.app.page_frame import Page
from treadload.app.run_names import name_of_key
from treadload.app.session import STUDIES, Run, Session
from treadload.app.study_form import StudyForm
from treadload.app.uploads import Uploads
from treadload.app.verdict_panel import VerdictPanel
from treadload.registry import PAGES


@PAGES.register("study")
class StudyPage(Page):
    """A study that was solved here or uploaded, at the point where its sliders stand."""

    address: ClassVar[str] = "/study"
    title: ClassVar[str] = "study"
    has_solve: ClassVar[bool] = True
    solve_words: ClassVar[str] = "Solve the study"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._at: dict[str, int] = {}
        self._about: Answer = {}
        self._selection = {"reading": "", "along": "", "field": ""}
        self._drawing = self._again = False
        self._moves = 0
        self._gallery = Gallery(self)
        self._new = StudyForm(session)
        self._varied: list[str] = []

    def inside(self) -> None:
        """The sliders, the figures, what was solved."""
        with ui.element("section").classes("left").props('aria-label="the study"'):
            self.left = Uploads(self.session)
            self.left.build()
            heading("Study").style("margin-top:4px")
            with ui.element("div").classes("line"):
                self.left.upload("open a study …", STUDIES, self._opened)
            self._name = ui.label("").classes("note").props('id="study-name"')
            self._sliders = ui.element("div").props('id="sliders"')
            self._summary = ui.element("div")
            self._new.build()
        with ui.element("section").classes("centre").props('aria-label="figures of the study"'):
            self._hint = ui.label(
                "Start a study of the case of the bench or of the life page at the left, or open one that was saved "
                "as one file: tl.save_results(tl.sweep(…), 'study.nc'). Fields that it kept are drawn as maps."
            )
            self._hint.classes("note")
            self._tools = ui.element("div").classes("tools")
            self._places = {
                "curve": Place("curve", "the result along one input of the study"),
                "field": Place("field", "map of a field at this point of the study"),
            }
            self._gallery.build()
        with ui.element("section").classes("right").props('aria-label="the point"'):
            self.right = VerdictPanel(
                lambda row: None, lambda kind: None, home={"csv": "tables, CSV", "html": "report"}
            )
            self.right.build()

    async def started(self) -> None:
        """A study that was opened or solved before is shown."""
        self.stage.text = "waiting for a study"
        self.state("idle")
        ready = self.session.last_ready(self.address)
        if ready is not None:
            await self._show(ready)

    def solve_asked(self) -> None:
        """Solve the study that the fields describe."""
        varied = self._new.varied()
        if varied is not None:
            self._varied = varied
            self.start(self._new.form)

    def question_of(self, form: Form) -> tuple[str, dict[str, object]]:
        """The case and what varies."""
        return "sweep", {"table": dict(form.table), "varied": self._varied}

    def name_of(self, form: Form) -> str:
        """The inputs that vary."""
        names = (name_of_key(text.partition("=")[0], form.table) for text in self._varied)
        return f"study of {' and '.join(names)}"

    def settled(self, run: Run) -> None:
        """The study is solved: show it."""
        run.ready = True
        background_tasks.create(self._show(run))

    async def _opened(self, kept: str) -> None:
        run = self.session.new_run(None, self.session.known_as(kept), self.address)
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
            self._at = {dim["name"]: 0 for dim in answer["dims"]}
            first = max(answer["dims"], key=lambda dim: len(dim["values"]))["name"]
            preferred = [name for name in ("largest_pressure", "largest_extension") if name in answer["readings"]]
            self._selection = {"reading": next(iter(preferred), next(iter(answer["readings"]))), "along": first,
                           "field": next(iter(answer["fields"]), "")}  # fmt: skip
            self._controls()
            self.stage.text = f"{run.title} is open"
        await self._gallery.show(run.name)
        await self._draw()

    def _controls(self) -> None:
        """A slider for each dimension, and what is drawn."""
        self._sliders.clear()
        with self._sliders:
            for dim in self._about["dims"]:
                with ui.element("div").classes("slide"):
                    with ui.element("div").classes("head"):
                        ui.label(dim["words"])
                        label = with_attributes(ui.label(dim["values"][0]), data_at=dim["name"])
                    slider = ui.slider(min=0, max=max(1, len(dim["values"]) - 1), step=1, value=0)
                    with_attributes(slider, aria_label=dim["words"], data_dim=dim["name"]).props("snap markers")
                    if len(dim["values"]) < 2:
                        slider.disable()
                    slider.on_value_change(
                        lambda event, dim=dim, label=label: self._moved(dim, label, int(event.value))
                    )
        self._summary.clear()
        with self._summary:
            heading("Summary")
            for line in self._about["summary"]:
                ui.label(line).classes("note")
        self._tools.clear()
        with self._tools:
            for key, words, options in (
                ("reading", "result", self._about["readings"]),
                ("along", "along", {dim["name"]: dim["words"] for dim in self._about["dims"]}),
                ("field", "map", self._about["fields"]),
            ):
                if options:
                    select = ui.select(dict(options), value=self._selection[key], label=words,
                                       on_change=lambda event, key=key: self._chosen(key, event.value))  # fmt: skip
                    with_attributes(select, data_choice=key).props("dense outlined options-dense")

    def _moved(self, dim: Dimension, label: ui.label, number: int) -> None:
        label.text = dim["values"][min(number, len(dim["values"]) - 1)]
        self._at[dim["name"]] = min(number, len(dim["values"]) - 1)
        background_tasks.create(self._draw())

    def _chosen(self, key: str, value: str) -> None:
        self._selection[key] = value
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
                                 **self._selection)  # fmt: skip
        if "error" in answer:
            return
        self._moves += 1
        with self.client:
            for name, text in answer["figures"].items():
                self._places[name].draw(text, f"{self._moves}")
            run.rows, run.warnings = answer["rows"], answer["warnings"]
            self.right.show(run, done=True)
            self.left.clear_problem()
            self.state("shown", moves=str(self._moves))
