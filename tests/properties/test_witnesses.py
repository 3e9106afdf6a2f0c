"""What a second path gives: signs and sizes that the code that computes them cannot vouch for."""

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.damage import Criterion, FatigueLine, InterfaceStrength, ShearFatigue
from treadload.damage.climate import Climate
from treadload.damage.fields import tension_behind
from treadload.damage.quantity import STRESS
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.damage.uniform import RECTANGLE, compare_uniform
from treadload.life import wheels
from treadload.life.peaks import peaks_and_valleys
from treadload.life.solve import solve_life
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.tire import Tire

SPACING, MU = 0.012, 0.6
RUBBER = Elastic(1e6, 0.4)
ROAD = Pavement.half_space(Elastic(5e6, 0.3))


def paraboloid(spacing=SPACING, material=RUBBER):
    x, y = (spacing * (np.arange(n) - (n - 1) / 2) for n in (round(0.288 / spacing), round(0.312 / spacing)))
    return Tire.from_height_map(x[None, :] ** 2 / 0.7 + y[:, None] ** 2 / 0.9, spacing, material=material)


def wheel(**given):
    return tl.Rolling(normal_load=3e3, friction=MU, **given)


def steady():
    return tl.solve_contact(paraboloid(), ROAD, wheel(tractive_force=500.0, lateral_force=900.0))


def history():
    rolling = wheel(creepage_x=-0.03, creepage_y=0.04)
    return tl.contact.solve_transient(paraboloid(), ROAD, rolling, distances=SPACING * np.arange(1, 7)).contact


@pytest.mark.parametrize("make", [steady, history])
def test_the_road_moves_as_the_response_to_the_contact_says(make):
    """Contact takes the displacement from its influence coefficients, the response from fields in the road."""
    contact = make()
    below = tl.solve_response(contact, ROAD, depths=[0.0]).dataset.isel(depth=0)
    size = float(abs(below.displacement_z).max())
    assert float(abs(below.displacement_y).max()) > 0.05 * size
    for name in ("displacement_x", "displacement_y", "displacement_z"):
        # Both are exact for pressure and shear that are uniform on each cell.
        np.testing.assert_allclose(
            contact.dataset[name], below[name].transpose("y", "x"), atol=1e-9 * size, err_msg=name
        )


@pytest.mark.parametrize("make", [steady, history])
def test_where_it_slips_friction_bears_the_shear(make):
    data = make().dataset
    slips = (data.state == 2).to_numpy()
    assert slips.sum() > 20
    shear = np.hypot(data.traction_x, data.traction_y).to_numpy()
    born = (data.friction_coefficient * data.pressure).to_numpy()
    # The solver's tolerance on the shear is 1e-6 of the largest.
    np.testing.assert_allclose(shear[slips], born[slips], atol=1e-5 * shear.max())
    assert (shear <= born + 1e-5 * shear.max()).all()
    assert float(data.friction_coefficient.max()) == pytest.approx(MU, rel=1e-12)


def test_spin_of_an_elastic_wheel_loses_only_what_friction_takes():
    """Energy: the moment about the vertical axis brings in what slip takes out."""
    losses = []
    for spacing in (SPACING, SPACING / 2):
        tire, road = paraboloid(spacing, Elastic(1e6, 0.5)), Pavement.half_space(Elastic(5.4e9, 0.5))
        contact = tl.solve_contact(tire, road, wheel(spin=1.0))
        losses.append(tl.contact.rolling_resistance(contact, 0.35).material_loss)
    taken = float(contact.dataset.friction_work_total)
    assert taken > 40
    # Upwind differences of slip are of first order in the cell, so two cells tell the limit.
    assert abs(2 * losses[1] - losses[0]) < 0.03 * taken
    assert abs(losses[1]) < 0.2 * taken


def test_only_the_size_of_the_net_shear_counts_on_the_rectangle():
    """A square on a half-space cannot tell ahead from aside: its readings turn with its shear."""
    tire = paraboloid()
    road = Pavement.half_space(Elastic(5e9, 0.35))
    readings = []
    for force in ({"tractive_force": 800.0}, {"lateral_force": 800.0}):
        contact = tl.solve_contact(tire, road, wheel(**force))
        compared = compare_uniform(contact, road, depths=[0.0, 0.03], pressure=3e5, mean_over=None)
        readings.append(compared.dataset.sel(load=RECTANGLE))
    for name in ("largest_vertical_shear", "largest_extension", "largest_in_plane_extension"):
        ahead, aside = (one[name].to_numpy() for one in readings)
        # Both read on the contact's own cells, which lie alike along and across but for half a cell at the end.
        np.testing.assert_allclose(aside, ahead, rtol=0.02, err_msg=name)
    area = float(readings[1].uniform_area)
    sheared = readings[1].largest_vertical_shear.isel(depth=0).item()
    # At the surface γ = q / G.
    assert sheared == pytest.approx(800 / area / (5e9 / 2.7), rel=1e-3)


def test_a_peak_between_two_points_is_that_of_the_parabola():
    """A parabola through three points is itself, wherever the points lie."""
    x = np.linspace(-1, 1, 21)
    tops, places = np.array([3.0, 5.0, 2.0]), np.array([0.013, -0.24, 0.449])
    read = tops[:, None] - 1.7 * (x[None] - places[:, None]) ** 2
    assert (read.max(axis=1) < tops - 1e-5).all()
    np.testing.assert_allclose(
        peaks_and_valleys(x, read, centres=np.zeros(1), turns=1, smooth=True)[0], tops, rtol=1e-12
    )
    np.testing.assert_allclose(
        peaks_and_valleys(x, read, centres=np.zeros(1), turns=1, smooth=False)[0], read.max(axis=1), rtol=1e-15
    )
    # A ramp has no top but its end; a plateau none above itself.
    flat = np.array([x + 2, np.ones_like(x)])
    np.testing.assert_allclose(
        peaks_and_valleys(x, flat, centres=np.zeros(1), turns=1, smooth=True)[0], [3.0, 1.0], rtol=1e-12
    )


def test_a_life_does_not_know_how_far_beside_the_wheels_readings_end(monkeypatch):
    """Wheels that wander bring the ends of a bowl under the worst place: where they are cut, a life is too long."""
    tire = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    # A thick slab on soft soil bends over a metre: the widest bowl that a road has.
    road = Pavement([Layer(Elastic(7e9, 0.35), 0.3), Layer(Elastic(1.2e8, 0.35))])
    traffic = Traffic((AxleClass("one", 1.0, 32.5e3, 820e3),), 1e5, wander=Wander.normal(0.25))
    base = (Criterion("base", FatigueLine(90e-6, -0.2), 0),)

    def years():
        return solve_life(
            tl.Design(tire, road, traffic, Climate.constant(15.0), base, spacing=0.012), workers=1
        ).years("base")

    own = years()
    monkeypatch.setattr(wheels, "MARGIN", 1.2)
    # What lies beyond has less than a hundredth of the largest damage, for a wander that rarely goes so far.
    assert own == pytest.approx(years(), rel=3e-3)


def surface(stress_zz, tension, x):
    """A response of the surface alone, (ny, nx), from its pressure and its tension along x."""
    fields = {name: (("depth", "y", "x"), np.zeros((1, *stress_zz.shape))) for name in STRESS}
    fields["stress_zz"] = (("depth", "y", "x"), stress_zz[None])
    fields["stress_xx"] = (("depth", "y", "x"), tension[None])
    return xr.Dataset(fields, {"depth": [0.0], "y": np.arange(len(stress_zz)) * 0.1, "x": x})


@pytest.mark.parametrize(("left", "behind"), [(1e-8, -0.1), (1e-4, -0.3)])
def test_round_off_is_no_wheel_and_a_faint_pressure_is_one(left, behind):
    """Ahead of its rear a wheel's tension does not count; pressure down to 1e-6 of the largest is of the wheel."""
    x = np.linspace(-0.4, 0.4, 9)
    pressed = np.where((x > -0.05) & (x < 0.25), 8e5, 0.0) + np.where(abs(x + 0.2) < 0.01, left * 8e5, 0.0)
    tension = 1e5 * (1 + x)
    tension[:2] = [2e4, 3e4]

    class Given:
        dataset = surface(-pressed[None], tension[None], x)

    assert tension_behind(Given)["tension_behind_x"].item() == pytest.approx(behind)


def test_a_parted_bond_reads_a_thousand_and_round_off_nothing():
    """A law of passes has no use for infinity, and a power of round-off is no damage."""
    bond = Criterion.of_bond("bond", InterfaceStrength(1e6, 0.0), ShearFatigue(-0.2))
    shear = np.array([[0.0, 0.5, 0.9e-0, 2e6, 0.25e6, 0.999e9, 1.001e9, 1e12]])
    zero = np.zeros_like(shear)
    data = xr.Dataset({name: (("y", "x"), zero) for name in ("stress_xz", "stress_zz")})
    data["stress_yz"] = (("y", "x"), shear)
    np.testing.assert_allclose(bond.read(data), [[0, 0, 0, 2, 0.25, 999, 1000, 1000]], rtol=1e-12)
    none = Criterion.of_bond("none", InterfaceStrength(0.0, 0.0), ShearFatigue(-0.2))
    np.testing.assert_array_equal(none.read(data)[0, 3:], 1000.0)
    assert none.read(data)[0, 0] == 0


def test_the_bowl_goes_through_the_middle_of_a_wheel_wherever_it_stands(tmp_path):
    """Under a symmetric footprint the deepest point of the bowl is its centre."""
    n, at = 8, (0.31, -0.17)
    c = 0.02 * (np.arange(n) - (n - 1) / 2)
    pressure = np.where(c[:, None] ** 2 + c[None] ** 2 < 0.07**2, 7e5, 0.0)
    data = xr.Dataset(
        {"pressure": (("y", "x"), pressure, {"units": "Pa"})},
        {"y": ("y", c + at[1], {"units": "m"}), "x": ("x", c + at[0], {"units": "m"})},
    )
    data.to_netcdf(tmp_path / "spot.nc", engine="h5netcdf")
    case = tl.Case.from_text(
        '[footprint]\nfile = "spot.nc"\n'
        '[[pavement.layers]]\nthickness = "10 cm"\n'
        'material = { kind = "elastic", modulus = "5 GPa", poisson = 0.35 }\n'
        '[[pavement.layers]]\nmaterial = { kind = "elastic", modulus = "100 MPa", poisson = 0.35 }\n'
        '[response]\ndepths = ["2 cm"]\n',
        folder=tmp_path,
    )
    bowl = tl.run(case).bowl
    assert bowl.dataset.attrs["load_x"] == pytest.approx(at[0], abs=1e-12)
    assert float(bowl.dataset.y[0]) == pytest.approx(at[1], abs=1e-12)
    sunk = bowl.dataset.displacement_z.isel(depth=0, y=0)
    assert float(sunk.x[np.argmax(sunk.to_numpy())]) == pytest.approx(at[0], abs=1e-12)
    # And it is as deep behind as ahead.
    near = sunk.where(abs(sunk.x - at[0]) < 0.25, drop=True).to_numpy()
    np.testing.assert_allclose(near, near[::-1], rtol=1e-9)
