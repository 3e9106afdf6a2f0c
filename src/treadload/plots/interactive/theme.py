"""How figures on a page look: the package's colours on light and on dark paper."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
from matplotlib.typing import ColorType

from treadload.errors import InputError
from treadload.plots.kit.style import CASES, INK, MUTED, PAPER, RULE, SLIP, STICK, sequential

FONT = "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif"


@dataclass(frozen=True)
class Theme:
    """Colours of a page. ink: of text and arrows. halo: around what lies on a coloured field."""

    name: str
    paper: str
    ink: str
    muted: str
    rule: str
    halo: str
    stick: str
    slip: str
    rubber: str
    cases: tuple[str, ...]


LIGHT = Theme("light", PAPER, INK, MUTED, RULE, PAPER, STICK, SLIP, "#aab1bb", CASES)
DARK = Theme(
    "dark", "#14181d", "#e8ebef", "#a2abb6", "#39424d", "#14181d", "#56b4e9", "#ff9d45", "#59626d",
    ("#56b4e9", "#ff9d45", "#2fc79a", "#dd8fc4", "#e3c000", "#e8ebef"),
)  # fmt: skip
THEMES = {"light": LIGHT, "dark": DARK}

# Of a kind of quantity: map of matplotlib from dark to bright, and the ends of it that are used.
_BRIGHT = {
    "pressure": ("viridis", 0.0, 1.0),
    "shear": ("viridis", 0.0, 1.0),
    "strain": ("magma", 0.06, 1.0),
    "height": ("cividis", 0.0, 1.0),
}
_STEPS, _FADE = 33, 3


def theme_of(name: str | Theme) -> Theme:
    """A theme by its name. Raises InputError for another than "light" and "dark"."""
    if isinstance(name, Theme):
        return name
    if name not in THEMES:
        raise InputError(f"a theme of the page is 'light' or 'dark', got {name!r}")
    return THEMES[name]


@functools.cache
def colour_scale(kind: str, theme: str = "light") -> list[list[float | str]]:
    """Steps of a colour scale as plotly takes them, from nothing, the paper, to the most.

    kind: "pressure", "shear", "strain", "height"; "signed", whose middle is the paper; "zones" of open, stick, slip.
    """
    look = THEMES[theme]
    if kind == "zones":
        thirds = (look.paper, look.stick, look.slip)
        return [[edge / 3, colour] for number, colour in enumerate(thirds) for edge in (number, number + 1)]
    if kind == "signed":
        # Blue and vermilion, told apart by all readers; paler towards the middle.
        ends = (mpl.colors.to_rgb(look.cases[0]), mpl.colors.to_rgb(look.paper), mpl.colors.to_rgb(look.cases[1]))
        return [[0.0, _text(ends[0])], [0.5, _text(ends[1])], [1.0, _text(ends[2])]]
    paper = mpl.colors.to_rgb(look.paper)
    steps: list[list[float | str]] = []
    for number in range(_STEPS):
        share = number / (_STEPS - 1)
        if theme == "light":
            colour: Any = sequential(kind)(share)[:3]
        else:
            base, low, high = _BRIGHT[kind]
            colour_map, weight = mpl.colormaps[base](low + (high - low) * share)[:3], min(1.0, number / _FADE)
            colour = tuple(weight * a + (1 - weight) * b for a, b in zip(colour_map, paper, strict=True))
        steps.append([share, _text(colour)])
    return steps


def template(theme: Theme) -> dict[str, object]:
    """The template of plotly for a theme."""
    axis = {
        "gridcolor": theme.rule, "linecolor": theme.muted, "tickcolor": theme.muted, "zeroline": False,
        "ticks": "outside", "ticklen": 4, "showgrid": False, "showline": True, "mirror": False,
        "title": {"font": {"size": 12}, "standoff": 6}, "tickfont": {"size": 11}, "automargin": True,
        "separatethousands": False, "exponentformat": "power",
    }  # fmt: skip
    solid = {**{k: axis[k] for k in ("gridcolor", "linecolor", "tickfont")}, "backgroundcolor": theme.paper,
             "showbackground": False, "zeroline": False}  # fmt: skip
    return {
        "layout": {
            "font": {"family": FONT, "size": 12, "color": theme.ink},
            "paper_bgcolor": theme.paper, "plot_bgcolor": theme.paper,
            "colorway": list(theme.cases), "xaxis": axis, "yaxis": axis,
            "scene": {"xaxis": solid, "yaxis": solid, "zaxis": solid},
            "hoverlabel": {"font": {"family": FONT, "size": 12, "color": theme.ink}, "bgcolor": theme.paper,
                           "bordercolor": theme.muted},
            "legend": {"bgcolor": "rgba(0,0,0,0)", "font": {"size": 11}},
            "annotationdefaults": {"font": {"color": theme.ink}},
            "separators": ".\u202f", "hovermode": "closest", "dragmode": "pan",
            "modebar": {"bgcolor": "rgba(0,0,0,0)", "color": theme.muted, "activecolor": theme.ink},
        }
    }  # fmt: skip


def _text(colour: ColorType) -> str:
    return str(mpl.colors.to_hex(colour))
