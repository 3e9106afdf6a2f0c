"""Soft spheres and voids half a radius below the surface, beside axisymmetric finite elements."""

import pytest

from axisymmetric import mean_strain_of_a_sphere
from treadload.validation.stones import NEAR_SOFT, NEAR_VOID, near_the_surface


@pytest.mark.parametrize(("contrast", "exact"), [(0.0, NEAR_VOID), (0.1, NEAR_SOFT)])
def test_elements_that_fit_plane_and_sphere_converge(contrast, exact):
    coarse, fine = (mean_strain_of_a_sphere(1.5, 0.3, contrast, 20 * n, 60 * n, 10 * n) for n in (1, 2))
    for first, second, known in zip(coarse, fine, exact, strict=True):
        # Of second order: what is left after it is taken away, of elements four times as large as the numbers.
        assert (4 * second - first) / 3 == pytest.approx(known, rel=0.004)


@pytest.mark.slow
@pytest.mark.parametrize("contrast", [0.0, 0.1])
def test_elements_deep_below_the_surface_are_eshelby(contrast):
    volume, shape = 1.3 / 2.1, 2 * (4 - 5 * 0.3) / (15 * 0.7)
    exact = 0.8 / 3 / (1 + (contrast - 1) * volume) + 1.3 / 3 / (1 + (contrast - 1) * shape)
    coarse, fine = (mean_strain_of_a_sphere(6.0, 0.3, contrast, 40 * n, 120 * n, 20 * n)[0] for n in (1, 2))
    # Six radii deep the surface changes it by some 0.2 %.
    assert (4 * fine - coarse) / 3 == pytest.approx(exact, rel=0.005)


@pytest.mark.parametrize(("contrast", "exact"), [(0.0, NEAR_VOID), (0.1, NEAR_SOFT)])
def test_eight_cells_a_radius_near_the_surface(contrast, exact):
    # Measured: 2.1 and 1.3 % for a void, 0.5 and 2.0 % for a tenth; steps of cells fall slowly, 3.0 % with 4 cells.
    assert near_the_surface(contrast, 8) == pytest.approx(exact, rel=0.03)
