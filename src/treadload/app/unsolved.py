"""What a case asks for and the page does not solve, said beside the result, with the command that solves it."""

from __future__ import annotations

from treadload.case import Case
from treadload.case.step import Source


def left_out(case: Case) -> tuple[str, ...]:
    """Names of the steps of a case that the page does not solve."""
    return tuple(step.name for step in case.steps if not (step.is_quick or isinstance(step, Source)))


def unsolved(case: Case) -> list[str]:
    """Tables of a case, "[crossing]", that the page does not solve. A life is solved whole."""
    if case.command == "life":
        return []
    return [f"[{step.name}]" for step in case.steps if step.has_table and not step.is_quick]


def unsolved_sentence(case: Case | None) -> str:
    """A sentence on what the page did not solve of a case; "" where it solved all."""
    named = [] if case is None else unsolved(case)
    if case is None or not named:
        return ""
    those = f"{', '.join(named[:-1])} and {named[-1]}" if len(named) > 1 else named[0]
    return (
        f"This page did not solve {those}. Take the TOML home and run `{command(case)}`; the NetCDF and the report "
        "below solve the whole case, too, for as long as that takes."
    )


def command(case: Case, file: str = "case.toml") -> str:
    """The command that solves a case whole."""
    return f"treadload {case.command} {file}"
