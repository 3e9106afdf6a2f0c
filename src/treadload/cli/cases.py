"""`treadload init`, `schema`, `run`, `life` and `calibrate`: cases, and what comes of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Protocol

import typer

from treadload.cli import shell
from treadload.cli.progress import counts, stages
from treadload.describing import HasSummary


class Answer(HasSummary, Protocol):
    """A result of a case."""

    def to_tree(self) -> Any:
        """What is written of it."""


def run(
    case: Annotated[Path, typer.Argument(help="The case, a TOML file.")],
    output: shell.Output = None,
    changes: shell.Changes = None,
    dry_run: shell.DryRun = False,
    quiet: shell.Quiet = False,
) -> None:
    """Compute a case and write its result."""
    from treadload.case import Case
    from treadload.study import plan_case, run_case, run_dents

    def solve(question: Case) -> Answer:
        with stages(shell.err, quiet=quiet) as tell:
            return run_dents(question, progress=tell) if question.dents else run_case(question, progress=tell)

    _answer(case, Case, plan_case, solve, output, changes, dry_run=dry_run)


def life(
    design: Annotated[Path, typer.Argument(help="The design case, a TOML file.")],
    output: shell.Output = None,
    sensitivity: Annotated[bool, typer.Option(help="Find what the life depends on most; doubles the work.")] = True,
    workers: Annotated[int | None, typer.Option(min=1, help="Threads; all cores if left out.")] = None,
    changes: shell.Changes = None,
    dry_run: shell.DryRun = False,
    quiet: shell.Quiet = False,
) -> None:
    """Compute the life of a road under its traffic and climate, and write it."""
    from treadload.case import LifeCase
    from treadload.study import plan_life, run_life

    def solve(question: LifeCase) -> Answer:
        with counts(shell.err, quiet=quiet) as tell:
            return run_life(question, sensitivity=sensitivity, workers=workers, progress=tell)

    _answer(design, LifeCase, plan_life, solve, output, changes, dry_run=dry_run)


def calibrate(
    case: Annotated[Path, typer.Argument(help="The calibration case, a TOML file.")],
    output: shell.Output = None,
    jobs: Annotated[int, typer.Option(min=1, help="Processes.")] = 1,
    state: Annotated[
        Path | None,
        typer.Option(help="File that keeps what was solved; a search goes on from it.", show_default=False),
    ] = None,
    changes: shell.Changes = None,
    dry_run: shell.DryRun = False,
    quiet: shell.Quiet = False,
) -> None:
    """Fit numbers of a tire to what was measured of it, with error bars, and write them."""
    from treadload.case import CalibrationCase
    from treadload.study import plan_calibration, run_calibration

    def solve(question: CalibrationCase) -> Answer:
        try:
            with counts(shell.err, quiet=quiet) as tell:
                return run_calibration(question, jobs=jobs, state=state, progress=tell)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(
                "nothing is kept; with --state FILE, what is solved is kept, and the same command goes on from there"
                if state is None
                else f"what was solved is kept in {state}; the same command goes on from there"
            ) from None

    _answer(case, CalibrationCase, plan_calibration, solve, output, changes, dry_run=dry_run)


def _answer(
    file: Path,
    kind: Any,
    plan: Callable[[Any], str],
    solve: Callable[[Any], Answer],
    output: Path | None,
    changes: list[str] | None,
    *,
    dry_run: bool,
) -> None:
    """Read a case of a kind; print its plan, or solve it, print its summary and write its result."""
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write

    path = output or file.with_suffix(".nc")
    # A path that cannot be written is refused before the computation, not after it.
    check_output(path)
    question = kind.from_toml(file, changes=changes or ())
    check_writable(path)
    if dry_run:
        return shell.planned(plan(question), path)
    result = solve(question)
    # What was computed is told before the disk can refuse it.
    shell.out.print(result.summary(), markup=False)
    shell.written(write(result.to_tree(), path))


def init(
    kind: shell.Kind = "run",
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")] = Path("case.toml"),
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
) -> None:
    """Write a case that runs as it is, each key with its unit, its default and its reason."""
    from treadload.case.first import first_case
    from treadload.errors import InputError
    from treadload.files import write_whole

    text = first_case(kind)
    if output.exists() and not force:
        raise InputError(f"{output} exists already; give another name with -o, or --force to overwrite it")
    shell.written([write_whole(output, text)])
    shell.out.print(f"next: treadload {kind} {output} --dry-run", markup=False)


def schema(
    kind: shell.Kind = "run",
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File to write; else it is printed.", show_default=False),
    ] = None,
) -> None:
    """JSON schema of a case, with what other packages bring: an editor then completes and explains its keys."""
    import json

    from treadload.case.schema import json_schema
    from treadload.files import write_whole

    text = json.dumps(json_schema(kind), indent=2, ensure_ascii=False)
    if output is None:
        shell.plain(f"{text}\n")
        return
    shell.written([write_whole(output, f"{text}\n")])
    shell.out.print(f"first line of the case, for editors that know Taplo: #:schema ./{output.name}", markup=False)
