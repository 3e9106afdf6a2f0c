"""The nine functions of fading waves: against integrals over their wave vectors, their derivatives, their limits."""

import numpy as np
import pytest

from treadload.kernels.half_space.waves import POWERS, Waves

_RECTANGLE = (0.3, 1.1, -0.4, 0.9)
_REAL, _COMPLEX = 0.7, 0.6 + 0.4j


def _corners(part, z):
    """Alternating sums of A, its derivatives or its integral over a rectangle, (9,)."""
    x0, x1, y0, y1 = _RECTANGLE
    at = [getattr(Waves(x, y, z), part) for x, y in ((x1, y1), (x0, y0), (x0, y1), (x1, y0))]
    return at[0] + at[1] - at[2] - at[3]


def _summed(power, z):
    """(2π)⁻² ∬ kᵖ cosᵃ sinᵇ exp(i k·x - k Z) k dk dθ over the rectangle, k by hand, the rest by quadrature, (9,)."""
    points, weights = np.polynomial.legendre.leggauss(24)
    x0, x1, y0, y1 = _RECTANGLE
    x = 0.5 * (x1 - x0) * points + 0.5 * (x1 + x0)
    y = (0.5 * (y1 - y0) * points + 0.5 * (y1 + y0))[:, None]
    theta = 2 * np.pi * np.arange(300) / 300
    c, s = np.cos(theta), np.sin(theta)
    fades = z - 1j * (x[..., None] * c + y[..., None] * s)
    radial = np.prod(np.arange(1.0, power + 2)) / fades ** (power + 2)
    shares = np.outer(weights, weights) * 0.25 * (x1 - x0) * (y1 - y0)
    mean = np.einsum("yx,yxt->t", shares, radial) * (2 * np.pi / 300) / (2 * np.pi) ** 2
    return np.array([(mean * c**a * s**b).sum() for a, b in POWERS])


@pytest.mark.parametrize("z", [_REAL, _COMPLEX])
@pytest.mark.parametrize(("part", "power"), [("integrals", -1), ("values", 0), ("slopes", 1), ("curvatures", 2)])
def test_the_functions_are_the_integrals_of_their_waves(part, power, z):
    # F⁻¹ of cosᵃ sinᵇ exp(-k Z): -A of even powers, -i A of odd ones; each d/dZ is a factor -k.
    expected = -_corners(part, z) * np.array([1] * 5 + [1j] * 4) * (-1) ** power
    # 24 Gauss points a side and 300 angles leave 1e-12 of these smooth integrands.
    assert np.abs(_summed(power, z) - expected).max() < 1e-11 * np.abs(expected).max()


@pytest.mark.parametrize(
    ("whole", "slope"), [("integrals", "values"), ("values", "slopes"), ("slopes", "curvatures")]
)
def test_derivatives_follow_from_a_step_into_the_complex_plane(whole, slope):
    x, y, z = np.random.default_rng(1).uniform([[-2.0]] * 2 + [[0.05]], 2.0, (3, 200))
    step = 1e-20
    derivative = getattr(Waves(x, y, z + 1j * step), whole).imag / step
    # Round-off near edges, where differences of order (R / distance)² cancel.
    np.testing.assert_allclose(getattr(Waves(x, y, z), slope), derivative, rtol=1e-9, atol=1e-11)


def test_complex_depths_are_reached_without_a_jump():
    generator = np.random.default_rng(2)
    for x, y in generator.normal(size=(40, 2)):
        path = 10 ** generator.uniform(-3, 1) * np.exp(1j * np.linspace(0, 0.4999 * np.pi, 4000))
        at = Waves(x, y, path)
        # A branch missed is a jump of a half or more; steps of the path are a thousandth.
        assert np.abs(np.diff(at.values)).max() < 0.03
        np.testing.assert_allclose(Waves(x, y, path.conj()).values, at.values.conj(), rtol=1e-12, atol=1e-14)


def test_the_surface_is_the_limit_and_real_numbers_meet_complex_ones():
    x, y = np.array([0.4, -1.3, -0.6]), np.array([0.9, 0.2, -0.5])
    for part in ("values", "slopes", "integrals"):
        # What differs at 1e-12 is of that order.
        below = getattr(Waves(x, y, 1e-12), part)
        np.testing.assert_allclose(getattr(Waves(x, y, 0.0), part), below, atol=1e-10)
    z = np.array([0.3, 1e-3, 2.0])
    np.testing.assert_allclose(Waves(x, y, z + 0j).values, Waves(x, y, z).values, atol=1e-14)
    straight = Waves(0.0, 0.5, 0.3)
    assert np.isfinite([straight.values, straight.curvatures, straight.integrals]).all()
