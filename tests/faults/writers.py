"""Whatever writes a file or a folder, each as a function of its path."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

import treadload as tl
from studies import FREE, question, records_of, wheel
from treadload.sweeps.design import product
from treadload.sweeps.store import begun


@dataclass(frozen=True)
class Writer:
    """A writer. name: of the file or folder that it is given. write: called with the path. slow: takes over 0.5 s.

    fresh: its names are always new, so that it replaces nothing.
    """

    name: str
    write: Callable[[Path], Any]
    slow: bool = False
    fresh: bool = False

    @property
    def is_store(self) -> bool:
        """True for a folder that grows; a file appears at once."""
        return self.name.endswith(".zarr")


DESIGN = product(FREE, {"rolling.friction": [0.3, 0.5, 0.7], "rolling.normal_load": ["20 kN", "30 kN"]})


def store(path: Path, count: int = DESIGN.count) -> None:
    """A study of a function, up to so many of its cases."""
    with begun(path, FREE, DESIGN, question(FREE)) as keeping:
        for record in records_of(DESIGN, wheel):
            if not keeping.finished and record.number not in keeping.records and record.number < count:
                keeping.append(record)


def writers() -> dict[str, Writer]:
    """All of them by name, over the contact and the response of a small tread."""
    from treadload.calibration.evaluations import Evaluations
    from treadload.cli.cases import init, schema
    from treadload.cli.exports import as_python, cite
    from treadload.results.discs import equivalent_discs
    from treadload.results.elements import write_elements
    from treadload.results.exports import write_csv, write_excel, write_parquet
    from treadload.results.tractions import write_tractions
    from treadload.results.vtk import write_vtk

    x = 5e-3 * (np.arange(24) - 11.5)
    tire = tl.Tire.from_height_map((x[None, :] ** 2 + x[:, None] ** 2) / 0.8, 5e-3, material=tl.Elastic(3e6, 0.5))
    road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=400.0, friction=0.7, tractive_force=100.0))
    response = tl.solve_response(contact, road, depths=[0.0, 0.02])
    both = {"contact": contact, "response": response}
    figure = contact.plot.pressure()
    discs = equivalent_discs(contact, 3)
    known = {((float(number),), 0): np.arange(9.0) for number in range(300)}
    solved = SimpleNamespace(readings_by_task=known, problem=SimpleNamespace(fingerprint="a"))

    def shown(command: Callable[..., Any], *arguments: Any) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            command(*arguments)

    def from_case(command: Callable[..., Any], path: Path) -> None:
        shown(command, None if command is cite else _case(), path)

    return {
        "netcdf": Writer("a.nc", lambda path: tl.save_results(both, path)),
        "csv": Writer("a.csv", lambda path: write_csv(both, path)),
        "parquet": Writer("a.parquet", lambda path: write_parquet(both, path)),
        "excel": Writer("a.xlsx", lambda path: write_excel(both, path)),
        "cells": Writer("a.vts", lambda path: write_vtk(contact, path)),
        "points": Writer("a.vtr", lambda path: write_vtk(response, path)),
        "mesh": Writer("a.vtu", lambda path: write_vtk(contact, path)),
        "elements": Writer("a.inp", lambda path: write_elements(contact, path)),
        "tractions": Writer("a.dat", lambda path: write_tractions(contact, path)),
        "discs": Writer("a.csv", discs.write_csv),
        "report": Writer("a.html", lambda path: tl.report(both, path), slow=True),
        "linked": Writer("a.html", lambda path: contact.plot.interactive().write_html(path), slow=True),
        "png": Writer("a.png", lambda path: tl.plots.save(figure, path)),
        "svg": Writer("a.svg", lambda path: tl.plots.save(figure, path)),
        "pdf": Writer("a.pdf", lambda path: tl.plots.save(figure, path)),
        "savefig": Writer("b.png", lambda path: figure.savefig(path)),
        "init": Writer("case.toml", lambda path: shown(init, "run", path, True)),
        "schema": Writer("a.json", lambda path: shown(schema, "run", path), slow=True),
        "cite": Writer("a.bib", lambda path: from_case(cite, path)),
        "as-python": Writer("a.py", lambda path: from_case(as_python, path)),
        "state": Writer("state.json", lambda path: Evaluations._write(solved, path)),
        "store": Writer("a.zarr", store),
        "taken home": Writer("a_tables.zip", lambda path: _take(both, path), fresh=True),
        "upload": Writer("upload.csv", _upload, fresh=True),
    }


def _case() -> Path:
    return Path(__file__).parent / "case.toml"


def _take(parts: Any, path: Path) -> None:
    """The tables of a run as the page hands them over."""
    from treadload.app.export_files import write_export

    write_export(parts, lambda: None, "csv", path.parent, "a")


def _upload(path: Path) -> None:
    from treadload.app.session import Session

    session = Session(SimpleNamespace(), folder=path.parent)
    session.keep("mine.csv", b"1,2\n" * 5000, (".csv",))
