"""From a case to its results, from a traffic to a life."""

from treadload.study.delamination import BondComparison, compare_bonds, solve_interfaces
from treadload.study.design import DesignResult, run_design
from treadload.study.life import design_life
from treadload.study.passages import Passages, solve_passages
from treadload.study.plan import plan_case, plan_design
from treadload.study.run import Result, run_case
from treadload.study.sensitivity import Sensitivity, life_sensitivity
from treadload.study.two_grids import assess_on_two_grids
from treadload.study.uniform import UniformComparison, compare_uniform

__all__ = [
    "BondComparison",
    "DesignResult",
    "Passages",
    "Result",
    "Sensitivity",
    "UniformComparison",
    "assess_on_two_grids",
    "compare_bonds",
    "compare_uniform",
    "design_life",
    "life_sensitivity",
    "plan_case",
    "plan_design",
    "run_case",
    "run_design",
    "solve_interfaces",
    "solve_passages",
]
