"""Solve the cross-sections of the catalogue's treads and write their tables into the package.

    python benchmarks/ship_section_tables.py

Run it after a change of the elements, of a table or of a tread in the catalogue; tables of other treads are
removed. `tests/unit/test_section_tables.py` fails where a table is missing or differs from a new solution.
"""

from __future__ import annotations

import treadload as tl
from treadload.contact.bodies.section_tables import ship, shipped_path
from treadload.contact.contact_grid import DEFAULT_SPACING
from treadload.kernels.sections import Section
from treadload.tire import TreadProfile
from treadload.tire.belt import belts
from treadload.tire.library import tires

# Of rubber: what the tutorials and the warning of a contact give.
POISSON = 0.495
# Radius of a tire, m, below which it is a car's.
SMALLEST_TRUCK = 0.4


def catalogue_sections() -> list[Section]:
    """Sections of the treads of the catalogue that have ribs and a belt of their name, for cells of the default size.

    The "335/65R22.5 tread" is left out: two of its ribs are joined by a shallow groove, and such a table takes 18 MB.
    So is the car tire, whose tables are made at its first use.
    """
    sections = []
    for name, tread in tires.items():
        if not isinstance(tread, TreadProfile) or tread.lateral or not tread.grooves or name not in belts:
            continue
        if tread.rolling_radius < SMALLEST_TRUCK:
            continue
        belt = tl.tire.Belt.from_library(name)
        tire = tl.Tire.from_profile(name, inflation_pressure=820e3, belt=belt, tread="ribs")
        sections += [group.section.for_cells(DEFAULT_SPACING) for group in tire.ribs]
    return list({shipped_path(section, POISSON): section for section in sections}.values())


def main() -> None:
    """Write the tables and remove all others."""
    paths = [ship(section, POISSON) for section in catalogue_sections()]
    for path in paths[0].parent.glob("*.npz"):
        if path not in paths:
            path.unlink()
    print(f"{len(paths)} tables, {sum(path.stat().st_size for path in paths) / 1e6:.1f} MB, in {paths[0].parent}")


if __name__ == "__main__":
    main()
