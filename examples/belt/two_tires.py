"""The same wheel as a half-space and as a tread on an inflated belt: which tire do measurements know?

A 315/80R22.5, 35 kN at 800 kPa, beside the stiffnesses of a textbook set of its size; its print at 820 kPa beside the
paper's pressure sensor; and the shear that each rib exerts on the road while the wheel rolls freely, beside what the
literature says of its signs.

    python examples/belt/two_tires.py [folder]
"""

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import treadload as tl
from treadload.footprint import tire_card
from treadload.plots import compare_pressure, new_figure, save
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
BELT = tl.tire.Belt.from_library("315/80R22.5")
LOAD, INFLATION = 35e3, 820e3
# The textbook set CityBus_Pac02Tire.tir at 35 kN and 800 kPa, see SOURCE.md: name in a card, words, value in a unit.
TEXTBOOK = {
    "secant_stiffness": ("vertical stiffness (N/mm)", 1000.0, 1e-3),
    "longitudinal_stiffness": ("longitudinal slip stiffness / load", 14.85, 1 / LOAD),
    "cornering_stiffness": ("cornering stiffness / load (1/rad)", 5.66, 1 / LOAD),
    "lateral_stiffness": ("lateral stiffness (N/mm)", 436.0, 1e-3),
    "relaxation_length": ("relaxation length (m)", 0.454, 1.0),
    "effective_radius_ratio": ("effective rolling radius / free", 0.959, 1.0),
    "pneumatic_trail": ("pneumatic trail (mm)", 47.0, 1e3),
}
# Materials 2021, 14, 2117: the paper's sensor at 35 kN and 820 kPa, m² and Pa.
SENSOR_AREA, SENSOR_PEAK = 58_761e-6, 1532e3


def tires(inflation_pressure: float = INFLATION) -> dict[str, tl.Tire]:
    """The tread of the catalogue on the paper's half-space of 3 MPa, and on the catalogue's belt."""
    return {
        "half-space": tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.5)),
        "belt": tl.Tire.from_profile("315/80R22.5", inflation_pressure=inflation_pressure, belt=BELT),
    }


def stiffnesses(spacing: float) -> dict[str, dict[str, float]]:
    """Prints each tire's card beside the textbook; returns relative differences."""
    cards = {name: tire_card(tire, ROAD, [LOAD], spacing=spacing).dataset for name, tire in tires(800e3).items()}
    print(f"{'35 kN, 800 kPa':36s}{'textbook':>9s}" + "".join(f"{name:>20s}" for name in cards))
    found: dict[str, dict[str, float]] = {name: {} for name in cards}
    for key, (words, known, unit) in TEXTBOOK.items():
        cells = ""
        for name, card in cards.items():
            value = float(card[key].squeeze()) * unit
            found[name][key] = value / known - 1
            cells += f"{value:11.4g} ({100 * found[name][key]:+4.0f} %)"
        print(f"{words:36s}{known:9.4g}{cells}")
    print(STIFFNESSES)
    return found


def print_of(contact: tl.contact.Contact) -> tl.footprint.Footprint:
    """The computed footprint, to be measured like a recorded one."""
    return tl.footprint.Footprint(tl.response.GridLoad.from_dataset(contact))


def felt_area(contact: tl.contact.Contact, cells: int) -> float:
    """Area, m², of the sensels that feel anything. cells: of the contact along a side of a sensel."""
    touched = (contact.dataset.pressure > 0).values
    rows, columns = (-size % cells for size in touched.shape)
    whole = np.pad(touched, ((0, rows), (0, columns)))
    blocks = whole.reshape(whole.shape[0] // cells, cells, whole.shape[1] // cells, cells)
    return float(blocks.any(axis=(1, 3)).sum()) * cells**2 * contact.cell_area


def prints(contacts: dict[str, tl.contact.Contact]) -> dict[str, dict[str, float]]:
    """Prints what the sensor and each tire say of the footprint."""
    print(f"{'35 kN, 820 kPa':36s}{'sensor':>9s}" + "".join(f"{name:>12s}" for name in contacts))
    measures = {name: print_of(contact).measures for name, contact in contacts.items()}
    pitch = contacts["belt"].dataset.attrs["dx"]
    rows = [
        ("net area (mm²)", SENSOR_AREA * 1e6, [m.net_area * 1e6 for m in measures.values()]),
        ("gross area, grooves with it (mm²)", None, [m.gross_area * 1e6 for m in measures.values()]),
        ("length (mm)", None, [m.length * 1e3 for m in measures.values()]),
        ("mean over the net area (kPa)", LOAD / SENSOR_AREA / 1e3, [m.mean / 1e3 for m in measures.values()]),
        ("that over the inflation", LOAD / SENSOR_AREA / INFLATION, [m.mean / INFLATION for m in measures.values()]),
        ("gross mean over the inflation", None, [LOAD / m.gross_area / INFLATION for m in measures.values()]),
        ("peak (kPa)", SENSOR_PEAK / 1e3, [m.peak / 1e3 for m in measures.values()]),
    ]
    for cells in (2, 3, 4):
        words = f"area felt by sensels of {cells * pitch * 1e3:g} mm (mm²)"
        rows.append((words, None, [felt_area(contact, cells) * 1e6 for contact in contacts.values()]))
    for words, sensor, values in rows:
        print(f"{words:36s}{'' if sensor is None else f'{sensor:.4g}':>9s}" + "".join(f"{v:12.5g}" for v in values))
    for pressure in (600e3, 300e3):
        wheel = tl.Rolling(normal_load=LOAD, friction=0.0)
        softer = print_of(tl.solve_contact(tires(pressure)["belt"], ROAD, wheel, spacing=6e-3)).measures
        net, gross = (1e6 * area for area in (softer.net_area, softer.gross_area))
        print(f"the belt at {pressure / 1e3:.0f} kPa: net {net:.0f}, gross {gross:.0f} mm² (cells of 6 mm)")
    print(PRINT.format(area=LOAD / INFLATION * 1e6))
    return {name: {"net": m.net_area, "gross": m.gross_area, "length": m.length} for name, m in measures.items()}


def ribs(contact: tl.contact.Contact) -> xr.Dataset:
    """Forces of each rib on the road over the wheel load, and largest stresses.

    share, lateral, longitudinal: pressure, q_y and q_x summed over the rib. bulging: q_y summed with the sign that
    points out of the middle of the rib, positive where the rib pushes the road outward.
    """
    data = contact.dataset
    edges = print_of(contact).find_ribs()
    which = np.digitize(data.y.values, edges[1:-1])
    area = contact.cell_area / float(data.normal_load)
    p, qx, qy = (data[name].sum("x").values * area for name in ("pressure", "traction_x", "traction_y"))
    rows = []
    for rib in range(len(edges) - 1):
        own = which == rib
        y = data.y.values[own]
        middle = float(np.average(y, weights=p[own]))
        out = np.sign(np.where(np.abs(y - middle) < 1e-9, 0.0, y - middle))
        rows.append((middle, p[own].sum(), qy[own].sum(), (qy[own] * out).sum(), qx[own].sum()))
    middle, *columns = np.transpose(rows)
    names = ("share", "lateral", "bulging", "longitudinal")
    return xr.Dataset({n: ("rib", c) for n, c in zip(names, columns, strict=True)}, {"middle": ("rib", middle)})


def shear(contacts: dict[str, tl.contact.Contact]) -> dict[str, xr.Dataset]:
    """Prints the shear of free rolling, rib by rib, and the largest stresses in the ratio that de Beer gives."""
    print("free rolling: forces of the tire on the road, thousandths of the load, rib by rib from the left")
    print("(lateral: to the right; out of the rib: away from its own middle; along: in the direction of travel)")
    found = {}
    for name, contact in contacts.items():
        rib, data = ribs(contact), contact.dataset
        found[name] = rib
        for words, key in (("lateral", "lateral"), ("out of the rib", "bulging"), ("along", "longitudinal")):
            print(f"{name:22s}{words:16s}" + "".join(f"{1e3 * value:8.2f}" for value in rib[key].values))
        largest = [float(np.abs(data[key]).max()) for key in ("pressure", "traction_y", "traction_x")]
        ratio = " : ".join(f"{10 * value / largest[0]:.2g}" for value in largest)
        print(f"{'':22s}largest p : q_y : q_x = {ratio}")
    print(SHEAR)
    return found


@styled
def sections(contacts: dict[str, tl.contact.Contact]) -> Figure:
    """Pressure along the middle rib, load per width across, and lateral shear across."""
    figure = new_figure(10.4, 3.4)
    along, across, sideways = figure.subplots(1, 3)
    for colour, (name, contact) in zip(CASES, contacts.items(), strict=False):
        data = contact.dataset
        dx = data.attrs["dx"]
        along.plot(data.x * 1e3, data.pressure.sel(y=0, method="nearest") / 1e3, color=colour, label=name)
        across.step(data.y * 1e3, data.pressure.sum("x") * dx / 1e3, color=colour, where="mid")
        sideways.step(data.y * 1e3, data.traction_y.sum("x") * dx / 1e3, color=colour, where="mid")
    along.axhline(INFLATION / 1e3, color=MUTED, lw=0.8, ls=(0, (4, 2)))
    along.annotate("inflation", (1, INFLATION / 1e3), xycoords=("axes fraction", "data"), ha="right", va="bottom",
                   color=MUTED, fontsize=8.5)  # fmt: skip
    along.set(xlabel="x, travel to the right (mm)", ylabel="pressure at y = 0 (kPa)")
    across.set(xlabel="y (mm)", ylabel="load per width (N/mm)")
    sideways.set(xlabel="y (mm)", ylabel="lateral shear per width (N/mm)")
    headline(along, "Along the middle rib")
    headline(across, "Across")
    headline(sideways, "Shear on the road")
    along.legend(loc="upper left")
    open_axes(along, across, sideways)
    return figure


def main(folder: Path, spacing: float = 3e-3, card_spacing: float = 6e-3) -> dict[str, Any]:
    folder.mkdir(parents=True, exist_ok=True)
    compared = stiffnesses(card_spacing)
    wheel = tl.Rolling(normal_load=LOAD, friction=0.7)
    contacts = {name: tl.solve_contact(tire, ROAD, wheel, spacing=spacing) for name, tire in tires().items()}
    measured = prints(contacts)
    # Rubber that gives way in volume shears the road as a half-space too; one nearly rigid in volume bulges more.
    softer = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.47))
    bulging = replace(tires()["belt"], belt=replace(BELT, tread=replace(BELT.tread, poisson=0.49)))
    others = {"half-space, ν = 0.47": softer, "belt, ν = 0.49": bulging}
    free = {name: tl.solve_contact(tire, ROAD, wheel, spacing=spacing) for name, tire in others.items()}
    sheared = shear({**contacts, **free})
    save(
        compare_pressure(list(contacts.values()), ["Half-space of 3 MPa", "Tread on an inflated belt"]),
        folder / "pressure.png",
    )
    save(sections(contacts), folder / "sections.png")
    return {"stiffness": compared, "print": measured, "ribs": sheared}


STIFFNESSES = """
The belt has all five stiffnesses within 20 % of the textbook, at once. A half-space cannot: along it is 1.3 to 1.4
times as stiff as across with moduli of 2 to 10 MPa, the textbook 2.6 times and the belt 2.1. What the belt does not
have: the textbook rolls on a radius 4.1 % below the free one, the belt on 1.3 % below (Calspan's 335/65R22.5 at 95
psi: 1.7 %), and its trail is a quarter short.
"""

PRINT = """
Inflation alone would carry the load on {area:.0f} mm², grooves counted. The belt's print, grooves counted, is
larger, as its rim presses less than the inflation; its ribs press more, as grooves press nothing. The sensor tells
58 761 mm², a mean of 0.73 of the inflation without grooves. The belt has such a print at 600 kPa with its grooves
counted, and without them not even at 300 kPa; nor does its print at 820 kPa, seen by sensels of 12 mm, wider than
the grooves. Either the sensor counted more than what touched, or load and inflation were not those told. The
half-space meets the sensor because its tread was fitted to it, and because a half-space knows of no inflation: that
agreement is no evidence for it.
"""

SHEAR = """
What the literature says, as commonly quoted, not checked against the source. Roque, Myers and Birgisson (2000):
under a radial tire every rib pushes the road outward from the rib's middle (Poisson's effect); the inflated tread
as a whole, and more so of a bias tire, pushes it towards the middle of the tire. De Beer, Fisher and Jooste (1997):
largest vertical to lateral to longitudinal stress about 10 : 3.6 : 1.4 in slow free rolling. Signs change between
the shear on the tire and on the road; all here is the shear of the tire on the road. Rubber as a half-space does
not shear the road if ν = 0.5, and pulls every rib inward if ν is less: the wrong sign. The belt has both signs, but
its lateral shear is a tenth of de Beer's: too small. Arm and Poisson's ratio of the tread make it, and no
measurement rib by rib was at hand to fit them.
"""


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("two_tires"))
