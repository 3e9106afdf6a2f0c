"""Stress, strain and displacement in the road."""

from treadload.grid import Grid
from treadload.response.gears import axle, dual_wheels, place_load, tandem
from treadload.response.heterogeneous import Heterogeneous, compute_heterogeneous
from treadload.response.loads import GridLoad, UniformDisc, UniformRectangle
from treadload.response.material import MATERIAL_LENGTH
from treadload.response.passes.drum import roll_drum
from treadload.response.passes.solution import Passes
from treadload.response.passes.solve import roll_passes
from treadload.response.settle import SettledModuli, settle
from treadload.response.solution import Response
from treadload.response.solve import solve_response
from treadload.response.superposition import map_grid

__all__ = [
    "MATERIAL_LENGTH",
    "Grid",
    "GridLoad",
    "Heterogeneous",
    "Passes",
    "Response",
    "SettledModuli",
    "UniformDisc",
    "UniformRectangle",
    "axle",
    "compute_heterogeneous",
    "dual_wheels",
    "map_grid",
    "place_load",
    "roll_drum",
    "roll_passes",
    "settle",
    "solve_response",
    "tandem",
]
