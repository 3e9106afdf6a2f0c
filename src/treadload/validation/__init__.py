"""Witnesses: what treadload computes beside closed forms, published tables and other programs."""

from treadload.validation.check import Check
from treadload.validation.table import GROUPS, format_markdown, format_table, run_checks

__all__ = ["GROUPS", "Check", "format_markdown", "format_table", "run_checks"]
