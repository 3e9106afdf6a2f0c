"""A study as a table: one row for each case, with why it failed."""

from __future__ import annotations

import numpy as np
import xarray as xr

from treadload.sweeps.gathered import FAILED, SOLVED, UNSOLVED
from treadload.sweeps.sweep import Sweep

_WORDS = {UNSOLVED: "not solved", SOLVED: "solved", FAILED: "failed"}


def table_of(study: Sweep, *, fields: bool = False) -> xr.Dataset:
    """The dataset of a study for a table: `status` in words, `failure` with the reason, one row for each case.

    fields: with its fields too, a row for each of their places.
    """
    data = study.dataset
    status = data["status"]
    words = np.array([_WORDS.get(int(code), str(code)) for code in status.to_numpy().ravel()])
    reasons = np.full(study.design.count, "", dtype=object)
    for number, reason in study.failures:
        reasons[number] = reason
    kept = data[list(data.data_vars) if fields else ["status", "seconds", *study.results]]
    return kept.assign(
        status=(status.dims, words.reshape(status.shape), {"long_name": "whether the case was solved"}),
        failure=(status.dims, reasons.reshape(status.shape), {"long_name": "why the case failed"}),
    ).drop_attrs(deep=False)
