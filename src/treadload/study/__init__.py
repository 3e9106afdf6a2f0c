"""From a case to its results."""

from treadload.study.run import Result, run_case

__all__ = ["Result", "run_case"]
