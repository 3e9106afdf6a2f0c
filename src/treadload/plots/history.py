"""What happens over distance or angle: forces, torque and slip of a wheel step by step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.plots.contact import shear
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, MUTED, headline, open_axes, styled


@figure(
    "TransientResult", name="history", main=True, title="Against the distance", wide=True,
    caption="Forces, and the share of the contact that slips.",
)  # fmt: skip
@styled
def transient_history(transient: Source) -> Figure:
    """Forces of the road on the tire, and the share of the contact that slips, against the distance rolled.

    transient: a TransientResult or its dataset. Returns the figure. Raises InputError for missing variables.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> transient = tl.contact.solve_transient(tire, road, wheel, distances=[0.005, 0.01], spacing=0.006)
    >>> [ax.get_ylabel() for ax in tl.plots.transient_history(transient).axes]
    ['force of the road on the tire (kN)', 'share of the contact that slips (%)']
    """
    data = fields_of(transient, "distance", "tractive_force", "lateral_force", "slip_fraction")
    far = 1e3 * data["distance"].to_numpy()
    left, right = _panels("distance rolled (mm)")
    forces = {"along travel": "tractive_force", "to the right": "lateral_force"}
    for number, (label, name) in enumerate(forces.items()):
        left.plot(far, 1e-3 * data[name].to_numpy(), color=CASES[number], label=label)
    left.set_ylabel("force of the road on the tire (kN)")
    left.legend()
    headline(left, "Forces")
    right.plot(far, 100 * data["slip_fraction"].to_numpy(), color=CASES[1])
    headline(right, "Slip zone")
    return left.figure  # type: ignore[return-value]


@figure(
    "TurnResult", name="history", main=True, title="Against the angle", wide=True,
    caption="Forces, and the share of the contact that slips.",
)  # fmt: skip
@styled
def turn_history(turn: Source) -> Figure:
    """Torque that turns a standing wheel, and the share of the contact that slips, against its angle.

    turn: a TurnResult or its dataset. Returns the figure. Raises InputError for missing variables.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> turn = tl.contact.turn_on_the_spot(tire, road, wheel, angles=[0.5], spacing=0.006)
    >>> [ax.get_ylabel() for ax in tl.plots.turn_history(turn).axes]
    ['steering torque (kN m)', 'share of the contact that slips (%)']
    """
    data = fields_of(turn, "turn_angle", "steering_torque", "slip_fraction", "sliding_torque")
    angle, limit = np.degrees(data["turn_angle"].to_numpy()), 1e-3 * float(data["sliding_torque"])
    left, right = _panels("angle of the wheel (°)")
    left.plot(angle, 1e-3 * data["steering_torque"].to_numpy(), color=CASES[0])
    left.axhline(limit, color=INK, ls=":", lw=1)
    left.annotate(
        "all slides", (0, limit), (3, 3), xycoords=("axes fraction", "data"), textcoords="offset points", fontsize=8.5
    )
    left.set_ylim(None, max(1.12 * limit, left.get_ylim()[1]))
    left.set_ylabel("steering torque (kN m)")
    headline(left, "Torque")
    right.plot(angle, 100 * data["slip_fraction"].to_numpy(), color=CASES[1])
    headline(right, "Slip zone")
    return left.figure  # type: ignore[return-value]


def _at_the_end(data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> Iterator[Drawing]:
    contact = beside.get("contact")
    if contact is not None and "part_of" in contact.attrs:
        yield Drawing({"contact": contact})


@figure(
    "TransientResult", "TurnResult", title="Shear at the end", wide=True,
    caption="Shear in plan; hatched cells slip.", when=_at_the_end,
)  # fmt: skip
def shear_at_the_end(history: Source, contact: Source | None = None) -> Figure:
    """Shear after the last step as a surface in space, beside its plan with the zones that stick and slip, kPa.

    history: a TransientResult or a TurnResult. contact: at its end; needed of a dataset. Returns the figure. Raises
    InputError where the contact is missing.
    """
    contact = contact or getattr(history, "contact", None)
    if contact is None:
        raise InputError("the contact at the end is not in this dataset; give it as contact=")
    return shear(contact)


def _panels(label: str) -> tuple[Axes, Axes]:
    figure = new_figure(8.6, 3.9)
    left, right = figure.subplots(1, 2)
    open_axes(left, right)
    for ax in (left, right):
        ax.axhline(0, color=MUTED, lw=0.7)
        ax.set_xlabel(label)
    right.set_ylabel("share of the contact that slips (%)")
    # Limits that are set before lines are drawn stay as they are.
    right.set_ylim(0, 102)
    return left, right
