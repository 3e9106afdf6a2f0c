"""A server and a browser for the tests of the page."""

import os
import time
from pathlib import Path

import pytest

from page_visits import CHROMIUM, Visit, serving


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """A server of its own, see `page_visits.Serving`."""
    with serving(tmp_path_factory.mktemp("app")) as one:
        time.sleep(1 if os.getloadavg()[0] < 0.7 * (os.cpu_count() or 1) else 8)
        yield one


@pytest.fixture(scope="module")
def chromium():
    sync_api = pytest.importorskip("playwright.sync_api")
    if not Path(CHROMIUM).exists():
        pytest.skip("no Chromium here; .ci/run installs it")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def visit(chromium, server):
    """A browser on the bench, whose first case is solved."""
    one = Visit(chromium, server.printed)
    one.ready(1)
    yield one
    one.context.close()
