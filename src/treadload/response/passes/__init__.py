"""Passes over a road that yields: plastic strain, residual stress, the rut, and what they come to."""

from treadload.response.passes.drum import roll_drum
from treadload.response.passes.solution import Passes
from treadload.response.passes.solve import roll_passes

__all__ = ["Passes", "roll_drum", "roll_passes"]
