"""Strain from stress, principal values and directions, invariants."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadload.kernels import tensors
from treadload.kernels.largest import ALIKE

fields = arrays(float, (6, 7), elements=st.floats(-1e-3, 1e-3))


def test_uniaxial_stress():
    strain = tensors.strain_from_stress(np.array([2e6, 0, 0, 0, 0, 0.0]), 5e9, 0.35)
    # Round-off of a closed form.
    np.testing.assert_allclose(strain, [4e-4, -1.4e-4, -1.4e-4, 0, 0, 0], rtol=1e-14)


def test_shear_strain_is_the_tensors():
    modulus, poisson = 5e9, 0.3
    strain = tensors.strain_from_stress(np.array([0, 0, 0, 1e6, 2e6, 3e6]), modulus, poisson)
    shear_modulus = modulus / (2 * (1 + poisson))
    np.testing.assert_allclose(strain[3:], np.array([1e6, 2e6, 3e6]) / (2 * shear_modulus), rtol=1e-14)


def test_incompressible_strain_has_no_trace():
    stress = np.random.default_rng(1).normal(size=(6, 20))
    strain = tensors.strain_from_stress(stress, 1.0, 0.5)
    # Round-off of numbers of order one.
    np.testing.assert_allclose(strain[:3].sum(axis=0), 0, atol=1e-14)


@settings(max_examples=200, deadline=None)
@given(fields, st.sampled_from([1e-300, 1e-9, 1.0, 1e12, 1e200]), st.floats(-1e4, 1e4))
def test_principal_values_in_closed_form_are_those_of_the_solver(field, factor, pressure):
    """Also where values are equal, near each other, or small beside a mean."""
    field = factor * (field + 1e-3 * pressure * np.array([1, 1, 1, 0, 0, 0.0])[:, None])
    exact = np.linalg.eigvalsh(tensors.matrices(field)).T[::-1]
    found = tensors.principal_values(field)
    # Round-off of the largest component, a hundred times it where φ has lost as much before LAPACK takes over.
    np.testing.assert_allclose(found, exact, rtol=0, atol=5e-14 * np.abs(field).max())
    assert (np.diff(found, axis=0) <= 1e-13 * np.abs(field).max()).all()
    np.testing.assert_allclose(tensors.largest_principal(field), exact[0], rtol=0, atol=5e-14 * np.abs(field).max())


@settings(max_examples=100, deadline=None)
@given(st.floats(0, 1e-2), st.integers(0, 2**32 - 1))
def test_principal_values_near_each_other(apart, seed):
    """Two values a known distance apart in any frame: the formula alone would be off by the root of round-off."""
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    for values in ([1.0, 1.0 - apart, -2.0], [2.0, apart - 1.0, -1.0]):
        full = turn @ np.diag(values) @ turn.T
        tensor = full[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        np.testing.assert_allclose(tensors.principal_values(tensor[:, None])[:, 0], values, rtol=0, atol=1e-13)
        np.testing.assert_allclose(tensors.largest_principal(tensor[:, None])[0], values[0], rtol=0, atol=1e-13)


@settings(max_examples=100, deadline=None)
@given(fields)
def test_principal_values_and_direction(field):
    values, direction = tensors.principal(field)
    full = tensors.matrices(field)
    scale = 1e-15 + np.abs(field).max()
    # Backward stable: a few units of round-off of the largest component.
    np.testing.assert_allclose(values, np.linalg.eigvalsh(full)[:, ::-1].T, atol=1e-13 * scale)
    np.testing.assert_allclose(np.linalg.norm(direction, axis=-1), 1, rtol=1e-13)
    # Of two values that are alike, a direction between theirs is given.
    alike = values[0] - values[1] <= ALIKE * np.abs(values).max(axis=0)
    error = np.einsum("nij,nj->ni", full, direction) - values[0][:, None] * direction
    assert (np.abs(error).max(axis=1) <= np.where(alike, ALIKE, 1e-13) * scale).all()
    leading = [next(c for c in vector if abs(c) > 1e-12) for vector in direction]
    assert min(leading) > 0


@settings(max_examples=100, deadline=None)
@given(fields)
def test_in_plane_values(field):
    value, angle = tensors.in_plane_principal(field)
    full = tensors.matrices(field)[:, :2, :2]
    scale = 1e-15 + np.abs(field).max()
    # Round-off of the largest component.
    np.testing.assert_allclose(value, np.linalg.eigvalsh(full)[:, 1], atol=1e-13 * scale)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    gap = np.abs(np.einsum("ni,nij,nj->n", along, full, along) - value)
    alike = np.diff(np.linalg.eigvalsh(full))[:, 0] <= ALIKE * np.abs(full).max(axis=(1, 2), initial=1e-15)
    assert (gap <= np.where(alike, ALIKE, 1e-13) * scale).all()
    assert (angle > -np.pi / 2).all()
    assert (angle <= np.pi / 2).all()


@settings(max_examples=100, deadline=None)
@given(arrays(float, 6, elements=st.floats(-1e-15, 1e-15)), st.sampled_from([0, 1, 2]))
def test_round_off_does_not_choose_a_direction(noise, least):
    """Of the directions of a double value that nearest to travel is given; across travel, the lateral one."""
    values = np.ones(3)
    values[least] = -1.1
    tensor = np.concatenate([values, np.zeros(3)]) + noise
    expected = [0, 1, 0] if least == 0 else [1, 0, 0]
    # Noise of 1e-15 turns the axis of the third value by as much.
    np.testing.assert_allclose(tensors.principal(tensor[:, None])[1][0], expected, atol=1e-14)
    same = np.array([1.0, 1, 1, 0, 0, 0]) + noise
    np.testing.assert_allclose(tensors.principal(same[:, None])[1][0], [1, 0, 0], atol=1e-14)
    if least == 2:
        assert tensors.in_plane_principal(tensor)[1] == 0


@settings(max_examples=50, deadline=None)
@given(fields)
def test_the_largest_in_space_is_at_least_the_largest_in_the_plane(field):
    values, _ = tensors.principal(field)
    in_plane, _ = tensors.in_plane_principal(field)
    # Round-off of components up to 1e-3.
    assert (values[0] >= in_plane - 1e-17).all()


def test_extension_across_travel_is_at_a_right_angle():
    across = np.array([-1.0, 2.0, -1.0, -0.0, 0.0, 0.0])
    assert tensors.in_plane_principal(across)[1] == np.pi / 2
    np.testing.assert_allclose(tensors.principal(across)[1], [0, 1, 0], atol=1e-15)


@settings(max_examples=50, deadline=None)
@given(arrays(float, (6, 7), elements=st.floats(-1e6, 1e6)))
def test_invariants_from_principal_stress(stress):
    (s1, s2, s3), _ = tensors.principal(stress)
    differences = np.sqrt((s1 - s2) ** 2 + (s2 - s3) ** 2 + (s3 - s1) ** 2)
    # Round-off of stress up to 1e6, under a square root.
    np.testing.assert_allclose(tensors.octahedral_shear(stress), differences / 3, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(tensors.von_mises(stress), differences / np.sqrt(2), rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(tensors.mean(stress), (s1 + s2 + s3) / 3, atol=1e-8)


def test_von_mises_of_a_bar_is_its_stress():
    assert tensors.von_mises(np.array([-3.0, 0, 0, 0, 0, 0])) == pytest.approx(3.0, rel=1e-14)


def test_mazars_counts_extension_alone():
    values = np.array([[3.0, 1.0, -1.0], [4.0, -2.0, -2.0], [-5.0, -3.0, -3.0]])
    np.testing.assert_array_equal(tensors.mazars(values), [5.0, 1.0, 0.0])
