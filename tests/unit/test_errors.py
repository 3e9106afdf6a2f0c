"""Errors can be caught as what they are and as what they mean to Python."""

import math

import pytest

from treadload.errors import ConvergenceError, GeometryError, InputError, TreadloadError


@pytest.mark.parametrize(
    ("error", "family"), [(InputError, ValueError), (GeometryError, ValueError), (ConvergenceError, RuntimeError)]
)
def test_families(error, family):
    assert issubclass(error, TreadloadError)
    assert issubclass(error, family)


def test_convergence_error_carries_its_residual():
    assert ConvergenceError("stopped", 0.3).residual == 0.3
    assert math.isnan(ConvergenceError("stopped").residual)
    assert str(ConvergenceError("stopped", 0.3)) == "stopped"
