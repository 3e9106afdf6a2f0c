"""From a case to its results, from a traffic to a life."""

from treadload.study.delamination import BondComparison, compare_bonds, solve_interfaces
from treadload.study.life import design_life
from treadload.study.passages import Passages, solve_passages
from treadload.study.run import Result, run_case
from treadload.study.uniform import UniformComparison, compare_uniform

__all__ = [
    "BondComparison",
    "Passages",
    "Result",
    "UniformComparison",
    "compare_bonds",
    "compare_uniform",
    "design_life",
    "run_case",
    "solve_interfaces",
    "solve_passages",
]
