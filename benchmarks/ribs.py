"""Ribs with free sides beside the layer of the same tread: products with the operator, contacts, first uses.

The 315/80R22.5 at 820 kPa on cells of 3 mm, friction 0.7 where nothing else is stated: the layer with ν = 0.47, as a
belt of the catalogue has it, ribs with ν = 0.495. Both are solved in turn and the fastest of the repeats counts. The
tables of the sections are in the package. The bounds are the house's: a product within 2 times the layer's, a contact
within 3 times. A tread that is not in the catalogue, five ribs of one kind, has its sections solved in 6 s and
read from the cache folder in 0.2 s. Seconds of the processor, on one thread.
"""

import os
import tempfile
from time import process_time

import numpy as np
from timing import best_of, print_table

import treadload as tl
from treadload.contact.bodies import Influence, Pair, section_tables
from treadload.contact.bodies.influence import forget_operators
from treadload.contact.bodies.ribs import cells_section
from treadload.contact.bodies.section_tables import face_table
from treadload.grid import Grid
from treadload.tire import TreadProfile
from treadload.tire.grooves import Groove

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


def products(tires, repeats=40):
    """Row of the displacement in three components by pressure and shear, on 40 x 120 cells."""
    grid = Grid.on_lattice(0.36, 0.30, 3e-3, 7.5e-3)
    ny, nx = shape = 40, 120
    draws = np.random.default_rng(1)
    pressure, shear = draws.random(shape), draws.standard_normal((2, *shape))
    bodies = [Pair.of(one, ROAD).both for one in tires]
    operators = [Influence(shape, grid.dx, grid.dy, body, -0.5 * (ny - 1) * grid.dy) for body in bodies]
    seconds = [float("inf")] * len(tires)
    for repeat in range(repeats + 1):
        for number, influence in enumerate(operators):
            rows = influence.material[:, None]
            taken, _ = best_of(lambda i=influence, r=rows: i.displacement(r * pressure, r * shear), 1, process_time)
            # The first makes the operators.
            if repeat:
                seconds[number] = min(seconds[number], taken)
    yield (f"{ny} x {nx} cells", *(1e3 * one for one in seconds), seconds[1] / seconds[0], 2)


def first_uses(spacing):
    """Rows of the tables of a tread of five ribs of one kind: its sections solved, and read from the cache folder."""
    grooves = tuple(Groove(y, 0.0112, 0.0141) for y in (-0.0834, -0.0278, 0.0278, 0.0834))
    profile = TreadProfile(0.5, 1.5, 0.27, grooves=grooves, shoulder_radius=0.008)
    belt = tl.tire.Belt(tread=tl.Elastic(5.5e6, 0.495), bending=(80, 100, 150))
    ribs = tl.Tire.from_profile(profile, inflation_pressure=820e3, belt=belt, tread="ribs").ribs
    sections = {cells_section(group, spacing) for group in ribs}
    with tempfile.TemporaryDirectory() as folder:
        os.environ["TREADLOAD_CACHE"] = folder
        for name, bound in (("solved", 6), ("from the cache", 0.2)):
            section_tables._table.cache_clear()
            taken, _ = best_of(lambda: [face_table(section, 0.495) for section in sections], 1, process_time)
            yield name, taken, bound


def main(spacing=3e-3, repeats=5):
    tires = tire("layer", 0.47), tire("ribs", 0.495)
    header = "product", "layer, ms", "ribs, ms", "ribs/layer", "bound"
    print_table("Products with the operator, three components", header, [*products(tires)])
    print_table("Sections of five ribs of one kind", ("tables", "s", "bound"), [*first_uses(spacing)])
    for title, cold in (("kernels kept", False), ("from nothing", True)):
        print_table(f"Ribs beside a layer, {title}", HEADER, [*contacts(tires, spacing, repeats, cold=cold)])


if __name__ == "__main__":
    main()
