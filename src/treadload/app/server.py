"""The server: routes and sockets behind the guard, a session for each browser, and their processes."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import sys
import webbrowser
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path

from fastapi import Request
from fastapi.responses import FileResponse, PlainTextResponse, Response
from nicegui import Client, app, background_tasks, core, ui
from nicegui.client import templates
from nicegui.server import Server

from treadload.app.connections import Impatient
from treadload.app.engines import EngineLost, Engines
from treadload.app.export_files import KINDS
from treadload.app.form import Form
from treadload.app.guard import SESSION, Guard, Keys, address_of
from treadload.app.links import Links
from treadload.app.page_frame import Page
from treadload.app.pages import LOOK, build, registered_pages
from treadload.app.policy import give_nonces
from treadload.app.service import Service
from treadload.app.sessions import TAB_GONE, Sessions
from treadload.errors import InputError
from treadload.plots.interactive import link_script

_ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32"><rect width="32" height="32" rx="6" fill="#14181d"/>'
    '<circle cx="16" cy="14" r="9" fill="none" stroke="#56b4e9" stroke-width="4"/>'
    '<path d="M3 27h26" stroke="#ff9d45" stroke-width="3"/></svg>'
)


def free_port(host: str, port: int) -> int:
    """The port, or a free one for 0. Raises InputError where it cannot be listened on."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        if sys.platform != "win32":
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except OSError as error:
            raise InputError(
                f"cannot listen on {host}, port {port}: {error.strerror or error}; give another --port"
            ) from error
        return int(probe.getsockname()[1])


def run(host: str, port: int, *, service: Service | None = None, open_browser: bool) -> None:
    """Serve until interrupted."""
    port = free_port(host, port)
    service = Service() if service is None else service
    proxy = service.proxy
    links = Links.begin(host, port, address_of(host, port) if proxy is None else proxy.address)
    try:
        _run(host, port, links, service, open_browser=open_browser and proxy is None)
    finally:
        links.end()


def _run(host: str, port: int, links: Links, service: Service, *, open_browser: bool) -> None:
    engines, proxy = Engines(service.limits), service.proxy
    sessions = Sessions(engines, links.folder)
    keys = Keys(host, port, links.use, sessions.end, _is_connected, proxy=proxy)
    forms, pages = FirstForms(), registered_pages()
    prepare(keys, sessions, forms, pages)

    async def ready() -> None:
        engines.warm()
        for command in dict.fromkeys(page.command for page in pages):
            background_tasks.create(forms.ready(command))
        background_tasks.create(announce())

    async def announce() -> None:
        # It begins a moment before it answers.
        while not Server.instance.started:
            await asyncio.sleep(0.01)
        print(f"treadload app: {links.new() if proxy is None else proxy.address}", flush=True)
        if open_browser:
            webbrowser.open(links.for_browser())

    def over() -> None:
        engines.close()
        sessions.close()
        # Here as well: a server that gets a signal ends by it once it has shut down.
        links.end()

    app.on_startup(ready)
    app.on_shutdown(over)
    _serve(host, port)


def _is_connected(page: str) -> bool:
    """True while the browser of a page holds its socket open."""
    client = Client.instances.get(page)
    return client is not None and client.has_socket_connection


def _serve(host: str, port: int) -> None:
    ui.run(
        host=host, port=port, show=False, reload=False, title="treadload", favicon=_ICON, dark=None,
        tailwind=False, show_welcome_message=False, language="en-US", reconnect_timeout=TAB_GONE, on_air=None,
        http=Impatient, proxy_headers=False, server_header=False, binding_refresh_interval=None, access_log=False,
        # On this machine it takes longer to pack than to send.
        gzip_middleware_factory=None, ws_per_message_deflate=False,
    )  # fmt: skip


class FirstForms:
    """What the first form of a command waits for, its schema and the units, read once while the browser opens."""

    def __init__(self) -> None:
        self._tasks: dict[str, asyncio.Task[object]] = {}
        self._turn = asyncio.Lock()

    async def ready(self, command: str) -> None:
        """Return once it is read; at once for "", which is no command."""
        if not command:
            return
        if command not in self._tasks:
            self._tasks[command] = asyncio.create_task(self._read(command))
        # A page that is closed meanwhile ends its wait, not the reading.
        await asyncio.shield(self._tasks[command])

    async def _read(self, command: str) -> None:
        # Two at once would read the same libraries twice.
        async with self._turn:
            await asyncio.to_thread(lambda: Form.first(command).parts(Path()))


def prepare(keys: Keys, sessions: Sessions, forms: FirstForms, pages: list[type[Page]]) -> None:
    """Put the pages and their guard into the application."""
    logging.getLogger("nicegui").setLevel(logging.ERROR)
    # A bar over the page at each upload, which has no name for who does not see it.
    app.config.quasar_config["loadingBar"]["skipHijack"] = True

    for kind in pages:
        _page(keys, sessions, forms, kind, pages)

    @app.get("/take/{run}/{kind}")
    async def take(request: Request, run: str, kind: str) -> Response:
        session = sessions.get(request.scope[SESSION])
        stored = None if session is None else session.runs.get(run)
        if session is None or stored is None or kind not in KINDS:
            return PlainTextResponse("treadload: this browser has no such result\n", status_code=404)
        try:
            answer = await session.last(stored.page, "export", run=run, kind=kind)
        except EngineLost as error:
            return PlainTextResponse(f"treadload: {error}\n", status_code=503)
        if "file" not in answer:
            return PlainTextResponse(f"treadload: {answer.get('error', 'stopped')}\n", status_code=422)
        path = (session.folder / answer["file"]).resolve()
        if path.parent != session.folder.resolve():
            return PlainTextResponse("treadload: no such file\n", status_code=404)
        return FileResponse(path, filename=f"treadload_{KINDS[kind]}", headers={"cache-control": "no-store"})

    @app.get("/link.js")
    async def link() -> Response:
        return Response(link_script(), media_type="text/javascript", headers={"cache-control": "no-cache"})

    app.add_static_files("/look", LOOK, max_cache_age=0)
    give_nonces(templates.env.loader)
    _keep_events_in_session(keys)
    _around_everything(keys)


def _page(keys: Keys, sessions: Sessions, forms: FirstForms, kind: type[Page], pages: list[type[Page]]) -> None:
    """A page at its address, for tabs of whoever asks."""

    @ui.page(kind.address, title=f"treadload, {kind.title}", response_timeout=30.0)
    async def page_of(request: Request) -> None:
        await forms.ready(kind.command)
        name, client = request.scope[SESSION], ui.context.client
        session, left = sessions.tab(name)
        keys.owners[client.id] = name

        def gone() -> None:
            keys.owners.pop(client.id, None)
            left()

        client.on_delete(gone)
        build(session, kind, pages)


def _around_everything(keys: Keys) -> None:
    """The guard as the outermost layer: nicegui adds its own when it starts, and the last one added is outermost."""
    built = app.build_middleware_stack

    def guarded() -> Guard:
        return Guard(built(), keys)

    app.build_middleware_stack = guarded  # type: ignore[method-assign]


Handler = Callable[..., object]


def _keep_events_in_session(keys: Keys) -> None:
    """Let a socket send events to pages of its session only."""
    for event in ("event", "javascript_response", "ack", "log", "handshake"):
        inner = core.sio.handlers["/"][event]

        def checked(sid: str, message: Mapping[str, object], inner: Handler = inner) -> object:
            with contextlib.suppress(KeyError, TypeError):
                session = core.sio.get_environ(sid)["asgi.scope"][SESSION]
                if keys.may_use(str(message["client_id"]), session):
                    return inner(sid, message)
            return False

        async def waited(sid: str, message: Mapping[str, object], checked: Handler = checked) -> object:
            answer = checked(sid, message)
            return await answer if isinstance(answer, Awaitable) else answer

        core.sio.on(event, waited)
