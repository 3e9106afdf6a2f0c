"""A page that asks another host for a script, a style, a font or an image is a warning of the build."""

import re
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util import logging

ASKED = re.compile(
    r"<(?:script|img|iframe|source|audio|video|embed)\b[^>]*\bsrc(?:set)?=[\"'](?:https?:)?//[^\"']+"
    r"|<link\b(?![^>]*rel=[\"']?(?:canonical|license))[^>]*\bhref=[\"'](?:https?:)?//[^\"']+"
)
STYLED = re.compile(r"url\(\s*[\"']?(?:https?:)?//[^)]+|@import\s+[\"'](?:https?:)?//[^\"']+")
log = logging.getLogger(__name__)


def foreign(folder: Path) -> list[str]:
    """What built pages and styles ask of other hosts, each with its file."""
    found = []
    for pattern, kind in ((ASKED, "*.html"), (STYLED, "*.css")):
        for page in sorted(folder.rglob(kind)):
            found += [f"{page.relative_to(folder)}: {one}" for one in pattern.findall(page.read_text("utf-8"))]
    return found


def check(app: Sphinx, error: Exception | None) -> None:
    """Warn of each."""
    if error is None and app.builder.format == "html":
        for one in foreign(Path(app.outdir)):
            log.warning("asks another host: %s", one)


def setup(app: Sphinx) -> dict[str, bool]:
    """What Sphinx calls."""
    app.connect("build-finished", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
