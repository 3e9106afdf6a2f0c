"""Stress below cells on an anisotropic half-space: laws of mechanics, its surface, other ways to the same field."""

import numpy as np
import pytest
from tests.grain import LEANING, STRAIGHT, TILTED, isotropic, stroh

from treadload.kernels.anisotropy import interior
from treadload.kernels.anisotropy.coefficients import Angular, coefficients
from treadload.kernels.anisotropy.interior import Modes, corner_fields
from treadload.kernels.anisotropy.symbol import NotConvergedError, surface_symbol
from treadload.kernels.half_space import interior as closed

DX, DY = 0.5, 0.35
LOAD = np.random.default_rng(4).normal(size=(3, 4, 5))
SOLIDS = {"tilted": TILTED, "leaning": LEANING, "straight": STRAIGHT}
STIFFNESS = {name: one.stiffness / 1e9 for name, one in SOLIDS.items()}
MODES = {name: Modes.of(stiffness) for name, stiffness in STIFFNESS.items()}
ALL = pytest.mark.parametrize("name", MODES)


def fields(modes, depths, x, y, load=LOAD):
    stress, displacement, _ = interior.fields_on_grid(load, DX, DY, np.atleast_1d(depths), 1.0, modes, x, y, "direct")
    return stress, displacement


def voigt(tensor):
    return np.array([tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[1, 2], tensor[0, 2], tensor[0, 1]])


@ALL
def test_points_are_few_and_the_error_is_known(name):
    assert MODES[name].points <= 300
    assert MODES[name].error < 1e-10
    assert not MODES[name].split


@ALL
@pytest.mark.parametrize("place", [(0.63, 0.41, 0.3), (-0.9, 0.2, 0.05), (3.1, -1.7, 2.0)])
def test_the_field_is_in_equilibrium_and_follows_hooke(name, place):
    """Central differences of fourth order."""
    step = 2e-3 * max(place[2], 0.1)
    weights = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}

    def along(axis):
        parts = [0.0, 0.0]
        for k, weight in weights.items():
            at = np.array(place)
            at[axis] += k * step
            found = fields(MODES[name], at[2:], at[:1], at[1:2])
            parts = [part + weight / step * one[0, :, 0, 0] for part, one in zip(parts, found, strict=True)]
        s = parts[0]
        return np.array([[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]]), parts[1]

    slopes = [along(axis) for axis in range(3)]
    size = max(np.abs(one).max() for one, _ in slopes)
    assert np.abs(sum(slopes[axis][0][axis] for axis in range(3))).max() < 1e-6 * size
    gradient = np.array([slopes[axis][1] for axis in range(3)])
    strain = voigt(0.5 * (gradient + gradient.T))
    strain[3:] *= 2
    stress = fields(MODES[name], place[2:], np.array(place[:1]), np.array(place[1:2]))[0][0, :, 0, 0]
    found = STIFFNESS[name] @ strain
    np.testing.assert_allclose(found, stress[[0, 1, 2, 5, 4, 3]], rtol=0, atol=1e-6 * np.abs(stress).max())


@ALL
def test_the_surface_carries_the_load_and_moves_as_the_coefficients_say(name):
    x, y = DX * np.arange(-2, 8), DY * np.arange(-2, 7)
    stress, _ = fields(MODES[name], 0.0, x, y)
    load = np.zeros((3, len(y), len(x)))
    load[:, 2:6, 2:7] = LOAD
    for component, k in ((2, 0), (4, 1), (5, 2)):
        np.testing.assert_allclose(stress[0, component], -load[k], rtol=0, atol=1e-11)
    # And the limit of small depths is the surface.
    near = fields(MODES[name], 1e-9, x, y)[0]
    np.testing.assert_allclose(near, stress, rtol=0, atol=1e-6)
    angular = Angular.of(surface_symbol(STIFFNESS[name]))
    kernel = coefficients(angular, 7, 9, DX, DY, -4 * DX, -3 * DY)
    for k, rows in ((0, ((4, 1), (5, 1), (2, 0))), (1, ((0, 0), (3, -1), (4, -1)))):
        one = np.zeros((3, 7, 9))
        one[k, 3, 4] = 1
        moved = fields(MODES[name], 0.0, DX * np.arange(9), DY * np.arange(7), one)[1][0]
        for component, (even, sign) in enumerate(rows):
            odd = {3: 6, 4: 7, 5: 8}.get(even)
            expected = kernel[even] + (0 if odd is None else sign * kernel[odd])
            np.testing.assert_allclose(moved[component], expected, rtol=0, atol=1e-9 * kernel.max())


@pytest.mark.parametrize(
    ("poisson", "step", "first"), [(0.35, 0.35, 0.1), (0.0, 0.5, 0.0)], ids=["off", "centres and edges"]
)
def test_isotropy_is_the_closed_form(poisson, step, first):
    """Modes fall together there, and the stiffness is changed by 1e-9 of it: that is what is left.

    On edges and corners of cells at the surface, too, where jumps take their means and logarithms are cut.
    """
    modes = Modes.of(isotropic(1.0, poisson))
    assert modes.split
    x, y, depths = (
        DX * (first + step * np.arange(-6, 14)),
        DY * (first + step * np.arange(-6, 12)),
        [0, 0.01, 0.2, 3.0],
    )
    stress, displacement = fields(modes, depths, x, y)
    known = closed.fields_on_grid(LOAD, DX, DY, np.array(depths), 0.5 / (1 + poisson), poisson, x, y, "direct")
    np.testing.assert_allclose(stress, known[0], rtol=0, atol=2e-8 * np.abs(known[0]).max())
    np.testing.assert_allclose(displacement, known[1], rtol=0, atol=2e-8 * np.abs(known[1]).max())


@pytest.mark.parametrize("name", ["leaning"])
def test_it_is_the_integral_along_the_real_axis(name):
    """Equation 4.4 by the midpoint rule, which needs points where the path has none to spare."""
    x, y, z, points = 0.21, -0.13, 0.4, 4096
    total = np.zeros((18,), complex)
    signs = {(1, 1): 1, (1, -1): -1, (-1, 1): -1, (-1, -1): 1}
    tensor_at = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
    c = STIFFNESS[name][tensor_at[:, :, None, None], tensor_at[None, None]]
    for angle in np.pi * (np.arange(points // 8) + 0.5) / (points // 8):
        p, a, b = stroh(STIFFNESS[name], angle)
        cosine, sine = np.cos(angle), np.sin(angle)
        logs = sum(
            sign * np.log(-1j * ((x + i * DX / 2) * cosine + (y + j * DY / 2) * sine + p * z))
            for (i, j), sign in signs.items()
        )
        f = np.linalg.inv(-1j * b)[:, [2, 0, 1]]
        wave = np.array([cosine, sine, 0])[:, None] + np.array([0, 0, 1])[:, None] * p
        stress = 1j * np.einsum("ijkl,km,lm,m,mt->ijt", c, a, wave, logs, f, optimize=True)
        total += (stress[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]] / (cosine * sine)).ravel()
    exact = total.real.reshape(6, 3) * np.pi / (points // 8) / (2 * np.pi**2)
    for k in range(3):
        one = np.zeros((3, 1, 1))
        one[k] = 1
        found = fields(MODES[name], z, np.array([x]), np.array([y]), one)[0][0, :, 0, 0]
        np.testing.assert_allclose(found, exact[:, k], rtol=0, atol=1e-9)


def test_steep_contrasts_take_more_points_or_are_refused(monkeypatch):
    modes = Modes.of(np.diag([30.0, 1, 1, 0.5, 0.4, 0.4]))
    assert modes.points > MODES["straight"].points
    corner = corner_fields(modes, np.array([0.3]), np.array([0.4]), 0.01, moves=False)
    assert corner.shape == (18, 1)
    monkeypatch.setattr(interior, "_MOST", 30)
    with pytest.raises(NotConvergedError, match="30 directions do not resolve the stress"):
        Modes.of(np.diag([30.0, 1, 1, 0.5, 0.4, 0.4]))
    monkeypatch.setattr(interior, "_HEIGHTS", ())
    with pytest.raises(NotConvergedError, match="come too near to their conjugates"):
        Modes.of(TILTED.stiffness)
