"""Results together: one tree of named parts, its citations, NetCDF that others can open, and tables."""

from treadload.results.cite import citations
from treadload.results.dataset import height_map
from treadload.results.exports import write_csv, write_excel
from treadload.results.files import load, save
from treadload.results.roads import road_in_rows
from treadload.results.tree import life_tree, to_tree

__all__ = [
    "citations",
    "height_map",
    "life_tree",
    "load",
    "road_in_rows",
    "save",
    "to_tree",
    "write_csv",
    "write_excel",
]
