"""The sessions of a server: one for each browser, as long as it has a tab, and a minute more."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from treadload.app.engines import Engines
from treadload.app.session import Session

TAB_GONE = 20.0
"""How long the tab of a lost connection is waited for, s; two fifths of it for an answer on a busy machine."""
LINGERS = 60.0
"""How long a session outlasts the connection of its last tab, s."""


class Sessions:
    """Sessions by the names that the guard gives them.

    engines: where they take their processes from. folder: in which each gets a private one. A session whose last tab
    is gone, and does not come again within `lingers` s, ends: with its processes, its results and its files.
    """

    def __init__(self, engines: Engines, folder: Path, *, lingers: float = LINGERS) -> None:
        self._engines, self._folder, self._lingers = engines, folder, lingers
        self._sessions: dict[str, Session] = {}
        self._tabs: dict[str, int] = {}
        self._ending: dict[str, asyncio.TimerHandle] = {}

    def __len__(self) -> int:
        return len(self._sessions)

    def get(self, name: str) -> Session | None:
        """The session of a name, where it has begun and not ended."""
        return self._sessions.get(name)

    def tab(self, name: str) -> tuple[Session, Callable[[], None]]:
        """The session of a name for a tab that opens, and what to call when the tab is gone."""
        if name not in self._sessions:
            folder = Path(tempfile.mkdtemp(prefix="session-", dir=self._folder))
            self._sessions[name] = Session(self._engines, folder)
        session = self._sessions[name]
        self._tabs[name] = self._tabs.get(name, 0) + 1
        self._stay(name)
        gone = False

        def left() -> None:
            nonlocal gone
            if gone or self._sessions.get(name) is not session:
                return
            gone = True
            self._tabs[name] -= 1
            if not self._tabs[name]:
                wait = max(0.0, self._lingers - TAB_GONE)
                self._ending[name] = asyncio.get_running_loop().call_later(wait, self.end, name)

        return session, left

    def end(self, name: str) -> None:
        """End a session."""
        self._stay(name)
        self._tabs.pop(name, None)
        session = self._sessions.pop(name, None)
        if session is not None:
            session.close()
            # A process that was writing may have put a file back.
            again = asyncio.get_running_loop().call_later
            again(1.0, lambda: shutil.rmtree(session.folder, ignore_errors=True))

    def close(self) -> None:
        """End all of them."""
        for name in list(self._sessions):
            self.end(name)

    def _stay(self, name: str) -> None:
        timer = self._ending.pop(name, None)
        if timer is not None:
            timer.cancel()
