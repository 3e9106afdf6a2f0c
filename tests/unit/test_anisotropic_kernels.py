"""The surface of an anisotropic half-space: its symbol and the coefficients of rectangles."""

import math
import time

import numpy as np
import pytest
from tests.grain import LEANING, STRAIGHT, TILTED, isotropic, stroh_symbol

import treadload as tl
from treadload.contact.bodies.anisotropic import AnisotropicHalfSpace
from treadload.kernels.anisotropy import symbol as module
from treadload.kernels.anisotropy.coefficients import EVEN, ODD, Angular, coefficients, green
from treadload.kernels.anisotropy.stiffness import as_matrix, as_tensor, rotated
from treadload.kernels.anisotropy.symbol import NotConvergedError, surface_symbol, symbol_at
from treadload.kernels.half_space import rectangle
from treadload.kernels.half_space.rectangle import CombinedElasticity

ANGLES = np.linspace(0, 2 * np.pi, 17)


@pytest.mark.parametrize("material", [STRAIGHT, TILTED, LEANING], ids=["straight", "tilted", "leaning"])
def test_the_symbol_is_that_of_stroh_s_eigenvectors(material):
    symbol = surface_symbol(material.stiffness)
    exact = np.array([stroh_symbol(material.stiffness, angle) for angle in ANGLES])
    # The bound of the kernel; eigenvectors themselves lose a digit or two.
    assert np.abs(symbol(ANGLES) - exact).max() < 1e-13 * np.abs(exact).max()
    assert np.abs(symbol_at(material.stiffness, ANGLES, symbol.means) - exact).max() < 1e-13 * np.abs(exact).max()


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.4999])
def test_isotropy_is_no_special_case(poisson):
    shear, c, s = 1 / (2 * (1 + poisson)), np.cos(ANGLES), np.sin(ANGLES)
    exact = np.zeros((len(ANGLES), 3, 3), complex)
    # Johnson (1985), section 13.2, with the coupling (1 - 2 ν)/2G.
    exact[:, 0, 0], exact[:, 1, 1], exact[:, 2, 2] = (1 - poisson * c**2), (1 - poisson * s**2), (1 - poisson)
    exact[:, 0, 1] = exact[:, 1, 0] = -poisson * c * s
    for axis, along in ((0, c), (1, s)):
        exact[:, axis, 2], exact[:, 2, axis] = 0.5j * (1 - 2 * poisson) * along, -0.5j * (1 - 2 * poisson) * along
    symbol = surface_symbol(isotropic(1.0, poisson))
    # Near-incompressible: the stiffness has a condition of 1e4, and digits with it.
    np.testing.assert_allclose(symbol(ANGLES), exact / shear, rtol=0, atol=1e-13 if poisson < 0.4 else 1e-11)
    assert symbol.means == 16


def test_turns_are_added_until_the_mean_holds(monkeypatch):
    stiff = rotated(np.diag([60.0, 1, 1, 0.5, 0.5, 0.5]), TILTED.rotation)
    symbol = surface_symbol(stiff)
    assert symbol.means > 32
    exact = np.array([stroh_symbol(stiff, angle) for angle in ANGLES])
    assert np.abs(symbol(ANGLES) - exact).max() < 1e-12 * np.abs(exact).max()
    monkeypatch.setattr(module, "_MOST_MEANS", 64)
    with pytest.raises(NotConvergedError, match=r"^64 turns do not resolve"):
        surface_symbol(stiff)
    with pytest.raises(tl.InputError, match=r"differs with direction more .*: 64 turns .*; bring its moduli closer"):
        AnisotropicHalfSpace.of(stiff, is_tire=False)


def test_a_turned_solid_has_the_turned_symbol():
    turn = 0.7
    about_z = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    there = surface_symbol(rotated(TILTED.stiffness, about_z))(ANGLES + turn)
    here = about_z @ surface_symbol(TILTED.stiffness)(ANGLES) @ about_z.T
    np.testing.assert_allclose(there, here, rtol=0, atol=1e-13 * np.abs(here).max())
    again = as_matrix(as_tensor(TILTED.stiffness))
    np.testing.assert_array_equal(again, TILTED.stiffness)


@pytest.mark.parametrize("first", [0.0, -2.5 * 0.7])
def test_isotropic_coefficients_are_the_program_s(first):
    modulus, poisson, shape = 2.3, 0.3, (12, 16, 0.7, 0.4)
    angular = Angular.of(surface_symbol(isotropic(modulus, poisson)))
    bodies = CombinedElasticity.of(math.inf, 0.0, modulus / (2 * (1 + poisson)), poisson)
    found = coefficients(angular, *shape, first)
    normal = rectangle.normal_by_pressure(*shape, bodies, first)
    xx, yy, xy = rectangle.tangential_by_shear(*shape, bodies, first)
    # The road alone: u_x under pressure is +k_x, and u_z under shear on it -k_x.
    k_x, k_y = rectangle.coupling(*shape, bodies, first)
    expected = np.array([xx, yy, normal, xy, 0 * xx, 0 * xx, 0 * xx, k_x, k_y])
    np.testing.assert_allclose(found, expected, rtol=0, atol=5e-15 * normal.max())


@pytest.mark.parametrize("material", [TILTED, LEANING], ids=["tilted", "leaning"])
def test_coefficients_are_integrals_of_the_point_load(material):
    symbol = surface_symbol(material.stiffness)
    dx, dy, reach = 0.7, 0.4, 6
    angular = Angular.of(symbol)
    found = coefficients(angular, 2 * reach + 1, 2 * reach + 1, dx, dy, -reach * dx, -reach * dy)
    nodes, weights = np.polynomial.legendre.leggauss(24)
    harmonics = green(symbol)
    order = harmonics.shape[-1] // 2
    for i, j in ((2, 0), (0, 3), (3, -2), (-3, 2), (-2, -5), (-6, 4)):
        x, y = np.meshgrid(i * dx + dx / 2 * nodes, j * dy + dy / 2 * nodes)
        waves = np.exp(1j * np.multiply.outer(np.arange(-order, order + 1), np.arctan2(y, x)))
        g = np.tensordot(harmonics, waves, 1).real
        direct = (g / np.hypot(x, y) * np.outer(weights, weights)).sum((1, 2)) * dx * dy / 4
        # 24 points are exact to 2e-15 here; the sum over corners loses what a distance of 7 cells costs.
        assert np.abs(found[:, j + reach, i + reach] - direct).max() < 2e-14 * np.abs(found).max()


def test_the_point_load_is_the_transform_of_the_symbol():
    """PV∫ Im L(t)/cos(t - φ) dt, summed by hand; 4.2 of the formulas."""
    symbol = surface_symbol(TILTED.stiffness)
    harmonics = green(symbol)
    order = harmonics.shape[-1] // 2
    angle = 0.43
    g = (harmonics @ np.exp(1j * angle * np.arange(-order, order + 1))).real
    # Points symmetric about the poles at φ ± π/2: what is left of them cancels.
    t = angle + np.pi / 2 + np.pi / 400 * (np.arange(800) + 0.5)
    imaginary = symbol(t).imag
    principal = (imaginary / np.cos(t - angle)[:, None, None]).sum(0) * np.pi / 400
    expected = symbol(np.array([angle + np.pi / 2]))[0].real / (2 * np.pi) - principal / (4 * np.pi**2)
    rows = [expected[i, j] + expected[j, i] for i, j in EVEN], [expected[i, j] - expected[j, i] for i, j in ODD]
    # Next to the poles three digits cancel.
    np.testing.assert_allclose(2 * g, np.concatenate(rows), rtol=0, atol=1e-12 * np.abs(g).max())


def test_the_table_keeps_its_error_and_is_quick():
    angular = Angular.of(surface_symbol(TILTED.stiffness))
    assert angular.error < 1e-16
    seconds = []
    for _ in range(3):
        start = time.process_time()
        one = coefficients(angular, 128, 128, 0.7, 0.4, -64 * 0.7, -64 * 0.4)
        seconds.append(time.process_time() - start)
    # The bound for 128² offsets; measured 0.02 s on one core.
    assert min(seconds) < 0.1
    some = coefficients(angular, 128, 128, 0.7, 0.4, -64 * 0.7, -64 * 0.4, rows=(2, 7))
    np.testing.assert_array_equal(some, one[[2, 7]])
    # Even and odd under (x, y) → (-x, -y).
    sign = np.where(np.arange(9) < 6, 1, -1)[:, None, None]
    np.testing.assert_allclose(one[:, :0:-1, :0:-1], sign * one[:, 1:, 1:], rtol=0, atol=1e-13 * np.abs(one).max())
