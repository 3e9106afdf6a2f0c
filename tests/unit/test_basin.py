"""The basin around wheels: against the same response on a fine field, and against a plate on an elastic solid."""

import numpy as np
import pytest

from treadload.case import Case
from treadload.damage import Criterion, FatigueLine, FrenchSubgrade
from treadload.grid import Grid
from treadload.life.crossings import CrackLines, stresses
from treadload.life.passage import BEHIND, BORDER, Passing, passages
from treadload.life.seasons import Warm
from treadload.life.solve import solve_sum
from treadload.life.wheels import Wheels
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad
from treadload.response.basin import basin_reach, basin_tensors, coarsened, stiffness_radius, too_wide
from treadload.response.several import Question, tensors_of_many
from treadload.steps.design import design_of
from treadload.templates import first_case

ROAD = Pavement(
    [
        Layer(Elastic(4e9, 0.35), 0.06),
        Layer(Elastic(6e9, 0.35), 0.15),
        Layer(Elastic(120e6, 0.35)),
    ]
)
CELL = 10e-3
TOP = Criterion("top", FatigueLine(90e-6, -0.2), 0, "top", "in-plane")
BASE = Criterion("base", FatigueLine(90e-6, -0.2), 1)
SOIL = Criterion("soil", FrenchSubgrade(), -1, "top")
LIFE = """
spacing = "24 mm"
[tire]
profile = "315/80R22.5"
[pavement]
layers = [
  { name = "slab", thickness = "60 cm", material = { modulus = "30000 MPa", poisson = 0.2 } },
  { name = "soil", material = { modulus = "5 MPa", poisson = 0.35 } },
]
[climate]
temperature = 15
[traffic]
passes_per_year = 1e5
[[traffic.classes]]
name = "axle"
share = 1
wheel_load = "35 kN"
inflation_pressure = "8.3 bar"
[[criteria]]
name = "surface"
law = "fatigue-line"
layer = "slab"
place = "top"
epsilon_6 = "30 microstrain"
slope = -0.2
"""
Y = -1.8 + 5e-3 * np.arange(721)


def wheels(places=((0.0, 0.0),)):
    grid = Grid(25, 27, CELL, CELL, -12 * CELL, float(Y[0]) + CELL * 167)
    x, y = np.meshgrid(grid.x, grid.y)
    # Smooth to its edges, so that nothing near the wheel extends more than the basin does.
    shape = np.maximum(1 - (x / 0.11) ** 4, 0) * np.maximum(1 - (y / 0.12) ** 4, 0)
    pressure = 35e3 * shape / (shape.sum() * CELL**2)
    load = GridLoad(grid, pressure, np.zeros(shape.shape), np.zeros(shape.shape))
    loads = tuple(load.moved(x=at, y=right) for at, right in places)
    return Wheels(loads, np.array([grid.x + at for at in sorted({at for at, _ in places})]), None, "w", 0.0)


def solved(rolling, criterion=TOP, road=ROAD, turns=9, reach=1.5, y=Y):
    return passages([Passing(rolling, Warm(road, (criterion,)), y, turns, reach)])[0][0]


def test_the_radius_is_that_of_a_plate_on_a_solid():
    plate = Pavement([Layer(Elastic(30e9, 0.2), 0.25), Layer(Elastic(100e6, 0.4))])
    cubed = 30e9 * 0.25**3 * (1 - 0.4**2) / (6 * (1 - 0.2**2) * 100e6)
    assert stiffness_radius(plate) == pytest.approx(cubed ** (1 / 3), rel=1e-12)
    halves = Pavement([Layer(Elastic(30e9, 0.2), 0.1), Layer(Elastic(30e9, 0.2), 0.15), Layer(Elastic(100e6, 0.4))])
    assert stiffness_radius(halves) == pytest.approx(stiffness_radius(plate), rel=1e-12)
    assert stiffness_radius(Pavement.half_space(Elastic(1e8, 0.4))) == 0


def test_how_far_it_is_followed():
    assert basin_reach([ROAD]) == pytest.approx(max(1.5, 3 * stiffness_radius(ROAD)))
    stiff = Pavement([Layer(Elastic(40e9, 0.2), 1.5), Layer(Elastic(20e6, 0.4))])
    assert 3 * stiffness_radius(stiff) > 10
    assert basin_reach([ROAD, stiff]) == 10
    assert "followed to 10 m" in too_wide(stiff)
    assert too_wide(ROAD) == ""


def test_away_from_the_wheel_it_is_the_response_of_the_same_load():
    rolling = wheels()
    x, y = np.array([-1.4, -0.9, -0.75, -0.5, -0.3, -0.21]), np.array([-0.9, -0.4, 0.0, 0.21, 0.7])
    at = {"needs": TOP.needs, "mean_over": 0.01}
    exact = tensors_of_many([Question(rolling.joined, ROAD, np.zeros(1))], x, y, **at)[0]
    coarse = basin_tensors([Question(coarsened(rolling.loads), ROAD, np.zeros(1))], x, y, **at)[0]
    for name in ("stress_xx", "stress_yy", "stress_xy", "strain_xx", "strain_yy"):
        size = float(np.abs(exact[name]).max())
        # Blur, coarse cells and waves leave 0.5 % of the largest, 90 mm from the footprint.
        np.testing.assert_allclose(coarse[name], exact[name], atol=0.005 * size, err_msg=name)


def test_stress_for_cracks_is_that_of_a_reading():
    """Under the wheel, in a stiff course on soft soil too: 1e-6 of the largest stress of a component at a depth."""
    rolling, depths = wheels(), np.array([0.0, 0.004, 0.02, 0.05])
    soft = Pavement([Layer(Elastic(20e9, 0.35), 0.06), Layer(Elastic(20e6, 0.4))])
    for road in (ROAD, soft):
        lines = CrackLines.of(rolling, Y, 1.5)
        (stress,) = stresses(rolling, [Warm(road, ())], depths, lines)
        names = [f"stress_{part}" for part in ("xx", "yy", "zz", "xy", "xz", "yz")]
        x, y = lines.x[lines.near_x], lines.y[lines.near_y]
        (read,) = tensors_of_many([Question(rolling.joined, road, depths)], x, y, needs=names)
        near = stress[:, :, lines.near_y[:, None], lines.near_x]
        exact = np.stack([read[name].to_numpy() for name in names])
        assert np.abs(near - exact).max() <= 1e-6 * np.abs(exact).max()


def test_the_surface_hogs_around_the_wheel_and_is_read_there():
    read = solved(wheels())
    x, y = np.linspace(-1.3, 0.0, 131), Y[::4]
    exact = tensors_of_many([Question(wheels().joined, ROAD, np.zeros(1))], x, y, needs=TOP.needs, mean_over=0.01)[0]
    field = TOP.read(exact)[0]
    far = np.abs(y) > 0.25
    # A coarse basin, splines and straight lines between rows: half a per cent of the largest.
    np.testing.assert_allclose(read[0, ::4][far], field.max(axis=1)[far], atol=0.005 * field.max())
    assert read[0].max() == pytest.approx(field.max(), rel=0.003)
    ahead = int(np.abs(Y).argmin())
    # Ahead and behind: two alike cycles on the wheel's line, each from rest or nearly so.
    assert read[2, ahead] == pytest.approx(read[0, ahead], rel=0.01)
    assert read[1, ahead] < 0.3 * read[0, ahead]
    assert read[0, ahead] == pytest.approx(field[np.abs(y).argmin()].max(), rel=0.005)


def test_a_wider_field_moves_nothing():
    narrow, wide = (solved(wheels(((-1.31, 0.0), (0.0, 0.0), (1.31, 0.0))), reach=reach) for reach in (1.3, 2.0))
    harm = [(rows[0] ** 5 - rows[1] ** 5 + rows[2] ** 5).max() for rows in (narrow, wide)]
    assert harm[0] == pytest.approx(harm[1], rel=0.005)


def test_between_the_axles_of_a_group_their_basins_add_up():
    alone, group = solved(wheels()), solved(wheels(((-1.31, 0.0), (0.0, 0.0))))
    ahead = int(np.abs(Y).argmin())
    # At 0.655 m between two axles either one alone does nearly its most.
    assert 1.7 * alone[0, ahead] < group[0, ahead] < 2 * alone[0, ahead]


def test_a_group_longer_than_the_field_is_solved_around_all_of_its_axles():
    """Axles 9 m apart do not feel each other: twice the damage of one, whichever axle of them is read."""
    alone, group = solved(wheels()), solved(wheels(((-9.0, 0.0), (0.0, 0.0))))

    def harm(rows):
        return rows[0] ** 5 - rows[1] ** 5 + rows[2] ** 5 - rows[3] ** 5 + rows[4] ** 5 - rows[5] ** 5 + rows[6] ** 5

    assert harm(group).max() == pytest.approx(2 * harm(alone).max(), rel=0.01)
    assert group[9 + BORDER, int(harm(group).argmax())] == 0


def test_a_road_whose_basin_is_wider_than_it_is_followed_is_named_in_the_life():
    solved_passages = solve_sum(design_of(Case.from_text(LIFE, name="case")), workers=1).passages
    (named,) = [line for line in solved_passages.warnings if "followed to 10 m" in line]
    reach = 3 * stiffness_radius(Pavement([Layer(Elastic(30e9, 0.2), 0.6), Layer(Elastic(5e6, 0.35))]))
    assert f"{reach:.3g} m" in named
    assert solved_passages.reach == 10


@pytest.mark.slow
def test_the_surface_life_of_the_first_case_does_not_change_with_the_field(monkeypatch):
    """`treadload init life`, its basin followed to 1.3 and to 2.0 m: at 6 mm 0.008 %, under a half-space 0.011 %."""
    case = Case.from_text(first_case("life"), name="life", changes=["spacing=0.012"])
    design = design_of(case)
    years = []
    for reach in (1.3, 2.0):
        monkeypatch.setattr("treadload.life.passages.basin_reach", lambda roads, reach=reach: reach)
        life = solve_sum(design, workers=1)
        assert life.passages.reach == reach
        years.append(life.life.years("surface, top-down"))
    assert years[0] == pytest.approx(years[1], rel=0.01)


def test_a_largest_value_on_the_border_is_marked():
    inside = solved(wheels())
    assert inside[9 + BORDER, int(inside[0].argmax())] == 0
    short = solved(wheels(), reach=0.5, y=Y[260:461])
    assert short.shape == (9 + BEHIND, 201)
    assert short[9 + BORDER, int(short[0].argmax())] == 1


def test_deep_down_nothing_is_read_beyond_what_is_solved():
    narrow = np.abs(Y) <= 0.4
    for criterion in (BASE, SOIL):
        read = solved(wheels(), criterion)
        assert read[0].argmax() == np.abs(Y).argmin() or read[0].max() == pytest.approx(read[0, narrow].max())
        assert (read[0, np.abs(Y) > 0.8] == 0).all()
