"""The page under a load from this machine alone: sessions, silent sockets, uploads, cancelled solves.

    python tests/app/load.py [--count 200] [--silent 300] [--cancels 50] [--no-wait]

Prints what each cost, beside its bound. A visitor is a browser without a window: it enters by an address of its own,
loads the page, speaks over its socket as the page does, and leaves, some of them once the first case is solved.
--no-wait leaves out the minute after which sessions end.
"""

import argparse
import asyncio
import html
import json
import os
import re
import sys
import tempfile
import time
import uuid
from pathlib import Path

import aiohttp

sys.path.insert(0, str(Path(__file__).parents[1]))
from page_visits import serving
from treadload.app.engines import MOST_PROCESSES
from treadload.app.guard import MOST_UPLOADED
from treadload.app.sessions import LINGERS

# The page at once says "solving" and "ready" in what it sends.
_STATE = re.compile(r'data-state\\?":\s*\\?"([a-z]+)')
# Memory that is back, and how long the next user waits, s.
MOST_GROWN, MOST_WAITED = 1.2, 1.0
_PATIENCE = 240.0


class Visitor:
    """A browser on the bench, without a window."""

    def __init__(self, server, begins=True):
        self.server, self.begins, self.states, self.seen = server, begins, [], asyncio.Event()

    async def __aenter__(self):
        jar = aiohttp.CookieJar(unsafe=True)
        self.http = aiohttp.ClientSession(cookie_jar=jar, headers={"origin": self.server.base.rstrip("/")})
        self.begun = self.heard = begun = time.monotonic()
        async with self.http.get(self.server.address()) as answer:
            assert answer.status == 200
        async with self.http.get(self.server.base) as answer:
            page = await answer.text()
        self.client = re.search(r"'client_id': '([^']+)'", page)[1]
        self.elements = json.loads(html.unescape(re.search(r"String\.raw`(.*?)`", page, re.DOTALL)[1]))
        about = {"client_id": self.client, "next_message_id": 0, "implicit_handshake": "true", "EIO": 4,
                 "document_id": uuid.uuid4().hex, "tab_id": uuid.uuid4().hex, "transport": "websocket"}  # fmt: skip
        self.socket = await self.http.ws_connect(
            f"{self.server.base}_nicegui_ws/socket.io/", params=about, max_msg_size=0
        )
        self.listening = asyncio.create_task(self._listen())
        await self._first_word()
        self.waited = time.monotonic() - begun
        return self

    async def __aexit__(self, *_):
        self.listening.cancel()
        await self.socket.close()
        await self.http.close()

    async def _first_word(self):
        """Wait for the page to speak, as long as the socket is open."""
        seen = asyncio.create_task(self.seen.wait())
        await asyncio.wait((seen, self.listening), timeout=_PATIENCE, return_when=asyncio.FIRST_COMPLETED)
        if not seen.done():
            seen.cancel()
            raise ConnectionError(f"{self._lost()}, while it waited for the first word")

    def _lost(self):
        """How the socket was lost, in words."""
        if not self.listening.done():
            return "the socket is open"
        quiet = time.monotonic() - self.heard
        return f"the socket was closed with {self.socket.close_code}, {quiet:.1f} s after its last word"

    async def _listen(self):
        async for message in self.socket:
            told, self.heard = str(message.data), time.monotonic()
            if told == "2":
                await self.socket.send_str("3")
            elif told.startswith("0"):
                await self.socket.send_str("40")
            elif told.startswith("42"):
                self.seen.set()
                self.states += _STATE.findall(told)
                for asked in re.findall(r'"request_id":\s*"([^"]+)"', told) if self.begins else ():
                    await self._say("javascript_response", request_id=asked, result={"width": 900, "dark": False})

    async def _say(self, event, **told):
        await self.socket.send_str("42" + json.dumps([event, {"client_id": self.client, **told}]))

    def _named(self, name):
        return next((int(key), one) for key, one in self.elements.items() if one.get("props", {}).get("id") == name)

    async def click(self, name):
        """Click the button of an id."""
        key, one = self._named(name)
        await self._say("event", id=key, listener_id=one["events"][0]["listener_id"], args=["{}"])

    async def until(self, *states):
        """Wait for one of some states that comes after now; returns the first of them."""
        known, end = len(self.states), time.monotonic() + _PATIENCE
        while not (seen := [state for state in self.states[known:] if state in states]):
            assert time.monotonic() < end, (states, self.states[known:])
            if self.listening.done():
                raise ConnectionError(f"{self._lost()}, while it waited for {states} after {self.states[known:]}")
            await asyncio.sleep(0.02)
        return seen[0]

    async def upload(self, size):
        """Send a file of so many bytes where results go; returns the status of the answer."""
        key = next(key for key, one in self.elements.items() if ".nc" in one.get("props", {}).get("accept", ""))
        form = aiohttp.FormData()
        form.add_field("file", bytes(size), filename="a.nc")
        async with self.http.post(
            f"{self.server.base}_nicegui/client/{self.client}/upload/{key}", data=form
        ) as answer:
            return answer.status


def memory(server):
    """Of the server, MiB."""
    told = Path(f"/proc/{server.process.pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", told)[1]) / 1024


def processes(server):
    """Of the server, that solve."""
    children = Path(f"/proc/{server.process.pid}/task").glob("*/children")
    return [int(pid) for one in children for pid in one.read_text().split()]


def sockets(server):
    """That the server holds open."""
    files = Path(f"/proc/{server.process.pid}/fd").iterdir()
    return sum(os.readlink(one).startswith("socket:") for one in files if one.is_symlink())


async def next_user(server):
    """How long the next user waits for the page and its socket, s."""
    async with Visitor(server) as one:
        return one.waited


async def opened_and_closed(server, count):
    """Sessions, four at a time, in each tenth a case is solved.

    Returns the most processes there ever were, and how many visitors lost their socket or got no result.
    """
    left, most, lost = list(range(count)), 0, 0

    async def visitors():
        nonlocal most, lost
        while left:
            number = left.pop()
            one = Visitor(server, begins=number % 10 == 0)
            try:
                async with one:
                    if one.begins:
                        await one.until("ready", "done", "failed")
                        lost += "failed" in one.states
                    most = max(most, len(processes(server)))
            except ConnectionError as error:
                # With a farewell where a busy machine answered a ping too late: a browser would call again.
                lost += one.socket.close_code != aiohttp.WSCloseCode.OK
                print(f"visitor {number}: {error}", flush=True)

    await asyncio.gather(*(visitors() for _ in range(4)))
    return most, lost


async def settled(server, wait):
    """Wait until sessions have ended; returns how many are left."""
    end = time.monotonic() + (LINGERS + 40 if wait else 0)
    while time.monotonic() < end and list(server.own.glob("session-*")):
        await asyncio.sleep(1)
    return len(list(server.own.glob("session-*")))


async def silent(server, count):
    """Sockets that say nothing, or half of what they want; returns how long the next user waits, and what is left."""
    before, host, port = sockets(server), *server.host.split(":")
    held = [await asyncio.open_connection(host, int(port)) for _ in range(count)]
    for number, (_, writer) in enumerate(held):
        writer.write(b"GET / HTTP/1.1\r\nhost: " if number % 2 else b"")
    waited = await next_user(server)
    most = sockets(server) - before
    await asyncio.sleep(12)
    left = sockets(server) - before
    for _, writer in held:
        writer.close()
    return waited, most, left


async def cancelled(server, count):
    """Solves that are cancelled; returns the memory before and after the last half of them."""
    async with Visitor(server) as one:
        await one.until("ready", "done", "failed")
        for number in range(count):
            begun = asyncio.create_task(one.until("solving"))
            await asyncio.sleep(0)
            await one.click("solve")
            await begun
            ended = asyncio.create_task(one.until("cancelled", "done"))
            await asyncio.sleep(0)
            await one.click("cancel")
            await ended
            if number == count // 2:
                before = memory(server)
        return before, memory(server), len(processes(server))


async def uploaded(server):
    """Status of a file of the largest size, and of one beyond it."""
    async with Visitor(server) as one:
        fits = await one.upload(MOST_UPLOADED - 1000)
        try:
            return fits, await one.upload(MOST_UPLOADED + 2**17)
        except aiohttp.ClientOSError:
            # The server answers before the file is sent and hangs up; who still writes may not get to read why.
            return fits, 413


def check(what, value, bound, fine):
    """Print a number beside its bound."""
    print(f"{'ok ' if fine else 'BAD'} {what}: {value} (bound {bound})", flush=True)
    return bool(fine)


async def load(server, *, count, silents, cancels, wait, most_waited=MOST_WAITED):
    """All of it; True where every bound holds. most_waited: by the next user, s, on a machine that is not busy."""
    await opened_and_closed(server, 4)
    await settled(server, wait)
    before, fine = memory(server), []
    begun = time.monotonic()
    most, lost = await opened_and_closed(server, count)
    print(f"{count} sessions opened and closed in {time.monotonic() - begun:.0f} s", flush=True)
    fine.append(check("visitors who lost their socket or got no result", lost, 0, not lost))
    fine.append(check("processes meanwhile", most, MOST_PROCESSES, most <= MOST_PROCESSES))
    waited, held, left = await silent(server, silents)
    fine.append(
        check(f"next user beside {silents} silent sockets, s", f"{waited:.2f}", most_waited, waited < most_waited)
    )
    fine.append(check("sockets held of them at once", held, 72, held <= 72))
    fine.append(check("sockets left after 12 s", left, 8, left <= 8))
    told = await uploaded(server)
    fine.append(check("uploads at the bound and beyond", told, (200, 413), told == (200, 413)))
    half, end, running = await cancelled(server, cancels)
    grown = f"{half:.0f} to {end:.0f} MiB"
    fine.append(
        check(f"memory over the last half of {cancels} cancelled solves", grown, "1.2 times", end < 1.2 * half)
    )
    fine.append(check("processes after them", running, MOST_PROCESSES, running <= MOST_PROCESSES))
    if wait:
        sessions = await settled(server, wait)
        fine.append(check("sessions left after a minute", sessions, 0, sessions == 0))
        left = len(processes(server))
        fine.append(check("processes left, one of them for the next user", left, 1, left <= 1))
        after = memory(server)
        fine.append(check("memory", f"{before:.0f} to {after:.0f} MiB", "1.2 times", after < MOST_GROWN * before))
    waited = await next_user(server)
    fine.append(check("next user, s", f"{waited:.2f}", most_waited, waited < most_waited))
    return all(fine)


def main(argv=None):
    """Run it against a server of its own."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--silent", type=int, default=300)
    parser.add_argument("--cancels", type=int, default=50)
    parser.add_argument("--no-wait", action="store_true")
    told = parser.parse_args(argv)
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder)) as server:
        return 0 if asyncio.run(
            load(server, count=told.count, silents=told.silent, cancels=told.cancels, wait=not told.no_wait)
        ) else 1  # fmt: skip


if __name__ == "__main__":
    sys.exit(main())
