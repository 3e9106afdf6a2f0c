"""A connection that is lost while a case is solved, in a real Chromium."""

import time

import pytest

from page_visits import Visit
from treadload.app.sessions import LINGERS, TAB_GONE

pytestmark = pytest.mark.browser
# The line of the page is cut; a browser that is offline keeps a line that it has.
CUT = "() => window.socket.io.engine.close()"
ROW = "document.querySelector('#verdict [data-row=normal_load]')?.innerText.trim()"


@pytest.fixture
def caller(chromium, server):
    visit = Visit(chromium, server.address())
    visit.ready(1)
    visit.done()
    yield visit
    visit.context.close()


@pytest.mark.parametrize("seconds", [5.0, 30.0])
def test_a_connection_lost_in_the_middle_of_a_solve_comes_again_with_its_result(caller, seconds):
    """Shorter and longer than the tab is waited for: the tab goes on, or is loaded again in the same session."""
    assert seconds < LINGERS
    page = caller.page
    verdict = caller.verdict()
    page.evaluate("window.wasHere = true")
    caller.set("rolling.normal_load", "36")
    page.wait_for_selector('#bench[data-state="solving"]')
    caller.context.set_offline(True)
    page.evaluate(CUT)
    time.sleep(seconds)
    caller.context.set_offline(False)
    if seconds > TAB_GONE:
        # The old tab is connected for a moment, and can show its result, before it is loaded again.
        page.wait_for_function("() => !window.wasHere")
    page.wait_for_function("() => window.socket && window.socket.connected")
    page.wait_for_selector('#bench[data-state="done"]')
    assert bool(page.evaluate("window.wasHere")) == (seconds < TAB_GONE)
    assert caller.verdict()["normal_load"] == "36.000 kN"
    # What was solved before is still there; a page that is loaded again solves its form once more.
    assert page.locator("#runs [role=listitem]").count() >= 2
    # And the next case is solved.
    caller.set("rolling.normal_load", "32.5")
    page.wait_for_function(f"() => ({ROW}) === '32.500 kN'")
    caller.done()
    assert caller.verdict() == verdict
