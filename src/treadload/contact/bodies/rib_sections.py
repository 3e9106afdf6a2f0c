"""The cross-sections of a tire's ribs, solved ahead of the contact that needs them, with a word on each."""

from __future__ import annotations

from collections.abc import Callable

from treadload.contact.bodies.ribs import cells_section
from treadload.contact.bodies.section_tables import face_table
from treadload.tire import Tire


def solve_sections(tire: Tire, cell: float, tell: Callable[[str], None]) -> None:
    """Solve the sections of the ribs of a tire, where they are not kept from an earlier time.

    cell: size of the cells, m. tell: called with a line of text before each; of a tire without ribs never.
    """
    if not tire.ribs or tire.belt is None:
        return
    sections = list(dict.fromkeys(cells_section(group, cell) for group in tire.ribs))
    for number, section in enumerate(sections, start=1):
        tell(f"cross-section {number} of {len(sections)} of the ribs, solved once and kept")
        face_table(section, tire.belt.tread.poisson)
