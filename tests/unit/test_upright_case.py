"""A case whose layers have a grain: read, solved, written, opened, reported; and what else reads layers' moduli."""

import numpy as np
import pytest

import treadload as tl
from cases import COARSE_CASE, ONE_AXLE
from treadload.pavement.asphalt import is_bituminous
from treadload.results.roads import road_in_rows
from upright import MATERIALS

LAYERS = """
[[pavement.layers]]
name = "asphalt"
thickness = "120 mm"
material = { kind = "transversely-isotropic", horizontal = "5400 MPa", vertical = "3.8 GPa", shear = "1600 MPa", poisson_horizontal = 0.35, poisson_vertical = 0.25 }
bond = { stiffness = "5e4 MPa/m" }

[[pavement.layers]]
name = "stone"
material = { kind = "transversely-isotropic", horizontal = "150 MPa", vertical = "300 MPa", shear = "120 MPa", poisson_horizontal = 0.35, poisson_vertical = 0.3 }

"""  # noqa: E501
START = COARSE_CASE.index("[[pavement.layers]]")
GRAINED = COARSE_CASE[:START] + LAYERS + COARSE_CASE[COARSE_CASE.index("[rolling]") :]
MIX, STONE = list(MATERIALS.values())[:2]


@pytest.mark.slow
def test_a_case_is_read_and_a_response_written_and_opened(tmp_path):
    case = tl.Case.from_text(GRAINED)
    road = case.pavement.build()
    assert [layer.material for layer in road.layers] == [MIX, STONE]
    assert tl.Case.from_text(case.to_toml()).pavement.build() == road
    solved = tl.solve_response(tl.UniformDisc(0.1, 7e5), road, depths=[0.0, 0.12], x=[0.0, 0.1], y=[0.0, 0.1])
    tl.save_results(solved, tmp_path / "r.nc")
    opened = tl.open_results(tmp_path / "r.nc").response
    assert opened.road == road
    assert opened.dataset.identical(solved.dataset)
    assert "E_v = 3800 MPa" in solved.summary()
    assert "E_v = 300 MPa" in road_in_rows(road)


@pytest.mark.slow
def test_a_case_is_solved_written_opened_and_reported(tmp_path):
    case = tl.Case.from_text(GRAINED)
    road = case.pavement.build()
    result = tl.run(case)
    data = result.response.dataset
    # Hooke's law of the grained top, from what the result holds.
    names = ("xx", "yy", "zz", "yz", "xz", "xy")
    strain = np.stack([data[f"strain_{name}"].to_numpy() * (1 if name[0] == name[1] else 2) for name in names])
    stress = np.stack([data[f"stress_{name}"].to_numpy() for name in names])
    hooke = np.tensordot(MIX.stiffness, strain, axes=1)
    assert np.abs(hooke - stress).max() < 1e-9 * np.abs(stress).max()
    tl.save_results(result, tmp_path / "r.nc")
    opened = tl.open_results(tmp_path / "r.nc")
    assert opened.response.road == road
    again = tl.solve_response(opened.response.loads, opened.response.road, depths=[0.02], x=[0.0], y=[0.0])
    here = data.sel(depth=0.02).sel(x=0.0, y=0.0, method="nearest")
    assert float(again.dataset["strain_xx"].squeeze()) == pytest.approx(float(here["strain_xx"]), rel=1e-6)
    tl.report(opened, tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text()
    assert "E_h = 5400 MPa, E_v = 3800 MPa, G_hv = 1600 MPa, ν_hh = 0.35, ν_vh = 0.25" in page
    assert "E_h = 150 MPa, E_v = 300 MPa" in page
    assert "Lekhnitskii" in page
    assert "Turner, J. R. (1980)" in page


def test_a_case_refuses_what_no_material_has_in_one_sentence():
    with pytest.raises(tl.InputError, match=r"not positive definite: the smallest eigenvalue .* 1/Pa"):
        tl.Case.from_text(GRAINED.replace("poisson_vertical = 0.25", "poisson_vertical = 0.6"))
    with pytest.raises(tl.InputError, match="vertical"):
        tl.Case.from_text(GRAINED.replace('vertical = "3.8 GPa", ', ""))


def test_laws_that_need_one_modulus_say_that_there_is_none():
    text = ONE_AXLE.replace('pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }\n', "") + LAYERS
    law = '\n[[criteria]]\nname = "a"\nlaw = "asphalt-institute"\nlayer = "asphalt"\nplace = "bottom"\n'
    with pytest.raises(tl.InputError, match="modulus is missing, and the layer does not provide it"):
        tl.Case.from_text(text + law + "air_voids = 0.05\nbinder_volume = 0.11\n")


def test_thin_unbound_layers_are_not_asphalt_and_stiff_ones_may_be():
    assert is_bituminous(STONE) is False
    assert is_bituminous(MIX) is None


def test_numbers_that_no_layer_has_are_doubted():
    # Megapascals without their unit.
    soft = tl.materials.TransverselyIsotropic(150.0, 300.0, 120.0, 0.35, 0.3)
    disc = tl.UniformDisc(0.1, 7e5)
    found = tl.solve_response(disc, tl.Pavement.half_space(soft), depths=[0.1], x=[0.0], y=[0.0])
    assert any("the modulus of layer 1 is 300 Pa" in text for text in found.warnings)


def test_means_over_a_cube_and_interfaces_read_the_grain():
    road = tl.Pavement([tl.Layer(MIX, 0.12, bond=tl.pavement.Bond(1e9)), tl.Layer(STONE)])
    grid = tl.response.Grid.centred(0.2, 0.2, 0.02)
    load = tl.response.GridLoad(grid, np.full(grid.shape, 7e5), np.full(grid.shape, 1e5), np.zeros(grid.shape))
    asked = {"depths": [0.0, 0.119], "x": [0.0, 0.05], "y": [0.01]}
    mean = tl.solve_response(load, road, mean_over=0.01, **asked).dataset
    point = tl.solve_response(load, road, **asked).dataset
    # Deep below a wide load the mean over 10 mm is the point itself but for curvature.
    for name in ("strain_xx", "strain_zz"):
        found, other = (one[name].sel(depth=0.119).to_numpy() for one in (mean, point))
        np.testing.assert_allclose(found, other, rtol=0.05)
    slid = tl.life.solve_interfaces(load, road, x=np.linspace(-0.2, 0.2, 9), y=[0.01])
    data = slid.dataset if hasattr(slid, "dataset") else slid
    assert float(np.abs(data["interface_shear"]).max()) > 1e3
