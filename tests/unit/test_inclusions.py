"""Inclusions by their equivalent eigenstrain: a sphere against Eshelby, a cavity, many against Mori and Tanaka."""

import numpy as np
import pytest

from treadload.kernels.eigenstrain import operator
from treadload.kernels.eigenstrain.inclusions import equivalent
from treadload.kernels.eigenstrain.operator import Grid
from treadload.kernels.tensors import principal_values
from treadload.materials.aggregates import Spheres
from treadload.response.heterogeneous.cut import mixed, shares

_NU = 0.3
_VOLUME, _SHEAR = (1 + _NU) / (3 * (1 - _NU)), 2 * (4 - 5 * _NU) / (15 * (1 - _NU))
_ONE = np.array([1.0, 1, 1, 0, 0, 0])


def _moduli(modulus, poisson=_NU):
    """3 k and 2 G."""
    return modulus / (1 - 2 * poisson), modulus / (1 + poisson)


def _block(cells, beyond=1):
    """Grid of a sphere of so many cells a radius, and cells beyond it; distance of each cell from the middle."""
    half = cells + beyond
    at = np.arange(2 * half) - half + 0.5
    grid = Grid(2 * half, 2 * half, 1.0, 1.0, np.arange(2 * half + 1.0))
    return grid, at, np.sqrt(at[:, None, None] ** 2 + at[:, None] ** 2 + at**2)


def _sphere(cells, contrast, *, beyond=1, averaged=True, single=False, tension=0):
    """A sphere in an endless body under a tension of 1: solution, its cells, grid, distances."""
    grid, at, distance = _block(cells, beyond)
    inside = distance < cells
    matrix = _moduli(1.0)
    shear = 0.5 / (1 + _NU)
    apply = operator.cells(grid, shear, _NU, averaged=averaged, surface=False, single=single)
    stress = np.zeros((6, *grid.shape))
    stress[tension] = 1.0
    own = tuple(np.full(inside.sum(), contrast * one) for one in matrix)
    return equivalent(apply, stress, inside, own, matrix, grid.thickness), inside, grid, at


def _strain(stress, modulus):
    return (stress * (1 + _NU) - _NU * stress[:3].sum(axis=0) * _ONE[:, None]) / modulus


def _exact(contrast):
    """Strain inside a sphere under a uniaxial tension of 1, modulus 1, one Poisson's ratio: Eshelby (1957)."""
    remote = np.array([1, -_NU, -_NU, 0, 0, 0])
    mean = remote[:3].sum() / 3 * _ONE
    return mean / (1 + (contrast - 1) * _VOLUME) + (remote - mean) / (1 + (contrast - 1) * _SHEAR)


def _mean_error(cells, contrast, **how):
    found, inside, _, _ = _sphere(cells, contrast, **how)
    return _strain(found.stress[:, inside].mean(axis=1, keepdims=True), contrast)[0, 0] / _exact(contrast)[0] - 1


def test_a_soft_sphere_strains_as_eshelbys():
    assert abs(_mean_error(8, 0.1)) < 5e-3


@pytest.mark.slow
def test_a_stiff_sphere_looks_larger_by_its_steps_which_fade_with_their_size():
    few, many = _mean_error(8, 12.0), _mean_error(10, 12.0)
    # Error of a staircase: as one over the cells of a radius.
    assert many / few == pytest.approx(8 / 10, rel=0.05)
    assert abs((10 * many - 8 * few) / 2) < 5e-3


@pytest.mark.slow
def test_a_stiff_sphere_seen_at_the_centres_of_its_cells_is_within_a_hundredth_and_a_half():
    assert abs(_mean_error(10, 12.0, averaged=False)) < 1.5e-2


@pytest.mark.parametrize(("cells", "bound"), [(8, 5e-3), pytest.param(10, 5e-3, marks=pytest.mark.slow)])
def test_a_stiff_sphere_whose_border_counts_by_share_is_eshelbys(cells, bound):
    # With whole cells 3.9 and 3.1 % too much, of their volume and of their steps.
    grid, at, _ = _block(cells, 1)
    middle = np.zeros(1)
    depth = float(grid.edges[-1]) / 2
    fullest, holder, share = shares(Spheres(middle, middle, middle + depth, middle + cells), at, at, grid.depths)
    volume = 4 / 3 * np.pi * cells**3
    assert abs((fullest > 0).sum() - volume) <= 0.5
    assert share.sum() == pytest.approx(volume, rel=1e-3)
    inside = holder > 0
    matrix = _moduli(1.0)
    apply = operator.cells(grid, 0.5 / (1 + _NU), _NU, averaged=True, surface=False)
    stress = np.zeros((6, *grid.shape))
    stress[0] = 1.0
    own = tuple(mixed(np.full(inside.sum(), 12 * one), one, share[inside]) for one in matrix)
    found = equivalent(apply, stress, inside, own, matrix, grid.thickness)
    # Both parts of a cell bear its stress: that of the stone is the mean by share.
    mean = (found.stress[:, inside] * share[inside]).sum(axis=1, keepdims=True) / share.sum()
    assert abs(_strain(mean, 12.0)[0, 0] / _exact(12.0)[0] - 1) < bound
    assert found.iterations <= 30


@pytest.mark.parametrize("contrast", [12.0, 0.1])
@pytest.mark.parametrize(
    "cells", [8, pytest.param(16, marks=pytest.mark.slow), pytest.param(24, marks=pytest.mark.slow)]
)
def test_iterations_do_not_grow_with_the_grid(cells, contrast):
    found, _, _, _ = _sphere(cells, contrast, beyond=0, single=True)
    assert found.iterations <= 30
    assert found.residual < 2e-6
    assert found.method == "conjugate gradients"


@pytest.mark.slow
def test_beside_a_cavity_stress_is_goodiers():
    found, inside, _, at = _sphere(6, 0.0, beyond=4)
    assert np.abs(found.stress[:, inside]).max() < 1e-4
    # Along y through the middle, under tension along x; means of the four cells around the axis.
    stress = found.stress[0][9:11, :, 9:11].mean(axis=(0, 2))
    r = np.sqrt(at**2 + 0.5)
    exact = 1 + (4 - 5 * _NU) / (2 * (7 - 5 * _NU)) * (6 / r) ** 3 + 9 / (2 * (7 - 5 * _NU)) * (6 / r) ** 5
    second = slice(17, None)
    assert np.abs(stress[second] / exact[second] - 1).max() < 3e-2


def test_a_stone_just_below_the_surface_is_as_another_program_found_it():
    # A trial outside this package, stress of mastic 3 GPa and stone 60 GPa, radius 5 cells, a cover of one.
    at = np.arange(16) - 7.5
    grid = Grid(16, 16, 1.0, 1.0, np.arange(15.0))
    inside = (grid.depths - 6)[:, None, None] ** 2 + at[:, None] ** 2 + at**2 < 25
    mastic = _moduli(3.0, 0.35)
    apply = operator.cells(grid, 0.5 * mastic[1], 0.35, averaged=True)
    stress = np.zeros((6, *grid.shape))
    stress[0] = 1.0
    own = tuple(np.full(inside.sum(), one) for one in _moduli(60.0, 0.2))
    found = equivalent(apply, stress, inside, own, mastic, grid.thickness)
    # Its stone had other cells at the border: 1.81. The stone shields the surface above it: 0.57 to 0.60.
    assert found.stress[0][inside].mean() == pytest.approx(1.81, rel=0.03)
    assert principal_values(found.stress)[0][~inside].max() == pytest.approx(2.04, rel=0.01)
    above = operator.cells(grid, 0.5 * mastic[1], 0.35, depths=np.array([0.0]))(found.eigenstrain)
    assert 1 + above[0, 0, 7:9, 7:9].mean() == pytest.approx(0.57, abs=0.05)


def test_stiff_and_soft_together_are_solved_and_satisfy_their_laws():
    grid = Grid(12, 8, 1.0, 1.2, np.array([0.0, 1.0, 2.0, 3.0, 4.2, 5.5, 7.0]))
    generator = np.random.default_rng(1)
    phase = np.zeros(grid.shape, int)
    phase[1:4, 2:6, 1:5], phase[2:5, 2:6, 6:9], phase[1:3, 3:5, 9:11] = 1, 2, 3
    # The third is stiffer in volume and softer in shear.
    kinds = {1: _moduli(12.0, 0.2), 2: _moduli(0.1, 0.4), 3: (10.0, 0.3)}
    inside = phase > 0
    own = tuple(np.array([kinds[k][part] for k in phase[inside]]) for part in (0, 1))
    matrix = _moduli(1.0)
    apply = operator.cells(grid, 0.5 / (1 + _NU), _NU, averaged=True)
    stress = generator.normal(size=(6, 1, 1, 1)) * np.ones((6, *grid.shape))
    found = equivalent(apply, stress, inside, own, matrix, grid.thickness, tolerance=1e-10)
    assert found.method == "MINRES"
    assert found.residual < 1e-8
    np.testing.assert_allclose(found.stress, stress + apply(found.eigenstrain), atol=1e-9)
    inner, strain = found.stress[:, inside], found.eigenstrain[:, inside]

    def compliant(tensor, moduli):
        mean = tensor[:3].sum(axis=0) / 3 * _ONE[:, None]
        return mean / moduli[0] + (tensor - mean) / moduli[1]

    # The stone's own law and that of the mortar with its eigenstrain give one strain.
    np.testing.assert_allclose(compliant(inner, own), compliant(inner, matrix) + strain, atol=1e-7)


@pytest.mark.slow
def test_sixteen_soft_spheres_are_mori_and_tanakas():
    cells, fraction, contrast = 4, 0.26, 0.1
    # Close-packed places around a hole between four: 4 and 12 of them, as dense as the fraction says.
    side = cells * (16 / 3 * np.pi / fraction) ** (1 / 3)
    steps = np.stack(np.meshgrid(*[np.arange(-4, 5)] * 3), axis=-1).reshape(-1, 3)
    centres = steps[steps.sum(axis=1) % 2 == 0] * side / 2 - side / 4
    x, y, z = centres[np.linalg.norm(centres, axis=1) < 0.84 * side].T
    volume = 4 * side**3
    assert len(x) == 16
    grid, at, _ = _block(int(np.abs(x).max() + cells) + 1, 0)
    spheres = Spheres(x, y, z + len(at) / 2, np.full(16, float(cells)))
    fullest, holder, part = shares(spheres, at, at, grid.depths)
    apply = operator.cells(grid, 0.5 / (1 + _NU), _NU, averaged=True, surface=False, single=True)

    def effective(inside, share, load, modulus, shape):
        """Modulus over that of the matrix. Maxwell: the cluster's dipole is that of one sphere of the material."""
        # A cell of two parts as stiff as their mean; all of it stone where the share is one.
        own = tuple(one * (share * contrast + 1 - share) for one in _moduli(1.0))
        stress = load[:, None, None, None] * np.ones((6, *grid.shape))
        found = equivalent(apply, stress, inside, own, _moduli(1.0), grid.thickness)
        relative = found.eigenstrain[int(np.argmax(load))].sum() / volume * modulus
        return 1 - relative / (1 + relative * shape)

    change = contrast - 1
    for load, modulus, shape in ((_ONE, _moduli(1.0)[0], _VOLUME), (np.eye(6)[3], _moduli(1.0)[1], _SHEAR)):
        expected = 1 + fraction * change / (1 + (1 - fraction) * change * shape)
        whole = effective(fullest > 0, np.ones((fullest > 0).sum()), load, modulus, shape) / expected - 1
        mixed_in = effective(holder > 0, part[holder > 0], load, modulus, shape) / expected - 1
        # Whole cells of the spheres' volume, as stones are computed, look larger by their steps; borders as stiff as
        # the mean of both parts look smaller. Measured: -2.0 and 2.7 %, -1.4 and 1.9 %; with 6 cells a radius -1.5
        # and 1.4 %, -1.1 and 1.1 %. Between them stand Mori and Tanaka.
        assert -2.2e-2 < whole < 0 < mixed_in < 3e-2
        assert abs(whole + mixed_in) / 2 < 1e-2
