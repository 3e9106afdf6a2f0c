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
from matplotlib.figure import Figure

import treadload as tl
from treadload.plots import save

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
LONG_TERM, INSTANTANEOUS, POISSON = 3e6, 3.6e6, 0.5
SHARE = 1 - LONG_TERM / INSTANTANEOUS
RUBBERS = {
    "one relaxation, 5 ms": tl.Prony.standard_linear_solid(INSTANTANEOUS, LONG_TERM, 5e-3, POISSON),
    "five, 50 µs to 0.5 s": tl.Prony(INSTANTANEOUS, tuple((SHARE / 5, 5e-5 * 10**k) for k in range(5)), POISSON),
}
SPEEDS = (0.1, 0.5, 2.0, 5.0, 10.0, 20.0, 40.0, 100.0, 500.0)  # m/s
WHEEL = {"normal_load": 32.5e3, "friction": 0.7}


def main(folder: Path, spacing: float = 6e-3, speeds: tuple[float, ...] = SPEEDS) -> dict[str, list[float]]:
    folder.mkdir(parents=True, exist_ok=True)
    profile = tl.TreadProfile.from_library("315/80R22.5")
    found: dict[str, list[float]] = {}
    lines = {}
    for name, rubber in RUBBERS.items():
        tire = tl.Tire.from_profile(profile, material=rubber)
        print(f"\n{name}: {rubber}")
        print(f"{'speed':>10} {'resistance':>11} {'centre':>8} {'approach':>9} {'area':>7} {'lost':>9}")
        found[name] = []
        for speed in speeds:
            contact = tl.solve_contact(tire, ROAD, tl.Rolling(speed=speed, **WHEEL), spacing=spacing)
            result = tl.rolling_resistance(contact, profile.rolling_radius)
            found[name].append(1e3 * result.coefficient)
            lines[name, speed] = contact.dataset.pressure.sum("y") * contact.dataset.attrs["dy"]
            approach, area = 1e3 * float(contact.dataset.approach), 1e4 * contact.area
            print(
                f"{speed * 3.6:5.4g} km/h {found[name][-1]:6.2f} N/kN {1e3 * result.pressure_centre_x:5.2f} mm "
                f"{approach:6.2f} mm {area:3.0f} cm² {result.material_power:7.0f} W"
            )
    save(figure(found, lines, speeds), folder / "rolling_resistance.png")
    return found


def figure(found, lines, speeds):
    fig = Figure(figsize=(9.5, 3.8), layout="constrained")
    left, right = fig.subplots(1, 2)
    for name, values in found.items():
        left.semilogx(np.array(speeds) * 3.6, values, "o-", ms=4, label=name)
    left.set(xlabel="speed, km/h", ylabel="rolling resistance, N/kN", ylim=(0, None))
    left.legend(frameon=False)
    left.grid(alpha=0.3)
    name, values = next(iter(found.items()))
    worst = speeds[int(np.argmax(values))]
    for speed in sorted({speeds[0], worst, speeds[-1]}):
        line = lines[name, speed]
        right.plot(line.x * 1e3, line / 1e3, label=f"{3.6 * speed:g} km/h")
    right.axvline(0, color="0.6", lw=0.8)
    right.annotate("travel →", (0.98, 0.94), xycoords="axes fraction", ha="right")
    right.set(xlabel="x, mm", ylabel="load on a slice across the tire, kN/m", ylim=(0, None), title=name)
    right.legend(frameon=False, loc="upper left", fontsize="small")
    right.grid(alpha=0.3)
    return fig


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("rolling_resistance"))
