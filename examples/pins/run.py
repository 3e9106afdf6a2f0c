"""Shear that pins in a road measure under a truck tire: beside a computed contact rib by rib, and fitted to it.

`pins.csv` is no measurement. It was computed by this package (`make`, below) with E = 6 MPa, ν = 0.49 and μ = 0.35 on
cells of 3 mm, read by pins of 9.7 mm every 12 mm, with noise of 8 kPa, so that what a fit finds can be compared with
what is known. A fit on other cells than those of the data is off by what cells change of the shear, about 0.01 of the
pressure.

    python examples/pins/run.py [folder]          compare and fit
    python examples/pins/run.py make              make pins.csv again
"""

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import treadload as tl
from treadload.footprint import Measured, read_footprint, sample_pins, write_pins
from treadload.plots import save

TABLE = Path(__file__).parent / "pins.csv"
ROAD = tl.Pavement.half_space(tl.Elastic(210e9, 0.3))
LOAD, INFLATION = 35e3, 820e3
# What the data were made with: modulus and Poisson's ratio of the ribs, friction, noise of a reading, Pa.
KNOWN = {"modulus": 6e6, "poisson": 0.49, "friction": 0.35}
NOISE = 8e3
COMMENT = f"""computed by examples/pins/run.py of treadload, no measurement: 315/80R22.5 with ribs on its belt,
rolling freely, {LOAD / 1e3:g} kN, {INFLATION / 1e3:g} kPa, E = 6 MPa, nu = 0.49, friction 0.35,
cells of 3 mm, noise of 8 kPa"""


def tire(modulus: float = 5.5e6, poisson: float = 0.495) -> tl.Tire:
    """The catalogue's 315/80R22.5 with ribs of this rubber."""
    belt = replace(tl.tire.Belt.from_library("315/80R22.5"), tread=tl.Elastic(modulus, poisson))
    return tl.Tire.from_profile("315/80R22.5", inflation_pressure=INFLATION, belt=belt, tread="ribs")


def make(path: Path = TABLE, spacing: float = 3e-3) -> None:
    """Writes the table."""
    state = tl.Rolling(normal_load=LOAD, friction=KNOWN["friction"])
    contact = tl.solve_contact(tire(KNOWN["modulus"], KNOWN["poisson"]), ROAD, state, spacing=spacing)
    load = tl.response.GridLoad.from_dataset(contact)
    pins = sample_pins(load, pin=9.7e-3, pitch=12e-3, step=5e-3, offset=2e-3)
    random = np.random.default_rng(29)
    noise = NOISE * random.normal(size=pins.load.array.shape) * (pins.pressure > 0)
    pressure, along, across = pins.load.array + noise
    noisy = replace(pins.load, pressure=np.maximum(pressure, 0.0), traction_x=along, traction_y=across)
    # Nobody rolls over pins in the middle.
    write_pins(replace(pins, load=noisy).moved(0.0, 0.004), path, comment=COMMENT)


def main(folder: Path, spacing: float = 6e-3, sought: tuple[str, ...] = ("modulus", "friction")) -> dict[str, Any]:
    folder.mkdir(parents=True, exist_ok=True)
    pins = read_footprint(TABLE)
    print(f"{pins.source}\n")
    start = tire(poisson=KNOWN["poisson"])
    contact = tl.solve_contact(start, ROAD, tl.Rolling(normal_load=LOAD, friction=0.7), spacing=spacing)
    comparison = tl.compare(contact, pins)
    print(comparison.summary())
    save(comparison.plot.shear(), folder / "shear.png")
    fit = tl.calibrate(start, sought, [Measured(load=LOAD, pins=pins)], friction=0.7, spacing=spacing)
    print(f"\n{fit.summary()}\n\nknown, as the data are computed:")
    for name in sought:
        print(f"  {name}: {KNOWN[name]:g}, fitted {fit.value(name):.4g} ± {fit.standard_deviation(name):.2g}")
    save(fit.plot.fit(), folder / "fit.png")
    fitted = fit.comparisons[0]
    print(f"\nwith the fitted numbers:\n{fitted.summary()}")
    save(fitted.plot.shear(), folder / "shear_fitted.png")
    return {
        "before": comparison.dataset["rib_outward_shear"],
        "after": fitted.dataset["rib_outward_shear"],
        "fitted": {name: fit.value(name) for name in sought},
        "deviations": {name: fit.standard_deviation(name) for name in sought},
        "undecided": fit.undecided,
    }


if __name__ == "__main__":
    if sys.argv[1:] == ["make"]:
        make()
    else:
        main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("pins"))
