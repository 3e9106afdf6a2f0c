"""How the fitted moduli of one basin scatter, together."""

from __future__ import annotations

import math

import numpy as np

from treadload.damage.scatter import Scatter
from treadload.deferred import xarray as xr
from treadload.errors import InputError

# Deviation of ln E up to which a modulus scatters as one number: a coefficient of variation of 1. Correlations closer
# to one than this are round-off.
_DECIDED, _JOINT = math.sqrt(math.log(2.0)), 1 - 1e-9


def scatter_of(basin: xr.Dataset) -> Scatter:
    """Scatter of the moduli of a basin of a backcalculation's dataset, with their correlation.

    Raises InputError for a modulus that the basin leaves undecided.
    """
    names = [str(name) for name in basin["layer_name"].to_numpy()]
    deviation = dict(zip(names, map(float, basin["modulus_deviation"].to_numpy()), strict=True))
    unknowns = [str(name) for name in basin["unknown"].to_numpy()]
    sought = [k for k, name in enumerate(unknowns) if math.isfinite(deviation.get(name, math.nan))]
    wide = [unknowns[k] for k in sought if deviation[unknowns[k]] > _DECIDED]
    if wide:
        raise InputError(
            f"the basin of station {basin['station'].item()} leaves the modulus of {wide[0]} undecided: it has a "
            f"deviation of ln E of {deviation[wide[0]]:.2g}, above {_DECIDED:.2g}; give a prior, or fix the layer"
        )
    joint = basin["unknown_correlation"].to_numpy()
    return Scatter(
        moduli={unknowns[k]: math.sqrt(math.expm1(deviation[unknowns[k]] ** 2)) for k in sought},
        modulus_correlation=tuple(
            (unknowns[i], unknowns[k], float(np.clip(joint[i, k], -_JOINT, _JOINT)))
            for n, i in enumerate(sought)
            for k in sought[n + 1 :]
        ),
    )
