"""Images of layers: closed rectangle integrals against quadrature, fits against the compliance that they fit."""

import math

import numpy as np
import pytest

from treadload.kernels.layers.images import Images, coefficients, fit_images, surface_compliance
from treadload.kernels.layers.layered import Stack

INF = math.inf


def stack(moduli, poisson, thickness, springs=None, rigid=False):
    shear = [e * 1e6 / (2 * (1 + nu)) for e, nu in zip(moduli, poisson, strict=True)]
    return Stack(shear, poisson, [*thickness, INF], springs or [INF] * (len(shear) - 1), rigid)


STACKS = {
    "asphalt on soil": stack([7000, 9000, 120], [0.35] * 3, [0.06, 0.15]),
    "soft tack coat": stack([7000, 9000, 120], [0.35] * 3, [0.06, 0.15], [1e9, INF]),
    "hardly held": stack([7000, 9000, 120], [0.35] * 3, [0.06, 0.15], [1e6, INF]),
    "loose": stack([7000, 9000, 120], [0.35] * 3, [0.06, 0.15], [0.0, INF]),
    "inverted": stack([5000, 300, 15000, 80], [0.35, 0.35, 0.25, 0.35], [0.08, 0.12, 0.2]),
    "soft over stiff": stack([50, 5000], [0.45, 0.2], [0.1]),
    "rubber over concrete": stack([3, 30000], [0.5, 0.2], [0.01]),
    "thin on top": stack([3000, 10000, 200, 50], [0.35, 0.35, 0.35, 0.45], [0.002, 0.15, 0.3]),
    "six decades": stack([1e5, 0.1], [0.3, 0.45], [0.2]),
    "rock below": stack([100], [0.3], [0.1], rigid=True),
    "incompressible on rock": stack([100], [0.5], [0.1], rigid=True),
    "layers on rock": stack([5000, 300, 60], [0.35] * 3, [0.1, 0.3, 2.0], rigid=True),
    "a hundred layers": stack([1e3 * 1.03**i for i in range(100)] + [100], [0.35] * 101, [0.01] * 100),
}


@pytest.mark.parametrize("depth", [0.03, 0.5, 20.0])
def test_rectangle_integrals_are_closed(depth):
    n, c, t, d = 1.1, 0.6, 0.7, -0.4
    images = Images(*(np.array([value]) for value in (depth, n, c, t, d)), bonded=True, residual=0.0)
    dx, dy, shape = 0.013, 0.021, (4, 5)
    found = coefficients(images, *shape, dx, dy)
    nodes, weights = np.polynomial.legendre.leggauss(24)
    expected = np.empty_like(found)
    for j, i in np.ndindex(shape):
        x, y = dx * (i + nodes / 2)[None, :], dy * (j + nodes / 2)[:, None]
        root = np.sqrt(x**2 + y**2 + depth**2)
        over = root + depth
        v_xx, v_yy = -1 / over + x**2 / (root * over**2), -1 / over + y**2 / (root * over**2)
        v_xy = x * y / (root * over**2)
        by_p, along, across = c / (root * over), t / root - d * v_xx, t / root - d * v_yy
        fields = (n / root, along, across, -d * v_xy, by_p * x, by_p * y)
        expected[:, j, i] = [(np.outer(weights, weights) * f).sum() * dx * dy / 4 / (2 * np.pi) for f in fields]
    # Round-off of the corner sums far above the load: 1e-12 of the largest.
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize("name", STACKS)
def test_the_fit_holds_at_other_wavenumbers(name):
    layers = STACKS[name]
    images = fit_images(layers)
    # Measured: 4e-10 to 9e-7; the hardest are six decades of modulus and an incompressible layer on rock.
    assert images.residual < 1e-6
    rng = np.random.default_rng(1)
    first, total = layers.thickness[0], float(layers.interfaces[-1])
    k = np.sort(np.exp(rng.uniform(np.log(1e-2 / total), np.log(50 / first), 300)))
    whole = surface_compliance(k, layers)
    top = surface_compliance(k, Stack(layers.shear[:1], layers.poisson[:1], [], []))
    error = np.abs(images.at(k) + top - whole)
    # Below 0.1 % of the top layer's compliance, 1 % on rock, an error counts against that.
    floor = 1e-2 if layers.rigid else 1e-3
    assert (error[:2] / np.maximum(np.abs(whole[0]), floor * top[0])).max() < 2e-6
    if images.bonded:
        assert (error[2:] / np.maximum(np.abs(whole[2]), floor * top[2])).max() < 2e-6
    else:
        assert np.isnan(images.at(k)[2:]).all()


@pytest.mark.parametrize("name", [name for name, layers in STACKS.items() if not layers.rigid])
def test_long_waves_feel_the_half_space_below(name):
    layers = STACKS[name]
    images = fit_images(layers)
    top = (1 - layers.poisson[0]) / layers.shear[0]
    bottom = (1 - layers.poisson[-1]) / layers.shear[-1]
    assert images.normal.sum() + top == pytest.approx(bottom, rel=1e-6)


def test_on_rock_long_waves_feel_nothing_give_way():
    layers = STACKS["rock below"]
    images = fit_images(layers)
    top = (1 - layers.poisson[0]) / layers.shear[0]
    # Compliance falls with k; what is left at k = 0 is an error of the fit.
    assert abs(images.normal.sum() + top) < 1e-6 * top


def test_equal_layers_change_nothing():
    layers = stack([5400] * 3, [0.35] * 3, [0.06, 0.2])
    images = fit_images(layers)
    half_space = np.pi * layers.shear[0] / (1 - layers.poisson[0])
    # Round-off of the recursion, 1e-15, is fitted too.
    assert np.abs(images.at(np.geomspace(1e-2, 1e3, 50))).max() * half_space < 1e-12
    assert np.abs(coefficients(images, 50, 50, 3e-3, 3e-3)).max() * half_space < 1e-12 * 3e-3


def test_neighbouring_shapes_share_their_coefficients():
    images = fit_images(STACKS["asphalt on soil"])
    small, large = coefficients(images, 5, 7, 3e-3, 2e-3), coefficients(images, 40, 50, 3e-3, 2e-3)
    np.testing.assert_allclose(small, large[:, :5, :7], rtol=0, atol=1e-12 * np.abs(large).max())
