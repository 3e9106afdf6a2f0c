"""What does a rubber's memory cost to roll, and where does the road feel it?

Rolling resistance against speed of the 315/80R22.5 tread at 32.5 kN on asphalt, for two rubbers with the same
stiffness at rest and at a blow: one relaxation time (a standard linear solid), and five spread over four decades,
as filled rubber has them. Their constants are assumed, not measured: E = 3 MPa is the paper's tire; 20 % more at
once gives a loss factor of 0.09 at most, that of a tread compound made for low resistance. The half-space stands
for tread, belt and sidewall together, so read the shape of the curves, not the last digit.

    python examples/rolling_resistance.py [folder]
"""

import sys
from pathlib import Path

import numpy as np

import treadload as tl
from treadload.materials import Prony
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled, travel_arrow

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
LONG_TERM, INSTANTANEOUS, POISSON = 3e6, 3.6e6, 0.5
SHARE = 1 - LONG_TERM / INSTANTANEOUS
RUBBERS = {
    "one relaxation, 5 ms": Prony.standard_linear_solid(INSTANTANEOUS, LONG_TERM, 5e-3, POISSON),
    "five, 50 µs to 0.5 s": Prony(INSTANTANEOUS, tuple((SHARE / 5, 5e-5 * 10**k) for k in range(5)), POISSON),
}
SPEEDS = (0.1, 0.3, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0)  # m/s, to 144 km/h
WHEEL = {"normal_load": 32.5e3, "friction": 0.7}


def main(folder: Path, spacing: float = 6e-3, speeds: tuple[float, ...] = SPEEDS) -> dict[str, list[float]]:
    folder.mkdir(parents=True, exist_ok=True)
    profile = tl.catalogue.tires["315/80R22.5"]
    found: dict[str, list[float]] = {}
    lines = {}
    for name, rubber in RUBBERS.items():
        tire = tl.Tire.from_profile(profile, material=rubber)
        print(f"\n{name}: {rubber}")
        print(f"{'speed':>10} {'resistance':>11} {'centre':>8} {'approach':>9} {'area':>7} {'lost':>9}")
        found[name] = []
        for speed in speeds:
            contact = tl.solve_contact(tire, ROAD, tl.Rolling(speed=speed, **WHEEL), spacing=spacing)
            result = tl.contact.rolling_resistance(contact, profile.rolling_radius)
            found[name].append(1e3 * result.coefficient)
            lines[name, speed] = contact.dataset.pressure.sum("y") * contact.dataset.attrs["dy"]
            approach, area = 1e3 * float(contact.dataset.approach), 1e4 * contact.area
            print(
                f"{speed * 3.6:5.4g} km/h {found[name][-1]:6.2f} N/kN {1e3 * result.pressure_centre_x:5.2f} mm "
                f"{approach:6.2f} mm {area:3.0f} cm² {result.material_power:7.0f} W"
            )
    save(figure(found, lines, speeds), folder / "rolling_resistance.png")
    return found


@styled
def figure(found, lines, speeds):
    drawn = new_figure(9.6, 4.0)
    left, right = drawn.subplots(1, 2)
    open_axes(left, right)
    for (name, values), colour in zip(found.items(), CASES, strict=False):
        left.semilogx(np.array(speeds) * 3.6, values, "o-", ms=4, color=colour, label=name)
    left.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    left.set(xlabel="speed (km/h)", ylabel="rolling resistance (N/kN)", ylim=(0, None))
    headline(left, "Rolling resistance", "of the tread's own memory, for two rubbers")
    left.legend(loc="upper left")
    name, values = next(iter(found.items()))
    worst = int(np.argmax(values))
    shown = sorted({speeds[0], speeds[worst], speeds[-1]})
    for speed, colour in zip(shown, CASES, strict=False):
        line = lines[name, speed]
        right.plot(line.x * 1e3, line / 1e3, color=colour, label=f"{3.6 * speed:g} km/h")
    right.axvline(0, color=MUTED, lw=0.9)
    right.set(xlabel="x, direction of travel (mm)", ylabel="load on a strip across the tire (kN/m)", ylim=(0, None))
    headline(right, "Where the load stands", f"{name}; the axle stands at x = 0")
    right.legend(loc="lower center")
    travel_arrow(right)
    return drawn


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("rolling_resistance"))
