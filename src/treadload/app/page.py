"""The pages of a session, put on a tab."""

from __future__ import annotations

from pathlib import Path

from nicegui import background_tasks, ui

from treadload.app.bench import Bench
from treadload.app.life import LifePage
from treadload.app.session import Session
from treadload.app.study import StudyPage
from treadload.app.tab import Tab

# The shell is there before any script has run, and goes when the page stands. Plotly brings a style sheet for maps of
# the earth unless an element of that name is there; none is drawn here.
_SHELL = """
<div id="shell" aria-hidden="true"><div class="bar"><b>treadload</b></div></div>
<template id="8431bff7cc77ea8693f8122c6e0981316b936a0a4930625e08b1512d134062bc"></template>
<script src="/link.js"></script><script type="module" src="/look/bench.js"></script>
"""
LOOK = Path(__file__).parent / "look"
KINDS_OF_PAGES: tuple[type[Tab], ...] = (Bench, LifePage, StudyPage)
"""One class for each page."""


def build(session: Session, kind: type[Tab]) -> None:
    """Put a page of a session on one of its tabs."""
    ui.add_head_html('<link rel="stylesheet" href="/look/bench.css">')
    ui.add_body_html(_SHELL)
    tab = kind(session)
    tab.build()
    background_tasks.create(tab.begin())
