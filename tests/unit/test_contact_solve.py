"""solve_contact: the public door. What goes in, what comes out, and every refusal."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from treadload.contact import Contact, Rolling, contact_grid, solve_contact, solve_transient, turn_on_the_spot
from treadload.contact import solve as solving
from treadload.contact.bodies.influence import forget_operators
from treadload.contact.solvers import coupling
from treadload.errors import ConvergenceError, GeometryError, InputError
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.tire import Groove, Tire, TreadProfile, example_mesh
from treadload.validation.tires import contact_conditions

ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))
RUBBER = Elastic(3e6, 0.5)
SMALL = TreadProfile(0.3, 0.4, 0.12, 0.01, grooves=(Groove(-0.025, 0.008, 0.006), Groove(0.025, 0.008, 0.006)))
TIRE = Tire.from_profile(SMALL, material=RUBBER)
SPACING = 4e-3


def solve(tire=TIRE, road=ROAD, spacing=SPACING, **rolling):
    return solve_contact(tire, road, Rolling(**{"normal_load": 3e3, "friction": 0.6, **rolling}), spacing=spacing)


def bowl(n=40, spacing=3e-3, radius=0.4):
    x = spacing * (np.arange(n) - (n - 1) / 2)
    return (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius)


def holds(contact):
    failed = [check for check in contact_conditions("", contact) if not check.passed]
    assert not failed, failed


@pytest.fixture(scope="module")
def driving():
    return solve(tractive_force=500.0, lateral_force=-200.0, spin=0.1)


def test_the_conditions_of_contact(driving):
    holds(driving)


def test_the_result_keeps_its_question_and_its_names(driving):
    assert isinstance(driving, Contact)
    assert driving.tire is TIRE
    assert driving.road is ROAD
    assert driving.rolling == Rolling(
        normal_load=3e3, friction=0.6, tractive_force=500.0, lateral_force=-200.0, spin=0.1
    )
    data = driving.dataset
    for name in data.variables:
        assert "units" in data[name].attrs, name
    assert data.pressure.dims == ("y", "x")
    assert (data.attrs["dx"], data.attrs["dy"]) == (SPACING, SPACING)
    assert set(np.unique(data.state)) == {0, 1, 2}


def test_the_road_feels_the_opposite_of_the_tire(driving):
    data = driving.dataset
    cell = driving.cell_area
    assert float(data.traction_x.sum()) * cell == pytest.approx(-500.0, rel=1e-6)
    assert float(data.traction_y.sum()) * cell == pytest.approx(200.0, rel=1e-6)
    assert float(data.tractive_force) == pytest.approx(500.0, rel=1e-6)
    moment = float((data.y * data.traction_x - data.x * data.traction_y).sum()) * cell
    assert float(data.aligning_moment) == pytest.approx(moment, rel=1e-9)
    assert float(data.creepage_x) < 0


def test_the_road_goes_down_under_pressure_and_back_under_driving(driving):
    data = driving.dataset
    assert float(data.displacement_z.max()) > 0
    assert (data.displacement_z.to_numpy()[data.pressure.to_numpy() > 0] > 0).all()
    assert float(data.displacement_x.mean()) < 0


def test_statistics_and_summary(driving):
    stats = driving.stats
    assert stats["normal_residual"] <= 1e-6
    assert stats["rolling_residual"] <= 1e-6
    assert stats["coupling_change"] <= 1e-6
    assert stats["cells"] == driving.dataset.pressure.size
    assert stats["seconds"] > 0
    text = driving.summary()
    assert "3.000 kN" in text
    assert "Q_x = 0.5 kN" in text
    assert f"{driving.area * 1e6:.0f} mm²" in text
    assert "3 kN" in repr(driving)


def test_area_and_slip_fraction(driving):
    state = driving.dataset.state.to_numpy()
    assert driving.area == pytest.approx((state > 0).sum() * SPACING**2)
    assert driving.slip_fraction == pytest.approx((state == 2).sum() / (state > 0).sum())


def test_the_grid_holds_the_patch_with_a_margin(driving):
    pressure = driving.dataset.pressure.to_numpy()
    for edge in (pressure[:4], pressure[-4:], pressure[:, :4], pressure[:, -4:]):
        assert not edge.any()


def test_approach_instead_of_load(driving):
    approach = float(driving.dataset.approach)
    again = solve(normal_load=None, approach=approach, tractive_force=500.0, lateral_force=-200.0, spin=0.1)
    assert float(again.dataset.normal_load) == pytest.approx(3e3, rel=1e-4)
    holds(again)


def test_creepages_instead_of_forces(driving):
    data = driving.dataset
    again = solve(creepage_x=float(data.creepage_x), creepage_y=float(data.creepage_y), spin=0.1)
    assert float(again.dataset.tractive_force) == pytest.approx(500.0, rel=1e-4)
    assert float(again.dataset.lateral_force) == pytest.approx(-200.0, rel=1e-4)
    assert float(again.dataset.creepage_x) == float(data.creepage_x)
    holds(again)


def test_free_rolling_of_like_bodies_needs_no_shear():
    contact = solve(Tire.from_profile(SMALL, material=RUBBER), Pavement.half_space(RUBBER))
    assert contact.stats["coupling_rounds"] == 1
    assert not contact.dataset.traction_x.any()
    assert not contact.dataset.traction_y.any()
    assert float(contact.dataset.creepage_x) == 0.0


def test_a_pressure_that_stays_the_same_is_settled():
    """The second round changed nothing at all; that once counted as not settled."""
    tire = Tire.from_profile("315/80R22.5", material=RUBBER)
    contact = solve_contact(tire, ROAD, Rolling(normal_load=32.5e3, friction=0.7))
    assert contact.stats["coupling_rounds"] <= 3


def test_without_friction_only_pressure():
    contact = solve(friction=0.0)
    assert contact.dataset.pressure.max() > 0
    assert not contact.dataset.traction_x.any()
    assert float(contact.dataset.tractive_force) == 0.0


def test_a_height_map_keeps_its_cells():
    contact = solve(Tire.from_height_map(bowl(), 3e-3, material=RUBBER), spacing=None, normal_load=300.0)
    assert contact.dataset.sizes == {"y": 40, "x": 40}
    holds(contact)
    assert "height map, 40 x 40 cells of 3 x 3 mm, gap up to 8.55 mm, no holes" in contact.summary()
    same = solve(Tire.from_height_map(bowl(), 3e-3, material=RUBBER), spacing=3e-3, normal_load=300.0)
    np.testing.assert_array_equal(same.dataset.pressure, contact.dataset.pressure)


def test_cells_without_material_carry_nothing():
    gap = bowl()
    gap[18:22, :] = np.nan
    contact = solve(Tire.from_height_map(gap, 3e-3, material=RUBBER), spacing=None, normal_load=300.0)
    assert not contact.dataset.pressure.to_numpy()[18:22].any()
    assert np.isnan(contact.dataset.gap.to_numpy()[18:22]).all()
    holds(contact)


def test_only_the_top_layer_counts():
    layered = Pavement([Layer(Elastic(5.4e9, 0.35), 0.1), Layer(Elastic(1e8, 0.4))])
    one, other = solve(), solve(road=layered)
    np.testing.assert_array_equal(one.dataset.pressure, other.dataset.pressure)


def test_progress_is_told():
    told = []
    solve_contact(TIRE, ROAD, Rolling(normal_load=3e3, friction=0.6), spacing=8e-3, progress=told.append)
    assert any("locating" in text for text in told)
    assert any("rolling" in text for text in told)


@pytest.mark.parametrize("load", [0.0, -1.0, math.nan, math.inf, -math.inf])
def test_a_load_must_be_positive(load):
    with pytest.raises(InputError, match="normal_load"):
        Rolling(normal_load=load, friction=0.5)


@pytest.mark.parametrize("approach", [0.0, -1e-3, math.nan])
def test_an_approach_must_be_positive(approach):
    with pytest.raises(InputError, match="approach"):
        Rolling(approach=approach, friction=0.5)


@pytest.mark.parametrize("given", [{}, {"normal_load": 1e3, "approach": 1e-3}])
def test_either_load_or_approach(given):
    with pytest.raises(InputError, match="either normal_load"):
        Rolling(friction=0.5, **given)


@pytest.mark.parametrize("friction", [-0.1, math.nan, math.inf])
def test_friction_must_not_be_negative(friction):
    with pytest.raises(InputError, match="friction"):
        Rolling(normal_load=1e3, friction=friction)


@pytest.mark.parametrize("name", ["tractive_force", "lateral_force", "creepage_x", "creepage_y", "spin", "speed"])
def test_everything_must_be_a_number(name):
    with pytest.raises(InputError, match=name):
        Rolling(normal_load=1e3, friction=0.5, **{name: math.nan})


@pytest.mark.parametrize(("force", "creepage"), [("tractive_force", "creepage_x"), ("lateral_force", "creepage_y")])
def test_either_force_or_creepage(force, creepage):
    with pytest.raises(InputError, match=f"either {force} or {creepage}"):
        Rolling(normal_load=1e3, friction=0.5, **{force: 1.0, creepage: 0.0})


def test_speed_must_be_positive():
    with pytest.raises(InputError, match="speed"):
        Rolling(normal_load=1e3, friction=0.5, speed=0.0)


@pytest.mark.parametrize(
    "forces",
    [{"tractive_force": 1801.0}, {"lateral_force": -1801.0}, {"tractive_force": 1300.0, "lateral_force": 1300.0}],
)
def test_forces_beyond_friction_name_the_largest_possible(forces):
    with pytest.raises(InputError, match="1800 N") as caught:
        solve(**forces)
    assert "gross sliding" in str(caught.value)


def test_force_without_friction_is_refused():
    with pytest.raises(InputError, match="gross sliding"):
        solve(friction=0.0, tractive_force=1.0)


def test_forces_beyond_friction_under_an_approach():
    with pytest.raises(InputError, match="gross sliding"):
        solve(normal_load=None, approach=2e-3, tractive_force=1e6)


def test_the_lowest_cell_counts_as_the_plane():
    gap = bowl() + 0.25
    gap[18:22, 18:22] = np.nan
    contact = solve(Tire.from_height_map(gap, 3e-3, material=RUBBER), spacing=None, normal_load=None, approach=1e-5)
    data = contact.dataset
    assert float(data.initial_gap.min()) == 0.0
    touching = data.state.to_numpy() > 0
    # The eight cells nearest to the hole, and no cell that the approach does not reach.
    assert touching.sum() == 8
    assert (data.initial_gap.to_numpy()[touching] < 1e-5).all()


@pytest.mark.parametrize("spacing", [0.0, -1e-3, math.nan, math.inf])
def test_spacing_must_be_positive(spacing):
    with pytest.raises(InputError, match="spacing"):
        solve(spacing=spacing)


def test_spacing_too_coarse_says_what_would_do():
    with pytest.raises(InputError, match="fewer than 8 cells across") as caught:
        solve(spacing=0.03)
    assert "or less" in str(caught.value)


def test_spacing_too_fine_says_what_would_do():
    with pytest.raises(InputError, match="or more"):
        solve(spacing=2e-5)


def test_a_height_map_refuses_another_spacing():
    with pytest.raises(InputError, match="keeps them"):
        solve(Tire.from_height_map(bowl(), 3e-3, material=RUBBER), spacing=2e-3)


@pytest.mark.parametrize(
    ("side", "shift"), [("leading", (0, 15)), ("trailing", (0, -15)), ("right", (15, 0)), ("left", (-15, 0))]
)
def test_a_contact_cut_off_by_the_border_names_the_side(side, shift):
    gap = np.roll(bowl(60), shift, axis=(0, 1))[10:50, 10:50]
    with pytest.raises(GeometryError, match="reaches the border") as caught:
        solve(Tire.from_height_map(gap, 3e-3, material=RUBBER), spacing=None, normal_load=300.0)
    assert side in str(caught.value)


HARD = Elastic(3e6, 0.2)


def test_a_contact_that_shear_carries_to_the_border_is_refused():
    """The frictionless patch fits; the shear of dissimilar bodies widens it. 54 loads in a row came back cut off."""
    gap = bowl()
    free = solve(Tire.from_height_map(gap, 3e-3, material=HARD), spacing=None, normal_load=1900.0, friction=0.0)
    assert not free.dataset.pressure[[0, -1]].any()
    with pytest.raises(GeometryError, match="reaches the border"):
        solve(
            Tire.from_height_map(gap, 3e-3, material=HARD),
            spacing=None,
            normal_load=1900.0,
            friction=0.9,
            creepage_x=0.5,
        )


def test_a_history_that_shear_carries_to_the_border_is_refused():
    tire = Tire.from_height_map(bowl(), 3e-3, material=HARD)
    state = Rolling(normal_load=1900.0, friction=0.9, creepage_x=0.5)
    with pytest.raises(GeometryError, match="reaches the border"):
        solve_transient(tire, ROAD, state, distances=[0.05, 0.1])


@pytest.mark.parametrize(("length", "width"), [(0.06, 0.06), (0.06, 0.16)])
def test_a_grid_that_proves_too_small_grows(monkeypatch, length, width):
    state = {"friction": 0.9, "creepage_x": 0.5}
    tire = Tire.from_profile(SMALL, material=HARD)
    whole = solve(tire, **state)
    small = Grid.on_lattice(length, width, SPACING)
    monkeypatch.setattr(solving, "place", lambda *_: (small, tire.height_map(small)))
    told = []
    grown = solve_contact(tire, ROAD, Rolling(normal_load=3e3, **state), spacing=SPACING, progress=told.append)
    assert sum("normal contact on" in text for text in told) > 1
    # The tolerance of both solves, 1e-6 of the largest pressure or so.
    both = whole.dataset.pressure.reindex_like(grown.dataset.pressure, fill_value=0.0)
    np.testing.assert_allclose(grown.dataset.pressure, both, atol=1e-5 * float(whole.dataset.pressure.max()))
    holds(grown)


def test_a_start_on_a_grid_too_small_for_the_load_is_left(driving):
    light = solve(normal_load=100.0)
    heavy = Rolling(normal_load=3e3, friction=0.6, tractive_force=500.0, lateral_force=-200.0, spin=0.1)
    grown = solve_contact(TIRE, ROAD, heavy, start=light)
    assert grown.dataset.sizes["x"] > light.dataset.sizes["x"]
    np.testing.assert_allclose(grown.area, driving.area, rtol=1e-9)


def test_contacts_of_a_loop_concatenate():
    """One lattice, whatever the load: 101 and 112 columns made 213."""
    first, second = solve(normal_load=1e3).dataset, solve(normal_load=3e3).dataset
    assert first.sizes != second.sizes
    both = xr.concat([first, second], "case", join="outer")
    assert both.sizes["x"] == max(first.sizes["x"], second.sizes["x"])
    assert both.sizes["y"] == max(first.sizes["y"], second.sizes["y"])
    assert 0.0 in first.x.values
    assert 0.0 in first.y.values


def test_a_symmetric_tread_has_a_symmetric_grid_and_pressure():
    data = solve().dataset
    for name in ("x", "y"):
        np.testing.assert_array_equal(data[name], -data[name][::-1])
    np.testing.assert_array_equal(data.initial_gap, data.initial_gap[::-1])
    pressure = data.pressure.to_numpy()
    # To the tolerance of the solve; cells in contact are the same.
    np.testing.assert_allclose(pressure, pressure[::-1], atol=1e-5 * pressure.max())
    assert ((pressure > 0) == (pressure[::-1] > 0)).all()


def test_a_load_too_large_for_the_surface_reaches_every_border():
    with pytest.raises(GeometryError, match=r"leading.*trailing.*right.*left"):
        solve(Tire.from_height_map(bowl(), 3e-3, material=RUBBER), spacing=None, normal_load=1e6)


def test_a_tire_without_material_or_pressure():
    with pytest.raises(InputError, match="material"):
        solve(Tire.from_profile(SMALL))


def test_a_coupling_that_does_not_settle_says_how_far_it_came(monkeypatch):
    monkeypatch.setattr(coupling, "_MOST_ROUNDS", 2)
    with pytest.raises(ConvergenceError, match="did not settle in 2 rounds") as caught:
        solve(Tire.from_profile(SMALL, material=Elastic(3e6, 0.3)), tractive_force=1000.0)
    assert caught.value.residual > 1e-6
    assert "Dundurs" in str(caught.value)


@pytest.mark.parametrize("given", [{"creepage_x": -1.5}, {"creepage_y": 2.0}])
def test_creepages_beyond_a_locked_wheel(given):
    with pytest.raises(InputError, match=r"must lie in \[-1, 1\]"):
        Rolling(normal_load=1e3, friction=0.5, **given)


@pytest.mark.parametrize("tolerance", [1e-14, 0.0, 0.5, float("nan")])
def test_tolerances_below_round_off_or_beyond_use(tolerance):
    with pytest.raises(InputError, match="tolerance must lie in"):
        solve_contact(TIRE, ROAD, Rolling(normal_load=3e3, friction=0.6), spacing=SPACING, tolerance=tolerance)


def test_power_beyond_the_largest_number_is_said():
    contact = solve(creepage_x=0.1, speed=1e308)
    assert np.isinf(float(contact.dataset.friction_power_total))
    assert any("friction_power, friction_power_total are infinite" in text for text in contact.warnings)
    assert "warning: friction_power" in contact.summary()


def test_results_that_are_numbers_need_no_warning(driving):
    assert driving.warnings == ()
    standing = turn_on_the_spot(TIRE, ROAD, Rolling(normal_load=3e3, friction=0.6), angles=[0.01], spacing=8e-3)
    # Nothing rolls: its creepages are NaN by design.
    assert np.isnan(float(standing.contact.dataset.creepage_x))
    assert standing.contact.warnings == ()


def test_camber_without_spin_says_the_spin_that_belongs_to_it():
    camber = math.radians(4.0)
    tire = Tire.from_scan(example_mesh(), camber=camber, material=RUBBER)
    assert (tire.camber, Tire.from_profile(SMALL).camber_spin) == (camber, 0.0)
    spin = tire.camber_spin
    # The mesh's crown is 0.5 m from its axle or so; the sign is minus for a top that leans to the right.
    assert spin == pytest.approx(-math.sin(camber) / tire.quality.crown_radius, rel=1e-12)
    state = {"spacing": 12e-3, "normal_load": 20e3, "creepage_y": 0.0}
    upright_on_top = solve(tire, **state)
    said = [text for text in upright_on_top.warnings if "camber" in text]
    assert len(said) == 1
    assert f"{spin:.3g} rad/m" in said[0]
    assert "4°" in said[0]
    rolling = solve(tire, **state, spin=spin)
    assert not any("camber" in text for text in rolling.warnings)
    # Camber thrust pushes the tire to the side it leans to.
    assert float(rolling.dataset.lateral_force) > float(upright_on_top.dataset.lateral_force) + 100.0
    history = solve_transient(tire, ROAD, Rolling(normal_load=20e3, friction=0.6), distances=[0.01], spacing=12e-3)
    assert any("camber" in text for text in history.contact.warnings)


def test_a_height_map_in_millimetres_taken_for_metres_is_said():
    contact = solve(
        Tire.from_height_map(1e3 * bowl(), 3e-3, material=RUBBER), spacing=None, normal_load=None, approach=1e-3
    )
    assert any('give units={"gap": "mm"}' in text for text in contact.warnings)


def test_a_contact_on_a_grid_offset_is_located_once_and_is_the_same_in_every_digit(monkeypatch):
    wheel = Rolling(normal_load=20e3, tractive_force=6e3, friction=0.7)
    forget_operators()
    alone = solve_contact(replace(TIRE, name="alone"), ROAD, wheel, spacing=SPACING, offset=(0.5, 0.5))
    located = []
    before = contact_grid.check_numbers
    monkeypatch.setattr(contact_grid, "check_numbers", lambda *at: located.append(at) or before(*at))
    forget_operators()
    tire = replace(TIRE, name="both")
    solve_contact(tire, ROAD, wheel, spacing=SPACING)
    shifted = solve_contact(tire, ROAD, wheel, spacing=SPACING, offset=(0.5, 0.5))
    assert len(located) == 1
    for name in alone.dataset:
        assert np.array_equal(shifted.dataset[name], alone.dataset[name], equal_nan=True), name
    # Another load lies on another place.
    solve_contact(tire, ROAD, replace(wheel, normal_load=25e3), spacing=SPACING)
    assert len(located) == 2
