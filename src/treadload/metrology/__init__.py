"""Heights of a surface from files of surface metrology: X3P, SDF, SUR, AL3D.

Headers are compared with the bytes of the file before heights are read. No library is needed.
"""

from treadload.metrology.surface_file import ENDINGS, SurfaceMap, read_surface_map

__all__ = ["ENDINGS", "SurfaceMap", "read_surface_map"]
