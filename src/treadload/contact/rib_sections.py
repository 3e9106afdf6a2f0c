"""The cross-sections of a tire's ribs, solved ahead of the contact that needs them, with a word on each."""

from __future__ import annotations

from collections.abc import Callable

from treadload.contact.bodies.ribs import cells_section
from treadload.contact.bodies.section_tables import face_table
from treadload.contact.bounds import check_ribs
from treadload.tire import Tire


def prepare_ribs(tire: Tire, cell: float, tell: Callable[[str], None]) -> None:
    """Solve the sections of the ribs of a tire, where they are not kept from an earlier time.

    cell: size of the cells across, m. tell: called with a line of text before each; of a tire
    without ribs never. Raises InputError for cells that are too wide for the ribs.
    """
    if not tire.ribs or tire.belt is None:
        return
    check_ribs(tire, cell)
    sections = list(dict.fromkeys(cells_section(group, cell) for group in tire.ribs))
    for number, section in enumerate(sections, start=1):
        tell(f"cross-section {number} of {len(sections)} of the ribs, solved once and kept")
        face_table(section, tire.belt.tread.poisson)
