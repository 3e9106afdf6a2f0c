"""The pages of a session, put on a tab."""

from __future__ import annotations

from pathlib import Path

from nicegui import background_tasks, ui

from treadload.app.bench import Bench
from treadload.app.life import LifePage
from treadload.app.session import Session
from treadload.app.study import StudyPage
from treadload.app.tab import PAGES, Tab
from treadload.plots.interactive import link_script

LOOK = Path(__file__).parent / "look"
KINDS_OF_PAGES: tuple[type[Tab], ...] = (Bench, LifePage, StudyPage)
"""One class for each page."""


def build(session: Session, kind: type[Tab]) -> None:
    """Put a page of a session on one of its tabs."""
    ui.add_head_html('<link rel="stylesheet" href="/look/bench.css">')
    # The shell is there before any script has run, and goes when the page stands.
    ui.add_body_html(
        f'<div id="shell" aria-hidden="true"><div class="bar"><b>treadload, {PAGES[kind.address]}</b></div></div>'
        f"<script>{link_script()}</script><script type='module' src='/look/bench.js'></script>"
    )
    tab = kind(session)
    tab.build()
    background_tasks.create(tab.begin())
