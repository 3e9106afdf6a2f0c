"""Excel workbooks as they are read."""

from __future__ import annotations

import os
from typing import Any

from treadload.errors import InputError, how_to_install


def numbered_rows(path: str | os.PathLike[str]) -> list[tuple[int, list[Any]]]:
    """Rows of the first sheet of a workbook that hold anything, with their numbers in the sheet, from 1.

    Raises InputError for what cannot be read, holds nothing, or without openpyxl.
    """
    try:
        import openpyxl
    except ImportError as error:
        raise InputError(
            f"cannot read {path}: Excel needs openpyxl, which is not installed; {how_to_install('excel')}, or give a "
            "CSV file"
        ) from error
    try:
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
        rows = [list(row) for row in book.worksheets[0].iter_rows(values_only=True)]
        book.close()
    # Whatever a broken archive or a strange sheet raises.
    except Exception as error:
        raise InputError(f"cannot read {path} as an Excel workbook: {error}") from error
    kept = [(number, row) for number, row in enumerate(rows, start=1) if any(cell is not None for cell in row)]
    if not kept:
        raise InputError(f"{path} holds nothing: its first sheet is empty")
    return kept
