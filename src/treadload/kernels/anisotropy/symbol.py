"""How the surface of an anisotropic half-space answers to waves of traction, without an eigenproblem.

For waves exp(i k m·x) with m = (cos θ, sin θ, 0) and the normal n = (0, 0, 1) into the body,

    u = L(θ) t / k,   L = B⁻¹ - i S B⁻¹,   t: traction on the body at z = 0 (t_z > 0 presses),
    H = <(bb)⁻¹>,  S = -<(bb)⁻¹(ba)>,  B = <(aa) - (ab)(bb)⁻¹(ba)>,   (ab)_ik = a_j C_ijkl b_l,

means over the turns of a = m cos ω + n sin ω, b = -m sin ω + n cos ω. L is Hermitian, its real part has period π, its
imaginary part changes sign over π. Isotropy is no special case.

Sources: Barnett & Lothe (1973), Phys. Norv. 7, 13-19; Ting (1996), Anisotropic Elasticity, chapter 7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.kernels import fft
from treadload.kernels.anisotropy.stiffness import as_tensor
from treadload.kernels.arrays import Array, ComplexArray

# Of the largest value, where means and harmonics count as converged; the next doubling gains the square.
_CONVERGED = 1e-13
_FEWEST, _MOST_MEANS, _MOST_ANGLES = 16, 8192, 4096


class NotConvergedError(ValueError):
    """The directions differ by more than the averages can follow."""


@dataclass(frozen=True, eq=False)
class Symbol:
    """L over directions as a Fourier series: L(θ) = Σ c_n exp(i n θ).

    harmonics: c_n (3, 3, 2 n_max + 1), 1/Pa, n from -n_max to n_max. means: over how many turns ω.
    """

    harmonics: ComplexArray
    means: int

    @property
    def order(self) -> int:
        """n_max, the highest harmonic."""
        return int(self.harmonics.shape[-1]) // 2

    def __call__(self, angle: Array) -> ComplexArray:
        """L (…, 3, 3), 1/Pa, in directions θ (…), rad."""
        waves = np.exp(1j * np.multiply.outer(angle, np.arange(-self.order, self.order + 1)))
        return np.asarray(waves @ self.harmonics.transpose(2, 0, 1).reshape(-1, 9)).reshape(*np.shape(angle), 3, 3)


def surface_symbol(stiffness: Array) -> Symbol:
    """L of a half-space z > 0 in all directions. stiffness: (6, 6), Pa, positive definite.

    As many turns and directions are taken as bring the error below 1e-13 of the largest value.
    Raises NotConvergedError where 4096 directions do not suffice.
    """
    scale = float(np.abs(stiffness).max())
    tensor = as_tensor(stiffness / scale)
    count, means = _FEWEST, _FEWEST
    while True:
        values, means = _converged(tensor, np.pi * np.arange(count) / count, means)
        # L(θ + π) is the conjugate of L(θ).
        harmonics = fft.fft(np.concatenate([values, values.conj()]), axis=0) / (2 * count)
        size = np.abs(harmonics).max((1, 2))
        # The upper half of the harmonics is the error of the lower one.
        if size[count // 2 : -count // 2].max() <= _CONVERGED * size.max():
            break
        count *= 2
        if count > _MOST_ANGLES:
            raise NotConvergedError(f"{_MOST_ANGLES} directions do not resolve the compliance of the surface")
    kept = np.flatnonzero(size[: count // 2] > 1e-3 * _CONVERGED * size.max())
    order = max(int(kept[-1]), 3)
    at = np.arange(-order, order + 1)
    return Symbol(np.moveaxis(harmonics[at], 0, -1) / scale, means)


def symbol_at(stiffness: Array, angle: Array, means: int) -> ComplexArray:
    """L (n, 3, 3), 1/Pa, in directions θ (n,), rad, by means over so many turns ω. stiffness: (6, 6), Pa."""
    return _averages(as_tensor(stiffness), np.asarray(angle, float), means)


def _converged(tensor: Array, angle: Array, means: int) -> tuple[ComplexArray, int]:
    """L (n, 3, 3) at angles (n,), and the number of turns that it took, at least the one given."""
    values = _averages(tensor, angle, means)
    while True:
        finer = _averages(tensor, angle, 2 * means)
        if np.abs(finer - values).max() <= _CONVERGED * np.abs(finer).max():
            return finer, means
        means *= 2
        if means > _MOST_MEANS:
            raise NotConvergedError(f"{_MOST_MEANS} turns do not resolve the compliance of the surface")
        values = finer


def _averages(tensor: Array, angle: Array, means: int) -> ComplexArray:
    m = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
    n = np.array([0.0, 0.0, 1.0])
    mm = np.einsum("nj,ijkl,nl->nik", m, tensor, m, optimize=True)
    mn = np.einsum("nj,ijkl,l->nik", m, tensor, n, optimize=True)
    nn = np.einsum("j,ijkl,l->ik", n, tensor, n)[None]
    nm = mn.transpose(0, 2, 1)
    s_mean, b_mean = np.zeros_like(mm), np.zeros_like(mm)
    for turn in np.pi * np.arange(means) / means:
        c, s = np.cos(turn), np.sin(turn)
        aa = c * c * mm + c * s * (mn + nm) + s * s * nn
        bb = s * s * mm - c * s * (mn + nm) + c * c * nn
        ab = c * c * mn - s * s * nm + c * s * (nn - mm)
        turned = np.linalg.solve(bb, ab.transpose(0, 2, 1))
        s_mean -= turned
        b_mean += aa - ab @ turned
    compliance = np.linalg.inv(b_mean / means)
    # Both are symmetric and antisymmetric but for rounding.
    real = 0.5 * (compliance + compliance.transpose(0, 2, 1))
    odd = (s_mean / means) @ compliance
    return np.asarray(real - 0.5j * (odd - odd.transpose(0, 2, 1)))
