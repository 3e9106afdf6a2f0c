"""The orthotropic material: its conventions, its turns, what it refuses, and what a case says of it."""

import numpy as np
import pytest
from tests.grain import STRAIGHT, TILTED, isotropic

import treadload as tl
from treadload.life.stiffer import stiffer
from treadload.materials.kinds import upright
from treadload.materials.orthotropic import rotation

MIX = tl.materials.Orthotropic((5e9, 4e9, 3e9), (1.9e9, 1.6e9, 1.5e9), (0.35, 0.3, 0.25))


def test_pulling_along_an_axis_gives_its_modulus_and_its_ratios():
    ratios = np.array([[0, 0.35, 0.3], [0.35 * 4 / 5, 0, 0.25], [0.3 * 3 / 5, 0.25 * 3 / 4, 0]])
    for axis, modulus in enumerate((5e9, 4e9, 3e9)):
        stress = np.zeros(6)
        stress[axis] = 1e6
        strain = MIX.compliance @ stress
        assert strain[axis] == pytest.approx(1e6 / modulus, rel=1e-13)
        across = np.delete(-strain[:3] / strain[axis], axis)
        assert across == pytest.approx(np.delete(ratios[axis], axis), rel=1e-12)
    # yz, xz, xy of engineering shears.
    assert (MIX.stiffness @ [0, 0, 0, 1e-3, 1e-3, 1e-3])[3:] == pytest.approx([1.5e6, 1.6e6, 1.9e6], rel=1e-13)
    assert upright(MIX) == pytest.approx((3e9, (0.3 * 3 / 5 + 0.25 * 3 / 4) / 2))


def test_equal_moduli_are_elastic_and_two_equal_axes_transversely_isotropic():
    same = tl.materials.Orthotropic([5e9] * 3, [5e9 / 2.6] * 3, [0.3] * 3)
    np.testing.assert_allclose(same.stiffness, isotropic(5e9, 0.3), rtol=1e-13, atol=1e-3)
    upright_axis = tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, 0.25)
    ratio = 0.25 * 5.4 / 3.8
    found = tl.materials.Orthotropic((5.4e9, 5.4e9, 3.8e9), (2e9, 1.6e9, 1.6e9), (0.35, ratio, ratio))
    np.testing.assert_allclose(found.stiffness, upright_axis.stiffness, rtol=1e-13, atol=1e-3)
    np.testing.assert_allclose(found.rotated(yaw=0.7).stiffness, found.stiffness, rtol=1e-12, atol=1e-3)


@pytest.mark.parametrize(
    ("turn", "axis", "goes"),
    # z is down: travel turns to the right, upwards; the right turns downwards.
    [({"yaw": 0.3}, 0, (np.cos(0.3), np.sin(0.3), 0)), ({"pitch": 0.3}, 0, (np.cos(0.3), 0, -np.sin(0.3))),
     ({"roll": 0.3}, 1, (0, np.cos(0.3), np.sin(0.3)))],
)  # fmt: skip
def test_turns_go_where_they_say(turn, axis, goes):
    turned = MIX.rotated(**turn)
    np.testing.assert_allclose(turned.rotation[:, axis], goes, atol=1e-15)
    # Stress along the turned axis meets its modulus there.
    stress = np.outer(goes, goes) * 1e6
    strain = turned.compliance @ stress[[0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]]
    tensor = np.diag(strain[:3])
    for value, (i, j) in zip(strain[3:], ((1, 2), (0, 2), (0, 1)), strict=True):
        tensor[i, j] = tensor[j, i] = value / 2
    assert goes @ tensor @ np.array(goes) == pytest.approx(1e6 / MIX.moduli[axis], rel=1e-13)


def test_turns_follow_each_other_and_change_no_eigenvalue():
    once, again = (0.4, -0.7, 1.1), (2.0, 0.3, -0.9)
    both = STRAIGHT.rotated(*once).rotated(*again)
    np.testing.assert_allclose(both.rotation, rotation(*again) @ rotation(*once), atol=1e-14)
    kelvin = np.sqrt([1, 1, 1, 2, 2, 2])
    own, turned = (np.linalg.eigvalsh(one.stiffness * np.outer(kelvin, kelvin)) for one in (STRAIGHT, both))
    np.testing.assert_allclose(turned, own, rtol=1e-13)
    # 21 constants are left, and turning back leaves 9.
    assert (np.abs(TILTED.stiffness) > 1e-6 * TILTED.stiffness.max()).all()
    back = STRAIGHT.rotated(yaw=0.5).rotated(yaw=-0.5).stiffness
    np.testing.assert_allclose(back, STRAIGHT.stiffness, rtol=0, atol=1e-15 * STRAIGHT.stiffness.max())


def test_an_elasticity_that_would_give_energy_is_refused_with_its_eigenvalue():
    compliance = np.linalg.inv(MIX.stiffness)
    compliance[0, 1] = compliance[1, 0] = -1.3 / 5e9
    eigenvalue = np.linalg.eigvalsh(compliance[:3, :3]).min()
    with pytest.raises(tl.InputError, match=r"^this elasticity is not positive definite: the smallest eigen") as told:
        tl.materials.Orthotropic((5e9, 4e9, 3e9), (1.9e9, 1.6e9, 1.5e9), (1.3, 0.3, 0.25))
    assert f"is {eigenvalue:.3g} 1/Pa" in str(told.value)
    assert "root of E_i/E_j, ν_12 = 1.118, ν_13 = 1.291, ν_23 = 1.155" in str(told.value)
    # Each of them alone may come as near as that.
    tl.materials.Orthotropic((5e9, 4e9, 3e9), (1.9e9, 1.6e9, 1.5e9), (1.117, 0.0, 0.0))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (((5e9, 4e9), (1e9,) * 3, (0.3,) * 3), r"moduli must be three numbers, E_1, E_2, E_3, got"),
        ((5e9, (1e9,) * 3, (0.3,) * 3), r"moduli must be three numbers"),
        (((5e9, -4e9, 1e9), (1e9,) * 3, (0.3,) * 3), r"the modulus E_2 must be a positive number of Pa, got -4e\+09"),
        (
            ((5e9,) * 3, (1e9, 1e9, 0), (0.3,) * 3),
            r"the modulus G_23 must be a positive number of Pa, got 0; asphalt",
        ),
        (((5e9,) * 3, (1e9,) * 3, (0.3, np.nan, 0.3)), r"poisson must be three finite numbers, ν_12, ν_13, ν_23"),
        (((5e9,) * 3, (1e9,) * 3, "0.3"), r"poisson must be three numbers"),
        (((5e9,) * 3, (1e9,) * 3, (0.3,) * 3, np.inf), r"yaw must be an angle in rad, got inf"),
    ],
)
def test_bad_numbers_are_told_in_one_sentence(given, said):
    with pytest.raises(tl.InputError, match=said):
        tl.materials.Orthotropic(*given)


def test_it_says_what_it_is():
    assert str(STRAIGHT).startswith("orthotropic, E_1 = 3000 MPa, E_2 = 1500 MPa")
    assert str(TILTED).endswith("turned by yaw 40°, pitch 34°, roll 20°")
    assert eval(repr(STRAIGHT), {"Orthotropic": tl.materials.Orthotropic}) == STRAIGHT


def test_a_stiffer_one_keeps_its_shape():
    for material in (TILTED, tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, 0.25)):
        np.testing.assert_allclose(material.stiffer(1.1).stiffness, 1.1 * material.stiffness, rtol=1e-12, atol=1e-3)
        assert type(material.stiffer(1.1)) is type(material)
    # A sensitivity multiplies the moduli of such layers, too, and does not take them for viscoelastic.
    road = tl.Pavement.half_space(TILTED)
    changed = stiffer(road, 0, 1.05).layers[0].material
    assert changed.moduli[0] > TILTED.moduli[0]
    assert changed.rotation == pytest.approx(TILTED.rotation)
