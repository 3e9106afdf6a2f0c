"""Finite elements of a tread: the displacement of its face under loads on it.

In 2.5-D a cross-section under waves of load along travel, in 3-D a block.

scikit-fem is not used: pressure is eliminated inside every element and blocks are swept column by column, so that
of its elements and assembly only the nine shape functions would serve.
"""

from treadload.kernels.sections.block_mesh import Block
from treadload.kernels.sections.blocks import FaceCells, block_compliance
from treadload.kernels.sections.compliance import CellTable, FaceTable, face_compliance
from treadload.kernels.sections.section import Section

__all__ = ["Block", "CellTable", "FaceCells", "FaceTable", "Section", "block_compliance", "face_compliance"]
