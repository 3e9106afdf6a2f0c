"""A study as a table: one row for each case, with why it failed."""

from __future__ import annotations

import numpy as np

from treadload.deferred import xarray as xr
from treadload.sweeps.gathered import FAILED, SOLVED, UNSOLVED
from treadload.sweeps.sweep import Sweep

_WORDS = {UNSOLVED: "not solved", SOLVED: "solved", FAILED: "failed"}


def table_of(study: Sweep, *, fields: bool = False) -> xr.Dataset:
    """The dataset of a study for a table: `status` in words, `failure` with the reason, one row for each case.

    fields: with its fields too, a row for each of their places.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> study = tl.sweep(case, {"normal_load": ["50 N", "100 N"]})
    >>> tl.sweeps.table_of(study).status.values.tolist()
    ['solved', 'solved']
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
