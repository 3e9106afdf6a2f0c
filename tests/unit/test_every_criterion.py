"""Every quantity under a power law and under a limit, from a case; and what is said of all of them."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from cases import ONE_AXLE
from treadload.case import Case
from treadload.cli import app
from treadload.damage import (
    Criterion,
    EnergyRatio,
    Limit,
    OctahedralRatio,
    PrincipalTension,
    laws_listed,
    listed,
    miner,
    quantities_listed,
)
from treadload.damage.indices import NO_WORK
from treadload.damage.ratios import energy_ratio_of
from treadload.damage.traffic import AxleClass, Traffic
from treadload.errors import InputError
from treadload.registry import CRITERIA, QUANTITIES

# Evaluated values of a life are kept in single precision, 6e-8; a fifth power has five times that.
SINGLE = 1e-6
STONES = 'cohesion = "250 kPa", friction_angle = "40 deg"'
ROQUE = (
    'creep_compliance = 1e-10, slope = 0.5, strength = "2 MPa", fracture_energy = 2500, resilient_modulus = "10 GPa"'
)
# Word or table in a case, and a number with its unit; all of the list, and what else can be read of a layer.
READS = {
    '"extension_strain"': "100 microstrain",
    '"in_plane_extension"': "100 microstrain",
    '"vertical_compression"': "300 microstrain",
    '"horizontal_tension"': "0.4 MPa",
    '"principal_tension"': "0.4 MPa",
    '"mazars_strain"': "150 microstrain",
    '{ quantity = "mazars_onset_ratio", onset = "80 microstrain" }': "1",
    '"von_mises_strain"': "200 microstrain",
    '"octahedral_shear_stress"': "0.3 MPa",
    '"mean_stress"': "0.1 MPa",
    f'{{ quantity = "octahedral_shear_ratio", {STONES} }}': "0.5",
    '"distortion_energy"': "50 J/m^3",
    '"vertical_shear_strain"': "200 microstrain",
    f'{{ quantity = "energy_ratio", {ROQUE} }}': "1",
}


def criterion(name, law, reads, number):
    key = "limit" if law == "limit" else "slope = -0.2\nreading_6"
    return f"""[[criteria]]
name = "{name}"
law = "{law}"
reads = {reads}
{key} = "{number}"
layer = 1
place = "top"
"""


@pytest.fixture(scope="module")
def life():
    text = "".join(
        criterion(f"{law} {number}", law, reads, bound)
        for law in ("power-law", "limit")
        for number, (reads, bound) in enumerate(READS.items())
    )
    case = Case.from_text(ONE_AXLE + text)
    assert Case.from_text(case.to_toml()).build_criteria() == case.build_criteria()
    return tl.run(case, leave_out=("sensitivity",)).life


def test_every_quantity_runs_from_a_case_by_a_power_law_and_by_a_limit(life, tmp_path):
    data = life.dataset
    for number, bound in enumerate(READS.values()):
        power, limit = (data.sel(criterion=f"{law} {number}") for law in ("power-law", "limit"))
        read = float(power["largest_reading"])
        assert read == float(limit["largest_reading"]) >= 0
        quantity = life.criteria[number].quantity
        allowed = quantity.number(bound)
        # One season, no wander: a passage does what its peaks do from rest, less what the valleys between them do.
        turns = life.readings.sel(criterion=f"power-law {number}").squeeze(["axle_class", "season"]).astype(float)
        peaks, valleys = (((part / allowed) ** 5).sum("turn") for part in (turns[::2], turns[1::2]))
        most = float((peaks - valleys).max())
        assert most >= (read / allowed) ** 5 * (1 - 1e-6)
        known = np.inf if read == 0 else 1e6 / most
        assert float(power["life_passes"]) == pytest.approx(known, rel=SINGLE)
        assert float(limit["life_passes"]) == (1.0 if read > allowed else np.inf)
        assert float(limit["design_utilisation"]) == pytest.approx(read / allowed, rel=SINGLE)
        assert float(power["design_utilisation"]) == pytest.approx(read / allowed * 10**-0.2, rel=SINGLE, abs=1e-300)
    # What presses everywhere has no tension; the others are read.
    assert (data["largest_reading"] > 0).sum() >= 20
    assert (data["life_passes"] == 1.0).any()
    tl.save_results(life, tmp_path / "life.nc")
    again = tl.open_results(tmp_path / "life.nc").life
    assert again.criteria == life.criteria
    assert json.loads(tl.results.to_tree(again)["life"].attrs["laws"])[-1].startswith("limit of the inverse energy")


@pytest.mark.parametrize(
    ("reads", "words"),
    [
        (
            '"dissipated_energy"',
            "all energy back; give a layer a viscoelastic material",
        ),
        ('"energy_ratio"', "reads.creep_compliance' is missing"),
        ('"octahedral_shear_ratio"', "reads.cohesion' is missing"),
        (
            '{ quantity = "octahedral_shear_ratio", cohesion = 1e5, friction_angle = 40 }',
            r"must lie in \[0, π/2\) rad",
        ),
        ('"energy"', "a quantity is 'extension_strain'"),
        ('"utilisation"', "reads.cohesion' is missing"),
    ],
)
def test_what_cannot_be_read_is_refused_in_a_sentence(reads, words):
    with pytest.raises(InputError, match=words) as caught:
        Case.from_text(ONE_AXLE + criterion("a", "limit", reads, "1"))
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(
    ("law", "more", "words"),
    [
        ("fatigue-line", "layer = 3", "'a': epsilon_6 is missing, and the layer does not provide it"),
        ("mepdg-top-down", "", "'a': air_voids and binder_volume are missing"),
        (
            "french-bituminous",
            "layer = 3\nthickness = 0.1",
            "'a': risk, epsilon_6, .* missing.* traffic_class = \"T1\"",
        ),
        ("french-bituminous", 'layer = 1\nrisk = 0.1\ntraffic_class = "T3"', "T3 is a risk of 25 % .* remove one"),
        ("french-bituminous", 'layer = 1\ntraffic_class = "T9"', "traffic_class: .*'T5'"),
        ("french-bituminous", "layer = 3\nrisk = 0.05", "'a'"),
        ("limit", 'layer = 1\nplace = "top"\nreads = "mazars_strain"', "'a': limit is missing"),
        (
            "limit",
            'layer = 1\nreads = "mazars_strain"\nlimit = "1 MPa"',
            "cannot read '1 MPa'",
        ),
        ("limit", 'layer = 1\nreads = "mazars_strain"\nlimit = 0', "limit, of the Mazars equivalent strain, must be"),
    ],
)
def test_a_layer_without_the_data_of_a_law_is_refused_in_a_sentence(law, more, words):
    with pytest.raises(InputError, match=words) as caught:
        Case.from_text(f'{ONE_AXLE}[[criteria]]\nname = "a"\nlaw = "{law}"\n{more}\n')
    assert len(str(caught.value).splitlines()) == 1


def test_a_limit_allows_all_passes_or_none():
    law = Limit(PrincipalTension(), "2 MPa")
    np.testing.assert_array_equal(law.allowable_passes(np.array([-1.0, 2e6, 2.1e6])), [np.inf, np.inf, 1.0])
    assert np.isnan(law.allowable_passes(np.nan))
    assert law.allowable_strain(1e9) == 2e6
    assert str(law) == "limit of the principal tension, 2 MPa"
    with pytest.raises(InputError, match="passes must be positive"):
        law.allowable_strain(0.0)


def test_where_nothing_fails_the_worst_place_is_that_of_the_largest_reading():
    y = np.linspace(-0.2, 0.2, 5)
    read = np.array([0.0, 1e5, 3e5, 2e5, 0.0])[None, None, None]
    criteria = [Criterion("a", Limit(PrincipalTension(), 4e5), 0, "top")]
    traffic = Traffic((AxleClass("one", 1.0, 30e3, 8e5),), 1e5)
    data = miner(read, criteria, traffic, tl.damage.Climate.constant(15.0), y=y).dataset
    assert float(data["worst_y"][0]) == 0.0
    assert float(data["design_utilisation"][0]) == 0.75


def test_octahedral_shear_over_its_strength_is_mohr_and_coulombs_circle():
    """Triaxial compression that touches Coulomb's line uses the mix up: σ₁ = σ₃ N + 2c √N, N = tan²(45° + φ/2)."""
    cohesion, angle, confined = 2e5, np.radians(40.0), 1e5
    n = np.tan(np.pi / 4 + angle / 2) ** 2
    axial = confined * n + 2 * cohesion * np.sqrt(n)
    stress = -np.array([confined, confined, axial, 0, 0, 0])
    ratio = OctahedralRatio(cohesion, angle)
    assert float(ratio.of(stress, np.empty(0))) == pytest.approx(1.0, rel=1e-12)
    # Pulled beyond the tip of the cone.
    assert float(ratio.of(np.array([1e6, 1e6, 1e6, 0, 0, 0]), np.empty(0))) == 1e3


def test_the_energy_ratio_reads_its_inverse():
    mix = EnergyRatio(1e-10, 0.5, 2e6, 2500.0, 1e10)
    stress = np.array([1.03e6, 0.2e6, -1e5, 0, 0, 0])
    read = float(energy_ratio_of(1e-10, 0.5, 2e6, 2500.0, 1e10).of(stress, np.empty(0)))
    assert 1 / read == pytest.approx(float(mix.ratio(1.03e6)), rel=1e-12)


def test_all_that_a_criterion_can_name_is_listed_with_its_source():
    named = {one.name: one for one in (*quantities_listed(), *laws_listed())}
    assert set(named) == {*QUANTITIES.names(), *CRITERIA.names()}
    for name, one in named.items():
        assert all((one.words, one.asks, one.source, one.calibrated)), name
        assert listed(name) == one
    for name in CRITERIA.names():
        assert named[name].ends, name
    assert "cohesion (Pa)" in named["octahedral_shear_ratio"].asks
    assert named["power-law"].unit == "any"
    with pytest.raises(InputError, match="did you mean 'mazars_strain'"):
        listed("mazars")


def test_the_command_lists_them():
    ran = CliRunner().invoke(app, ["criteria"], env={"COLUMNS": "160"})
    assert ran.exit_code == 0, ran.output
    assert all(name in ran.stdout for name in (*QUANTITIES.built_in(), *CRITERIA.built_in()))
    one = CliRunner().invoke(app, ["criteria", "energy_ratio"])
    assert "Roque et al. (2004)" in one.stdout
    wrong = CliRunner().invoke(app, ["criteria", "energy"])
    assert wrong.exit_code == 2
    assert "did you mean 'energy_ratio'" in wrong.output


@pytest.mark.usefixtures("figures_as_dots")
def test_a_life_tells_what_each_class_does_to_the_surface(life, tmp_path):
    """The contact's own largest work of sliding; the tearing of its shear with the modulus of the season."""
    data = life.dataset
    (polishing,) = data["largest_polishing_work"].to_numpy()
    ((tearing,),) = data["largest_tearing_work"].to_numpy()
    assert polishing >= 0
    assert tearing > 0
    assert data["largest_tearing_work"].dims == ("axle_class", "season")
    page = tl.report(life, tmp_path / "life.html").read_text()
    assert "Ravelling and polishing" in page
    # A wheel that rolls freely tears next to nothing, which the page calls nothing.
    assert (f"{tearing:.3g}" in page) == (tearing >= NO_WORK)
