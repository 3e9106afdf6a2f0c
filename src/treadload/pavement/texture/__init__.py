"""Texture of a road: readers, treatment, depth, and surfaces from a spectrum."""

from treadload.pavement.texture.crg import CurvedGrid, read_crg
from treadload.pavement.texture.depth import ProfileDepth, map_profile_depth, mean_profile_depth, mean_texture_depth
from treadload.pavement.texture.description import Texture
from treadload.pavement.texture.files import of_matrix, read_texture
from treadload.pavement.texture.synthetic import self_affine
from treadload.pavement.texture.treatment import band_pass, cut, fill_dropouts, level, remove_outliers

__all__ = [
    "CurvedGrid",
    "ProfileDepth",
    "Texture",
    "band_pass",
    "cut",
    "fill_dropouts",
    "level",
    "map_profile_depth",
    "mean_profile_depth",
    "mean_texture_depth",
    "of_matrix",
    "read_crg",
    "read_texture",
    "remove_outliers",
    "self_affine",
]
