"""What every page has: its head, what it waits for, and the solves that it asks of the process of its session."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Mapping
from typing import ClassVar

from nicegui import background_tasks, ui

from treadload.app.answers import Answer
from treadload.app.case_form import CaseForm
from treadload.app.elements import call_script, plain, text, with_attributes
from treadload.app.engines import EngineLost
from treadload.app.form import Form
from treadload.app.session import Run, Session
from treadload.app.unsolved import unsolved_sentence
from treadload.app.uploads import Uploads
from treadload.app.verdict_panel import VerdictPanel
from treadload.case import Case
from treadload.steps import case_as_python

# Narrower than this the maps do not become; they are drawn anew for a window that changes by more than that, pixels.
_NARROWEST, _CHANGED = 560.0, 20.0
# What a browser is like, as it says.
_ABOUT = (
    "({width: document.querySelector('.centre').clientWidth - 26, "
    "dark: matchMedia('(prefers-color-scheme: dark)').matches, link: treadloadLinked()})"
)


class Page:
    """A page in one tab of a browser. Kinds of pages say what is inside, what they ask for and what they draw.

    Another package registers one as ours are, `@PAGES.register("name")`, and names it as an entry point of
    `treadload.pages`. address: "/name". title: in the head and in the list of pages. command: of the cases that its
    form makes, "run" or "life"; "" for a page without one. has_solve, solve_words: whether a page without a form
    solves as well, and what its button says.
    """

    address: ClassVar[str] = ""
    title: ClassVar[str] = ""
    command: ClassVar[str] = ""
    has_solve: ClassVar[bool] = False
    solve_words: ClassVar[str] = "Solve"
    left: Uploads
    right: VerdictPanel

    def __init__(self, session: Session) -> None:
        self.session, self.client = session, ui.context.client
        if self.command and self.address not in session.forms:
            session.forms[self.address] = Form.first(self.command)
        self.theme, self.width = "light", 1100.0
        self.now: Run | None = None
        self._solving: asyncio.Task[None] | None = None
        self._count = 0

    @property
    def form(self) -> Form:
        """The case that its fields are."""
        return self.session.forms[self.address]

    def build(self, pages: Mapping[str, str]) -> None:
        """Put everything on the page. pages: addresses and titles of all."""
        self._dark = ui.dark_mode(value=None)
        with ui.element("header").classes("bar"):
            text("h1", f"treadload, {self.title}")
            with ui.element("nav").classes("pages").props('aria-label="pages"'):
                for address, words in pages.items():
                    link = with_attributes(text("a", words), href=f".{address}")
                    if address == self.address:
                        link.props('aria-current="page"')
            self.stage = ui.label("starting").classes("stage").props('role="status" aria-live="polite" id="stage"')
            if self.command or self.has_solve:
                self._cancel = plain("Cancel", self.cancel).props('id="cancel" disabled')
                plain(self.solve_words, self.solve_asked, main=True).props('id="solve"')
            plain("Light or dark", self._other_theme).props('id="theme"')
        self._root = ui.element("div").classes("bench").props('id="bench" data-state="starting" data-ready="0"')
        with self._root:
            self.inside()
        self._before = ui.label("").classes("before").props('role="status" aria-live="polite" id="before"')
        if isinstance(self.left, CaseForm):
            self.left.when_checked = lambda: self.compare_with_form(typed=True)
        ui.on("link", lambda event: self._linked(str(event.args["link"])))
        ui.on("width", lambda event: self._resized(float(event.args["width"])))

    # What kinds of pages do.

    def inside(self) -> None:
        """Put what is below the head on the page."""
        raise NotImplementedError

    async def started(self) -> None:
        """The browser is there, and what it is like is known."""

    def view_options(self) -> dict[str, object]:
        """What a solve is asked for, besides the run, its tables and the theme."""
        return {}

    def drawn(self, run: Run, answer: Answer) -> None:
        """Draw a part of a run that is there."""

    def finished(self, run: Run) -> None:
        """All parts of a run are there."""

    def settled(self, run: Run) -> None:
        """Nothing more comes of a run."""

    def left_undone(self) -> None:
        """A solve came to no result; that of before stays."""

    def redraw(self) -> None:
        """Draw once more what stands on the page, in the theme of now."""

    def name_of(self, form: Form) -> str:
        """What a run of a form is called."""
        return str(form.value("title") or "a case")

    # What the browser is and wants.

    async def begin(self) -> None:
        """Wait for the browser, and show where its session stands."""
        if not await self._is_there():
            return
        with self.client:
            about = None
            with contextlib.suppress(TimeoutError):
                about = await ui.run_javascript(_ABOUT, timeout=10)
            # Nothing is begun, and no process is taken, for who has left already.
            if about is None and not await self._is_there():
                return
            if about:
                self.width = max(_NARROWEST, float(about["width"]))
                self.theme = "dark" if about["dark"] else "light"
                self._dark.value = bool(about["dark"])
                self._linked(str(about.get("link") or ""))
            await self.started()

    async def _is_there(self) -> bool:
        """Wait for the browser; False where it does not come, or not again."""
        try:
            await self.client.connected(timeout=60)
        except Exception:
            return False
        # A connection that is lost for a moment comes again.
        return not self.client.is_deleted

    def _linked(self, link: str) -> None:
        """Restore the case of a link."""
        if link and isinstance(self.left, CaseForm):
            self.left.link.restore(link)

    def _other_theme(self) -> None:
        self.theme = "light" if self.theme == "dark" else "dark"
        self._dark.value = self.theme == "dark"
        self.redraw()

    def _resized(self, width: float) -> None:
        """Draw for another width of the window, once that has come to rest."""
        width = max(_NARROWEST, width)
        if abs(width - self.width) > _CHANGED:
            self.width = width
            self.redraw()

    def js(self, name: str, *arguments: object) -> None:
        """Call a function of ours in the browser."""
        with self.client:
            call_script(name, *arguments)

    def state(self, state: str, **more: str) -> None:
        """Say on the page where it stands."""
        self._root.props["data-state"] = state
        for key, value in more.items():
            self._root.props[f"data-{key}"] = value
        self._root.update()

    # Results of another case.

    def compare_with_form(self, *, typed: bool = False) -> None:
        """Dim what is shown of another case than that of the fields.

        typed: True once the form holds what was typed into its fields.
        """
        if self.now is None:
            return
        form = self.now.form
        self._before.text = f"Results of the case before: {self.now.title}"
        is_another_case = form is not None and form.table != self.form.table
        stale = "all" if is_another_case else self.stale_part()
        self.js("treadloadStale", stale, typed)

    def stale_part(self) -> str:
        """Which part of the page follows a run that is shown: "section", or "" where all is of that run."""
        return ""

    # Solving.

    def solve_asked(self) -> None:
        """The button that solves was pressed."""
        self.solve(self.form)

    def question_of(self, form: Form) -> tuple[str, dict[str, object]]:
        """What the process is asked for to solve a form, and the rest of the question."""
        return form.command, {"table": dict(form.table), "theme": self.theme, **self.view_options()}

    def solve(self, form: Form) -> None:
        """Solve a form in the process of the session; what was being solved is left."""
        case = form.check(self.session.folder).case
        if case is None:
            if isinstance(self.left, CaseForm):
                self.left.check()
            return
        self.start(form, unsolved_sentence(case))

    def start(self, form: Form, unsolved: str = "") -> None:
        """Begin to solve a form in place of what is being solved. unsolved: see `Run`."""
        if self._solving is not None:
            self._solving.cancel()
        self._solving = background_tasks.create(self._solve(form, unsolved))

    async def _solve(self, form: Form, unsolved: str) -> None:
        with self.client:
            run = self.session.new_run(form, self.name_of(form), self.address)
            run.unsolved = unsolved
            self.state("solving")
            self._cancel.props(remove="disabled")
            self.stage.text = "waiting for the process that solves"
            try:
                await self.session.stop(self.address)
                do, question = self.question_of(form)
                async for answer in self.session.ask(self.address, do, run=run.name, **question):
                    self._hear(run, answer)
            except EngineLost as error:
                if self.client.is_deleted:
                    self.session.runs.pop(run.name, None)
                    return
                # The process is ended where it does not stop of itself.
                self._failed(run, "cancelled" if self._solving is None else str(error))
            except asyncio.CancelledError:
                if not run.ready:
                    self.session.runs.pop(run.name, None)
                raise
            self._cancel.props("disabled")

    def _hear(self, run: Run, answer: Answer) -> None:
        """Show what the process says of a run. A tab that is closed has no place for it; the run is kept."""
        if self.client.is_deleted:
            run.ready = run.ready or "ready" in answer
            run.rows, run.warnings = answer.get("rows", run.rows), answer.get("warnings", run.warnings)
            run.allowed, run.card = answer.get("allowed", run.allowed), answer.get("card", run.card)
            return
        if "stage" in answer:
            self.stage.text = f"{answer['seconds']:.1f} s  {answer['stage']}"
        if "part" in answer:
            run.rows, run.warnings, run.card = answer["rows"], answer["warnings"], answer.get("card")
            self.now = run
            self.drawn(run, answer)
            self.compare_with_form()
            self.state("drawn", part=answer["part"], **{f"drawn-{answer['part']}": f"{answer['process']:.3f}"})
        if "ready" in answer:
            run.ready = True
            self._count += 1
            if isinstance(self.left, CaseForm):
                self.left.upload_solved()
            self.left.clear_problem()
            self.right.show(run, done=True)
            self.state("ready", ready=str(self._count), seconds=f"{answer['seconds']:.3f}",
                       process=f"{answer['process']:.3f}", run=run.name)  # fmt: skip
            self.stage.text = f"solved in {answer['seconds']:.1f} s"
            self.finished(run)
        if "done" in answer:
            run.allowed, run.card = answer.get("allowed", {}), answer.get("card", run.card)
            if self.now is run:
                self.right.show_allowed(run.allowed)
                self.right.show_card(run.card)
            self.state("done")
            self.settled(run)
        if "error" in answer:
            self._failed(run, answer["error"])
        if "stopped" in answer and not run.ready:
            self._failed(run, "cancelled")

    def _failed(self, run: Run, why: str) -> None:
        if not run.ready:
            self.session.runs.pop(run.name, None)
            self.state("cancelled" if why == "cancelled" else "failed")
            self.stage.text = why if why == "cancelled" else "not solved"
            if why != "cancelled":
                why = self.session.in_words(why.removeprefix("case: "))
                if isinstance(self.left, CaseForm) and self.left.upload_failed():
                    why = f"{why.rstrip('.')}. The case keeps what it had before."
                self.left.show_problem(why)
        self._cancel.props("disabled")
        self.left_undone()

    async def cancel(self) -> None:
        """Leave what is being solved, or waits to be."""
        solving, self._solving = self._solving, None
        if solving is None or solving.done():
            return
        self.stage.text = "cancelling"
        await self.session.stop(self.address)
        solving.cancel()
        await asyncio.wait([solving])
        self.stage.text = "cancelled"
        self._cancel.props("disabled")
        # A run that was ready before its slices were cut stays; so does what another click began meanwhile.
        if self._solving is None and self._root.props.get("data-state") in ("solving", "drawn", "failed"):
            self.state("cancelled")
        self.left_undone()

    # Asking for figures, and taking home.

    async def last(self, do: str, **question: object) -> Answer:
        """The last answer of the process; what is wrong is said on the page."""
        with self.client:
            try:
                answer = await self.session.last(self.address, do, **question)
            except EngineLost as error:
                answer = {"error": str(error)}
            if "error" in answer:
                self.left.show_problem(answer["error"])
            return answer

    def take_home(self, kind: str) -> None:
        """Give the case as TOML or Python."""
        form = self.now.form if self.now is not None and self.now.form is not None else self.form
        toml = self.session.to_toml(form)
        with self.client:
            if kind == "toml":
                ui.download.content(toml, "case.toml", "application/toml")
            else:
                program = case_as_python(Case.from_text(toml))
                self.right.show_program(program)
                call_script("treadloadCopy", program)
