"""Results together: one tree of named parts, its citations, NetCDF that others can open, and tables."""

from treadload.footprint import Footprint
from treadload.results.bibtex import bibtex
from treadload.results.dataset import Fields, height_map
from treadload.results.discs import EquivalentDiscs, equivalent_discs
from treadload.results.elements import write_elements
from treadload.results.exports import write_csv, write_excel, write_parquet
from treadload.results.files import open_results, save_results
from treadload.results.opened import Results
from treadload.results.roads import road_in_rows
from treadload.results.study import Study
from treadload.results.tractions import write_tractions
from treadload.results.tree import as_tree, to_tree
from treadload.results.vtk import write_vtk

__all__ = [
    "EquivalentDiscs",
    "Fields",
    "Footprint",
    "Results",
    "Study",
    "as_tree",
    "bibtex",
    "equivalent_discs",
    "height_map",
    "open_results",
    "road_in_rows",
    "save_results",
    "to_tree",
    "write_csv",
    "write_elements",
    "write_excel",
    "write_parquet",
    "write_tractions",
    "write_vtk",
]
