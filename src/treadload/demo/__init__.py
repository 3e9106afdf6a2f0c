"""The demonstration: a real truck tire, rolling freely and driving."""

from treadload.demo.run import Demo, run_demo

__all__ = ["Demo", "run_demo"]
