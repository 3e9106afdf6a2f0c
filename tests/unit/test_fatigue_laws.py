"""The fatigue laws: what they share, what each refuses, and the traffic of the French method."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases import ONE_AXLE
from treadload.case import Case
from treadload.catalogue import mixes
from treadload.citations import COMMONLY_QUOTED
from treadload.damage.laws import american, equivalence, french
from treadload.damage.laws.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
)
from treadload.damage.laws.equivalence import equivalent_axles
from treadload.damage.laws.fatigue import FatigueLine
from treadload.damage.laws.french import FrenchBituminous, FrenchHydraulic, FrenchSubgrade
from treadload.damage.laws.indian import (
    IrcCementTreated,
    IrcFatigue,
    IrcRutting,
    granular_modulus,
    subgrade_modulus,
)
from treadload.damage.laws.validity import range_warnings, warnings_of
from treadload.damage.quantity import Quantity
from treadload.errors import InputError

GB3 = FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3, 11880 / 9000, 120e6)
GC3 = FrenchHydraulic(0.75e6, -1 / 15, 1.0, 0.05, 1.4)
LAWS = [
    FatigueLine(120e-6, -0.2),
    GB3,
    GC3,
    FrenchSubgrade(),
    MepdgBottomUp(5e9, 0.2, 0.07, 0.11),
    MepdgTopDown(5e9, 0.2, 0.07, 0.11),
    AsphaltInstitute(5e9),
    AsphaltInstitute(5e9, 0.05, 0.11),
    AsphaltInstituteSubgrade(),
    ShellFatigue(5e9),
    IrcFatigue(3e9, 0.035, 0.115),
    IrcFatigue(3e9, 0.035, 0.115, 0.8),
    IrcRutting(),
    IrcRutting(0.8),
]


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_what_every_law_tells(law):
    assert isinstance(law.reads, Quantity)
    assert law.source
    assert law.verified == (not law.caveat)
    low, high = law.validity
    assert 0 < low < high
    # Round-off of a power, amplified by an exponent of at most 15.
    assert law.allowable_passes(low) == pytest.approx(1e8, rel=1e-12)
    assert law.allowable_passes(high) == pytest.approx(1e4, rel=1e-12)
    assert law.allowable_passes(law.at_a_million) == pytest.approx(1e6, rel=1e-12)
    assert law.allowable_passes(-high) == math.inf
    assert type(law.allowable_passes(high)) is float
    assert law.allowable_strain(np.array([1e5, 1e6])).shape == (2,)
    hash(law)


@pytest.mark.parametrize("law", LAWS, ids=str)
@given(passes=st.floats(1e2, 1e10), factor=st.floats(1.01, 10))
def test_more_strain_fewer_passes_and_there_and_back(law, passes, factor):
    strain = law.allowable_strain(passes)
    assert law.allowable_passes(strain) == pytest.approx(passes, rel=1e-11)
    assert law.allowable_passes(strain * factor) < law.allowable_passes(strain)


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_unverified_numbers_are_said_where_the_law_speaks(law):
    inside = math.sqrt(math.prod(law.validity))
    said = warnings_of(law, np.array([inside, 0.0, np.nan]))
    assert len(said) == (not law.verified)
    if not law.verified:
        assert law.caveat in said[0]
        assert COMMONLY_QUOTED in law.caveat or "the original was not read" in law.caveat
        told = " ".join(type(law).__doc__.split())
        assert "ot verified" in told


def test_the_asphalt_institutes_lives_are_those_that_another_program_prints():
    # A public program of layers prints them with three digits in its tests; its strains have four.
    assert american.AsphaltInstitute(3000e6).allowable_passes(237.7e-6) == pytest.approx(1.03e6, rel=5e-3)
    assert american.AsphaltInstituteSubgrade().allowable_passes(344.2e-6) == pytest.approx(4.36e6, rel=2e-3)


def test_what_is_verified():
    assert {type(law).__name__ for law in LAWS if law.verified} == {
        "FatigueLine",
        "FrenchBituminous",
        "FrenchHydraulic",
        "FrenchSubgrade",
        "IrcFatigue",
        "IrcRutting",
        "MepdgBottomUp",
        "MepdgTopDown",
    }


def test_a_given_scatter_of_the_thickness_stands_before_the_rule():
    """The rule is read in the cited source by now, so that neither way leaves a caveat."""
    given_one = FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3, thickness_scatter=0.025)
    assert given_one.verified
    assert GB3.verified
    assert given_one.risk_factor == GB3.risk_factor


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_every_law_says_what_its_end_is_and_whether_it_holds_wander(law):
    assert law.end_of_life
    assert law.includes_wander == type(law).__name__.startswith(("French", "Irc"))


def test_the_end_of_the_mepdg_is_that_of_its_sums_of_cracking():
    """Damage of 1: half of the area from below, a metre of crack a metre of lane from above."""
    assert "half of the lane's area" in MepdgBottomUp.end_of_life
    assert american.bottom_up_cracking(1.0, 0.2) == pytest.approx(0.5, rel=1e-14)
    assert "a metre of crack along each metre" in MepdgTopDown.end_of_life
    assert american.top_down_cracking(1.0) == pytest.approx(1.0, rel=1e-14)


def test_damage_outside_of_a_range_is_stated_by_its_share():
    """N = 10⁴ at 251 microstrain: 300 lies outside and is the largest, though another season does the damage."""
    line = FatigueLine(100e-6, -0.2)
    names = (["heavy", "light"], ["cold", "warm"])
    readings = np.array([[120e-6, 300e-6], [100e-6, 110e-6]])

    def texts(shares):
        return range_warnings([[line] * 2] * 2, readings, np.array(shares), names)

    (little,) = texts([[0.9, 0.02], [0.05, 0.03]])
    assert "300 microstrain is above 251" in little
    assert "% of the damage" not in little
    (much,) = texts([[0.3, 0.65], [0.05, 0.0]])
    assert (
        "65 % of the damage is done outside of its range, most by heavy, warm: 300 microstrain is above 251" in much
    )
    # Where most of the damage is done outside and the largest value lies inside, only the first is told.
    low = range_warnings([[line]], np.array([[10e-6]]), np.array([[1.0]]), (["one"], ["year"]))
    assert len(low) == 1
    assert "100 % of the damage is done outside" in low[0]
    assert range_warnings([[line]], np.array([[100e-6]]), np.array([[1.0]]), (["one"], ["year"])) == []


def test_extrapolation_is_said_with_its_numbers():
    line = FatigueLine(100e-6, -0.2)
    assert warnings_of(line, 100e-6) == ()
    # ε₆ · 100^0.2 = 251 microstrain allows 1e4 passes; 1000 microstrain allows 10.
    (above,) = warnings_of(line, np.array([1e-3, 1e-6]))
    assert "1000 microstrain is above 251 microstrain" in above
    assert "10 load repetitions are extrapolated" in above
    (below,) = warnings_of(line, 10e-6)
    assert "10 microstrain is below 39.8 microstrain" in below
    assert warnings_of(line, -1e-3) == ()
    (stress,) = warnings_of(GC3, 2e6)
    assert "2 MPa is above" in stress


@given(st.floats(0.001, 0.999), st.floats(0.1, 1.5), st.floats(0, 0.05))
def test_risk_and_safety_mirror_each_other(risk, scatter, spread):
    taken = french.risk_factor(risk, -0.2, scatter, spread)
    # The normal law is symmetric; round-off of its quantile in the tail.
    assert taken * french.risk_factor(1 - risk, -0.2, scatter, spread) == pytest.approx(1, rel=1e-10)
    assert (taken < 1) == (risk < 0.5) or risk == pytest.approx(0.5)


def test_scatter_of_the_thickness_and_platforms():
    rule = [french.thickness_scatter(h) for h in (0.05, 0.10, 0.12, 0.15, 0.30)]
    # Round-off of a linear rule.
    np.testing.assert_allclose(rule, [0.01, 0.01, 0.016, 0.025, 0.025], rtol=1e-14)
    factors = [french.platform_factor(m) for m in (49e6, 50e6, 79e6, 80e6, 119e6, 120e6, None)]
    np.testing.assert_allclose(factors, [1 / 1.2, 1 / 1.1, 1 / 1.1, 1 / 1.065, 1 / 1.065, 1, 1], rtol=1e-15)


def test_equivalent_axles_are_the_sum_of_the_years():
    years = np.arange(20)
    # Round-off of a sum of twenty.
    geometric = 365 * 200 * 0.8 * (1.03**years).sum()
    assert equivalent_axles(200, 20, 0.8, growth=0.03) == pytest.approx(geometric, rel=1e-13)
    arithmetic = 365 * 200 * 0.8 * (1 + 0.03 * years).sum()
    assert equivalent_axles(200, 20, 0.8, growth=0.03, kind="arithmetic") == pytest.approx(arithmetic, rel=1e-13)
    assert equivalent_axles(200, 20, 0.8) == 365 * 200 * 20 * 0.8
    # ((1 + t)^n - 1)/t of a tiny growth does not cancel: n + n (n - 1) t / 2.
    tiny = equivalent_axles(1, 20, 1, growth=1e-9)
    assert tiny == pytest.approx(365 * (20 + 190e-9), rel=1e-14)


def test_aggressiveness_of_a_vehicle():
    single, tandem = (130e3, 1, 1), (65e3, 2, 0.75)
    # (1 + 2 · 0.75 / 2⁵) axles a vehicle.
    assert equivalence.aggressiveness([single, tandem], vehicles=1, power=5) == pytest.approx(1 + 1.5 / 32, rel=1e-14)
    assert equivalence.aggressiveness([single], vehicles=4, power=12) == 0.25


def test_mix_factor_of_the_neutral_mix_is_one():
    # Vb/(Va + Vb) = 0.69 makes the exponent vanish.
    assert american.mix_factor(0.31, 0.69) == pytest.approx(1, rel=1e-14)


def test_cracking_grows_from_nothing_to_its_ends():
    damage = np.array([0.0, 1e-3, 0.5, 1.0, 1e3, np.inf])
    below, above = american.bottom_up_cracking(damage, 0.15), american.top_down_cracking(damage)
    assert (np.diff(below) >= 0).all()
    assert (np.diff(above) >= 0).all()
    assert below[0] == above[0] == 0
    # Half of each at the end of the life: 50 % of the area, 5280 feet a mile.
    np.testing.assert_allclose([below[3], above[3], below[-1], above[-1]], [0.5, 1, 1, 2], rtol=1e-14)


def test_top_down_cracking_is_what_a_public_program_codes():
    """ProductOneME: 10.56·1000/(1 + exp(7.0 - 3.5 log₁₀(100 D))) feet per mile; 5280 are a metre per metre."""
    damage = np.array([0.01, 0.1, 0.7, 5.0])
    coded = 10.56 * 1000 / (1 + np.exp(7.0 - 3.5 * np.log10(100 * damage)))
    np.testing.assert_allclose(5280 * american.top_down_cracking(damage), coded, rtol=1e-13)


def test_two_documents_disagree_on_the_subgrade_of_the_asphalt_institute():
    """What the docstring states: (0.028/ε)^4 over 1.365e-9 ε^-4.477 at 300 microstrain."""
    law = american.AsphaltInstituteSubgrade()
    assert (0.028 / 300e-6) ** 4 / law.allowable_passes(300e-6) == pytest.approx(9.4, rel=0.01)
    assert "CRREL" in law.caveat
    assert "9 times" in type(law).__doc__


def test_laws_of_catalogued_materials():
    known = FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3, 11880 / 9000, 120e6)
    law = FrenchBituminous.of(mixes["EB-GB3"], thickness=0.15, risk=0.05, platform_modulus=120e6)
    # The table is linear between 10 and 20 °C: (11880 + 6120)/2 = 9000 MPa at 15 °C.
    assert law.allowable_strain(5e6) == pytest.approx(known.allowable_strain(5e6), rel=1e-12)
    warm = FrenchBituminous.of(mixes["EB-GB3"], thickness=0.15, risk=0.05, temperature=25, platform_modulus=120e6)
    # k_θ alone: √(9000/4410).
    assert warm.at_a_million / law.at_a_million == pytest.approx(math.sqrt(9000 / 4410), rel=1e-12)
    assert FrenchHydraulic.of(mixes["GC-T3"], risk=0.05) == GC3
    jointed = FrenchHydraulic.of(mixes["BC5"], risk=0.05, joints=1 / 1.47, thickness_scatter=0.01)
    assert jointed.joints == 1 / 1.47
    assert FrenchSubgrade.of(mixes["PF3"]) == FrenchSubgrade()
    assert FrenchSubgrade.of(mixes["PF3"], "light").constant == 0.016
    assert FrenchSubgrade.of(mixes["GNT1"], "inverted").constant == 0.0144


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: FrenchBituminous.of(mixes["BBM"], thickness=0.04, risk=0.05),
            "'BBM' has no fatigue line",
        ),
        (
            lambda: FrenchHydraulic.of(mixes["BC5"], risk=0.05),
            "joints of 'BC5' depends on the structure",
        ),
        (
            lambda: FrenchHydraulic.of(mixes["BC5"], risk=0.05, joints=1.0),
            "thickness_scatter of 'BC5' depends",
        ),
        (
            lambda: FrenchSubgrade.of(mixes["PF3"], "inverted"),
            "the traffic heavy, light, got 'inverted'",
        ),
        (lambda: FrenchSubgrade.of(mixes["PF3"], "none"), "got 'none'"),
        (lambda: FrenchBituminous(90, -0.2, 0.3, 0.15, 0.05, 1.3), '90e-6 or "90 microstrain"'),
        (lambda: FrenchBituminous(90e-6, 0.2, 0.3, 0.15, 0.05, 1.3), r"slope must lie in \(-1, 0\), got 0.2"),
        (lambda: FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 5, 1.3), r"risk must lie in \(0, 1\), got 5; 5 % is 0.05"),
        (lambda: FrenchBituminous(90e-6, -0.2, -0.3, 0.15, 0.05, 1.3), "scatter must be a positive number, got -0.3"),
        (lambda: FrenchBituminous(90e-6, -0.2, 0.3, 0, 0.05, 1.3), "thickness must be a positive number of metres"),
        (lambda: FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3, platform_modulus=-1), "PF3 has 120e6"),
        (lambda: FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3, thickness_scatter=25), "25 mm is 0.025"),
        (lambda: FrenchHydraulic(-1, -0.1, 1, 0.05, 1.4), "sigma_6 must be a positive number of Pa, got -1"),
        (lambda: FrenchSubgrade(12000), "plain strain, got 12000; 12000 microstrain is 0.012"),
        (lambda: MepdgBottomUp(5000, 0.2, 0.07, 0.11), "modulus must be in Pa, got 5000"),
        (lambda: MepdgBottomUp(5e9, 0.2, 7, 11), r"share of the volume in \(0, 1\), got 7; 7 % is 0.07"),
        (lambda: MepdgTopDown(5e9, 0.2, 0.07, 11), "binder_volume, of the effective binder, must be a share"),
        (lambda: AsphaltInstitute(5e9, 0.05), "both air_voids and binder_volume or none, got 0.05 and None"),
        (lambda: ShellFatigue(math.nan), "modulus must be a positive number of Pa, got nan"),
        (lambda: equivalent_axles(-1, 20, 0.8), "vehicles_per_day must be a positive number, got -1"),
        (lambda: equivalent_axles(1, 20, 0.8, growth=-2), "growth must be above -1 per year, got -2"),
        (lambda: equivalent_axles(1, 20, 0.8, growth=math.inf, kind="arithmetic"), "at most 10 per year, got inf"),
        (lambda: equivalent_axles(1, 2e21, 0.8, growth=0.02), "over 2e.21 years makes more passes than a number"),
        (lambda: equivalent_axles(1, 20, 0.8, growth=-0.5, kind="arithmetic"), "leaves no traffic over 20 years"),
        (lambda: equivalent_axles(1, 20, 0.8, kind="weekly"), '"geometric" or "arithmetic", got \'weekly\''),
        (lambda: equivalence.aggressiveness([], vehicles=1, power=5), "axles is empty"),
        (lambda: equivalence.aggressiveness([(-1, 1, 1)], vehicles=1, power=5), "load > 0 N"),
        (lambda: american.top_down_cracking(-0.1), "damage must be ≥ 0, got -0.1"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_the_indian_laws_print_what_the_guideline_prints():
    # Example III.1 of IRC:37-2018: 53 and 187 million passes; the first is cut.
    assert IrcFatigue(3e9, 0.035, 0.115).allowable_passes(175e-6) == pytest.approx(53.57e6, rel=1e-3)
    assert IrcRutting().allowable_passes(278e-6) == pytest.approx(186.57e6, rel=1e-3)
    # Of volumes with their sum of 15 % the shares and the percentages are the same factor.
    assert american.mix_factor(3.5, 11.5) == pytest.approx(american.mix_factor(0.035, 0.115), rel=1e-13)
    # At 80 % more passes, by the constants printed.
    pairs = ((IrcFatigue, (3e9, 0.035, 0.115), 1.6064 / 0.5161), (IrcRutting, (), 4.1656 / 1.41))
    for law, numbers, ratio in pairs:
        some, most = (law(*numbers, reliability=r).allowable_passes(2e-4) for r in (0.8, 0.9))
        assert some / most == pytest.approx(ratio, rel=1e-9)


def test_a_cement_treated_base_bears_its_strength_once_or_twice():
    law = IrcCementTreated(1.4e6)
    assert law.allowable_passes(0.972 * 1.4e6) == pytest.approx(1.0, rel=1e-9)
    # log10 N = (0.972 - 0.5)/0.0825.
    assert math.log10(law.allowable_passes(0.7e6)) == pytest.approx(0.472 / 0.0825, rel=1e-12)
    assert law.allowable_strain(law.allowable_passes(0.6e6)) == pytest.approx(0.6e6, rel=1e-12)
    assert law.allowable_passes(-1.0) == math.inf
    assert law.allowable_passes(np.array([0.0, 0.7e6, np.nan])).tolist()[0] == math.inf
    assert math.isnan(law.allowable_passes(math.nan))
    low, high = law.validity
    assert law.allowable_passes(np.array([low, high])) == pytest.approx([1e8, 1e4], rel=1e-9)
    assert not law.verified
    assert "no printed answer" in law.caveat


def test_moduli_of_the_indian_guideline():
    # CBR 10: 76.83 MPa, and 240.2 MPa of 450 mm of granular layers on it.
    assert subgrade_modulus(10.0) == pytest.approx(76.83e6, rel=1e-4)
    assert subgrade_modulus(5.0) == pytest.approx(50e6)
    assert granular_modulus(0.45, subgrade_modulus(10.0)) == pytest.approx(240.15e6, rel=1e-4)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: IrcFatigue(3000, 0.035, 0.115), "modulus must be in Pa, got 3000; 3000 MPa is 3e9"),
        (lambda: IrcFatigue(3e9, 3.5, 0.115), "air_voids must be a share"),
        (lambda: IrcRutting(0.95), r"reliability must be 0.8 or 0.9, got 0.95"),
        (lambda: IrcCementTreated(1.4), r"strength must be in Pa, got 1.4; 1.4 MPa is 1.4e6"),
        (lambda: IrcCementTreated(1.4e6).allowable_strain(1e12), "no tension allows by this law"),
        (lambda: granular_modulus(0.0, 5e7), "thickness must be a positive number of metres"),
        (lambda: subgrade_modulus(200.0), "must be at most 100 %, got 200"),
    ],
)
def test_what_the_indian_laws_refuse(build, message):
    with pytest.raises(InputError, match=message):
        build()


def test_the_indian_laws_of_a_case():
    criteria = """
[[criteria]]
name = "fatigue"
law = "irc-fatigue"
layer = 1
air_voids = 0.035
binder_volume = 0.115
reliability = 0.8
[[criteria]]
name = "rutting"
law = "irc-rutting"
[[criteria]]
name = "cement"
law = "irc-cement-treated"
layer = 1
place = "bottom"
strength = "1.4 MPa"
"""
    built = Case.from_text(ONE_AXLE + criteria).build_criteria()
    assert [type(criterion.law_at(15.0)) for criterion in built] == [IrcFatigue, IrcRutting, IrcCementTreated]
    # What is left out comes from the layer: its modulus.
    assert built[0].law_at(15.0).modulus > 1e9
