"""`treadload init`, `schema`, `run`, `life` and `calibrate`: cases, and what comes of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import shell
from treadload.cli.progress import counts, stages


def run(
    case: Annotated[Path, typer.Argument(help="The case, a TOML file.")],
    output: shell.Output = None,
    changes: shell.Changes = None,
    dry_run: shell.DryRun = False,
    quiet: shell.Quiet = False,
) -> None:
    """Compute a case and write its result."""
    from treadload.case import Case
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write
    from treadload.study import plan_case, run_case

    path = output or case.with_suffix(".nc")
    # A path that cannot be written is refused before the computation, not after it.
    check_output(path)
    question = Case.from_toml(case, changes=changes or ())
    check_writable(path)
    if dry_run:
        return shell.planned(plan_case(question), path)
    with stages(shell.err, quiet=quiet) as tell:
        result = run_case(question, progress=tell)
        tell(f"writing {path}")
        files = write(result.to_tree(), path)
    shell.out.print(result.summary(), markup=False)
    shell.written(files)


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
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write
    from treadload.study import plan_life, run_life

    path = output or design.with_suffix(".nc")
    check_output(path)
    question = LifeCase.from_toml(design, changes=changes or ())
    check_writable(path)
    if dry_run:
        return shell.planned(plan_life(question), path)
    with counts(shell.err, quiet=quiet) as tell:
        result = run_life(question, sensitivity=sensitivity, workers=workers, progress=tell)
    files = write(result.to_tree(), path)
    shell.out.print(result.summary(), markup=False)
    shell.written(files)


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
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write
    from treadload.study import plan_calibration, run_calibration

    path = output or case.with_suffix(".nc")
    check_output(path)
    question = CalibrationCase.from_toml(case, changes=changes or ())
    check_writable(path)
    if dry_run:
        return shell.planned(plan_calibration(question), path)
    with counts(shell.err, quiet=quiet) as tell:
        result = run_calibration(question, jobs=jobs, state=state, progress=tell)
    files = write(result.to_tree(), path)
    shell.out.print(result.summary(), markup=False)
    shell.written(files)


def init(
    kind: shell.Kind = "run",
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")] = Path("case.toml"),
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
) -> None:
    """Write a case that runs as it is, each key with its unit, its default and its reason."""
    from treadload.case.first import first_case
    from treadload.errors import InputError
    from treadload.files import replacing

    text = first_case(kind)
    if output.exists() and not force:
        raise InputError(f"{output} exists already; give another name with -o, or --force to overwrite it")
    with replacing(output) as path:
        path.write_text(text, encoding="utf-8")
    shell.written([output])
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
    from treadload.files import replacing

    text = json.dumps(json_schema(kind), indent=2, ensure_ascii=False)
    if output is None:
        print(text)
        return
    with replacing(output) as path:
        path.write_text(f"{text}\n", encoding="utf-8")
    shell.written([output])
    shell.out.print(f"first line of the case, for editors that know Taplo: #:schema ./{output.name}", markup=False)
