"""The numbers at the right of a page, warnings, and what is taken home."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

from nicegui import ui

from treadload.app.answers import Allowed, Card, PageRow
from treadload.app.elements import heading, plain, text, with_attributes
from treadload.app.session import Run

_HOME = {"nc": "NetCDF", "html": "report", "csv": "tables, CSV"}
_LONGEST, _LONG = 42, 20
"""Letters of a value that stands beside its label, and on one line; a longer one is a sentence below."""


class VerdictPanel:
    """Rows of results, warnings, files.

    go: called with a row that is clicked. take: with what the case is taken home as. home: files → their names.
    goes_to_groups: True where the first row of a group can be clicked, too.
    """

    def __init__(
        self, go: Callable[[PageRow], object], take: Callable[[str], object], home: dict[str, str] | None = None,
        *, goes_to_groups: bool = False,
    ) -> None:  # fmt: skip
        self._home, self._has_case = home or _HOME, home is None
        self._go, self._take, self._goes_to_groups = go, take, goes_to_groups

    def build(self) -> None:
        """Put the empty panel on the page."""
        self._all = ui.element("div").props('id="verdict"')
        with self._all:
            self._card = ui.element("div").props('id="card"')
        self._program = ui.dialog()

    def show(self, run: Run, *, done: bool) -> None:
        """Show the numbers of a run. done: False while the rest is being solved."""
        self._all.clear()
        with self._all:
            self._card = ui.element("div").props('id="card"')
            self.show_card(run.card)
            if run.unsolved:
                ui.label(run.unsolved).classes("warning").props('id="unsolved"')
            self._tables(run.rows)
            self._allowed = ui.element("div").props('id="allowed"')
            self.show_allowed(run.allowed)
            for warning in run.warnings:
                ui.label(warning).classes("warning")
            if not done:
                ui.label("the rest is being solved").classes("note")
                return
            heading("Take home")
            with ui.element("div").classes("home"):
                if self._has_case:
                    plain("TOML", lambda: self._take("toml"), label="take the case home as TOML")
                    plain("copy as Python", lambda: self._take("python"))
                for kind, words in self._home.items():
                    with_attributes(text("a", words), href=f"./take/{run.name}/{kind}", data_take=kind).props(
                        "download"
                    )
            if self._has_case:
                ui.label("NetCDF and report hold what `treadload run` gives; they take some seconds.").classes("note")

    def show_card(self, card: Card | None) -> None:
        """Show the answer at a glance."""
        self._card.clear()
        if card is None:
            return
        with self._card, ui.element("div").classes("glance"):
            with_attributes(text("p", card["headline"]), data_state=card["state"]).classes("headline")
            with ui.element("dl"):
                for label, fact in card["facts"]:
                    text("dt", label)
                    with_attributes(text("dd", fact), data_fact=label)
            for line, name in ((card["further"], "further"), (card["map"], "bright")):
                if line:
                    with_attributes(text("p", line).classes("note"), id=name)

    def show_allowed(self, allowed: Allowed) -> None:
        """Show load repetitions by criterion below the numbers; they are known last."""
        self._allowed.clear()
        if not allowed:
            return
        with self._allowed:
            self._tables(allowed["rows"])
            for sentence in allowed["notes"]:
                ui.label(sentence).classes("note")
            with ui.element("p").classes("note"):
                ui.html("Load repetitions of this one load at this one temperature, not a life: that is on the "
                        '<a href="./life">life page</a>.', sanitize=False)  # fmt: skip

    def _tables(self, rows: Sequence[PageRow]) -> None:
        """Rows under their headings; of a group the first, and the others when they are asked for."""
        for title, members in itertools.groupby(rows, key=lambda row: row["heading"]):
            shown = list(members)
            with heading(title):
                if shown[0]["about"]:
                    ui.tooltip(shown[0]["about"])
            with ui.element("table").classes("rows"):
                for group, inner in itertools.groupby(shown, key=lambda row: row["group"]):
                    first, *further = inner
                    if not group:
                        for row in (first, *further):
                            self._row(row, row["label"])
                        continue
                    self._row(first, group, can_go=self._goes_to_groups)
                    if further:
                        with ui.element("tr"), ui.element("td").props('colspan="2"'), ui.element("details"):
                            text("summary", f"{first['label']}; {len(further)} more ▾")
                            with ui.element("table").classes("rows"):
                                for row in further:
                                    self._row(row, row["label"])

    def _row(self, row: PageRow, label: str, *, can_go: bool = False) -> None:
        detail = row.get("detail", "")
        if len(row["value"]) > _LONGEST:
            with ui.element("tr"), ui.element("td").props('colspan="2"').classes("sentence"):
                ui.label(label)
                with_attributes(text("div", row["value"]), data_row=row["key"])
            return
        with ui.element("tr").classes("open" if detail else ""):
            with ui.element("td"):
                ui.label(label)
            cell = with_attributes(ui.element("td"), data_row=row["key"])
            with cell.classes("long" if len(row["value"]) > _LONG else ""):
                if row.get("x") is not None or can_go:
                    with ui.element("button").classes("go").props('type="button"') as go:
                        text("span", row["value"])
                    # A browser finds no name in what a closed list holds.
                    with_attributes(go, aria_label=f"{row['value']}, show it")
                    go.on("click", lambda row=row: self._go(row)).tooltip("show it")
                else:
                    ui.label(row["value"])
            if row["note"]:
                cell.tooltip(row["note"])
        if detail:
            with ui.element("tr"), ui.element("td").props('colspan="2"').classes("sentence"):
                with_attributes(ui.label(detail), data_detail=row["key"])

    def show_program(self, program: str) -> None:
        """Show a program that was copied."""
        self._program.clear()
        with self._program, ui.card().style("max-width:760px"):
            ui.label("Copied. The same as a program:")
            text("pre", program).classes("program")
            plain("Close", self._program.close)
        self._program.open()
