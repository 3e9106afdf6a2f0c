"""`treadload backcalculate`: moduli of a road from deflection basins."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import shell
from treadload.cli.progress import counts


def backcalculate(
    basins: Annotated[Path, typer.Argument(help="Basins: CSV, PDDX of AASHTO, or F25 of Dynatest.")],
    structure: Annotated[
        Path,
        typer.Argument(
            help="TOML with [pavement], [backcalculation] and the layout of a CSV, [basins] or [moving_basins]."
        ),
    ],
    output: shell.Output = None,
    jobs: Annotated[int, typer.Option(min=1, help="Processes.")] = 1,
    state: Annotated[
        Path | None,
        typer.Option(help="Folder that keeps what was solved; the same command goes on from it.", show_default=False),
    ] = None,
    changes: shell.Changes = None,
    quiet: shell.Quiet = False,
) -> None:
    """Find the moduli of a road's layers from deflection basins, with error bars, and write them."""
    from treadload.files import check_writable
    from treadload.results import to_tree
    from treadload.results.exports import check_output, write
    from treadload.roads import backcalculate as solve
    from treadload.roads import read_basins
    from treadload.steps.backcalculation import StructureFile

    path = output or basins.with_name(f"{basins.stem}_moduli.nc")
    check_output(path)
    question = StructureFile.from_toml(structure, changes=changes or ())
    drops = read_basins(basins, question.layout)
    check_writable(path)
    try:
        with counts(shell.err, quiet=quiet) as tell:
            result = solve(
                drops, question.structure, **question.backcalculation.options(), jobs=jobs, state=state, progress=tell
            )
    except KeyboardInterrupt:
        raise KeyboardInterrupt(
            "nothing is kept; with --state FOLDER, what is solved is kept, and the same command goes on from there"
            if state is None
            else f"what was solved is kept in {state}; the same command goes on from there"
        ) from None
    shell.summarise(result)
    shell.written(write(to_tree(result), path))
