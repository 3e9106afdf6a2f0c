"""Ribs with free sides on a belt: a tread that is the same along travel only.

The compliance of a rib is that of its cross-section (`kernels.sections`). Ribs that stand apart do not affect each
other through their thin common undertread: at the depth of a truck's grooves that is 1.6 % of the compliance under
loads that do not vary along travel, and less under others.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from treadload.contact.bodies.body import Body, Offsets, Rows, Strip, Waves
from treadload.contact.bodies.section_tables import face_table
from treadload.kernels.arrays import Array
from treadload.kernels.sections import CellTable, Section
from treadload.materials import Elastic
from treadload.tire.rib_rows import rows_on_faces
from treadload.tire.ribs import RibGroup

# Wider cells, as those on which a contact is located, share the elements of these, m.
_WIDEST = 3e-3
# Tables of rows that are kept, and decimals of a metre to which their ends are rounded: mirrored ribs share a table.
_KEPT, _DECIMALS = 16, 12


def cells_section(group: RibGroup, cell: float) -> Section:
    """The section of ribs with the elements that cells of a size, m, need."""
    return group.section.for_cells(min(cell, _WIDEST))


@dataclass(frozen=True)
class Ribs(Body):
    """Ribs of a tread, body 1. groups: of ribs that stand apart. material: their rubber.

    layer: the same rubber without grooves, which stands for the ribs where a single number is asked for.
    """

    groups: tuple[RibGroup, ...]
    material: Elastic
    layer: Body

    def normal(self, at: Offsets) -> Array:
        """As in `Body`: none, all is in the strips."""
        return np.zeros((at.ny, at.nx))

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`: none, all is in the strips."""
        return np.zeros((3, at.ny, at.nx))

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`: none, all is in the strips."""
        return np.zeros((2, at.ny, at.nx))

    def compliance(self, waves: Waves) -> Array:
        """As in `Body`, of the layer."""
        return np.asarray(self.layer.compliance(waves))

    def across(self, k: Array) -> Array:
        """As in `Body`, of the layer."""
        return self.layer.across(k)

    @property
    def striped(self) -> bool:
        """As in `Body`."""
        return True

    def strips(self, rows: Rows) -> tuple[Strip, ...]:
        """As in `Body`: rows that lie on a face, each with the part that it stands for, see `tire.rib_rows`."""
        bands = [band for group in self.groups for band in group.bands]
        on_faces = iter(rows_on_faces(rows.y, rows.dy, bands))
        strips = []
        for group in self.groups:
            faces = [face for face in itertools.islice(on_faces, len(group.bands)) if face.rows.size]
            if not faces:
                continue
            number = np.concatenate([face.rows for face in faces])
            relative = np.concatenate([face.parts for face in faces]) - group.centre
            if group.mirrored:
                relative = -relative[::-1, ::-1]
            edges = tuple(np.round(relative, _DECIMALS).ravel().tolist())
            table = _rows_table(cells_section(group, rows.dy), self.material.poisson, edges, rows.dy)
            strips.append(Strip(number, table, self.material.modulus, group.mirrored))
        return tuple(strips)


@lru_cache(maxsize=_KEPT)
def _rows_table(section: Section, poisson: float, edges: tuple[float, ...], dy: float) -> CellTable:
    """Table of rows of dy, m, of a section. edges: left and right end of every row in turn, m."""
    return face_table(section, poisson).on_cells(np.reshape(edges, (-1, 2)), dy)
