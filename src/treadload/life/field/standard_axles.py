"""Standard axles of 80 kN a year of a traffic, as tables of sections count them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from treadload.damage.traffic import AxleClass, Traffic

STANDARD_LOADS = {1: 80e3, 2: 147.7e3, 3: 213.5e3}
"""Loads of a single axle, a tandem and a tridem that do the damage of one standard axle, N.

18, 33.2 and 48 kip. By the equation of load equivalence of the AASHTO Guide 1993, as the University of Toledo
(course CET 3120) prints it, a tandem is one standard axle at 33.0 to 33.5 kip and a tridem at 47.1 to 48.2, for
structural numbers 1 to 6 and a terminal serviceability of 2.5.
"""
POWER = 4.0
"""Power of the load by which axles become standard ones, which the equation of the AASHO road test implies (Addis,
Transport Research Laboratory, Vehicle wheel loads and road pavement wear)."""
# Axles nearer to each other than this act as a group, m; wheels further apart across are of both ends of an axle, m.
_GROUP, _WIDE = 2.0, 1.0
# Wheels this near to each other along travel are of one axle, m.
_SAME = 0.05


def standard_axles(traffic: Traffic) -> float:
    """Standard axles of 80 kN in the first year of a traffic: (load / `STANDARD_LOADS`)^`POWER` of every group."""
    return float(sum(traffic.passes_per_year * row.share * standard_axles_of(row) for row in traffic.classes))


def standard_axles_of(row: AxleClass) -> float:
    """Standard axles of one passage of a class. Its wheels are those of one wheel path, or of both where they span
    more than an axle's half.
    """
    y = np.array([place[1] for place in row.wheels])
    ends = 1 if np.ptp(y) > _WIDE else 2
    x = np.sort([place[0] for place in row.wheels])
    axles = np.split(x, np.flatnonzero(np.diff(x) > _SAME) + 1)
    loads = [ends * row.wheel_load * len(axle) for axle in axles]
    at = np.array([float(axle.mean()) for axle in axles])
    groups = np.split(np.arange(len(at)), np.flatnonzero(np.diff(at) > _GROUP) + 1)
    return float(sum(_of_group([loads[k] for k in group]) for group in groups))


def _of_group(loads: Sequence[float]) -> float:
    """Of the loads of neighbouring axles, N; more than three count as several groups of three at most."""
    if len(loads) > max(STANDARD_LOADS):
        return _of_group(loads[:3]) + _of_group(loads[3:])
    return float((sum(loads) / STANDARD_LOADS[len(loads)]) ** POWER)
