"""Zero-padded convolution against the sum it stands for."""

import tracemalloc

import numpy as np
import pytest

from treadload.kernels.gridding.convolution import Convolution, Padding

SHAPES = [((1, 1), (1, 1)), ((1, 7), (1, 7)), ((5, 8), (5, 8)), ((4, 6), (7, 3)), ((6, 3), (2, 9))]


def direct(kernel, load, field_shape, dx, dy, x0, y0):
    """Σ kernel(x_field - x_load, y_field - y_load) · load, cell by cell."""
    (ny, nx), (my, mx) = load.shape, field_shape
    field = np.zeros(field_shape)
    for j in range(my):
        for i in range(mx):
            for q in range(ny):
                for p in range(nx):
                    field[j, i] += kernel(x0 + dx * (i - p), y0 + dy * (j - q)) * load[q, p]
    return field


def sampled(padding, kernel, dx=1.0, dy=1.0, x0=0.0, y0=0.0):
    """The operator of a kernel of the distances field cell minus load cell, wrapped round; no pair has the others."""
    wrapped = []
    for loads, fields, n in zip(padding.load_shape, padding.field_shape, padding.shape, strict=True):
        offsets = np.full(n, 3.0)
        offsets[:fields] = np.arange(fields)
        offsets[n - loads + 1 :] = np.arange(1 - loads, 0)
        wrapped.append(offsets)
    y, x = wrapped
    return Convolution(padding, padding.spectrum(kernel(x0 + dx * x[None, :], y0 + dy * y[:, None])))


def lopsided(x, y):
    return np.exp(-0.3 * x + 0.1 * y) * np.cos(x * y) + 0.2 * x


@pytest.mark.parametrize(("load_shape", "field_shape"), SHAPES)
def test_equals_the_direct_sum(load_shape, field_shape):
    dx, dy, x0, y0 = 0.5, 0.8, 0.3, -1.1
    load = np.random.default_rng(2).normal(size=load_shape)
    padding = Padding.of(load_shape, field_shape)
    operator = sampled(padding, lopsided, dx, dy, x0, y0)
    expected = direct(lopsided, load, field_shape, dx, dy, x0, y0)
    # Round-off of two transforms of fewer than 300 numbers.
    np.testing.assert_allclose(operator(load), expected, atol=1e-13 * np.abs(expected).max() + 1e-14)


@pytest.mark.parametrize("parity", [(1, 1), (-1, 1), (1, -1), (-1, -1)])
def test_wrap_gives_the_other_quadrants_by_parity(parity):
    ny, nx = 4, 5
    px, py = parity

    def kernel(x, y):
        even = 1 / (1 + x**2 + 2 * y**2)
        return even * (x if px < 0 else 1.0) * (y if py < 0 else 1.0)

    padding = Padding.of((ny, nx))
    ky, kx = padding.quadrant
    quadrant = kernel(np.arange(kx)[None, :], np.arange(ky)[:, None])
    operator = Convolution(padding, padding.spectrum(padding.wrap(quadrant, px, py)))
    if px == py:
        # Even in both or odd in both: the spectrum is real.
        np.testing.assert_allclose(operator.spectrum.imag, 0, atol=1e-14)
    load = np.random.default_rng(3).normal(size=(ny, nx))
    expected = direct(kernel, load, (ny, nx), 1.0, 1.0, 0.0, 0.0)
    np.testing.assert_allclose(operator(load), expected, atol=1e-13)


def test_a_stack_of_loads_goes_through_at_once():
    padding = Padding.of((3, 4))
    loads = np.random.default_rng(5).normal(size=(2, 3, 4))
    together = padding.inverse(padding.forward(loads))
    np.testing.assert_allclose(together, loads, atol=1e-15)


def test_the_spectrum_of_an_even_kernel_is_that_of_all_its_quadrants():
    padding = Padding.of((7, 5), (6, 9))
    quadrant = np.random.default_rng(6).normal(size=padding.quadrant)
    whole = padding.spectrum(padding.wrap(quadrant))
    np.testing.assert_allclose(padding.even_spectrum(quadrant), whole, atol=1e-13)


@pytest.mark.parametrize("shape", [(7, 9), (1, 4), (3, 1), (20, 12)])
def test_the_spectrum_of_an_odd_kernel_is_that_of_all_its_quadrants(shape):
    padding = Padding.of(shape)
    quadrant = np.random.default_rng(0).normal(size=padding.quadrant)
    quadrant[0], quadrant[:, 0] = 0.0, 0.0
    whole = padding.spectrum(padding.wrap(quadrant, -1, -1))
    np.testing.assert_allclose(padding.odd_spectrum(quadrant), whole, atol=1e-13)


def test_single_precision_stays_single():
    padding = Padding.of((30, 40))
    quadrant = 1 / (1 + np.hypot(*np.indices(padding.quadrant)))
    load = np.random.default_rng(7).random((30, 40))
    exact = Convolution(padding, padding.even_spectrum(quadrant))(load)
    field = Convolution(padding, padding.even_spectrum(quadrant.astype(np.float32)))(load.astype(np.float32))
    assert field.dtype == np.float32
    # A transform loses a few units of the last place of the largest number: 1.2e-7.
    np.testing.assert_allclose(field, exact, atol=1e-6 * exact.max())


def test_the_padded_space_is_never_there_as_a_whole():
    n = 1400
    padding = Padding.of((n, n))
    operator = Convolution(padding, padding.even_spectrum(np.ones(padding.quadrant)))
    load = np.ones((n, n))
    tracemalloc.start()
    operator(load)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # The field, its waves along x (as much as two fields), and some 2^17 numbers at a time.
    assert peak < 3.7 * load.nbytes
    # The padded space alone is four fields.
    assert np.prod(padding.shape) * load.itemsize >= 4 * load.nbytes
