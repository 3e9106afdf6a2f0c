"""Prony series: relaxation, creep, complex modulus, and what is refused."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.errors import InputError
from treadload.materials import Elastic, Prony

RUBBER = Prony(10e6, ((0.2, 1e-5), (0.3, 1e-2), (0.1, 1.0), (0.2, 1e4)), 0.49)


def test_limits():
    assert RUBBER.glassy == Elastic(10e6, 0.49)
    assert RUBBER.rubbery.modulus == pytest.approx(2e6)
    assert RUBBER.relaxation_modulus(0.0) == pytest.approx(10e6)
    assert RUBBER.relaxation_modulus(1e9) == pytest.approx(2e6)
    assert RUBBER.creep_compliance([0.0, 1e9]) * 1e6 == pytest.approx([0.1, 0.5])
    assert RUBBER.complex_modulus(0.0) == pytest.approx(2e6)
    assert RUBBER.complex_modulus(1e12) == pytest.approx(10e6, rel=1e-6)
    assert (RUBBER.complex_modulus(np.logspace(-6, 7, 40)).imag > 0).all()


shares = st.lists(st.floats(1e-4, 1.0), min_size=1, max_size=6)


@given(shares, st.floats(0.01, 1.0), st.floats(-8.0, 4.0), st.floats(0.3, 3.0))
@settings(max_examples=60, deadline=None)
def test_creep_is_the_inverse_of_relaxation(weights, relaxing, first, apart):
    weights = np.array(weights) * relaxing / sum(weights)
    material = Prony(1e6, tuple((g, 10 ** (first + apart * k)) for k, g in enumerate(weights)), 0.4)
    omega = np.logspace(first - 2, first + apart * len(weights) + 2, 30)
    terms = sum(f / (1 + 1j * omega * t) for f, t in material.creep_terms)
    creep = 1 + terms + material.fluidity / (1j * omega)
    # Round-off of the secular equation: what remains of the modulus loses the digits of 1 - Σg.
    np.testing.assert_allclose(creep * material.complex_modulus(omega) / 1e6, 1.0, rtol=1e-8)
    assert all(f > 0 for f, _ in material.creep_terms)
    if not material.is_fluid:
        back = Prony.from_creep(1e6, material.creep_terms, 0.4)
        np.testing.assert_allclose(back.terms, material.terms, rtol=1e-6)


def test_convolution_of_creep_and_relaxation_is_time():
    # ∫ E(t - s) J(s) ds = t for every pair of the two.
    t = 3.0
    nodes, weights = np.polynomial.legendre.leggauss(40)
    ends = t * np.concatenate([[0.0], np.logspace(-9, 0, 60)])
    total = 0.0
    for low, high in itertools.pairwise(ends):
        s = low + 0.5 * (high - low) * (1 + nodes)
        total += 0.5 * (high - low) * weights @ (RUBBER.relaxation_modulus(s) * RUBBER.creep_compliance(t - s))
    # J varies by 1e-5 s near s = t, which the panels do not follow: 1e-6 of t.
    assert total == pytest.approx(t, rel=2e-6)


def test_standard_linear_solid_and_its_creep():
    solid = Prony.standard_linear_solid(2e6, 1e6, 0.0045, 0.4)
    assert Prony.from_creep(2e6, ((1.0, 0.009),), 0.4).terms[0] == pytest.approx(solid.terms[0])


def test_a_maxwell_element_is_a_fluid():
    fluid = Prony(1e6, ((1.0, 0.1),), 0.5)
    assert fluid.is_fluid
    assert fluid.creep_terms == ()
    assert fluid.creep_compliance(1.0) == pytest.approx((1 + 10) / 1e6)
    with pytest.raises(InputError, match=r"0\.99"):
        _ = fluid.rubbery


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ((0.0, ((0.5, 1.0),), 0.4), "modulus"),
        ((1e6, ((0.5, 1.0),), 0.6), "poisson"),
        ((1e6, (), 0.4), "Elastic"),
        ((1e6, ((0.5, 0.0),), 0.4), "time"),
        ((1e6, ((-0.5, 1.0),), 0.4), "share"),
        ((1e6, ((0.7, 1.0), (0.7, 2.0)), 0.4), r"1\.4"),
        ((1e6, ((0.2, 1.0), (0.2, 1.0)), 0.4), "combine"),
        ((1e6, ((0.2,),), 0.4), "pairs"),
        ((1e6, ((float("nan"), 1.0),), 0.4), "nan"),
    ],
)
def test_bad_input(arguments, word):
    with pytest.raises(InputError, match=word):
        Prony(*arguments)


def test_long_term_modulus_below_the_instantaneous_one():
    with pytest.raises(InputError, match="long_term"):
        Prony.standard_linear_solid(1e6, 2e6, 0.1, 0.4)
