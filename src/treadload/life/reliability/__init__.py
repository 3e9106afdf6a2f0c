"""Reliability of the service life: what a life scatters by, from few solves of changed roads."""

from treadload.life.reliability.propagation import MonteCarlo
from treadload.life.reliability.solution import Reliability
from treadload.life.reliability.solve import FEWEST_HELD, life_reliability, number_of_roads

__all__ = ["FEWEST_HELD", "MonteCarlo", "Reliability", "life_reliability", "number_of_roads"]
