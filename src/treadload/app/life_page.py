"""The page of a road's life: traffic, climate and criteria at the left; years, who and when in the middle."""

from __future__ import annotations

from typing import ClassVar

from nicegui import background_tasks, ui

from treadload.app.answers import Answer, Picture
from treadload.app.case_form import CaseForm
from treadload.app.elements import heading
from treadload.app.gallery import put
from treadload.app.page_frame import Page
from treadload.app.run_cards import RunCards
from treadload.app.session import Run, Session
from treadload.app.verdict_panel import VerdictPanel
from treadload.registry import PAGES


@PAGES.register("life")
class LifePage(Page):
    """How many years a road lasts."""

    address: ClassVar[str] = "/life"
    title: ClassVar[str] = "life"
    command: ClassVar[str] = "life"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._runs = RunCards(session, self.address, self._show)
        self._drawn: dict[str, Picture] = {}
        self._criterion = ""

    def inside(self) -> None:
        """The form, the figures, the verdict."""
        with ui.element("section").classes("left").props('aria-label="the case"'):
            self._form = self.left = CaseForm(self.session, self.address, self.solve)
            self.left.build()
        with ui.element("section").classes("centre").props('aria-label="the life"'):
            self._hint = ui.label("Solve the case to see how long the road lasts; each change solves it again.")
            self._hint.classes("note").props('id="hint"')
            with ui.element("div").classes("tools"):
                self._by = ui.select({"": "the first to fail"}, value="", label="governing criterion and time, by",
                                     on_change=lambda event: self._choose(str(event.value or "")))  # fmt: skip
                self._by.props('dense outlined options-dense id="by"')
            self._pictures = ui.element("div").classes("pictures").props('id="pictures"')
            heading("Runs")
            self._runs.build()
        with ui.element("section").classes("right").props('aria-label="the verdict"'):
            self.right = VerdictPanel(lambda row: self._choose(row["group"]), self.take_home, goes_to_groups=True)
            self.right.build()

    async def started(self) -> None:
        """A life is solved when it is asked for; one that stands is shown."""
        ready = self.session.last_ready(self.address)
        self.stage.text = "ready to solve"
        self.state("idle")
        self._runs.list(None)
        if ready is not None:
            self._show(ready)

    def drawn(self, run: Run, answer: Answer) -> None:
        """Put the figures of a part where they belong."""
        if answer.get("part") == "life":
            self._drawn, self._criterion = {}, ""
            self._offer(answer["criteria"])
        self._drawn |= answer["pictures"]
        self._put()
        self.right.show(run, done=run.ready)

    def _offer(self, names: list[str]) -> None:
        self._by.set_options({"": "the first to fail", **{name: name for name in names}}, value="")

    def _put(self) -> None:
        self._hint.set_visibility(not self._drawn)
        self._pictures.clear()
        with self._pictures:
            for key, picture in self._drawn.items():
                put(key, picture)

    def finished(self, run: Run) -> None:
        """A card for it."""
        self._runs.list(run)

    def _choose(self, criterion: str) -> None:
        if criterion != self._criterion and self.now is not None and criterion in self._by.options:
            self._criterion = criterion
            self._by.set_value(criterion)
            background_tasks.create(self._share(self.now))

    async def _share(self, run: Run) -> None:
        answer = await self.last("shares", run=run.name, criterion=self._criterion)
        if "error" not in answer and run is self.now:
            with self.client:
                run.rows = answer["rows"]
                self._drawn |= answer["pictures"]
                self._put()
                self.right.show(run, done=run.ready)
                self.state("shared", criterion=self._criterion)

    def _show(self, run: Run) -> None:
        background_tasks.create(self._shown(run))

    async def _shown(self, run: Run) -> None:
        answer = await self.last("pictures", run=run.name)
        if "error" in answer:
            return
        with self.client:
            self.now = run
            if run.form is not None:
                self._form.take(run.form)
            run.rows, run.warnings, run.card = answer["rows"], answer["warnings"], answer["card"]
            self.drawn(run, {**answer, "part": "life"})
            self._runs.list(run)
            self.state("shown", run=run.name)
