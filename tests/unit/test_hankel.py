"""Discs by integrals over one wavenumber: closed form, other quadratures, the table in r."""

import math

import numpy as np
from scipy.integrate import simpson
from scipy.special import j0, j1

from treadload.kernels.half_space.disc import disc_fields
from treadload.kernels.layers import hankel
from treadload.kernels.layers.hankel import AxialPlanes, Disc, integrals, interpolated, panels, synthesise_discs
from treadload.kernels.layers.layered import Stack, transfer
from treadload.kernels.layers.moving import Body, Level, Path, moving_fields
from treadload.kernels.layers.wavenumbers import disc_spectrum, quadrature

INF = math.inf
LAYERS = Stack([3e9, 1e8, 2e7], [0.35, 0.4, 0.5], [0.08, 0.3], [1e9, INF])
ALONE = Stack([2e9], [0.35], [], [])
DEPTHS = np.array([0.1, 0.25, 0.38, 1.0])
X, Y = np.linspace(-0.4, 0.9, 14), np.array([-0.3, 0.0, 0.11])


def planes_of(stack, depths=DEPTHS):
    where = [stack.layer_at(z, False) for z in depths]
    return AxialPlanes(
        lambda k: transfer(k, stack, depths, [False] * len(depths)).plane[:, :, 1],
        np.array([stack.shear[layer] for layer in where]),
        np.array([stack.poisson[layer] for layer in where]),
        36 / depths,
        float(depths.min()),
    )


def test_discs_in_a_half_space_are_the_closed_form():
    discs = [Disc(0.1, 7e5, 0.02, -0.03), Disc(0.15, 5e5, 0.4, 0.0), Disc(0.1, 6e5, -0.3, 0.0)]
    found = synthesise_discs(discs, planes_of(ALONE), X, Y, 1.0)
    exact = np.zeros_like(found)
    for row, depth in enumerate(DEPTHS):
        for disc in discs:
            grid_x, grid_y = np.meshgrid(X - disc.x, Y - disc.y)
            stress, moved = disc_fields(disc.radius, grid_x, grid_y, depth, 2e9, 0.35)
            exact[row] += disc.pressure * np.concatenate([stress, moved])
    # Waves cut at e^-36; the issue asks for 1e-5 of the largest value.
    for rows in (slice(0, 6), slice(6, 9)):
        np.testing.assert_allclose(found[:, rows], exact[:, rows], atol=1e-11 * np.abs(exact[:, rows]).max(), rtol=0)


def test_discs_on_layers_by_the_wavenumbers_of_the_plane():
    found = synthesise_discs([Disc(0.12, 7e5, 0.1, 0.05)], planes_of(LAYERS), X, Y, 3.0)
    limit = 36 / DEPTHS.min()
    moduli = [2 * (1 + nu) * shear for shear, nu in zip(LAYERS.shear, LAYERS.poisson, strict=True)]
    body = Body(moduli, LAYERS.poisson, LAYERS.thickness, LAYERS.spring)
    levels = [Level(z, LAYERS.layer_at(z, False), False) for z in DEPTHS]
    path, across = Path.of(limit, (-0.02, 0.22), 3.0), quadrature(limit, 1.1, 3.0)
    other = moving_fields([disc_spectrum(0.12, 7e5, 0.1, 0.05)], body, levels, limit, X, Y, path, across)[:, :9]
    # What the plane's quadrature leaves, displacement the most: a disc in one dimension has no 1/k.
    for rows in (slice(0, 6), slice(6, 9)):
        np.testing.assert_allclose(found[:, rows], other[:, rows], atol=1e-9 * np.abs(other[:, rows]).max(), rtol=0)


def test_integrals_by_another_rule():
    radius, r, planes = 0.12, np.array([0.0, 0.12, 0.7]), planes_of(LAYERS)
    found = integrals({radius: r}, planes, 3.0)[radius]
    # Simpson on steps of a hundredth of what the waves turn in, after a substitution that spreads what is near zero.
    t = np.linspace(np.log(1e-9), np.log(360), 60001)
    k = np.exp(t)
    kernel, load = planes.kernels(k), radius * j1(k * radius) * k
    for i, turn in enumerate(np.outer(r, k)):
        ratio = np.where(turn > 0, j1(turn) / np.where(turn > 0, turn, 1), 0.5)
        integrands = [kernel[:, 1] / k * j0(turn), kernel[:, 3] * j0(turn), kernel[:, 0] * j0(turn)]
        integrands += [kernel[:, 0] * ratio, kernel[:, 2] * k * ratio]
        exact = np.stack([simpson(one * load, x=t) for one in integrands], axis=1)
        # The steps' own error, (k r dt)^4 where the waves are still there.
        np.testing.assert_allclose(found[:, :, i] / np.abs(exact), np.sign(exact), rtol=1e-7)


def test_interpolation_in_r_leaves_nothing():
    planes = planes_of(LAYERS)
    edges = panels(0.12, 2.5, planes.clearance)
    assert edges[0] == 0
    assert edges[-1] >= 2.5
    assert 0.12 in edges
    r = np.linspace(0, 2.5, 301)
    at = hankel._points(edges)
    exact = integrals({0.12: r}, planes, 3.0)[0.12]
    found = interpolated(integrals({0.12: at}, planes, 3.0)[0.12], edges, r)
    # 4.6^-18 of the field's own size on the ellipse.
    error = np.abs(found - exact).max(axis=2) / np.abs(exact).max(axis=2)
    assert error.max() < 1e-10


def test_interpolation_converges_at_its_rate(monkeypatch):
    planes = planes_of(ALONE, np.array([0.1]))
    edges, r = panels(0.12, 1.0, 0.1), np.linspace(0, 1, 101)
    exact = integrals({0.12: r}, planes, 1.0)[0.12]
    errors = []
    for count in (6, 10, 14):
        monkeypatch.setattr(hankel, "_POINTS", count)
        table = integrals({0.12: hankel._points(edges)}, planes, 1.0)[0.12]
        errors.append(float((np.abs(interpolated(table, edges, r) - exact).max(axis=2) / np.abs(exact).max()).max()))
    # 4.6 a point, less what the powers before it take.
    assert errors[1] < errors[0] * 3.0**-4
    assert errors[2] < errors[1] * 3.0**-4


def test_blocks_change_nothing(monkeypatch):
    arguments = ([Disc(0.1, 7e5, 0.0, 0.0)], planes_of(LAYERS), X, Y, 3.0)
    whole = synthesise_discs(*arguments)
    monkeypatch.setattr(hankel, "_BLOCK", 5000)
    # Round-off of sums in another order.
    np.testing.assert_allclose(
        synthesise_discs(*arguments), whole, atol=1e-12 * np.abs(whole[:, :6]).max(), rtol=1e-9
    )


def test_the_axis_has_no_direction():
    found = synthesise_discs([Disc(0.1, 7e5, 0.0, 0.0)], planes_of(LAYERS), np.zeros(1), np.zeros(1), 3.0)[:, :, 0, 0]
    np.testing.assert_allclose(found[:, 0], found[:, 1], rtol=1e-10)
    assert not found[:, [3, 4, 5, 6, 7]].any()


def test_work_is_shared_by_wheels_and_points():
    """Kernels are asked for once a wavenumber, however many discs and points there are."""
    planes, asked = planes_of(LAYERS), []

    def counting(k):
        asked.append(len(k))
        return planes.kernels(k)

    counted = AxialPlanes(counting, planes.shear, planes.poisson, planes.limit, planes.clearance)
    numbers = []
    for discs, points in ((1, 14), (8, 14), (8, 200)):
        asked.clear()
        wheels = [Disc(0.12, 7e5, -0.3 + 0.05 * i, 0.0) for i in range(discs)]
        synthesise_discs(wheels, counted, np.linspace(-0.4, 0.9, points), Y, 3.0)
        numbers.append(sum(asked))
    # A little further from the outer wheel: the panels are that much narrower.
    assert max(numbers) <= 1.3 * min(numbers)
