"""Normal contact against Hertz and the flat punch."""

import numpy as np
import pytest

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.closed_forms import hertz, hertz_of_axes
from treadload.validation.patches import LONG, centres, cylinder, paraboloid

BODIES = CombinedElasticity.of(1.2e6, 0.45, 3e9, 0.3)
ACROSS = 64


def solved(exact, across=ACROSS, tolerance=1e-8):
    spacing = 2 * exact.a / across, 2 * exact.b / across
    return paraboloid(
        BODIES, (exact.radius_x, exact.radius_y), exact.load, (across + 8,) * 2, spacing, tolerance=tolerance
    )


@pytest.mark.parametrize("radii", [(0.5, 0.5), (2.0, 0.5), (0.5, 2.0), (0.3, 0.36), (5.0, 0.5)])
def test_hertz_ellipse(radii):
    exact = hertz(*radii, 2e3, BODIES.contact_modulus)
    assert exact.load == pytest.approx(2e3)
    patch = solved(exact)
    # The house's bounds at 64 cells across; measured 5e-5 and 2.1e-4.
    assert patch.normal.approach == pytest.approx(exact.approach, rel=1e-3)
    assert patch.normal.pressure.max() == pytest.approx(exact.peak, rel=5e-3)
    expected = exact.pressure(patch.x[None, :], patch.y[:, None])
    # The rim's square root over half a cell: √(2·1/64) of the peak at worst, in one cell a row.
    assert np.abs(patch.normal.pressure - expected).max() < 0.1 * exact.peak
    inner = expected > 0.5 * exact.peak
    assert np.abs(patch.normal.pressure - expected)[inner].max() < 1e-3 * exact.peak
    # Counting cells is good to about half a cell on the rim.
    area = patch.contact.sum() * patch.cell
    assert area == pytest.approx(np.pi * exact.a * exact.b, rel=0.02)


def test_hertz_far_apart_curvatures_tend_to_the_strip():
    """a/b → 0: the pressure across the short axis is that of a cylinder of the same load per length."""
    exact = hertz_of_axes(0.01, 2.0, 100.0, BODIES.contact_modulus)
    line = 4 / np.pi * exact.load * 3 / (4 * exact.b) * np.pi / 4  # N/m in the middle: P' = π a p0 / 2
    assert np.pi * exact.a * exact.peak / 2 == pytest.approx(line)
    strip = np.sqrt(4 * line * exact.radius_x / (np.pi * BODIES.contact_modulus))
    # The next term is of order (a/b)² ln(a/b) = 1e-4.
    assert exact.a == pytest.approx(strip, rel=1e-3)


def test_hertz_both_ways():
    one = hertz(1.7, 0.4, 500.0, 2e6)
    two = hertz_of_axes(one.a, one.b, 500.0, 2e6)
    assert (two.radius_x, two.radius_y, two.peak, two.approach) == pytest.approx((1.7, 0.4, one.peak, one.approach))


def test_hertz_cylinder():
    # p0 = E* a / 2R and P' = π a p0 / 2 for a = 1 mm, R = 100 mm.
    peak = BODIES.contact_modulus * 1e-3 / 0.2
    patch = cylinder(BODIES, 0.1, np.pi * 1e-3 * peak / 2, 72, 2e-3 / 64, LONG * 1e-3)
    pressure = patch.normal.pressure[0]
    assert pressure.max() == pytest.approx(peak, rel=5e-4)
    inner = np.abs(patch.x) < 0.9e-3
    expected = peak * np.sqrt(1 - (patch.x[inner] / 1e-3) ** 2)
    assert np.abs(pressure[inner] - expected).max() < 5e-3 * peak


def test_the_middle_of_five_long_rows_is_a_strip():
    """The row that makes a strip is no trick of one row: with neighbours, the middle one says the same."""
    peak = BODIES.contact_modulus * 1e-3 / 0.2
    load = np.pi * 1e-3 * peak / 2
    x = centres(56, 2e-3 / 48)
    influence = Influence((5, x.size), 2e-3 / 48, 0.2, HalfSpaces(BODIES))
    gap = np.tile(x**2 / 0.2, (5, 1))
    five = solve_normal(influence, gap, load=load, tolerance=1e-10)
    # The ends carry more; the middle row, 0.1 m from its neighbours' ends, is a strip under its own share.
    share = five.pressure[2].sum() * 2e-3 / 48
    own = cylinder(BODIES, 0.1, share, 56, 2e-3 / 48, LONG * 1e-3).normal.pressure[0]
    assert share == pytest.approx(load, rel=0.1)
    # The ends disturb it by (a/0.1 m)² = 1e-4 of the peak.
    assert np.abs(five.pressure[2] - own).max() < 1e-3 * peak


@pytest.mark.parametrize("cells", [20, 40])
def test_flat_circular_punch(cells):
    """δ = P / 2aE* and p = P / (2πa² √(1 - r²/a²)): Johnson (1985), section 3.4."""
    dx = 2.0 / cells
    x = centres(cells + 2, dx)
    r = np.hypot(x[None, :], x[:, None])
    influence = Influence((x.size, x.size), dx, dx, HalfSpaces(BODIES))
    found = solve_normal(influence, np.where(r < 1, 0.0, np.nan), load=1e3)
    area = (r < 1).sum() * dx**2
    a = np.sqrt(area / np.pi)
    # Cells at a singular edge: first order, 2 % with 20 across.
    assert found.approach == pytest.approx(1e3 / (2 * a * BODIES.contact_modulus), rel=0.4 / cells)
    middle = r < 0.5
    expected = 1e3 / (2 * np.pi * a**2 * np.sqrt(1 - (r[middle] / a) ** 2))
    np.testing.assert_allclose(found.pressure[middle], expected, rtol=1.0 / cells)
