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

# Of rubber: what the tutorials and the warning of a contact give.
POISSON = 0.495
# Treads whose tables travel with the package: two of 1.6 MB. The other ribbed treads of the catalogue, the car's too,
# would bring two or more of the same size each; they are solved at first use, within a minute or so, and kept in the
# user's cache.
SHIPPED = ("315/80R22.5",)


def catalogue_sections() -> list[Section]:
    """Sections of the ribs of the treads in SHIPPED on the belt of their name, for cells of the default size."""
    sections = []
    for name in SHIPPED:
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
