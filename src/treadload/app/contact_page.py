"""The page of a contact: the form at the left, linked maps, slices and runs in the middle, numbers at the right."""

from __future__ import annotations

import contextlib
from typing import ClassVar, Unpack

from nicegui import background_tasks, ui

from treadload.app.answers import Answer, View
from treadload.app.case_form import CaseForm
from treadload.app.case_schema import label_of
from treadload.app.elements import heading, plain, with_attributes
from treadload.app.figure_place import Place
from treadload.app.form import Form
from treadload.app.gallery import Gallery
from treadload.app.page_frame import Page
from treadload.app.run_cards import RunCards
from treadload.app.session import FOOTPRINTS, Run, Session
from treadload.app.slice_panel import SlicePanel
from treadload.app.verdict_panel import VerdictPanel
from treadload.registry import PAGES
from treadload.us_units import sentence_in_display_units

# Of a thumbnail, letters of its data URL.
_MOST_LETTERS = 200_000


@PAGES.register("bench")
class ContactPage(Page):
    """A wheel on a road: contact, response, verdict."""

    address: ClassVar[str] = "/"
    title: ClassVar[str] = "the bench"
    command: ClassVar[str] = "run"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._view: View = {"left": "contact/pressure", "right": "response/principal_strain_1", "depth": 0}
        self._over: str | None = None
        self._pair: tuple[Run, Run] | None = None
        self._depths: list[float] = []
        self._slice = SlicePanel(lambda: background_tasks.create(self._cut()), self.js)
        self._runs = RunCards(session, self.address, self._show, self._compare)
        self._gallery = Gallery(self)
        self._section_follows = False
        self._tread: Place | None = None

    def inside(self) -> None:
        """The form, the maps and what is below them, the verdict."""
        with ui.element("section").classes("left").props('aria-label="the case"'):
            self._form = self.left = CaseForm(self.session, self.address, self.solve, {
                "open a result …": ((".nc",), lambda name: self.opened("result", name)),
                "footprint …": (FOOTPRINTS, lambda name: self.opened("footprint", name)),
            })  # fmt: skip
            self.left.build()
        with ui.element("section").classes("centre").props('aria-label="maps and slices"'):
            self._centre()
        with ui.element("section").classes("right").props('aria-label="the verdict"'):
            self.right = VerdictPanel(lambda row: self.fly(float(row["x"]), float(row["y"])), self.take_home)
            self.right.build()

    def _centre(self) -> None:
        with ui.element("div").classes("tools"):
            self._maps_of = {
                side: with_attributes(
                    ui.select({self._view[side]: "…"}, value=self._view[side], label=f"{side} map",
                              on_change=lambda event, side=side: self._look(**{side: event.value})),
                    data_map=side,
                ).props("dense outlined options-dense").classes("long")
                for side in ("left", "right")
            }  # fmt: skip
            self._depth = ui.select({0: "surface"}, value=0, label="depth of maps",
                                    on_change=lambda event: self._look(depth=event.value))  # fmt: skip
            self._depth.props('dense outlined options-dense data-map="depth"').style("max-width:150px")
            plain("whole contact", lambda: self.js("treadloadWhole"))
            plain("SVG", lambda: self.js("treadloadPicture", "svg"), label="take the maps home as SVG")
            plain("PNG", lambda: self.js("treadloadPicture", "png"), label="take the maps home as PNG")
        self._maps = Place("maps", "two linked maps of the result")
        self._slice.build()
        with ui.element("div").classes("tools"):
            heading("Runs").style("margin:8px 0")
            self._runs.button()
            plain("Tread in space", self._show_tread).props('id="tread"')
        self._runs.build()
        self._space = ui.element("div").props('id="space"')
        self._gallery.build()

    async def started(self) -> None:
        """A page that is loaded again leaves what it had begun, and solves its form anew."""
        self._runs.list(self.now)
        await self.session.stop(self.address)
        self.solve(self.form)

    # The run that is shown.

    def view_options(self) -> dict[str, object]:
        """The maps of a part as soon as it is there."""
        self._pair = None
        return {"view": self._seen()}

    def _seen(self) -> View:
        return {**self._view, "width": self.width, "line": self._slice.line}

    def name_of(self, form: Form) -> str:
        """The load and the forces or creepages, as they were typed."""
        wheel = form.value("rolling")
        numbers = wheel if isinstance(wheel, dict) else {}
        parts = [
            f"{value} {label_of(key).lower()}" for key, value in numbers.items() if key not in ("friction", "speed")
        ]
        return ", ".join(parts).replace(" normal load", "") or super().name_of(form)

    def drawn(self, run: Run, answer: Answer) -> None:
        """Draw what an answer holds, and tell its verdict."""
        figures = answer.get("figures", {})
        self._section_follows = "part" in answer
        for name in ("maps", "places"):
            if name in figures:
                self._maps.draw(figures[name], f"{run.name}:{answer.get('part', 'maps')}", add=name == "places")
        self._slice.draw(figures)
        if "choices" in answer:
            self._offer(answer["choices"], answer["depths"])
        if "rows" in answer:
            self.right.show(run, done=run.ready)

    def finished(self, run: Run) -> None:
        """A card for it, with a thumbnail once the maps are drawn."""
        self.stage.text += "; slices follow"
        background_tasks.create(self._gallery.show(run.name))
        self._runs.list(self.now)
        background_tasks.create(self._thumb(run))

    def stale_part(self) -> str:
        """The section, until the road below the run is solved."""
        return "section" if self._section_follows else ""

    def settled(self, run: Run) -> None:
        """The road below the maps is known: cut it."""
        self.stage.text = "solved"
        background_tasks.create(self._cut())

    def left_undone(self) -> None:
        """The section of the run that stays was perhaps not solved yet."""
        if self._section_follows:
            background_tasks.create(self._cut())

    def _offer(self, choices: dict[str, str], depths: list[float]) -> None:
        """Fill the lists of maps without asking for what they show already."""
        for side, select in self._maps_of.items():
            wanted = self._view["left"] if side == "left" else self._view["right"]
            options = choices if wanted in choices else {**choices, wanted: "follows when it is solved"}
            if select.options != options:
                select.set_options(options, value=wanted)
        if depths and depths != self._depths:
            self._depths = depths
            named = {number: sentence_in_display_units(f"{depth * 1e3:g} mm") for number, depth in enumerate(depths)}
            self._view["depth"] = min(self._view["depth"], len(depths) - 1)
            self._depth.set_options(named, value=self._view["depth"])

    def _look(self, **view: Unpack[View]) -> None:
        if all(self._view.get(key) == value for key, value in view.items()):
            return
        self._view.update(view)
        self._pair = None
        self.redraw()

    def redraw(self) -> None:
        """Draw the run, or the two, of now."""
        if self._pair is not None:
            background_tasks.create(self._draw_pair(*self._pair))
        elif self.now is not None:
            background_tasks.create(self._draw_run(self.now))

    async def _draw_run(self, run: Run) -> None:
        answer = await self.last("maps", run=run.name, theme=self.theme, view=self._seen())
        if "error" not in answer:
            run.rows, run.warnings, run.card = answer["rows"], answer["warnings"], run.card or answer.get("card")
            with self.client:
                self.drawn(run, answer)
        await self._cut()
        if self._tread is not None:
            await self._draw_tread(run)
        await self._gallery.show(run.name)

    async def _cut(self) -> None:
        run = self.now
        if run is None or run.name not in self.session.runs:
            return
        lacks_section = await self._draw_slice(run)
        # Its process gave way to another; what was brought as a file has no case of this page and gets no section.
        if lacks_section and run.form is not None:
            answer = await self.last("section", run=run.name)
            if "error" in answer:
                return
            run.allowed, run.card = answer.get("allowed", run.allowed), answer.get("card", run.card)
            with self.client:
                self.right.show(run, done=run.ready)
            await self._draw_slice(run)

    async def _draw_slice(self, run: Run) -> bool:
        """Draw what lies along the line; True where the road below the run is not known any more."""
        answer = await self.last("cut", run=run.name, theme=self.theme, line=self._slice.line,
                                 name=self._slice.section_of, over=self._over)  # fmt: skip
        if self.now is run:
            self._slice.draw(answer.get("figures", {}))
            self._section_follows = "section" not in answer.get("figures", {}) and run.form is not None
            self.compare_with_form()
        return bool(answer.get("lacks_section"))

    def fly(self, x: float, y: float) -> None:
        """Show the maps around a place, m."""
        self.js("treadloadFly", round(x * 1e3, 3), round(y * 1e3, 3))

    async def _show_tread(self) -> None:
        """Show the tread in space, or put it away."""
        if self._tread is not None:
            self._space.clear()
            self._tread = None
        elif self.now is not None:
            with self.client, self._space:
                self._tread = Place("tread", "the tread in space")
            await self._draw_tread(self.now)

    async def _draw_tread(self, run: Run) -> None:
        answer = await self.last("tread", run=run.name, theme=self.theme)
        if self._tread is not None and "error" not in answer:
            self._tread.draw(answer["figures"]["tread"])

    # Other runs.

    def _show(self, run: Run) -> None:
        self.now, self._pair = run, None
        if run.form is not None:
            self._form.take(run.form)
        self._runs.list(run)
        background_tasks.create(self._draw_run(run))

    def _compare(self, first: Run, second: Run) -> None:
        self._pair = (first, second)
        background_tasks.create(self._draw_pair(first, second))

    async def _draw_pair(self, first: Run, second: Run) -> None:
        answer = await self.last("difference", first=first.name, second=second.name, name=self._view["left"],
                                 theme=self.theme, width=self.width, labels=["A", "B"])  # fmt: skip
        if "error" not in answer:
            self._maps.draw(answer["figures"]["maps"], "compared")
        with self.client:
            self.state("compared")

    async def _thumb(self, run: Run) -> None:
        with self.client:
            picture = None
            with contextlib.suppress(TimeoutError):
                picture = await ui.run_javascript("treadloadThumb()", timeout=30)
            if not isinstance(picture, str) or len(picture) > _MOST_LETTERS or '"' in picture:
                return
            if picture.startswith("data:image/png;base64,"):
                run.thumb, run.thumb_theme = picture, self.theme
                self._runs.list(self.now)

    # Files.

    async def opened(self, kind: str, kept: str) -> None:
        """Show a result that was uploaded, or lay a measured footprint over the contact."""
        run = self.session.new_run(None, self.session.known_as(kept), self.address)
        answer = await self.last("open", run=run.name, file=kept, kind=kind)
        with self.client:
            if "error" in answer:
                self.session.runs.pop(run.name, None)
                return
            run.ready = True
            if kind == "footprint":
                self._over = run.name
                self._runs.list(self.now)
                await self._cut()
                return
            self.now, self._depths, self._pair = run, [], None
            await self._draw_run(run)
            self._runs.list(run)
