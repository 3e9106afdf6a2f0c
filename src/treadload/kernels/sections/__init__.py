"""2.5-D finite elements of a cross-section: the displacement of its face under waves of load along travel.

scikit-fem is not used: pressure is eliminated inside every element and blocks are swept column by column, so that
of its elements and assembly only the nine shape functions would serve.
"""

from treadload.kernels.sections.compliance import CellTable, FaceTable, face_compliance
from treadload.kernels.sections.section import Section

__all__ = ["CellTable", "FaceTable", "Section", "face_compliance"]
