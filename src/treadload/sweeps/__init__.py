"""Studies of many cases: which, where they are solved, where their results are kept."""

from treadload.sweeps.cluster import SchedulerLost
from treadload.sweeps.design import Design, Input
from treadload.sweeps.network import Network, Sections, read_sections, solve_network
from treadload.sweeps.plan import plan_sweep
from treadload.sweeps.sampling import bounds_of, over_points, sampled
from treadload.sweeps.screening import Morris, Sobol, Tornado, morris, sobol, tornado
from treadload.sweeps.sweep import Sweep, causes_of, open_sweep, sweep
from treadload.sweeps.tables import table_of
from treadload.sweeps.vary import from_file, from_texts

__all__ = [
    "Design",
    "Input",
    "Morris",
    "Network",
    "SchedulerLost",
    "Sections",
    "Sobol",
    "Sweep",
    "Tornado",
    "bounds_of",
    "causes_of",
    "from_file",
    "from_texts",
    "morris",
    "open_sweep",
    "over_points",
    "plan_sweep",
    "read_sections",
    "sampled",
    "sobol",
    "solve_network",
    "sweep",
    "table_of",
    "tornado",
]
