"""The material with an upright axis: its stiffness, its conventions, what it refuses."""

import numpy as np
import pytest

import treadload as tl
from treadload.materials.anisotropic import eigenvalues, inverted

MIX = tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, 0.25)


def test_pulling_along_an_axis_gives_its_modulus_and_its_ratios():
    # ν_vh is read under vertical stress: what contracts is horizontal. Along the other way it is ν_vh E_h / E_v.
    upright = MIX.compliance @ [0, 0, 1e6, 0, 0, 0]
    assert upright[2] == pytest.approx(1e6 / 3.8e9, rel=1e-14)
    assert -upright[:2] / upright[2] == pytest.approx([0.25, 0.25], rel=1e-13)
    flat = MIX.compliance @ [1e6, 0, 0, 0, 0, 0]
    assert flat[0] == pytest.approx(1e6 / 5.4e9, rel=1e-14)
    assert -flat[1:3] / flat[0] == pytest.approx([0.35, 0.25 * 5.4 / 3.8], rel=1e-13)
    sheared = MIX.stiffness @ [0, 0, 0, 1e-3, 2e-3, 3e-3]
    assert sheared[3:] == pytest.approx([1.6e6, 3.2e6, 3e-3 * 5.4e9 / 2.7], rel=1e-14)


def test_the_stiffness_turns_about_the_vertical_without_change_and_is_elastic_s_where_all_is_equal():
    turn, c = np.radians(31), MIX.stiffness
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    at = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
    full = np.empty((3, 3, 3, 3))
    for row, (i, j) in enumerate(at):
        for column, (k, l) in enumerate(at):
            full[i, j, k, l] = full[j, i, k, l] = full[i, j, l, k] = full[j, i, l, k] = c[row, column]
    turned = np.einsum("ia,jb,kc,ld,abcd->ijkl", *[rotation] * 4, full)
    # Round-off of a sum of 81 products.
    assert np.abs(turned - full).max() < 1e-14 * full.max()

    young, nu = 5e9, 0.3
    same = tl.materials.TransverselyIsotropic(young, young, young / 2.6, nu, nu).stiffness
    lame = young * nu / (1.3 * 0.4)
    expected = np.diag([young / 1.3] * 3 + [young / 2.6] * 3)
    expected[:3, :3] += lame
    assert same == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("ratios", [(0.35, 0.6), (0.35, -0.6), (0.8, 0.4)])
def test_an_elasticity_that_would_give_energy_is_refused_with_its_eigenvalue(ratios):
    horizontal, across = ratios
    compliance = np.diag([1 / 5.4e9, 1 / 5.4e9, 1 / 3.8e9, 1 / 1.6e9, 1 / 1.6e9, 2 * (1 + horizontal) / 5.4e9])
    compliance[0, 1] = compliance[1, 0] = -horizontal / 5.4e9
    compliance[:2, 2] = compliance[2, :2] = -across / 3.8e9
    eigenvalue = np.linalg.eigvalsh(compliance[:3, :3]).min()
    assert eigenvalue < 0
    most = np.sqrt((1 - horizontal) * 3.8 / (2 * 5.4))
    with pytest.raises(tl.InputError, match=r"^this elasticity is not positive definite: the smallest eigen") as told:
        tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, horizontal, across)
    assert f"is {eigenvalue:.3g} 1/Pa" in str(told.value)
    assert f"poisson_vertical between -{most:.3g} and {most:.3g}" in str(told.value)
    # And the bound is where it says.
    tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, horizontal, 0.999 * most)
    with pytest.raises(tl.InputError, match="not positive definite"):
        tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, horizontal, 1.001 * most)


def test_what_is_no_number_or_beyond_all_ratios_is_refused():
    with pytest.raises(tl.InputError, match=r"must lie in \(-1, 1\), got 1\.2, .* is -6\.35e-11 1/Pa"):
        tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 1.2, 0.25)
    with pytest.raises(tl.InputError, match="vertical must be a positive number of Pa, got -1"):
        tl.materials.TransverselyIsotropic(5.4e9, -1.0, 1.6e9, 0.35, 0.25)
    with pytest.raises(tl.InputError, match="poisson_vertical must be a number, got nan"):
        tl.materials.TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, float("nan"))


def test_eigenvalues_are_those_of_the_tensor_and_stiffness_is_the_inverse():
    # Shear in the horizontal plane, twice, and in the vertical planes, twice: ε = σ / 2 G.
    values = eigenvalues(MIX.compliance)
    for shear in (MIX.shear_horizontal, 1.6e9):
        assert np.isclose(values, 1 / (2 * shear), rtol=1e-12, atol=0).sum() == 2
    assert inverted(MIX.compliance, "") @ MIX.compliance == pytest.approx(np.eye(6), abs=1e-14)


def test_it_says_what_it_is():
    assert str(MIX) == (
        "transversely isotropic, E_h = 5400 MPa, E_v = 3800 MPa, G_hv = 1600 MPa, ν_hh = 0.35, ν_vh = 0.25"
    )
    assert eval(repr(MIX), vars(tl.materials)) == MIX
