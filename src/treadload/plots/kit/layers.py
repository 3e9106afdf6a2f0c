"""Layers of a road in figures: where they end, what they are called, a field cut at their interfaces."""

from __future__ import annotations

import json
import textwrap
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.layers.depths import SAME_DEPTH, layers_at, on_interface
from treadload.plots.kit.plan import MM, fields_of
from treadload.plots.kit.style import INK, MUTED, PAPER, RULE, figure_of, halo, plain

# Depths, mm, this near to each other count as one.
_SAME = SAME_DEPTH * MM
# Letters in a line of a layer's name, and of one that has a single line; type, points.
_LETTERS = 16
_SINGLE = 22
_TYPE = 8.0
_LINE = 10.5
# Distance of the names from the axes, points.
_BESIDE = 7.0
# A name that stands further than this from its layer is led there by a line so long, points.
_MOVED = 2.0
_LED = 5.0


@dataclass(frozen=True)
class Layers:
    """Layers from the surface down.

    interfaces: depths of their bottoms, mm, (n,). names: one more, all filled. side: of an interface that a response
    at its depth stands for, "above" or "below".
    """

    interfaces: tuple[float, ...]
    names: tuple[str, ...]
    side: str = "above"

    @classmethod
    def of(cls, data: xr.Dataset) -> Layers:
        """By a response's attributes `interfaces` (m), `layer_names` (JSON) and `side`; else one layer."""
        # A file gives back a list of one as a number.
        ends = np.atleast_1d(np.asarray(data.attrs.get("interfaces", []), dtype=float)) * MM
        layer_names = data.attrs.get("layer_names", "[]")
        names = [str(name) for name in (json.loads(layer_names) if isinstance(layer_names, str) else layer_names)]
        if len(names) == len(ends) and len(ends):
            names.append("rigid base")
        names += [""] * (len(ends) + 1 - len(names))
        filled = [name or f"layer {number}" for number, name in enumerate(names, start=1)]
        return cls(tuple(ends.tolist()), tuple(filled[: len(ends) + 1]), str(data.attrs.get("side", "above")))

    def spans(self, bottom: float) -> list[tuple[str, float, float]]:
        """Name, top and end of every layer that reaches above a depth, mm; the last one ends there."""
        sides = (0.0, *self.interfaces, np.inf)
        return [
            (name, top, min(end, bottom))
            for name, top, end in zip(self.names, sides[:-1], sides[1:], strict=True)
            if top < bottom - _SAME
        ]

    def pieces(self, depths: Array) -> list[slice]:
        """The rows of each layer in increasing depths (n,), mm; empty for a layer without one.

        A depth on an interface belongs to the layer on its `side`; of two equal ones the first belongs to the layer
        above, the second to the layer below.
        """
        twice = np.concatenate([[False], np.diff(depths) <= _SAME])
        lone = ~(twice | np.append(twice[1:], False))
        below = twice | (lone & (self.side == "below"))
        rows = layers_at(depths / MM, np.array(self.interfaces) / MM, below)
        sides = np.searchsorted(rows, np.arange(len(self.names) + 1))
        return [slice(int(start), int(end)) for start, end in pairwise(sides)]


def both_sides(above: Source, below: Source) -> xr.Dataset:
    """One dataset of two responses that differ in the side of the interfaces, so that figures show the jump.

    above, below: solved at the same points with side="above" and side="below". Returns the first with the rows
    of the second that lie on an interface added after its own; depths increase, those of interfaces appear twice.
    Raises InputError if the points differ.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, at = tl.UniformDisc(0.15, 7e5), {"depths": [0.15], "x": [0.0], "y": [0.0]}
    >>> sides = (tl.solve_response(plate, road, side=side, **at) for side in ("above", "below"))
    >>> stress = tl.plots.both_sides(*sides).stress_xx
    >>> [f"{value / 1e3:.0f} kPa" for value in stress.values.ravel()]  # the layers share strain, not stress
    ['2034 kPa', '-18 kPa']
    """
    upper, lower = fields_of(above, "depth").sortby("depth"), fields_of(below, "depth").sortby("depth")
    if not all(upper[name].equals(lower[name]) for name in ("x", "y")):
        raise InputError("the two sides of an interface must be solved at the same x and y")
    ends = np.array(Layers.of(upper).interfaces)
    shared = on_interface(lower["depth"].to_numpy(), ends / MM)
    if not shared.any():
        return upper
    joined = xr.concat(
        [upper, lower.isel(depth=shared)],
        "depth", data_vars="minimal", coords="minimal", compat="override", join="override", combine_attrs="override",
    )  # fmt: skip
    # Stable: the row above stays before the row below.
    return joined.isel(depth=np.argsort(joined["depth"].to_numpy(), kind="stable"))


def draw_interfaces(ax: Axes, layers: Layers, bottom: float, *, on_colours: bool = False) -> None:
    """A line at every interface above a depth, mm, on axes whose y is depth. on_colours: over a coloured field."""
    for depth in layers.interfaces:
        if depth < bottom - _SAME:
            line = ax.axhline(depth, color=INK if on_colours else MUTED, lw=0.9, zorder=2.6)
            line.set_gid("interface")
            if on_colours:
                line.set_path_effects([*halo(2.4)])


def name_layers(ax: Axes, layers: Layers, bottom: float) -> float:
    """Names and thicknesses of the layers right of axes whose y is the depth. Returns the width they take, points.

    Names of thin layers move apart and are led to their place. A road of one layer is not named.
    """
    spans = layers.spans(bottom)
    if len(layers.names) < 2:
        return 0.0
    height = _height_in_points(ax)
    scale = height / bottom
    texts = [_label(name, _thickness(layers, k), (end - top) * scale) for k, (name, top, end) in enumerate(spans)]
    sizes = np.array([_LINE * (text.count("\n") + 1) for text in texts])
    wanted = np.array([(top + end) / 2 * scale for _, top, end in spans])
    placed = _apart(wanted, sizes, height)
    for text, at, want in zip(texts, placed, wanted, strict=True):
        moved = abs(at - want) > _MOVED
        note = ax.annotate(
            text, (1, want / scale), xycoords=ax.get_yaxis_transform(), xytext=(_BESIDE + _LED * moved, want - at),
            textcoords="offset points", ha="left", va="center", fontsize=_TYPE, color=INK, linespacing=1.15,
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": RULE, "lw": 0.8, "shrinkA": 1, "shrinkB": 0, "relpos": (0, 0.5)}
            if moved else None,
        )  # fmt: skip
        note.set_gid("layer")
    longest = max(len(line) for text in texts for line in text.split("\n"))
    return _BESIDE + _LED * bool((abs(placed - wanted) > _MOVED).any()) + 0.56 * _TYPE * longest


def hatch_unknown(ax: Axes, top: float, end: float) -> None:
    """Mark depths, mm, of a layer in which nothing was computed."""
    patch = ax.axhspan(top, end, facecolor=PAPER, edgecolor=RULE, hatch="////", lw=0, zorder=1.5)
    patch.set_gid("unknown")


def _thickness(layers: Layers, number: int) -> str:
    if number >= len(layers.interfaces):
        return ""
    top = layers.interfaces[number - 1] if number else 0.0
    return f"{layers.interfaces[number] - top:.4g} mm"


def _label(name: str, thickness: str, room: float) -> str:
    """A name and a thickness in lines as the room, points, allows; in one at least, shortened."""
    lines = textwrap.wrap(name, _LETTERS) or [name]
    if room >= _LINE * (len(lines) + bool(thickness)):
        return plain("\n".join([*lines, thickness] if thickness else lines))
    whole = f"{name}, {thickness}" if thickness else name
    lines = textwrap.wrap(whole, _SINGLE)
    if room >= _LINE * len(lines):
        return plain("\n".join(lines))
    kept = _SINGLE - (len(thickness) + 2 if thickness else 0)
    short = name if len(name) <= kept else name[: kept - 1].rstrip(" ,") + "…"
    return plain(f"{short}, {thickness}" if thickness else short)


def _apart(wanted: Array, sizes: Array, height: float) -> Array:
    """Places down the page, points, as near to those wanted as boxes of these sizes can stand within a height."""
    placed = wanted.copy()
    low = 0.0
    for k, size in enumerate(sizes):
        placed[k] = max(placed[k], low + size / 2)
        low = placed[k] + size / 2
    high = max(height, float(sizes.sum()))
    for k in range(len(sizes) - 1, -1, -1):
        placed[k] = min(placed[k], high - sizes[k] / 2)
        high = placed[k] - sizes[k] / 2
    return placed


def _height_in_points(ax: Axes) -> float:
    """Height of axes as far as it is known before the layout."""
    box = ax.get_window_extent()
    height = float(box.height)
    if ax.get_aspect() == 1:
        (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
        height = min(height, float(box.width) * abs((high - low) / (right - left)))
    return height * 72.0 / figure_of(ax).dpi
