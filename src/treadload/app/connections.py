"""Connections that say nothing: they are closed after a while, and a crowd of them at once, so that others get in."""

from __future__ import annotations

import asyncio
from typing import Any, ClassVar

from uvicorn.protocols.http.auto import AutoHTTPProtocol

PATIENCE = 10.0
"""How long a caller may take to send its request, s."""
MOST_WAITING = 64
"""Callers that have not sent a request yet; one more, and the one that waits longest is closed."""

_Base: Any = AutoHTTPProtocol


class Impatient(_Base):  # type: ignore[misc]
    """The protocol of the server, for callers whose request comes in time."""

    _waiting: ClassVar[dict[Impatient, asyncio.TimerHandle]] = {}

    def connection_made(self, transport: asyncio.Transport) -> None:
        """Somebody calls."""
        super().connection_made(transport)
        self._wait()

    def data_received(self, data: bytes) -> None:
        """A part of a request, or all of it."""
        super().data_received(data)
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            # A socket of the page has a patience of its own.
            self._on_message()
        elif self.cycle is None or self.cycle.response_complete:
            self._wait()
        else:
            self._on_message()

    def connection_lost(self, exc: Exception | None) -> None:
        """It is over."""
        self._on_message()
        super().connection_lost(exc)

    def timeout_keep_alive_handler(self) -> None:
        """Nothing more was asked for 5 s; a socket may have come on the last bytes of an answer, and stays."""
        if self.transport.get_protocol() is self:
            super().timeout_keep_alive_handler()

    def _wait(self) -> None:
        if self in self._waiting:
            return
        if len(self._waiting) >= MOST_WAITING:
            next(iter(self._waiting))._give_up()
        self._waiting[self] = asyncio.get_running_loop().call_later(PATIENCE, self._give_up)

    def _on_message(self) -> None:
        timer = self._waiting.pop(self, None)
        if timer is not None:
            timer.cancel()

    def _give_up(self) -> None:
        self._on_message()
        self.transport.abort()
