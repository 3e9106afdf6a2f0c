"""Gridded loads on layers by wavenumbers: the closed form, the wave frame's own synthesis, the rule of panels."""

import math
from dataclasses import replace

import numpy as np
import pytest

from bilinear_loads import bilinear_on_grid
from treadload.kernels.half_space.interior import fields_on_grid
from treadload.kernels.layers import synthesis
from treadload.kernels.layers.layered import Stack, transfer
from treadload.kernels.layers.moving import Body, Level, Path, moving_fields
from treadload.kernels.layers.synthesis import FULL, READING, Cells, ElasticPlane, rule, synthesise_cells
from treadload.kernels.layers.wavenumbers import cells_spectrum, quadrature

ALONE = Stack([2e9], [0.35], [], [])
LAYERS = Stack([3e9, 1e8, 2e7], [0.35, 0.5, 0.4], [0.08, 0.3], [1e9, math.inf])
DEPTHS = np.array([0.05, 0.2, 0.7])
X, Y = np.array([-0.1, 0.0, 0.13]), np.array([-0.07, 0.02])
LOAD = np.random.default_rng(1).uniform(0, 1e6, (3, 4, 5))


def cells(load=LOAD, x0=-0.06, y0=-0.03):
    return Cells(load, 0.03, 0.02, x0, y0)


def plane(stack, depth, fall=36.0):
    def kernels(k):
        result = transfer(k, stack, [depth], [False])
        return result.plane[0], result.transverse[0]

    layer = stack.layer_at(depth, False)
    return ElasticPlane(kernels, stack.shear[layer], stack.poisson[layer], fall / depth)


def solved(loads, stack, depths=DEPTHS, x=X, y=Y, accuracy=FULL):
    nodes = rule(36 / depths.min(), 0.3, 2.0, accuracy)
    planes = [plane(stack, z, 36.0 if accuracy is FULL else accuracy.fall) for z in depths]
    return synthesise_cells([loads], planes, [(0, k) for k in range(len(planes))], x, y, nodes, nodes)


def close(found, exact, tolerance):
    for rows in (slice(0, 6), slice(6, 9)):
        np.testing.assert_allclose(
            found[:, rows], exact[:, rows], atol=tolerance * np.abs(exact[:, rows]).max(), rtol=0
        )


@pytest.mark.parametrize("parts", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)])
def test_cells_in_a_half_space_are_the_closed_form(parts):
    load = LOAD * np.array(parts)[:, None, None]
    stress, moved, _ = fields_on_grid(load, 0.03, 0.02, DEPTHS, 2e9, 0.35, X + 0.06, Y + 0.03)
    # What the quadrature leaves of displacement, which falls as 1/k; the issue asks for 1e-8.
    close(solved([cells(load)], ALONE), np.concatenate([stress, moved], axis=1), 2e-9)


@pytest.mark.parametrize(("count_x", "count_y"), [(5, 4), (4, 5), (1, 3)])
def test_points_on_both_sides_alike_have_the_values_of_any_points(count_x, count_y):
    """They are added up on one side; one more point, which breaks the symmetry, is not folded."""
    x, y = (0.04 * (np.arange(count) - 0.5 * (count - 1)) for count in (count_x, count_y))
    folded = solved([cells()], LAYERS, x=x, y=y)
    whole = solved([cells()], LAYERS, x=np.append(x, 0.17), y=np.append(y, 0.19))
    close(folded, whole[..., :-1, :-1], 1e-13)


def test_bilinear_loads_in_a_half_space_are_the_closed_form():
    load = Cells(LOAD, 0.03, 0.02, -0.06, -0.03, 2)
    stress, moved, _ = bilinear_on_grid(LOAD, 0.03, 0.02, DEPTHS, 2e9, 0.35, X + 0.06, Y + 0.03)
    close(solved([load], ALONE), np.concatenate([stress, moved], axis=1), 2e-9)


def test_layers_by_the_fields_in_the_wave_frame():
    limit = 36 / DEPTHS.min()
    moduli = [2 * (1 + nu) * shear for shear, nu in zip(LAYERS.shear, LAYERS.poisson, strict=True)]
    body = Body(moduli, LAYERS.poisson, LAYERS.thickness, LAYERS.spring)
    levels = [Level(z, LAYERS.layer_at(z, False), False) for z in DEPTHS]
    spectrum = cells_spectrum(LOAD, 0.03, 0.02, -0.06, -0.03)
    path, across = Path.of(limit, (-0.075, 0.075), 2.0), quadrature(limit, 0.3, 2.0)
    exact = moving_fields([spectrum], body, levels, limit, X, Y, path, across)[:, :9]
    # Another rule, other unknowns, no table and no derivative taken on the way back.
    close(solved([cells()], LAYERS), exact, 2e-9)


def test_loads_add_up_and_blocks_change_nothing(monkeypatch):
    whole = solved([cells(), cells(2 * LOAD, 0.05)], LAYERS)
    monkeypatch.setattr(synthesis, "_BLOCK", 3000)
    parts = solved([cells()], LAYERS) + solved([cells(2 * LOAD, 0.05)], LAYERS)
    # Round-off of sums in another order.
    close(whole, parts, 1e-11)


def test_pressure_alone_takes_the_short_way_to_the_same():
    load = LOAD * np.array([1.0, 0, 0])[:, None, None]
    # A shear that is not zero but nothing takes the long way.
    almost = load + np.array([0, 1e-200, 0])[:, None, None]
    close(solved([cells(load)], LAYERS), solved([cells(almost)], LAYERS), 1e-13)


def test_the_rule_integrates_what_is_singular_at_zero_and_what_turns():
    points, weights = rule(40.0, 2.0, 2.0)
    assert weights.sum() == pytest.approx(40, rel=1e-12)
    kx, ky = np.meshgrid(points, points)
    k = np.hypot(kx, ky)
    # ∬ over the plane of exp(-k) cos(kx) / k is 2π / √2; the square around zero is taken by Gauss.
    found = 4 * (np.outer(weights, weights) * np.exp(-k) * np.cos(kx) / k).sum()
    assert found == pytest.approx(2 * np.pi / np.sqrt(2), rel=1e-7)
    for reach in (0.3, 2.0, 30.0):
        points, weights = rule(300.0, reach, max(reach, 2.0))
        turning = (weights * np.cos(points * reach)).sum()
        # Exactly sin(kr) / r: 1e-10 a panel, some tens of panels.
        assert turning == pytest.approx(np.sin(300 * reach) / reach, abs=1e-9 * 300)


def test_panels_of_a_rule_converge():
    exact = solved([cells()], LAYERS)
    errors = []
    for fewer in (5, 3, 1):
        few = replace(FULL, usual_points=FULL.usual_points - fewer)
        error = np.abs(solved([cells()], LAYERS, accuracy=few) - exact)[:, :6].max()
        errors.append(float(error / np.abs(exact[:, :6]).max()))
    # Each point takes a factor of 2.5² = 6; 3 is asserted.
    assert errors[1] < errors[0] / 9
    assert errors[2] < max(errors[1] / 9, 1e-11)


@pytest.mark.parametrize("stack", [LAYERS, Stack([5e9, 3e7], [0.35, 0.45], [0.2], [math.inf])])
def test_readings_keep_seven_digits_of_stress(stack):
    """Soft soil below a stiff layer as well, and points far from the load along one axis."""
    exact = solved([cells()], stack)
    # e^-28 with powers of k h before it, and panels of six points: 1e-7 of the largest stress at a depth.
    for row, error in enumerate(np.abs(solved([cells()], stack, accuracy=READING) - exact)[:, :6]):
        assert error.max() <= 1e-7 * np.abs(exact[row, :6]).max()


@pytest.mark.parametrize("stack", [LAYERS, ALONE])
def test_single_numbers_keep_six_digits(stack):
    """Waves that cancel each other to a field: single numbers have seven digits, of the largest at a depth."""
    nodes = rule(36 / DEPTHS.min(), 0.3, 2.0, READING)
    planes = [plane(stack, z, READING.fall) for z in DEPTHS]
    tasks = [(0, row) for row in range(len(planes))]
    exact, short = (
        synthesise_cells([[cells()]], planes, tasks, X, Y, nodes, nodes, None, range(6), precision)
        for precision in (np.float64, np.float32)
    )
    for whole, error in zip(exact, np.abs(short - exact), strict=True):
        assert error.max() <= 1e-6 * np.abs(whole).max()
    assert np.abs(short - exact).max() > 0


def test_readings_cost_a_third():
    fine, few = (len(rule(one.fall / 0.2, 0.8, 2.0, one)[0]) for one in (FULL, READING))
    assert few**2 < 0.3 * fine**2
