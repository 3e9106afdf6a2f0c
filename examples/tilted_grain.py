"""Where does a footprint point, and which way does a wheel creep? On a road whose grain is tilted.

A steel ball of 100 mm radius is pressed and driven on a carbon-fibre laminate whose fibres dive into it by 20°. Its
contact is an ellipse although the bodies are round and flat; the long axis stands across the fibres' trace. Pressure
drags the surface along the fibres: rolling over them one way or the other the wheel creeps forwards or backwards, by
more than its driving force accounts for, and across travel where they are turned out of it. The moduli are assumed,
within what such laminates have.

    python examples/tilted_grain.py [folder]
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.patches import Ellipse

import treadload as tl
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled
from treadload.validation.grain import axes_of, hertz_on_grain

STEEL = tl.Elastic(210e9, 0.3)
LAMINATE = tl.materials.Orthotropic((130e9, 10e9, 10e9), (5e9, 5e9, 3.5e9), (0.3, 0.3, 0.4))
LEAN, SHOWN = 20.0, 40.0  # degrees: fibres dive, and are turned from travel to the right in the left figure
RADIUS, LOAD, FRICTION, DRIVE = 0.1, 3e3, 0.4, 600.0  # m, N, -, N
TURNS = tuple(range(0, 181, 15))


def laminate(turn: float) -> tl.materials.Orthotropic:
    """The laminate with fibres that dive forwards, and are turned from travel to the right, degrees."""
    return LAMINATE.rotated(yaw=np.radians(turn), pitch=-np.radians(LEAN))


def wheel(width: float, cells: int) -> tl.Tire:
    """A ball of steel, known over a width in m."""
    spacing = width / cells
    x = spacing * (np.arange(cells) - 0.5 * (cells - 1))
    return tl.Tire.from_height_map((x[None] ** 2 + x[:, None] ** 2) / (2 * RADIUS), spacing, material=STEEL)


def main(folder: Path, turns: tuple[float, ...] = TURNS, cells: int = 40) -> dict[str, object]:
    folder.mkdir(parents=True, exist_ok=True)
    # A rigid ball gives the size of the patch; steel gives way by a few per cent of it.
    exact = hertz_on_grain(laminate(SHOWN), np.eye(2) / (2 * RADIUS), LOAD)
    tire = wheel(2.7 * exact.axes[0], cells)

    pressed = tl.solve_contact(
        tire, tl.Pavement.half_space(laminate(SHOWN)), tl.Rolling(normal_load=LOAD, friction=0.0)
    )
    ratio, angle = axes_of(pressed.dataset.pressure.values)
    print(
        f"fibres dive by {LEAN:g}° and are turned by {SHOWN:g}°: the contact is {ratio:.3f} times as long as wide, "
        f"its long axis at {np.degrees(angle):.1f}°\nclosed form of a rigid ball: "
        f"{exact.axes[0] / exact.axes[1]:.3f}, {np.degrees(exact.angle):.1f}°\n\n{pressed.summary()}\n\n"
        "fibres turned   creepage along   across"
    )
    driven = tl.Rolling(normal_load=LOAD, friction=FRICTION, tractive_force=DRIVE)
    creepage = []
    for turn in turns:
        data = tl.solve_contact(tire, tl.Pavement.half_space(laminate(turn)), driven).dataset
        creepage.append((float(data.creepage_x), float(data.creepage_y)))
        print(f"{turn:10.0f}°   {100 * creepage[-1][0]:12.3f} %   {100 * creepage[-1][1]:+.3f} %")
    save(figure(pressed, exact, turns, creepage), folder / "tilted_grain.png")
    return {"ratio": ratio, "angle": np.degrees(angle), "exact": exact, "creepage": creepage}


@styled
def figure(pressed, exact, turns, creepage):
    drawn = new_figure(11.0, 4.6)
    left, right = drawn.subplots(1, 2)
    pressed.plot.pressure(ax=left)
    long, short = (2e3 * axis for axis in exact.axes)
    angle = np.degrees(exact.angle)
    left.add_patch(Ellipse((0, 0), long, short, angle=angle, fill=False, ec=CASES[1], lw=1.2, ls="--"))
    way = np.array([np.cos(np.radians(SHOWN)), np.sin(np.radians(SHOWN))]) * 0.6 * long
    left.annotate("", way, -way, arrowprops={"arrowstyle": "->", "color": MUTED, "lw": 1.2})
    left.annotate("fibres", way, (3, 0), textcoords="offset points", color=MUTED, fontsize=8.5)
    open_axes(right)
    for part, label, colour in ((0, "along travel", CASES[0]), (1, "across travel", CASES[1])):
        right.plot(turns, [100 * both[part] for both in creepage], "o-", ms=4, color=colour, label=label)
    right.axhline(0, color=MUTED, lw=0.8)
    right.set(xlabel="fibres turned from travel to the right (°)", ylabel="creepage (%)", xticks=range(0, 181, 45))
    headline(
        right, "Creepage of a driving ball", f"with {DRIVE / LOAD:g} of its load, μ = {FRICTION:g}, no force across"
    )
    right.legend(loc="best")
    return drawn


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("tilted_grain"))
