"""Networks of roads: a table of sections, the remaining life of each, and which fails first."""

from treadload.sweeps.network.sections import Sections, read_sections
from treadload.sweeps.network.solution import Network
from treadload.sweeps.network.solve import network_of, solve_network

__all__ = ["Network", "Sections", "network_of", "read_sections", "solve_network"]
