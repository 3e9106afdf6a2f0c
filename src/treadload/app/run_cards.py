"""The runs of a session as cards, and which two of them are compared."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from nicegui import ui

from treadload.app.answers import PageRow
from treadload.app.elements import plain, text, with_attributes
from treadload.app.run_names import names_of
from treadload.app.session import Run, Session


@dataclass
class _Card:
    """What changes of a card: its picture, what is said of the run, which side it is on."""

    whole: Any
    picture: Any
    name: Any
    label: Any
    show: Any
    sides: dict[str, Any]


class RunCards:
    """Cards of the runs of a page. show: called with a run. compare: called with two; left out, none are compared.

    A card stays where it is while it changes: a click on one that is drawn anew would be lost.
    """

    def __init__(
        self,
        session: Session,
        page: str,
        show: Callable[[Run], object],
        compare: Callable[[Run, Run], object] | None = None,
    ) -> None:
        self._session, self._page, self._show, self._compare = session, page, show, compare
        self._pair: dict[str, Run] = {}
        self._cards: dict[str, _Card] = {}

    def build(self) -> None:
        """Put the empty list on the page."""
        self._runs = ui.element("div").classes("runs").props('id="runs" role="list" aria-label="runs"')

    def button(self) -> None:
        """Put the button that compares on the page."""
        self._go = plain("Compare A with B", self._both).props('id="compare" disabled')

    def list(self, now: Run | None) -> None:
        """List the runs that are solved, the newest first. now: that which is shown."""
        runs = {run.name: run for run in self._session.runs.values() if run.ready and run.page == self._page}
        for name in [name for name in self._cards if name not in runs]:
            self._cards.pop(name).whole.delete()
        titles = names_of(list(runs.values()), self._session.known_as)
        for name, run in runs.items():
            if name not in self._cards:
                with self._runs:
                    self._cards[name] = self._card(run)
                self._cards[name].whole.move(target_index=0)
            card = self._cards[name]
            self._named(card, run, titles[name])
            with_attributes(card.picture, data_theme=run.thumb_theme)
            if run.thumb and card.picture.props.get("src") != run.thumb:
                card.picture.props["src"] = run.thumb
                card.picture.update()
            card.picture.set_visibility(bool(run.thumb))
            card.label.set_text(_first(run.rows))
            shown = now is not None and name == now.name
            card.whole.classes(add="now" if shown else "", remove="" if shown else "now")

    def _card(self, run: Run) -> _Card:
        with ui.element("div").classes("run").props('role="listitem"') as whole:
            picture = ui.element("img").props('alt="pressure of this run"')
            with ui.element("div").classes("say"):
                name = text("b", "")
                label = text("span", "")
            with ui.element("div").classes("line"):
                show = plain("show", lambda: self._show(run))
                sides = {
                    side: plain(side, lambda side=side: self._choose(side, run))
                    for side in (("A", "B") if self._compare is not None else ())
                }  # fmt: skip
        return _Card(whole, picture, name, label, show, sides)

    def _named(self, card: _Card, run: Run, title: str) -> None:
        """Name a card by what sets its run apart from the others, which changes as others come."""
        run.title = title
        if card.name.text == title:
            return
        card.name.set_text(title)
        with_attributes(card.name, title=title)
        with_attributes(card.show, aria_label=f"show the run {title}").update()
        for side, button in card.sides.items():
            with_attributes(button, aria_label=f"take as {side} for a comparison, {title}").update()

    def _choose(self, side: str, run: Run) -> None:
        self._pair[side] = run
        for name, card in self._cards.items():
            chosen = name == run.name
            card.sides[side].classes(add="chosen" if chosen else "", remove="" if chosen else "chosen")
        if len(self._pair) == 2:
            self._go.props(remove="disabled")

    def _both(self) -> None:
        if len(self._pair) == 2 and self._compare is not None:
            self._compare(self._pair["A"], self._pair["B"])


# Rows on the card of a run.
_FIRST = ("largest_pressure", "worst_strain", "worst_passes", "governing", "governing_years")


def _first(rows: list[PageRow]) -> str:
    values = {row["key"]: row["value"] for row in rows}
    return ", ".join(values[key] for key in _FIRST if key in values)
