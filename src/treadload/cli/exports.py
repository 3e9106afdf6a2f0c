"""`treadload export`, `cite` and `as-python`: what is taken to other programs, papers and scripts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from treadload.cli import shell

if TYPE_CHECKING:
    from treadload.composing import BaseResult


def export(
    results: Annotated[Path, typer.Argument(help="A result file, .nc.")],
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o",
            help=".vts, .vtr or .vtu (ParaView), .inp (loads for Abaqus and CalculiX), .dat (contact stresses of "
            "cells), .csv, .xlsx or .parquet (tables).",
        ),
    ],
    part: Annotated[
        str, typer.Option(help="Of the results, by name; left out, the contact or the response that fits.")
    ] = "",
    units: Annotated[str, typer.Option(help="Of a .dat or .inp file: SI (m, Pa) or mm (mm, MPa).")] = "SI",
    discs: Annotated[
        int | None, typer.Option(help="Write so many equivalent discs of the contact, as .csv.", show_default=False)
    ] = None,
) -> None:  # fmt: skip
    """Write a result, or a part of it, for another program; the file extension selects it."""
    from treadload.contact import Contact
    from treadload.errors import InputError
    from treadload.files import TABLE, check_suffix
    from treadload.response import Response
    from treadload.results import open_results
    from treadload.results.discs import equivalent_discs
    from treadload.results.elements import ELEMENTS, write_elements
    from treadload.results.exports import TABLES, write
    from treadload.results.tractions import TRACTIONS, write_tractions
    from treadload.results.vtk import VTK, write_vtk

    suffix = check_suffix(output, {**TABLES, **VTK, **TRACTIONS, **ELEMENTS} if discs is None else TABLE, "results")
    opened = open_results(results)

    def chosen(*kinds: type[BaseResult]) -> BaseResult:
        groups = [kind.group for kind in kinds]
        name = part or next((group for group in groups if group in opened), "")
        if not name:
            raise InputError(
                f"{results} holds no {' and no '.join(groups)}; it holds {', '.join(opened) or 'nothing'}"
            )
        return opened[name]

    if discs is not None:
        equivalents = equivalent_discs(chosen(Contact), discs)
        shell.summarise(equivalents)
        files: tuple[Path, ...] = (equivalents.write_csv(output),)
    elif suffix in VTK:
        kinds = (Response,) if suffix == ".vtr" else (Contact, Response)
        files = (write_vtk(chosen(*kinds), output),)
    elif suffix in TRACTIONS:
        files = (write_tractions(chosen(Contact), output, units=units),)
    elif suffix in ELEMENTS:
        files = write_elements(chosen(Contact), output, units=units)
    else:
        files = write(opened.tree if not part else opened[part].dataset, output)
    shell.written(files)


def cite(
    source: Annotated[
        Path | None,
        typer.Argument(
            help="A case, .toml, a result, .nc, or a tire, .tir; left out, the program itself.", show_default=False
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File to write, .bib; else it is printed.", show_default=False),
    ] = None,
) -> None:
    """BibTeX of the program and of the methods that a case, a result or a tire file really uses."""
    from treadload.citations import references
    from treadload.files import check_suffix, write_whole
    from treadload.results.bibtex import bibtex, citations_of

    if output is not None:
        check_suffix(output, {".bib": "BibTeX"}, "citations")
    if source is None:
        used = references(())
    elif source.suffix.lower() == ".toml":
        from treadload.case import Case

        used = citations_of(Case.from_toml(source))
    elif source.suffix.lower() == ".tir":
        from treadload.tire.magic_formula import methods
        from treadload.tire.tir_file import read_tir

        used = references(methods(read_tir(source).version))
    else:
        from treadload.results import open_results

        used = citations_of(open_results(source).tree)
    text = bibtex(used)
    if output is None:
        shell.plain(text)
        return
    shell.written([write_whole(output, text)])


def as_python(
    case: Annotated[Path, typer.Argument(help="The case of a wheel or of a life, a TOML file.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File to write, .py; else it is printed.", show_default=False),
    ] = None,
    changes: shell.Changes = None,
) -> None:
    """A case as the Python that gives the same numbers."""
    from treadload.case import Case
    from treadload.files import check_suffix, write_whole
    from treadload.steps import case_as_python

    if output is not None:
        check_suffix(output, {".py": "Python"}, "a script")
    text = case_as_python(Case.from_toml(case, changes=changes or ()))
    if output is None:
        shell.plain(text)
        return
    shell.written([write_whole(output, text)])
