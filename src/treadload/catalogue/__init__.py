"""Named things with their sources and caveats: mixes, structures, viscoelastic materials, tires and belts.

Each is a read-only mapping, `catalogue.mixes["BBSG3"]`; other packages bring more by entry points, see the `group` of
each. The readers take files like those in `catalogue/data`.
"""

from treadload.materials.library import mixes, read_mixes
from treadload.materials.published import published as materials
from treadload.materials.published import read_materials
from treadload.named import Catalogue
from treadload.pavement.catalogue import Structure, read_structures, structures
from treadload.tire.belt import belts, read_belts
from treadload.tire.library import TireMesh, read_tires, tires

__all__ = [
    "Catalogue",
    "Structure",
    "TireMesh",
    "belts",
    "materials",
    "mixes",
    "read_belts",
    "read_materials",
    "read_mixes",
    "read_structures",
    "read_tires",
    "structures",
    "tires",
]
