"""The array library of the kernels: the loop of normal contact runs on nothing but the array API standard."""

import sys

import array_api_strict
import numpy as np
import pytest

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.errors import InputError
from treadload.kernels import fft
from treadload.kernels.half_space.rectangle import CombinedElasticity

BODIES = HalfSpaces(CombinedElasticity(1e6, 0.4, 0.0))
N, DX, LOAD = 50, 2e-3, 200.0
X = DX * (np.arange(N) - (N - 1) / 2)
DOME = (X[None, :] ** 2 + X[:, None] ** 2) / (2 * 0.3)
GROOVED = np.where(np.abs(X)[None, :] < 6e-3, np.nan, DOME)


def influence():
    return Influence((N, N), DX, DX, BODIES)


@pytest.fixture
def strict():
    """A stand-in for the library of a GPU: only what the standard of 2023 has, and no mixing with NumPy."""
    array_api_strict.set_array_api_strict_flags(api_version="2023.12")
    with fft.on(array_api_strict):
        yield array_api_strict
    array_api_strict.reset_array_api_strict_flags()


@pytest.mark.parametrize("gap", [DOME, GROOVED], ids=["dome", "grooved"])
@pytest.mark.parametrize("given", [{"load": LOAD}, {"approach": 4e-4}], ids=["load", "approach"])
def test_the_loop_uses_nothing_but_the_standard(gap, given, strict):
    found = solve_normal(influence(), gap, **given)
    assert isinstance(found.pressure, np.ndarray)
    with fft.on(np):
        expected = solve_normal(influence(), gap, **given)
    # Single precision rounds otherwise in another library; either is within the tolerance of 1e-6 of the approach.
    np.testing.assert_allclose(found.pressure, expected.pressure, atol=2e-5 * expected.pressure.max())
    assert found.approach == pytest.approx(expected.approach, rel=1e-6)
    assert found.residual <= 1e-6


def test_arrays_go_to_the_device_and_come_back(strict):
    there = fft.to_device(DOME)
    assert fft.namespace(there) is strict
    np.testing.assert_array_equal(fft.to_host(there), DOME)
    assert fft.namespace(DOME) is np
    assert fft.to_host(DOME) is DOME


@pytest.mark.parametrize("real", [np.float32, float])
def test_transforms_of_any_library_are_those_of_scipy(real, strict):
    field = np.random.default_rng(3).normal(size=(12, 10)).astype(real)
    there = fft.to_device(field)
    round_off = 10 * np.finfo(real).eps
    for ours, theirs in (
        (fft.rfft(field, n=16), fft.rfft(there, n=16)),
        (fft.rfft2(field, s=(14, 12)), fft.rfft2(there, s=(14, 12))),
        (fft.irfft2(fft.rfft2(field), s=(12, 10)), fft.irfft2(fft.rfft2(there), s=(12, 10))),
        (fft.ifft(fft.fft(fft.rfft(field), n=20)), fft.ifft(fft.fft(fft.rfft(there), n=20))),
        (fft.irfft(fft.rfft(field), n=10), fft.irfft(fft.rfft(there), n=10)),
    ):
        assert fft.to_host(theirs).dtype == ours.dtype
        np.testing.assert_allclose(fft.to_host(theirs), ours, atol=round_off * np.abs(ours).max())


def test_an_unknown_device_is_refused(monkeypatch):
    monkeypatch.setenv("TREADLOAD_DEVICE", "tpu")
    with pytest.raises(InputError, match="TREADLOAD_DEVICE is 'tpu'; it can be cpu or cuda"):
        solve_normal(influence(), DOME, load=LOAD)


def test_a_device_without_its_library_says_what_to_install(monkeypatch):
    monkeypatch.setenv("TREADLOAD_DEVICE", "cuda")
    monkeypatch.setitem(sys.modules, "cupy", None)
    with pytest.raises(InputError, match="CuPy is not installed; install"):
        solve_normal(influence(), DOME, load=LOAD)


def test_the_device_named_is_the_one_used(monkeypatch):
    """CUDA's library takes the arrays where it is there: here a stand-in of its name."""
    monkeypatch.setenv("TREADLOAD_DEVICE", "cuda")
    monkeypatch.setitem(sys.modules, "cupy", array_api_strict)
    assert fft.device() is array_api_strict
    assert solve_normal(influence(), DOME, load=LOAD).residual <= 1e-6
