"""From a case to its results, from a traffic to a life."""

from treadload.study.life import design_life
from treadload.study.passages import Passages, solve_passages
from treadload.study.run import Result, run_case
from treadload.study.uniform import UniformComparison, compare_uniform

__all__ = [
    "Passages",
    "Result",
    "UniformComparison",
    "compare_uniform",
    "design_life",
    "run_case",
    "solve_passages",
]
