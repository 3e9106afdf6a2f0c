"""Which tread makes the paper's footprint? Fit the 315/80R22.5 profile to figure 5, once.

The paper's scan is not published. Four free parameters of a five-rib tread (crown radius, shoulder radius,
groove width, groove-edge radius) are fitted to two printed numbers, the area and the peak pressure at 35 kN,
and kept near what such tires look like: a search of some minutes. The strains of figures 8 and 9 are then
predictions.

    python examples/paper/fit_profile.py            print the fit
    python examples/paper/fit_profile.py --write    and put it into the catalogue
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import differential_evolution

import treadload as tl
import treadload.tire
from treadload.errors import GeometryError

AREA, PEAK = 59_553e-6, 1576e3  # m², Pa: figure 5 at 35 kN and 820 kPa
# (name, expected, spread): what such a tread is expected to measure, m.
EXPECTED = (
    ("crown radius", 2.0, 0.5),
    ("shoulder radius", 0.010, 0.004),
    ("groove width", 0.012, 0.002),
    ("groove-edge radius", 0.002, 0.0008),
)
SOURCE = (
    "Rolling radius: half of the size's nominal overall diameter, 1076 mm. Crown radius, shoulder radius, groove "
    "width and groove-edge radius: fitted by examples/paper/fit_profile.py to the contact area (59 553 mm²) and the "
    "peak pressure (1576 kPa) that Materials 2021, 14, 2117 prints for 35 kN at 820 kPa."
)
NOTES = "Five equal ribs, four grooves with vertical walls."
CAVEATS = (
    "Fitted to two printed numbers, not measured on a tire.",
    "Groove depth: 15 mm, usual for a new truck tire; the contact does not depend on it as long as the floor stays "
    "clear of the road.",
    "Tread width: 282 mm, assumed.",
)
RUBBER, ASPHALT = tl.Elastic(3e6, 0.5), tl.Elastic(5.4e9, 0.35)


def profile_of(crown: float, shoulder: float, groove: float, edge: float) -> tl.tire.TreadProfile:
    """Five equal ribs with these measures, m."""
    start = tl.catalogue.tires["315/80R22.5"]
    grooves = treadload.tire.equal_ribs(start.width, 4, groove, 0.015, edge_radius=edge)
    grooves = tuple(replace(g, centre=round(g.centre, 5)) for g in grooves)
    texts = {"source": SOURCE, "notes": NOTES, "caveats": CAVEATS}
    return replace(start, crown_radius=crown, shoulder_radius=shoulder, grooves=grooves, **texts)


def footprint(profile: tl.tire.TreadProfile) -> tuple[float, float]:
    """Contact area, m², and peak pressure, Pa, at 35 kN on 3 mm cells."""
    contact = tl.solve_contact(
        tl.Tire.from_profile(profile, material=RUBBER),
        tl.Pavement.half_space(ASPHALT),
        tl.Rolling(normal_load=35e3, friction=0.0),
        spacing=3e-3,
        tolerance=1e-4,
    )
    return contact.area, float(contact.dataset.pressure.max())


def misfit(scaled: np.ndarray) -> float:
    """Distance from the two printed numbers (in tenths of a per cent), and from the expected tread."""
    parameters = [mean + spread * z for (_, mean, spread), z in zip(EXPECTED, scaled, strict=True)]
    try:
        area, peak = footprint(profile_of(*parameters))
    except GeometryError:
        return 1e9
    return ((area / AREA - 1) / 1e-3) ** 2 + ((peak / PEAK - 1) / 1e-3) ** 2 + float(np.sum(np.square(scaled)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="replace the profile in the catalogue")
    arguments = parser.parse_args()
    # Whole rows of cells come into contact at once, so the misfit has steps: search without derivatives.
    best = differential_evolution(misfit, [(-2, 2)] * 4, popsize=8, maxiter=15, rng=1, polish=False, init="sobol")
    parameters = [float(mean + spread * z) for (_, mean, spread), z in zip(EXPECTED, best.x, strict=True)]
    # A drawing says tenths of a millimetre; the crown radius, whole millimetres.
    parameters = [round(parameters[0], 3), *(round(value, 4) for value in parameters[1:])]
    fitted = profile_of(*parameters)
    area, peak = footprint(fitted)
    for (name, expected, _), value in zip(EXPECTED, parameters, strict=True):
        print(f"{name:20s} {value * 1e3:8.1f} mm   (expected {expected * 1e3:g})")
    print(f"{'area':20s} {area * 1e6:8.0f} mm²  (paper {AREA * 1e6:.0f}, {area / AREA - 1:+.1%})")
    print(f"{'peak pressure':20s} {peak / 1e3:8.0f} kPa  (paper {PEAK / 1e3:.0f}, {peak / PEAK - 1:+.1%})")
    if arguments.write:
        path = Path(treadload.__file__).parent / "catalogue" / "data" / "tires" / "315_80R22.5.toml"
        path.write_text(fitted.to_toml(), encoding="utf-8")
        print(f"written to {path}")


if __name__ == "__main__":
    main()
