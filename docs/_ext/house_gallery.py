"""Figures of the house for the gallery: they are objects, and no state of pyplot holds them."""

from typing import Any

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst


def figures(block: Any, variables: dict[str, Any], conf: dict[str, Any]) -> str:
    """Write each figure that a block has newly bound to a name; returns their reStructuredText."""
    known = variables.setdefault("house_figures", [])
    paths = []
    for value in list(variables["example_globals"].values()):
        if isinstance(value, Figure) and not any(value is one for one in known):
            known.append(value)
            paths.append(next(variables["image_path_iterator"]))
            value.savefig(paths[-1], dpi=110, facecolor="white")
    return figure_rst(paths, conf["src_dir"])
