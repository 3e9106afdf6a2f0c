"""A case and its tables."""

from treadload.case.model import Case

__all__ = ["Case"]
