"""Elastic: its moduli and its bounds."""

import math

import pytest

from treadload.errors import InputError
from treadload.materials import Elastic


def test_shear_modulus():
    assert Elastic(3e6, 0.5).shear_modulus == pytest.approx(1e6)
    assert Elastic(5.4e9, 0.35).shear_modulus == pytest.approx(2e9)


def test_equal_when_its_numbers_are():
    assert Elastic(1e6, 0.3) == Elastic(1e6, 0.3)
    assert hash(Elastic(1e6, 0.3)) == hash(Elastic(1e6, 0.3))
    assert Elastic(1e6, 0.3) != Elastic(1e6, 0.31)
    assert "5400 MPa" in str(Elastic(5.4e9, 0.35))


@pytest.mark.parametrize("modulus", [0.0, -1.0, math.nan, math.inf])
def test_modulus_must_be_positive(modulus):
    with pytest.raises(InputError, match="modulus"):
        Elastic(modulus, 0.3)


@pytest.mark.parametrize("poisson", [-1.0, 0.51, math.nan])
def test_poisson_has_bounds(poisson):
    with pytest.raises(InputError, match="poisson"):
        Elastic(1e6, poisson)


@pytest.mark.parametrize("poisson", [0.5, 0.0, -0.99])
def test_poisson_within_bounds(poisson):
    assert Elastic(1e6, poisson).poisson == poisson


def test_a_modulus_whose_inverse_is_no_number_is_refused():
    # The smallest number has half of itself at zero: its shear modulus was zero, and contacts divided by it.
    with pytest.raises(InputError, match="below 1e-300 Pa"):
        Elastic(5e-324, 0.45)
    assert Elastic(1e-300, 0.5).shear_modulus > 0
