"""A little of the page under a load; `python tests/app/load.py` runs as much as you like."""

import asyncio

import pytest
from load import load

from page_visits import serving

pytestmark = pytest.mark.slow


def test_sessions_silent_sockets_uploads_and_cancelled_solves(tmp_path):
    """All bounds of the load, the next user's second apart: tests share their machine."""
    with serving(tmp_path) as server:
        assert asyncio.run(load(server, count=6, silents=80, cancels=2, wait=False, most_waited=20.0))
