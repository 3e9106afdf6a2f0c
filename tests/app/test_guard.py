"""Who may speak to the page: each way around the guard is tried."""

import asyncio

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from treadload.app import guard
from treadload.app.guard import Guard, Keys

HERE = "http://127.0.0.1:8137"
WIRE = "ws://127.0.0.1:8137"


async def behind(scope, receive, send):
    """What the guard protects: says who asked, and reads the body of a request."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        await send({"type": "websocket.send", "text": scope[guard.SESSION]})
        return
    size = 0
    while True:
        message = await receive()
        if message["type"] == "http.disconnect":
            size = -1
            break
        size += len(message.get("body", b""))
        if not message.get("more_body"):
            break
    body = f"{scope[guard.SESSION]} {size}".encode()
    headers = [(b"access-control-allow-origin", b"*")]
    await send({"type": "http.response.start", "status": 200, "headers": headers})
    await send({"type": "http.response.body", "body": body})


class Tokens:
    """Tokens that open once."""

    def __init__(self):
        self.left, self.count = set(), 0

    def new(self):
        self.count += 1
        self.left.add(f"token{self.count}")
        return f"token{self.count}"

    def use(self, token):
        opens = token in self.left
        self.left.discard(token)
        return opens


@pytest.fixture
def tokens():
    return Tokens()


@pytest.fixture
def keys(tokens):
    return Keys("127.0.0.1", 8137, tokens.use)


def visitor(keys, **more):
    return TestClient(Guard(behind, keys), base_url=HERE, follow_redirects=False, **more)


def entered(keys):
    browser = visitor(keys)
    answer = browser.get(f"/?token={keys.opens.__self__.new()}")
    assert answer.status_code == 200
    assert "set-cookie" in answer.headers
    return browser


def test_a_token_opens_once_and_leaves_the_address(keys, tokens):
    browser, token = visitor(keys), tokens.new()
    answer = browser.get(f"/?token={token}")
    assert 'http-equiv="refresh" content="0;url=/"' in answer.text
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert token not in cookie + answer.text
    assert answer.headers["cache-control"] == "no-store"
    first = browser.get("/").text
    # Who comes with it again stays who they are; for another browser it is void, and the remedy is told.
    again = browser.get(f"/?token={token}")
    assert again.status_code == 200
    assert "set-cookie" not in again.headers
    assert browser.get("/").text == first
    stranger = visitor(keys).get(f"/?token={token}")
    assert stranger.status_code == 403
    assert "set-cookie" not in stranger.headers
    assert "treadload app --new-link" in stranger.text
    assert entered(keys).get("/").text != first


def test_what_looks_ahead_does_not_use_a_token(keys, tokens):
    """A browser that fetches what might be opened, or a check whether a link is good."""
    token = tokens.new()
    assert visitor(keys).head(f"/?token={token}").status_code == 503
    ahead = visitor(keys).get(f"/?token={token}", headers={"sec-purpose": "prefetch;prerender"})
    assert ahead.status_code == 503
    assert visitor(keys).get(f"/?token={token}").status_code == 200


def test_the_session_that_was_not_seen_for_longest_goes_for_another(keys, monkeypatch):
    gone = []
    monkeypatch.setattr(guard, "_MOST_SESSIONS", 3)
    keys.evicted = gone.append
    browsers = [entered(keys) for _ in range(3)]
    names = [one.get("/").text.split()[0] for one in browsers]
    browsers[0].get("/")
    entered(keys)
    assert gone == [names[1]]
    assert [one.get("/").status_code for one in browsers] == [200, 403, 200]
    # One that has a page open goes last.
    keys.owners |= {"page-0": names[0]}
    entered(keys)
    assert gone[1] not in names
    entered(keys)
    entered(keys)
    assert names[0] not in gone
    assert browsers[0].get("/").status_code == 200


def test_who_has_just_come_is_not_evicted_for_pages_that_were_left(keys, monkeypatch):
    """A page is owned until its browser has been gone for 10 s; two who come at once meet a full server."""
    gone, connected = [], {"page-0"}
    monkeypatch.setattr(guard, "_MOST_SESSIONS", 3)
    keys.evicted, keys.connected = gone.append, connected.__contains__
    browsers = [entered(keys) for _ in range(3)]
    names = [one.get("/").text.split()[0] for one in browsers]
    keys.owners |= {f"page-{number}": name for number, name in enumerate(names)}
    first, second = entered(keys), entered(keys)
    assert gone == names[1:]
    assert [one.get("/").status_code for one in (browsers[0], first, second)] == [200, 200, 200]


@pytest.mark.parametrize(
    "path", ["/", "/take/abc/nc", "/_nicegui/x/static/nicegui.js", "/look/bench.js", "/?token=", "/?token=x"]
)
def test_without_the_token_there_is_nothing(keys, path):
    answer = visitor(keys).get(path)
    assert answer.status_code == 403
    assert "token" in answer.text
    assert "set-cookie" not in answer.headers


def test_a_made_up_cookie_opens_nothing(keys):
    browser = visitor(keys, cookies={keys.cookie: "guessed"})
    assert browser.get("/").status_code == 403
    assert visitor(keys, headers={"cookie": f"{keys.cookie}=x; ;;=;[]"}).get("/").status_code == 403


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8137", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8137.evil.example", ""]
)
def test_another_host_is_not_answered_even_with_the_token(keys, host):
    browser = entered(keys)
    for path in ("/", f"/?token={keys.opens.__self__.new()}"):
        answer = browser.get(path, headers={"host": host})
        assert answer.status_code == 421


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9999", "https://127.0.0.1:8137"])
def test_another_origin_is_not_answered(keys, origin):
    browser = entered(keys)
    assert browser.get("/", headers={"origin": origin}).status_code == 403
    assert browser.post("/_nicegui_ws/socket.io/", headers={"origin": origin}).status_code == 403
    with (
        pytest.raises(WebSocketDisconnect),
        browser.websocket_connect(f"{WIRE}/_nicegui_ws/socket.io/", headers={"origin": origin}),
    ):
        pass


def test_what_changes_something_names_its_origin(keys):
    browser = entered(keys)
    assert browser.post("/", content=b"x").status_code == 403
    assert browser.post("/", content=b"x", headers={"origin": HERE}).status_code == 200


def test_a_page_of_the_same_machine_does_not_read(keys):
    """Pages of other ports of this machine are of the same site, and cookies are sent with what they ask for."""
    browser = entered(keys)
    asked = {"sec-fetch-site": "same-site", "sec-fetch-mode": "no-cors"}
    assert browser.get("/take/x/nc", headers=asked).status_code == 403
    assert browser.get("/", headers={**asked, "sec-fetch-mode": "navigate"}).status_code == 200


def test_a_socket_needs_the_cookie_and_the_origin(keys):
    path = f"{WIRE}/_nicegui_ws/socket.io/?EIO=4"
    with (
        pytest.raises(WebSocketDisconnect) as refused,
        visitor(keys).websocket_connect(path, headers={"origin": HERE}),
    ):
        pass
    assert refused.value.code == 1008
    browser = entered(keys)
    with pytest.raises(WebSocketDisconnect), browser.websocket_connect(path):
        pass
    with browser.websocket_connect(path, headers={"origin": HERE}) as socket:
        assert socket.receive_text() in keys.sessions.values()


def test_the_pages_of_another_browser_are_out_of_reach(keys):
    one, other = entered(keys), entered(keys)
    keys.owners["page-of-one"] = one.get("/").text.split()[0]
    upload = "/_nicegui/client/page-of-one/upload/7"
    assert one.post(upload, content=b"x", headers={"origin": HERE}).status_code == 200
    assert other.post(upload, content=b"x", headers={"origin": HERE}).status_code == 403
    assert one.post("/_nicegui/client/unknown/upload/7", content=b"x", headers={"origin": HERE}).status_code == 403
    socket = f"{WIRE}/_nicegui_ws/socket.io/?client_id=page-of-one"
    with one.websocket_connect(socket, headers={"origin": HERE}) as mine:
        assert mine.receive_text() == keys.owners["page-of-one"]
    with pytest.raises(WebSocketDisconnect), other.websocket_connect(socket, headers={"origin": HERE}):
        pass
    # A page that was given up while its tab was away: the socket opens, its handshake fails, and the tab loads anew.
    with one.websocket_connect(socket.replace("page-of-one", "gone"), headers={"origin": HERE}) as late:
        assert late.receive_text() == keys.owners["page-of-one"]


def test_what_is_sent_is_bounded(keys, monkeypatch):
    monkeypatch.setattr(guard, "MOST_UPLOADED", 1000)
    monkeypatch.setattr(guard, "_AROUND", 0)
    monkeypatch.setattr(guard, "MOST_SENT", 100)
    browser = entered(keys)
    name = browser.get("/").text.split()[0]
    keys.owners["p"] = name
    upload, origin = "/_nicegui/client/p/upload/7", {"origin": HERE}
    assert browser.post(upload, content=b"x" * 1000, headers=origin).text == f"{name} 1000"
    assert browser.post(upload, content=b"x" * 1001, headers=origin).status_code == 413
    assert browser.post("/", content=b"x" * 101, headers=origin).status_code == 413
    # Without a length said in advance the body is cut, and the caller taken for gone.
    assert browser.post(upload, content=iter([b"x" * 600, b"x" * 600]), headers=origin).text == f"{name} -1"
    assert browser.post(upload, content=b"x", headers={**origin, "content-length": "-1"}).status_code == 413


def test_every_answer_carries_its_policy(keys):
    browser = entered(keys)
    for answer in (browser.get("/"), visitor(keys).get("/"), browser.get("/", headers={"host": "x"})):
        assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
        assert answer.headers["x-content-type-options"] == "nosniff"
        # No page elsewhere is told that it may read.
        assert "access-control-allow-origin" not in answer.headers


def test_a_server_for_others_answers_to_its_name():
    keys = Keys("192.0.2.7", 80, lambda token: False)
    assert {"192.0.2.7", "192.0.2.7:80", "127.0.0.1:80"} <= keys.hosts
    assert guard.address_of("::1", 5) == "http://[::1]:5/"
    assert guard.address_of("0.0.0.0", 5) == "http://127.0.0.1:5/"
    secret = keys.enter()
    assert secret not in repr(keys)


def test_the_guard_lets_the_server_begin_and_end(keys):
    seen = []

    async def inner(scope, receive, send):
        seen.append(scope["type"])

    asyncio.run(Guard(inner, keys)({"type": "lifespan"}, None, None))
    assert seen == ["lifespan"]


def test_a_body_that_stops_coming_is_given_up(keys, monkeypatch):
    monkeypatch.setattr(guard, "_PATIENCE", 0.05)
    said = []

    async def receive():
        if not said:
            said.append("begun")
            return {"type": "http.request", "body": b"x", "more_body": True}
        await asyncio.sleep(60)

    body = guard._Counted(receive, 100)
    assert asyncio.run(_read(body)) == ["http.request", "http.disconnect"]


def test_what_waits_for_the_caller_to_leave_may_wait(keys, monkeypatch):
    monkeypatch.setattr(guard, "_PATIENCE", 0.01)
    messages = [{"type": "http.request", "body": b"x"}, {"type": "http.disconnect"}]

    async def receive():
        await asyncio.sleep(0 if len(messages) > 1 else 0.1)
        return messages.pop(0)

    body = guard._Counted(receive, 100)
    assert asyncio.run(_read(body)) == ["http.request", "http.disconnect"]
    assert not messages


async def _read(body):
    return [(await body())["type"], (await body())["type"]]
