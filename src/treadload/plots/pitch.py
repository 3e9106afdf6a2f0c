"""A tread with blocks over one pitch: what changes from position to position, and maps where shear is largest."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import KPA, MICRO, MM, Plan, colour_bar, draw_cells, draw_outline, fields_of, limits
from treadload.plots.kit.style import CASES, headline, measure, open_axes, sequential, signed, styled

# A force that is none, kN.
_NO_FORCE = 1e-6


@figure(
    "PitchPassage", name="history", main=True, title="Over one pitch", wide=True,
    caption="Peaks, area, and forces or creepages at every position of the wheel; means are dashed.",
)  # fmt: skip
@styled
def pitch_history(passage: Source) -> Figure:
    """Peak pressure and shear, contact area, forces or creepages, over the place of the axle.

    passage: a PitchPassage or its dataset. Returns the figure.

    >>> passage = tl.open_results("pitch.nc").pitch  # of tl.contact.solve_pitch, which takes 10 s
    >>> [ax.get_ylabel() for ax in tl.plots.pitch_history(passage).axes]
    ['largest of a cell (kPa)', 'contact area (cm²)', 'creepage (%)']
    """
    names = ("largest_pressure", "largest_traction", "contact_area", "tractive_force", "lateral_force")
    data = fields_of(passage, *names, "creepage_x", "creepage_y", "position")
    at = data["position"].to_numpy() * MM
    figure = new_figure(7.4, 7.4)
    upper, middle, lower = figure.subplots(3, 1, sharex=True)
    for name, label, colour in (("largest_pressure", "pressure", CASES[0]), ("largest_traction", "shear", CASES[1])):
        values = data[name].to_numpy() * KPA
        upper.plot(at, values, "o-", ms=3, color=colour, label=label)
        upper.axhline(values.mean(), color=colour, lw=0.9, ls="--")
    upper.set_ylabel("largest of a cell (kPa)")
    upper.set_ylim(bottom=0)
    upper.legend()
    area = data["contact_area"].to_numpy() * 1e4
    middle.plot(at, area, "o-", ms=3, color=CASES[0])
    middle.axhline(area.mean(), color=CASES[0], lw=0.9, ls="--")
    middle.set_ylabel("contact area (cm²)")
    forces = [data[name].to_numpy() * 1e-3 for name in ("tractive_force", "lateral_force")]
    if max(np.abs(force).max() for force in forces) > _NO_FORCE:
        curves, label = forces, "force on the tire (kN)"
    else:
        # Rolling freely has no force, and what changes is the creepage.
        curves, label = [data[name].to_numpy() * 100 for name in ("creepage_x", "creepage_y")], "creepage (%)"
    for values, along, colour in zip(curves, ("along", "across"), CASES, strict=False):
        lower.plot(at, values, "o-", ms=3, color=colour, label=along)
        lower.axhline(values.mean(), color=colour, lw=0.9, ls="--")
    lower.set_ylabel(label)
    lower.set_xlabel("place of the axle in the pitch (mm)")
    lower.legend()
    open_axes(upper, middle, lower)
    pitch = float(data.attrs.get("pitch", np.nan)) * MM
    headline(upper, "Over one pitch", f"{measure(pitch)} mm, {len(at)} positions")
    return figure


@figure(
    "PitchPassage", name="maps", title="Where shear is largest", wide=True,
    caption="Pressure, shear along and shear to the right at the position with the largest shear of a cell.",
)  # fmt: skip
@styled
def pitch_maps(passage: Source, *, position: int | None = None) -> Figure:
    """Pressure and both shears, kPa, at a position of the wheel.

    passage: a PitchPassage or its dataset. position: number; left out, that with the largest shear of a cell.
    Returns the figure.

    >>> passage = tl.open_results("pitch.nc").pitch  # of tl.contact.solve_pitch, which takes 10 s
    >>> tl.plots.pitch_maps(passage).axes[0].get_title(loc="left")
    'Axle at 60.0 mm'
    """
    data = fields_of(passage, "pressure", "traction_x", "traction_y", "largest_traction", "position", "x", "y")
    number = int(data["largest_traction"].to_numpy().argmax()) if position is None else position
    here = data.isel(position=number)
    axle = float(here["position"])
    here = here.assign_coords(x=here["x"] - axle)
    pressure = here["pressure"].transpose("y", "x").to_numpy() * KPA
    touched = pressure > 0
    along, across = np.flatnonzero(touched.any(0)), np.flatnonzero(touched.any(1))
    part = {"x": slice(max(along[0] - 2, 0), along[-1] + 3), "y": slice(max(across[0] - 2, 0), across[-1] + 3)}
    here = here.isel(part)
    pressure, touched = pressure[part["y"], part["x"]], touched[part["y"], part["x"]]
    plan = Plan.of(here)
    shears = [here[name].transpose("y", "x").to_numpy() * KPA for name in ("traction_x", "traction_y")]
    largest = max(float(np.abs(shear).max()) for shear in shears) or 1.0
    figure = new_figure(12.0, 4.6)
    axes = figure.subplots(1, 3, sharey=True)
    scale = limits(pressure)
    mesh = draw_cells(axes[0], plan, np.where(touched, pressure, np.nan), sequential("pressure"), scale)
    colour_bar(mesh, axes[0], "contact pressure (kPa)", scale)
    for ax, shear, label in zip(
        axes[1:], shears, ("shear along travel (kPa)", "shear to the right (kPa)"), strict=True
    ):
        mesh = ax.pcolormesh(
            plan.x_edges, plan.y_edges, np.ma.masked_where(~touched, shear), cmap="RdBu_r", vmin=-largest,
            vmax=largest, rasterized=True,
        )  # fmt: skip
        ax.set_aspect("equal")
        ax.set_xlabel("x, direction of travel (mm)")
        colour_bar(mesh, ax, label, limits(np.abs(shear)))
    for ax in axes:
        draw_outline(ax, touched, plan)
    headline(axes[0], f"Axle at {signed(axle * MM)} mm", f"peak {measure(float(pressure.max()))} kPa", 24)
    for ax, shear in zip(axes[1:], shears, strict=True):
        headline(ax, "", f"peak {measure(float(np.abs(shear).max()))} kPa", 24)
    return figure


@figure(
    "PitchResponse", name="strains", main=True, title="Strains over one pitch", wide=True,
    caption="Largest tensile strain in the horizontal plane at every depth; means are dashed.",
)  # fmt: skip
@styled
def pitch_strains(response: Source) -> Figure:
    """Largest tensile strain in the horizontal plane over the place of the axle, a curve a depth, microstrain.

    response: a PitchResponse or its dataset. Returns the figure.

    >>> import xarray as xr
    >>> strains = {"largest_in_plane_extension": (("depth", "position"), [[60e-6, 80e-6, 70e-6, 60e-6]])}
    >>> response = xr.Dataset(strains, {"depth": [0.02], "position": [0.0, 0.015, 0.03, 0.045]})
    >>> f"{tl.plots.pitch_strains(response).axes[0].lines[0].get_ydata().max():.0f} microstrain"
    '80 microstrain'
    """
    data = fields_of(response, "largest_in_plane_extension", "position", "depth")
    at = data["position"].to_numpy() * MM
    strains = data["largest_in_plane_extension"].transpose("depth", "position").to_numpy() * MICRO
    figure = new_figure(7.4, 4.2)
    ax = figure.subplots()
    for number, (depth, values) in enumerate(zip(data["depth"].to_numpy(), strains, strict=True)):
        colour = CASES[number % len(CASES)]
        ax.plot(at, values, "o-", ms=3, color=colour, label=f"{measure(float(depth) * MM)} mm deep")
        ax.axhline(values.mean(), color=colour, lw=0.9, ls="--")
    ax.set_xlabel("place of the axle in the pitch (mm)")
    ax.set_ylabel("largest tensile strain (microstrain)")
    ax.legend()
    open_axes(ax)
    headline(ax, "Strains over one pitch", f"at most {measure(float(strains.max()))} microstrain")
    return figure
