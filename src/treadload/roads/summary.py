"""Rows of a backcalculation: classes of load, error bars in words, what is flagged, refused and undecided."""

from __future__ import annotations

import math
import re

import numpy as np

from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.roads.unknowns import DEPTH
from treadload.rows import Row, row

# Loads that differ by less than this part belong to one height of drop.
_SAME_LOAD = 0.12
_LISTED = 5
# Deviations of ln E above this are factors rather than parts.
_WIDE = 0.4
_NAMES, _LEAVE = re.compile(" and |, "), "these data leave "


def deviation_in_words(deviation: float) -> str:
    """A standard deviation of ln E."""
    return (
        f"± {100 * deviation:.2g} %" if deviation < _WIDE else f"times or over {math.exp(min(deviation, 20.0)):.2g}"
    )


def load_classes(loads: Array, good: Array) -> list[tuple[float, Array]]:
    """Drops by their height: median load, N, and numbers of the drops, of those that are good."""
    drops = np.flatnonzero(good)
    order = drops[np.argsort(loads[drops])]
    ordered = loads[order]
    cuts = np.flatnonzero(np.diff(ordered) > _SAME_LOAD * ordered[:-1]) + 1
    return [(float(np.median(loads[part])), np.sort(part)) for part in np.split(order, cuts)]


def depth_row(data: xr.Dataset, good: Array) -> Row:
    """Where the stiff layer lies."""
    depth = data["stiff_depth"].to_numpy()[good]
    if not np.isfinite(depth).any():
        return row("stiff_depth", "none: the last layer is a half-space")
    if DEPTH not in data["unknown"].to_numpy():
        return row("stiff_depth", f"{float(np.nanmedian(depth)):.4g} m below the surface")
    return row("stiff_depth", f"{float(np.nanmedian(depth)):.4g} m below the surface in the median, sought")


def reason_rows(data: xr.Dataset, chosen: Array, key: str) -> list[Row]:
    """Rows of the reasons, those of several basins counted."""
    by_kind: dict[str, list[tuple[str, str]]] = {}
    for basin in np.flatnonzero(chosen):
        for text in str(data["reason"].to_numpy()[basin]).split("; "):
            # Numbers differ from basin to basin; what is wrong stands before the colon.
            by_kind.setdefault(text.partition(":")[0], []).append((str(data["station"].to_numpy()[basin]), text))
    rows = []
    for kind, entries in by_kind.items():
        if len(entries) == 1:
            rows.append(row(key, f"station {entries[0][0]}: {entries[0][1]}"))
        else:
            rows.append(row(key, f"{kind}: {len(entries)} basins, at {_stations([name for name, _ in entries])}"))
    return rows


def undecided_rows(data: xr.Dataset) -> list[Row]:
    """A row for each unknown that some basins leave undecided."""
    texts = [str(text) for text in data["undecided"].to_numpy()]
    stations = [str(name) for name in data["station"].to_numpy()]
    if len(texts) == 1:
        return [row("undecided", text) for text in texts[0].split("; ") if text]
    rows = []
    for name in map(str, data["unknown"].to_numpy()):
        # The names stand between these words.
        among = [
            any(
                name in _NAMES.split(part.partition(" undecided")[0].removeprefix(_LEAVE))
                for part in text.split("; ")
            )
            for text in texts
        ]
        at = [station for station, named in zip(stations, among, strict=True) if named]
        if at:
            rows.append(
                row(
                    "undecided", f"{name}, alone or with others: {len(at)} of {len(texts)} basins, at {_stations(at)}"
                )
            )
    return rows


def _stations(names: list[str]) -> str:
    distinct = list(dict.fromkeys(names))
    more = "" if len(distinct) <= _LISTED else f" and {len(distinct) - _LISTED} more stations"
    return ", ".join(distinct[:_LISTED]) + more
