"""Layers on a half-space or a rigid base, one horizontal wavenumber at a time: reflection from the bottom up.

Fields vary as exp(i k·x). In the frame of the wave vector k = (k, 0) the plane P-SV part, displacements
(i u_k, u_z) and forces (i f_k, f_z), and the transverse SH part, u_t and f_t, separate; f is the force that
the body above exerts downwards on the body below, f = -σ·n with n along +z. In this frame every quantity of
an elastic body is real.

Only decaying exponentials appear and the modes stay independent at ν = 0.5, so thick, thin and
incompressible layers lose no digits. Displacement and force are unknowns: no output needs a derivative in z.

Source: reflection matrices after Kennett (1983), Seismic Wave Propagation in Stratified Media, chapter 6,
taken to the static limit; the spring between layers after Goodman, Taylor and Brekke (1968), J. Soil Mech.
Found. Div. ASCE 94, 637-659.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from treadload.kernels.arrays import Array
from treadload.kernels.depths import layers_at, snapped

# On a rigid base waves this long, times the depth of the base, stand for all longer ones: digits lost grow like the
# inverse cube of it and more where ν = 0.5, what is left out shrinks with its fourth power.
_LONGEST = 1e-3

Scalars = Any
"""Real or complex numbers, one or one per wavenumber."""


@dataclass(frozen=True)
class Stack:
    """Layers from the surface down.

    shear: shear modulus of each layer, Pa, a number or an array over the wavenumbers, real or complex.
    poisson: Poisson's ratio of each layer, likewise; 0.5 is allowed.
    thickness: of each layer, m; without rigid base the last one is not read.
    spring: stiffness of each interface between layers against relative sliding, Pa/m, len(shear) - 1 values:
    inf for bonded layers, 0 for a frictionless interface; normal displacement is continuous.
    rigid: True if the last layer is bonded to a rigid base, False if it is a half-space.
    """

    shear: Sequence[Scalars]
    poisson: Sequence[Scalars]
    thickness: Sequence[float]
    spring: Sequence[float]
    rigid: bool = False

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
    pieces = _pieces(stack, depths)
    used = _shortened(k, stack)
    passes = _upwards(used, pieces, stack.rigid)
    plane, transverse = _inverse(passes[0].impedance), 1 / passes[0].transverse
    force, shear = np.zeros_like(plane), np.ones_like(transverse)
    force[0, 0] = force[1, 1] = 1
    fields = np.zeros((len(depths), 4, 2, len(k)), plane.dtype)
    sliding = np.zeros((len(depths), 2, len(k)), plane.dtype)

    def put(rows: list[int]) -> None:
        fields[rows, :2], fields[rows, 2:] = k * plane, force
        sliding[rows, 0], sliding[rows, 1] = k * transverse, shear

    put([i for i, z in enumerate(depths) if z <= 0])
    for number, (piece, above) in enumerate(zip(pieces, passes, strict=True)):
        if above.down is None:
            break
        rows = [i for i, z in enumerate(depths) if z > 0 and z == piece.bottom]
        if number + 1 == len(pieces):
            force, shear = _product(above.base, plane), above.base_transverse * transverse
            plane, transverse = _product(above.down, plane), above.down_transverse * transverse
            put(rows)
            break
        plane, transverse = _product(above.down, plane), above.down_transverse * transverse
        under = passes[number + 1]
        before = plane, transverse
        if math.isfinite(piece.spring):
            # The body below follows less: it carries what the spring lets through.
            slid = (under.impedance[0, 0] * plane[0] + under.impedance[0, 1] * plane[1]) / (
                under.impedance[0, 0] + piece.spring
            )
            plane = np.stack([plane[0] - slid, plane[1]])
            transverse = transverse * (piece.spring / (piece.spring + under.transverse))
        after = plane, transverse
        force, shear = _product(under.impedance, plane), under.transverse * transverse
        plane, transverse = before
        put([i for i in rows if not below[i]])
        plane, transverse = after
        put([i for i in rows if below[i]])
    # What a load does across itself is odd in k.
    fields[:, [0, 1, 2, 3], [1, 0, 1, 0]] *= k / used
    return Transfer(fields, sliding)


def _shortened(k: Array, stack: Stack) -> Array:
    """The wavenumbers at which waves are computed: on a rigid base none below the limit of long waves.

    A soft spring lets layers drift by long waves of its own; it and the frictionless interface keep theirs.
    """
    if not stack.rigid:
        return k
    depth = float(stack.interfaces[-1])
    least = _LONGEST / depth
    stiffest = max(float(np.abs(g).max()) for g in stack.shear)
    if any(spring < 1e3 * least**2 * stiffest * depth for spring in stack.spring):
        return k
    return np.maximum(k, least)


@dataclass(frozen=True)
class _Piece:
    """Part of a layer between two neighbouring depths of output or interfaces."""

    shear: Scalars
    poisson: Scalars
    thickness: float
    bottom: float
    spring: float


@dataclass(frozen=True)
class _Pass:
    """Of one piece: force over displacement at its top, and what carries its top's displacement to its bottom."""

    impedance: Array
    transverse: Array
    down: Any = None
    down_transverse: Any = None
    base: Any = None
    base_transverse: Any = None


def _pieces(stack: Stack, depths: Sequence[float]) -> list[_Piece]:
    ends = [*stack.interfaces, *([] if stack.rigid else [math.inf])]
    springs = [*stack.spring, math.inf]
    pieces: list[_Piece] = []
    top = 0.0
    for layer, end in enumerate(ends):
        for cut in sorted({float(z) for z in depths if top < z < end}):
            pieces.append(_Piece(stack.shear[layer], stack.poisson[layer], cut - top, cut, math.inf))
            top = cut
        pieces.append(_Piece(stack.shear[layer], stack.poisson[layer], end - top, float(end), springs[layer]))
        top = float(end)
    return pieces


def _upwards(k: Array, pieces: Sequence[_Piece], rigid: bool) -> list[_Pass]:
    """Impedance at the top of every piece, from the last one up, returned from the first down."""
    passes: list[_Pass] = []
    under: _Pass | None = None
    for piece in reversed(pieces):
        m = piece.shear * k
        chi = (3 - 4 * piece.poisson) * np.ones_like(k)
        one, zero = np.ones_like(chi), np.zeros_like(chi)
        u_down, f_down = np.array([[one, zero], [one, chi]]), m * np.array([[2 * one, chi - 1], [2 * one, chi + 1]])
        u_up, f_up = np.array([[one, zero], [-one, -chi]]), m * np.array([[-2 * one, 1 - chi], [2 * one, chi + 1]])
        if under is None and not rigid:
            under = _Pass(_product(f_down, _inverse(u_down)), m * one)
            passes.append(under)
            continue
        if under is None:
            reflection, mirror = -_product(_inverse(u_up), u_down), -one
        else:
            z, zt = under.impedance, under.transverse
            if math.isfinite(piece.spring):
                column = z[:, 0]
                z = z - column[:, None] * column[None, :] / (z[0, 0] + piece.spring)
                zt = zt * (piece.spring / (zt + piece.spring))
            reflection = -_product(_inverse(f_up - _product(z, u_up)), f_down - _product(z, u_down))
            mirror = (m - zt) / (m + zt)
        kh = k * piece.thickness
        fade = np.exp(-kh)
        across = fade * np.array([[np.ones_like(kh), kh], [np.zeros_like(kh), np.ones_like(kh)]])
        back = _product(across, _product(reflection, across))
        back_transverse = mirror * fade**2
        waves = _inverse(u_down + _product(u_up, back))
        carry, sway = _product(across, waves), fade / (1 + back_transverse)
        under = _Pass(
            _product(f_down + _product(f_up, back), waves),
            m * (1 - back_transverse) / (1 + back_transverse),
            _product(u_down + _product(u_up, reflection), carry),
            (1 + mirror) * sway,
            _product(f_down + _product(f_up, reflection), carry) if not passes else None,
            m * (1 - mirror) * sway if not passes else None,
        )
        passes.append(under)
    return passes[::-1]


def _product(a: Array, b: Array) -> Array:
    """Product of matrices (2, 2, nk)."""
    product: Array = np.stack([a[0, 0] * b[0] + a[0, 1] * b[1], a[1, 0] * b[0] + a[1, 1] * b[1]])
    return product


def _inverse(a: Array) -> Array:
    """Inverse of matrices (2, 2, nk)."""
    inverse: Array = np.array([[a[1, 1], -a[0, 1]], [-a[1, 0], a[0, 0]]]) / (a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0])
    return inverse
