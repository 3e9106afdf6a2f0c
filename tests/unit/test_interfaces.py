"""The bond between layers: strength and fatigue in closed form, fields of interfaces, where and when they part."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.citations import COMMONLY_QUOTED
from treadload.damage import (
    LEUTNER_MINIMUM,
    Criterion,
    InterfaceStrength,
    ShearFatigue,
    assess_bonds,
    delaminate,
    interface_fields,
)
from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import BONDED, FRICTIONLESS, HALF_BONDED, Bond, Layer, Pavement
from treadload.response import UniformRectangle, solve_response

ANGLE = math.radians(30)
BRAKED = UniformRectangle(0.2, 0.2, 0.8e6, traction_x=0.4e6)
X = np.linspace(-0.2, 0.2, 9)
SPRING = 1e9


def road(upper=BONDED, lower=BONDED):
    return Pavement(
        [
            Layer(Elastic(7e9, 0.35), 0.06, name="wearing course", bond=upper),
            Layer(Elastic(9e9, 0.35), 0.15, name="base", bond=lower),
            Layer(Elastic(120e6, 0.35), name="soil"),
        ]
    )


def both_sides(of, load=BRAKED):
    return [solve_response(load, of, depths=of.interfaces, x=X, y=X, side=side) for side in ("above", "below")]


@pytest.fixture(scope="module")
def bonded():
    return interface_fields(*both_sides(road()))


@pytest.mark.parametrize(
    ("shear", "pressed", "wanted"),
    [
        # τ / (c + σ tan φ) by hand, c = 0.5 MPa, φ = 30°: in compression, without normal stress, in tension.
        (0.4e6, 0.6e6, 0.4 / (0.5 + 0.6 / math.sqrt(3))),
        (0.4e6, 0.0, 0.8),
        (0.1e6, -0.2e6, max(0.1 / (0.5 - 0.2 / math.sqrt(3)), 0.2 / (0.5 * math.sqrt(3)))),
        # Tension alone, against the end of the line c / tan φ; beyond it nothing holds shear.
        (0.0, -0.3e6, 0.3 / (0.5 * math.sqrt(3))),
        (0.1e6, -0.9e6, math.inf),
        (0.0, 0.7e6, 0.0),
    ],
)
def test_utilisation_is_coulombs(shear, pressed, wanted):
    found = float(InterfaceStrength(0.5e6, ANGLE).utilisation(shear, pressed))
    assert found == pytest.approx(wanted, rel=1e-12)


def test_a_tensile_strength_cuts_the_line():
    cut = InterfaceStrength(0.5e6, ANGLE, tensile_strength=0.1e6)
    assert float(cut.utilisation(0.0, -0.05e6)) == pytest.approx(0.5, rel=1e-12)
    assert float(cut.utilisation(0.4e6, 0.6e6)) == float(InterfaceStrength(0.5e6, ANGLE).utilisation(0.4e6, 0.6e6))
    assert float(InterfaceStrength(0.5e6, 0.0, 0.0).utilisation(0.0, -1.0)) == math.inf


def test_without_cohesion_friction_alone_holds():
    loose = InterfaceStrength(0.0, ANGLE)
    assert float(loose.utilisation(0.3e6, 0.9e6)) == pytest.approx(0.3 / 0.9 * math.sqrt(3), rel=1e-12)
    assert float(loose.utilisation(1.0, 0.0)) == math.inf
    assert float(loose.utilisation(0.0, -1.0)) == math.inf
    assert float(loose.utilisation(0.0, 0.0)) == 0.0
    smooth = InterfaceStrength(0.0)
    assert float(smooth.utilisation(1.0, 1e9)) == math.inf


def test_without_friction_pressure_does_not_matter():
    glued = InterfaceStrength(0.5e6)
    assert np.asarray(glued.utilisation(0.2e6, np.array([0.0, 1e6, 1e9]))) == pytest.approx(0.4, rel=1e-12)
    assert glued.tension_limit == math.inf


@settings(deadline=None, max_examples=50)
@given(st.floats(0, 2e6), st.floats(-2e6, 2e6), st.floats(1e-3, 1e3))
def test_without_friction_utilisation_is_linear_in_the_load(shear, pressed, factor):
    glued = InterfaceStrength(0.5e6, 0.0, 0.3e6)
    one, more = glued.utilisation(shear, pressed), glued.utilisation(factor * shear, factor * pressed)
    assert float(more) == pytest.approx(factor * float(one), rel=1e-12)


@settings(deadline=None, max_examples=50)
@given(st.floats(0, 2e6), st.floats(-0.3e6, 2e6), st.floats(1.0, 10.0))
def test_more_shear_less_pressure_and_less_cohesion_use_more(shear, pressed, factor):
    strength = InterfaceStrength(0.5e6, ANGLE)
    here = float(strength.utilisation(shear, pressed))
    assert float(strength.utilisation(factor * shear, pressed)) >= here
    assert float(strength.utilisation(shear, pressed - 1e5)) >= here
    assert float(InterfaceStrength(0.5e6 / factor, ANGLE).utilisation(shear, pressed)) >= here


def test_leutner_forces_become_stresses():
    # F / (π d²/4) on 150 mm: 15 kN is 0.849 MPa, 12 kN 0.679 MPa.
    assert InterfaceStrength.from_leutner(15e3).cohesion == pytest.approx(0.8488e6, rel=1e-4)
    assert InterfaceStrength.from_leutner(12e3).cohesion == pytest.approx(0.6791e6, rel=1e-4)
    assert InterfaceStrength.from_leutner(7e3, 0.1).cohesion == pytest.approx(7e3 / (math.pi * 0.05**2), rel=1e-12)
    least = InterfaceStrength.leutner_minimum("lower")
    assert least.cohesion == InterfaceStrength.from_leutner(LEUTNER_MINIMUM["lower"]).cohesion
    assert COMMONLY_QUOTED in least.caveat
    assert COMMONLY_QUOTED in Criterion.of_bond("bond", least, ShearFatigue(-0.2)).quantity.caveat


def test_strengths_follow_their_temperature():
    strength = InterfaceStrength(lambda t: 1e6 - 20e3 * t, ANGLE, lambda t: 0.1e6)
    assert strength.depends_on_temperature
    assert strength.at(20.0) == InterfaceStrength(0.6e6, ANGLE, 0.1e6)
    with pytest.raises(InputError, match="temperature"):
        strength.utilisation(1.0, 1.0)
    with pytest.raises(InputError, match="at 60 °C: cohesion"):
        strength.at(60.0)


def test_passes_of_a_bond_are_a_power_of_its_utilisation():
    law = ShearFatigue(-0.2)
    used = np.array([0.05, 0.5, 1.0])
    assert law.allowable_passes(used) == pytest.approx(used**-5.0, rel=1e-12)
    assert law.allowable_passes(0.0) == math.inf
    assert ShearFatigue(-0.25, single_pass=0.8).allowable_passes(0.4) == pytest.approx(16.0, rel=1e-12)


def test_shear_of_a_spring_is_its_stiffness_times_the_jump():
    """Goodman's law at both interfaces, along and across travel; the solver's own round-off, 1e-9 of the largest."""
    fields = interface_fields(*both_sides(road(Bond(SPRING), Bond(2 * SPRING))))
    for name in "xy":
        shear, jump = fields[f"interface_shear_{name}"].to_numpy(), fields[f"jump_{name}"].to_numpy()
        for k, stiffness in enumerate((SPRING, 2 * SPRING)):
            assert np.abs(shear[k] - stiffness * jump[k]).max() <= 1e-9 * np.abs(shear[k]).max()


def test_tractions_are_continuous_and_a_bond_does_not_slide(bonded):
    other = interface_fields(both_sides(road())[1])
    for name in ("interface_shear_x", "interface_shear_y", "interface_pressure"):
        size = float(np.abs(bonded[name]).max())
        # Above, the first interface is met with the half-space split off, below without: both are cut at 1e-9.
        assert np.abs(other[name].to_numpy() - bonded[name].to_numpy()).max() <= 1e-8 * size
    assert np.abs(bonded["jump_x"]).max() <= 1e-13


def test_a_frictionless_interface_bears_no_shear():
    pressing = UniformRectangle(0.2, 0.2, 0.8e6)
    fields = interface_fields(*both_sides(road(FRICTIONLESS), pressing))
    assert (
        fields["interface_shear"].isel(interface=0).max() <= 1e-9 * fields["interface_shear"].isel(interface=1).max()
    )
    assert np.abs(fields["jump_x"].isel(interface=0)).max() > 1e-6


def test_a_spring_lies_between_its_limits(bonded):
    """Shear grows with the stiffness of the bond, from nothing to that of the bonded road."""
    found = [
        interface_fields(solve_response(BRAKED, road(Bond(k)), depths=road().interfaces, x=X, y=X))
        for k in (1e6, 1e9, 1e10, 1e11, 1e12, 1e15)
    ]
    largest = [float(fields["interface_shear"].isel(interface=0).max()) for fields in found]
    whole = float(bonded["interface_shear"].isel(interface=0).max())
    assert (np.diff(largest) > 0).all()
    # Off by what the spring gives over what the layers give, some E / h = 1e11 Pa/m; a soft one over all the road.
    assert largest[0] < 1e-3 * whole
    assert largest[-1] == pytest.approx(whole, rel=1e-3)


def test_half_bonded_bears_half_the_shear_of_its_limits(bonded):
    """The French rule: the mean of bonded and frictionless, where the shear is nothing."""
    half = interface_fields(solve_response(BRAKED, road(HALF_BONDED), depths=road().interfaces, x=X, y=X))
    expected = bonded["interface_shear_x"].isel(interface=0).to_numpy() / 2
    assert half["interface_shear_x"].isel(interface=0).to_numpy() == pytest.approx(expected, abs=1.0)


def test_an_interface_carries_the_load_on():
    """Equilibrium: pressure and shear of an interface add up to the forces on the surface, 32 and 16 kN."""
    x = 6 * np.sinh(np.linspace(-4, 4, 121)) / math.sinh(4)
    soft = Pavement([Layer(Elastic(1e9, 0.35), 0.1), Layer(Elastic(0.8e9, 0.3))])
    fields = interface_fields(solve_response(BRAKED, soft, depths=soft.interfaces, x=x, y=x))
    down, along = (
        float(np.trapezoid(np.trapezoid(fields[name].isel(interface=0), x), x))
        for name in ("interface_pressure", "interface_shear_x")
    )
    # Of Cerruti's shear 3 z / 2 a lies beyond a = 6 m: 2.5 %. Points 15 mm apart under the load: 1e-3.
    assert down == pytest.approx(32e3, rel=2e-3)
    assert -along == pytest.approx(16e3 * (1 - 0.15 / 6), rel=5e-3)


def test_the_verdict_finds_where_and_when(bonded):
    strengths = (InterfaceStrength(1e6, ANGLE), InterfaceStrength(0.02e6))
    verdict = assess_bonds(bonded, strengths, ShearFatigue(-0.2))
    data = verdict.dataset
    for k, strength in enumerate(strengths):
        one = bonded.isel(interface=k)
        used = strength.utilisation(one["interface_shear"].to_numpy(), one["interface_pressure"].to_numpy())
        assert float(data["largest_utilisation"][k]) == used.max()
        here = data["utilisation"].isel(interface=k).sel(x=data["parting_x"][k], y=data["parting_y"][k])
        assert float(here) == used.max()
        assert float(data["parting_passes"][k]) == pytest.approx(used.max() ** -5, rel=1e-12)
    assert verdict.first == 1
    text = verdict.summary()
    assert "interface 1, below wearing course (60 mm deep)" in text
    assert "interface 2, below base" in text
    assert "fails first" in text


def test_verdicts_in_all_states(bonded):
    weak = assess_bonds(bonded, InterfaceStrength(1e3))
    assert "fails in the first pass" in weak.summary()
    asked = assess_bonds(bonded, [InterfaceStrength(1e6), None])
    assert asked.first == 0
    assert "no strength given" in asked.summary()
    assert "Give a law" in asked.summary()
    assert np.isnan(asked.dataset["utilisation"].isel(interface=1)).all()
    doubted = assess_bonds(bonded, InterfaceStrength.leutner_minimum("wearing"), ShearFatigue(-0.2))
    assert any(COMMONLY_QUOTED in text for text in doubted.warnings)
    warm = assess_bonds(bonded, InterfaceStrength(lambda t: 1e6 - 1e4 * t), temperature=[10.0, 20.0])
    assert [one.cohesion for one in warm.strengths] == [0.9e6, 0.8e6]


def test_tension_that_is_not_judged_is_told(bonded):
    lifted = bonded.assign(interface_pressure=-bonded["interface_pressure"])
    told = assess_bonds(lifted, InterfaceStrength(1e6))
    assert any("tension up to" in text for text in told.warnings)
    assert not assess_bonds(lifted, InterfaceStrength(10e6, 0.0, 2e6)).warnings


def test_a_worst_place_at_the_edge_of_the_points_is_told(bonded):
    cut = bonded.isel(x=slice(0, 4))
    assert any("edge of the points" in text for text in assess_bonds(cut, InterfaceStrength(1e6)).warnings)
    line = bonded.isel(y=[4])
    assert not any("edge" in text for text in assess_bonds(line, [InterfaceStrength(1e6), None]).warnings)


def test_points_that_end_before_the_worst_place_are_solved_further():
    """A response is solved further: what is largest, and where, is that of points which reach far enough."""
    near, wide = np.linspace(-0.06, 0.06, 9), np.linspace(-0.2, 0.2, 81)
    strength = [InterfaceStrength(1e6, ANGLE), None]
    response, whole = (solve_response(BRAKED, road(), depths=road().interfaces, x=x, y=x) for x in (near, wide))
    verdict, reference = assess_bonds(response, strength, ShearFatigue(-0.2)), assess_bonds(whole, strength)
    data, known = verdict.dataset.isel(interface=0), reference.dataset.isel(interface=0)
    largest = float(data["largest_utilisation"])
    assert largest == pytest.approx(float(known["largest_utilisation"]), rel=2e-3)
    assert largest > 1.02 * float(data["utilisation"].max())
    assert abs(float(data["parting_x"]) - float(known["parting_x"])) <= 0.01
    assert abs(float(data["parting_x"])) > 0.06
    assert float(data["parting_passes"]) == pytest.approx(largest**-5, rel=1e-9)
    assert strength[0].utilisation(data["parting_shear"], data["parting_pressure"]) == pytest.approx(largest)
    (text,) = (text for text in verdict.warnings if "edge of the points" in text)
    assert "solved further, to 0.3 m beyond them" in text
    assert f"it is {largest:.3g} at x = {1e3 * float(data['parting_x']):.0f} mm" in text
    # The numbers of the summary are those of the place, which the map does not have.
    shown = next(row for row in verdict.rows() if row.key == "interface_shear")
    assert shown.value == float(data["parting_shear"])
    assert not any("edge" in text for text in reference.warnings)
    # Fields alone, without road and loads, are named.
    (text,) = (t for t in assess_bonds(interface_fields(response), strength).warnings if "edge" in t)
    assert "solve it further out" in text


def test_friction_alone_is_not_followed_into_the_far_field():
    """Without cohesion the utilisation is a ratio of stresses that both vanish; what counts still feels the load."""
    response = solve_response(BRAKED, road(), depths=road().interfaces, x=X, y=X)
    verdict = assess_bonds(response, [InterfaceStrength(0.0, ANGLE), None])
    shear = verdict.dataset["interface_shear"].isel(interface=0)
    assert float(verdict.dataset["parting_shear"][0]) >= 1e-3 * float(shear.max())


def test_load_scales_the_utilisation_of_a_glued_interface(bonded):
    twice = interface_fields(
        solve_response(
            UniformRectangle(0.2, 0.2, 1.6e6, traction_x=0.8e6), road(), depths=road().interfaces, x=X, y=X
        )
    )
    one, two = (assess_bonds(f, InterfaceStrength(1e6)).dataset["utilisation"].to_numpy() for f in (bonded, twice))
    assert two == pytest.approx(2 * one, rel=1e-9)


def test_delaminate_changes_one_bond():
    changed = delaminate(road(), 0)
    assert [layer.bond for layer in changed.layers] == [FRICTIONLESS, BONDED, BONDED]
    assert delaminate(road(), -1, Bond(SPRING)).layers[1].bond == Bond(SPRING)
    assert delaminate(changed, 0, BONDED) == road()


def test_a_criterion_reads_what_the_verdict_reads(bonded):
    strength = InterfaceStrength(1e6, ANGLE)
    criterion = Criterion.of_bond("bond", strength, ShearFatigue(-0.2), -2)
    above = solve_response(BRAKED, road(), depths=[criterion.depth(road())], x=X, y=X, side=criterion.side)
    wanted = assess_bonds(bonded, strength).dataset["utilisation"].isel(interface=0).to_numpy()
    # One depth and two share no wavenumbers: both are cut at 1e-9 of the largest stress.
    assert criterion.read(above.dataset.isel(depth=0)) == pytest.approx(wanted, abs=1e-8)
    assert (criterion.number(road()), criterion.depth(road())) == (0, pytest.approx(0.06))
    angle, dip = criterion.crack(above.dataset.isel(depth=0))
    assert np.isnan(angle).all()
    assert (dip == 0).all()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda _: InterfaceStrength(-1.0), "cohesion must be"),
        (lambda _: InterfaceStrength(1e6, 35.0), r"35° is math.radians"),
        (lambda _: InterfaceStrength(1e6, ANGLE, 2e6), "beyond the end of Coulomb's line"),
        (lambda _: InterfaceStrength(1e6, 0.0, -1.0), "tensile_strength must be"),
        (lambda _: InterfaceStrength.from_leutner(0.0), "force"),
        (lambda _: InterfaceStrength.from_leutner(15e3, 150.0), "150 mm is 0.15"),
        (lambda _: InterfaceStrength.leutner_minimum("top"), "wearing, lower"),
        (lambda _: ShearFatigue(0.2), r"\(-1, 0\)"),
        (lambda _: ShearFatigue(-0.2, 0.0), "single_pass"),
        (lambda _: delaminate(road(), 2), "2 interface"),
        (lambda _: delaminate(Pavement.half_space(Elastic(1e9, 0.3)), 0), "there is none"),
        (lambda f: assess_bonds(f, [InterfaceStrength(1e6)]), "each of the 2 interfaces"),
        (lambda f: assess_bonds(f, [None, None]), "at least one"),
        (lambda f: assess_bonds(f, InterfaceStrength(1e6), temperature=[1.0]), "one for each of the 2"),
        (lambda f: assess_bonds(f, InterfaceStrength(lambda t: 1e6)), "temperature"),
        (
            lambda _: interface_fields(solve_response(BRAKED, road(), depths=[0.06], x=X, y=X)),
            "lacks the interface at 0.21 m",
        ),
        (
            lambda _: interface_fields(
                solve_response(BRAKED, Pavement.half_space(Elastic(1e9, 0.3)), depths=[0.06], x=X, y=X)
            ),
            "no interfaces",
        ),
    ],
)
def test_bad_input_is_named(bonded, make, words):
    with pytest.raises(InputError, match=words):
        make(bonded)
