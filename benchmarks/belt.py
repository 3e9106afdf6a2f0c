"""A tread on an inflated belt: rolling beside the half-space tire, and what its kernels cost.

The example mesh at 32.5 kN, rolling freely and driving with 10 kN, on cells of 3 mm; the half-space as the paper's
rubber, whose pressure and shear do not feel each other, and with ν = 0.47, where they do, as on a belt. The floor is
one padded convolution of two components of the same grid. Bounds are the house's: rolling with kept kernels within 3
times the half-space's, the kernels of a grid within 40 convolutions. Seconds of the processor, on one thread.
"""

from dataclasses import replace
from time import process_time

from floors import rolling_product
from timing import best_of, print_table

import treadload as tl
from treadload.contact.bodies import Influence, Offsets
from treadload.contact.bodies.belt import belt_surface
from treadload.kernels import belt as sheets
from treadload.kernels.layers import images

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
INFLATION, LOAD = 820e3, 32.5e3
HEADER = ("rolling", "half-space, s", "ν = 0.47, s", "belt, s", "belt/half-space", "belt/coupled", "bound")


def rolling(spacing):
    """The example tire as three bodies; yields rows, and what was solved last on the belt."""
    belt = tl.tire.Belt.from_library("315/80R22.5")
    belted = tl.Tire.from_scan(tl.example_mesh(), inflation_pressure=INFLATION, belt=belt)
    solid = replace(belted, belt=None, material=tl.Elastic(3e6, 0.5))
    tires = (solid, replace(solid, material=tl.Elastic(3e6, 0.47)), belted)
    for name, force in (("free", 0.0), ("10 kN", 10e3)):
        wheel = tl.Rolling(normal_load=LOAD, tractive_force=force, friction=0.7)
        seconds = []
        for tire in tires:
            # Once for the kernels, then the fastest of three.
            tl.solve_contact(tire, ROAD, wheel, spacing=spacing)
            seconds.append(
                best_of(lambda t=tire, w=wheel: tl.solve_contact(t, ROAD, w, spacing=spacing), 3, process_time)[0]
            )
        yield (name, *seconds, seconds[2] / seconds[0], seconds[2] / seconds[1], 3)


def kernels(spacing, shape):
    """Kernels of the belt and its tread layer on a grid, from nothing: a row each, in convolutions of that grid."""
    inflated = tl.Tire.from_profile(
        "315/80R22.5", inflation_pressure=INFLATION, belt=tl.tire.Belt.from_library("315/80R22.5")
    ).carcass
    influence = Influence(shape, spacing, spacing, belt_surface(inflated))
    at = Offsets(*influence.padding.quadrant, spacing, spacing)
    floor = rolling_product(influence, process_time)

    def all_of_them():
        sheets.coefficients.cache_clear()
        images._coefficients.cache_clear()
        surface = belt_surface(inflated)
        return surface.normal(at), surface.tangential(at), surface.coupling(at)

    seconds, _ = best_of(all_of_them, repeats=5, clock=process_time)
    yield f"{shape[1]} x {shape[0]}", floor * 1e3, seconds, seconds / floor, 40


def main(spacing=3e-3, grids=((3e-3, (117, 93)), (2e-3, (171, 141)))):
    title = f"The example tire on cells of {1e3 * spacing:g} mm, kernels kept"
    print_table(title, HEADER, [*rolling(spacing)])
    header = ("cells", "floor, ms", "kernels, s", "kernels/floor", "bound")
    print_table("All kernels of a belt and its tread, cold", header, [row for one in grids for row in kernels(*one)])


if __name__ == "__main__":
    main()
