"""The page under a load, in small: `python tests/app/load.py` is the whole of it."""

import asyncio
import sys

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads processes and sockets from /proc"),
]


def test_sessions_silent_sockets_uploads_and_cancelled_solves_stay_within_bounds(tmp_path, monkeypatch):
    load = pytest.importorskip("load", exc_type=ImportError)
    # Others work on the machine that tests run on; the bound of a second is asserted by the whole of it.
    monkeypatch.setattr(load, "MOST_WAITED", 30.0)
    with load.serving(tmp_path) as server:
        assert asyncio.run(load.load(server, count=11, silents=150, cancels=3, wait=False))
