"""A tire on layers: operators that keep their symmetries, what is refused, and what the user is told."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.catalogue import mixes
from treadload.contact.bodies import layers as layered
from treadload.contact.bodies.body import Sum
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.bodies.layers import Layering, images_of
from treadload.errors import ConvergenceError
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.kernels.layers.images import surface_compliance
from treadload.kernels.layers.layered import Stack

STACK = Stack([2.5e9, 1e8, 4e7], [0.35, 0.3, 0.45], [0.04, 0.1, math.inf], [1e9, math.inf])
BODIES = CombinedElasticity.of(4e7, 0.45, STACK.shear[0], STACK.poisson[0])
INFLUENCE = Influence((5, 7), 0.02, 0.03, Sum.of(HalfSpaces(BODIES), Layering(images_of(STACK))))

STEEL, RUBBER = tl.Elastic(210e9, 0.3), tl.Elastic(3e6, 0.5)


def road(bond=tl.pavement.BONDED):
    return tl.Pavement(
        [
            tl.Layer(tl.Elastic(7e9, 0.35), 0.06, "wearing course", bond),
            tl.Layer(tl.Elastic(9e9, 0.35), 0.15, "base"),
            tl.Layer(tl.Elastic(120e6, 0.35), name="soil"),
        ]
    )


def contact(material, layers, friction=0.5, **options):
    x = 2e-3 * (np.arange(24) - 11.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 0.1)
    wheel = tl.Rolling(normal_load=300.0, friction=friction)
    return tl.solve_contact(tl.Tire.from_height_map(gap, 2e-3, material=material), layers, wheel, **options)


def columns(operator):
    """Dense matrix of an operator on (2, ny, nx) or (ny, nx) loads, flattened."""
    shape, many = operator
    size = int(np.prod(shape))
    return np.stack([many(row.reshape(shape)).ravel() for row in np.eye(size)], axis=1)


def tangential(padding):
    xx, yy, xy = INFLUENCE.tangential(padding)

    def product(q):
        x, y = padding.forward(q)
        return padding.inverse(np.array([xx * x + xy * y, xy * x + yy * y]))

    return product


def test_the_normal_operator_is_symmetric_and_positive():
    dense = columns(((5, 7), INFLUENCE.normal))
    np.testing.assert_allclose(dense, dense.T, rtol=0, atol=1e-13 * dense.max())
    assert np.linalg.eigvalsh(dense).min() > 0


def test_the_shift_operator_is_symmetric_and_positive_and_the_rolling_one_monotone():
    dense = columns(((2, 5, 7), tangential(INFLUENCE.padding)))
    np.testing.assert_allclose(dense, dense.T, rtol=0, atol=1e-13 * dense.max())
    assert np.linalg.eigvalsh(dense).min() > 0
    ahead = tangential(INFLUENCE.rolling_padding)
    rolling = columns(((2, 5, 7), lambda q: ahead(q)[..., :-1] - ahead(q)[..., 1:]))
    assert np.linalg.eigvalsh(rolling + rolling.T).min() > 0
    one = rolling[17, 17]
    assert INFLUENCE.self_influence(rolls=True) == pytest.approx(one, rel=1e-10)
    assert INFLUENCE.self_influence(rolls=False) == pytest.approx(dense[17, 17], rel=1e-10)


def test_the_work_of_pressure_and_shear_on_each_other_is_equal():
    rng = np.random.default_rng(3)
    p, q = rng.random((5, 7)), rng.normal(size=(2, 5, 7))
    u = INFLUENCE.displacement(p, np.zeros_like(q))
    assert np.vdot(q, u[:2]) == pytest.approx(np.vdot(p, INFLUENCE.gap_by_shear(q)), rel=1e-10)
    both = INFLUENCE.displacement(p, q)
    np.testing.assert_allclose(both[2], INFLUENCE.normal(p) + INFLUENCE.gap_by_shear(q), rtol=1e-12)


def compliance_at(k):
    """Times k: of u_n by p, of the coupling, of u_t by q_t, of u_k by q_k less that."""
    tire = np.array([1 - 0.45, (1 - 2 * 0.45) / 2, 1.0, -0.45]) / 4e7
    # The road's coupling counts against the tire's.
    return tire + surface_compliance(np.array([k]), STACK)[:, 0]


def test_the_stiffness_symbols_invert_the_compliance_of_a_wave():
    influence = Influence((64, 64), 0.01, 0.01, Sum.of(HalfSpaces(BODIES), Layering(images_of(STACK))))
    k = 2 * np.pi * 3 / 0.64
    normal, _, across, split = compliance_at(k)
    assert influence.normal_stiffness[0, 3] * normal == pytest.approx(k)
    xx, yy, xy = influence.tangential_stiffness_on(influence.shape)[:, 0, 3]
    assert (xx, yy, xy) == pytest.approx((k / (across + split), k / across, 0.0))
    # Turned by 45°, both mix; the product with the compliance is the identity.
    xx, yy, xy = influence.tangential_stiffness_on(influence.shape)[:, 3, 3]
    diagonal = math.sqrt(2) * k
    _, _, across, split = compliance_at(diagonal)
    compliance = np.array([[across + split / 2, split / 2], [split / 2, across + split / 2]]) / diagonal
    np.testing.assert_allclose(np.array([[xx, xy], [xy, yy]]) @ compliance, np.eye(2), atol=1e-12)


def test_layers_are_chosen_and_told():
    layered_one, plain = contact(STEEL, road(), road_compliance="layers"), contact(STEEL, road())
    assert layered_one.stats["layers_solved"]
    assert not plain.stats["layers_solved"]
    assert 0 < layered_one.stats["images_residual"] < 1e-6
    assert plain.stats["road_share"] == pytest.approx(layered_one.stats["road_share"], rel=0.01)
    assert layered_one.stats["road_share"] > 0.9
    # The layers add sinking, and no more iterations.
    assert float(layered_one.dataset.approach) > 1.1 * float(plain.dataset.approach)
    assert layered_one.stats["normal_iterations"] <= plain.stats["normal_iterations"] + 3
    assert layered_one.stats["krylov_iterations"] <= 1.2 * plain.stats["krylov_iterations"]
    assert 'road_compliance="layers"' in plain.warnings[-1]
    assert not layered_one.warnings
    assert "%, it matters" in layered_one.summary()
    assert "change of compliance by layers    +" in layered_one.summary()
    assert "%, they are in" in layered_one.summary()
    assert "%, left out" in plain.summary()


def test_a_soft_tire_is_told_that_the_road_is_negligible():
    soft = contact(RUBBER, road())
    assert soft.stats["road_share"] < 0.01
    assert not soft.warnings
    assert "%, negligible" in soft.summary()
    assert "change of compliance by layers    +" in soft.summary()
    plain = contact(RUBBER, tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), road_compliance="layers")
    assert not plain.stats["layers_solved"]
    assert "layers" not in plain.summary()


def test_a_start_serves_on_layers_too():
    first = contact(STEEL, road(), road_compliance="layers")
    again = contact(STEEL, road(), road_compliance="layers", start=first)
    scale = float(first.dataset.pressure.max())
    np.testing.assert_allclose(again.dataset.pressure, first.dataset.pressure, rtol=0, atol=1e-5 * scale)


def test_without_friction_a_loose_interface_serves():
    found = contact(STEEL, road(tl.pavement.FRICTIONLESS), 0.0, road_compliance="layers")
    assert found.stats["layers_solved"]
    assert np.isfinite(found.dataset.displacement_x).all()
    # A loose top layer carries less.
    held = contact(STEEL, road(), 0.0, road_compliance="layers")
    assert float(found.dataset.approach) > float(held.dataset.approach)


def test_refused():
    with pytest.raises(tl.InputError, match='"half_space" or "layers", got \'layer\''):
        contact(STEEL, road(), road_compliance="layer")
    with pytest.raises(tl.InputError, match=r"frictionless interface lets the layers above it drift.*friction = 0"):
        contact(STEEL, road(tl.pavement.FRICTIONLESS), road_compliance="layers")


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "limit"), [(1e-7, "rubbery"), (1e9, "glassy")])
def test_a_tire_that_remembers_on_layers(speed, limit):
    """Rolling slowly and fast it is one of its elastic limits, on layers that make a third of the compliance."""
    solid = tl.materials.Prony.standard_linear_solid(2e11, 1e11, 5e-3, 0.3)
    x = 2e-3 * (np.arange(24) - 11.5)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 0.1)
    wheel = tl.Rolling(normal_load=300.0, friction=0.5, tractive_force=60.0, speed=speed)
    one, other = (
        tl.solve_contact(
            tl.Tire.from_height_map(gap, 2e-3, material=material), road(), wheel, road_compliance="layers",
            tolerance=1e-9,
        ).dataset
        for material in (solid, getattr(solid, limit))
    )  # fmt: skip
    for name in ("pressure", "traction_x", "traction_y", "displacement_z"):
        scale = float(np.abs(other[name]).max())
        # What is left of the memory, 1e-7 m/s against cells of 2 mm in 5 ms, is far below the solvers' tolerance.
        np.testing.assert_allclose(one[name], other[name], rtol=0, atol=1e-6 * scale)
    assert float(one.creepage_x) == pytest.approx(float(other.creepage_x), rel=1e-6)


def test_layers_that_are_no_elastic_stack_are_refused():
    soft = tl.materials.Prony.standard_linear_solid(4e9, 3e9, 5e-3, 0.35)
    wearing = tl.Layer(tl.Elastic(7e9, 0.35), 0.06, "wearing course")
    layers = tl.Pavement([wearing, tl.Layer(soft, name="binder")])
    with pytest.raises(tl.InputError, match=r"layer 'binder' is viscoelastic .* \.glassy"):
        contact(STEEL, layers, road_compliance="layers")
    half = road(tl.pavement.HALF_BONDED)
    with pytest.raises(tl.InputError, match=r"below layer 'wearing course' is half-bonded.*road\.bond_limits"):
        contact(STEEL, half, road_compliance="layers")
    # As a half-space both serve, and the share is that of the stiff limit.
    bonded = contact(STEEL, road()).stats["road_share"]
    assert contact(STEEL, half).stats["road_share"] == pytest.approx(bonded, rel=1e-12)
    assert contact(STEEL, layers).stats["road_share"] > 0.9
    # A layer that waits for its temperature has no share yet.
    waiting = tl.Pavement([wearing, tl.Layer(mixes["EB-GB3"], 0.15, "base"), tl.Layer(tl.Elastic(1e8, 0.35))])
    assert "road_share" not in contact(STEEL, waiting).stats
    assert "compliance" not in contact(STEEL, waiting).summary()


def test_layers_with_a_grain_tell_their_share_or_why_not():
    top = tl.Elastic(7e9, 0.35)
    plain, upright, grained = (
        tl.Pavement([tl.Layer(top, 0.06), tl.Layer(base, name="base")])
        for base in (
            tl.Elastic(1e9, 0.35),
            # Isotropic to 1e-6, and so is its share.
            tl.materials.TransverselyIsotropic(1e9, 1e9 * (1 + 1e-6), 1e9 / 2.7, 0.35, 0.35),
            tl.materials.Orthotropic((1e9, 8e8, 9e8), (3e8, 3e8, 3e8), (0.3, 0.3, 0.3)),
        )
    )
    known, found = (contact(STEEL, one).stats for one in (plain, upright))
    for name in ("road_share", "layer_share"):
        assert found[name] == pytest.approx(known[name], rel=1e-4)
    unknown = contact(STEEL, grained)
    assert "road_share" not in unknown.stats
    (text,) = [text for text in unknown.warnings if "is not known" in text]
    assert "layer 'base' has a horizontal grain; a TransverselyIsotropic or an Elastic in its place shows" in text
    # Under a soft tire the road does not matter.
    assert not any("is not known" in text for text in contact(tl.Elastic(2e6, 0.5), grained).warnings)


def test_a_fit_that_fails_is_refused(monkeypatch):
    monkeypatch.setattr(layered, "_WORST_FIT", 1e-14)
    with pytest.raises(ConvergenceError, match=r"fitted with an error of .* above 1e-14"):
        images_of(STACK)
