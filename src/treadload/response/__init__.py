"""Stress, strain and displacement in the road."""

from treadload.response.gears import axle, dual_wheels, place_load, tandem
from treadload.response.loads import GridLoad, UniformDisc, UniformRectangle
from treadload.response.material import MATERIAL_LENGTH
from treadload.response.solution import Response
from treadload.response.solve import solve_response

__all__ = [
    "MATERIAL_LENGTH",
    "GridLoad",
    "Response",
    "UniformDisc",
    "UniformRectangle",
    "axle",
    "dual_wheels",
    "place_load",
    "solve_response",
    "tandem",
]
