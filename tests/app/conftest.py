"""A server and a browser for the tests of the page."""

import os
import time

import pytest

from page_visits import Visit, browser, serving


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """A server of its own, see `page_visits.Serving`."""
    with serving(tmp_path_factory.mktemp("app")) as one:
        time.sleep(1 if os.getloadavg()[0] < 0.7 * (os.cpu_count() or 1) else 8)
        yield one


@pytest.fixture(scope="module")
def chromium():
    with browser() as started:
        yield started


@pytest.fixture(scope="module")
def visit(chromium, server):
    """A browser on the bench, whose first case is solved."""
    one = Visit(chromium, server.printed)
    one.ready(1)
    yield one
    one.context.close()
