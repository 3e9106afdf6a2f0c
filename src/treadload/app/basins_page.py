"""The page of deflection basins: a list of drops, the fit beside the readings, moduli with their bars."""

from __future__ import annotations

from typing import ClassVar

from nicegui import background_tasks, events, ui

from treadload.app.elements import heading, with_attributes
from treadload.app.figure_place import Place
from treadload.app.gallery import Gallery
from treadload.app.page_frame import Page
from treadload.app.session import STUDIES, Run, Session
from treadload.app.uploads import Uploads
from treadload.app.verdict_panel import VerdictPanel
from treadload.registry import PAGES

_COLUMNS = [
    {"name": name, "label": label, "field": name, "align": "left", "sortable": True}
    for name, label in (("station", "station"), ("load", "kN"), ("misfit", "misfit %"), ("status", "status"))
]
# Rows of the list at once.
_ROWS = 12


@PAGES.register("basins")
class BasinsPage(Page):
    """A backcalculation that was uploaded, at one of its drops."""

    address: ClassVar[str] = "/basins"
    title: ClassVar[str] = "basins"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._drop, self._moves = 0, 0
        self._gallery = Gallery(self)

    def inside(self) -> None:
        """The list of drops, the figures, the numbers of a drop."""
        with ui.element("section").classes("left").props('aria-label="the drops"'):
            self.left = Uploads(self.session)
            self.left.build()
            heading("Backcalculation").style("margin-top:4px")
            with ui.element("div").classes("line"):
                self.left.upload("open a backcalculation …", STUDIES, self._opened)
            self._name = ui.label("").classes("note")
            self._search = with_attributes(ui.input(placeholder="find a station"), aria_label="find a station")
            self._search.props('dense outlined clearable id="search"')
            self._drops = ui.table(
                columns=_COLUMNS, rows=[], row_key="number", selection="single", pagination=_ROWS,
                on_select=self._selected,
            )  # fmt: skip
            self._drops.props('dense flat wrap-cells id="drops" hide-selected-banner').bind_filter_from(
                self._search, "value"
            )
            self._summary = ui.element("div")
            self._search.set_visibility(False)
            self._drops.set_visibility(False)
        with ui.element("section").classes("centre").props('aria-label="figures of the drop"'):
            self._hint = ui.label(
                "Open the result file of `treadload backcalculate`, moduli.nc. Each drop in its list shows the "
                "fitted basin beside the measured one, and its moduli along the road."
            )
            self._hint.classes("note")
            self._places = {
                "basin": Place("basin", "measured deflections of the drop and the fitted basin"),
                "moduli": Place("moduli", "moduli of the layers with error bars along the road"),
            }
            self._gallery.build()
        with ui.element("section").classes("right").props('aria-label="the drop"'):
            self.right = VerdictPanel(
                lambda row: None, lambda kind: None, home={"csv": "tables, CSV", "html": "report"}
            )
            self.right.build()

    async def started(self) -> None:
        """A backcalculation that was opened before is shown."""
        self.stage.text = "waiting for a backcalculation"
        self.state("idle")
        ready = self.session.last_ready(self.address)
        if ready is not None:
            await self._show(ready)

    async def _opened(self, kept: str) -> None:
        run = self.session.new_run(None, self.session.known_as(kept), self.address)
        answer = await self.last("open", run=run.name, file=kept, kind="basins")
        if "error" in answer:
            self.session.runs.pop(run.name, None)
            return
        run.ready = True
        await self._show(run)

    async def _show(self, run: Run) -> None:
        answer = await self.last("basins", run=run.name)
        if "error" in answer:
            return
        with self.client:
            self.now, self._drop = run, 0
            self._name.text = run.title
            self._hint.set_visibility(False)
            self._search.set_visibility(True)
            self._drops.set_visibility(True)
            drops = [dict(drop) for drop in answer["drops"]]
            self._drops.rows = drops
            self._drops.selected = drops[:1]
            self._drops.update()
            self._summary.clear()
            with self._summary:
                heading("Summary")
                for line in answer["summary"]:
                    ui.label(line).classes("note")
            self.stage.text = f"{run.title} is open"
        await self._gallery.show(run.name)
        await self._draw()

    def _selected(self, event: events.TableSelectionEventArguments) -> None:
        if event.selection:
            self._drop = int(event.selection[0]["number"])
            background_tasks.create(self._draw())

    def redraw(self) -> None:
        """Draw the drop once more."""
        background_tasks.create(self._draw())

    async def _draw(self) -> None:
        """Draw the drop of now; where another was chosen meanwhile, that one is drawn by its own call."""
        run, drop = self.now, self._drop
        if run is None:
            return
        answer = await self.last("basin", run=run.name, drop=drop, theme=self.theme)
        if "error" in answer or drop != self._drop or run is not self.now:
            return
        self._moves += 1
        with self.client:
            for name, text in answer["figures"].items():
                self._places[name].draw(text, f"{self._moves}")
            run.rows, run.warnings = answer["rows"], answer["warnings"]
            self.right.show(run, done=True)
            self.left.clear_problem()
            self.state("shown", moves=str(self._moves), drop=str(drop))
