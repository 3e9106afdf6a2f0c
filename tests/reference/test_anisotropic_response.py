"""Stress below a road of any anisotropy, through solve_response, against closed forms of fewer constants."""

import numpy as np
import pytest
from tests.grain import STRAIGHT, TILTED

import treadload as tl

RNG = np.random.default_rng(7)
GRID = tl.response.Grid(12, 10, 0.01, 0.012, -0.055, -0.054)
LOAD = tl.response.GridLoad(GRID, 1e6 * RNG.random((10, 12)), *(1e5 * RNG.normal(size=(2, 10, 12))))
DEPTHS = [0.0, 1e-4, 0.004, 0.02, 0.4]
UPRIGHT = tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, 0.25)
_ACROSS = 0.25 * 5.4 / 3.8
# The same constants by other words, and another way to the stress: the integral over directions.
SAME = tl.materials.Orthotropic((5.4e9, 5.4e9, 3.8e9), (2e9, 1.6e9, 1.6e9), (0.35, _ACROSS, _ACROSS))


def solved(load, material, **places):
    return tl.solve_response(load, tl.Pavement.half_space(material), depths=DEPTHS, **places)


@pytest.mark.parametrize("places", [{}, {"x": np.linspace(-0.2, 0.2, 7), "y": [0.003]}, {"points": [(0.01, 0.02)]}])
def test_the_integral_over_directions_is_the_closed_form_of_an_upright_axis(places):
    closed, found = (solved(LOAD, one, **places).dataset for one in (UPRIGHT, SAME))
    for name in (*(f"stress_{k}" for k in ("xx", "yy", "zz", "xy", "xz", "yz")), "strain_xx", "strain_xz",
                 "displacement_x", "displacement_y", "displacement_z"):  # fmt: skip
        one, other = closed[name].values, found[name].values
        # The bound; measured 2e-12, on the surface and at a hundredth of a cell, too.
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-9 * np.abs(one).max())


def test_a_disc_is_laid_on_cells_and_a_bilinear_load_refused():
    disc = tl.UniformDisc(0.15, 8e5)
    places = {"x": [0, 0.05, 0.2], "y": [0.0]}
    closed, found = (solved(disc, one, **places).dataset for one in (UPRIGHT, SAME))
    for name in ("stress_xx", "stress_zz", "stress_xz", "strain_xx", "displacement_z"):
        # 64 cells across: 4e-4 of the pressure.
        scale = 8e5 if name.startswith("stress") else float(np.abs(closed[name]).max())
        np.testing.assert_allclose(found[name], closed[name], rtol=0, atol=4e-4 * scale)
    smooth = tl.response.GridLoad(GRID, LOAD.pressure, LOAD.traction_x, LOAD.traction_y, interpolation="bilinear")
    with pytest.raises(tl.InputError, match=r'"bilinear" has no closed form on a road of general anisotropy; take'):
        solved(smooth, TILTED, x=[0.0], y=[0.0])


def test_a_scene_turned_round_gives_the_turned_tensor():
    """By a right angle: x becomes y, y becomes -x."""
    turned_load = tl.response.GridLoad(
        tl.response.Grid(10, 12, 0.012, 0.01, -0.054, -0.055),
        *(np.rot90(part, -1) for part in (LOAD.pressure, -LOAD.traction_y, LOAD.traction_x)),
    )
    x, y = np.linspace(-0.07, 0.09, 5), np.linspace(-0.05, 0.06, 4)
    here = solved(LOAD, TILTED, x=x, y=y).dataset
    there = solved(turned_load, TILTED.rotated(yaw=np.pi / 2), x=-y[::-1], y=x).dataset
    scale = float(np.abs(here.stress_zz).max())
    for one, other, sign in (("xx", "yy", 1), ("yy", "xx", 1), ("zz", "zz", 1), ("xy", "xy", -1), ("xz", "yz", 1),
                             ("yz", "xz", -1)):  # fmt: skip
        turned = np.rot90(here[f"stress_{one}"].values, -1, axes=(1, 2))
        np.testing.assert_allclose(there[f"stress_{other}"], sign * turned, rtol=0, atol=1e-9 * scale)
    np.testing.assert_allclose(
        there.displacement_y, np.rot90(here.displacement_x.values, -1, axes=(1, 2)), rtol=0,
        atol=1e-9 * float(np.abs(here.displacement_z).max()),
    )  # fmt: skip


def test_the_surface_moves_in_the_contact_as_in_the_response():
    x = 2e-3 * (np.arange(20) - 9.5)
    tire = tl.Tire.from_height_map((x[None] ** 2 + x[:, None] ** 2) / 0.4, 2e-3, material=tl.Elastic(2e9, 0.4))
    road = tl.Pavement.half_space(TILTED)
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=800.0, friction=0.5, tractive_force=150.0))
    below = tl.solve_response(contact, road, depths=[0.0]).dataset.isel(depth=0)
    for name in ("displacement_x", "displacement_y", "displacement_z"):
        scale = float(np.abs(contact.dataset[name]).max())
        np.testing.assert_allclose(below[name], contact.dataset[name], rtol=0, atol=1e-9 * scale)
    np.testing.assert_allclose(below.stress_zz, -contact.dataset.pressure, rtol=0, atol=1e-3)
    assert below.attrs["modulus"] == pytest.approx(TILTED.upright[0])


def test_layers_and_steep_contrasts_are_refused_in_a_sentence():
    layers = tl.Pavement([tl.Layer(TILTED, 0.1, "mat"), tl.Layer(tl.Elastic(1e8, 0.35))])
    with pytest.raises(tl.InputError, match=r"layer 'mat' is orthotropic, .* same in all horizontal directions"):
        tl.solve_response(LOAD, layers, depths=[0.02])
    creeping = tl.materials.Prony.standard_linear_solid(4e9, 3e9, 5e-3, 0.35)
    mixed = tl.Pavement([tl.Layer(creeping, 0.1), tl.Layer(STRAIGHT, name="mat")])
    with pytest.raises(tl.InputError, match=r"layer 'mat' is orthotropic, .* beside viscoelastic layers"):
        tl.solve_response(LOAD, mixed, depths=[0.02], speed=10.0)
    steep = tl.materials.Orthotropic((1e12, 1e9, 1e9), [0.4e9] * 3, (0.3, 0.3, 0.3)).rotated(0.5, 0.4)
    with pytest.raises(tl.InputError, match=r"differs with direction more than the stress below can be computed for"):
        solved(LOAD, steep, x=[0.0], y=[0.0])


CASE = """
title = "A road with a grain"
spacing = "8 mm"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
[[pavement.layers]]
name = "reinforced asphalt"
[pavement.layers.material]
kind = "orthotropic"
moduli = ["5 GPa", "4 GPa", "3 GPa"]
shear_moduli = ["1.9 GPa", "1.6 GPa", "1.5 GPa"]
poisson = [0.35, 0.3, 0.25]
yaw = "30 deg"
pitch = "10 deg"
[rolling]
normal_load = "20 kN"
friction = 0.6
[response]
depths = ["0 mm", "20 mm"]
[damage]
fatigue = { epsilon_6 = "120 microstrain", slope = -0.2 }
"""


@pytest.mark.slow
def test_a_case_runs_from_its_table_to_a_file_and_back(tmp_path):
    result = tl.run(tl.Case.from_text(CASE))
    material = result.contact.road.layers[0].material
    own = tl.materials.Orthotropic((5e9, 4e9, 3e9), (1.9e9, 1.6e9, 1.5e9), (0.35, 0.3, 0.25))
    turned = own.rotated(yaw=np.radians(30), pitch=np.radians(10))
    np.testing.assert_allclose(material.stiffness, turned.stiffness, rtol=0, atol=1e-14 * turned.stiffness.max())
    tl.save_results(result, tmp_path / "grain.nc")
    again = tl.open_results(tmp_path / "grain.nc")
    assert again.contact.road == result.contact.road
    assert "orthotropic, E_1 = 5000 MPa" in again.response.summary()
    assert "turned by yaw 30°, pitch 10°" in again.contact.road.layers[0].material.__str__()
    page = tmp_path / "grain.html"
    tl.report(again, page)
    assert "orthotropic, E_1 = 5000 MPa" in page.read_text(encoding="utf-8")
    refused = CASE.replace("poisson = [0.35, 0.3, 0.25]", "poisson = [0.35, 1.4, 0.25]")
    with pytest.raises(tl.InputError, match=r"layers\.0\.material: this elasticity is not positive definite"):
        tl.Case.from_text(refused)
