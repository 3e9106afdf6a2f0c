"""Pages whose blocks run when the site is built, with what they print and draw below each block.

`executed_pages` in conf.py lists the pages as patterns. Each is run by `page_runner` in a process while the gallery
is drawn in this one; a page that fails is a warning of the build.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from page_runner import Output, blocks_of
from sphinx.application import Sphinx
from sphinx.util import logging

RUNNER = Path(__file__).with_name("page_runner.py")
# Pictures of all pages, below the sources.
FOLDER = "executed"
# Wide code and its output need the place of the list of headings.
WIDE = "---\nhtml_theme.sidebar_secondary.remove: true\n---\n\n"
log = logging.getLogger(__name__)


def start(app: Sphinx) -> None:
    """Start the pages, one at a time, beside the build."""
    source = Path(app.srcdir)
    shutil.rmtree(source / FOLDER, ignore_errors=True)
    pages = sorted({page for pattern in app.config.executed_pages for page in source.glob(pattern)})
    pool = ThreadPoolExecutor(1)
    names = [page.relative_to(source).with_suffix("").as_posix() for page in pages if page.stem != "index"]
    app.executed_outputs = {name: pool.submit(_run, source, name) for name in names}  # type: ignore[attr-defined]
    pool.shutdown(wait=False)


def _run(source: Path, name: str) -> list[Output]:
    """Outputs of the blocks of a page."""
    command = [sys.executable, str(RUNNER), str(source / f"{name}.md"), str(source / FOLDER / name)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    if done.returncode:
        raise RuntimeError(done.stderr.strip()[-2000:])
    outputs = json.loads(done.stdout.splitlines()[-1])
    return [Output(output["text"], tuple(output["pictures"])) for output in outputs]


def insert(app: Sphinx, name: str, source: list[str]) -> None:
    """Put the outputs of a page below its blocks, when Sphinx reads it."""
    future: Future[list[Output]] | None = app.executed_outputs.get(name)  # type: ignore[attr-defined]
    if future is None:
        return
    try:
        outputs = future.result()
    except RuntimeError as error:
        log.warning("a block of the page fails: %s", error, location=name)
        return
    source[0] = WIDE + with_outputs(source[0], outputs, f"/{FOLDER}/{name}")


def with_outputs(page: str, outputs: list[Output], folder: str) -> str:
    """A page in Markdown with the outputs of its blocks. folder: of the pictures, from the root of the sources."""
    parts, begin = [], 0
    for block, output in zip(blocks_of(page), outputs, strict=True):
        parts.append(page[begin : block.end])
        begin = block.end
        if output.text.strip():
            parts.append(f"\n\n```{{code-block}} text\n:class: output\n\n{_lines(output.text)}\n```\n")
        for picture in output.pictures:
            title = picture.removesuffix(".png").replace("_", " ")
            parts.append(f"\n\n```{{image}} {folder}/{picture}\n:alt: Figure drawn by the code above: {title}\n```\n")
    return "".join([*parts, page[begin:]])


def _lines(text: str) -> str:
    """Printed lines without empty ones at both ends; a heading keeps its indent."""
    return text.strip("\n").rstrip()


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.add_config_value("executed_pages", [], "env")
    # Before sphinx-gallery, which draws all its pages in this event.
    app.connect("builder-inited", start, priority=100)
    app.connect("source-read", insert)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
