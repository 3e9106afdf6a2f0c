"""The verdict on the right of the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from treadload.app.elements import heading, plain, text, with_attributes

_GROUPS = {
    "contact": "Contact", "road": "Road", "life": "Years by criterion", "who": "Who does it", "when": "When",
    "point": "Point", "solved": "Solved", "depends": "What it depends on, by 5 %", "risk": "Probability",
    "solver": "Solver",
}  # fmt: skip
_HOME = {"nc": "NetCDF", "html": "report", "csv": "tables, CSV"}


class Right:
    """Rows of the verdict, warnings, what is taken home. go: called with a row that is clicked. take: with a kind."""

    def __init__(
        self, go: Callable[[dict[str, Any]], Any], take: Callable[[str], Any], home: dict[str, str] | None = None
    ) -> None:
        self._home, self._case = home or _HOME, home is None
        self._go, self._take = go, take

    def build(self) -> None:
        """Put the empty verdict on the page."""
        self._all = ui.element("div").props('id="verdict"')
        self._program = ui.dialog()

    def show(
        self,
        rows: list[dict[str, Any]],
        warnings: list[str],
        run: str,
        *,
        done: bool,
        allowed: dict[str, Any] | None = None,
        unsolved: str = "",
    ) -> None:
        """Show the verdict of a run. done: False while the rest is being solved. allowed: see `show_allowed`.

        unsolved: a sentence on what of the case this is not.
        """
        self._all.clear()
        with self._all:
            for group, title in _GROUPS.items():
                own = [row for row in rows if row["group"] == group]
                if own:
                    heading(title)
                    self._table(own)
                if group == "road":
                    self._allowed = ui.element("div").props('id="allowed"')
                    self.show_allowed(allowed or {})
            if unsolved:
                ui.label(unsolved).classes("warning").props('id="unsolved"')
            for warning in warnings:
                ui.label(warning).classes("warning")
            if not done:
                ui.label("the rest is being solved").classes("note")
                return
            heading("Take home")
            with ui.element("div").classes("home"):
                if self._case:
                    plain("TOML", lambda: self._take("toml"), label="take the case home as TOML")
                    plain("copy as Python", lambda: self._take("python"))
                for kind, words in self._home.items():
                    with_attributes(text("a", words), href=f"/take/{run}/{kind}", data_take=kind).props("download")
            if self._case:
                ui.label("NetCDF and report hold what `treadload run` gives; they take some seconds.").classes("note")

    def _table(self, rows: list[dict[str, Any]]) -> None:
        with ui.element("table").classes("rows"):
            for row in rows:
                with ui.element("tr"):
                    with ui.element("td"):
                        ui.label(row["label"]).style("display:inline")
                    with with_attributes(ui.element("td"), data_row=row["key"]) as cell:
                        if row.get("x") is not None or row.get("criterion"):
                            with ui.element("button").classes("go").props('type="button"') as go:
                                ui.label(row["value"]).style("display:inline")
                            go.on("click", lambda row=row: self._go(row)).tooltip("show it")
                        else:
                            ui.label(row["value"]).style("display:inline")
                if row.get("note"):
                    cell.tooltip(row["note"])
        # A verdict without passes is a sentence, or it reads as a road that lasts for ever.
        for row in rows:
            if row["key"] in ("verdict", "probability"):
                ui.label(row["note"]).classes("note")

    def show_allowed(self, told: dict[str, Any]) -> None:
        """Show passes by criterion below the verdict; they are known last. told: of `allowed_told`."""
        self._allowed.clear()
        if not told:
            return
        with self._allowed:
            heading("Passes by criterion")
            with ui.element("table").classes("rows allowed"):
                for row in told["rows"]:
                    with ui.element("tr"):
                        with ui.element("td"):
                            ui.label(row["label"])
                        with with_attributes(ui.element("td"), data_row=row["key"]) as cell:
                            if row.get("x") is None:
                                ui.label(row["value"])
                            else:
                                with ui.element("button").classes("go").props('type="button"') as go:
                                    ui.label(row["value"]).style("display:inline")
                                go.on("click", lambda row=row: self._go(row))
                        cell.tooltip(row["note"])
                    with ui.element("tr"), ui.element("td").props('colspan="2"'):
                        with_attributes(ui.label(f"{row['place']}: {row['reading']}"), data_detail=row["key"])
            for said in told["said"]:
                ui.label(said).classes("note")
            with ui.element("p").classes("note"):
                ui.html("Passes of this one load at this one temperature, not a life: that is on the "
                        '<a href="/life">life page</a>.', sanitize=False)  # fmt: skip

    def program(self, program: str) -> None:
        """Show a program that was copied."""
        self._program.clear()
        with self._program, ui.card().style("max-width:760px"):
            ui.label("Copied. The same as a program:")
            text("pre", program).classes("said")
            plain("Close", self._program.close)
        self._program.open()
