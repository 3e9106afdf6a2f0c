"""Ribs with free sides beside the layer of the same tread: what a contact costs, kernels kept and from nothing.

The 315/80R22.5 at 820 kPa on cells of 3 mm, friction 0.7 where nothing else is stated: the layer with ν = 0.47, as a
belt of the catalogue has it, ribs with ν = 0.495. Both are solved in turn and the fastest of the repeats counts. The
tables of the sections are in the package. The bound is the house's: a contact within 3 times the layer's. Seconds of
the processor, on one thread.
"""

from time import process_time

from timing import best_of, print_table

import treadload as tl
from treadload.contact.bodies.influence import forget_operators

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
WHEELS = (
    ("20 kN", {"normal_load": 20e3, "friction": 0.7}),
    ("35 kN", {"normal_load": 35e3, "friction": 0.7}),
    ("50 kN", {"normal_load": 50e3, "friction": 0.7}),
    ("35 kN, friction 0.3", {"normal_load": 35e3, "friction": 0.3}),
    ("35 kN, 10 kN driving", {"normal_load": 35e3, "friction": 0.7, "tractive_force": 10e3}),
)
HEADER = ("rolling", "layer, s", "ribs, s", "ribs/layer", "bound", "rounds", "products of shear", "of pressing")


def tire(tread, poisson):
    """The catalogue's tire on a belt with this tread."""
    belt = tl.tire.Belt(tread=tl.Elastic(5.5e6, poisson), bending=(80, 100, 150))
    return tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3, belt=belt, tread=tread)


def contacts(tires, spacing, repeats, *, cold):
    """Rows of all wheels. cold: every contact builds its operators."""
    for name, options in WHEELS:
        wheel = tl.Rolling(**options)
        seconds, contact = [float("inf")] * len(tires), None
        for repeat in range(repeats + 1):
            for number, one in enumerate(tires):

                def solve(one=one, wheel=wheel):
                    if cold:
                        forget_operators()
                    return tl.solve_contact(one, ROAD, wheel, spacing=spacing)

                taken, contact = best_of(solve, 1, process_time)
                # The first makes the operators.
                if cold or repeat:
                    seconds[number] = min(seconds[number], taken)
        stats = contact.stats
        counts = stats["coupling_rounds"], stats["krylov_iterations"], stats["normal_iterations"]
        yield (name, *seconds, seconds[1] / seconds[0], 3, *counts)


def main(spacing=3e-3, repeats=5):
    tires = tire("layer", 0.47), tire("ribs", 0.495)
    for title, cold in (("kernels kept", False), ("from nothing", True)):
        print_table(f"Ribs beside a layer, {title}", HEADER, [*contacts(tires, spacing, repeats, cold=cold)])


if __name__ == "__main__":
    main()
