"""Fields of bilinear loads: against averages of uniform cells, near and far, on lattices and at points."""

import numpy as np
import pytest

from bilinear_loads import bilinear_on_grid
from treadload.kernels.half_space import bilinear
from treadload.kernels.half_space.bilinear import bilinear_spectrum
from treadload.kernels.half_space.corners import at_nodes
from treadload.kernels.half_space.corners import fields as fields_of
from treadload.kernels.half_space.interior import fields_on_grid

DX, DY, SHEAR, NU = 0.003, 0.004, 2e9, 0.35
LOAD = np.random.default_rng(5).random((3, 4, 5)) * 1e6


def fields(x, y, depth, load=LOAD):
    stress, displacement, _ = bilinear_on_grid(load, DX, DY, np.array([depth]), SHEAR, NU, x, y)
    return np.concatenate([stress[0], displacement[0] * SHEAR / DX])


def averaged(x, y, depth, load=LOAD):
    """The same at one point by Gauss quadrature of uniform cells over a window, split where a cell ends."""
    px, wx = window(x, DX)
    py, wy = window(y, DY)
    at = np.array([depth])
    stress, displacement, _ = fields_on_grid(load, DX, DY, at, SHEAR, NU, px, py, method="direct")
    return np.einsum("cji,j,i->c", np.concatenate([stress[0], displacement[0] * SHEAR / DX]), wy, wx)


def window(centre, size):
    # The edge of a cell inside the window, or the window's own end.
    edge = (np.floor(centre / size) + 0.5) * size
    t, w = np.polynomial.legendre.leggauss(24)
    low, high = centre - size / 2, centre + size / 2
    parts = [(a, b) for a, b in ((low, edge), (edge, high)) if b - a > 1e-9 * size]
    return (
        np.concatenate([(a + b) / 2 + (b - a) / 2 * t for a, b in parts]),
        np.concatenate([(b - a) / 2 * w / size for a, b in parts]),
    )


@pytest.mark.parametrize("depth", [0.1 * DX, 0.5 * DX, 2 * DX, 10 * DX, 40 * DX])
@pytest.mark.parametrize(("x", "y"), [(2 * DX, DY), (2.25 * DX, 0.4 * DY), (-7.3 * DX, 3 * DY), (60 * DX, 11.2 * DY)])
def test_the_field_is_that_of_uniform_cells_averaged_over_one(depth, x, y):
    # 24 points a side resolve what happens over a tenth of a cell to 1e-7; deeper it is round-off of 1e6.
    tolerance = 1e-7 if depth < 0.3 * DX else 1e-11
    found = fields(np.array([x]), np.array([y]), depth)[:, 0, 0]
    np.testing.assert_allclose(found, averaged(x, y, depth), atol=tolerance * 1e6)


@pytest.mark.parametrize(("x", "y"), [(-7.25 * DX, 3.25 * DY), (30.4 * DX, 2.2 * DY)])
def test_the_surface_away_from_the_load_likewise(x, y):
    # Nothing singular in the window: round-off.
    found = fields(np.array([x]), np.array([y]), 0.0)[:, 0, 0]
    np.testing.assert_allclose(found, averaged(x, y, 0.0), atol=1e-11 * 1e6)


@pytest.mark.parametrize("method", ["direct", "fft"])
def test_far_rows_between_the_centres_are_like_their_neighbours(method):
    """There the edge of a cell lies in line with the point, and its logarithm is infinite."""
    one = np.ones((3, 1, 1))
    x, y = DX * np.array([60.0, 61.0]), DY * np.array([0.5, 0.5 + 1e-6, 40.5, 40.5 + 1e-6])
    x, y = (x, y) if method == "direct" else (y / DY * DX, x / DX * DY)
    found = bilinear_on_grid(one, DX, DY, np.zeros(1), SHEAR, NU, x, y, method)[0]
    pairs = found if method == "direct" else found.swapaxes(-1, -2)
    # The field is 5e-5 here and changes over the distance of a cell by a sixtieth: 1e-12 over a millionth.
    np.testing.assert_allclose(pairs[..., ::2, :], pairs[..., 1::2, :], atol=5e-12)


def test_the_surface_is_the_limit_from_below():
    x, y = DX * np.array([0.0, 1.0, 1.3, 4.9]), DY * np.array([0.5, 2.0, 3.7])
    at, near = fields(x, y, 0.0), fields(x, y, 1e-7 * DX)
    # The load is continuous; its slope jumps, which gives z ln z: 1.6e-6 of the load.
    np.testing.assert_allclose(near, at, atol=5e-6 * 1e6)


def test_the_surface_carries_the_interpolated_load():
    x, y = DX * np.array([-1.2, -0.5, 0.0, 1.25, 3.0, 4.5]), DY * np.array([-0.3, 2.0, 2.6])
    hats = [np.maximum(0, 1 - np.abs(at[:, None] / size - np.arange(n))) for at, size, n in ((x, DX, 5), (y, DY, 4))]
    expected = np.einsum("ji,kil,ml->kjm", hats[1], LOAD, hats[0])
    # Round-off of differences.
    np.testing.assert_allclose(-fields(x, y, 0.0)[[2, 4, 5]], expected, atol=1e-8)


def test_differences_and_averages_agree_where_they_take_turns():
    """Both ways to evaluate one kernel around their border."""
    one = np.zeros((3, 1, 1))
    one[:] = 1.0
    x = DX * np.linspace(24, 40, 9)
    for depth in (0.0, 0.3 * DX, 5 * DX):
        far = fields(x, np.array([0.0]), depth, one)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(bilinear, "_NEAR", 1000)
            exact = fields(x, np.array([0.0]), depth, one)
        # Round-off of differences at 40 cells; the fields there are 1e-4 (stress) and 1e-2 (displacement).
        np.testing.assert_allclose(far[:6], exact[:6], atol=2e-12)
        np.testing.assert_allclose(far[6:], exact[6:], atol=5e-11)


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 1e-18, reason="long doubles are doubles here")
def test_extended_precision_finds_the_same_in_square_and_long_cells():
    one, at = np.ones((3, 1, 1)), np.array([0.2, 0.5, 3.3, 10.2, 23.0, 30.0, 50.0])
    for dx, dy, tolerance in ((0.003, 0.003, 1e-12), (0.003, 0.2, 2e-11)):
        x, y = max(dx, dy) * at, max(dx, dy) * np.array([0.0, 0.37, 5.0])
        for depth in (0.0, 0.001, 0.01):
            stress, moved, _ = bilinear_on_grid(one, dx, dy, np.array([depth]), 1.0, NU, x, y)
            exact = np.array([[extended(i, j, dx, dy, depth) for i in x] for j in y]).transpose(2, 0, 1)
            # Round-off: (24 cells)² over dx dy of 1e-16 in stress, by 24 cells more in displacement.
            np.testing.assert_allclose(stress[0], exact[:6], atol=tolerance)
            np.testing.assert_allclose(moved[0], exact[6:], atol=60 * tolerance * np.sqrt(dx * dy))


def extended(x, y, dx, dy, depth):
    """The nine fields at one point under one cell, by differences of G in the 19 digits of long doubles."""
    number = np.longdouble
    at_x, at_y = number(x) + number(dx) * np.arange(-1, 2), number(y) + number(dy) * np.arange(-1, 2)
    functions = at_nodes(at_x[None, None, :], at_y[None, :, None], number(depth), number(dx), number(dy))
    fields = np.zeros(9)
    for values, uses in fields_of(functions, number(NU)):
        kernel = np.diff(np.diff(values, 2, axis=1), 2, axis=2) / (number(dx) * number(dy))
        for _, component in uses:
            fields[component] += float(kernel[0, 0, 0])
    return fields


def test_weights_average_polynomials_over_a_window():
    weights, at = bilinear._window_average(), np.arange(-4, 5)
    # ∫ s⁸ over (-1/2, 1/2) = 1 / (9·2⁸); round-off of 4⁸.
    assert weights @ at**8 == pytest.approx(1 / (9 * 256), abs=1e-11)
    assert weights.sum() == pytest.approx(1, abs=1e-14)


@pytest.mark.parametrize("depth", [0.0, 0.002])
def test_lattices_and_points_give_the_same(depth):
    rng = np.random.default_rng(2)
    load = rng.random((3, 40, 35))
    x, y = DX * (np.arange(60) - 12.4), DY * (np.arange(50) - 5.0)
    stress, displacement, method = bilinear_on_grid(load, DX, DY, np.array([depth]), SHEAR, NU, x, y)
    assert method == "fft"
    for i, j in ((0, 0), (17, 20), (59, 31)):
        at = x[i : i + 1], y[j : j + 1]
        one, moved, method = bilinear_on_grid(load, DX, DY, np.array([depth]), SHEAR, NU, *at)
        assert method == "direct"
        # Round-off of a transform of 1400 loads.
        np.testing.assert_allclose(stress[0, :, j, i], one[0, :, 0, 0], atol=1e-10)
        np.testing.assert_allclose(displacement[0, :, j, i] * SHEAR, moved[0, :, 0, 0] * SHEAR, atol=1e-11)


def test_no_load_is_no_field():
    stress, displacement, method = bilinear_on_grid(
        np.zeros((3, 2, 2)), DX, DY, np.zeros(1), SHEAR, NU, np.zeros(1), np.zeros(1)
    )
    assert method == "none"
    assert not stress.any()
    assert not displacement.any()


def test_the_spectrum_is_the_transform_of_the_hats():
    kx, ky = np.array([1.0, 120.0, 700.0]), np.array([3.0, 400.0])
    even, odd = bilinear_spectrum(LOAD, DX, DY, 0.01, -0.02)(kx, ky)
    # Gauss over each half of each hat.
    t, w = np.polynomial.legendre.leggauss(12)
    s, w = np.concatenate([-0.5 + t / 2, 0.5 + t / 2]), np.concatenate([w, w]) / 2

    def hat(k, centres, size):
        wave = np.exp(-1j * k[:, None, None] * (centres[:, None] + size * s))
        return (wave * (1 - np.abs(s)) * w).sum(axis=2) * size

    expected = np.einsum(
        "jm,cmn,in->cji", hat(ky, -0.02 + DY * np.arange(4), DY), LOAD, hat(kx, 0.01 + DX * np.arange(5), DX)
    )
    # Round-off.
    np.testing.assert_allclose(even + odd, expected, rtol=1e-11, atol=1e-9)
