"""The page behind a proxy: whom the guard lets in, what a service file may say, and limits of solving processes."""

import asyncio

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect
from test_guard import behind

from treadload.app.engines import Engine, EngineLost
from treadload.app.guard import Guard, Keys
from treadload.app.service import Limits, Proxy, Service
from treadload.errors import InputError
from treadload.files import parse_toml
from treadload.templates import first_case

ADDRESS, SECRET = "https://lab.example/roads/treadload/", "s" * 32
BASE = "/roads/treadload"
ANNA = {"x-treadload-proxy": SECRET, "x-remote-user": "anna"}
BERT = ANNA | {"x-remote-user": "bert"}


@pytest.fixture
def keys():
    proxy = Proxy(ADDRESS, "x-remote-user", SECRET)
    return Keys("127.0.0.1", 8137, lambda token: False, proxy=proxy)


def browser(keys, app=behind):
    return TestClient(Guard(app, keys), base_url="https://lab.example", follow_redirects=False)


def test_the_proxy_states_the_user_and_no_token_is_needed(keys):
    visitor = browser(keys)
    answer = visitor.get(f"{BASE}/", headers=ANNA)
    assert answer.status_code == 200
    cookie = answer.headers["set-cookie"]
    assert f"Path={BASE}" in cookie
    for part in ("Secure", "HttpOnly", "SameSite=Lax"):
        assert part in cookie
    assert "wss://lab.example;" in answer.headers["content-security-policy"]
    again = visitor.get(f"{BASE}/life", headers=ANNA)
    assert again.text == answer.text
    assert "set-cookie" not in again.headers


def test_a_session_belongs_to_its_user(keys):
    """Another user of the same browser gets another session; the cookie of the first opens nothing for the second."""
    visitor = browser(keys)
    first = visitor.get(f"{BASE}/", headers=ANNA).text
    assert visitor.get(f"{BASE}/take/a/toml", headers=BERT).status_code == 403
    other = visitor.get(f"{BASE}/", headers=BERT)
    assert "set-cookie" in other.headers
    assert other.text != first


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"x-remote-user": "anna"}, 403),
        (ANNA | {"x-treadload-proxy": "s" * 31 + "t"}, 403),
        ({"x-treadload-proxy": SECRET}, 401),
        (ANNA | {"x-remote-user": " "}, 401),
        (ANNA | {"host": "127.0.0.1:8137"}, 421),
        (ANNA | {"origin": "https://elsewhere.example"}, 403),
    ],
)
def test_who_does_not_come_by_the_proxy_is_sent_away(keys, headers, status):
    answer = browser(keys).get(f"{BASE}/", headers=headers)
    assert answer.status_code == status
    assert "set-cookie" not in answer.headers
    assert SECRET not in answer.text


def test_two_headers_of_users_are_none(keys):
    """A proxy that adds its header to that of a visitor, in place of setting it, lets nobody in."""
    headers = [*ANNA.items(), ("x-remote-user", "root")]
    assert browser(keys).get(f"{BASE}/", headers=headers).status_code == 401


def test_paths_are_below_the_address(keys):
    visitor = browser(keys)
    moved = visitor.get(BASE, headers=ANNA)
    assert moved.status_code == 308
    assert moved.headers["location"] == f"{BASE}/"
    assert visitor.get("/", headers=ANNA).status_code == 404
    assert visitor.get(f"{BASE}more/", headers=ANNA).status_code == 404


def test_the_page_is_told_its_path_by_the_guard_alone(keys):
    async def shows(scope, receive, send):
        told = [value for name, value in scope["headers"] if name == b"x-forwarded-prefix"]
        seen = b" ".join([scope["path"].encode(), *told])
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": seen})

    sent = ANNA | {"x-forwarded-prefix": "/evil"}
    assert browser(keys, shows).get(f"{BASE}/life", headers=sent).text == f"/life {BASE}"
    # Without a proxy nobody moves the addresses of a page.
    plain = Keys("127.0.0.1", 8137, lambda token: True)
    visitor = TestClient(Guard(shows, plain), base_url="http://127.0.0.1:8137")
    visitor.get("/?token=t")
    assert visitor.get("/life", headers={"x-forwarded-prefix": "/evil"}).text == "/life"


def test_sockets_need_the_cookie_and_the_origin(keys):
    visitor = browser(keys)
    socket = f"{BASE}/_nicegui_ws/socket.io"
    with pytest.raises(WebSocketDisconnect), visitor.websocket_connect(socket, headers=ANNA):
        pass
    name = visitor.get(f"{BASE}/", headers=ANNA).text.split()[0]
    home = ANNA | {"origin": "https://lab.example"}
    with visitor.websocket_connect(f"wss://lab.example{socket}", headers=home) as wire:
        wire.send_text("")
        assert wire.receive_text() == name


def test_anybody_may_ask_whether_it_runs(keys):
    answer = TestClient(Guard(behind, keys), base_url="http://127.0.0.1:8137").get("/health")
    assert answer.status_code == 200
    assert "set-cookie" not in answer.headers


def written(folder, text, mode=0o600, secret=SECRET):
    (folder / "secret").write_text(f"{secret}\n")
    (folder / "secret").chmod(mode)
    (folder / "service.toml").write_text(text)
    return folder / "service.toml"


WHOLE = f'address = "{ADDRESS}"\nuser_header = "X-Remote-User"\nsecret_file = "secret"\n'


def test_a_service_file_names_proxy_and_limits(tmp_path):
    service = Service.from_toml(written(tmp_path, f'{WHOLE}memory_limit_mb = 2000\ntime_limit = "10 min"\n'))
    assert service.limits == Limits(2000, 600.0)
    assert service.proxy == Proxy(ADDRESS, "x-remote-user", SECRET)
    assert (service.proxy.host, service.proxy.base) == ("lab.example", BASE)
    assert Proxy("http://lab.example:8080", "user", SECRET).host == "lab.example:8080"
    assert SECRET not in repr(service)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ((ADDRESS, "lab.example"), "https://lab.example/treadload/"),
        ((ADDRESS, "https://lab.example/a b"), "letters, digits"),
        (("X-Remote-User", "X Remote"), "X-Remote-User"),
        (("X-Remote-User", "X-Treadload-Proxy"), "user_header"),
        (('"secret"', '"none"'), "cannot read"),
        (("user_header", "header"), "user_header"),
        (("secret_file", "memory_limit_mb = 500\nsecret_file"), "at least 1000, got 500"),
        (("secret_file", 'time_limit = "1 s"\nsecret_file'), "at least 5 s, got 1 s"),
    ],
)
def test_bad_service_files_are_refused(tmp_path, change, words):
    with pytest.raises(InputError, match=words) as error:
        Service.from_toml(written(tmp_path, WHOLE.replace(*change)))
    assert SECRET not in str(error.value)


def test_a_secret_is_long_and_private(tmp_path):
    with pytest.raises(InputError, match=r"needs 32 .*got 5"):
        Service.from_toml(written(tmp_path, WHOLE, secret="short"))
    with pytest.raises(InputError, match="chmod 600"):
        Service.from_toml(written(tmp_path, WHOLE, mode=0o644))


def solved(limits, folder, **changes):
    """The last answer of a process with limits to a first case."""

    async def ask():
        engine = await Engine.start(limits)
        try:
            await engine.last("folder", folder=str(folder))
            table = parse_toml(first_case("run"), "case") | changes
            return await engine.last("run", run="r1", table=table, theme="light", view={})
        finally:
            engine.kill()

    return asyncio.run(ask())


@pytest.mark.slow
def test_a_case_beyond_the_memory_is_an_error_and_not_the_end_of_the_machine(tmp_path):
    answer = solved(Limits(memory=1000), tmp_path, spacing="0.25 mm")
    assert "1000 MB" in answer["error"]
    assert "larger" in answer["error"]


@pytest.mark.slow
def test_a_case_beyond_the_time_ends_with_its_process(tmp_path):
    with pytest.raises(EngineLost, match=r"longer than 5 s.*larger cells"):
        solved(Limits(time=5.0), tmp_path, spacing="0.4 mm")
