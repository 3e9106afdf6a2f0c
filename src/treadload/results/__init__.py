"""Results together: one tree of named parts, its citations, NetCDF that others can open, and tables."""

from treadload.footprint import Footprint
from treadload.results.cite import citations
from treadload.results.dataset import Fields, height_map
from treadload.results.exports import write_csv, write_excel, write_parquet
from treadload.results.files import open_results, save_results
from treadload.results.opened import Results
from treadload.results.roads import road_in_rows
from treadload.results.study import Study
from treadload.results.tree import as_tree, to_tree

__all__ = [
    "Fields",
    "Footprint",
    "Results",
    "Study",
    "as_tree",
    "citations",
    "height_map",
    "open_results",
    "road_in_rows",
    "save_results",
    "to_tree",
    "write_csv",
    "write_excel",
    "write_parquet",
]
