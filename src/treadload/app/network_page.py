"""The page of a network: a table of road sections comes in, and goes out ranked by remaining service life."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import ClassVar

from nicegui import background_tasks, ui

from treadload.app.answers import RankedSection
from treadload.app.elements import heading, plain
from treadload.app.form import Form
from treadload.app.gallery import Gallery
from treadload.app.page_frame import Page
from treadload.app.session import Run, Session
from treadload.app.uploads import Uploads
from treadload.app.verdict_panel import VerdictPanel
from treadload.errors import InputError
from treadload.registry import PAGES

TABLES = (".csv", ".xlsx")
_COLUMNS = {
    "rank": "rank", "section": "section", "station": "station km", "age": "age, years", "remaining": "remaining life",
    "service_life": "service life", "governing": "governing criterion",
}  # fmt: skip
# Rows of the table at once.
_ROWS = 25


class NetworkUploads(Uploads):
    """Files of a network, among them the case of all sections. came: called with its form and its name."""

    def __init__(self, page: NetworkPage) -> None:
        super().__init__(page.session)
        self._page = page

    def case_came(self, name: str, content: bytes) -> None:
        """The case of all sections. Raises InputError."""
        try:
            text = content.decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(f"{name} is not a text file in UTF-8") from error
        form = Form.from_text(text, name, self.session.files, "life")
        wrong = form.check(self.session.folder).wrong
        if wrong:
            sentences = (f"{key}: {words}" if key else words for key, words in wrong.items())
            raise InputError(f"{name}: {'; '.join(sentences)}")
        self._page.case_came(name, form)


@PAGES.register("network")
class NetworkPage(Page):
    """Road sections of a table, ranked by the remaining service life under one design case."""

    address: ClassVar[str] = "/network"
    title: ClassVar[str] = "network"
    has_solve: ClassVar[bool] = True
    solve_words: ClassVar[str] = "Rank the sections"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._table = ""
        self._ranked: list[RankedSection] = []
        self._gallery = Gallery(self)

    def inside(self) -> None:
        """The two files, the ranked table with its figures, and the numbers."""
        with ui.element("section").classes("left").props('aria-label="the network"'):
            self.left = NetworkUploads(self)
            self.left.build()
            heading("Design case of all sections").style("margin-top:4px")
            with ui.element("div").classes("line"):
                self.left.upload("open a TOML …", (".toml",), None)
                plain("take that of the life page", self._take_life)
            self._case = ui.label("").classes("note").props('id="case"')
            heading("Table of sections")
            with ui.element("div").classes("line"):
                self.left.upload("open a table …", TABLES, self._table_came)
            self._sections = ui.label("no table yet").classes("note").props('id="sections"')
            for sentence in (
                "One row for each section, CSV or Excel: id, station [km], age [years], and columns for what "
                "differs, such as thickness asphalt [mm], modulus base [MPa] or passes_per_year.",
                "Criteria of the case name their layer by role, such as lowest asphalt layer, where sections differ.",
            ):
                ui.label(sentence).classes("note")
        with ui.element("section").classes("centre").props('aria-label="the ranked sections"'):
            self._hint = ui.label("Open the case and the table, then rank the sections.").classes("note")
            columns = [
                {"name": name, "label": label, "field": name, "align": "left", "sortable": name == "section"}
                for name, label in _COLUMNS.items()
            ]
            self._list = ui.table(columns=columns, rows=[], row_key="number", pagination=_ROWS)
            self._list.props('dense flat wrap-cells id="ranked"').set_visibility(False)
            self._home = ui.element("div").classes("home")
            with self._home:
                plain("ranked table, CSV", self._take).props('id="take-ranked"')
            self._home.set_visibility(False)
            self._gallery.build()
        with ui.element("section").classes("right").props('aria-label="numbers of the network"'):
            self.right = VerdictPanel(
                lambda row: None, lambda kind: None,
                home={"csv": "tables, CSV", "html": "report", "nc": "NetCDF"},
            )  # fmt: skip
            self.right.build()

    async def started(self) -> None:
        """A network that was ranked before is shown."""
        self.stage.text = "waiting for a table"
        self.state("idle")
        if self.address not in self.session.forms:
            self._take_life()
        ready = self.session.last_ready(self.address)
        if ready is not None:
            await self._show(ready)

    def case_came(self, name: str, form: Form) -> None:
        """The case that all sections share. name: of its file."""
        self.session.forms[self.address] = form
        self._case.text = f"{name}: {form.value('title') or 'without a title'}"
        self.left.clear_problem()
        self._hint.set_visibility(True)

    def _take_life(self) -> None:
        form = self.session.forms.get("/life") or Form.first("life")
        self.case_came("case of the life page", form)

    def _table_came(self, kept: str) -> None:
        self._table = kept
        self._sections.text = self.session.known_as(kept)
        self.left.clear_problem()

    def solve_asked(self) -> None:
        """Rank the sections of the table."""
        if not self._table:
            self.left.show_problem("open a table of sections first: a CSV file or an Excel sheet")
            return
        self.start(self.form)

    def question_of(self, form: Form) -> tuple[str, dict[str, object]]:
        """The case and the table."""
        # Uncertainty of each service life is left to the page of one road.
        table = {key: value for key, value in form.table.items() if key != "reliability"}
        return "network", {"table": table, "file": self._table, "shown": self.session.known_as(self._table)}

    def name_of(self, form: Form) -> str:
        """The table."""
        return self.session.known_as(self._table)

    def settled(self, run: Run) -> None:
        """The network is ranked."""
        run.ready = True
        background_tasks.create(self._show(run))

    async def _show(self, run: Run) -> None:
        answer = await self.last("ranked", run=run.name)
        if "error" in answer:
            return
        with self.client:
            self.now, self._ranked = run, answer["sections"]
            run.rows, run.warnings = answer["rows"], answer["warnings"]
            self._hint.set_visibility(False)
            self._home.set_visibility(True)
            self._list.set_visibility(True)
            self._list.rows = [dict(section) for section in self._ranked]
            self._list.update()
            self.right.show(run, done=True)
            self.left.clear_problem()
            self.stage.text = f"{run.title}: {len(self._ranked)} sections"
            self.state("shown", run=run.name)
        await self._gallery.show(run.name)

    def _take(self) -> None:
        out = io.StringIO()
        table = csv.writer(out, lineterminator="\n")
        table.writerow(_COLUMNS.values())
        table.writerows([str(dict(section)[name]) for name in _COLUMNS] for section in self._ranked)
        name = f"{Path(self.now.title).stem if self.now is not None else 'sections'}_ranked.csv"
        with self.client:
            ui.download.content(out.getvalue().encode("utf-8-sig"), name, "text/csv")
