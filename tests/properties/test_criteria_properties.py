"""Criteria do not know the axes they are written in, and grow with the load as they should."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from treadload.damage.fields import known_quantities
from treadload.damage.quantity import STRAIN, STRESS
from treadload.kernels import tensors

ORDER = ([0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2])
stresses = arrays(float, (6, 3), elements=st.floats(-1e6, 1e6))
angles = arrays(float, 3, elements=st.floats(-np.pi, np.pi))
# Criteria of the horizontal and the vertical know the vertical, and only that.
VERTICAL = ("vertical_shear_strain", "horizontal_tension", "in_plane_extension", "vertical_compression")
# What a pressure from all sides leaves.
NORMAL = ("mean_stress", "horizontal_tension", "principal_tension", "vertical_compression")
DEGREE = {"distortion_energy": 2}
MODULUS, POISSON = 5.4e9, 0.35


def criteria(stress):
    strain = tensors.strain_from_stress(stress, MODULUS, POISSON)
    told = {name: one for name, one in known_quantities().items() if set(one.needs) <= {*STRESS, *STRAIN}}
    return {name: np.asarray(one.of(stress, strain)) for name, one in told.items()}


def turned(stress, rotation):
    full = np.einsum("ij,njk,lk->nil", rotation, tensors.matrices(stress), rotation)
    return np.moveaxis(full[:, ORDER[0], ORDER[1]], 0, -1)


def scale_of(name, stress):
    """Size of a criterion for a stress of this size; round-off is in parts of it."""
    size = np.abs(stress).max() + 1.0
    if name == "distortion_energy":
        return size**2 / MODULUS
    return size / (MODULUS if "strain" in name else 1)


@settings(max_examples=60, deadline=None)
@given(stresses, angles)
def test_rotation_changes_no_criterion(stress, angle):
    rotation = Rotation.from_euler("zyx", angle).as_matrix()
    before, after = criteria(stress), criteria(turned(stress, rotation))
    for name in set(before) - set(VERTICAL):
        # A square root doubles the digits lost where the criterion vanishes.
        loss = 1e-12 if name in ("extension_strain", "mean_stress", "distortion_energy") else 3e-7
        np.testing.assert_allclose(after[name], before[name], rtol=1e-9, atol=loss * scale_of(name, stress))


@settings(max_examples=60, deadline=None)
@given(stresses, st.floats(-np.pi, np.pi))
def test_rotation_about_the_vertical_changes_none_at_all(stress, angle):
    rotation = Rotation.from_euler("z", angle).as_matrix()
    before, after = criteria(stress), criteria(turned(stress, rotation))
    for name in VERTICAL:
        np.testing.assert_allclose(
            after[name], before[name], rtol=1e-9, atol=1e-12 * scale_of(name, stress), err_msg=name
        )


@settings(max_examples=60, deadline=None)
@given(stresses, st.floats(0.01, 100))
def test_criteria_are_homogeneous(stress, factor):
    before, after = criteria(stress), criteria(factor * stress)
    for name in before:
        expected = factor ** DEGREE.get(name, 1) * before[name]
        loss = 1e-11 * scale_of(name, stress) * factor ** DEGREE.get(name, 1)
        np.testing.assert_allclose(after[name], expected, rtol=1e-9, atol=loss, err_msg=name)


@settings(max_examples=40, deadline=None)
@given(stresses)
def test_some_are_never_negative_and_pressure_from_all_sides_breaks_nothing(stress):
    found = criteria(stress)
    for name in ("mazars_strain", "von_mises_strain", "octahedral_shear_stress", "vertical_shear_strain"):
        assert (found[name] >= 0).all(), name
    # ½ s:e of one tensor and its multiple: round-off of squares.
    assert (found["distortion_energy"] >= -1e-15 * scale_of("distortion_energy", stress)).all()
    # Round-off of a root, and squares that underflow.
    largest = np.maximum(found["extension_strain"], 0)
    assert (found["mazars_strain"] >= largest * (1 - 1e-14) - 1e-100).all()
    squeezed = criteria(np.array([-1e6, -1e6, -1e6, 0.0, 0.0, 0.0])[:, None])
    for name in set(squeezed) - {*NORMAL, "extension_strain", "in_plane_extension"}:
        assert squeezed[name] == pytest.approx(0, abs=1e-12 * scale_of(name, np.array(1e6)))


@settings(max_examples=40, deadline=None)
@given(stresses, st.floats(1e6, 1e11), st.floats(0.0, 0.45))
def test_distortion_energy_is_kunsts_form(stress, modulus, poisson):
    strain = tensors.strain_from_stress(stress, modulus, poisson)
    (s1, s2, s3), _ = tensors.principal(stress)
    form = (1 + poisson) / (6 * modulus) * ((s1 - s2) ** 2 + (s2 - s3) ** 2 + (s3 - s1) ** 2)
    # Round-off of squares of stress.
    atol = 1e-13 * (np.abs(stress).max() + 1) ** 2 / modulus
    np.testing.assert_allclose(tensors.distortion_energy(stress, strain), form, rtol=1e-9, atol=atol)
