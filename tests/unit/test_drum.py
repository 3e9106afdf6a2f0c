"""A drum on its own track: work and resistance, soft and stiff limits, layers, what is refused, what a file keeps."""

import math
from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.errors import ConvergenceError
from treadload.grid import Grid
from treadload.kernels.eigenstrain.surface import settlement
from treadload.materials import MohrCoulomb, PassesPowerLaw, VonMises
from treadload.response import roll_drum
from treadload.response.layered import View
from treadload.response.passes import drum as drums
from treadload.response.passes.box import Box
from treadload.response.passes.dents import Dents
from treadload.response.passes.steady import taken
from treadload.response.several import Question, answers
from treadload.tire import TreadProfile

RADIUS, MODULUS, YIELD = 1.0, 100e6, 0.4e6
SOIL = tl.materials.ElastoPlastic(tl.Elastic(MODULUS, 0.35), VonMises(YIELD, hardening=MODULUS / 5))
ROAD = tl.Pavement.half_space(SOIL)
# A rigid ball: a wheel as round across as along.
BALL = tl.Tire.from_profile(
    TreadProfile(rolling_radius=RADIUS, crown_radius=RADIUS, width=0.06), material=tl.Elastic(1e15, 0.3), name="ball"
)
CELLS = {"spacing": (3e-3, 4e-3), "layers": 6}
# Of first yield, by Hertz.
PEAK = 1.61 * YIELD
DEPTH = (math.pi * PEAK * (1 - 0.35**2) / (2 * MODULUS)) ** 2 * RADIUS
LOAD = 2 / 3 * PEAK * math.pi * DEPTH * RADIUS


@pytest.fixture(scope="module")
def rolled():
    return roll_drum(BALL, ROAD, 6 * LOAD, passes=3, **CELLS)


def test_below_first_yield_a_drum_leaves_nothing():
    done = roll_drum(BALL, ROAD, 0.9 * LOAD, passes=3, **CELLS)
    assert done.verdict == "elastic"
    assert done.dataset.sizes["pass"] == 1
    assert not done.dataset.residual_displacement_z.any()
    # An elastic road pushes the wheel as far forwards as back.
    assert abs(float(done.dataset.rolling_resistance[0])) < 1e-6 * LOAD


def test_the_track_carries_the_drum_on_a_wider_and_milder_pressure(rolled):
    data = rolled.dataset
    carried = data.pressure.sum(("y", "x")).to_numpy() * data.attrs["dx"] * data.attrs["dy"]
    np.testing.assert_allclose(carried, 6 * LOAD, rtol=1e-6)
    # In its rut the ball sits deeper, and presses less hard than Hertz' does.
    assert (np.diff(data.approach) > 0).all()
    assert float(data.peak_pressure.max()) < 0.9 * 6 ** (1 / 3) * PEAK
    # Where the road yields the pressure lies ahead of the axle; in the last pass it is that of an elastic road again.
    assert float(data.pressure_centre_x[0]) > 20 * float(data.pressure_centre_x[2]) > 0
    assert float(data.plastic_increment[1]) < 0.5 * float(data.plastic_increment[0])
    # Making a rut costs work, of which later passes need little.
    assert float(data.rolling_resistance[0]) > 5 * float(data.rolling_resistance[2]) > 0


def test_what_resists_is_the_work_on_plastic_strain(monkeypatch):
    """The moment of the pressure over the radius is the work that its stress does on the strain of a pass, per metre.

    Betti's theorem: it holds only if surface and stress are moved by one and the same body.
    """
    kept = {}

    def watched(road, elastic, before, **how):
        done = real(road, lambda change: kept.setdefault("all", []).append((change, elastic(change)))
                    or kept["all"][-1][1], before, **how)  # fmt: skip
        kept["road"] = road
        return done

    real = drums.roll
    monkeypatch.setattr(drums, "roll", watched)
    data = roll_drum(BALL, ROAD, 6 * LOAD, passes=1, **CELLS).dataset
    change, stress = kept["all"][-1]
    box = kept["road"].box
    weights = np.array([1, 1, 1, 2, 2, 2])[:, None, None, None] * np.diff(box.edges)[:, None, None] * box.dy
    work = float((weights * stress * taken(change)).sum())
    # Stress is read at the middle of rows, and steps along travel are cells of a twelfth of the contact.
    assert float(data.rolling_resistance[0]) == pytest.approx(work, rel=0.06)


@pytest.mark.slow
def test_just_above_first_yield_the_pressure_hardly_feels_the_track():
    """There a drum is the wheel of `roll_passes`, whose pressure does not change."""
    cell = (2e-3, 2e-3)
    done = roll_drum(BALL, ROAD, 1.4 * LOAD, passes=1, spacing=cell, layers=8).dataset
    road = tl.Pavement.half_space(tl.Elastic(MODULUS, 0.35))
    grid = Grid(done.sizes["x"], done.sizes["y"], *cell, float(done.x[0]), float(done.y[0]))
    ball = tl.Tire.from_height_map(BALL.surface.height_map(grid), cell, material=tl.Elastic(1e15, 0.3))
    contact = tl.solve_contact(ball, road, tl.Rolling(normal_load=1.4 * LOAD, friction=0.0))
    shifted = tl.response.GridLoad(grid, contact.dataset.pressure.to_numpy())
    wheel = tl.response.roll_passes(shifted, ROAD, passes=1, spacing=cell, layers=8)
    # 9 % apart: a drum's stress is that at the middle of cells, a wheel's the mean across them, and two rows yield.
    assert float(done.rut_depth[0]) == pytest.approx(float(wheel.dataset.rut_depth[0]), rel=0.12)
    # So few cells do not show their error, which is stated.
    assert any("2 cells deep and 5 wide, fewer than the 4" in text for text in wheel.warnings)


@pytest.mark.slow
def test_dents_of_layers_are_those_of_bettis_theorem():
    """Of a track in a layered road, as long cells of strain sink the surface by the stress of the road itself."""
    box = Box(8, 6, 0.02, 0.03, 0.0, -0.075, np.array([0.0, 0.02, 0.05]))
    road = tl.Pavement([tl.Layer(tl.Elastic(1e8, 0.35), 0.06), tl.Layer(tl.Elastic(8e8, 0.3))])
    change = (
        np.random.default_rng(1).standard_normal((6, 2, 6, 8)) * np.array([1, 1, 1, 0.3, 0.3, 1])[:, None, None, None]
    )
    found = Dents.of(box, road).track(taken(change))
    long = 200
    behind = np.repeat(change[..., :1], long, axis=-1)
    world = replace(box, nx=long + 8)

    def pressed(depths, x, y):
        one = (tl.response.GridLoad(Grid(1, 1, box.dx, box.dy, 0.0, 0.0), np.ones((1, 1))),)
        view = View(x, y, components=range(6))
        (answer,) = answers([Question(one, road, depths)], view, side="below", speed=None, mean_over=None)
        return answer.fields.stress

    exact = settlement(np.concatenate([behind, change], axis=-1), world.cells, pressed)[:, long:]
    # The sum ends 4 m behind, as its inverse.
    assert np.abs(found - exact).max() < 2e-3 * np.abs(exact).max()


def test_a_file_holds_a_drum_and_its_figures_read_it(rolled, tmp_path):
    opened = tl.open_results(tl.save_results(rolled, tmp_path / "drum.nc")).passes
    assert opened.summary() == rolled.summary()
    assert "rolling resistance, N" in opened.summary()
    assert opened.normal_load == 6 * LOAD
    assert opened.drum == BALL
    assert len(opened.plot.drum().axes) == 2


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"load": 0.0}, "load must be a positive number of N"),
        ({"passes": 0}, "passes must be a whole number >= 1, got 0"),
        ({"tolerance": 1.0}, r"tolerance must lie in \[1e-6, 0.1\]"),
        ({"spacing": 0.01}, "spacing must be a length along travel and one across"),
        ({"spacing": (0.01, -1.0)}, "spacing across travel must be a positive number"),
        ({"road": tl.Pavement.half_space(tl.Elastic(1e8, 0.3))}, "no layer of this road can yield"),
        (
            {
                "road": tl.Pavement.half_space(
                    tl.materials.ElastoPlastic(tl.Elastic(1e8, 0.3), PassesPowerLaw(1, 0.5))
                )
            },
            "a PassesPowerLaw has no flow that could act on the drum",
        ),
        ({"depth": 0.006}, "the plastic zone reaches the depth of the box, 0.006 m"),
    ],
)
def test_what_cannot_be_rolled_is_refused_in_a_sentence(change, words):
    asked = {"drum": BALL, "road": ROAD, "load": 6 * LOAD, **CELLS} | change
    with pytest.raises(tl.InputError, match=words) as caught:
        roll_drum(asked.pop("drum"), asked.pop("road"), asked.pop("load"), **asked)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.slow
def test_a_soft_road_under_a_drum_says_that_it_has_no_steady_pass():
    """Without hardening and far above its strength; the sentence has the residual and what to do."""
    weak = tl.Pavement.half_space(tl.materials.ElastoPlastic(tl.Elastic(MODULUS, 0.35), MohrCoulomb(2e3, 0.2)))
    with pytest.raises((tl.InputError, ConvergenceError), match=r"no steady pass|far above what the road can carry"):
        roll_drum(BALL, weak, 6 * LOAD, passes=1, spacing=(8e-3, 8e-3), layers=3)
