"""A network of roads in a report: its sections by rank, and those that failed."""

from __future__ import annotations

import numpy as np

from treadload.deferred import xarray as xr
from treadload.reporting.tables import NamedTable
from treadload.sweeps.gathered import FAILED
from treadload.sweeps.network.solution import ranking
from treadload.units import remaining_in_words, years_in_words

# Rows of a table.
_ROWS = 2000


def network_tables(data: xr.Dataset) -> tuple[NamedTable, ...]:
    """Sections by rank with their lives, and those that failed with their reasons."""
    order, placed = ranking(data), bool(np.isfinite(data["section_position"].to_numpy()).any())
    measured = "section_length" in data
    criteria = [str(name) for name in data["criterion"].to_numpy()]
    columns = ("rank", "section", *(("station",) if placed else ()), *(("length",) if measured else ()),
               "remaining life", "governing criterion", "age",
               "service life", *(f"by {name}" for name in criteria))  # fmt: skip
    rows = [_row(data.isel(section=int(k)), rank, placed) for rank, k in enumerate(order[:_ROWS], start=1)]
    heading = "Sections by remaining life"
    if len(order) > _ROWS:
        heading += f", the first {_ROWS} of {len(order)}"
    failed = np.flatnonzero(data["section_status"].to_numpy() == FAILED)
    reasons = [(str(data["section"].to_numpy()[k]), str(data["reason"].to_numpy()[k])) for k in failed[:_ROWS]]
    tables = (
        NamedTable(heading, columns, tuple(rows)),
        NamedTable("Sections that failed", ("section", "reason"), tuple(reasons)),
    )
    return tuple(table for table in tables if table.rows)


def _length(length: float) -> str:
    return "–" if np.isnan(length) else f"{length / 1e3:.3g} km"


def _row(at: xr.Dataset, rank: int, placed: bool) -> tuple[str, ...]:
    station = (f"{float(at['section_position']) / 1e3:.3f} km",) if placed else ()
    return (
        str(rank),
        str(at["section"].item()),
        *station,
        *((_length(float(at["section_length"])),) if "section_length" in at else ()),
        remaining_in_words(float(at["remaining_years"])),
        str(at["governing_criterion"].item()),
        years_in_words(float(at["section_age"])),
        years_in_words(float(at["governing_years"])),
        *(years_in_words(float(years)) for years in at["life_years"].to_numpy()),
    )
