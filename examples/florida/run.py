"""Florida's test roads: tensile strain of the surface where the report had its gauges, to be held against them.

The pit and the track of the Florida DOT's report for the study of wide-base tires (2013), at loads of 6 to 18 kip a
half axle of two tires and 25 °C. Gauges of 30 mm lie along and across, 3 to 12 in outside the wheel path. What was
measured is not public: this prints what the program computes, for whoever has it. The tire is the catalogue's.

    python examples/florida/run.py
"""

from pathlib import Path

import numpy as np

import treadload as tl

FOLDER = Path(__file__).parent
LOADS = (6, 9, 12, 15, 18)
# Of gauges, m: places beyond the outer edge of the tread, and their length.
BEYOND = 0.0254 * np.array([3, 6, 9, 12])
LENGTH = 0.030


def gauges(road, load, pressure="110 psi"):
    """Largest strain along and across as the wheels roll by (gauge,), microstrain, at each place, and at the bottom.

    load: kip on both tires. Tension positive; the mean over the length of a gauge.
    """
    changes = [f'rolling.normal_load="{500 * load} lbf"', f'tire.inflation_pressure="{pressure}"']
    case = tl.Case.from_toml(FOLDER / f"{road}.toml", changes=changes)
    result = tl.run(case)
    contact = result.contact
    loads = [tl.response.GridLoad.from_dataset(contact.dataset).moved(y=y) for y in (-0.17, 0.17)]
    edge = 0.17 + float(contact.dataset["y"].where((contact.dataset["pressure"] > 0).any("x")).max())
    within = LENGTH * np.linspace(-0.5, 0.5, 7)
    x = np.arange(-1.2, 1.2001, 0.01)
    y = (edge + BEYOND[:, None] + within).ravel()
    data = tl.solve_response(loads, case.road(), depths=[0.0], x=x, y=y).dataset.isel(depth=0)
    along, across = (data[f"strain_{part}"].to_numpy().reshape(len(BEYOND), 7, len(x)) for part in ("xx", "yy"))
    width = round(LENGTH / 0.01)
    middle = along[:, 3]
    smoothed = np.stack([np.convolve(row, np.full(width, 1 / width), "same") for row in middle])
    bottom = result.response.dataset.isel(depth=1)
    lowest = 1e6 * float(max(bottom["strain_xx"].max(), bottom["strain_yy"].max()))
    return 1e6 * smoothed.max(axis=1), 1e6 * across.mean(axis=1).max(axis=1), lowest


def main(roads=("pit", "track"), loads=LOADS):
    """The table. Returns what `gauges` gives by road and load."""
    places = "".join(f"{inches:>8} in" for inches in (3, 6, 9, 12))
    results = {}
    for road in roads:
        print(f"\n{road}: largest strain at the surface, microstrain, measured: not public\n{'':14}{places}")
        for load in loads:
            along, across, bottom = results[road, load] = gauges(road, load)
            for name, row in (("along", along), ("across", across)):
                print(f"{load:3d} kip {name:7s}" + "".join(f"{value:11.1f}" for value in row))
            print(f"{load:3d} kip bottom of the asphalt {bottom:.0f}")
    return results


if __name__ == "__main__":
    main()
