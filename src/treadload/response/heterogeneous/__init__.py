"""A window of road in which stones stand in a mortar: stress in both, and what it does to their bond."""

from treadload.response.heterogeneous.solution import Heterogeneous
from treadload.response.heterogeneous.solve import compute_heterogeneous, mortar_road

__all__ = ["Heterogeneous", "compute_heterogeneous", "mortar_road"]
