"""Settlement of the surface under a plate, for many layered columns at once: what deflection bowls are fitted with.

u(r) = P / (2π) ∫ g(k) T(k a) J0(k r) dk, with g(k) = k u_z(k) / f_z(k) of the layers and T the transform of the
plate's pressure. g less that of the top layer's half-space falls like exp(-2 k h₁) and is smooth over panels that
double: it is known at a few points of each, and its integral is a sum with weights that all columns share. The
half-space itself has a closed form (Weber and Schafheitlin). Slabs of unit shear modulus are computed once: a change
of moduli costs some forty products for each wavenumber and layer.

Source: as `kernels.layers.layered`; integrals of two Bessel functions after Watson (1944), A Treatise on the Theory
of Bessel Functions, section 13.4.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
import scipy

from treadload.kernels.arrays import Array, IntArray, Numbers
from treadload.kernels.layers.doubling import panels_up_to
from treadload.kernels.layers.layered import Body, Compliance, Scalars, Slab

# Points of a panel, which spans a factor of two: what g lacks there falls like 6⁻ⁿ.
_POINTS = 9
# Wavenumbers end where exp(-2 k h₁) is 1e-10, and the panel at zero at this over the length of the basin.
_END, _BEGIN = 11.5, 0.25
# Pressures of a rigid plate: (1 - r²/a²)^(m - 1/2) for m below this; a fifth moves the settlement by less than 1e-4.
_RIGID = 4


@dataclass(frozen=True, eq=False)
class Plate:
    """A loaded plate and the points of the surface that are read.

    nodes: wavenumbers (nk,), 1/m. weights: (load, point, nk), of g less that of the top half-space. direct: (load,
    point), of the top half-space alone. inside: points within the plate that a rigid plate keeps level; 0 for a
    uniform pressure. Points: those first, then the sensors.
    """

    nodes: Array
    weights: Array
    direct: Array
    inside: int

    @classmethod
    def of(
        cls, radius: float, offsets: Sequence[float] | Array, thinnest: float, basin: float, *, rigid: bool
    ) -> Plate:
        """A plate of a radius, m, and sensors at offsets from its axis (s,), m, >= 0.

        thinnest: of the top layers, m, inf for a half-space. basin: length over which the deepest layers spread the
        load, m: their depth times the cube root of the largest ratio of moduli. rigid: True for a plate that stays
        level, without shear below; False for a uniform pressure.
        """
        orders = [m + 0.5 for m in range(_RIGID)] if rigid else [1.0]
        inside = radius * np.cos((2 * np.arange(_RIGID) + 1) * math.pi / (4 * _RIGID)) if rigid else np.zeros(0)
        points = np.concatenate([inside, np.asarray(offsets, dtype=float)])
        direct = np.array([[_half_space(order, radius, float(r)) for r in points] for order in orders])
        first = _BEGIN / basin
        limit = 2 * first if math.isinf(thinnest) else _END / thinnest
        nodes, weights = [], []
        for at, k, w, shares in panels_up_to(first, limit, _POINTS, radius + float(points.max(initial=0.0))):
            nodes.append(at)
            turned = scipy.special.j0(np.outer(points, k)) * w
            weights.append(np.stack([(turned * _transform(order, k * radius)) @ shares for order in orders]))
        return cls(np.concatenate(nodes), np.concatenate(weights, axis=-1), direct, len(inside))

    def settlement(self, kernel: Array, top: Array) -> Array:
        """Settlement (..., s) of the sensors under 1 N, m. kernel: g (..., nk), 1/Pa. top: its limit (...)."""
        loads = [
            (top[..., None] * direct + (kernel - top[..., None]) @ weights.T) / (2 * math.pi)
            for direct, weights in zip(self.direct, self.weights, strict=True)
        ]
        if not self.inside:
            return np.asarray(loads[0])
        # Shares of the pressures for which all points inside settle alike, and carry 1 N together.
        each, count = np.stack(loads, axis=-1), self.inside
        system = np.zeros((*each.shape[:-2], count + 1, count + 1), each.dtype)
        size = np.abs(each[..., :count, :]).max(axis=(-2, -1))
        system[..., :count, :count] = each[..., :count, :] / size[..., None, None]
        system[..., :count, count] = -1.0
        system[..., count, :count] = 1.0
        wanted = np.zeros((*system.shape[:-1], 1), each.dtype)
        wanted[..., count, 0] = 1.0
        shares = np.linalg.solve(system, wanted)[..., :count, :]
        return np.asarray((each[..., count:, :] @ shares)[..., 0])


def _transform(order: float, x: Array) -> Array:
    """Transform of μ (1 - r²/a²)^(μ-1) / (π a²), a load of 1 N, at x = k a: Γ(μ+1) (2/x)^μ J_μ(x)."""
    return np.asarray(scipy.special.gamma(order + 1) * (2 / x) ** order * scipy.special.jv(order, x))


def _half_space(order: float, radius: float, r: float) -> float:
    """∫ T(k a) J0(k r) dk from 0 to ∞, 1/m."""
    scale = scipy.special.gamma(order + 1) * math.sqrt(math.pi)
    if r <= radius:
        return float(
            scale
            / (radius * scipy.special.gamma(order + 0.5))
            * scipy.special.hyp2f1(0.5, 0.5 - order, 1.0, (r / radius) ** 2)
        )
    return float(
        scale
        / (r * scipy.special.gamma(order + 1) * scipy.special.gamma(0.5))
        * scipy.special.hyp2f1(0.5, 0.5, order + 1, (radius / r) ** 2)
    )


@dataclass(frozen=True, eq=False)
class Columns:
    """Layered columns of given geometry, whose shear moduli change.

    slabs: of unit shear modulus, from the surface down, each (n, v, nk), v variants of a column or 1. poisson: of
    each
    layer (n, L). spring: stiffness of each interface, Pa/m, inf bonded. rigid: True on a rigid base.
    """

    nodes: Array
    slabs: tuple[Slab, ...]
    poisson: Array
    spring: tuple[float, ...]
    rigid: bool

    @classmethod
    def of(
        cls, nodes: Array, thickness: Sequence[Array], poisson: Array, spring: Sequence[float], *, rigid: bool
    ) -> Columns:
        """Columns at wavenumbers (nk,). thickness: of each layer that has one (n, v), m. poisson: (n, L)."""
        slabs = [_slab(nodes, depth, poisson[:, number]) for number, depth in enumerate(thickness)]
        return cls(nodes, tuple(slabs), poisson, tuple(spring), rigid)

    def with_thickness(self, layer: int, thickness: Array) -> Columns:
        """The columns with another thickness (n, v), m, of a layer."""
        slabs = list(self.slabs)
        slabs[layer] = _slab(self.nodes, thickness, self.poisson[:, layer])
        return Columns(self.nodes, tuple(slabs), self.poisson, self.spring, self.rigid)

    def rows(self, chosen: IntArray) -> Columns:
        """Some of the columns, by number."""
        slabs = tuple(_changed(slab, lambda entry: entry[chosen]) for slab in self.slabs)
        return Columns(self.nodes, slabs, self.poisson[chosen], self.spring, self.rigid)

    def bottom(self, shear: Array) -> Compliance:
        """Of what lies below the slabs: a rigid base, or a half-space of a shear modulus (n, v, nk), Pa."""
        if self.rigid:
            zero = np.zeros_like(shear)
            return Compliance(1.0, zero, zero, zero, zero)
        squeeze = (2 - 4 * self.poisson[:, -1])[:, None, None]
        diagonal = (2 + squeeze) / (4 * shear)
        return Compliance(1.0, diagonal, diagonal, -squeeze / (4 * shear), (1 + squeeze) / (4 * shear * shear))

    def spring_below(self, number: int) -> float:
        """Stiffness of the interface below a slab, Pa/m; inf below the last layer."""
        return self.spring[number] if number < len(self.spring) else math.inf

    def kernel(self, moduli: Numbers) -> tuple[Array, Array]:
        """Kernel g (n, v, nk), 1/Pa, and its limit for short waves, of shear moduli, Pa, real or complex.

        moduli: (n, v, L), the limit (n, v); or with moduli of each wavenumber (n, v, L, nk), the limit (n, v, nk).
        """
        # Of complex ones the algebra is the same, see `layered.Scalars`.
        shear = cast("Array", moduli)
        ones = np.ones((*shear.shape[:2], len(self.nodes)))
        spread = shear.ndim == 4
        below = self.bottom((shear[:, :, -1] if spread else shear[..., -1:]) * ones)
        for number in reversed(range(len(self.slabs))):
            modulus = shear[:, :, number] if spread else shear[..., number : number + 1]
            body = Body.of(below, 0.0, self.nodes, self.spring_below(number), modulus)
            below = scaled(self.slabs[number], modulus).up(body.sprung)
        stiffness = 1 - self.poisson[:, :1]
        limit = stiffness[..., None] / shear[:, :, 0] if spread else stiffness / shear[..., 0]
        return np.asarray(below.zz), np.asarray(limit)


def _slab(nodes: Array, thickness: Array, poisson: Array) -> Slab:
    """Slabs of unit shear modulus: (n, v, nk) each. thickness: (n, v), m. poisson: (n,)."""
    shape = (*thickness.shape, len(nodes))
    depth = np.broadcast_to(thickness[..., None], shape).ravel()
    ratio = np.broadcast_to(poisson[:, None, None], shape).ravel()
    k = np.broadcast_to(nodes, shape).ravel()
    slab = Slab.of(k, np.ones_like(k), ratio, depth, 0.0, None)
    return _changed(slab, lambda entry: entry.reshape(shape))


def _changed(slab: Slab, change: Callable[[Array], Array]) -> Slab:
    c, k, t = (tuple(change(np.asarray(entry)) for entry in entries) for entries in (slab.c, slab.k, slab.t))
    return Slab(slab.bottom, c, k, t, 0.0, 0.0, 0.0)


def scaled(slab: Slab, modulus: Scalars) -> Slab:
    """A slab of unit shear modulus with another one, (n, v, 1)."""
    (cx, cz, cc, cd), (kx, kz, kc, kd) = slab.c, slab.k
    softness, square = 1 / modulus, modulus * modulus
    return Slab(
        slab.bottom,
        (cx * softness, cz * softness, cc * softness, cd * (softness * softness)),
        (kx * modulus, kz * modulus, kc * modulus, kd * square),
        slab.t,
        0.0,
        0.0,
        0.0,
    )
