"""Self-contained HTML reports."""

from treadload.reporting.build import report, write_report

__all__ = ["report", "write_report"]
