import gc
import os
import time

import pytest


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """The garbage collector leaves out what is imported and collected: a million objects that stay to the end."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        # And looks at what is young at every 20 000 objects, not at every 700: as many as a few figures.
        gc.set_threshold(20_000, 20, 20)
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """After `TREADLOAD_TESTS_END`, a time in s since 1970, slow tests are skipped: CI runs them while they fit."""
    end = os.environ.get("TREADLOAD_TESTS_END")
    if end and item.get_closest_marker("slow") and time.time() > float(end):
        pytest.skip("CI's time is used up")


@pytest.hookimpl(trylast=True)
def pytest_configure(config):
    """Failures are printed when they happen: a run that is ended by its time limit has said which they were."""
    terminal = config.pluginmanager.get_plugin("terminalreporter")
    if terminal is not None:
        config.pluginmanager.register(FailuresAtOnce(terminal))


class FailuresAtOnce:
    """Prints the name and the last lines of each failure as soon as it is known."""

    def __init__(self, terminal):
        self.terminal = terminal

    def pytest_runtest_logreport(self, report):
        if report.failed:
            self.terminal.write_line(f"\n{report.nodeid} failed in {report.when} after {report.duration:.0f} s:")
            for line in report.longreprtext.splitlines()[-12:]:
                self.terminal.write_line(f"    {line[:300]}")


@pytest.fixture(scope="session")
def coarse_result():
    """Result of the coarse case: driving, 12 mm cells."""
    # Here, as the process that only hands out tests solves none.
    from cases import COARSE_CASE
    from treadload.case import Case
    from treadload.steps import run

    return run(Case.from_text(COARSE_CASE))


@pytest.fixture(scope="session", autouse=True)
def cache_folder(tmp_path_factory):
    """No test reads or fills the cache folder of whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TREADLOAD_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="module")
def page_of_dots():
    """The text of a report whose figures are drawn, and in the page each is one pixel: for fixtures of a module."""

    def write(*arguments, **options):
        from treadload.reporting import report

        with pytest.MonkeyPatch.context() as patch:
            as_dots(patch)
            return report(*arguments, **options).read_text(encoding="utf-8")

    return write


@pytest.fixture
def figures_as_dots(monkeypatch):
    """Figures of a report are drawn, and in the page each is one pixel: for what else the page holds."""
    as_dots(monkeypatch)


def as_dots(patch):
    from PIL import Image

    dot = Image.new("RGB", (1, 1))
    patch.setattr("treadload.reporting.pictures.raster", lambda figure, **_: dot)


@pytest.fixture
def without_figures(monkeypatch):
    """Pages without their figures, which other tests draw: seconds each."""
    monkeypatch.setattr("treadload.reporting.pictures.picture", lambda *_, **__: [])
