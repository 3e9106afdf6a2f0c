"""A server of the page and browsers that visit it, for tests of the page and for `tests/faults/page_load.py`."""

import json
import os
import re
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

import treadload as tl
from treadload.app.links import Links

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or "/usr/bin/chromium"
# A machine on which others work is several times slower: patience, ms. Bounds of time hold on a quiet one.
PATIENCE = 150_000


@contextmanager
def browser(*arguments):
    """Chromium, started with further arguments; the test is skipped where it is missing."""
    sync_api = pytest.importorskip("playwright.sync_api")
    if not Path(CHROMIUM).exists():
        pytest.skip("no Chromium here; .ci/run installs it")
    with sync_api.sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", *arguments])
        yield started
        started.close()


class Serving:
    """A server that runs. process: of it. folder: its TMPDIR. printed: the address that it printed."""

    def __init__(self, process, folder, printed):
        self.process, self.folder, self.printed = process, folder, printed
        self.base = re.match("https?://[^/]+/", printed)[0]
        self.host = re.search("//([^/]+)/", printed)[1]

    @property
    def own(self):
        """Its private folder."""
        (path,) = self.folder.glob("treadload-app-*")
        return path

    def address(self):
        """An address for one more visit."""
        return Links(self.own, self.base).new()

    def about(self):
        return json.loads((self.own / "server.json").read_text())


@contextmanager
def serving(folder, *options, printed="http://127.0.0.1:", units="si"):
    """A server of its own; nothing of it is left behind. printed: what its address begins with. units: of results."""
    source = str(Path(tl.__file__).parents[1])
    # The server is no test: nicegui looks for signs of pytest in the environment.
    env = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}
    env |= {"OMP_NUM_THREADS": "1", "TMPDIR": str(folder), "PYTHONPATH": source}
    command = [sys.executable, "-m", "treadload", "--units", units, "app", *(options or ("--no-open",))]
    with (folder / "err").open("w") as err:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=err, text=True, env=env, cwd=folder)
    try:
        line = process.stdout.readline()
        assert line.startswith(f"treadload app: {printed}"), (folder / "err").read_text()
        yield Serving(process, folder, line.split()[-1])
    finally:
        process.terminate()
        process.wait(timeout=30)
    # Nothing that was uploaded or solved stays behind.
    assert not list(folder.glob("treadload-app-*"))


class Visit:
    """One browser: its page, what it asked for, and what went wrong in it."""

    def __init__(self, chromium, address, context=None):
        self.context = context or chromium.new_context(viewport={"width": 1280, "height": 860})
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.asked, self.errors = [], []
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.on("websocket", lambda socket: self.asked.append(socket.url))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", lambda told: self.errors.append(told.text) if told.type == "error" else None)
        self.page.goto(address)

    def tab(self, path):
        """Another page of the same browser."""
        return Visit(None, re.match("http://[^/]+/", self.page.url)[0] + path, self.context)

    def ready(self, count):
        """Wait for so many solved cases, drawn."""
        self.page.wait_for_selector(f'#bench[data-ready="{count}"]')
        return self.page.get_attribute("#bench", "data-run")

    def solves(self):
        return int(self.page.get_attribute("#bench", "data-ready"))

    def done(self):
        self.page.wait_for_selector('#bench[data-state="done"]')

    def set(self, path, text):
        """Type into a field, and leave it."""
        field = self.page.locator(f'[data-path="{path}"]')
        field = field if field.evaluate("one => one.tagName") == "INPUT" else field.locator("input")
        field.fill(text)
        field.press("Enter")

    def verdict(self):
        cells = self.page.locator("#verdict [data-row]").evaluate_all(
            "all => all.map(one => [one.dataset.row, one.innerText.trim()])"
        )
        return dict(cells)

    def chosen(self, text, files):
        """Give files to the button of a text."""
        with self.page.expect_file_chooser() as chooser:
            self.page.get_by_role("button", name=text).click()
        chooser.value.set_files(files)


def within(seconds, bound, what):
    """Print a time beside its bound; assert it where TREADLOAD_QUIET says that nobody else works on the machine."""
    print(f"{what}: {seconds:.3f} s, bound {bound} s, load {os.getloadavg()[0]:.1f}")
    if os.environ.get("TREADLOAD_QUIET"):
        assert seconds < bound, what


def in_theme(page, dark):
    """Bring a page to one of its two themes, and wait until every colour has come to rest."""
    if page.evaluate("document.body.classList.contains('body--dark')") != dark:
        page.locator("#theme").click()
        page.wait_for_function("(dark) => document.body.classList.contains('body--dark') === dark", arg=dark)
    page.wait_for_function("document.getAnimations().every((one) => one.playState !== 'running')")


def axe_faults(visit, dark):
    """Serious faults that axe finds on a page in one of its themes."""
    import pytest

    sync_playwright = pytest.importorskip("axe_playwright_python.sync_playwright")
    page, before = visit.page, list(visit.errors)
    in_theme(page, dark)
    found = sync_playwright.Axe().run(page).response
    # It brings style sheets of its own into the page, which the policy of the page refuses.
    page.wait_for_timeout(100)
    visit.errors[:] = before
    assert found["passes"] or found["violations"]
    return [
        (fault["id"], fault["impact"], [node["html"][:160] for node in fault["nodes"]][:4])
        for fault in found["violations"] if fault["impact"] in ("serious", "critical")
    ]  # fmt: skip
