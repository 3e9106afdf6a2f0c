"""Studies of many cases: which, where they are solved, where their results are kept."""

from treadload.study.sweeps.cluster import SchedulerLost
from treadload.study.sweeps.design import Design, Input, bounds_of, over_points, sampled
from treadload.study.sweeps.plan import plan_sweep
from treadload.study.sweeps.sweep import Sweep, causes_of, open_sweep, sweep
from treadload.study.sweeps.tables import table_of
from treadload.study.sweeps.vary import from_file, from_texts

__all__ = [
    "Design",
    "Input",
    "SchedulerLost",
    "Sweep",
    "bounds_of",
    "causes_of",
    "from_file",
    "from_texts",
    "open_sweep",
    "over_points",
    "plan_sweep",
    "sampled",
    "sweep",
    "table_of",
]
