"""A truck wheel turned on the spot: the torque it takes, and what it does to the road.

The 315/80R22.5 tread stands under 32.5 kN on asphalt, μ = 0.7, and turns to the right until it slides, then
back. Prints torque and slip against the angle and the surface's largest tensile strain before and after the turn;
writes the figures.

    python examples/parking_turn.py [folder] [--coarse]
"""

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import treadload as tl
from treadload.contact.turning import TurnResult, turn_on_the_spot
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, INK, MUTED, headline, open_axes, styled

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
STANDING = tl.Rolling(normal_load=32.5e3, friction=0.7)
LARGEST = math.radians(30)


def turned(spacing: float, increments: int) -> tuple[TurnResult, TurnResult]:
    """The turn to the right, and the whole loop: right, left and right again."""
    tire = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.5))
    there = np.linspace(0, LARGEST, increments + 1)[1:]
    right = turn_on_the_spot(tire, ROAD, STANDING, angles=there, spacing=spacing)
    to_and_fro = np.concatenate([there, LARGEST - 2 * there, 2 * there - LARGEST])
    return right, turn_on_the_spot(tire, ROAD, STANDING, angles=to_and_fro, spacing=2 * spacing)


def extension(contact: tl.contact.Contact) -> tl.response.Response:
    """Stress and strain at the surface."""
    return tl.solve_response(contact, ROAD, depths=[0.0])


@styled
def draw_torque(right: TurnResult, loop: TurnResult) -> Figure:
    """Torque against the angle, to the right and in the loop."""
    figure = new_figure(6.8, 4.4)
    ax = figure.add_subplot()
    open_axes(ax)
    limit = float(right.dataset.sliding_torque) / 1e3
    for result, style in ((loop, {"color": MUTED, "lw": 1.2}), (right, {"color": CASES[0], "marker": "o", "ms": 3})):
        d = result.dataset
        label = "first turn" if result is right else "right, left and right again"
        ax.plot(np.degrees(d.turn_angle), d.steering_torque / 1e3, label=label, **style)
    ax.axhline(limit, color=INK, ls=":", lw=1)
    ax.annotate(
        "all slides", (0, limit), (3, 3), xycoords=("axes fraction", "data"), textcoords="offset points", fontsize=8.5
    )
    ax.set(xlabel="angle of the wheel (°)", ylabel="steering torque (kN m)", ylim=(None, 1.12 * limit))
    headline(ax, "A truck wheel turned on the spot", "32.5 kN, μ = 0.7; positive to the right")
    ax.legend(loc="lower right")
    return figure


def main(folder: Path, *, coarse: bool = False) -> dict[str, float]:
    """Turn, print, draw; returns the numbers that are checked."""
    folder.mkdir(parents=True, exist_ok=True)
    right, loop = turned(12e-3 if coarse else 4e-3, 10 if coarse else 30)
    print(right.summary())
    before = tl.solve_contact(right.contact.tire, ROAD, STANDING, spacing=right.contact.dataset.attrs["dx"])
    strains = {"standing": extension(before), "turned": extension(right.contact)}
    largest = {name: float(r.dataset.principal_strain_1.max()) * 1e6 for name, r in strains.items()}
    d = right.dataset
    fraction = float(d.steering_torque[-1] / d.sliding_torque)
    lost = float(loop.dataset.friction_energy[-2 * (loop.dataset.sizes["step"] // 3) :].sum())
    print()
    print(f"{'':44s} {'standing':>10s} {'turned':>10s}")
    print(
        f"{'largest tensile strain, surface (microstrain)':44s} {largest['standing']:9.1f} {largest['turned']:10.1f}"
    )
    print(
        f"torque at {math.degrees(LARGEST):g}°: {fraction:.1%} of what slides; a loop to and fro costs {lost:.0f} J"
    )
    save(draw_torque(right, loop), folder / "torque.png")
    save(right.contact.plot.shear(), folder / "shear_after_the_turn.png")
    save(strains["turned"].plot.strain_directions(contact=right.contact), folder / "strain_after_the_turn.png")
    return {
        "sliding torque": float(d.sliding_torque),
        "torque": float(d.steering_torque[-1]),
        "stiffness": right.stiffness,
        "standing": largest["standing"],
        "turned": largest["turned"],
        "loop": lost,
    }


if __name__ == "__main__":
    where = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    main(Path(where[0]) if where else Path("parking_turn"), coarse="--coarse" in sys.argv)
