"""A scanned tread of which a result file keeps the description and the sizes, not the mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

from treadload.errors import InputError
from treadload.grid import Grid
from treadload.tire.cross_section import TreadSection
from treadload.tire.quality import ScanQuality


@dataclass(frozen=True)
class RecordedSurface:
    """The description of a surface whose mesh is not at hand.

    words: of the surface. extent: m. quality: of the scan. camber: rad. outer_radius, crown_arc_radius: m, or None.
    cross_section: its grooves; None in files of earlier versions.
    Its gap cannot be asked again: `height_map` raises InputError that states how to go on.
    """

    words: str
    extent: tuple[float, float]
    quality: ScanQuality | None = None
    camber: float = 0.0
    outer_radius: float | None = None
    crown_arc_radius: float | None = None
    cross_section: TreadSection | None = None

    @property
    def fixed_grid(self) -> Grid | None:
        """None: no grid at all is known."""
        return None

    def height_map(self, grid: Grid) -> NoReturn:
        """Raise InputError: the gap is not known here."""
        raise InputError(
            f"the tread of this tire is not in the result file, only what it did to the road: {self.words}; read "
            "the scan again with Tire.from_scan, or take the gap on the cells of the contact, "
            'Tire.from_height_map(contact.dataset["initial_gap"])'
        )

    def __str__(self) -> str:
        return self.words
