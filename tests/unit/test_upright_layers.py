"""Layers that are another along z: beside the matrix exponential, half-spaces and isotropic layers; in contact."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.linalg import expm

import treadload as tl
from treadload.contact.bodies.anisotropic import AnisotropicHalfSpace
from treadload.contact.bodies.body import Offsets, Waves
from treadload.contact.bodies.choose import road_surface, surface_of
from treadload.contact.bodies.upright import UprightHalfSpace
from treadload.kernels.layers.images import fit_images, surface_compliance
from treadload.kernels.layers.layered import Stack, transfer
from treadload.pavement.stack import stack_of
from treadload.response.several import Question, tensors_of_many
from upright import MATERIALS, decays, nearly, plane_of, upright_of

MIX, UNBOUND, WEAK, NEAR = MATERIALS.values()
SOIL = tl.Elastic(80e6, 0.4)
K = np.geomspace(1e-5, 2e3, 40)


def road(*layers, rigid=False):
    """Of (material, thickness[, bond])."""
    return tl.Pavement([tl.Layer(one[0], *one[1:2], bond=one[2]) if len(one) > 2 else tl.Layer(*one)
                        for one in layers], rigid_base=rigid)  # fmt: skip


# Kept apart: neighbours of one material that are bonded are one layer.
GLUED = tl.pavement.Bond(1e25)


@pytest.mark.parametrize("name", MATERIALS)
def test_layers_follow_the_matrix_exponential(name):
    """On rock, where what goes down and comes up is known: (u, f) at the top from (0, f) at the base."""
    material, other = MATERIALS[name], UNBOUND
    stack = stack_of(road((material, 0.1), (other, 0.25), rigid=True))

    def generator(solid):
        (shear, poisson), own = plane_of(solid), upright_of(solid)
        plate = 2 * shear / (1 - poisson)
        return np.array(
            [[0, 1, -1 / own.shear, 0], [-own.lift, 0, 0, -1 / own.along], [-plate, 0, 0, own.lift], [0, 0, -1, 0]]
        )

    for k in (0.5, 4.0, 15.0):
        found = transfer([k], stack, [0.0, 0.1, 0.35], [False] * 3).plane[..., 0]
        for thickness, solid, top, bottom in ((0.1, material, 0, 1), (0.25, other, 1, 2)):
            # In units of a modulus, so that the exponential is of order one.
            scale = np.array([1 / material.shear] * 2 + [1, 1])
            step = expm(generator(solid) * np.outer(1 / scale, scale) * k * thickness)
            size = np.abs(step).max() * np.abs(found[top] / scale[:, None]).max()
            error = np.abs(found[bottom] / scale[:, None] - step @ (found[top] / scale[:, None])).max()
            # The exponential itself amplifies round-off of the top by what grows.
            assert error < 1e-12 * size
        assert np.abs(found[2, :2]).max() < 1e-13 * np.abs(found[0, :2]).max()
        assert found[0, 2:] == pytest.approx(np.eye(2), abs=1e-15)


@pytest.mark.parametrize("name", MATERIALS)
def test_equal_layers_are_one_half_space_in_every_wave(name):
    material, depths = MATERIALS[name], [0.0, 0.01, 0.06, 0.2, 0.5]
    several = stack_of(road((material, 0.06, GLUED), (material, 0.1, GLUED), (material, 0.04, GLUED), (material,)))
    several = Stack(several.shear, several.poisson, several.thickness, [math.inf] * 3, False, several.upright)
    whole = stack_of(road((material,)))
    one, other = (transfer(K, stack, depths, [False] * 5) for stack in (several, whole))
    scale = np.array([1 / material.shear] * 2 + [1, 1])[:, None, None]
    # A few hundred roundings, and ten doublings.
    assert np.abs(one.plane - other.plane).max(axis=(0, 2, 3), keepdims=False) / scale[:, 0, 0] == pytest.approx(
        0, abs=1e-12
    )
    np.testing.assert_allclose(one.transverse[:, 1], other.transverse[:, 1], rtol=0, atol=1e-12)
    # And the half-space is that of the two waves, whose traction is that of the load.
    own, (s1, s2) = upright_of(material), decays(material)
    kappa = 1 + own.across / own.shear

    def wave(s):
        below = own.across + own.along * s * s
        return np.array([1 / own.shear - kappa / below, kappa * s / below, s, 1])

    modes = np.stack([wave(s1), wave(s2)], axis=1)
    weights = np.linalg.solve(modes[2:], np.eye(2))
    for row, z in enumerate(depths):
        fades = np.exp(-np.outer([s1, s2], K * z))
        expected = np.einsum("ia,ak,al->ilk", modes, fades, weights).real
        # What the two modes lose where they are near each other.
        lost = 1e-13 / min(1, abs(s1 - s2))
        assert np.abs(other.plane[row] - expected)[:2].max() < 20 * lost * np.abs(expected[:2]).max() + 1e-25
        assert np.abs(other.plane[row] - expected)[2:].max() < 20 * lost


def test_springs_frictionless_interfaces_and_reciprocity():
    stack = stack_of(
        road((MIX, 0.06, tl.pavement.Bond(1e9)), (UNBOUND, 0.15, tl.pavement.FRICTIONLESS), (WEAK, 0.3), (SOIL,))
    )
    result = transfer(K, stack, [0.06, 0.06, 0.21, 0.21], [False, True] * 2)
    above, under = result.plane[::2], result.plane[1::2]
    np.testing.assert_allclose(above[:, 1:], under[:, 1:], rtol=1e-10, atol=1e-20)
    slide = (above[0, 0] - under[0, 0]) / K
    slack = 1e-10 * np.abs(above[0, 0]) / K * 1e9
    assert (np.abs(above[0, 2] - 1e9 * slide) <= 1e-10 * np.abs(above[0, 2]) + slack).all()
    assert np.abs(above[1, 2]).max() <= 1e-10
    surface = transfer(K, stack, [0.0], [False]).plane[0, :2]
    assert (np.abs(surface[0, 1] - surface[1, 0]) <= 1e-10 * np.abs(surface).max(axis=(0, 1))).all()


def test_long_waves_on_rock_compress_and_shear_column_by_column():
    stack = stack_of(road((MIX, 0.2), (UNBOUND, 0.5), rigid=True))
    k = np.geomspace(1e-12, 1e-3, 10)
    surface = transfer(k, stack, [0.0], [False]).plane[0]
    columns = [(upright_of(one), h) for one, h in ((MIX, 0.2), (UNBOUND, 0.5))]
    # Corrections are (k H)² times the contrast.
    np.testing.assert_allclose(surface[1, 1] / k, sum(h / own.along for own, h in columns), rtol=2e-5)
    np.testing.assert_allclose(surface[0, 0] / k, sum(h / own.shear for own, h in columns), rtol=2e-5)


GRID = tl.response.Grid.centred(0.1, 0.08, 0.02)
WHERE = {"x": np.linspace(-0.2, 0.21, 7), "y": np.linspace(-0.15, 0.16, 5)}


def loads():
    rng = np.random.default_rng(7)
    cells = tl.response.GridLoad(GRID, rng.random(GRID.shape) * 1e6, *rng.normal(size=(2, *GRID.shape)) * 2e5)
    smooth = tl.response.GridLoad(GRID, cells.pressure, cells.traction_x, cells.traction_y, "bilinear")
    return {"cells": cells, "bilinear": smooth, "disc": tl.UniformDisc(0.1, 7e5)}


def apart(one, other):
    """Largest difference of any field, over the largest value of its kind."""
    worst = 0.0
    for kind in ("stress", "strain", "displacement"):
        names = [name for name in other.dataset if str(name).startswith(kind + "_")]
        size = max(float(np.abs(other.dataset[name]).max()) for name in names)
        worst = max(worst, *(float(np.abs(one.dataset[name] - other.dataset[name]).max()) / size for name in names))
    return worst


@pytest.mark.parametrize("kind", ["cells", "bilinear", "disc"])
@pytest.mark.parametrize("name", ["compacted asphalt", "unbound, E_v = 2 E_h"])
def test_layers_all_equal_respond_as_the_half_space(kind, name):
    load, material = loads()[kind], MATERIALS[name]
    several = road((material, 0.06, GLUED), (material, 0.1, GLUED), (material,))
    asked = {"depths": [0.0, 0.02, 0.055, 0.1, 0.4], **WHERE}
    found, whole = tl.solve_response(load, several, **asked), tl.solve_response(load, road((material,)), **asked)
    assert "layered" in found.stats["method"]
    assert "layered" not in whole.stats["method"]
    assert apart(found, whole) < 1e-8


@pytest.mark.parametrize("kind", ["cells", "bilinear", "disc"])
def test_a_layer_split_by_a_millionth_responds_as_an_isotropic_one(kind):
    asphalt, base = tl.Elastic(7e9, 0.35), tl.Elastic(3e8, 0.35)
    asked = {"depths": [0.0, 0.02, 0.07, 0.2, 0.5], **WHERE}
    plain = tl.solve_response(loads()[kind], road((asphalt, 0.08), (base, 0.3), (SOIL,)), **asked)
    split = tl.solve_response(
        loads()[kind], road((nearly(asphalt, 1e-6), 0.08), (nearly(base, 1e-6), 0.3), (nearly(SOIL, 1e-6),)), **asked
    )
    assert apart(split, plain) < 1e-5
    equal = tl.solve_response(
        loads()[kind], road((nearly(asphalt, 0), 0.08), (nearly(base, 0), 0.3), (nearly(SOIL, 0),)), **asked
    )
    # Round-off, and what quadratures leave.
    assert apart(equal, plain) < 1e-9


def test_many_roads_under_many_loads_are_each_alone():
    """As lives solve them: roads that share a top share its half-space, and only what is read is computed."""
    soft, stiff = dataclasses.replace(MIX, vertical=3.0e9), road((MIX, 0.08), (UNBOUND, 0.3), (SOIL,))
    roads = [
        stiff,
        road((soft, 0.08), (UNBOUND, 0.3), (SOIL,)),
        road((MIX, 0.08), (WEAK, 0.2), (SOIL,)),
        road((MIX,)),
    ]
    cells, depths = loads()["cells"], np.array([0.0, 0.03, 0.08])
    questions = [Question([cells], one, depths) for one in roads]
    needs = ("strain_xx", "strain_zz", "stress_xz")
    found = tensors_of_many(questions, WHERE["x"], WHERE["y"], needs=needs)
    for one, together in zip(roads, found, strict=True):
        alone = tl.solve_response(cells, one, depths=depths, **WHERE).dataset
        for name in needs:
            exact = alone[name].to_numpy()
            # What readings need, in single numbers.
            np.testing.assert_allclose(together[name].to_numpy(), exact, rtol=0, atol=3e-6 * np.abs(exact).max())


def test_gridded_and_axisymmetric_loads_meet_on_layers():
    """A disc of cells: two syntheses, one in two directions and one in the distance."""
    layers = road((MIX, 0.08), (UNBOUND, 0.3), (SOIL,))
    fine = tl.response.Grid.centred(0.24, 0.24, 0.004)
    sub = (np.arange(8) + 0.5) / 8 - 0.5
    x = (fine.x[:, None] + fine.dx * sub).ravel()
    inside = (np.hypot(x[None], x[:, None]) < 0.1).reshape(fine.ny, 8, fine.nx, 8).mean(axis=(1, 3))
    zero = np.zeros(fine.shape)
    asked = {"depths": [0.08, 0.3], "x": [0.0, 0.13], "y": [0.02]}
    cells = tl.solve_response(tl.response.GridLoad(fine, 7e5 * inside, zero, zero), layers, **asked)
    disc = tl.solve_response(tl.UniformDisc(0.1, 7e5), layers, **asked)
    # The area of the disc on cells, and its rim.
    assert apart(cells, disc) < 2e-3


def test_an_upright_base_moves_the_strain_by_what_its_own_moduli_say():
    # Far below, a thick layer carries vertical stress that hardly depends on it; ε_zz follows E_v and not E_h.
    soft = tl.materials.TransverselyIsotropic(100e6, 200e6, 75e6, 0.3, 0.3)
    isotropic = tl.Elastic(200e6, 0.3)
    asked = {"depths": [0.3], "x": [0.0], "y": [0.0]}
    disc = tl.UniformDisc(0.15, 7e5)
    found, plain = (tl.solve_response(disc, road((tl.Elastic(5e9, 0.35), 0.1), (one,)), **asked).dataset
                    for one in (soft, isotropic))  # fmt: skip
    assert float(found["stress_zz"].squeeze()) == pytest.approx(float(plain["stress_zz"].squeeze()), rel=0.15)
    stress = np.array([float(found[f"stress_{name}"].squeeze()) for name in ("xx", "yy", "zz", "xy", "xz", "yz")])
    strain = np.array([float(found[f"strain_{name}"].squeeze()) for name in ("xx", "yy", "zz", "xy", "xz", "yz")])
    voigt = soft.stiffness @ np.array([*strain[:3], 2 * strain[5], 2 * strain[4], 2 * strain[3]])
    np.testing.assert_allclose(voigt[[0, 1, 2, 5, 4, 3]], stress, rtol=1e-10, atol=1e-9 * abs(stress).max())


def contact_modulus(material):
    """2 / L_zz of the symbol, Turner (1980)."""
    c = material.stiffness
    both = math.sqrt(c[0, 0] * c[2, 2])
    total = math.sqrt((both - c[0, 2]) * (both + c[0, 2] + 2 * c[3, 3]) / (c[2, 2] * c[3, 3]))
    return 2 * (both**2 - c[0, 2] ** 2) / (total * both)


def barnett_lothe(material):
    """L of the surface, u = L t / k, by the mean over directions in the plane of the wave and the normal."""
    at = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
    c = material.stiffness[at][:, :, at]
    h, s, b = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    for angle in np.arange(256) * np.pi / 256:
        one, two = np.array([np.cos(angle), 0, np.sin(angle)]), np.array([-np.sin(angle), 0, np.cos(angle)])
        aa, ab, bb = (np.einsum("j,ijkl,l", x, c, y) for x, y in ((one, one), (one, two), (two, two)))
        inverse = np.linalg.inv(bb)
        h, s, b = h + inverse, s - inverse @ ab.T, b + aa - ab @ inverse @ ab.T
    stiff = np.linalg.inv(b / 256)
    return stiff - 1j * (s / 256) @ stiff


@pytest.mark.parametrize("name", MATERIALS)
def test_the_contact_modulus_and_the_four_numbers_of_the_surface(name):
    material = MATERIALS[name]
    body = road_surface(road((material,)))
    assert isinstance(body, UprightHalfSpace)
    assert body.contact_modulus == pytest.approx(contact_modulus(material), rel=1e-12)
    symbol = barnett_lothe(material)
    assert body.contact_modulus == pytest.approx(2 / symbol[2, 2].real, rel=1e-12)
    compliance = surface_compliance(np.ones(1), stack_of(road((material,))))[:, 0]
    normal, coupling, transverse, difference = compliance
    assert transverse == pytest.approx(symbol[1, 1].real, rel=1e-12)
    assert transverse + difference == pytest.approx(symbol[0, 0].real, rel=1e-12)
    # i u_k by the pressure t_z.
    assert coupling == pytest.approx((1j * symbol[0, 2]).real, rel=1e-11)
    assert normal == pytest.approx(symbol[2, 2].real, rel=1e-12)


@pytest.mark.parametrize("name", MATERIALS)
@pytest.mark.parametrize("is_tire", [False, True])
def test_the_body_is_that_of_any_anisotropy(name, is_tire):
    """Another derivation: the symbol by averages over directions, coefficients by its harmonics."""
    material = MATERIALS[name]
    one = surface_of(material, is_tire=is_tire)
    other = AnisotropicHalfSpace.of(material.stiffness, is_tire=is_tire)
    assert isinstance(one, UprightHalfSpace)
    for at in (Offsets(5, 6, 0.003, 0.004), Offsets(5, 6, 0.003, 0.004, -0.0021)):
        for quantity in ("normal", "tangential", "coupling"):
            found, expected = getattr(one, quantity)(at), getattr(other, quantity)(at)
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * np.abs(expected).max())
    np.testing.assert_allclose(one.across(np.ones(2)), other.across(np.ones(2)), rtol=1e-12)


def test_elastic_layers_under_a_moving_wheel_are_those_at_rest():
    layers, load = road((MIX, 0.1), (UNBOUND, 0.3), (SOIL,)), tl.UniformDisc(0.1, 7e5)
    asked = {"depths": [0.1], "x": [0.0, 0.2], "y": [0.0]}
    moving = tl.solve_response(load, layers, speed=20.0, **asked)
    assert apart(moving, tl.solve_response(load, layers, **asked)) == 0
    assert float(moving.dataset["dissipated_energy"].max()) == 0


def test_isotropic_numbers_give_the_body_of_an_isotropic_half_space():
    material = tl.Elastic(5e9, 0.3)
    at, waves = Offsets(6, 5, 0.003, 0.004, 0.0), Waves((6, 8), 0.003, 0.004)
    one, other = road_surface(road((nearly(material, 0),))), road_surface(road((material,)))
    for quantity in ("normal", "tangential", "coupling"):
        found, expected = getattr(one, quantity)(at), getattr(other, quantity)(at)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * np.abs(expected).max())
    np.testing.assert_allclose(one.compliance(waves), other.compliance(waves), rtol=1e-12, atol=1e-25)
    np.testing.assert_allclose(one.across(np.ones(2)), other.across(np.ones(2)), rtol=1e-12)


@pytest.mark.parametrize(
    "layers",
    [
        road((MIX, 0.06), (UNBOUND, 0.3), (SOIL,)),
        road((WEAK, 0.06, tl.pavement.Bond(1e9)), (UNBOUND, 0.3), (MIX,)),
        road((UNBOUND, 0.4), rigid=True),
        road((SOIL, 0.1), (MIX, 0.2), (UNBOUND,)),
    ],
    ids=["asphalt", "weak in shear", "rock", "isotropic top"],
)
def test_images_hold_layers(layers):
    stack = stack_of(layers)
    images = fit_images(stack)
    assert images.residual < 1e-6
    k = np.geomspace(0.1, 300, 31)
    whole = surface_compliance(k, stack)
    top = surface_compliance(np.ones(1), stack.top)
    np.testing.assert_allclose(images.at(k)[0] + top[0], whole[0], rtol=2e-5)


def test_layers_all_equal_are_the_half_space_in_contact():
    at = tl.response.Grid.centred(0.03, 0.03, 0.001).x
    gap = (at[None] ** 2 + at[:, None] ** 2) / 2
    steel = tl.Tire.from_height_map(gap, 0.001, material=tl.Elastic(210e9, 0.3))
    wheel = tl.Rolling(normal_load=2e3, friction=0.3, tractive_force=200.0)
    equal = road((MIX, 0.05, GLUED), (MIX,))
    one = tl.solve_contact(steel, equal, wheel, road_compliance="layers")
    other = tl.solve_contact(steel, road((MIX,)), wheel)
    for name in ("pressure", "traction_x"):
        size = float(np.abs(other.dataset[name]).max())
        # The images' fit, and the tolerance of the contact.
        assert float(np.abs(one.dataset[name] - other.dataset[name]).max()) < 2e-4 * size
    # Hertz: the approach of two half-spaces whose compliances add up, from the nearest cell, but for cells of a/7.
    smooth = tl.solve_contact(steel, road((MIX,)), tl.Rolling(normal_load=2e3, friction=0.0))
    modulus = 1 / (1 / contact_modulus(MIX) + (1 - 0.3**2) / 210e9)
    radius = (3 * 2e3 * 1.0 / (4 * modulus)) ** (1 / 3)
    assert float(smooth.dataset["approach"]) == pytest.approx(radius**2 - gap.min(), rel=2e-3)


def test_layers_that_remember_beside_it_are_refused_but_for_their_limits():
    mix = tl.materials.Prony(5e9, ((0.5, 0.1),), 0.35)
    both = road((mix, 0.1), (UNBOUND, 0.3), (SOIL,))
    asked = {"depths": [0.1], "x": [0.0], "y": [0.0]}
    disc = tl.UniformDisc(0.1, 7e5)
    with pytest.raises(tl.InputError, match=r"^layer '' is transversely isotropic, .* speed=math.inf"):
        tl.solve_response(disc, both, speed=20.0, **asked)
    fast = tl.solve_response(disc, both, speed=math.inf, **asked)
    plain = tl.solve_response(disc, road((tl.Elastic(5e9, 0.35), 0.1), (UNBOUND, 0.3), (SOIL,)), **asked)
    assert apart(fast, plain) == 0
