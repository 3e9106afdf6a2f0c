"""Layers on a half-space or a rigid base, one horizontal wavenumber at a time: compliance from the bottom up.

Fields vary as exp(i k·x). In the frame of the wave vector k = (k, 0) the plane P-SV part, displacements
(i u_k, u_z) and forces (i f_k, f_z), and the transverse SH part, u_t and f_t, separate; f is the force that
the body above exerts downwards on the body below, f = -σ·n with n along +z. In this frame every quantity of
an elastic body is real. Displacements u are times k, as in a `Transfer`.

A layer is known in mixed form, u_top = C f_top + T u_bottom, f_bottom = Tᵀ f_top - K u_bottom: held at its bottom
and free at its top, it has finite compliances C and stiffnesses K in every case, thin, thick or incompressible, and
long waves lose no digits, as all differences are written out. The body below is known by its compliance S and by
det S, as multiples of a number that may be 0: no stiffness becomes infinite on a rigid base, no compliance above a
frictionless interface. All of it is linear in these five numbers, and what is summed for the diagonals is positive.
Displacement and force are unknowns: no output needs a derivative in z.

Source: equations of elasticity of a plane layer, solved with the waves of Kennett (1983), Seismic Wave Propagation in
Stratified Media, chapter 6, in the static limit; minors as unknowns after Dunkin (1965), Bull. Seismol. Soc. Am. 55,
335-358; the spring between layers after Goodman, Taylor and Brekke (1968), J. Soil Mech. Found. Div. ASCE 94,
637-659.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from treadload.kernels.arrays import Array, Reals
from treadload.kernels.layers.depths import layers_at, snapped
from treadload.kernels.layers.upright import Upright

# Below this phase, k times the thickness, sinh x - x is summed as a series: the difference would lose digits.
_SHORT = 0.5

Scalars = Reals
"""Numbers, one or one per wavenumber; complex of moduli with memory, of which the algebra is the same."""


@dataclass(frozen=True)
class Stack:
    """Layers from the surface down.

    shear: shear modulus of each layer, Pa, a number or an array over the wavenumbers, real or complex.
    poisson: Poisson's ratio of each layer; 0.5 is allowed.
    thickness: of each layer, m; without rigid base the last one is not read.
    spring: stiffness of each interface between layers against relative sliding, Pa/m, len(shear) - 1 values:
    inf for bonded layers, 0 for a frictionless interface; normal displacement is continuous.
    rigid: True if the last layer is bonded to a rigid base, False if it is a half-space.
    upright: of each layer what it has of its own along z, None where it is isotropic, or () if all of them are. Of
    those that have it `shear` and `poisson` are those in the horizontal plane.
    """

    shear: Sequence[Scalars]
    poisson: Sequence[float]
    thickness: Sequence[float]
    spring: Sequence[float]
    rigid: bool = False
    upright: Sequence[Upright | None] = ()

    def upright_of(self, layer: int) -> Upright | None:
        """What a layer has of its own along z, None in isotropy."""
        return self.upright[layer] if self.upright else None

    def lift_of(self, layer: int) -> float:
        """Horizontal normal stress by vertical where nothing strains horizontally: ν / (1 - ν) in isotropy."""
        upright = self.upright_of(layer)
        return self.poisson[layer] / (1 - self.poisson[layer]) if upright is None else upright.lift

    @property
    def moduli(self) -> list[float]:
        """Shear moduli of all layers, in the plane and across it: of real moduli, for scales."""
        return [float(shear) for shear in self.shear] + [
            upright.shear for upright in self.upright if upright is not None
        ]

    def faded(self, depth: float) -> float:
        """How deep a depth, m, lies for waves: they fall at least like e^{-k times it}; itself in isotropy."""
        if not any(self.upright):
            return depth
        total, top = 0.0, 0.0
        for layer, end in enumerate([*self.interfaces[: len(self.shear) - 1], math.inf]):
            upright = self.upright_of(layer)
            rate = 1.0 if upright is None else upright.fade(float(self.shear[layer]), float(self.poisson[layer]))
            total += rate * max(0.0, min(depth, end) - top)
            top = end
        return total

    @property
    def top(self) -> Stack:
        """The half-space of the top layer."""
        return Stack(self.shear[:1], self.poisson[:1], (), (), upright=self.upright[:1])

    @property
    def interfaces(self) -> Array:
        """Depth of each interface between layers, and of the rigid base, m."""
        count = len(self.shear) - (0 if self.rigid else 1)
        return np.cumsum(np.asarray(self.thickness[:count], dtype=float))

    def layer_at(self, depth: float, below: bool) -> int:
        """Number of the layer that holds a depth; on an interface, within round-off, the one above or below it."""
        return int(layers_at([depth], self.interfaces[: len(self.shear) - 1], below)[0])

    def snapped(self, depths: Sequence[float] | Array) -> Array:
        """Depths, m, those on an interface or the rigid base within round-off as exactly its own."""
        return snapped(depths, self.interfaces)


@dataclass(frozen=True)
class Transfer:
    """What unit loads at the surface do at each depth, per wavenumber.

    plane: (nz, 4, 2, nk); rows k·i u_k, k·u_z, i f_k, f_z; columns the loads i f_k = 1 and f_z = 1.
    transverse: (nz, 2, nk): k·u_t and f_t under f_t = 1.
    Displacements times k are in m · 1/m per Pa, that is 1/Pa.
    """

    plane: Array
    transverse: Array


def transfer(wavenumbers: ArrayLike, stack: Stack, depths: Sequence[float], below: Sequence[bool]) -> Transfer:
    """Displacement and force at depths under unit loads on the surface.

    wavenumbers: (nk,), 1/m, > 0. depths: (nz,), m, >= 0 and not below a rigid base, in any order.
    below: for each depth, whether a value on an interface, within round-off, is that of the layer below it.
    Returns a Transfer, complex where the moduli are. Memory: about 20 numbers per wavenumber, layer and depth.
    """
    k = np.asarray(wavenumbers, dtype=float)
    depths = stack.snapped(depths).tolist()
    slabs, bodies = upwards(k, stack, depths)
    kind = np.result_type(float, bodies[0].plane.xx, bodies[0].transverse)
    fields = np.zeros((len(depths), 4, 2, len(k)), kind)
    sliding = np.zeros((len(depths), 2, len(k)), kind)
    force, shear = np.zeros((2, 2, len(k)), kind), np.ones(len(k), kind)
    force[0, 0] = force[1, 1] = 1

    def put(rows: list[int], moved: Array, swayed: Array) -> None:
        fields[rows, :2], fields[rows, 2:] = moved, force
        sliding[rows, 0], sliding[rows, 1] = swayed, shear

    put([i for i, z in enumerate(depths) if z <= 0], bodies[0].plane.under(force), bodies[0].transverse * shear)
    for slab, body in zip(slabs, bodies[1:], strict=True):
        rows = [i for i, z in enumerate(depths) if z > 0 and z == slab.bottom]
        moved, force = slab.down(body.sprung, force)
        swayed, shear = slab.down_transverse(body.sprung_transverse, shear)
        put([i for i in rows if not (below[i] and body.slides)], moved, swayed)
        if body.slides:
            put([i for i in rows if below[i]], body.plane.under(force), body.transverse * shear)
    return Transfer(fields, sliding)


@dataclass(frozen=True)
class Compliance:
    """Of a body at its top, k u = S f: S = [[xx, xz], [xz, zz]] / scale and det = det S · scale; all (nk,).

    scale: 1, or 0 where the body holds nothing along x.
    """

    scale: Scalars
    xx: Scalars
    zz: Scalars
    xz: Scalars
    det: Scalars

    def under(self, force: Array) -> Array:
        """Displacement (2, 2, nk) under forces (2, 2, nk), where `scale` is 1."""
        return np.stack([self.xx * force[0] + self.xz * force[1], self.xz * force[0] + self.zz * force[1]])


@dataclass(frozen=True)
class Body:
    """All that lies below a depth.

    plane, transverse: compliance at its top. sprung, sprung_transverse: the same with the spring that holds the layer
    above, the transverse one as (scale, compliance). slides: whether there is such a spring.
    """

    plane: Compliance
    transverse: Scalars
    sprung: Compliance
    sprung_transverse: tuple[Scalars, Scalars]
    slides: bool

    @classmethod
    def of(cls, plane: Compliance, transverse: Scalars, k: Array, spring: float, shear: Scalars) -> Body:
        """With a spring, Pa/m, between it and a layer whose shear modulus gives the scale."""
        if spring == math.inf:
            return cls(plane, transverse, plane, (1.0, transverse), False)
        # The spring adds k / spring to the compliance xx; as multiples of `scale` neither 0 nor inf occurs.
        scale = spring + k * np.abs(shear)
        scaled_spring, free = spring / scale, k / scale
        at_rigid_bond = Compliance(
            scaled_spring,
            scaled_spring * plane.xx + free,
            scaled_spring * plane.zz,
            scaled_spring * plane.xz,
            scaled_spring * plane.det + free * plane.zz,
        )
        return cls(plane, transverse, at_rigid_bond, (scaled_spring, scaled_spring * transverse + free), True)


@dataclass(frozen=True)
class Slab:
    """Part of a layer between neighbouring depths of output or interfaces, in mixed form; all (nk,).

    c: compliance of its top, held at its bottom, 1/Pa. k: stiffness of its bottom, free at its top, Pa. t: what its
    top shows of its bottom, T. Lists are xx, zz, xz and the determinant; of t xx, xz, zx, zz and the determinant.
    """

    bottom: float
    c: tuple[Scalars, ...]
    k: tuple[Scalars, ...]
    t: tuple[Scalars, ...]
    c_transverse: Scalars
    k_transverse: Scalars
    t_transverse: Scalars

    @classmethod
    def of(
        cls, k: Array, shear: Scalars, poisson: Scalars, thickness: Scalars, bottom: float, upright: Upright | None
    ) -> Slab:
        """A slab of a material at wavenumbers k (nk,); all of it may be arrays over these."""
        a = k * thickness
        if upright is not None:
            return cls._upright(a, float(shear), float(poisson), upright, bottom)
        squeeze = 2 - 4 * poisson
        chi, more = 1 + squeeze, 2 + squeeze
        e = np.exp(-a)
        ee, aa = e * e, a * e
        # 1 - e⁻²ᵃ and 1 - e⁻⁴ᵃ; 2 e⁻ᵃ (sinh a - a) and 2 e⁻²ᵃ (sinh 2a - 2a).
        two, four = -np.expm1(-2 * a), -np.expm1(-4 * a)
        odd, double = two - 2 * aa, four - 4 * aa * e
        short = np.flatnonzero(a < _SHORT)
        if len(short):
            odd[short] = 2 * e[short] * _sinh_less(a[short])
            double[short] = 2 * ee[short] * _sinh_less(2 * a[short])
        square, cross = two * two, 8 * aa * aa
        part = 1 / (chi * square + ee * (more * more) + 4 * aa * aa)
        soft, stiff = 0.25 * part / shear, part * shear
        half, rise, turn = 0.5 * more * part * e, 2 * a * two, more * (1 + ee)
        tilt, pull = 2 * a * (1 + ee), squeeze * two
        # What couples both directions vanishes at ν = 0, or 0.25, but for cubes of a: written out where a is small.
        lean, bend = tilt - pull, cross - chi * squeeze * square
        if len(short):
            brief = a < _SHORT
            lean = np.where(brief, 4 * poisson * two + 2 * a * np.expm1(-a) ** 2 - 2 * odd, lean)
            bend = np.where(brief, (1 - squeeze) * more * square - 2 * odd * (two + 2 * aa), bend)
        tanh = two / (1 + ee)
        return cls(
            bottom,
            (
                soft * more * (chi * four + 4 * aa * e),
                soft * more * (squeeze * four + double),
                soft * bend,
                soft / shear * (pull + odd) * (chi * two + 2 * aa),
            ),
            (
                stiff * more * (four + 4 * aa * e),
                stiff * more * double,
                -stiff * (squeeze * square + cross),
                4 * stiff * shear * odd * (two + 2 * aa),
            ),
            (
                half * (turn - rise),
                -half * (pull + tilt),
                half * lean,
                half * (turn + rise),
                part * ee * (more * more),
            ),
            tanh / shear,
            tanh * shear,
            2 * e / (1 + ee),
        )

    @classmethod
    def _upright(cls, a: Array, shear: float, poisson: float, upright: Upright, bottom: float) -> Slab:
        (cx, cz, cc), (kx, kz, kc), t = upright.slab(a, shear, poisson)
        modulus, turn = math.sqrt(shear * upright.shear), a * upright.roots(shear, poisson)[2]
        e, tanh = np.exp(-turn), np.tanh(turn)
        return cls(
            bottom,
            (cx, cz, cc, cx * cz - cc * cc),
            (kx, kz, kc, kx * kz - kc * kc),
            t,
            tanh / modulus,
            tanh * modulus,
            2 * e / (1 + e * e),
        )

    def up(self, s: Compliance) -> Compliance:
        """Compliance at the top, on a body of compliance s."""
        (cx, cz, cc, cd), (txx, txz, tzx, tzz, td) = self.c, self.t
        sum_, xx, zz, xz = self._together(s)
        row = txx * xx + txz * xz, txx * xz + txz * zz
        second_row = tzx * xx + tzz * xz, tzx * xz + tzz * zz
        px, pz = (row[0] * txx + row[1] * txz) / sum_, (second_row[0] * tzx + second_row[1] * tzz) / sum_
        pc = (row[0] * tzx + row[1] * tzz) / sum_
        det = cd + cz * px + cx * pz - 2 * cc * pc + td * td * s.det / sum_
        return Compliance(1.0, cx + px, cz + pz, cc + pc, det)

    def down(self, s: Compliance, force: Array) -> tuple[Array, Array]:
        """Displacement and force (2, 2, nk) at the bottom, on a body of compliance s, under a force at the top."""
        (kx, kz, kc, _), (txx, txz, tzx, tzz, _) = self.k, self.t
        sum_, xx, zz, xz = self._together(s)
        x, z = (txx * force[0] + tzx * force[1]) / sum_, (txz * force[0] + tzz * force[1]) / sum_
        # (1 + K S)⁻¹ = (1 + adj S adj K) / det(1 + K S)
        ax, az = kz * x - kc * z, kx * z - kc * x
        return (
            np.stack([xx * x + xz * z, xz * x + zz * z]),
            np.stack([s.scale * x + s.zz * ax - s.xz * az, s.scale * z + s.xx * az - s.xz * ax]),
        )

    def _together(self, s: Compliance) -> tuple[Scalars, Scalars, Scalars, Scalars]:
        """Determinant of 1 + K S; (S⁻¹ + K)⁻¹ times that: xx, zz, xz."""
        kx, kz, kc, kd = self.k
        together = s.scale + kx * s.xx + kz * s.zz + 2 * kc * s.xz + kd * s.det
        return together, s.xx + s.det * kz, s.zz + s.det * kx, s.xz - s.det * kc

    def up_transverse(self, s: tuple[Scalars, Scalars]) -> Scalars:
        """As `up`, of the transverse part."""
        base, compliance = s
        return self.c_transverse + self.t_transverse**2 * compliance / (base + self.k_transverse * compliance)

    def down_transverse(self, s: tuple[Scalars, Scalars], force: Array) -> tuple[Array, Array]:
        """As `down`, of the transverse part."""
        base, compliance = s
        carried = self.t_transverse * force / (base + self.k_transverse * compliance)
        return compliance * carried, base * carried


def upwards(k: Array, stack: Stack, depths: Sequence[float]) -> tuple[list[Slab], list[Body]]:
    """Slabs from the surface down to the rigid base or the deepest depth, and the body below each and below none."""
    parts = pieces(stack, depths)
    transverse: Scalars
    if stack.rigid:
        zero = np.zeros_like(k)
        plane, transverse = Compliance(1.0, zero, zero, zero, zero), zero
    else:
        plane, transverse = _half_space(np.ones_like(k), stack)
    slabs: list[Slab] = []
    bodies: list[Body] = []
    for layer, thickness, bottom, spring in reversed(parts):
        shear = stack.shear[layer]
        bodies.append(Body.of(plane, transverse, k, spring, shear))
        upright = stack.upright_of(layer)
        slabs.append(Slab.of(k, shear, stack.poisson[layer], thickness, bottom, upright))
        plane, transverse = slabs[-1].up(bodies[-1].sprung), slabs[-1].up_transverse(bodies[-1].sprung_transverse)
    bodies.append(Body.of(plane, transverse, k, math.inf, 1.0))
    return slabs[::-1], bodies[::-1]


def _half_space(ones: Array, stack: Stack) -> tuple[Compliance, Scalars]:
    """Compliance of the last layer as a half-space, plane and transverse."""
    shear, poisson, upright = stack.shear[-1], stack.poisson[-1], stack.upright_of(-1)
    if upright is not None:
        xx, zz, xz, transverse = (entry * ones for entry in upright.half_space(float(shear), poisson))
        return Compliance(1.0, xx, zz, xz, xx * zz - xz * xz), transverse
    shear, squeeze = shear * ones, 2 - 4 * poisson
    diagonal = (2 + squeeze) / (4 * shear)
    return Compliance(1.0, diagonal, diagonal, -squeeze / (4 * shear), (1 + squeeze) / (4 * shear * shear)), 1 / shear


def pieces(stack: Stack, depths: Sequence[float]) -> list[tuple[int, float, float, float]]:
    """Layers cut at depths of output, down to the last: number of the layer, thickness, bottom, spring below."""
    ends = [*stack.interfaces, *([] if stack.rigid else [math.inf])]
    springs = [*stack.spring, math.inf]
    parts: list[tuple[int, float, float, float]] = []
    top = 0.0
    for layer, end in enumerate(ends):
        for cut in sorted({float(z) for z in depths if top < z < end}):
            parts.append((layer, cut - top, cut, math.inf))
            top = cut
        if end < math.inf:
            parts.append((layer, end - top, float(end), springs[layer]))
            top = float(end)
    return parts


def _sinh_less(x: Array) -> Array:
    """The difference sinh x - x for 0 <= x <= 1, to round-off."""
    square = x * x
    total = np.ones_like(x)
    for n in range(17, 3, -2):
        total = 1 + total * square / (n * (n - 1))
    return total * x * square / 6
