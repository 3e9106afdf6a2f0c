"""Waves in a plane section of elastic layers, and what comes back of them into the layer of a crack.

Plane strain with Airy's function F = (α + β k d) exp(-k d), d the distance from where its amplitudes (α, β) are
taken, and antiplane shear beside it. Amplitudes are of stress, Pa; displacements are multiplied by k.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array


@dataclass(frozen=True)
class Strip:
    """A layer of a section.

    modulus: Pa. poisson. thickness: m, inf for the last. slip: of its lower interface, m/Pa, 0 where it is bonded,
    inf without friction.
    """

    modulus: float
    poisson: float
    thickness: float
    slip: float = 0.0

    @property
    def shear(self) -> float:
        """Shear modulus, Pa."""
        return self.modulus / (2 * (1 + self.poisson))


def reflections(strips: tuple[Strip, ...], layer: int, k: Array, *, rigid: bool = False) -> tuple[Array, Array]:
    """What the top and the bottom of a layer send back: matrices (nk, 2, 2) from amplitudes to amplitudes.

    strips: from the surface down. layer: number. k: wavenumbers (nk,), 1/m, > 0. rigid: the last strip lies on rock.
    Both for waves that fade away from where they come: amplitudes at the boundary, incoming to outgoing.
    """
    above: Array = np.zeros((len(k), 2, 2))
    for strip in strips[:layer]:
        above = _slid(_through(above, strip, k, up=True), strip.slip, k, up=True)
    below = _bottom(strips, len(k), rigid)
    last = len(strips) if rigid else len(strips) - 1
    for strip in reversed(strips[layer + 1 : last]):
        below = _through(_slid(below, strip.slip, k), strip, k)
    host = strips[layer]
    if layer < len(strips) - 1:
        below = _slid(below, host.slip, k)
    return _reflection(above, host, up=True), _reflection(below, host)


def antiplane_reflections(
    strips: tuple[Strip, ...], layer: int, k: Array, *, rigid: bool = False
) -> tuple[Array, Array]:
    """As `reflections`, of antiplane shear: numbers (nk,)."""
    above: Array = np.zeros(len(k))
    for strip in strips[:layer]:
        above = _slid_antiplane(_tanh(above, strip, k), strip.slip, k)
    below = np.full(len(k), math.inf if rigid else strips[-1].shear)
    last = len(strips) if rigid else len(strips) - 1
    for strip in reversed(strips[layer + 1 : last]):
        below = _tanh(_slid_antiplane(below, strip.slip, k), strip, k)
    host = strips[layer]
    if layer < len(strips) - 1:
        below = _slid_antiplane(below, host.slip, k)
    with np.errstate(invalid="ignore"):
        reflected = [
            np.where(np.isinf(impedance), -1.0, (host.shear - impedance) / (host.shear + impedance))
            for impedance in (above, below)
        ]
    return reflected[0], reflected[1]


def shifted(amplitudes: Array, p: Array) -> Array:
    """Amplitudes (..., 2) at a distance p = k d further on (...), which fade."""
    fade = np.exp(-p)
    return np.stack([(amplitudes[..., 0] + p * amplitudes[..., 1]) * fade, amplitudes[..., 1] * fade], axis=-1)


def _bottom(strips: tuple[Strip, ...], count: int, rigid: bool) -> Array:
    """Stiffness (nk, 2, 2) below the last finite strip, traction by -displacement times k."""
    if rigid:
        return np.full((count, 2, 2), np.inf)
    traction, displacement = _wave(strips[-1])
    return np.broadcast_to(traction @ np.linalg.inv(displacement), (count, 2, 2)).copy()


def _wave(strip: Strip, *, up: bool = False) -> tuple[Array, Array]:
    """Traction (xz, zz) and displacement times k (x, z) of a wave's amplitudes, where these are taken."""
    nu = strip.poisson
    sign = -1.0 if up else 1.0
    traction = np.array([[-sign, sign], [-1.0, 0.0]])
    displacement = np.array([[1.0, -2 * (1 - nu)], [sign, sign * (1 - 2 * nu)]]) / (2 * strip.shear)
    return traction, displacement


def _reflection(stiffness: Array, strip: Strip, *, up: bool = False) -> Array:
    """Out of the boundary from into it, where traction = stiffness x displacement. up: the boundary is the top."""
    into, out = _wave(strip, up=up), _wave(strip, up=not up)
    if np.isinf(stiffness).any():
        return np.broadcast_to(-np.linalg.inv(out[1]) @ into[1], stiffness.shape)
    reflection: Array = -np.linalg.solve(out[0] - stiffness @ out[1], into[0] - stiffness @ into[1])
    return reflection


def _through(stiffness: Array, strip: Strip, k: Array, *, up: bool = False) -> Array:
    """Stiffness at the near side of a strip, from that at its far side."""
    back = _reflection(stiffness, strip, up=up)
    near, far = _wave(strip, up=up), _wave(strip, up=not up)
    p = k * strip.thickness
    shift = np.exp(-p)[:, None, None] * (np.eye(2) + p[:, None, None] * np.array([[0.0, 1.0], [0.0, 0.0]]))
    returned = shift @ back @ shift
    traction, displacement = (at_near + at_far @ returned for at_near, at_far in zip(near, far, strict=True))
    stiffness_through: Array = traction @ np.linalg.inv(displacement)
    return stiffness_through


def _slid(stiffness: Array, slip: float, k: Array, *, up: bool = False) -> Array:
    """Stiffness on the near side of an interface that slides."""
    if slip == 0:
        return stiffness
    if np.isinf(stiffness).any():
        compliance = np.zeros_like(stiffness)
    elif not stiffness.any():
        return stiffness
    else:
        compliance = np.linalg.inv(stiffness)
    # A traction on what lies above pushes it, the same on what lies below pulls it.
    sign = 1.0 if up else -1.0
    slid = np.zeros_like(stiffness)
    if math.isinf(slip):
        with np.errstate(divide="ignore"):
            slid[:, 1, 1] = 1 / compliance[:, 1, 1]
        return slid
    compliance[:, 0, 0] += sign * slip * k
    solved: Array = np.linalg.inv(compliance)
    return solved


def _tanh(stiffness: Array, strip: Strip, k: Array) -> Array:
    """Antiplane stiffness at the near side of a strip, from that at its far side."""
    t = np.tanh(k * strip.thickness)
    with np.errstate(invalid="ignore"):
        ratio: Array = np.where(
            np.isinf(stiffness),
            strip.shear / np.maximum(t, 1e-300),
            strip.shear * (stiffness + strip.shear * t) / (strip.shear + stiffness * t),
        )
    return ratio


def _slid_antiplane(stiffness: Array, slip: float, k: Array) -> Array:
    if slip == 0:
        return stiffness
    if math.isinf(slip):
        return np.zeros_like(stiffness)
    with np.errstate(divide="ignore"):
        slid: Array = 1 / (1 / stiffness + slip * k)
    return slid
