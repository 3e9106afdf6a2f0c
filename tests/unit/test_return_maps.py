"""Return maps: the stress comes back to the yield surface, in the direction of the law, and costs work."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadload as tl
from treadload.kernels.plasticity.cone import Cone
from treadload.kernels.plasticity.mises import Mises
from treadload.kernels.plasticity.state import State, contracted, deviator, size
from treadload.materials import DruckerPrager, MohrCoulomb, PassesPowerLaw, Perzyna, Swift, VonMises

STEEL, ASPHALT = tl.Elastic(210e9, 0.3), tl.Elastic(600e6, 0.35)
LAWS = {
    "perfect": (STEEL, VonMises(1e9)),
    "linear": (STEEL, VonMises(1e9, hardening=2.1e8)),
    "swift": (STEEL, VonMises(Swift(1280e6 * 10**0.57, 4e-6, 0.095))),
    "prager": (STEEL, VonMises(1e9, kinematic=4.2e9)),
    "armstrong-frederick": (STEEL, VonMises(1e9, hardening=1e8, kinematic=2e11, recovery=400.0)),
    "drucker-prager": (ASPHALT, DruckerPrager(1e5, math.radians(50), math.radians(10), hardening=1e6)),
    "mohr-coulomb": (ASPHALT, MohrCoulomb(6e4, math.radians(35), math.radians(5))),
    "no friction": (ASPHALT, MohrCoulomb(6e4, 0.0)),
}


def state_of(law, elastic, n, seed):
    """A state with a history: what two returns have left."""
    rng = np.random.default_rng(seed)
    back = law.return_map(elastic)
    state = State.virgin((n,))
    for _ in range(2):
        state = back(3 * law.strength * rng.standard_normal((6, n)), state)
    return back, state


def stress_after(back, trial, before, after):
    return trial - back.elastic(after.strain - before.strain)


@pytest.mark.parametrize("name", LAWS)
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**6), far=st.floats(-1.0, 1.5))
def test_a_return_ends_on_the_surface_and_costs_work(name, seed, far):
    elastic, law = LAWS[name]
    back, before = state_of(law, elastic, 40, seed)
    trial = law.strength * 10**far * np.random.default_rng(seed + 1).standard_normal((6, 40))
    after = back(trial, before)
    stress = stress_after(back, trial, before, after)
    over, left = back.excess(trial, before), back.excess(stress, after)
    yields = over > 0
    # Consistency: on the surface where it yields, to round-off of a trial stress of up to a hundred strengths.
    assert np.all(np.abs(left[yields]) < 1e-12 * law.strength)
    # Inside nothing happens at all.
    assert np.array_equal(after.strain[:, ~yields], before.strain[:, ~yields])
    assert np.all((after.hardening > before.hardening)[yields])
    # Dissipation: the work on plastic strain less what the back stress stores.
    flow = after.strain - before.strain
    drag = after.back if isinstance(back, Mises) else 0 * stress
    assert np.all(contracted(stress - drag, flow) >= -1e-12 * np.abs(stress).max() * np.abs(flow).max())
    # And a second return from there changes nothing but round-off.
    again = back(stress, after)
    assert np.abs(again.strain - after.strain).max() <= 1e-12 * np.abs(after.strain).max()


def test_the_cone_without_friction_is_von_mises():
    trial = 4e5 * np.random.default_rng(3).standard_normal((6, 200))
    cone, mises = (law.return_map(ASPHALT) for law in (DruckerPrager(1e5, 1e-9), VonMises(1e5)))
    state = State.virgin((200,))
    one, other = cone(trial, state).strain, mises(trial, state).strain
    # tan β of 1e-9 moves the surface by as much of the mean stress.
    assert np.abs(one - other).max() < 1e-8 * np.abs(other).max()


def test_beyond_the_apex_all_of_the_deviator_goes():
    back = MohrCoulomb(6e4, math.radians(35), math.radians(5)).return_map(ASPHALT)
    assert isinstance(back, Cone)
    tension = np.array([5e5, 5e5, 5e5, 1e4, 0.0, 2e4])[:, None]
    before = State.virgin((1,))
    stress = stress_after(back, tension, before, back(tension, before))
    # c cot φ: the tip of Mohr and Coulomb's pyramid.
    tip = 6e4 / math.tan(math.radians(35))
    np.testing.assert_allclose(stress[:, 0], [tip, tip, tip, 0, 0, 0], rtol=1e-12, atol=1e-9 * tip)


def test_dilation_is_the_ratio_of_the_law():
    angle = math.radians(10)
    law = DruckerPrager(1e5, math.radians(40), angle)
    back = law.return_map(ASPHALT)
    trial = np.array([-3e5, -2e5, -9e5, 1e5, 2e5, 0.0])[:, None]
    after = back(trial, State.virgin((1,)))
    assert after.strain[:3].sum() == pytest.approx(math.tan(angle) * after.hardening[0], rel=1e-12)
    assert size(deviator(after.strain))[0] * 2 / 3 == pytest.approx(after.hardening[0], rel=1e-12)


def test_triaxial_compression_fails_where_mohr_and_coulomb_say():
    # σ1 - σ3 = 2 c cos φ + (σ1 + σ3) sin φ at the compression edge, compression positive.
    phi, c, confining = math.radians(35), 6e4, 1e5
    back = MohrCoulomb(c, phi).return_map(ASPHALT)
    failing = (confining * (1 + math.sin(phi)) + 2 * c * math.cos(phi)) / (1 - math.sin(phi))
    stress = -np.array([confining, confining, failing, 0, 0, 0])[:, None]
    assert abs(back.excess(stress, State.virgin((1,)))[0]) < 1e-12 * failing


def test_tension_follows_the_curve_of_hardening():
    # Uniaxial, driven by strain with the lateral stress held at zero: σ = Y + H p.
    law = VonMises(1e9, hardening=2e9)
    back, state, axial = law.return_map(STEEL), State.virgin((1,)), 0.02
    lateral = -0.3 * axial
    for _ in range(60):
        strain = np.array([lateral, lateral, axial, 0, 0, 0])[:, None]
        after = back(back.elastic(strain), state)
        stress = back.elastic(strain - after.strain)
        lateral -= float(stress[0, 0]) / (STEEL.modulus / 0.52 * 0.7) * 0.5
    assert abs(stress[0, 0]) < 1e3
    p = after.hardening[0]
    assert stress[2, 0] == pytest.approx(1e9 + 2e9 * p, rel=1e-6)
    assert p == pytest.approx(axial - stress[2, 0] / STEEL.modulus, rel=1e-6)


@pytest.mark.parametrize("law", [VonMises(1e5, kinematic=1e7, recovery=10.0), MohrCoulomb(6e4, 0.6, 0.1)])
@pytest.mark.parametrize("exponent", [1.0, 3.0, 8.0])
def test_a_viscous_law_obeys_its_rate_and_tends_to_the_surface(law, exponent):
    viscous = Perzyna(law, fluidity=2.0, exponent=exponent)
    back, plain = viscous.return_map(ASPHALT), law.return_map(ASPHALT)
    # Compression, where no cone has its apex.
    trial = 3e5 * np.random.default_rng(5).standard_normal((6, 50))
    trial[:3] -= 4e5
    before = State.virgin((50,))
    for duration in (1e-4, 1e-2, 1.0):
        after = back(trial, before, duration)
        over = plain.excess(stress_after(back, trial, before, after), after)
        moved = after.hardening > 0
        assert moved.any()
        rate = after.hardening / duration
        np.testing.assert_allclose(rate[moved], 2.0 * (over[moved] / law.strength) ** exponent, rtol=1e-6)
    slow, last = back(trial, before, 1e9).strain, plain(trial, before).strain
    # Above the surface stays (dp / (fluidity duration))^(1/8), 2.4 % of the strength, at the largest exponent.
    assert np.abs(slow - last).max() < 0.03 * np.abs(last).max()
    assert not back(trial, before, 0.0).strain.any()


def test_swift_counts_plain_strain():
    # M50 steel in microstrain, 1280 MPa (4 + 10⁶ p)^0.095: what the docstring says of the units.
    law = Swift(1280e6 * 10 ** (6 * 0.095), 4e-6, 0.095)
    stress, slope = law.curve(np.array([0.0, 1e-3]))
    np.testing.assert_allclose(stress, 1280e6 * np.array([4.0, 1004.0]) ** 0.095, rtol=1e-12)
    assert slope[1] == pytest.approx((law.curve(np.array(1e-3 + 1e-9))[0] - stress[1]) / 1e-9, rel=1e-4)


def test_the_power_law_of_the_american_guide():
    # 50 °C is 122 °F.
    law = PassesPowerLaw.asphalt(50.0)
    assert law.factor == pytest.approx(10**-3.35412 * 122**1.5606, rel=1e-12)
    assert law.exponent == 0.4791


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: VonMises(-1.0), "yield_stress must be a positive number of Pa, got -1"),
        (lambda: VonMises(1e8, hardening=-1.0), "hardening must be a number >= 0 Pa, got -1"),
        (lambda: VonMises(1e8, recovery=3.0), "recovery is 3 without kinematic hardening"),
        (lambda: VonMises(Swift(1e9, 1e-5, 0.1), hardening=1e6), "Swift's law hardens by itself"),
        (lambda: Swift(1e9, 1e-5, 2.0), r"exponent of Swift's law must lie in \[0, 1\], got 2.0"),
        (lambda: MohrCoulomb(6e4, 35), r"friction_angle must lie in \[0, π/2\) rad, got 35; 35 degrees is"),
        (lambda: MohrCoulomb(6e4, 0.5, 0.6), r"dilation_angle must lie in \[0, 0.5\] rad"),
        (lambda: MohrCoulomb(0.0, 0.5), "cohesion must be a positive number of Pa, got 0"),
        (lambda: Perzyna(PassesPowerLaw(1, 0.5), 1.0), "the law of Perzyna must be"),
        (lambda: Perzyna(VonMises(1e8), 1.0, 0.5), r"exponent of Perzyna's law must lie in \[1, 50\], got 0.5"),
        (lambda: PassesPowerLaw(1.0, 1.5), r"exponent must lie in \(0, 1\], got 1.5"),
        (lambda: PassesPowerLaw.asphalt(323.0), r"temperature must lie in \[5, 65\] °C"),
        (
            lambda: tl.materials.ElastoPlastic(tl.materials.Prony(1e9, ((0.5, 1.0),), 0.3), VonMises(1e8)),
            "must be an Elastic",
        ),
        (lambda: tl.materials.ElastoPlastic(tl.Elastic(1e9, 0.5), VonMises(1e8)), "give at most 0.49"),
        (lambda: tl.materials.ElastoPlastic(tl.Elastic(1e9, 0.3), 3), "the law must be VonMises"),
        (
            lambda: tl.materials.ElastoPlastic(ASPHALT, PassesPowerLaw(1, 0.5)).return_map(),
            "is not followed step by step",
        ),
    ],
)
def test_what_no_material_is_gets_a_sentence(make, words):
    with pytest.raises(tl.InputError, match=words) as caught:
        make()
    assert len(str(caught.value).splitlines()) == 1


def test_contact_and_response_take_the_elastic_part():
    law = tl.materials.MohrCoulomb(6e4, 0.6)
    plain, yielding = (
        tl.Pavement([tl.Layer(one, 0.05), tl.Layer(tl.Elastic(1e8, 0.35))])
        for one in (ASPHALT, tl.materials.ElastoPlastic(ASPHALT, law))
    )
    disc = tl.UniformDisc(0.1, 7e5)
    one, other = (tl.solve_response(disc, road, depths=[0.02], x=[0.0], y=[0.0]) for road in (plain, yielding))
    assert float(one.dataset.stress_zz[0, 0, 0]) == float(other.dataset.stress_zz[0, 0, 0])
    assert "layer 1 can yield, and this is the response of its elastic part" in other.summary()
    assert "can yield" not in one.summary()
    assert tl.Pavement([tl.Layer(tl.materials.ElastoPlastic(ASPHALT, law), 0.05), tl.Layer(ASPHALT)]).is_homogeneous


def test_a_case_reads_a_law_as_a_key_of_the_layer_or_with_the_material():
    from treadload.case.road import PavementPart

    law = {"kind": "mohr-coulomb", "cohesion": "60 kPa", "friction_angle": "35 deg"}
    elastic = {"modulus": "600 MPa", "poisson": 0.35}
    told = [
        {"material": elastic, "plasticity": law},
        {"material": {"kind": "elastoplastic", "elastic": elastic, "law": law}},
    ]
    made = [PavementPart.model_validate({"layers": [layer]}).build().layers[0].material for layer in told]
    assert made[0] == made[1]
    # Text becomes a number of fifteen digits.
    assert made[0] == tl.materials.ElastoPlastic(ASPHALT, MohrCoulomb(6e4, float(f"{math.radians(35):.15g}")))
