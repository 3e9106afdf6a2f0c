"""Means that are read again and again are those of `solve_response`."""

import numpy as np
import pytest

import treadload as tl
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.response import GridLoad, Response, solve_response
from treadload.response.means import Means

ASPHALT = tl.Elastic(5.4e9, 0.35)
ROADS = {
    "half-space": tl.Pavement.half_space(ASPHALT),
    "layers": tl.Pavement([tl.Layer(ASPHALT, 0.06), tl.Layer(tl.Elastic(200e6, 0.35))]),
    "upright": tl.Pavement.half_space(
        tl.materials.TransverselyIsotropic(6e9, 4e9, 1.5e9, poisson_horizontal=0.3, poisson_vertical=0.25)
    ),
}


def two_lattices(cell: float) -> list[GridLoad]:
    """The mean of two loads whose cells lie half a cell apart."""
    several = np.random.default_rng(4)
    loads = []
    for offset, shape in ((0.0, (12, 15)), (0.5, (13, 14))):
        grid = Grid(shape[1], shape[0], cell, cell, (offset - 7) * cell, (offset - 6) * cell)
        loads.append(GridLoad(grid, *(several.uniform(0, 4e5, (3, *shape)))))
    return loads


@pytest.mark.parametrize("road", ROADS)
@pytest.mark.parametrize("cell", [0.003, 0.006])
def test_means_are_those_of_a_response(road, cell):
    response = solve_response(two_lattices(cell), ROADS[road], depths=[0.0, 0.025], x=[0.0], y=[0.0])
    means = Means.of(response, 0.010)
    for depths, at in (
        ([0.0, 0.025], cell * np.arange(-3, 4)),
        ([0.004], 1e-3 * np.arange(5) / 2),
        ([0.008], [0.0011]),
    ):
        places = {"x": np.asarray(at), "y": np.asarray(at) + 1e-3}
        alone = solve_response(response.loads, ROADS[road], depths=depths, mean_over=0.010, **places).dataset
        fine, rough = (means.at(np.array(depths), **places, rough=rough) for rough in (False, True))
        for tensor in ("stress", "strain"):
            largest = max(float(np.abs(alone[f"{tensor}_{name}"]).max()) for name in ("xx", "yy", "zz"))
            for name in ("xx", "yy", "zz", "xy", "xz", "yz"):
                part = f"{tensor}_{name}"
                # The bound of interpolation between nodes.
                assert np.abs(fine[part] - alone[part]).max() < 1e-8 * largest
                # What a search may be off, see `Means.at`, with a margin.
                assert np.abs(rough[part] - alone[part]).max() < 3e-6 * largest


def test_a_response_without_its_road_has_no_means():
    response = solve_response(two_lattices(0.003)[:1], ROADS["half-space"], depths=[0.0])
    with pytest.raises(InputError, match="without it"):
        Means.of(Response(response.dataset), 0.010)
