"""A year of a road by every criterion: 12 seasons, 3 classes of axles in 3 maneuvers each, 17 criteria.

The road and the traffic of `examples/design_life`, read by its three criteria and by every quantity that a limit can
hold at the top of the wearing course. Two threads; processor seconds beside those of the clock, which a busy machine
stretches. `python year.py --sensitivities` goes on with those of the whole, as `treadload life` does.
"""

import os
import sys
import time
from pathlib import Path

from timing import print_table

import treadload as tl
from treadload.life.sensitivity import life_sensitivity
from treadload.life.solve import solve_life
from treadload.steps.design import design_of

DESIGN = Path(__file__).parents[1] / "examples" / "design_life" / "design.toml"
GOALS = {"life": 20.0, "sensitivities": 60.0}
STONES = 'cohesion = "250 kPa", friction_angle = "40 deg"'
MIX = (
    'creep_compliance = 1e-10, slope = 0.5, strength = "2 MPa", fracture_energy = 2500, resilient_modulus = "10 GPa"'
)
READS = {
    '"extension_strain"': "200 microstrain",
    '"in_plane_extension"': "200 microstrain",
    '"vertical_compression"': "900 microstrain",
    '"horizontal_tension"': "2 MPa",
    '"principal_tension"': "2 MPa",
    '"mazars_strain"': "300 microstrain",
    '{ quantity = "mazars_onset_ratio", onset = "80 microstrain" }': "4",
    '"von_mises_strain"': "900 microstrain",
    '"octahedral_shear_stress"': "1 MPa",
    '"mean_stress"': "1 MPa",
    f'{{ quantity = "octahedral_shear_ratio", {STONES} }}': "1",
    '"distortion_energy"': "900 J/m^3",
    '"vertical_shear_strain"': "900 microstrain",
    f'{{ quantity = "energy_ratio", {MIX} }}': "1",
}


def case():
    more = "".join(
        f'\n[[criteria]]\nname = "quantity {number}"\nlaw = "limit"\nreads = {reads}\nlimit = "{limit}"\n'
        'layer = "EB-BBSG3"\nplace = "top"\n'
        for number, (reads, limit) in enumerate(READS.items())
    )
    return tl.Case.from_text(DESIGN.read_text(encoding="utf-8") + more)


def timed(solve):
    began, spent = time.perf_counter(), time.process_time()
    result = solve()
    return result, time.perf_counter() - began, time.process_time() - spent


def main():
    design = design_of(case())
    life, seconds, processor = timed(lambda: solve_life(design, workers=2))
    rows = [("life", life.stats["contacts"], life.stats["responses"], seconds, processor)]
    if "--sensitivities" in sys.argv:
        _, seconds, processor = timed(lambda: life_sensitivity(design, life, workers=2))
        rows.append(("sensitivities", "", "", seconds, processor))
    rows = [(*row, GOALS[row[0]], "kept" if row[3] <= GOALS[row[0]] else "MISSED") for row in rows]
    header = ("what", "contacts", "responses", "seconds", "processor", "goal", "")
    print_table(f"A year by {len(life.criteria)} criteria, two threads of {os.cpu_count()} cores", header, rows)


if __name__ == "__main__":
    main()
