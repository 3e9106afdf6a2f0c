"""Who may speak to the page: one layer around every route and socket.

A token in the first address is good for one visit and is exchanged for a cookie that names a session of one browser,
see `links`. Everything else is refused with a sentence: another host name (a page elsewhere that was made to resolve
to this machine), another origin (a page elsewhere that calls this one), no cookie, a page of another session, too
many bytes. Behind a proxy with authentication, see `service`, the session belongs to the user that the proxy states,
and no token is needed.
"""

from __future__ import annotations

import asyncio
import hmac
import re
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

from treadload.app.links import sent_on
from treadload.app.policy import NONCE, headers_of, new_nonce
from treadload.app.service import SECRET_HEADER, Proxy

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Asgi = Callable[[Scope, Receive, Send], Awaitable[None]]

MOST_UPLOADED = 64 * 2**20
"""Bytes of a file that is uploaded."""
MOST_SENT = 2**20
"""Bytes of any other request."""
SESSION = "treadload.session"
"""Key of a request's scope under which its session stands."""
HEALTH = "/health"
"""Address that answers anybody whether the server runs."""
PREFIX = "x-forwarded-prefix"
"""Header of the path below which the page lies, which the framework reads; the guard alone sets it."""

# Of one server; the one that was not seen for longest goes for another.
_MOST_SESSIONS = 32
# How long a caller may take for the next part of what it sends, s.
_PATIENCE = 30.0
# What a form adds around a file.
_AROUND = 2**16
_CLIENT = re.compile(r"^/_nicegui/client/([^/]+)/")
_UPLOAD = re.compile(r"^/_nicegui/client/[^/]+/upload/[0-9]+$")
_SOCKET = "/_nicegui_ws/"
# Addresses that are parts of a page, not pages.
_PARTS = ("/_nicegui", "/take/", "/look/", "/link.js")
_ENTER = (
    "open the address that `treadload app` printed when it started; its token is good for one visit, and "
    "`treadload app --new-link`, on the machine of the server, prints another"
)


@dataclass
class Keys:
    """What opens one server: its addresses, the names it answers to, and the browsers that came by an address.

    host: that it listens on. opens: says once of a token that it opens this server. evicted: called with the name of
    a session that goes for another. connected: whether the browser of a page is connected now. sessions: secret of a
    cookie → name of the session, the one seen last at the end. owners: page of a browser → session. proxy: in front
    of the server, None for browsers that come by a token. users: session → user that the proxy stated.
    """

    host: str
    port: int
    opens: Callable[[str], bool] = field(repr=False)
    evicted: Callable[[str], Any] = field(default=lambda name: None, repr=False)
    connected: Callable[[str], bool] = field(default=lambda page: True, repr=False)
    sessions: dict[str, str] = field(default_factory=dict, repr=False)
    owners: dict[str, str] = field(default_factory=dict, repr=False)
    proxy: Proxy | None = None
    users: dict[str, str] = field(default_factory=dict, repr=False)

    @property
    def cookie(self) -> str:
        """Name of the cookie; a browser sends those of one host to all its ports."""
        return f"treadload_{self.port}"

    @property
    def hosts(self) -> frozenset[str]:
        """Values of the header Host that are answered, in small letters."""
        if self.proxy is not None:
            return frozenset({self.proxy.host})
        names = {"127.0.0.1", "localhost", "[::1]"}
        if self.host not in ("0.0.0.0", "::"):
            names.add(f"[{self.host}]" if ":" in self.host else self.host.lower())
        ports = {f"{name}:{self.port}" for name in names}
        return frozenset(ports | names if self.port == 80 else ports)

    @property
    def origins(self) -> frozenset[str]:
        """Values of the header Origin that are answered, in small letters."""
        if self.proxy is not None:
            return frozenset({self.proxy.origin})
        return frozenset(f"http://{host}" for host in self.hosts)

    def enter(self, user: str = "") -> str:
        """The secret of a new session. user: that the proxy states, "" without a proxy."""
        secret = secrets.token_urlsafe(32)
        self.sessions[secret] = secrets.token_hex(8)
        self.users[self.sessions[secret]] = user
        while len(self.sessions) > _MOST_SESSIONS:
            # One whose browser is connected goes only where all are. A page is owned for a while after its browser
            # has left, and one that has just come has no page yet: it goes after those that have left.
            earlier = list(self.sessions.items())[:-1]
            here = {name for page, name in self.owners.items() if self.connected(page)}
            gone = next((secret for secret, name in earlier if name not in here), earlier[0][0])
            name = self.sessions.pop(gone)
            self.users.pop(name, None)
            self.owners = {page: owner for page, owner in self.owners.items() if owner != name}
            self.evicted(name)
        return secret

    def cookie_of(self, secret: str) -> str:
        """The cookie that carries the secret of a session.

        Behind a proxy a visit may begin on the page that asks for the password, on another host: a cookie of the
        strictest kind would be withheld there. Requests that change something have to come from the page either way.
        """
        if self.proxy is None:
            return f"{self.cookie}={secret}; Path=/; HttpOnly; SameSite=Strict"
        secure = "; Secure" if self.proxy.origin.startswith("https:") else ""
        return f"{self.cookie}={secret}; Path={self.proxy.base or '/'}; HttpOnly; SameSite=Lax{secure}"

    def session_of(self, cookies: str, user: str = "") -> str | None:
        """Name of the session whose secret is among the cookies of a request of this user."""
        try:
            jar = SimpleCookie(cookies)
        except CookieError:
            return None
        morsel = jar.get(self.cookie)
        if morsel is None:
            return None
        secret = next((secret for secret in self.sessions if _same(secret, morsel.value)), None)
        if secret is None or self.users.get(self.sessions[secret], "") != user:
            return None
        name = self.sessions[secret] = self.sessions.pop(secret)
        return name

    def is_owned(self, client: str) -> bool:
        """True for a page that is there."""
        return client in self.owners

    def may_use(self, client: str, session: str) -> bool:
        """True where a page belongs to a session."""
        owner = self.owners.get(client)
        return owner is not None and hmac.compare_digest(owner, session)


def address_of(host: str, port: int) -> str:
    """Where the page of a server is, for a browser on its machine."""
    shown = "127.0.0.1" if host in ("0.0.0.0", "::") else host
    shown = f"[{shown}]" if ":" in shown else shown
    return f"http://{shown}:{port}/"


def _same(secret: str, reference: str) -> bool:
    return hmac.compare_digest(secret.encode(), reference.encode("utf-8", "replace"))


@dataclass(frozen=True)
class Refusal:
    """Why a request is not answered."""

    status: int
    why: str


class Guard:
    """The layer, as ASGI. app: what it protects."""

    def __init__(self, app: Asgi, keys: Keys) -> None:
        self._app, self._keys = app, keys

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, refuse, or hand on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        if scope["type"] == "http" and scope["path"] == HEALTH:
            await _answer(send, Refusal(200, "the page is served"))
            return
        proxy = self._keys.proxy
        if proxy is not None and scope["type"] == "http" and scope["path"] == proxy.base != "":
            await _move(send, f"{proxy.base}/")
            return
        request = _Request(_without_prefix(scope)) if proxy is None else _from_proxy(scope, proxy)
        if isinstance(request, Refusal):
            await _refuse(scope, receive, send, request)
            return
        scope = request.scope
        session = self._keys.session_of(_header(scope, "cookie"), request.user)
        refused = self._wrong_caller(scope)
        new_cookie: list[tuple[bytes, bytes]] = []
        if refused is None and proxy is not None and session is None and _is_page(scope):
            secret = self._keys.enter(request.user)
            session = self._keys.sessions[secret]
            new_cookie = [(b"set-cookie", self._keys.cookie_of(secret).encode())]
        if refused is None and proxy is None and scope["type"] == "http" and scope["path"] == "/":
            token = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token")
            if token is not None:
                await self._enter(scope, token[-1], session, send)
                return
        if refused is None:
            refused = self._wrong_session(scope, session)
        if refused is not None:
            await _refuse(scope, receive, send, refused)
            return
        scope[SESSION] = session
        if scope["type"] == "http":
            scope[NONCE] = new_nonce()
            extra = headers_of(scope[NONCE], self._socket_origin(scope)) + new_cookie
            await self._app(scope, _Counted(receive, _most(scope["path"])), _with_headers(send, extra))
        else:
            await self._app(scope, receive, send)

    def _socket_origin(self, scope: Scope) -> str:
        """Scheme and host of the page's socket, as its browser knows them."""
        proxy = self._keys.proxy
        return f"ws://{_header(scope, 'host')}" if proxy is None else proxy.origin.replace("http", "ws", 1)

    def _wrong_caller(self, scope: Scope) -> Refusal | None:
        """What is wrong with host, origin or size, before anybody is asked for."""
        keys = self._keys
        hosts = [value.lower() for name, value in _headers(scope) if name == "host"]
        if len(hosts) != 1 or hosts[0] not in keys.hosts:
            return Refusal(421, f"this server answers to {', '.join(sorted(keys.hosts))} only, got {hosts}")
        origins = [value.lower() for name, value in _headers(scope) if name == "origin"]
        if any(origin not in keys.origins for origin in origins):
            return Refusal(403, f"a page of another origin may not call this one, got {origins}")
        reads = scope["type"] == "http" and scope["method"] in ("GET", "HEAD")
        if not reads and not origins:
            return Refusal(403, "a request that changes something, or a socket, has to name its origin")
        site, mode = _header(scope, "sec-fetch-site"), _header(scope, "sec-fetch-mode")
        if site in ("cross-site", "same-site") and mode != "navigate":
            return Refusal(403, "a page elsewhere may not read from this one")
        length = _header(scope, "content-length")
        most = _most(scope["path"])
        if length and (not length.isascii() or not length.isdigit() or int(length) > most):
            return Refusal(413, _too_long(most))
        return None

    def _wrong_session(self, scope: Scope, session: str | None) -> Refusal | None:
        if session is None:
            proxy = self._keys.proxy
            return Refusal(403, _ENTER if proxy is None else f"open {proxy.address} in a browser that keeps cookies")
        client = _CLIENT.match(scope["path"])
        named = [client[1]] if client else []
        if scope["path"].startswith(_SOCKET):
            query = parse_qs(scope.get("query_string", b"").decode("latin-1"))
            # Nobody has the page of a tab that was away too long: the handshake fails, and the tab loads it again.
            named += [name for name in query.get("client_id", []) if self._keys.is_owned(name)]
        if any(not self._keys.may_use(name, session) for name in named):
            return Refusal(403, "this page belongs to another browser, or the server was restarted; load it again")
        return None

    async def _enter(self, scope: Scope, token: str, session: str | None, send: Send) -> None:
        """Exchange the token for a cookie, and send the browser to the address without it."""
        if scope["method"] != "GET" or "prefetch" in _header(scope, "sec-purpose"):
            await _answer(send, Refusal(503, "this address is good for one visit, and this is none"))
            return
        if not self._keys.opens(token) and session is None:
            why = "this is no token of this server, or it was used before"
            await _answer(send, Refusal(403, f"{why}; {_ENTER}"))
            return
        # A page of this server has to send the browser on: a cookie of the strictest kind is withheld from all
        # redirections of a visit that began elsewhere, as it does in the file that the browser is opened with.
        body = sent_on("/").encode()
        headers = [(b"content-type", b"text/html; charset=utf-8"), (b"cache-control", b"no-store")]
        headers.append((b"content-length", str(len(body)).encode()))
        if session is None:
            headers.append((b"set-cookie", self._keys.cookie_of(self._keys.enter()).encode()))
        await send({"type": "http.response.start", "status": 200, "headers": headers + headers_of()})
        await send({"type": "http.response.body", "body": body})


@dataclass(frozen=True)
class _Request:
    """A request as the page behind the guard is asked. user: that the proxy states, "" without a proxy."""

    scope: Scope
    user: str = ""


def _from_proxy(scope: Scope, proxy: Proxy) -> _Request | Refusal:
    """A request of the proxy, below the path of the page, or why it is not answered."""
    if not proxy.proves(_header(scope, SECRET_HEADER)):
        return Refusal(403, f"this server answers its proxy only; open {proxy.address}")
    users = [value.strip() for name, value in _headers(scope) if name == proxy.user_header]
    if len(users) != 1 or not users[0]:
        return Refusal(401, f"the proxy has to state one user in the header {proxy.user_header}, got {len(users)}")
    path, base = str(scope["path"]), proxy.base
    if not path.startswith(f"{base}/"):
        return Refusal(404, f"the page is at {proxy.address}")
    hidden = (SECRET_HEADER.encode(), PREFIX.encode())
    headers = [header for header in scope["headers"] if header[0].lower() not in hidden]
    headers.append((PREFIX.encode(), base.encode()))
    below = {name: value for name, value in scope.items() if name != "raw_path"}
    return _Request({**below, "path": path[len(base) :], "headers": headers}, users[0])


def _without_prefix(scope: Scope) -> Scope:
    """A request without the header by which a caller could move the addresses on a page."""
    kept_headers = [header for header in scope.get("headers", ()) if header[0].lower() != PREFIX.encode()]
    return {**scope, "headers": kept_headers}


def _is_page(scope: Scope) -> bool:
    """True where a browser opens a page."""
    return scope["type"] == "http" and scope["method"] == "GET" and not scope["path"].startswith(_PARTS)


class _Counted:
    """The body of a request, as long as it stays below a bound and goes on coming; else the caller is gone."""

    def __init__(self, receive: Receive, most: int) -> None:
        self._receive, self._most, self._seen, self._more = receive, most, 0, True

    async def __call__(self) -> Message:
        try:
            # Once all of it is there, this waits for the caller to leave.
            message = await asyncio.wait_for(self._receive(), _PATIENCE if self._more else None)
        except TimeoutError:
            return {"type": "http.disconnect"}
        self._more = bool(message.get("more_body"))
        self._seen += len(message.get("body", b""))
        return message if self._seen <= self._most else {"type": "http.disconnect"}


def _most(path: str) -> int:
    return MOST_UPLOADED + _AROUND if _UPLOAD.match(path) else MOST_SENT


def _too_long(most: int) -> str:
    return f"this is more than {most // 2**20} MB, which is the most that this server takes at once"


def _headers(scope: Scope) -> list[tuple[str, str]]:
    return [(name.decode("latin-1").lower(), value.decode("latin-1")) for name, value in scope.get("headers", ())]


def _header(scope: Scope, wanted: str) -> str:
    joint = "; " if wanted == "cookie" else ", "
    return joint.join(value for name, value in _headers(scope) if name == wanted)


def _with_headers(send: Send, extra: list[tuple[bytes, bytes]]) -> Send:
    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            kept_headers = [
                header
                for header in message.get("headers", ())
                if not header[0].lower().startswith(b"access-control-")
            ]
            message = {**message, "headers": [*kept_headers, *extra]}
        await send(message)

    return sent


async def _refuse(scope: Scope, receive: Receive, send: Send, refusal: Refusal) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": refusal.why[:120]})
        return
    await _answer(send, refusal)


async def _move(send: Send, address: str) -> None:
    """Links of a page are relative, and a path that lacks its last stroke would lead them astray."""
    headers = [(b"location", address.encode()), (b"content-length", b"0"), *headers_of()]
    await send({"type": "http.response.start", "status": 308, "headers": headers})
    await send({"type": "http.response.body", "body": b""})


async def _answer(send: Send, refusal: Refusal) -> None:
    body = f"treadload: {refusal.why}\n".encode()
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"cache-control", b"no-store")]
    headers += [(b"content-length", str(len(body)).encode()), (b"connection", b"close")]
    await send({"type": "http.response.start", "status": refusal.status, "headers": headers + headers_of()})
    await send({"type": "http.response.body", "body": body})
