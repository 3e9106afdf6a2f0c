"""How every figure looks: type, colours, titles; and nothing global changed on the way."""

from __future__ import annotations

import functools
import math
import textwrap
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.transforms import offset_copy
from matplotlib.typing import ColorType

from treadload.errors import InputError, nearest
from treadload.plots.kit.us_figure import show_in_display_units
from treadload.registry import COLOUR_MAPS
from treadload.units import times_power_of_ten

INK = "#1b1f24"
MUTED = "#5b6470"
RULE = "#c9ced6"
PAPER = "#ffffff"

# States of contact, distinct also to readers with red-green colour blindness.
STICK, SLIP = "#0b6fae", "#d55e00"
# One colour per case, in the order given: blue, vermilion, green, purple, amber, black.
CASES = ("#0b6fae", "#d55e00", "#00805f", "#a5508a", "#b98700", "#1b1f24")
# Orientation of cracks: none, longitudinal, transverse, oblique, horizontal.
ORIENTATION_COLOURS = (RULE, "#0b6fae", "#d55e00", "#8a3b74", "#00805f")

_RC: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.5,
    "axes.titlesize": 11.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    # Ours stand clear of everything: left to itself matplotlib measures all ticks again for every title.
    "axes.titley": 1.0,
    "axes.labelsize": 9.5,
    "axes.labelcolor": INK,
    "axes.edgecolor": MUTED,
    "axes.linewidth": 0.7,
    "axes.facecolor": PAPER,
    "axes.axisbelow": True,
    "text.color": INK,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "grid.color": "#e4e7ec",
    "grid.linewidth": 0.7,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "hatch.linewidth": 0.5,
    "figure.facecolor": PAPER,
    "figure.dpi": 100,
    "figure.constrained_layout.h_pad": 0.06,
    "figure.constrained_layout.w_pad": 0.06,
    "savefig.dpi": 180,
    "savefig.facecolor": PAPER,
    "svg.fonttype": "path",
    "svg.hashsalt": "treadload",
    "pdf.fonttype": 42,
}

# Letters in a line of a title.
_TITLE = 52
# Distance of the x label's line below the axes, points.
_LABEL_LINE = 26
# Width of axes that have room for "x, direction of travel (mm)" and the arrow on that line, points.
_BESIDE_ARROW = 240

P = ParamSpec("P")
R = TypeVar("R")

# rcParams belong to the process: two threads of a server must not draw between each other's settings.
_LOCK = threading.RLock()
_inside: ContextVar[bool] = ContextVar("treadload_figure_drawn", default=False)


@contextmanager
def house_style() -> Iterator[None]:
    """The settings of treadload's figures inside a `with`; those from before afterwards."""
    with _LOCK, mpl.rc_context(_RC):
        yield


def styled(draw: Callable[P, R]) -> Callable[P, R]:
    """A function that draws in the package's style, and in the units of display, whatever others it draws by."""

    @functools.wraps(draw)
    def inside(*args: P.args, **kwargs: P.kwargs) -> R:
        outermost = not _inside.get()
        token = _inside.set(True)
        try:
            with house_style():
                drawn = draw(*args, **kwargs)
                if outermost and isinstance(drawn, Figure):
                    show_in_display_units(drawn)
                return drawn
        finally:
            _inside.reset(token)

    return inside


@COLOUR_MAPS.register("matplotlib")
def named_map(name: str) -> Colormap:
    """A colour map of matplotlib by its name. Raises InputError for one that is not known."""
    if name not in mpl.colormaps:
        suggestion = nearest(name, list(mpl.colormaps))
        hint = (
            suggestion
            if suggestion.startswith("did")
            else "known are jet, turbo, viridis, gray and others of matplotlib"
        )
        raise InputError(f"no colour map {name!r}; {hint}")
    return mpl.colormaps[name]


@functools.cache
def sequential(name: str) -> Colormap:
    """Perceptually uniform map from paper (nothing) to dark (most): "pressure", "shear", "strain", "height"."""
    base, low, high = {
        "pressure": ("viridis_r", 0.02, 1.0),
        "shear": ("viridis_r", 0.02, 1.0),
        "strain": ("magma_r", 0.0, 0.88),
        "height": ("cividis_r", 0.0, 1.0),
    }[name]
    source = mpl.colormaps[base]
    count = 256
    colours = [tuple(source(low + (high - low) * k / (count - 1))) for k in range(count)]
    # The first steps fade to paper, so that nothing reads as nothing.
    fade = 14
    for k in range(fade):
        weight = k / fade
        colours[k] = tuple(weight * c + (1 - weight) for c in colours[k])
    return LinearSegmentedColormap.from_list(f"treadload_{name}", colours, N=count)


def headline(ax: Axes, title: str, details: str = "", letters: int = _TITLE) -> None:
    """A bold title, at most so many letters in a line, with a quiet line of numbers under it, flush left."""
    lines = details.count("\n") + 1 if details else 0
    ax.set_title(textwrap.fill(plain(title), letters), loc="left", pad=6 + 12.5 * lines)
    if details:
        ax.annotate(
            details, (0, 1), xytext=(0, 5), xycoords="axes fraction", textcoords="offset points",
            ha="left", va="bottom", fontsize=8.5, color=MUTED, linespacing=1.35,
        )  # fmt: skip


def open_axes(*axes: Axes) -> None:
    """Axes of curves: a quiet grid, no frame above and right."""
    for ax in axes:
        ax.grid(True)
        ax.spines[["top", "right"]].set_visible(False)


def plain(text: str) -> str:
    """Text of a user, safe from being read as mathematics."""
    return text.replace("$", r"\$")


def halo(width: float = 2.5) -> list[withStroke]:
    """Paper around letters and lines that lie on a coloured field."""
    return [withStroke(linewidth=width, foreground=PAPER)]


def ink_on(colour: ColorType) -> str:
    """Of ink and paper, that which stands out more from a colour of matplotlib, by the contrast of WCAG 2."""

    def light(colour: ColorType) -> float:
        parts = np.array(to_rgb(colour))
        linear = np.where(parts <= 0.03928, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
        return float(linear @ (0.2126, 0.7152, 0.0722))

    ground = light(colour) + 0.05
    return INK if ground / (light(INK) + 0.05) > (light(PAPER) + 0.05) / ground else PAPER


def travel_arrow(ax: Axes) -> None:
    """An arrow under the right end of a map that points where the wheel goes, right of the label of its x."""
    ax.xaxis.label.set(x=0.0, horizontalalignment="left")
    if _width_in_points(ax) < _BESIDE_ARROW:
        # The arrow shows the direction.
        ax.set_xlabel(ax.get_xlabel().replace("x, direction of travel", "x"))
    start, end = (
        offset_copy(ax.transAxes, figure_of(ax), x=shift, y=-_LABEL_LINE, units="points") for shift in (-34, 0)
    )
    ax.annotate(
        "", (1, 0), xytext=(1, 0), xycoords=end, textcoords=start, annotation_clip=False,
        arrowprops={"arrowstyle": "-|>,head_width=0.26,head_length=0.5", "color": INK, "lw": 1.3,
                    "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip
    ax.annotate(
        "travel", (1, 0), xytext=(-38, -_LABEL_LINE), xycoords="axes fraction", textcoords="offset points",
        fontsize=8.5, ha="right", va="center",
    )  # fmt: skip


def _width_in_points(ax: Axes) -> float:
    """Width of axes as far as it is known before the layout."""
    box = ax.get_window_extent()
    width = float(box.width)
    if ax.get_aspect() == 1:
        (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
        width = min(width, float(box.height) * abs((right - left) / (high - low)))
    return width * 72.0 / figure_of(ax).dpi


def legend_below(ax: Axes, handles: Sequence[Artist], columns: int | None = None) -> None:
    """A legend under the label of the x axis, at a distance that does not depend on the size of the axes."""
    below = offset_copy(ax.transAxes, figure_of(ax), y=-_LABEL_LINE - 11, units="points")
    ax.legend(
        handles=list(handles), loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=below,
        ncols=columns or len(handles), handlelength=1.8, columnspacing=1.4, borderaxespad=0,
    )  # fmt: skip


def figure_of(ax: Axes) -> Figure:
    """The figure at the root of axes."""
    figure = ax.get_figure(root=True)
    if figure is None:
        raise InputError("these axes belong to no figure; make them with figure.add_subplot()")
    return figure


def measure(value: float) -> str:
    """A size with the digits that a reader needs: 1487, 26, 0.30."""
    return f"{value:.0f}" if abs(value) >= 9.95 else f"{value:.2g}"


def signed(value: float, digits: int = 1) -> str:
    """A number with a true minus sign."""
    return f"{value:z.{digits}f}".replace("-", "\u2212")


def thousands(value: float) -> str:
    """A whole number with narrow spaces between its thousands."""
    return f"{value:,.0f}".replace(",", "\u202f")


def power_of_ten(value: float) -> str:
    """A positive number as 1.2×10⁵, in characters that need no mathematics; a dash for none."""
    if not math.isfinite(value):
        return "∞" if value > 0 else "–"
    return times_power_of_ten(f"{value:.1e}")
