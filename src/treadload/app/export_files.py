"""What a user takes home of a run: files that treadload writes."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

from treadload.composing import BaseResult
from treadload.errors import InputError
from treadload.files import write_whole
from treadload.reporting import report
from treadload.results import save_results
from treadload.results.exports import csv_files
from treadload.us_units import display_units

KINDS = {"nc": "result.nc", "html": "report.html", "csv": "tables.zip"}
"""What the process of a browser writes, and how the file is called at home."""


def write_export(
    parts: Mapping[str, BaseResult], whole: Callable[[], object], kind: str, folder: Path, run: str
) -> str:
    """Write a file of a run in the folder; returns its name.

    parts: what the page shows. whole: makes what `treadload run` gives, slices and all. Raises InputError.
    """
    if kind not in KINDS:
        raise InputError(f"there is nothing called {kind!r} to take home; there are {', '.join(KINDS)}")
    path = folder / f"{run}_{KINDS[kind]}"
    if path.exists():
        return path.name
    if kind == "html":
        report(whole(), path)
        return path.name
    # Files of results stay in SI units.
    with display_units("si"):
        if kind == "nc":
            save_results(whole(), path)
            return path.name
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
            for file, pieces in csv_files(dict(parts), Path("tables.csv")):
                archive.writestr(file.name, "".join(pieces))
        write_whole(path, content.getvalue())
    return path.name
