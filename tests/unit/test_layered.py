"""Layers at one wavenumber: closed forms, extended precision, continuity, springs, reciprocity."""

import math

import numpy as np
import pytest

from treadload.kernels.layers.layered import Stack, transfer

K = np.geomspace(1e-5, 2e3, 40)


def half_space(k, z, shear, poisson):
    """Boussinesq and Cerruti in wavenumbers: rows k U, k w, F, G; columns F, G; and SH."""
    kz, chi = k * z, 3 - 4 * poisson
    down = np.array([[1.0, 0.0], [1.0, chi]])
    force = shear * np.array([[2.0, chi - 1], [2.0, chi + 1]])
    wave = np.array([[1.0, kz], [0.0, 1.0]]) * math.exp(-kz)
    inverse = np.linalg.inv(force)
    return np.vstack([down @ wave @ inverse, force @ wave @ inverse]), np.exp(-kz) * np.array([1 / shear, 1.0])


@pytest.mark.parametrize("poisson", [0.0, 0.35, 0.5])
def test_equal_layers_are_a_half_space(poisson):
    shear, depths = 2e9, [0.0, 0.01, 0.06, 0.2, 0.5]
    stack = Stack([shear] * 4, [poisson] * 4, [0.06, 0.1, 0.04], [math.inf] * 3)
    result = transfer(K, stack, depths, [False] * 5)
    scale = np.array([1 / shear, 1 / shear, 1, 1])[:, None]
    for row, z in enumerate(depths):
        for i, k in enumerate(K):
            plane, transverse = half_space(k, z, shear, poisson)
            # 1e-12: a few hundred roundings.
            np.testing.assert_allclose(result.plane[row, :, :, i] / scale, plane / scale, atol=1e-12, rtol=0)
            np.testing.assert_allclose(
                result.transverse[row, :, i] / scale[::2, 0], transverse / scale[::2, 0], atol=1e-12, rtol=0
            )


SPRUNG = Stack([3e9, 6e9, 1e8, 2e7], [0.35, 0.25, 0.5, 0.4], [0.06, 0.15, 0.3], [1e9, 0.0, math.inf])


def test_traction_is_continuous_and_the_spring_follows_its_law():
    depth = [0.06, 0.06, 0.21, 0.21, 0.51, 0.51]
    result = transfer(K, SPRUNG, depth, [False, True] * 3)
    above, under = result.plane[::2], result.plane[1::2]
    np.testing.assert_allclose(above[:, 1:], under[:, 1:], rtol=1e-10)
    np.testing.assert_allclose(result.transverse[::2, 1], result.transverse[1::2, 1], rtol=1e-10)
    np.testing.assert_allclose(above[2], under[2], rtol=1e-10)
    slide = (above[0, 0] - under[0, 0]) / K
    # Round-off of the displacement itself: the jump may be far smaller.
    slack = 1e-10 * np.abs(above[0, 0]) / K * 1e9
    assert (np.abs(above[0, 2] - 1e9 * slide) <= 1e-10 * np.abs(above[0, 2]) + slack).all()
    # No shear passes the frictionless interface.
    assert np.abs(above[1, 2]).max() <= 1e-10
    assert np.abs(result.transverse[2, 1]).max() == 0


@pytest.mark.parametrize("poisson", [0.0, 0.25])
def test_a_loose_sheet_keeps_its_digits_in_long_waves(poisson):
    """Its slide under a pressure is a difference of third order in k h: the same for one sheet and two halves."""
    rest = [6.8e8], [0.5], [9.9]
    k = np.geomspace(1e-4, 1, 9)
    whole = Stack([2.1e7, *rest[0]], [poisson, *rest[1]], [0.012, *rest[2]], [0.0], True)
    halves = Stack([2.1e7] * 2 + rest[0], [poisson] * 2 + rest[1], [0.01, 0.002] + rest[2], [math.inf, 0.0], True)
    one, two = (transfer(k, stack, [0.012], [False]).plane[0, :2] for stack in (whole, halves))
    assert (np.abs(one - two) <= 1e-9 * np.abs(one)).all()


def test_reciprocity_with_slip():
    surface = transfer(K, SPRUNG, [0.0], [False]).plane[0, :2]
    # Betti: what a shear does to the settlement, a pressure does to the slide.
    assert (np.abs(surface[0, 1] - surface[1, 0]) <= 1e-10 * np.abs(surface).max(axis=(0, 1))).all()


def test_depths_inside_layers_change_nothing():
    alone = transfer(K, SPRUNG, [0.4], [False])
    among = transfer(K, SPRUNG, [0.01, 0.4, 0.03, 0.1, 0.9], [False] * 5)
    for rows in (slice(0, 2), slice(2, 4)):
        size = np.abs(alone.plane[0, rows]).max(axis=(0, 1))
        # A spring and a contrast of 300 lose a few digits; the wave itself may be as small as it likes.
        assert (np.abs(among.plane[1, rows] - alone.plane[0, rows]) <= 1e-9 * size + 1e-290).all()


def test_rigid_base():
    stack = Stack([1e8, 2e7], [0.3, 0.4], [0.2, 0.5], [math.inf], rigid=True)
    result = transfer(K, stack, [0.0, 0.7], [False, False])
    # Fixed at the base, to round-off of what moves above.
    assert (np.abs(result.plane[1, :2]) <= 1e-12 * np.abs(result.plane[0, :2]).max(axis=(0, 1))).all()
    # A long wave is uniform compression: u_z = p Σ h / M, and the base carries the load.
    long = transfer([1e-3], stack, [0.0, 0.7], [False, False])
    stiffness = [2 * g * (1 - nu) / (1 - 2 * nu) for g, nu in ((1e8, 0.3), (2e7, 0.4))]
    assert long.plane[0, 1, 1, 0] / 1e-3 == pytest.approx(0.2 / stiffness[0] + 0.5 / stiffness[1], rel=1e-5)
    assert long.plane[1, 3, 1, 0] == pytest.approx(1, rel=1e-5)


def test_complex_moduli_are_those_of_the_real_ones_on_the_real_axis():
    spun = Stack([g * np.exp(0.2j) for g in SPRUNG.shear], SPRUNG.poisson, SPRUNG.thickness, [math.inf] * 3)
    still = Stack(SPRUNG.shear, SPRUNG.poisson, SPRUNG.thickness, [math.inf] * 3)
    one, other = transfer(K, spun, [0.1], [False]), transfer(K, still, [0.1], [False])
    # All moduli turned by the same phase: forces stay, displacements turn back.
    np.testing.assert_allclose(one.plane[0, 2:], other.plane[0, 2:], atol=1e-9)
    np.testing.assert_allclose(one.plane[0, :2] * np.exp(0.2j), other.plane[0, :2], atol=1e-9 / 2e7)


@pytest.mark.parametrize("poisson", [[0.35, 0.5], [0.5, 0.5], [0.3, 0.49999]])
def test_the_longest_waves_on_a_rigid_base_keep_their_digits(poisson):
    stack = Stack([1e9, 1e8], poisson, [0.1, 0.5], [math.inf], rigid=True)
    k = np.geomspace(1e-12, 1e-3, 10)
    result = transfer(k, stack, [0.0, 0.1, 0.6], [False] * 3)
    assert np.isfinite(result.plane).all()
    # As k goes to 0 shear is Σ h/G and the base carries the load; corrections are (k H)² times the contrast.
    np.testing.assert_allclose(result.plane[0, 0, 0] / k, 0.1 / 1e9 + 0.5 / 1e8, rtol=2e-5)
    np.testing.assert_allclose(result.plane[:, 2, 0], 1, atol=1e-5)
    np.testing.assert_allclose(result.plane[:, 3, 1], 1, atol=1e-5)
    yielding = [(1 - 2 * nu) / (2 * g * (1 - nu)) for g, nu in zip(stack.shear, poisson, strict=True)]
    settled = np.dot(yielding, stack.thickness)
    assert np.abs(result.plane[0, 1, 1] / k - settled).max() <= 2e-5 * 0.5 / 1e8
