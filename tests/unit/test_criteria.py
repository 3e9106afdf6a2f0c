"""Criteria as fields of a response, what they need, and where they peak."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

import treadload as tl
from treadload import variables
from treadload.damage.fields import compute_quantities, known_quantities, peak, tension_behind
from treadload.damage.laws.energy_ratio import EnergyRatio
from treadload.errors import InputError
from treadload.response.fields import response_dataset

ROAD = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
LINE = np.linspace(-0.4, 0.4, 33)
WHEEL = tl.UniformRectangle(0.2, 0.25, 8e5, traction_x=-2e5)
RESPONSE = tl.solve_response(WHEEL, ROAD, depths=[0.0, 0.02, 0.05, 0.1], x=LINE, y=[-0.13, 0.0, 0.11])
MIX = EnergyRatio(creep_compliance=1e-10, slope=0.5, strength=2e6, fracture_energy=2500, resilient_modulus=1e10)


def without(*names):
    return SimpleNamespace(dataset=RESPONSE.dataset.drop_vars(names))


def test_all_that_the_response_has_fields_for():
    found = compute_quantities(RESPONSE)
    assert set(found.data_vars) == set(known_quantities()) - {"dissipated_energy"}
    for name, values in found.items():
        assert values.dims == ("depth", "y", "x"), name
        assert values.attrs == variables.attributes(str(name))
        assert np.isfinite(values).all()
    # The response names some of them itself.
    for name in ("mazars_strain", "octahedral_shear_stress", "mean_stress"):
        np.testing.assert_allclose(found[name], RESPONSE.dataset[name], rtol=1e-12)
    np.testing.assert_allclose(found["extension_strain"], RESPONSE.dataset["principal_strain_1"], rtol=1e-12)
    assert set(compute_quantities(without("strain_xx")).data_vars) == {
        "octahedral_shear_stress",
        "mean_stress",
        "horizontal_tension",
        "principal_tension",
        "vertical_compression",
    }


def test_dissipated_energy_is_the_passages_own():
    energy = ("depth", "y"), np.full((4, 3), 12.5), {"units": "J/m^3"}
    response = SimpleNamespace(dataset=RESPONSE.dataset.assign(dissipated_energy=energy))
    found = compute_quantities(response, ["dissipated_energy"])
    assert found["dissipated_energy"].attrs == {"units": "J/m^3"}
    assert peak(found, "dissipated_energy") == {"value": 12.5, "depth": 0.0, "y": 0.11}  # of equals the largest y


def test_the_onset_divides_mazars_strain():
    found = compute_quantities(RESPONSE, [tl.damage.MazarsOnset(50e-6)])
    np.testing.assert_allclose(found["mazars_onset_ratio"], RESPONSE.dataset["mazars_strain"] / 50e-6, rtol=1e-12)


def test_a_wheels_shear_peaks_near_its_edge_and_its_extension_where_it_drags():
    found = compute_quantities(RESPONSE)
    shear = peak(found, "vertical_shear_strain", deepest=0.05)
    assert shear["depth"] <= 0.05
    assert abs(abs(shear["y"]) - 0.125) < 0.02 or abs(abs(shear["x"]) - 0.1) < 0.03
    # Shear on a free surface is the traction: γ = q/G under the wheel, nothing beside it.
    surface = found["vertical_shear_strain"].sel(depth=0, y=0)
    assert float(surface.sel(x=0)) == pytest.approx(2e5 / ROAD.surface_material.shear_modulus, rel=1e-9)
    assert float(abs(surface.sel(x=0.4))) < 1e-15
    deep = peak(found, "vertical_shear_strain")
    assert deep["value"] >= shear["value"]


def test_tension_behind_a_dragging_wheel():
    """The wheel pushes the road back, so that the surface is pressed together behind it and pulled before it."""
    driving, braking = (
        RESPONSE,
        tl.solve_response(tl.UniformRectangle(0.2, 0.25, 8e5, traction_x=2e5), ROAD, depths=[0.0], x=LINE, y=[0.0]),
    )
    behind = tension_behind(braking)
    at = braking.dataset.sel(depth=0, y=0)
    # On the axis of symmetry the largest tension is σ_xx where it exceeds σ_yy.
    mask = at["x"] < -0.1
    expected = np.maximum(at["stress_xx"], at["stress_yy"]).where(mask)
    assert float(behind["tension_behind"][0]) == pytest.approx(float(expected.max()), rel=1e-9)
    assert float(behind["tension_behind_x"][0]) == float(at["x"][int(expected.argmax("x"))])
    assert float(behind["tension_behind"][0]) > float(tension_behind(driving)["tension_behind"][1])
    # The row beside the wheel, at y = -0.13, counts behind the same rear.
    assert (tension_behind(driving)["tension_behind_x"] < -0.1).all()


def test_tension_behind_does_not_ask_for_an_order_of_x():
    backwards = SimpleNamespace(dataset=RESPONSE.dataset.isel(x=slice(None, None, -1)))
    np.testing.assert_array_equal(
        tension_behind(backwards)["tension_behind"], tension_behind(RESPONSE)["tension_behind"]
    )


def test_energy_ratio_in_the_units_of_its_source():
    # Worked by hand from the printed form: σ = 150 psi, St = 2 MPa, D₁ = 1e-10/Pa, DCSE_f = 2.5 - 0.2 kJ/m³.
    psi = 6894.757293168361
    a = 0.0299 * 150**-3.10 * (6.36 - 2.0) + 2.46e-8
    known = a * 2.3 / (0.5**2.98 * 1e-10 * psi)
    assert MIX.limit == pytest.approx(2300, rel=1e-12)
    assert float(MIX.ratio(150 * psi)) == pytest.approx(known, rel=1e-12)
    assert float(MIX.needed(150 * psi)) == pytest.approx(2300 / known, rel=1e-12)


def test_energy_ratio_falls_with_tension():
    tension = np.array([-1e6, 0.0, 1e5, 1e6, 2e6])
    ratio = MIX.ratio(tension)
    assert np.isinf(ratio[:2]).all()
    assert (np.diff(ratio[2:]) < 0).all()
    assert MIX.verified
    assert not MIX.caveat


PSI = 6894.757293168361


@pytest.mark.parametrize(
    ("tension", "words"),
    [
        # The conventional stresses of reports pass.
        (148 * PSI, ()),
        (150 * PSI, ()),
        (230 * PSI, ()),
        (1.8e6, ("1.8 MPa is more than its sources use",)),
        # A peak of a computed contact: more than the mix bears once.
        (np.array([[0.1e6, 3.4e6, np.nan]]), ("3.4 MPa exceeds the strength of the mix, 2 MPa; it is a peak",)),
    ],
)
def test_energy_ratio_warns_of_stress_that_it_was_not_made_for(tension, words):
    said = MIX.warnings(tension)
    assert len(said) == len(words)
    for sentence, part in zip(said, words, strict=True):
        assert part in sentence
        assert "conventional stress of the layer, 1.02 to 1.59 MPa" in sentence


def test_energy_ratio_of_a_computed_surface_keeps_its_warning():
    found = compute_quantities(RESPONSE, ["horizontal_tension"])["horizontal_tension"]
    ratio = MIX.ratio(found)
    assert ratio.name == "energy_ratio"
    assert ratio.dims == found.dims
    np.testing.assert_array_equal(ratio, MIX.ratio(found.to_numpy()))
    said = json.loads(ratio.attrs["warnings"])
    assert "of a computed surface" in said[0]
    # Below the surface it is a stress of the layer.
    assert len(json.loads(MIX.ratio(found.sel(depth=[0.05, 0.1])).attrs["warnings"])) == 0


def test_energy_ratio_in_words():
    said = MIX.summary(150 * PSI)
    assert said.startswith(f"energy ratio {float(MIX.ratio(150 * PSI)):.3g} under 1.03 MPa")
    assert "warning" not in said
    assert "warning: energy ratio: 1.8 MPa is more than its sources use" in MIX.summary(1.8e6)


def free(stress_zz=0.0):
    stress = np.zeros((6, 1, 1, 5))
    stress[2] = stress_zz
    at = np.zeros(1), np.zeros(1), np.linspace(-0.1, 0.1, 5)
    return SimpleNamespace(dataset=response_dataset(stress, stress / 1e9, *at))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: compute_quantities(RESPONSE, ["stress"]), "no quantity 'stress'; did you mean 'mean_stress'"),
        (
            lambda: compute_quantities(RESPONSE, ["dissipated_energy"]),
            "needs dissipated_energy, which the response lacks; solve a moving wheel on a viscoelastic road",
        ),
        (
            lambda: compute_quantities(without("stress_xy"), ["mean_stress"]),
            "the quantity mean_stress needs stress_xy, which the response lacks",
        ),
        (lambda: tl.damage.MazarsOnset(100), r"plain strain in \(0, 0.01\), got 100"),
        (lambda: peak(compute_quantities(RESPONSE, ["mean_stress"]), "mazars"), "hold mean_stress, got 'mazars'"),
        (lambda: peak(compute_quantities(RESPONSE, ["mean_stress"]), "mean_stress", deepest=-1.0), "up to -1.0 m"),
        (lambda: tension_behind(SimpleNamespace(dataset=RESPONSE.dataset.isel(depth=[1]))), "with depth 0"),
        (lambda: tension_behind(free()), "no pressure acts on the surface"),
        (lambda: tension_behind(free(-1e6)), "reaches the first x of the response, -0.1 m"),
        (lambda: EnergyRatio(1e-10, 2.0, 2e6, 2500, 1e10), r"slope must lie in \(0, 1\), got 2.0"),
        (lambda: EnergyRatio(1e-10, 0.5, 7e6, 2500, 1e10), "below 6.36 MPa in this regression, got 7 MPa"),
        (lambda: EnergyRatio(1e-10, 0.5, 2e6, 100, 1e10), r"St²/\(2 MR\) = 200 J/m³"),
        (lambda: EnergyRatio(-1.0, 0.5, 2e6, 100, 1e10), "creep_compliance must be a positive number of 1/Pa"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(InputError, match=message):
        make()
