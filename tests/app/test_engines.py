"""Processes of the page: what is left does not go on, whoever waits for it."""

import asyncio
import contextlib
import subprocess
import sys

import pytest

from treadload.app.engines import Engine, Engines
from treadload.app.form import Form

pytestmark = pytest.mark.slow


def fine():
    """A case whose contact takes far longer than the patience with a solve that should stop."""
    return dict(Form.first().with_values({"spacing": "0.7 mm"}).table)


async def asking(engine):
    """A task that waits for a solve which the process has begun."""
    begun = asyncio.Event()

    async def listen():
        async for _ in engine.ask("run", run="a", table=fine(), theme="light", view={}):
            begun.set()

    task = asyncio.create_task(listen())
    await begun.wait()
    return task


def test_a_solve_that_nobody_waits_for_any_more_is_ended(tmp_path):
    """A second case, typed while the first is solved, does not wait until the first is there."""

    async def tried():
        engine = await Engine.start()
        await engine.last("folder", folder=str(tmp_path))
        task = await asking(engine)
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task
        kept = await engine.stop()
        # It stopped of itself and goes on to the next, or there is no such process any more.
        if kept:
            assert "error" in await engine.last("maps", run="a", theme="light", view={})
        else:
            for _ in range(100):
                if not engine.lives:
                    break
                await asyncio.sleep(0.1)
            assert not engine.lives
        engine.kill()

    asyncio.run(asyncio.wait_for(tried(), 120))


def test_who_leaves_while_a_process_starts_leaves_it_to_the_next(tmp_path):
    async def tried():
        engines = Engines()
        first = asyncio.create_task(engines.take(tmp_path))
        await asyncio.sleep(0.3)
        first.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await first
        assert engines._spare is not None
        engine = await engines.take(tmp_path)
        assert engine.lives
        engines.close()
        await asyncio.sleep(0.1)

    asyncio.run(asyncio.wait_for(tried(), 120))


def test_a_process_whose_page_is_gone_ends_whatever_its_threads_do():
    """Of 20 that were solving, 12 were still there after 40 s: without a Python frame."""
    text = (
        "import threading, time; from treadload.app import engine\n"
        "engine.warm = lambda: None\n"
        "threading.Thread(target=time.sleep, args=(3600,)).start()\n"
        "engine.main()\n"
    )
    ran = subprocess.run([sys.executable, "-c", text], stdin=subprocess.DEVNULL, capture_output=True, timeout=300)
    assert ran.returncode == 0
    assert b'"warm": true' in ran.stdout
