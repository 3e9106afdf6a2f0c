"""`treadload init`, `schema`, `run`, `life` and `calibrate`: cases, and what comes of them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any, TypedDict, Unpack

import typer

from treadload.cli import shell
from treadload.cli.progress import Count, Stage, counts, stages


def run(
    case: Annotated[Path, typer.Argument(help="The case, a TOML file.")],
    output: shell.Output = None,
    changes: shell.Changes = None,
    dry_run: shell.DryRun = False,
    quiet: shell.Quiet = False,
) -> None:
    """Compute a case and write its result."""
    with stages(shell.err, quiet=quiet) as tell:
        _answer(case, output, changes, dry_run=dry_run, progress=tell)


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
    left_out = () if sensitivity else ("sensitivity",)
    with counts(shell.err, quiet=quiet) as tell:
        _answer(design, output, changes, dry_run=dry_run, command="life", count=tell, leave_out=left_out,
                workers=workers)  # fmt: skip


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
    try:
        with counts(shell.err, quiet=quiet) as tell:
            _answer(case, output, changes, dry_run=dry_run, command="calibrate", count=tell, jobs=jobs, state=state)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(
            "nothing is kept; with --state FILE, what is solved is kept, and the same command goes on from there"
            if state is None
            else f"what was solved is kept in {state}; the same command goes on from there"
        ) from None


class RunKeys(TypedDict, total=False):
    """Keywords of `treadload.run`, which explains them."""

    leave_out: tuple[str, ...]
    workers: int | None
    jobs: int
    state: Path | None


def _answer(
    file: Path,
    output: Path | None,
    changes: list[str] | None,
    *,
    dry_run: bool,
    command: str = "",
    progress: Stage | None = None,
    count: Count | None = None,
    **options: Unpack[RunKeys],
) -> None:
    """Read a case; print its plan, or solve it, print its summary and write its result.

    command: that the case must be for; any where it is left out. options: of `treadload.run`.
    """
    if dry_run:
        # Before NumPy is loaded: in the small products of a plan its threads only wait for each other.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from treadload.case import Case
    from treadload.errors import InputError
    from treadload.files import check_writable
    from treadload.results.exports import check_output, write
    from treadload.steps import Progress, plan
    from treadload.steps import run as run_case

    path = output or file.with_suffix(".nc")
    # A path that cannot be written is refused before the computation, not after it.
    check_output(path)
    case = Case.from_toml(file, changes=changes or ())
    if command and case.command != command:
        raise InputError(f"{file} is not a case of `treadload {command}`: use `treadload {case.command} {file}`")
    check_writable(path)
    if dry_run:
        return shell.planned(plan(case), path)
    hooks: dict[str, Any] = {"stage": progress, "count": count}
    result = run_case(case, progress=Progress(**{key: hook for key, hook in hooks.items() if hook}), **options)
    # What was computed is told before the disk can refuse it.
    shell.summarise(result)
    shell.written(write(result.to_tree(), path))


def init(
    kind: shell.Kind = "run",
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")] = Path("case.toml"),
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
) -> None:
    """Write a case that runs as it is, each key with its unit, its default and its reason."""
    from treadload.errors import InputError
    from treadload.files import write_whole
    from treadload.templates import first_case

    if kind.endswith(".toml"):
        raise InputError(
            f"the argument is the kind of case, run, life or calibrate; the file: treadload init -o {kind}"
        )
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
    from treadload.cli import listings
    from treadload.files import write_whole
    from treadload.templates import check_kind

    check_kind(kind)
    text = listings.schema(kind)
    if output is None:
        shell.plain(text)
        return
    shell.written([write_whole(output, text)])
    shell.out.print(f"first line of the case, for editors that know Taplo: #:schema ./{output.name}", markup=False)
