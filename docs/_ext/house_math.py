"""Equations as SVG, set by matplotlib while the site is built: no script, no font and no host is asked for later."""

from __future__ import annotations

import html
import re
from functools import cache
from typing import Any

from docutils import nodes
from matplotlib import rc_context
from matplotlib.backends.backend_svg import _short_float_fmt as short
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import TextPath
from sphinx.application import Sphinx
from sphinx.util import logging

SIZE = 10.0
log = logging.getLogger(__name__)


@cache
def svg(latex: str) -> str:
    """One line of mathematics as an inline SVG whose baseline is that of the text around it."""
    with rc_context({"mathtext.fontset": "stix"}):
        outline = TextPath((0, 0), f"${latex}$", size=SIZE, prop=FontProperties())
        from matplotlib.mathtext import MathTextParser

        found = MathTextParser("path").parse(f"${latex}$", dpi=72, prop=FontProperties(size=SIZE))
    width, height, depth = found.width, found.height, found.depth
    box = outline.get_extents()
    # Italics lean out of their box.
    left, right = min(0.0, box.x0), max(width, box.x1) + 0.1
    low, high = min(-depth, box.y0), max(height - depth, box.y1)
    em = 1 / SIZE
    label = html.escape(latex, quote=True)
    return (
        f'<svg class="math" role="img" aria-label="{label}" '
        f'viewBox="{left:.2f} {-high:.2f} {right - left:.2f} {high - low:.2f}" '
        f'style="width:{(right - left) * em:.3f}em;height:{(high - low) * em:.3f}em;vertical-align:{low * em:.3f}em">'
        f"<title>{label}</title>"
        f'<path fill="currentColor" d="{_commands(outline)}"/></svg>'
    )


def _commands(outline: Any) -> str:
    letters = {Path.MOVETO: "M", Path.LINETO: "L", Path.CURVE3: "Q", Path.CURVE4: "C", Path.CLOSEPOLY: "Z"}
    parts = []
    for points, code in outline.iter_segments(simplify=False, curves=True):
        letter = letters[code]
        ends = "" if letter == "Z" else " ".join(short(-v if k % 2 else v) for k, v in enumerate(points))
        parts.append(letter + ends)
    return "".join(parts)


def set_line(latex: str, where: nodes.Node) -> str:
    """The SVG of a line, or its text and a warning of the build where matplotlib cannot set it."""
    try:
        return svg(latex.strip())
    except (ValueError, RuntimeError) as error:
        log.warning("this equation cannot be set: %s\n%s", latex, error, location=where)
        return f"<code>{html.escape(latex)}</code>"


def visit_inline(translator: Any, node: nodes.Node) -> None:
    """Within a line of text."""
    translator.body.append(f'<span class="math">{set_line(node.astext(), node)}</span>')
    raise nodes.SkipNode


def visit_block(translator: Any, node: nodes.Node) -> None:
    r"""Lines that end in \\ stand below each other."""
    lines = [line for line in re.split(r"\\\\", " ".join(node.astext().split())) if line.strip()]
    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    name = f' id="{node["ids"][0]}"' if node.get("ids") else ""
    inner = "".join(f'<div class="line">{set_line(line, node)}</div>' for line in lines)
    translator.body.append(f'<div class="math-block"{name}>{inner}{number}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.add_html_math_renderer("mathtext", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
