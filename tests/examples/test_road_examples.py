"""Examples of real roads: a hot day, a delaminated wearing course, dual wheels. Each ends in a checked number."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import treadload as tl

FOLDER = Path(__file__).parents[2] / "examples"


def example(name, spacing='"12 mm"'):
    """The example on coarser cells, for speed."""
    text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    assert 'spacing = "6 mm"' in text
    return tl.Case.from_text(text.replace('spacing = "6 mm"', f"spacing = {spacing}"), folder=FOLDER)


@pytest.mark.parametrize("name", ["hot_day", "delaminated", "dual_wheel", "layers"])
def test_examples_are_valid_and_written_back(name):
    case = tl.Case.from_toml(FOLDER / f"{name}.toml")
    assert tl.Case.from_text(case.to_toml(), folder=FOLDER) == case


@pytest.mark.slow
def test_dual_wheels_of_tires_strain_the_base_as_the_standard_discs_do(tmp_path):
    result = tl.run(example("dual_wheel"))
    # The French method's load on the French structure: 100.0 microstrain at the base, between the wheels, where
    # every program of that method has it.
    discs = tl.response.dual_wheels(tl.UniformDisc(0.125, 0.662e6), 0.375)
    standard = tl.solve_response(discs, result.road, depths=[0.21], x=[0.0], y=[0.0]).dataset
    assert standard.principal_strain_1.item() == pytest.approx(100.0e-6, abs=0.1e-6)
    # Ribs on a belt at the same inflation pressure press harder on less area. (A half-space tire: 100 within 3 %.)
    worst = result.verdict.dataset
    assert float(worst.worst_strain) == pytest.approx(107.7e-6, rel=0.02)
    assert abs(float(worst.worst_y)) < 0.012
    # Both wheels are in the map.
    surface = result.response.dataset.sel(depth=0)
    load = -float(surface.stress_zz.sum()) * 0.012**2
    assert load == pytest.approx(2 * 32.5e3, rel=1e-3)
    tree = result.to_tree()
    tl.save_results(tree, tmp_path / "r.nc")
    back = tl.open_results(tmp_path / "r.nc").tree
    assert set(back.children) == {"contact", "response", "slice_along", "slice_across", "bowl", "damage", "asked"}
    for name, group in tree.children.items():
        xr.testing.assert_identical(back[name].to_dataset(), group.to_dataset())
    names = [layer["name"] for layer in json.loads(back.attrs["layers"])]
    assert names == ["EB-BBSG3", "EB-GB3", "PF3"]


@pytest.mark.slow
def test_a_delaminated_wearing_course_extends_at_its_underside():
    case = example("delaminated")
    result = tl.run(case)
    layers = result.road.layers
    bonded, slides = (
        tl.Pavement([replace(layers[0], bond=bond), *layers[1:]])
        for bond in (tl.pavement.BONDED, tl.pavement.FRICTIONLESS)
    )
    discs = tl.response.dual_wheels(tl.UniformDisc(0.125, 0.662e6), 0.375)
    under = {"depths": [0.06], "x": [0.0], "y": [0.1875]}
    # On the axis of one of the standard discs the underside is known to the digits printed: it extends by 101
    # microstrain where it slides, and shortens by 18.7 at least where it is bonded.
    free = tl.solve_response(discs, slides, **under).dataset.in_plane_strain_1.item()
    held = tl.solve_response(discs, bonded, **under).dataset.in_plane_strain_1.item()
    assert free == pytest.approx(101e-6, abs=0.5e-6)
    assert held == pytest.approx(-18.7e-6, abs=0.05e-6)
    # The tire of the example spreads the same load over a longer patch: less, but of the same kind. The parted face
    # rubs below it: less again, and worst beside the wheel, where it slides.
    worst = float(result.verdict.dataset.worst_strain)
    unbound = tl.solve_response(result.contact, slides, depths=[0.06]).dataset.in_plane_strain_1
    assert 0.7 * free < float(unbound.max()) < free
    assert 0.7 * float(unbound.max()) < worst < 0.95 * float(unbound.max())
    assert abs(float(result.verdict.dataset.worst_y)) > 0.08
    assert any("takes this load once, from rest" in text for text in result.warnings)
    bonded_too = tl.solve_response(result.contact, bonded, depths=[0.06]).dataset.in_plane_strain_1
    assert float(bonded_too.max()) < 0.1 * worst
    assert "Goodman" in result.to_tree().attrs["citations"]
    # An elastic road does not lag: the bowl is symmetric about the load.
    bowl = result.bowl.dataset.displacement_z.squeeze()
    near = bowl.values[np.abs(bowl.x.values) <= 1.205]
    assert result.bowl.dataset.attrs["load_x"] == pytest.approx(0, abs=1e-6)
    np.testing.assert_allclose(near, near[::-1], rtol=1e-4)


@pytest.mark.slow
def test_on_a_hot_day_strain_lies_between_the_elastic_limits_and_lags(tmp_path):
    case = example("hot_day", '"15 mm"')
    result = tl.run(case)
    assert case.pavement.layer_temperatures() == pytest.approx([40, 33.5, None])
    data = result.response.dataset
    assert data.attrs["speed"] == pytest.approx(70 / 3.6)
    # No frequency is softer than none and none stiffer than an infinite one: the base's strain lies between.
    base = {
        limit: float(tl.solve_response(result.contact, road, depths=[0.21]).dataset.in_plane_strain_1.max())
        for limit, road in (("fast", result.road.glassy), ("slow", result.road.rubbery))
    }
    worst = float(result.verdict.dataset.worst_strain)
    assert base["fast"] < worst < base["slow"]
    # The lowest point of the bowl lies behind the load, by less than the contact is long.
    bowl = result.bowl.dataset.displacement_z.squeeze()
    lowest = float(bowl.x[int(np.argmax(bowl.values))])
    assert -0.15 < lowest < -0.005
    # Energy is lost in the viscoelastic layer and in no other.
    energy = result.slice_across.dataset.dissipated_energy
    depth = energy.depth
    assert float(energy.where((depth > 0.02) & (depth <= 0.06), drop=True).min()) > 0
    assert float(np.abs(energy.where(depth > 0.0601, drop=True)).max()) == 0
    tree = result.to_tree()
    tl.save_results(tree, tmp_path / "r.nc")
    back = tl.open_results(tmp_path / "r.nc").tree
    for name, group in tree.children.items():
        xr.testing.assert_identical(back[name].to_dataset(), group.to_dataset())
    for name in ("Kennett", "Huet", "Sayegh", "Duhamel"):
        assert name in back.attrs["citations"]
    assert json.loads(back.attrs["layers"])[0]["frequency"] == 10
