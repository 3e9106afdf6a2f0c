"""Take the pictures of the pages of `treadload app` that stand in the docs: python docs/pictures.py.

Needs the extras app and dev, and Chromium.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

IMAGES = Path(__file__).parent / "images"
# Name, width and height, and theme of each.
PICTURES = (("app_light", 1280, 980, False), ("app_dark", 1920, 1080, True))
# ms; a machine on which others work is slow.
PATIENCE = 300_000
SETTLED = "document.getAnimations().every((one) => one.playState !== 'running')"


def main() -> None:
    """The bench on a road of the catalogue, whose layers have laws."""
    # A folder of its own: cases and files of this one are nobody's business.
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "treadload", "app", "--no-open"]
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=folder)
        try:
            assert server.stdout is not None
            address = server.stdout.readline().split()[-1]
            with sync_playwright() as playwright:
                chromium = shutil.which("chromium") or shutil.which("chromium-browser")
                browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
                page = browser.new_page(viewport={"width": 1280, "height": 900})
                page.set_default_timeout(PATIENCE)
                page.goto(address)
                _solved(page, "1")
                # The second is the pavement's.
                page.get_by_label("Given by", exact=True).nth(1).click()
                page.get_by_role("option", name="structure").click()
                # No tooltip in the picture.
                page.mouse.move(640, 5)
                _solved(page, "2")
                for name, width, height, dark in PICTURES:
                    _take(page, IMAGES / f"{name}.png", width, height, dark)
                browser.close()
        finally:
            server.terminate()
            server.wait(timeout=30)


def _solved(page: Page, count: str) -> None:
    """Wait until so many cases are solved, with everything that follows."""
    page.wait_for_selector(f'#bench[data-ready="{count}"]')
    page.wait_for_selector('#bench[data-state="done"]')


def _take(page: Page, path: Path, width: int, height: int, dark: bool) -> None:
    if page.evaluate("document.body.classList.contains('body--dark')") != dark:
        page.locator("#theme").click()
        page.wait_for_function("(dark) => document.body.classList.contains('body--dark') === dark", arg=dark)
    page.set_viewport_size({"width": width, "height": height})
    # Figures are drawn again in another theme and for another width.
    page.wait_for_timeout(4000)
    page.wait_for_function(SETTLED)
    page.screenshot(path=path)


if __name__ == "__main__":
    main()
