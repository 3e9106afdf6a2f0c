"""Rate of the interpolation from lattices in the distance that it leaves to near cells."""

import numpy as np

from treadload.kernels.gridding import gridded, precorrected
from treadload.kernels.half_space.interior import fields_on_grid


def test_twelfth_order_in_the_distance_to_the_nearest_cell_interpolated(monkeypatch):
    load = np.zeros((3, 1, 1))
    load[0] = 1.0
    rng = np.random.default_rng(3)
    reaches = np.array([7.0, 9.0, 12.0, 16.0])
    # Alone, a cell is interpolated from just beyond the window on: points there see the worst of it.
    places = [(reach + rng.uniform(0.5, 1.5, 20), rng.uniform(-2, 2, 20)) for reach in reaches]

    def settlement(x, y, method):
        return fields_on_grid(load, 1.0, 1.0, np.zeros(1), 1.0, 0.35, x, y, method)[1][0, 2]

    exact = [settlement(*at, "direct") for at in places]
    monkeypatch.setattr(gridded, "_cheapest", lambda *at: [(0.0, "precorrected", 1)] * len(at[3]))
    errors = []
    for reach, at, values in zip(reaches, places, exact, strict=True):
        monkeypatch.setattr(precorrected, "FINE", precorrected.Order(12, reach))
        errors.append(np.abs(settlement(*at, "precorrected") - values).max() / values.max())
    rates = -np.diff(np.log(errors)) / np.diff(np.log(reaches))
    # Degree 11 in x and y leaves the twelfth derivative, which falls with the twelfth power beyond the load's own.
    assert (rates > 12).all(), rates
