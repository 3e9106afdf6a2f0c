"""Addresses that let a browser in, each good for one visit, and the private folder of a server that holds them.

An address is a file: named by the hash of its token, in a folder that only the user of the server can read. Whoever
can write there may let a browser in, so `treadload app --new-link` needs no other key, and a token that was used is
gone with its file. The browser that the server opens itself gets a file that sends it on, so that no token stands
among the arguments of a process, which everybody on the machine can read.
"""

from __future__ import annotations

import contextlib
import hashlib
import html
import json
import os
import secrets
import shutil
import socket
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TypedDict

from treadload.errors import InputError

_PREFIX = "treadload-app-"
_ABOUT, _OPEN, _LINKS = "server.json", "open.html", "links"
# An address that nobody used for so long is void, s.
_LASTS = 24 * 3600.0
# A server that has just begun does not answer yet, s; how long one is waited for.
_STARTS, _ANSWERS = 60.0, 1.0
_SENDS_ON = (
    '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta name="referrer" content="no-referrer">'
    '<meta http-equiv="refresh" content="0;url={address}"><title>treadload</title></head>'
    '<body><a href="{address}">treadload</a></body></html>\n'
)


@dataclass(frozen=True)
class Links:
    """The private folder of a server. address: where it is, "http://127.0.0.1:8137/"."""

    folder: Path
    address: str

    @classmethod
    def begin(cls, host: str, port: int, address: str) -> Links:
        """The folder of a server that begins, which only its user can read."""
        _sweep()
        links = cls(Path(tempfile.gettempdir()) / f"{_PREFIX}{secrets.token_hex(8)}", address)
        # Whatever comes between, an interruption too, leaves no folder.
        try:
            links.folder.mkdir(mode=0o700)
            (links.folder / _LINKS).mkdir(mode=0o700)
            about = {"host": host, "port": port, "address": address, "pid": os.getpid()}
            _write_private(links.folder / _ABOUT, json.dumps(about))
        except BaseException:
            links.end()
            raise
        return links

    def new(self) -> str:
        """An address that opens the page to one visit."""
        token = secrets.token_urlsafe(32)
        _write_private(self._file(token), "")
        return f"{self.address}?token={token}"

    def use(self, token: str) -> bool:
        """True for a token that was not used yet; it is from then on."""
        file = self._file(token)
        try:
            fresh = time.time() - file.stat().st_mtime < _LASTS
            file.unlink()
        except FileNotFoundError:
            return False
        (self.folder / _OPEN).unlink(missing_ok=True)
        return fresh

    def for_browser(self) -> str:
        """The address of a private file that sends a browser on to the page."""
        path = self.folder / _OPEN
        path.unlink(missing_ok=True)
        _write_private(path, _SENDS_ON.format(address=html.escape(self.new())))
        return path.as_uri()

    def end(self) -> None:
        """Remove the folder and all in it."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _file(self, token: str) -> Path:
        return self.folder / _LINKS / hashlib.sha256(token.encode("utf-8", "replace")).hexdigest()


def sent_on(address: str) -> str:
    """A page that sends a browser on to an address of this server."""
    return _SENDS_ON.format(address=html.escape(address))


def new_link(port: int = 0) -> str:
    """An address, good for one visit, of a page that this user serves on this machine.

    port: of the server; 0 for the only one. Raises InputError where none, or several, answer.
    """
    servers = {int(about["port"]): links for links, about in _servers() if _answers(about)}
    if port and port not in servers:
        raise InputError(f"you serve no page on port {port} of this machine; {_those(sorted(servers))}")
    if len(servers) != 1 and not port:
        raise InputError(
            f"a new address needs one page that is being served, got {len(servers)}; {_those(sorted(servers))}"
        )
    return servers[port or next(iter(servers))].new()


def _those(ports: list[int]) -> str:
    if not ports:
        return "start one by `treadload app`; TMPDIR has to be the same for both"
    return f"give --port, one of {', '.join(map(str, ports))}"


class About(TypedDict, total=False):
    """What a server states of itself in its folder."""

    address: str
    host: str
    port: int
    pid: int


def _servers() -> list[tuple[Links, About]]:
    """Folders of this user's servers, running or not."""
    servers = []
    for folder in Path(tempfile.gettempdir()).glob(f"{_PREFIX}*"):
        with contextlib.suppress(OSError, ValueError, KeyError):
            if hasattr(os, "getuid") and folder.lstat().st_uid != os.getuid():
                continue
            about: About = json.loads((folder / _ABOUT).read_text(encoding="utf-8"))
            servers.append((Links(folder, str(about["address"])), about))
    return servers


def _answers(about: About) -> bool:
    host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(str(about["host"]), str(about["host"]))
    try:
        with socket.create_connection((host, int(about["port"])), timeout=_ANSWERS):
            return True
    except OSError:
        return False


def _sweep() -> None:
    """Remove what servers left that were killed."""
    for links, about in _servers():
        with contextlib.suppress(OSError):
            old = time.time() - links.folder.stat().st_mtime > _STARTS
            if old and not _lives(int(about.get("pid", 0))) and not _answers(about):
                links.end()


def _lives(pid: int) -> bool:
    """True for a process that is there, and where that cannot be known."""
    if os.name != "posix":
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return pid > 0


def _write_private(path: Path, text: str) -> None:
    """A file that is new, and that nobody else can read."""
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
        file.write(text)
