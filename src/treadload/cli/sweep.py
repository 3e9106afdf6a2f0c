"""`treadload sweep`: a case with some of its inputs varied."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from treadload.cli import ending, shell
from treadload.cli.progress import counts

if TYPE_CHECKING:
    from treadload.case import Case
    from treadload.sweeps import Design

Vary = Annotated[
    list[str] | None,
    typer.Option(
        "--vary",
        metavar="KEY=VALUES",
        help="A key and its values: friction=0.3:0.9:7, normal_load='20 kN:40 kN:5', thickness='5 cm:20 cm:4:log' or "
        "pavement.temperature=[5, 15, 35]; with --sample a range, friction=0.3:0.9. Several make every combination.",
        show_default=False,
    ),
]
Table = Annotated[
    Path | None,
    typer.Option(
        "--table",
        help="Cases in a CSV file or an Excel sheet instead: headings are keys, as normal_load \\[kN].",
        show_default=False,
    ),
]
Ids = Annotated[
    list[str] | None,
    typer.Option(
        "--id",
        metavar="COLUMN",
        help="A column of --table that identifies its row; id, name, section and label do so by themselves. May be "
        "given several times.",
        show_default=False,
    ),
]
Sample = Annotated[
    str,
    typer.Option(
        metavar="METHOD:COUNT",
        help="Spread so many cases over the ranges of --vary: sobol:256, latin:100 or random:50.",
        show_default=False,
    ),
]
Seed = Annotated[int, typer.Option(min=0, help="Of the sample; the same gives the same cases.")]
FieldNames = Annotated[
    list[str] | None,
    typer.Option(
        "--field",
        metavar="NAME",
        help="Kept besides the numbers of every case: pressure, slice_along.strain_xx, max(principal_strain_1). May "
        "be given several times.",
        show_default=False,
    ),
]
Store = Annotated[
    Path | None,
    typer.Option("--output", "-o", help="Folder of the results, *.zarr; a study goes on in it.", show_default=False),
]
Jobs = Annotated[int, typer.Option(min=1, help="Processes of this machine.")]
Scheduler = Annotated[
    str | None,
    typer.Option(help="A Dask scheduler instead, tcp://host:8786, or local.", show_default=False),
]
Threads = Annotated[bool, typer.Option("--threads", help="Threads in place of processes.")]


@dataclass(frozen=True)
class Cases:
    """Which cases are solved, as typed."""

    vary: Vary = None
    table: Table = None
    ids: Ids = None
    sample: Sample = ""
    seed: Seed = 0

    def check(self) -> None:
        """Raise InputError for options that exclude each other."""
        from treadload.errors import InputError

        if self.table is not None and (self.vary or self.sample):
            raise InputError("--table gives all cases; leave out --vary and --sample, or the table")
        if self.ids and self.table is None:
            raise InputError("--id names a column of a table; give the table with --table")

    def of(self, question: Case) -> Design:
        """The cases of a question."""
        from treadload.sweeps import from_file, from_texts

        if self.table:
            return from_file(question, self.table, ids=self.ids or ())
        return from_texts(question, self.vary or (), sample=self.sample, seed=self.seed)


@dataclass(frozen=True)
class Workers:
    """Where the cases are solved, as typed."""

    jobs: Jobs = 1
    in_threads: Threads = False
    scheduler: Scheduler = None


@shell.with_options
def sweep(
    case: Annotated[Path, typer.Argument(help="The case, or the design case, a TOML file.")],
    cases: Cases,
    *,
    fields: FieldNames = None,
    output: Store = None,
    workers: Workers,
    changes: shell.Changes = None,
    dry_run: shell.DryRun = False,
    quiet: shell.Quiet = False,
) -> None:
    """Solve a case for many values of its inputs; goes on where it was interrupted."""
    from treadload.case.schema import read_case
    from treadload.sweeps import plan_sweep, sweep

    question = read_case(case, changes=changes or ())
    cases.check()
    design = cases.of(question)
    path = output or case.with_suffix(".zarr")
    if dry_run:
        return shell.planned(plan_sweep(question, design, fields or ()), path)
    with counts(shell.err, quiet=quiet) as tell:
        study = sweep(
            question, design, fields=fields or (), store=path, jobs=workers.jobs, in_threads=workers.in_threads,
            scheduler=workers.scheduler, progress=tell,
        )  # fmt: skip
    shell.summarise(study)
    shell.written([path])
    if not study.stats["solved"]:
        raise typer.Exit(ending.FAILED)
