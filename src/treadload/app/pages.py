"""The pages that are served: ours and those of other packages, and the sentence in place of one that is broken."""

from __future__ import annotations

import re
from pathlib import Path
from typing import ClassVar

from nicegui import background_tasks, ui

from treadload.app.basins_page import BasinsPage
from treadload.app.contact_page import ContactPage
from treadload.app.life_page import LifePage
from treadload.app.network_page import NetworkPage
from treadload.app.page_frame import Page
from treadload.app.session import Session
from treadload.app.study_page import StudyPage
from treadload.errors import InputError
from treadload.registry import PAGES

# Addresses on a page are relative: a proxy may put the pages below a path of its own.
# The shell is there before any script has run, and goes when the page stands. Plotly brings a style sheet for maps of
# the earth unless an element of that name is there; none is drawn here.
_SHELL = """
<div id="shell" aria-hidden="true"><div class="bar"><b>treadload</b></div></div>
<template id="8431bff7cc77ea8693f8122c6e0981316b936a0a4930625e08b1512d134062bc"></template>
<script src="./link.js"></script><script type="module" src="./look/bench.js"></script>
"""
OURS: tuple[type[Page], ...] = (ContactPage, LifePage, StudyPage, NetworkPage, BasinsPage)
LOOK = Path(__file__).parent / "look"
_ADDRESS = re.compile("/[a-z0-9-]*")
# Addresses of the server that are no pages.
_TAKEN = ("/take", "/look", "/health")


class BrokenPage(Page):
    """What is shown in place of a page whose package cannot be loaded. problem: a sentence that names it."""

    problem: ClassVar[str] = ""

    def inside(self) -> None:
        """The sentence."""
        ui.label(self.problem).classes("problem").props('role="alert" id="broken"')


def registered_pages() -> list[type[Page]]:
    """All pages, ours first; a broken one as a page that says why."""
    pages: list[type[Page]] = []
    try:
        names = PAGES.names()
    except InputError as error:
        # Two have one name: none of another package is served.
        return [*OURS, _broken("pages", str(error))]
    for name in names:
        try:
            pages.append(_checked(name, {page.address for page in pages}))
        except InputError as error:
            pages.append(_broken(name, str(error)))
    # Ours in their order, those of other packages behind them, broken ones last.
    place = {page: number for number, page in enumerate(OURS)}
    return sorted(pages, key=lambda page: (issubclass(page, BrokenPage), place.get(page, len(OURS))))


def _checked(name: str, taken: set[str]) -> type[Page]:
    entry = PAGES.find(name)
    kind = entry.target
    if not (isinstance(kind, type) and issubclass(kind, Page)):
        raise InputError(f"the page {name!r} of {entry.package} must be a class of treadload.app.page_frame.Page")
    if not _ADDRESS.fullmatch(kind.address) or kind.address in (*taken, *_TAKEN):
        raise InputError(
            f'the page {name!r} of {entry.package} needs an address of its own, such as "/{name}", got '
            f"{kind.address!r}"
        )
    return kind


def _broken(name: str, problem: str) -> type[Page]:
    slug = re.sub("[^a-z0-9]+", "-", name.lower()).strip("-")
    about = {"address": f"/broken-{slug}", "title": f"{name[:40]} (broken)", "problem": problem}
    return type("BrokenPage", (BrokenPage,), about)


def build(session: Session, kind: type[Page], pages: list[type[Page]]) -> None:
    """Put a page of a session on one of its tabs."""
    ui.add_head_html('<link rel="stylesheet" href="./look/bench.css">')
    ui.add_body_html(_SHELL)
    page = kind(session)
    page.build({page.address: page.title for page in pages})
    background_tasks.create(page.begin())
