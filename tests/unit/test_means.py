"""Means that are read again and again are those of `solve_response`."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.response import GridLoad, Response, solve_response
from treadload.response.means import Means
from treadload.response.superposition import mean_loads

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


@pytest.mark.parametrize("road", ROADS)
def test_the_fields_of_a_response_serve_where_its_points_stand_for_themselves(road):
    own, shifted = two_lattices(0.003)
    places = {"x": 0.003 * np.arange(-4, 5), "y": 0.003 * np.arange(-3, 4)}
    depths = np.array([0.0, 0.025, 0.05])
    solved = solve_response(own, ROADS[road], depths=depths, **places)
    both = replace(solved, loads=tuple(mean_loads([[own], [shifted]])))
    for response in (solved, both):
        means = Means.of(response, 0.010)
        again, served = means.at(depths, **places), means.at_points_of(solved, depths)
        for name in again:
            # Round-off, of synthesis from waves in layers.
            assert np.abs(served[name] - again[name]).max() <= 1e-10 * np.abs(again[name]).max()
    # They are read, not solved: at twice the fields the response itself has them, at the surface it is solved again.
    doubled = replace(solved, dataset=solved.dataset * 2)
    served = Means.of(solved, 0.010).at_points_of(doubled, depths)["stress_xx"]
    assert np.array_equal(served[1:], doubled.dataset["stress_xx"][1:])
    assert np.allclose(served[0], Means.of(solved, 0.010).at(depths[:1], **places)["stress_xx"][0])


def test_fields_with_a_stress_that_was_added_are_solved_again():
    (own, _), depths = two_lattices(0.003), np.array([0.025])
    solved = solve_response(own, ROADS["layers"], depths=depths, x=[0.0, 0.003], y=[0.0])
    added = replace(solved, dataset=solved.dataset + 1.0, restrained=(1.0,))
    means = Means.of(solved, 0.010)
    again = means.at(depths, added.dataset["x"].to_numpy(), added.dataset["y"].to_numpy())
    assert np.array_equal(means.at_points_of(added, depths)["stress_xx"], again["stress_xx"])
