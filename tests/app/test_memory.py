"""Nothing of a page stays in the server once its tab is gone."""

import asyncio
import gc
import weakref

import pytest
from nicegui import Client, core, ui
from starlette.requests import Request

from treadload.app.engines import Engines
from treadload.app.pages import OURS, build
from treadload.app.sessions import Sessions


def closed_pages(kind, folder, count):
    """Weak references to the page, form, session and client of tabs that were opened and closed, one by one."""

    async def visited():
        about = {"type": "http", "method": "GET", "path": kind.address, "query_string": b"", "headers": []}
        core.loop = asyncio.get_running_loop()
        sessions, left = Sessions(Engines(), folder, lingers=0.0), []
        for number in range(count):
            session, gone = sessions.tab(str(number))
            client = Client(ui.page(kind.address), request=Request(about))
            client.on_delete(gone)
            with client:
                build(session, kind, list(OURS))
            await asyncio.sleep(0)
            client.delete()
            left += [weakref.ref(session), weakref.ref(client)]
            del session, client, gone
        await asyncio.sleep(0.1)
        assert len(sessions) == 0
        sessions.close()
        for task in asyncio.all_tasks() - {asyncio.current_task()}:
            task.cancel()
            await asyncio.wait([task])
        return left

    before = core.loop
    try:
        left = asyncio.run(visited())
    finally:
        core.loop = before
    gc.collect()
    return left


@pytest.mark.parametrize("kind", OURS)
def test_tabs_that_are_gone_leave_nothing_in_memory(kind, tmp_path):
    """Before, a list of NiceGUI and a cache of FastAPI kept all fields of all tabs: 0.45 MiB each."""
    left = closed_pages(kind, tmp_path, 2)
    kinds = [type(one()).__name__ for one in left if one() is not None]
    assert kinds == []
