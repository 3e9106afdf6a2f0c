"""Fits of stations, a row for each of their drops."""

from __future__ import annotations

import dataclasses

import numpy as np

from treadload.roads.solve import REFUSED, Fits
from treadload.roads.station_loads import StationLoads


def by_drop(fits: Fits, stations: StationLoads) -> Fits:
    """The fit of its station for every drop, with the deflections and the misfit of the drop.

    Drops that were left out of their station are refused with their reason.
    """
    row = stations.station_of
    out = Fits(**{entry.name: getattr(fits, entry.name)[row] for entry in dataclasses.fields(Fits)})
    fitted = stations.of_drop(fits.deflection)
    measured = stations.basins.deflection
    with np.errstate(all="ignore"):
        square = np.square(fitted / measured - 1)
    there = np.isfinite(square)
    misfit = np.sqrt(np.where(there, square, 0.0).sum(axis=1) / np.maximum(there.sum(axis=1), 1))
    out = dataclasses.replace(out, deflection=fitted, misfit=np.where(there.any(axis=1), misfit, np.nan))
    for drop, reason in enumerate(stations.reasons):
        if reason:
            for entry in dataclasses.fields(Fits):
                values = getattr(out, entry.name)
                values[drop] = "" if values.dtype == object else 0.0 if entry.name == "at_bound" else np.nan
            out.status[drop], out.reason[drop] = REFUSED, reason
    return out
