"""Excel workbooks as they are read."""

from __future__ import annotations

import io
import os
import warnings
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from treadload.errors import InputError, TreadloadError, error_line, how_to_install

# Bytes of a workbook and of all that it unpacks to; how far a large member may be packed; cells of a sheet.
_MOST_BYTES, _MOST_UNPACKED = 2**27, 2**29
_MOST_RATIO, _SMALL = 1000, 2**24
_MOST_CELLS, _MOST_ROWS = 5_000_000, 1_048_576


def numbered_rows(path: str | os.PathLike[str]) -> list[tuple[int, list[Any]]]:
    """Rows of the first visible sheet of a workbook that hold anything, with their numbers in the sheet, from 1.

    A formula gives the value that was saved with it, None where there is none. Raises InputError for what cannot be
    read, is a bomb, holds nothing, and without openpyxl.
    """
    try:
        import openpyxl
    except ImportError as error:
        raise InputError(
            f"cannot read {path}: Excel needs openpyxl, which is not installed; {how_to_install('excel')}, or give a "
            "CSV file"
        ) from error
    try:
        content = Path(path).read_bytes() if os.path.getsize(path) <= _MOST_BYTES else None
        if content is None:
            raise InputError(f"{path} has more than {_MOST_BYTES} bytes; save the sheet as CSV")
        _check_archive(content, path)
        # Remarks of the library, as on styles that it leaves out, mean nothing here.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
            sheet = next((sheet for sheet in book.worksheets if sheet.sheet_state == "visible"), None)
            if sheet is None:
                raise InputError(f"{path} has no visible sheet of cells; save the table in one")
            # What the sheet says of its own size may be all that Excel can hold.
            sheet.reset_dimensions()
            kept = list(_filled(sheet, path))
            book.close()
    except TreadloadError:
        raise
    # Whatever a broken archive or a strange sheet raises.
    except Exception as error:
        raise InputError(
            f"cannot read {path} as an Excel workbook ({error_line(error)}); open it in the spreadsheet and save it "
            "again, or save the sheet as CSV"
        ) from error
    if not kept:
        raise InputError(f"{path} holds nothing: its first visible sheet is empty")
    return kept


def _filled(sheet: Any, path: str | os.PathLike[str]) -> Iterator[tuple[int, list[Any]]]:
    cells = 0
    for number, row in enumerate(sheet.iter_rows(values_only=True), start=1):
        cells += len(row)
        if cells > _MOST_CELLS or number > _MOST_ROWS:
            raise InputError(
                f"{path} has more than {_MOST_CELLS} cells or {_MOST_ROWS} rows in its first visible sheet; delete "
                "what lies beside the table"
            )
        values = [None if isinstance(cell, str) and not cell.strip() else cell for cell in row]
        if any(cell is not None for cell in values):
            yield number, values


def _check_archive(content: bytes, path: str | os.PathLike[str]) -> None:
    """Raise InputError for an archive that unpacks to more than a workbook holds."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        entries = archive.infolist()
    total = sum(entry.file_size for entry in entries)
    if total > _MOST_UNPACKED:
        raise InputError(f"{path} unpacks to {total} bytes, more than {_MOST_UNPACKED}; save the sheet as CSV")
    for entry in entries:
        if entry.file_size > _SMALL and entry.file_size > _MOST_RATIO * entry.compress_size:
            raise InputError(
                f"{entry.filename!r} in {path} unpacks from {entry.compress_size} to {entry.file_size} bytes, more "
                f"than {_MOST_RATIO} times; do not trust the file"
            )
