"""Sessions end after their last tab, processes are bounded, and callers that say nothing are hung up on."""

import asyncio
import contextlib
import json
import time
from types import SimpleNamespace

import pytest

from treadload.app import connections, engines
from treadload.app.engines import Engine, EngineLost, Engines
from treadload.app.sessions import TAB_GONE, Sessions


class Process:
    """A process as `Engine` uses it, that answers nothing and ends when it is killed."""

    count = 0

    def __init__(self):
        Process.count += 1
        self.pid, self.returncode = Process.count, None
        self.stdin = SimpleNamespace(write=self.hear, drain=self.drained)
        self.lines = asyncio.Queue()
        self.stdout = SimpleNamespace(readline=self.lines.get)
        self.lines.put_nowait(b'{"id": 0}\n')

    def hear(self, line):
        asked = json.loads(line)
        if asked["do"] == "folder":
            self.lines.put_nowait(json.dumps({"id": asked["id"], "done": True}).encode() + b"\n")

    async def drained(self):
        pass

    def kill(self):
        if self.returncode is None:
            self.returncode = -9
            self.lines.put_nowait(b"")

    async def wait(self):
        return self.returncode


@pytest.fixture
def started(monkeypatch):
    """Processes that were started; they are no real ones."""
    made = []

    async def start(limits=None):
        await asyncio.sleep(0)
        process = Process()
        made.append(process)
        engine = Engine(process)
        await engine._waiting[0].get()
        return engine

    monkeypatch.setattr(Engine, "start", start)
    monkeypatch.setattr(engines, "_LATER", 0.01)
    return made


def alive(made):
    return [one for one in made if one.returncode is None]


def test_a_session_ends_after_its_last_tab_with_its_process_and_files(started, tmp_path):
    async def tried():
        held = Engines()
        sessions = Sessions(held, tmp_path, lingers=TAB_GONE + 0.05)
        session, left = sessions.tab("a")
        _, also_left = sessions.tab("a")
        await session.engine("bench")
        await session.engine("life")
        (session.folder / "upload").write_bytes(b"x")
        assert session.folder.parent == tmp_path
        left()
        left()
        await asyncio.sleep(0.2)
        # One tab is left, however often the other says that it is gone.
        assert sessions.get("a") is session
        assert len(alive(started)) >= 2
        also_left()
        await asyncio.sleep(0.01)
        # A tab that is loaded again finds its session.
        same, left_again = sessions.tab("a")
        assert same is session
        await asyncio.sleep(0.2)
        assert sessions.get("a") is session
        left_again()
        await asyncio.sleep(0.2)
        assert sessions.get("a") is None
        assert not session.folder.exists()
        # But the one that is kept for the next.
        assert len(alive(started)) <= 1
        assert not session._engines["bench"].lives
        assert sessions.tab("a")[0] is not session
        sessions.close()
        held.close()
        assert not alive(started)
        assert not list(tmp_path.iterdir())

    asyncio.run(tried())


def test_a_process_that_comes_too_late_for_its_session_is_ended(started, tmp_path):
    async def tried():
        held = Engines()
        sessions = Sessions(held, tmp_path)
        session, _ = sessions.tab("a")
        waiting = asyncio.create_task(session.engine("bench"))
        await asyncio.sleep(0)
        sessions.end("a")
        with pytest.raises(EngineLost, match="load it again"):
            await waiting
        held.close()
        assert not alive(started)

    asyncio.run(tried())


def test_no_more_processes_than_the_bound_and_the_idle_one_ends_for_another(started, tmp_path, monkeypatch):
    monkeypatch.setattr(engines, "MOST_PROCESSES", 3)

    async def tried():
        held = Engines()
        taken = [await held.take(tmp_path) for _ in range(3)]
        assert len(alive(started)) == 3
        taken[0].used = time.monotonic()
        fourth = await held.take(tmp_path)
        assert [one.lives for one in (*taken, fourth)] == [True, False, True, True]
        assert len(alive(started)) == 3
        # All of them solve: the next is told why, and what to do.
        for one in (taken[0], taken[2], fourth):
            one._solving.add(1)
        with pytest.raises(EngineLost, match=r"3 cases are being solved at once.*solve again"):
            await held.take(tmp_path)
        taken[2]._solving.clear()
        await held.take(tmp_path)
        assert not taken[2].lives
        # Nor is one kept warm in the place of somebody's.
        await asyncio.sleep(0.05)
        assert len(alive(started)) == 3
        held.close()
        assert not alive(started)

    asyncio.run(tried())


def test_who_leaves_while_a_process_starts_leaves_no_process_behind(started, tmp_path):
    async def tried():
        held = Engines()
        visitors = [asyncio.create_task(held.take(tmp_path)) for _ in range(5)]
        await asyncio.sleep(0)
        for one in visitors:
            one.cancel()
        for one in visitors:
            with contextlib.suppress(asyncio.CancelledError):
                await one
        await asyncio.sleep(0.05)
        assert len(alive(started)) == 1
        held.close()
        await asyncio.sleep(0)
        assert not alive(started)

    asyncio.run(tried())


def test_who_asks_a_process_that_ended_by_itself_is_told_at_once(started):
    """Between the end of its output and that of the process nobody reads any more."""

    async def tried():
        engine = await Engine.start()
        process = started[0]
        never = asyncio.Event()

        async def wait():
            await never.wait()
            return process.returncode

        process.wait, process.kill = wait, lambda: None
        process.lines.put_nowait(b"")
        await asyncio.sleep(0.01)
        assert not engine.lives
        with pytest.raises(EngineLost, match="has ended"):
            await asyncio.wait_for(engine.last("maps", run="a"), 1)
        never.set()

    asyncio.run(tried())


def test_who_waits_for_a_process_that_is_killed_does_not_wait_for_its_output_to_close(started):
    """What a process has started may hold its output open."""

    async def tried():
        engine = await Engine.start()
        started[0].kill = lambda: None
        waiting = asyncio.create_task(engine.last("maps", run="a"))
        await asyncio.sleep(0)
        engine.kill()
        with pytest.raises(EngineLost, match="has ended"):
            await asyncio.wait_for(waiting, 1)

    asyncio.run(tried())


def test_who_leaves_while_a_process_learns_its_folder_leaves_none_without_a_session(started, tmp_path, monkeypatch):
    async def tried():
        held = Engines()
        monkeypatch.setattr(Process, "hear", lambda process, line: None)
        taking = asyncio.create_task(held.take(tmp_path))
        while not started or len(held._all) < 1 or not held._all[0]._waiting.keys() - {0}:
            await asyncio.sleep(0)
        taking.cancel()
        with pytest.raises(asyncio.CancelledError):
            await taking
        assert not alive(started)
        held.close()

    asyncio.run(tried())


class Transport(asyncio.Transport):
    """A connection as a protocol sees it."""

    def __init__(self):
        super().__init__()
        self.protocol, self.gone, self.written = None, False, b""

    def get_extra_info(self, name, default=None):
        return default

    def get_protocol(self):
        return self.protocol

    def is_closing(self):
        return self.gone

    def write(self, data):
        self.written += data

    def abort(self):
        if self.gone:
            return
        self.gone = True
        self.protocol.connection_lost(None)

    close = abort

    def pause_reading(self):
        pass

    resume_reading = pause_reading


async def _answer(scope, receive, send):
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"0")]})
    await send({"type": "http.response.body", "body": b""})


@pytest.fixture
def call(monkeypatch):
    """Calls the server, which is as impatient as a test wants it."""
    uvicorn = pytest.importorskip("uvicorn")
    from uvicorn.server import ServerState

    monkeypatch.setattr(connections, "PATIENCE", 0.1)
    monkeypatch.setattr(connections, "MOST_WAITING", 5)
    config = uvicorn.Config(_answer, http=connections.Impatient, log_level="error", timeout_keep_alive=60)
    config.load()
    state = ServerState()

    def calls():
        transport = Transport()
        transport.protocol = connections.Impatient(config=config, server_state=state, app_state={})
        transport.protocol.connection_made(transport)
        return transport

    return calls


REQUEST = b"GET / HTTP/1.1\r\nhost: a\r\n\r\n"


def test_who_says_nothing_is_hung_up_on(call):
    async def tried():
        silent, slow, quick = call(), call(), call()
        slow.protocol.data_received(REQUEST[:10])
        quick.protocol.data_received(REQUEST)
        await asyncio.sleep(0.01)
        assert quick.written.startswith(b"HTTP/1.1 200")
        # A second request that stops in its middle waits no longer than a first.
        halved = call()
        halved.protocol.data_received(REQUEST)
        await asyncio.sleep(0.01)
        halved.protocol.data_received(REQUEST[:10])
        await asyncio.sleep(0.2)
        assert (silent.gone, slow.gone, quick.gone, halved.gone) == (True, True, False, True)
        assert not connections.Impatient._waiting
        quick.abort()

    asyncio.run(tried())


def test_a_crowd_of_silent_callers_does_not_keep_others_out(call):
    async def tried():
        first = call()
        crowd = [call() for _ in range(20)]
        assert first.gone
        assert [one.gone for one in crowd].count(False) == 5
        user = call()
        user.protocol.data_received(REQUEST)
        await asyncio.sleep(0.01)
        assert user.written.startswith(b"HTTP/1.1 200")
        assert not user.gone
        for one in (*crowd, user):
            if not one.gone:
                one.abort()
        assert not connections.Impatient._waiting

    asyncio.run(tried())


UPGRADE = (
    b"GET / HTTP/1.1\r\nhost: a\r\nconnection: Upgrade\r\nupgrade: websocket\r\nsec-websocket-version: 13\r\n"
    b"sec-websocket-key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
)


def test_a_socket_that_comes_on_the_last_bytes_of_an_answer_stays_open(call):
    """The server takes the answer for complete a moment after its caller, and then waits 5 s for another request."""
    import uvicorn
    from uvicorn.server import ServerState

    class Socket(asyncio.Protocol):
        def __init__(self, **_):
            pass

    async def tried():
        complete = asyncio.Event()

        async def answer(scope, receive, send):
            await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"1")]})
            await send({"type": "http.response.body", "body": b"x", "more_body": True})
            await complete.wait()
            await send({"type": "http.response.body", "body": b""})

        config = uvicorn.Config(
            answer, http=connections.Impatient, ws=Socket, log_level="critical", timeout_keep_alive=0.05
        )
        config.load()
        transport = Transport()
        transport.set_protocol = lambda protocol: setattr(transport, "protocol", protocol)
        protocol = connections.Impatient(config=config, server_state=ServerState(), app_state={})
        transport.protocol = protocol
        protocol.connection_made(transport)
        protocol.data_received(REQUEST)
        await asyncio.sleep(0.01)
        assert transport.written.endswith(b"x")
        protocol.data_received(UPGRADE)
        assert isinstance(transport.protocol, Socket)
        complete.set()
        await asyncio.sleep(0.2)
        assert not transport.gone

    asyncio.run(tried())


def test_a_life_that_is_cancelled_is_not_computed_on(started):
    """It stops of itself, or its process ends."""

    async def tried():
        engine = await Engine.start()
        waiting = asyncio.create_task(engine.last("life", run="a"))
        await asyncio.sleep(0)
        assert not engine.is_idle
        assert not await engine.stop()
        assert not engine.lives
        with pytest.raises(EngineLost):
            await waiting
        assert not alive(started)

    asyncio.run(tried())
