"""Settlement under a plate for many layered columns: against the solver of single roads and closed forms."""

import numpy as np
import pytest

import treadload as tl
from treadload.kernels.layers import settlement
from treadload.kernels.layers.settlement import Columns, Plate

OFFSETS = np.array([0.0, 0.2, 0.3, 0.6, 0.9, 1.5, 2.4])
RADIUS = 0.15


def settled(moduli, poisson, thickness, *, spring=None, stiff=False, rigid=False):
    """Settlement (s,) under 1 N of one column, Pa and m."""
    moduli, poisson = np.array(moduli), np.array(poisson)
    depth = max(sum(thickness), RADIUS) * (moduli.max() / moduli.min()) ** (1 / 3)
    plate = Plate.of(RADIUS, OFFSETS, thickness[0] if thickness else np.inf, depth, rigid=rigid)
    columns = Columns.of(
        plate.nodes, [np.full((1, 1), h) for h in thickness], poisson[None],
        spring or [np.inf] * (len(moduli) - 1), rigid=stiff,
    )  # fmt: skip
    return plate.settlement(*columns.kernel((moduli / (2 * (1 + poisson)))[None, None]))[0, 0]


def solved(moduli, poisson, thickness, *, bonds=None, stiff=False):
    depths = [*thickness, *[None] * (len(moduli) - len(thickness))]
    bonds = bonds or [tl.pavement.BONDED] * len(moduli)
    layers = [
        tl.Layer(tl.Elastic(e, v), h, bond=b) for e, v, h, b in zip(moduli, poisson, depths, bonds, strict=True)
    ]
    load = tl.UniformDisc(RADIUS, 1 / (np.pi * RADIUS**2))
    road = tl.Pavement(layers, rigid_base=stiff)
    return tl.solve_response([load], road, depths=[0.0], x=OFFSETS, y=[0.0]).dataset["displacement_z"].values.ravel()


@pytest.mark.parametrize(
    ("moduli", "poisson", "thickness", "stiff"),
    [
        ([5e9, 3e8, 6e7], [0.35, 0.35, 0.4], [0.15, 0.3], False),
        ([2e10, 5e9, 1e8, 4e7], [0.35, 0.25, 0.35, 0.5], [0.04, 0.2, 0.4], False),
        ([3e8, 2e10, 2e8, 3e7], [0.35, 0.2, 0.35, 0.49], [0.02, 0.2, 0.3], False),
        ([5e9, 3e8, 6e7], [0.35, 0.35, 0.4], [0.15, 0.3, 9.5], True),
    ],
)
def test_it_is_that_of_the_solver_of_one_road(moduli, poisson, thickness, stiff):
    """Two quadratures of the same integral: this one has 9 points in each octave of wavenumbers, good for 1e-7."""
    ours = settled(moduli, poisson, thickness, stiff=stiff)
    np.testing.assert_allclose(ours, solved(moduli, poisson, thickness, stiff=stiff), rtol=1e-7)


def test_a_spring_between_layers():
    case = ([5e9, 3e8, 6e7], [0.35, 0.35, 0.4], [0.15, 0.3])
    bonds = [tl.pavement.Bond(stiffness=1e9), tl.pavement.FRICTIONLESS, tl.pavement.BONDED]
    np.testing.assert_allclose(settled(*case, spring=[1e9, 0.0]), solved(*case, bonds=bonds), rtol=1e-7)


def test_a_half_space_is_exact_under_both_plates():
    """Boussinesq: uniform, 2 (1 - ν²) p a / E at the centre; rigid, P (1 - ν²) / (2 a E), an arcsine beside it."""
    uniform = settled([1e8], [0.4], [])
    assert uniform[0] == pytest.approx(2 * (1 - 0.16) / (np.pi * RADIUS * 1e8), rel=1e-12)
    rigid = settled([1e8], [0.4], [], rigid=True)
    beside = np.arcsin(np.minimum(1.0, RADIUS / np.maximum(OFFSETS, RADIUS)))
    np.testing.assert_allclose(rigid, (1 - 0.16) / (np.pi * RADIUS * 1e8) * beside, rtol=1e-12)


def test_four_pressures_level_a_rigid_plate_on_layers(monkeypatch):
    case = ([5e9, 3e8, 6e7], [0.35, 0.35, 0.4], [0.15, 0.3])
    four = settled(*case, rigid=True)
    monkeypatch.setattr(settlement, "_RIGID", 8)
    np.testing.assert_allclose(four, settled(*case, rigid=True), rtol=1e-5)
    # Less than under a uniform pressure at the centre, alike far away.
    ratio = four / settled(*case)
    assert 0.90 < ratio[0] < 0.96
    assert ratio[-1] == pytest.approx(1.0, abs=1e-3)


def test_columns_side_by_side_are_those_alone():
    rng = np.random.default_rng(3)
    moduli = 10 ** rng.uniform([9, 8, 7.5], [10.3, 9, 8.4], (5, 3))
    top, base = rng.uniform(0.05, 0.3, 5), rng.uniform(0.15, 0.5, 5)
    plate = Plate.of(RADIUS, OFFSETS, 0.05, 20.0, rigid=False)
    poisson = np.tile([0.35, 0.35, 0.4], (5, 1))
    columns = Columns.of(plate.nodes, [top[:, None], base[:, None]], poisson, [np.inf] * 2, rigid=False)
    shear = (moduli / (2 * (1 + poisson)))[:, None]
    both = plate.settlement(*columns.kernel(shear))
    at = np.array([3, 1])
    np.testing.assert_array_equal(plate.settlement(*columns.rows(at).kernel(shear[at])), both[at])
    other = columns.with_thickness(0, 2 * top[:, None]).kernel(shear)
    again = Columns.of(plate.nodes, [2 * top[:, None], base[:, None]], poisson, [np.inf] * 2, rigid=False)
    np.testing.assert_array_equal(plate.settlement(*other), plate.settlement(*again.kernel(shear)))
