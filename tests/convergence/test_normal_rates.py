"""Rates of normal contact, and iterations that do not grow with the grid."""

import tracemalloc

import numpy as np
import pytest

from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.closed_forms import hertz
from treadload.validation.patches import paraboloid
from treadload.validation.pressing import grooved_tire

BODIES = CombinedElasticity(1e6, 0.4, 0.0)
CELLS = (16, 32, 64, 128)


@pytest.mark.parametrize("radii", [(0.5, 0.5), (2.0, 0.5)])
def test_hertz(radii):
    exact = hertz(*radii, 500.0, BODIES.contact_modulus)
    errors = []
    for n in CELLS:
        patch = paraboloid(BODIES, radii, exact.load, (n + 6, n + 6), (2 * exact.a / n, 2 * exact.b / n))
        errors.append((patch.normal.approach / exact.approach - 1, patch.normal.pressure.max() / exact.peak - 1))
    approach, peak = np.abs(errors).T
    for error in (approach, peak):
        rates = np.log2(error[:-1] / error[1:])
        # Second order; the staircase of the rim leaves up to 0.4.
        assert (rates > 1.6).all(), rates
        assert np.log2(error[0] / error[-1]) / (len(CELLS) - 1) == pytest.approx(2, abs=0.15)


def test_hertz_pressure_field():
    """Mean error over the disc: order 3/2, of the square root at the rim."""
    exact = hertz(0.5, 0.5, 500.0, BODIES.contact_modulus)
    errors = []
    for n in CELLS:
        patch = paraboloid(BODIES, (0.5, 0.5), exact.load, (n + 6, n + 6), (2 * exact.a / n, 2 * exact.a / n))
        error = np.abs(patch.normal.pressure - exact.pressure(patch.x[None, :], patch.y[:, None]))
        errors.append(error.sum() * patch.cell / exact.load)
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > 1.2).all(), rates


def test_iterations_on_a_grooved_tire_stay_flat():
    counts = [grooved_tire(cells).iterations for cells in (64, 128, 256)]
    assert max(counts) <= 30
    # Sixteen times the cells, at most twice the iterations.
    assert counts[-1] <= 2 * counts[0]


@pytest.mark.slow
@pytest.mark.parametrize("cells", [512, 1024])
def test_iterations_on_a_fine_grooved_tire(cells):
    assert grooved_tire(cells).iterations <= 30


def test_products_on_a_grooved_tire():
    """One before, one after, a few for cells that left: 17 to 19 on each grid before single precision came in."""
    for cells in (64, 128, 256):
        found = grooved_tire(cells)
        assert found.products <= 16
        assert found.residual <= 1e-6


def test_memory_grows_with_the_cells_and_no_faster():
    """4096 x 4096 cells within 8 GB are 512 bytes a cell; a fine grid in single precision needs a third of it."""
    used = []
    for cells in (256, 512):
        tracemalloc.start()
        grooved_tire(cells)
        used.append(tracemalloc.get_traced_memory()[1] / cells**2)
        tracemalloc.stop()
    assert max(used) < 200
    assert used[1] <= 1.05 * used[0]
