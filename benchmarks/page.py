"""The page in a real Chromium, stage by stage: first sight, a case solved and redrawn, a move of the slider.

    python page.py [repeats]

Wall times from the key to the screen, as the page tells them, the smallest of some; and the processor
time of each process meanwhile, which others that work on the machine move less. Needs playwright and Chromium.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from timing import print_table

import treadload as tl

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
# What happens on the page and when, ms after the page was asked for.
WATCH = """
window.seen = [];
const note = (what) => window.seen.push([what, performance.now()]);
new MutationObserver((all) => {
  for (const { target, attributeName: name } of all) {
    if (name === "data-maps") note(`drawn ${document.body.dataset.maps.split(":")[1]}`);
    if (name === "data-state") note(`state ${target.dataset.state}`);
  }
  if (!window.formed && document.querySelector('[data-path="rolling.normal_load"]')) {
    window.formed = true;
    requestAnimationFrame(() => setTimeout(() => note("form"), 0));
  }
}).observe(document, {
  subtree: true, childList: true, attributes: true, attributeFilter: ["data-maps", "data-state"] });
document.addEventListener("keydown", () => { window.seen = [["key", performance.now()]]; }, true);
"""


def processor(pid):
    """Seconds of a process, from /proc."""
    told = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(told[11]) + int(told[12])) / os.sysconf("SC_CLK_TCK")


def processes(parent):
    """Processes below one, with their command lines."""
    found = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            own, above = path.read_text().rpartition(")")[2].split()[1], path.parent
            if int(own) == parent:
                found[int(above.name)] = (above / "cmdline").read_bytes().replace(b"\0", b" ").decode()
        except (OSError, ValueError):
            continue
    return found


class Serving:
    """A server of its own, and the processes that work for it."""

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        source = str(Path(tl.__file__).parents[1])
        env = {**os.environ, "OMP_NUM_THREADS": "1", "TMPDIR": self.folder.name, "PYTHONPATH": source}
        self.server = subprocess.Popen(
            [sys.executable, "-m", "treadload", "app", "--no-open"], stdout=subprocess.PIPE, text=True, env=env,
            cwd=self.folder.name,
        )  # fmt: skip
        self.address = self.server.stdout.readline().split()[-1]
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait(timeout=30)
        self.folder.cleanup()

    def used(self):
        """Processor seconds of the server and of the processes that solve."""
        engines = sum(processor(pid) for pid in processes(self.server.pid))
        return {"server": processor(self.server.pid), "solving": engines}


def times(page, first="key"):
    """What happened, s, after the first."""
    seen = page.evaluate("window.seen")
    start = next((at for what, at in seen if what == first), 0.0)
    made = {}
    for what, at in seen:
        made.setdefault(what, (at - start) / 1e3)
    return made


def smallest(rows):
    """The smallest of each time."""
    return {key: min(row[key] for row in rows if key in row) for key in rows[0]}


def visited(browser, address):
    """A fresh browser on the page of a server that has started, solved and drawn."""
    time.sleep(5)
    context = browser.new_context(viewport={"width": 1280, "height": 860})
    page = context.new_page()
    page.set_default_timeout(180_000)
    page.add_init_script(WATCH)
    page.goto(address)
    page.wait_for_selector('#bench[data-state="done"]')
    page.wait_for_function("document.querySelector('.section')?.data")
    paint = page.evaluate("performance.getEntriesByName('first-contentful-paint')[0].startTime") / 1e3
    return page, {"first paint": paint, **times(page, "")}


def changed(page, serving, load):
    """The load changed: times, processor times until the assessment is drawn."""
    client = page.context.new_cdp_session(page)
    client.send("Performance.enable")
    script = lambda: {one["name"]: one["value"] for one in client.send("Performance.getMetrics")["metrics"]}  # noqa: E731
    field = page.locator('[data-path="rolling.normal_load"]')
    field = field if field.evaluate("one => one.tagName") == "INPUT" else field.locator("input")
    field.fill(str(load))
    before, was = serving.used(), script()
    count = int(page.get_attribute("#bench", "data-ready")) + 1
    cuts = page.evaluate("window.treadloadTimes.section?.count ?? 0")
    field.press("Enter")
    page.wait_for_selector(f'#bench[data-ready="{count}"]')
    page.wait_for_function("document.body.dataset.maps.endsWith(':damage')")
    after, now = serving.used(), script()
    page.wait_for_function("(were) => (window.treadloadTimes.section?.count ?? 0) > were", arg=cuts)
    spent = {f"processor, {name}": after[name] - before[name] for name in after}
    spent["processor, tab"] = now["TaskDuration"] - was["TaskDuration"]
    root = page.locator("#bench")
    solved = {f"solved, {name}": float(root.get_attribute(f"data-drawn-{name}"))
              for name in ("contact", "response", "damage")}  # fmt: skip
    return {**times(page), **solved, **spent}


def slid(page):
    """A move of the slider by its key: until profile and section stand, and what drawing them took."""
    were = page.evaluate("window.treadloadTimes.slice?.count ?? 0")
    page.keyboard.press("ArrowRight")
    page.wait_for_function("(were) => (window.treadloadTimes.slice?.count ?? 0) > were", arg=were)
    page.wait_for_timeout(300)
    slice_ = page.evaluate("window.treadloadTimes.slice")
    start = page.evaluate("window.seen[0][1]")
    return {"key to screen": (slice_["end"] - start) / 1e3, "of it drawing": slice_["last"] / 1e3}


def main(repeats=5):
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        print("The page: needs playwright\n")
        return
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        sights = []
        # The address of a server opens in the first browser alone, so that each first sight has its server.
        for _ in range(max(1, repeats // 2 - 1)):
            with Serving() as serving:
                page, sight = visited(browser, serving.address)
                sights.append(sight)
                page.context.close()
        with Serving() as serving:
            page, sight = visited(browser, serving.address)
            sights.append(sight)
            changes = [changed(page, serving, 33 + number) for number in range(repeats)]
            page.wait_for_timeout(1000)
            page.locator("#along").click()
            page.locator("#place").focus()
            moves = [slid(page) for _ in range(repeats)]
            figures = page.evaluate("window.treadloadTimes")
        browser.close()
    told = f"smallest of some, load of the machine {os.getloadavg()[0]:.1f}"
    for title, rows in (("first sight", sights), ("a case of 3 mm, load changed", changes), ("slider", moves)):
        print_table(f"The page, {title}: s, {told}", ("stage", "s"), list(smallest(rows).items()))
    rows = [(name, one["letters"] / 1e3, one["least"] / 1e3) for name, one in figures.items()]
    print_table("Figures: text, and from the text to the page", ("figure", "kB", "s"), rows)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
