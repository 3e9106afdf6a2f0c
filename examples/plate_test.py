"""What modulus does a plate test read on layers, and which wheels feel the road give way at all?

A rigid steel plate is pressed on crushed stone over a capping layer over soil. On a half-space the load over the
settlement gives the modulus, E = (1 - ν²) P / (2 a s), whatever the radius a of the plate; on layers a small plate
reads the stone and a large one the soil. The moduli are assumed, within what such layers have.

The same road under four wheels of 100 mm of contact: the share of the road in the compliance of the contact says
whether its layers belong into the solution.

    python examples/plate_test.py [folder]
"""

import sys
from pathlib import Path

import numpy as np

import treadload as tl
from treadload.plots import new_figure, save
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled

POISSON = 0.35
STEEL = tl.Elastic(210e9, 0.3)
ROAD = tl.Pavement(
    [
        tl.Layer(tl.Elastic(300e6, POISSON), 0.25, "crushed stone"),
        tl.Layer(tl.Elastic(120e6, POISSON), 0.40, "capping layer"),
        tl.Layer(tl.Elastic(45e6, POISSON), name="soil"),
    ]
)
DIAMETERS = (0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.762, 1.2, 2.0, 4.0)  # m; 300, 600 and 762 mm are the standard ones
SHOWN = 0.6
WHEELS = {
    "pneumatic tire": tl.Elastic(3e6, 0.5),
    "solid rubber": tl.Elastic(10e6, 0.5),
    "polyurethane": tl.Elastic(60e6, 0.45),
    "steel": STEEL,
}


def plate(diameter: float, cells: int) -> tl.Tire:
    """A flat disc; there is no material around it."""
    spacing = diameter / cells
    x = spacing * (np.arange(cells + 2) - (cells + 1) / 2)
    inside = x[None, :] ** 2 + x[:, None] ** 2 <= (diameter / 2) ** 2
    return tl.Tire.from_height_map(np.where(inside, 0.0, np.nan), spacing, material=STEEL, name="plate")


def press(diameter: float, cells: int, compliance: str) -> tl.contact.Contact:
    """The plate under 0.25 MPa, without friction."""
    load = tl.Rolling(normal_load=0.25e6 * np.pi * diameter**2 / 4, friction=0.0)
    return tl.solve_contact(plate(diameter, cells), ROAD, load, road_compliance=compliance)


def apparent_modulus(contact: tl.contact.Contact, diameter: float) -> float:
    """Modulus in Pa of the half-space that settles as much; the steel's own compliance is 0.1 % of it."""
    data = contact.dataset
    return float((1 - POISSON**2) * data.normal_load / (diameter * data.approach))


def wheel_contact(material: tl.Elastic) -> tl.contact.Contact:
    """A ball as wide as it takes for a contact of some 100 mm under 5 kN, on the road as a half-space."""
    stone = ROAD.surface_material
    yielding = (1 - material.poisson**2) / material.modulus + (1 - stone.poisson**2) / stone.modulus
    radius = 4 * 0.05**3 / (3 * 5e3 * yielding)
    x = 4e-3 * (np.arange(40) - 19.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius)
    return tl.solve_contact(
        tl.Tire.from_height_map(gap, 4e-3, material=material), ROAD, tl.Rolling(normal_load=5e3, friction=0.0)
    )


def main(folder: Path, diameters: tuple[float, ...] = DIAMETERS, cells: int = 64) -> dict[str, dict]:
    folder.mkdir(parents=True, exist_ok=True)
    read = {d: apparent_modulus(press(d, cells, "layers"), d) / 1e6 for d in diameters}
    print("plate (mm)  modulus read (MPa)")
    for diameter, modulus in read.items():
        print(f"{1e3 * diameter:10.0f} {modulus:19.0f}")

    shown = {name: press(SHOWN, cells, name) for name in ("layers", "half_space")}
    settled = {name: 1e3 * float(contact.dataset.approach) for name, contact in shown.items()}
    print(
        f"\nThe {1e3 * SHOWN:.0f} mm plate settles {settled['layers']:.2f} mm on the layers; on a half-space of "
        f"crushed stone it would be {settled['half_space']:.2f} mm.\n\n{shown['layers'].summary()}"
    )

    print("\nwheel              road's share   its layers change the compliance by")
    share = {}
    for name, material in WHEELS.items():
        stats = wheel_contact(material).stats
        share[name] = 100 * stats["road_share"]
        print(f"{name:16} {share[name]:12.2f} %   {100 * stats['layer_share']:+.1f} %")
    save(figure(read, shown), folder / "plate_test.png")
    return {"modulus": read, "settlement": settled, "share": share}


@styled
def figure(read, shown):
    drawn = new_figure(9.6, 4.0)
    left, right = drawn.subplots(1, 2)
    open_axes(left, right)
    left.semilogx([1e3 * d for d in read], list(read.values()), "o-", ms=4, color=CASES[0])
    for layer in ROAD.layers:
        modulus = layer.material.modulus / 1e6
        left.axhline(modulus, color=MUTED, lw=0.9, ls="--")
        left.annotate(
            layer.name, (0, modulus), (4, 3), xycoords=("axes fraction", "data"), textcoords="offset points",
            fontsize=8.5, color=MUTED,
        )  # fmt: skip
    left.set(xlabel="diameter of the plate (mm)", ylabel="modulus read (MPa)", ylim=(0, 330))
    ticks = [50, 100, 300, 600, 1200, 4000]
    left.set_xticks(ticks, [str(tick) for tick in ticks])
    left.minorticks_off()
    headline(left, "What a plate test reads", "dashed: moduli of the layers")
    labels = (("layers", "on the layers"), ("half_space", "on crushed stone alone"))
    for (name, label), colour in zip(labels, CASES, strict=False):
        pressure = shown[name].dataset.pressure
        row = pressure.isel(y=pressure.sizes["y"] // 2)
        row = row[row > 0]
        right.plot(1e3 * row.x, row / 1e6, color=colour, label=label)
    right.axhline(0.25, color=MUTED, lw=0.9, ls="--")
    right.annotate("mean, 0.25 MPa", (0, 0.25), (0, 3), textcoords="offset points", ha="center", color=MUTED)
    right.set(xlabel="x (mm)", ylabel="pressure (MPa)", ylim=(0, 0.8))
    headline(
        right, f"Pressure under the plate of {1e3 * SHOWN:.0f} mm", "through its middle; it has no bound at the edge"
    )
    right.legend(loc="upper center")
    return drawn


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("plate_test"))
