"""README's chain on the 3 mm grid: contact and response, and the assessment on both grid offsets.

A scanned 335/65R22.5 at 32.5 kN that drives with 10 kN, one core, after import, in processor time. Contact and
response alone are timed in the same run as the whole chain, one after the other: the ratio of the two hardly depends
on the machine. Each chain starts as the first one of a process does, without what an earlier contact has kept.
Goals: 0.5 s for the chain; 2.3 times contact and response alone.
"""

import dataclasses
import itertools
import time

from timing import print_table

import treadload as tl
from treadload.contact.bodies.influence import forget_operators

GOAL, RATIO = 0.5, 2.3
REPEATS = 15
WHEEL = tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
LAW = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)


def chain(tire, number):
    """Processor time (s) of each step, and the assessment. number: of the chain, whose tire no other chain has."""
    forget_operators()
    tire = dataclasses.replace(tire, name=f"tire {number}")
    marks = [time.process_time()]
    contact = tl.solve_contact(tire, ROAD, WHEEL, spacing=3e-3)
    marks.append(time.process_time())
    response = tl.solve_response(contact, ROAD, depths=[0, 0.02])
    marks.append(time.process_time())
    verdict = tl.assess(response, LAW, shifted=True)
    marks.append(time.process_time())
    return [after - before for before, after in itertools.pairwise(marks)], verdict


def main():
    tire = tl.Tire.from_scan(tl.example_mesh(), inflation_pressure=820e3)
    cold, _ = chain(tire, 0)
    runs = [chain(tire, number) for number in range(1, REPEATS + 1)]
    verdict = runs[0][1]
    best = [min(times) for times in zip(*(run for run, _ in runs), strict=True)]
    alone, whole = best[0] + best[1], sum(best)
    rows = [
        (name, seconds, f"{seconds / alone:.2f}")
        for name, seconds in zip(
            ("contact", "response", "assessment with the contact half a cell beside"), best, strict=True
        )
    ]
    rows += [("contact and response alone", alone, "1.00"), ("whole chain", whole, f"{whole / alone:.2f}")]
    rows += [("whole chain, first run", sum(cold), "")]
    strain, passes = (float(verdict.dataset[name]) for name in ("worst_strain", "worst_passes"))
    print_table(
        f"README's chain on both grids: {1e6 * strain:.6f} microstrain, {passes:.6g} passes",
        ("step", "processor s", "of contact and response"),
        rows,
    )
    for name, value, goal in (("seconds", whole, GOAL), ("times contact and response", whole / alone, RATIO)):
        print(f"goal of {goal:g} {name}: {value:.2f}, {'kept' if value <= goal else 'MISSED'}")
    print()


if __name__ == "__main__":
    main()
