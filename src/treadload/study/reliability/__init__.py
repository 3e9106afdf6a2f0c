"""Years with a probability: what a life scatters by, from few solves of changed roads."""

from treadload.study.reliability.solution import Reliability
from treadload.study.reliability.solve import life_reliability, roads_asked

__all__ = ["Reliability", "life_reliability", "roads_asked"]
