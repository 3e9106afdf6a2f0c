"""A truck starts from rest: how the tractive force builds up over the distance.

The 315/80R22.5 tread stands under 32.5 kN on asphalt, μ = 0.7. The wheel turns 3 % faster than it rolls; every
particle of the tread that enters the contact sticks and is stretched on its way through. After two to three
lengths of the contact the wheel rolls steadily. Prints the force and the slip against the distance, compares the
end with steady rolling, and writes the figures.

    python examples/transient_start.py [folder] [--coarse]
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import treadload as tl
from treadload.contact.transient import TransientResult, solve_transient
from treadload.plots import new_figure, save
from treadload.plots.kit.style import (
    CASES,
    MUTED,
    RULE,
    headline,
    open_axes,
    sequential,
    signed,
    styled,
    travel_arrow,
)

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
DRIVING = tl.Rolling(normal_load=32.5e3, friction=0.7, creepage_x=-0.03)
DISTANCE = 1.2


def started(spacing: float, step: float) -> tuple[TransientResult, tl.contact.Contact]:
    """The start in equal steps, m, and steady rolling of the same creepage."""
    tire = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.5))
    distances = step * np.arange(1, round(DISTANCE / step) + 1)
    start = solve_transient(tire, ROAD, DRIVING, distances=distances, spacing=spacing, fields=True)
    return start, tl.solve_contact(tire, ROAD, DRIVING, spacing=spacing)


@styled
def draw_force(start: TransientResult, steady: tl.contact.Contact) -> Figure:
    """Tractive force and share of slip against the distance."""
    figure = new_figure(6.8, 5.4)
    above, below = figure.subplots(2, 1, sharex=True)
    open_axes(above, below)
    far = start.dataset.distance * 1e3
    above.plot(far, start.dataset.tractive_force / 1e3, color=CASES[0], label="from rest")
    above.axhline(float(steady.dataset.tractive_force) / 1e3, color=MUTED, ls=":", label="steady rolling")
    above.set(ylabel="tractive force (kN)", ylim=(0, None))
    headline(above, "Driving off", f"creepage of {-100 * DRIVING.creepage_x:g} %, 32.5 kN, μ = {DRIVING.friction:g}")
    above.legend(loc="lower right")
    below.plot(far, 100 * start.dataset.slip_fraction, color=CASES[1])
    below.axhline(100 * steady.slip_fraction, color=MUTED, ls=":")
    below.set(xlabel="distance rolled (mm)", ylabel="slip (% of the contact)", ylim=(0, None))
    return figure


@styled
def draw_shear(start: TransientResult) -> Figure:
    """Shear along the middle of a rib at several distances."""
    d = start.dataset
    row = int(np.argmax(d.pressure[-1].sum("x").values))
    figure = new_figure(6.8, 4.6)
    ax = figure.add_subplot()
    open_axes(ax)
    x, p = d.x * 1e3, d.pressure[-1, row] / 1e3
    ax.fill_between(x, DRIVING.friction * p, color=RULE, alpha=0.35, lw=0, label="μp")
    picked = np.unique(np.searchsorted(d.distance, [0.03, 0.09, 0.2, 0.4, DISTANCE - 1e-9]))
    shades = sequential("shear")(np.linspace(0.25, 1, picked.size))
    for number, colour in zip(picked, shades, strict=True):
        shear = -d.traction_x[number, row] / 1e3
        ax.plot(x, shear, color=colour, label=f"{float(d.distance[number]) * 1e3:.0f} mm")
    ax.set(xlabel="x, direction of travel (mm)", ylabel="shear of the road on the tire (kPa)", ylim=(0, None))
    headline(ax, "Shear builds up from the leading edge", f"along y = {signed(float(d.y[row]) * 1e3, 0)} mm")
    ax.legend(title="rolled", alignment="left")
    travel_arrow(ax)
    return figure


def main(folder: Path, *, coarse: bool = False) -> dict[str, float]:
    """Start, print, draw; returns the numbers that are checked."""
    folder.mkdir(parents=True, exist_ok=True)
    spacing = 12e-3 if coarse else 6e-3
    start, steady = started(spacing, spacing)
    print(start.summary())
    force, end = float(steady.dataset.tractive_force), float(start.dataset.tractive_force[-1])
    forces = start.dataset.tractive_force.values
    half = float(np.interp(0.5 * force, forces, start.dataset.distance.values))
    print(f"\nsteady rolling on the same cells: {force / 1e3:.3f} kN; after {DISTANCE:g} m {end / force:.1%} of it,")
    print(f"half of it after {half * 1e3:.0f} mm")
    save(draw_force(start, steady), folder / "force.png")
    save(draw_shear(start), folder / "shear_over_distance.png")
    save(start.contact.plot.stick_slip(), folder / "stick_slip_at_the_end.png")
    return {"steady": force, "end": end, "half way": half, "energy": float(start.dataset.friction_energy.sum())}


if __name__ == "__main__":
    where = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    main(Path(where[0]) if where else Path("transient_start"), coarse="--coarse" in sys.argv)
