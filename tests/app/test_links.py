"""Addresses that let a browser in: each once, in files that nobody else reads, and another on request."""

import json
import os
import re
import socket
import tempfile
import time
from contextlib import closing
from pathlib import Path
from urllib.request import url2pathname

import pytest

from treadload.app import links as module
from treadload.app import new_link
from treadload.app.links import Links
from treadload.errors import InputError

posix = pytest.mark.skipif(os.name != "posix", reason="no such rights there")


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


@pytest.fixture
def port():
    """A port on which somebody answers."""
    with closing(socket.create_server(("127.0.0.1", 0))) as server:
        yield server.getsockname()[1]


def begun(port):
    return Links.begin("127.0.0.1", port, f"http://127.0.0.1:{port}/")


def token_of(address):
    return re.search(r"token=([\w-]{40,})", address)[1]


def test_an_address_is_good_once(port):
    links = begun(port)
    address = links.new()
    assert address.startswith(f"http://127.0.0.1:{port}/?token=")
    assert links.use(token_of(address))
    assert not links.use(token_of(address))
    assert not links.use("")
    assert not links.use("../server.json")
    assert (links.folder / "server.json").exists()


def test_an_address_that_nobody_uses_is_void_after_a_day(port):
    links = begun(port)
    token = token_of(links.new())
    old = time.time() - 25 * 3600
    os.utime(links._file(token), (old, old))
    assert not links.use(token)
    assert not links._file(token).exists()


@posix
def test_nobody_else_reads_what_lets_a_browser_in(port):
    links = begun(port)
    path = Path(url2pathname(links.for_browser().removeprefix("file://")))
    links.new()
    assert links.folder.stat().st_mode & 0o077 == 0
    files = [one for one in links.folder.rglob("*") if one.is_file()]
    assert len(files) == 4
    assert [one for one in files if one.stat().st_mode & 0o077] == []
    # The file of the browser sends it on, and goes with the first that came in.
    token = token_of(path.read_text())
    assert f'content="0;url=http://127.0.0.1:{port}/?token={token}"' in path.read_text()
    # Tokens stand in it and nowhere else.
    assert token not in "".join(one.name + one.read_text() for one in files if one != path)
    assert links.use(token)
    assert not path.exists()
    links.end()
    assert not links.folder.exists()


def test_another_address_on_request(port):
    links = begun(port)
    address = new_link()
    assert address == f"http://127.0.0.1:{port}/?token={token_of(address)}"
    assert links.use(token_of(address))
    assert new_link(port) != address


def test_a_new_address_needs_one_server(port):
    with pytest.raises(InputError, match=r"got 0; start one by `treadload app`"):
        new_link()
    begun(port)
    with closing(socket.create_server(("127.0.0.1", 0))) as second:
        other = second.getsockname()[1]
        begun(other)
        with pytest.raises(InputError, match="got 2; give --port"):
            new_link()
        assert f":{other}/" in new_link(other)
    with pytest.raises(InputError, match=f"port 1 of this machine; give --port, one of {port}"):
        new_link(1)
    # Its server has ended: it answers no more.
    with pytest.raises(InputError, match=f"port {other}"):
        new_link(other)


@posix
def test_what_a_killed_server_left_is_removed_by_the_next(temporary, port):
    left, young, running = begun(port), begun(port), begun(port)
    about = json.loads((left.folder / "server.json").read_text())
    for links in (left, young):
        (links.folder / "server.json").write_text(json.dumps({**about, "port": 1, "pid": 2**22 + 1}))
    long_ago = time.time() - 3600
    for links in (left, running):
        os.utime(links.folder, (long_ago, long_ago))
    strange = temporary / "treadload-app-mine"
    strange.mkdir()
    module._sweep()
    assert not left.folder.exists()
    assert young.folder.exists()
    assert running.folder.exists()
    assert strange.exists()


def test_an_interruption_leaves_no_folder(port, temporary, monkeypatch):
    from treadload.app import server

    def stopped(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        # While the folder is made, and between that and the first request.
        patch.setattr(module, "_write_private", stopped)
        with pytest.raises(KeyboardInterrupt):
            begun(port)
    monkeypatch.setattr(server, "Engines", stopped)
    with pytest.raises(KeyboardInterrupt):
        server.run("127.0.0.1", 0, open_browser=False)
    assert not list(temporary.glob("treadload-app-*"))
