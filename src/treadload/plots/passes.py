"""What passes leave: the rut, plastic strain, residual stress with depth; and which loads come to rest."""

from __future__ import annotations

from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.plan import DEPTH_LABEL, MM, Y_LABEL, colour_bar, fields_of, limits, mark_peak, peak_of
from treadload.plots.kit.style import CASES, INK, MUTED, headline, measure, sequential, styled
from treadload.response.passes.verdict import in_words

# Ruts below so many mm are given in µm.
_FINE = 0.1
# Passes that one figure tells apart.
_SHOWN = 6
_WORDS = {"xx": "along travel", "yy": "across travel", "zz": "vertical"}


def _has_yielded(data: xr.Dataset) -> bool:
    return bool(data["equivalent_plastic_strain"].any())


@figure(
    "Passes", name="rut", main=True, title="Rut across travel", wide=True, order=1,
    caption="Displacement of the surface that passes leave, down; the same all along travel.",
)  # fmt: skip
@styled
def rut_profile(passes: Source, *, ax: Axes | None = None) -> Figure:
    """Shape of the surface across travel that passes leave, pass by pass, down positive.

    passes: with residual_displacement_z over (pass, across), m. Returns the figure.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(0.4e6, kinematic=60e6))
    >>> tire, road = tl.UniformDisc(0.1, 0.9e6), tl.Pavement.half_space(yielding)
    >>> passes = tl.response.roll_passes(tire, road, passes=2, spacing=0.1, layers=3)
    >>> tl.plots.rut_profile(passes).axes[0].get_ylabel()
    'surface, down (µm)'
    """
    data = fields_of(passes, "residual_displacement_z", "rut_depth", "pass", "across")
    profile, across = data["residual_displacement_z"].to_numpy() * MM, data["across"].to_numpy() * MM
    figure, ax = figure_and_axes(ax, 8.0, 4.0)
    factor, unit = (1e3, "µm") if np.abs(profile).max() < _FINE else (1.0, "mm")
    numbers = data["pass"].to_numpy()
    rows = _rows(len(numbers))
    shades = sequential("strain")(np.linspace(0.25, 0.85, len(rows)))
    for row, shade in zip(rows, shades, strict=True):
        label = f"{numbers[row]:g} pass{'' if numbers[row] == 1 else 'es'}"
        ax.plot(across, profile[row] * factor, color=shade, label=label)
    ax.axhline(0, color=MUTED, lw=0.7)
    ax.invert_yaxis()
    ax.set_xlim(across[0], across[-1])
    ax.set_xlabel(Y_LABEL)
    ax.set_ylabel(f"surface, down ({unit})")
    ax.grid(True)
    ax.legend(loc="lower right")
    deepest = float(data["rut_depth"][-1]) * MM * factor
    verdict = in_words(data.attrs.get("verdict", ""), data.attrs.get("falls"))
    headline(ax, "Rut across travel", f"{measure(deepest)} {unit} after {numbers[-1]:g} passes; {verdict}")
    return figure


@figure(
    "Passes", name="drum", title="Drum on its own track", wide=True, order=0,
    caption="Pressure along travel below the drum's middle, and its depth below the first surface.",
    when=lambda data: "pressure" in data,
)  # fmt: skip
@styled
def drum_contact(passes: Source) -> Figure:
    """A drum on its own track: its pressure along travel through its middle, and how deep it stands, pass by pass.

    passes: of `response.roll_drum`, with pressure over (pass, y, x), Pa, and approach and rut_depth by pass, m.
    Returns the figure.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(3e6, kinematic=60e6))
    >>> steel = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(210e9, 0.3))
    >>> road, cells = tl.Pavement.half_space(yielding), {"spacing": (0.003, 0.003), "depth": 0.009, "layers": 3}
    >>> passes = tl.response.roll_drum(steel, road, 120.0, **cells)
    >>> [ax.get_ylabel() for ax in tl.plots.drum_contact(passes).axes]
    ['pressure (MPa)', 'depth (µm)']
    """
    data = fields_of(passes, "pressure", "approach", "rut_depth", "contact_length", "pass", "y", "x")
    numbers, x = data["pass"].to_numpy(), data["x"].to_numpy() * MM
    pressure = data["pressure"].sel(y=0.0, method="nearest").to_numpy()
    factor, unit = (1e-6, "MPa") if pressure.max() >= 1e6 else (1e-3, "kPa")
    figure = new_figure(9.0, 3.9)
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    rows = _rows(len(numbers))
    shades = sequential("strain")(np.linspace(0.25, 0.85, len(rows)))
    for row, shade in zip(rows, shades, strict=True):
        left.plot(x, pressure[row] * factor, color=shade, marker="o", ms=3, label=f"{numbers[row]:g}")
    reach = np.abs(x[(pressure > 0).any(axis=0)]).max(initial=x[-1] - x[-2]) + 2 * (x[1] - x[0])
    left.set_xlim(-reach, reach)
    left.axvline(0, color=MUTED, lw=0.7)
    left.set_xlabel("x, ahead of the axle (mm)")
    left.set_ylabel(f"pressure ({unit})")
    left.legend(title="pass")
    depths = {"drum below the first surface": data["approach"], "rut": data["rut_depth"]}
    small = max(float(depth.max()) for depth in depths.values()) * MM < _FINE
    for (name, depth), colour in zip(depths.items(), CASES, strict=False):
        right.plot(numbers, depth.to_numpy() * (1e6 if small else MM), color=colour, marker="o", ms=4, label=name)
    right.set_ylim(bottom=0)
    right.set_xlabel("pass")
    right.xaxis.get_major_locator().set_params(integer=True)
    right.set_ylabel("depth (µm)" if small else "depth (mm)")
    right.legend()
    for ax in (left, right):
        ax.grid(True)
    lengths = data["contact_length"].to_numpy() * MM
    headline(
        left, "Drum on its own track", f"contact {measure(lengths[0])} mm long in the first pass, "
        f"{measure(lengths[-1])} mm in the last"
    )  # fmt: skip
    return figure


@figure(
    "Passes", name="strain", title="Plastic strain", wide=True, order=2,
    caption="Equivalent plastic strain after the last pass.", when=_has_yielded,
)  # fmt: skip
@styled
def plastic_strain(passes: Source, *, ax: Axes | None = None) -> Figure:
    """Accumulated equivalent plastic strain after the last pass, in a section across travel, %.

    passes: with equivalent_plastic_strain over (pass, depth, y). Returns the figure.
    Raises InputError where nothing has yielded.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(0.4e6, kinematic=60e6))
    >>> tire, road = tl.UniformDisc(0.1, 0.9e6), tl.Pavement.half_space(yielding)
    >>> passes = tl.response.roll_passes(tire, road, passes=2, spacing=0.1, layers=3)
    >>> tl.plots.plastic_strain(passes).axes[0].get_title(loc="left")
    'Plastic strain'
    """
    data = fields_of(passes, "equivalent_plastic_strain", "depth", "y").isel({"pass": -1})
    field = 100 * data["equivalent_plastic_strain"].transpose("depth", "y").to_numpy()
    if not field.any():
        raise InputError("nothing has yielded in these passes: there is no plastic strain to draw")
    down, across = data["depth"].to_numpy() * MM, data["y"].to_numpy() * MM
    figure, ax = figure_and_axes(ax, 8.0, 3.8)
    edges = np.asarray(data.attrs.get("row_edges", ()), float) * MM
    if len(edges) != len(down) + 1:
        edges = np.concatenate([[1.5 * down[0] - 0.5 * down[1]], 0.5 * (down[1:] + down[:-1]), [down[-1]]])
    sides = np.concatenate([across - 0.5 * (across[1] - across[0]), [1.5 * across[-1] - 0.5 * across[-2]]])
    scale = limits(field)
    mesh = ax.pcolormesh(
        sides, edges, field, cmap=sequential("strain"), vmin=0.0, vmax=scale.high, shading="flat", rasterized=True
    )
    ax.set_xlim(sides[0], sides[-1])
    ax.set_ylim(edges[-1], edges[0])
    ax.set_xlabel(Y_LABEL)
    ax.set_ylabel(DEPTH_LABEL)
    row, column = peak_of(field, horizontal=1)
    peak = float(field[row, column])
    mark_peak(ax, float(across[column]), float(down[row]), measure(peak))
    colour_bar(mesh, ax, "%", scale)
    number = float(data["pass"])
    headline(
        ax, "Plastic strain", f"equivalent, after {number:g} passes; peak {measure(peak)} %, {down[row]:.3g} mm deep"
    )
    return figure


@figure(
    "Passes", name="stress", title="Residual stress", order=3,
    caption="Along travel, below the wheel's line, tension positive.", when=_has_yielded,
)  # fmt: skip
@styled
def residual_stress(
    passes: Source, component: Literal["xx", "yy", "zz"] = "xx", *, y: float = 0.0, ax: Axes | None = None
) -> Figure:
    """Residual stress against depth below a line of the surface, pass by pass, tension positive.

    passes: with residual_stress_* over (pass, depth, y), Pa. component: of the tensor. y: of the line, m, the nearest
    there is. Returns the figure. Raises InputError for another component.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(0.4e6, kinematic=60e6))
    >>> tire, road = tl.UniformDisc(0.1, 0.9e6), tl.Pavement.half_space(yielding)
    >>> passes = tl.response.roll_passes(tire, road, passes=2, spacing=0.1, layers=3)
    >>> tl.plots.residual_stress(passes, "xx").axes[0].get_xlabel()
    'residual stress along travel (kPa)'
    """
    if component not in _WORDS:
        raise InputError(f"no component {component!r} of residual stress here; {nearest(component, _WORDS)}")
    name = f"residual_stress_{component}"
    data = fields_of(passes, name, "depth", "y", "pass").sel(y=y, method="nearest")
    stress, down, numbers = data[name].to_numpy(), data["depth"].to_numpy() * MM, data["pass"].to_numpy()
    factor, unit = (1e-6, "MPa") if np.abs(stress).max() >= 1e6 else (1e-3, "kPa")
    figure, ax = figure_and_axes(ax, 5.6, 4.8)
    rows = _rows(len(numbers))
    shades = sequential("strain")(np.linspace(0.25, 0.85, len(rows)))
    for row, shade in zip(rows, shades, strict=True):
        ax.plot(stress[row] * factor, down, color=shade, marker="o", ms=3, label=f"{numbers[row]:g}")
    ax.axvline(0, color=MUTED, lw=0.7)
    ax.invert_yaxis()
    ax.set_xlabel(f"residual stress {_WORDS[component]} ({unit})")
    ax.set_ylabel(DEPTH_LABEL)
    ax.grid(True)
    ax.legend(title="passes")
    headline(ax, "Residual stress", f"σ_{component} below y = {float(data['y']) * MM:.3g} mm, tension positive")
    return figure


@styled
def shakedown_map(fields: Source, *, ax: Axes | None = None) -> Figure:
    """Which loads yield nowhere, come to rest, or go on yielding, over the shear that they carry.

    fields: of `study.shakedown_map`. Loads are relative to that at first yield without shear. Returns the figure.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(0.4e6, kinematic=60e6))
    >>> patch, road = tl.UniformRectangle(0.2, 0.2, 0.3e6), tl.Pavement.half_space(yielding)
    >>> limits = tl.life.shakedown_map(patch, road, [0.0, 0.4], spacing=0.1, layers=3).dataset
    >>> tl.plots.shakedown_map(limits).axes[0].get_xlabel()
    'shear over pressure, all of it along travel'
    """
    data = fields_of(fields, "shakedown_load", "elastic_limit_load", "friction")
    friction = data["friction"].to_numpy()
    elastic, rest = data["elastic_limit_load"].to_numpy(), data["shakedown_load"].to_numpy()
    figure, ax = figure_and_axes(ax, 6.4, 4.4)
    top = 1.25 * float(rest.max())
    ax.fill_between(friction, 0, elastic, color=CASES[0], alpha=0.18, lw=0)
    ax.fill_between(friction, elastic, rest, color=CASES[1], alpha=0.18, lw=0)
    ax.plot(friction, elastic, color=CASES[0], marker="o", ms=4, label="first yield")
    ax.plot(friction, rest, color=CASES[1], marker="o", ms=4, label="shakedown")
    ax.set_xlim(friction[0], friction[-1])
    ax.set_ylim(0, top)
    ax.set_xlabel("shear over pressure, all of it along travel")
    ax.set_ylabel("load over that at first yield without shear")
    middle = len(friction) // 2
    for height, words in (
        (0.5 * elastic[middle], "elastic"),
        (0.5 * (elastic[middle] + rest[middle]), "shakes down"),
        (0.5 * (rest[middle] + top), "goes on yielding"),
    ):
        ax.text(friction[middle], height, words, ha="center", va="center", color=INK)
    ax.grid(True)
    ax.legend(loc="upper right")
    headline(ax, "Shakedown", str(data.attrs.get("law", "")))
    return figure


def _rows(count: int) -> list[int]:
    """Which passes are drawn: the first, the last, and some between, evenly in the number's place."""
    return sorted({round(row) for row in np.linspace(0, count - 1, min(count, _SHOWN))})
