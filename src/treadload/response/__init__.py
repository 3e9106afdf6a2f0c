"""Stress and strain in the road."""

from treadload.response.loads import GridLoad
from treadload.response.solution import Response
from treadload.response.solve import solve_response

__all__ = ["GridLoad", "Response", "solve_response"]
