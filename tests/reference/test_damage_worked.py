"""Fatigue laws against worked numbers, to all their digits.

tests/data/damage/worked.json: parameters of the French method as a public program prints them, numbers worked
from the formulas outside this package. Its twelve printed digits bound every tolerance here.
"""

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import treadload as tl
from treadload.damage.criterion import Criterion
from treadload.damage.fields import compute_quantities
from treadload.damage.laws.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    bottom_up_cracking,
    top_down_cracking,
)
from treadload.damage.laws.french import FrenchBituminous, FrenchHydraulic, FrenchSubgrade
from treadload.kernels import tensors
from treadload.response.fields import response_dataset

WORKED = json.loads((Path(__file__).parents[1] / "data" / "damage" / "worked.json").read_text(encoding="utf-8"))
# Half a unit of the last of twelve digits, on numbers that may begin with a one.
PRINTED = 6e-12
PSI, INCH = 6894.757293168361, 0.0254
# A modulus in each class of platform, by its printed factor.
PLATFORM = {0.833333333333: 40e6, 0.909090909091: 60e6, 0.93896713615: 100e6, 1.0: 120e6}


def bituminous(case):
    _, epsilon_6, scatter, calibration, _ = WORKED["french_bituminous"]["rows"][case["material"]]
    return FrenchBituminous(
        epsilon_6 * 1e-6,
        -0.2,
        scatter,
        case["thickness_m"],
        case["risk"],
        calibration,
        case["E10_MPa"] / case["E_theta_MPa"],
        PLATFORM[case["ks"]],
    )


@pytest.mark.parametrize(
    "case", WORKED["worked_eps_adm"], ids=lambda c: f"{c['material']}-{c['risk']}-{c['theta_eq_C']}"
)
def test_allowable_strain_of_the_french_method(case):
    law = bituminous(case)
    assert law.temperature_factor == pytest.approx(case["k_theta"], rel=PRINTED)
    assert law.spread == pytest.approx(case["Sh_m"], rel=PRINTED)
    assert law.risk_factor == pytest.approx(case["kr"], rel=PRINTED)
    assert law.allowable_strain(case["NE"]) * 1e6 == pytest.approx(case["eps_adm_microstrain"], rel=PRINTED)


def test_the_first_worked_case_to_three_digits():
    law = bituminous(WORKED["worked_eps_adm"][0])
    assert f"{law.risk_factor:.3f}" == "0.744"
    assert f"{law.allowable_strain(5e6) * 1e6:.1f}" == "72.5"


def test_allowable_stress_of_a_treated_gravel():
    case = WORKED["worked_sigma_adm"]
    law = FrenchHydraulic(
        case["sigma6"] * 1e6, -1 / case["minus_1_over_b"], case["SN"], case["risk"], case["kc"], case["kd"]
    )
    assert law.risk_factor == pytest.approx(case["kr"], rel=PRINTED)
    assert law.allowable_strain(case["NE"]) == pytest.approx(case["sigma_adm_MPa"] * 1e6, rel=PRINTED)


# Material of the base, its thickness and that of all bituminous layers; the axles of the JSON at a risk of 5 %.
STRUCTURES = {
    "6 BBSG3 / 15 GB3 / PF3": ("EB-GB3", 0.15),
    "8 BBSG3 / 15 GB3 / PF3": ("EB-GB3", 0.15),
    "6 BBSG3 / 13 EME2 / PF3": ("EB-EME2", 0.13),
}


@pytest.mark.parametrize("name", STRUCTURES)
def test_life_of_structures(name):
    rows = [row for row in WORKED["worked_structures"]["rows"] if row["structure"] == name]
    life = next(row for row in rows if "NE_subgrade" in row)
    compression = max(row["eps_z_subgrade_microstrain"] for row in rows if "eps_z_subgrade_microstrain" in row)
    # Twelve digits of a strain, to the power 1/0.222.
    passes = FrenchSubgrade().allowable_passes(compression * 1e-6)
    assert passes == pytest.approx(life["NE_subgrade"], rel=5 * PRINTED)

    material, thickness = STRUCTURES[name]
    at_15, epsilon_6, scatter, calibration, at = WORKED["french_bituminous"]["rows"][material]
    law = FrenchBituminous(epsilon_6 * 1e-6, -0.2, scatter, thickness, 0.05, calibration, at[2] / at_15, 120e6)
    # Twelve digits of a strain, to the fifth power.
    assert law.allowable_passes(life["eps_t_max"] * 1e-6) == pytest.approx(
        life["NE_fatigue_at_risk_5pct"], rel=6 * PRINTED
    )


BITUMEN = {"6 BBSG3 / 15 GB3 / PF3": (0.06, 9e9), "8 BBSG3 / 15 GB3 / PF3": (0.08, 9e9)}


@pytest.mark.parametrize("name", BITUMEN)
def test_strains_of_structures_under_the_french_axle(name):
    """The layered response, read by the laws: twin discs of 32.5 kN, bonded layers at 15 °C."""
    surfacing, base = BITUMEN[name]
    layers = [(7e9, surfacing), (base, 0.15), (120e6, None)]
    road = tl.Pavement([tl.Layer(tl.Elastic(modulus, 0.35), thickness) for modulus, thickness in layers])
    wheels = [tl.UniformDisc(0.125, 0.662e6, y=side * 0.1875) for side in (-1, 1)]
    bottom = surfacing + 0.15
    # The rows of the JSON: x = 0 under a wheel, 0.1875 m between the two.
    at = {"depths": [bottom], "x": [0.0], "y": [-0.1875, 0.0]}
    above = tl.solve_response(wheels, road, **at)
    below = tl.solve_response(wheels, road, **at, side="below")
    law = FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3)
    extension = Criterion("base", law, layer=1).read(above.dataset.isel(depth=0)).squeeze()
    soil = Criterion("soil", FrenchSubgrade(), layer=2, place="top")
    compression = soil.read(below.dataset.isel(depth=0)).squeeze()
    rows = [row for row in WORKED["worked_structures"]["rows"] if row["structure"] == name and "x" in row]
    for number, row in enumerate(rows):
        # Both solvers claim 1e-8 and better; the load's radius and pressure are as printed.
        assert 1e6 * float(extension[number]) == pytest.approx(row["eps_t_base_microstrain"], rel=1e-6)
        assert 1e6 * float(compression[number]) == pytest.approx(row["eps_z_subgrade_microstrain"], rel=1e-6)


@pytest.mark.parametrize("case", WORKED["mepdg"]["worked_Nf"], ids=lambda c: f"{c['mode']}-{c['hac_in']}")
def test_passes_of_the_mepdg(case):
    kind = {"bottom": MepdgBottomUp, "top": MepdgTopDown}[case["mode"]]
    law = kind(case["E_psi"] * PSI, case["hac_in"] * INCH, case["Va"] / 100, case["Vb"] / 100)
    assert law.allowable_passes(case["eps"]) == pytest.approx(case["Nf"], rel=PRINTED)


@pytest.mark.parametrize("case", WORKED["mepdg"]["worked_cracking"], ids=lambda c: f"{c['damage']}-{c['hac_in']}")
def test_cracking_of_the_mepdg(case):
    below = bottom_up_cracking(case["damage"], case["hac_in"] * INCH)
    above = top_down_cracking(case["damage"])
    assert 100 * below == pytest.approx(case["FC_bottom_pct"], rel=PRINTED)
    # Feet per mile of metres per metre.
    assert 5280 * above == pytest.approx(case["FC_top_ft_per_mile"], rel=PRINTED)


def test_asphalt_institute_as_a_public_program_prints_it():
    """LEAPS, a layered elastic program on the web, prints 1.03e6 and 4.36e6 passes for its template."""
    # Three digits.
    assert f"{AsphaltInstitute(3e9).allowable_passes(237.7e-6):.2e}" == "1.03e+06"
    assert f"{AsphaltInstituteSubgrade().allowable_passes(344.2e-6):.2e}" == "4.36e+06"


@pytest.mark.parametrize("case", WORKED["tensor_criteria"], ids=range(4))
def test_criteria_of_a_tensor(case):
    full = np.array(case["stress_MPa"]) * 1e6
    stress = full[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].reshape(6, 1, 1, 1)
    strain = tensors.strain_from_stress(stress, case["E_MPa"] * 1e6, case["nu"])
    response = SimpleNamespace(dataset=response_dataset(stress, strain, np.zeros(1), np.zeros(1), np.zeros(1)))
    found = {name: float(values.squeeze()) for name, values in compute_quantities(response).items()}
    # The stress has twelve digits, and their differences lose one.
    known = {
        "extension_strain": case["principal_strain"][2],
        "mazars_strain": case["mazars_equivalent_strain"],
        "mazars_onset_ratio": case["mazars_equivalent_strain"] / 100e-6,
        "octahedral_shear_stress": case["octahedral_shear_stress"] * 1e6,
        "mean_stress": case["mean_stress"] * 1e6,
        "von_mises_strain": case["von_mises_strain_Sousa"],
        "distortion_energy": case["distortion_energy_MPa"] * 1e6,
    }
    for name, value in known.items():
        assert found[name] == pytest.approx(value, rel=5 * PRINTED), name
    principal, _ = tensors.principal(strain)
    np.testing.assert_allclose(principal.squeeze()[::-1], case["principal_strain"], rtol=5 * PRINTED)
