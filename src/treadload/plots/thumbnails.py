"""A small picture of a result, which stands in what a notebook shows of it."""

from __future__ import annotations

from typing import Any

from treadload.accessors import offers
from treadload.plots.kit.files import png

# Kind of a result → the figure that says most of it at the size of a stamp.
_FIGURES = {
    "Contact": "pressure",
    "Footprint": "pressure",
    "Response": "strain_directions",
    "Verdict": "passes",
    "Life": "years",
    "Reliability": "years",
    "Sensitivity": "inputs",
    "ThicknessDesign": "lives",
    "Equivalents": "axles",
    "Passes": "rut",
    "Indentation": "dent",
    "Growth": "depth",
    "FootprintComparison": "maps",
}
# Points per inch: some 400 pixels, shown half as wide.
_DPI = 62.0


@offers("thumbnail", *_FIGURES)
def thumbnail(result: Any) -> bytes | None:
    """Bytes of a small PNG of a result, or None where it has nothing to draw: a list of points, a part of a field."""
    kind = next((one.__name__ for one in type(result).__mro__ if one.__name__ in _FIGURES), "")
    try:
        if kind != "Response":
            return png(getattr(result.plot, _FIGURES[kind])(), dpi=_DPI)
        data = result.dataset
        if "point" in data.dims or min(data.sizes["x"], data.sizes["y"]) < 2:
            return None
        return png(result.plot.strain_directions(float(data["depth"].to_numpy()[0])), dpi=_DPI)
    except Exception:
        # Whatever is wrong with the picture, the words beside it are shown.
        return None
