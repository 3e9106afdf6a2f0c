"""Layers one of whose interfaces has parted: traction and fields of a jump of the displacement across it.

One horizontal wavenumber at a time, in the frame of `kernels.layers.layered`. What lies above the interface is free
at the surface and known by the stiffness K of its underside, f = -K u; what lies below by its compliance S, u = S f.
A jump d, displacement above less that below, leaves the traction

    f = -H d,   H = K (1 + S K)⁻¹,

symmetric and not negative: H goes as k² for long waves, which bend and stretch the slab above, and as k for short
ones. A net force makes no jump, and a jump no net force.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.layers.layered import Body, Slab, Stack, pieces, upwards

_Put = Callable[[list[int], Array, Array, Array, Array], None]
"""Rows of depths, displacement and force (2, 2, nk), those across (nk,)."""


@dataclass(frozen=True)
class Jump:
    """What unit jumps of displacement at an interface do at each depth, per wavenumber k.

    plane: (nz, 4, 2, nk); rows k·i u_k, k·u_z, i f_k, f_z as in a `Transfer`; columns the jumps k·i d_k = 1 and
    k·d_z = 1. transverse: (nz, 2, nk): k·u_t and f_t under k·d_t = 1. stiffness: (2, 2, nk), Pa, and
    stiffness_transverse: (nk,): H at the interface.
    """

    plane: Array
    transverse: Array
    stiffness: Array
    stiffness_transverse: Array


def jump(k: Array, stack: Stack, interface: float, depths: Sequence[float], below: Sequence[bool]) -> Jump:
    """Displacement and force at depths under unit jumps across a bonded interface.

    k: (nk,), 1/m, > 0. stack: real; its interfaces may slide, the one that parts must not. interface: its depth, m.
    depths: (nz,), m, >= 0, in any order. below: for each depth, whether a value on an interface is that of the layer
    below it. Returns a Jump.
    """
    places = stack.snapped([*depths, interface]).tolist()
    depths, interface = places[:-1], places[-1]
    slabs, bodies = upwards(k, stack, places)
    springs = [spring for *_, spring in pieces(stack, places)]
    count = next(number for number, slab in enumerate(slabs) if slab.bottom == interface) + 1
    upper = _Upper.of(k, slabs[:count], springs[: count - 1])
    body = bodies[count]
    ones, zero = np.ones_like(k), np.zeros_like(k)
    moved: Array
    under: Array
    compliance = np.stack([np.stack([body.plane.xx * ones, body.plane.xz * ones]),
                           np.stack([body.plane.xz * ones, body.plane.zz * ones])])  # fmt: skip
    stiffness = _times(upper.stiffness, _inverse(_unit(k) + _times(compliance, upper.stiffness)))
    swaying = upper.transverse / (1 + body.transverse * upper.transverse)
    fields, sliding = np.zeros((len(depths), 4, 2, len(k))), np.zeros((len(depths), 2, len(k)))

    def put(rows: list[int], moved: Array, force: Array, swayed: Array, shear: Array) -> None:
        fields[rows, :2], fields[rows, 2:] = moved, force
        sliding[rows, 0], sliding[rows, 1] = swayed, shear

    force: Array
    shear: Array
    swayed: Array
    force, shear = -stiffness, -swaying * ones
    under, swayed_under = body.plane.under(force), body.transverse * shear
    on = [row for row, z in enumerate(depths) if z == interface]
    put([row for row in on if below[row]], under, force, swayed_under, shear)
    # Upwards: a bottom that moves by so much moves all above it.
    moved, swayed = under + _unit(k), swayed_under + ones
    put([row for row in on if not below[row]], moved, force, swayed, shear)
    for number in range(count - 1, -1, -1):
        top = slabs[number - 1].bottom if number else 0.0
        rows = [row for row, z in enumerate(depths) if z == top or (number == 0 and z <= 0)]
        (moved, swayed), (above, above_swayed), (pushed, sheared) = upper.up(number, moved, swayed)
        low = [row for row in rows if below[row] or number == 0]
        put(low, moved, pushed, swayed, sheared)
        put([row for row in rows if row not in low], above, pushed, above_swayed, sheared)
        moved, swayed = above, above_swayed
    _downwards(slabs[count:], bodies[count + 1 :], depths, below, (force, shear), put)
    return Jump(fields, sliding, stiffness, swaying + zero)


def _downwards(
    slabs: Sequence[Slab], bodies: Sequence[Body], depths: Sequence[float], below: Sequence[bool],
    at: tuple[Array, Array], put: _Put,
) -> None:  # fmt: skip
    """As `layered.transfer` goes down, from the force on the body below the interface."""
    force, shear = at
    for slab, body in zip(slabs, bodies, strict=True):
        rows = [row for row, z in enumerate(depths) if z > 0 and z == slab.bottom]
        moved, force = slab.down(body.sprung, force)
        swayed, shear = slab.down_transverse(body.sprung_transverse, shear)
        put([row for row in rows if not (below[row] and body.slides)], moved, force, swayed, shear)
        if body.slides:
            low = [row for row in rows if below[row]]
            put(low, body.plane.under(force), force, body.transverse * shear, shear)


@dataclass(frozen=True)
class _Upper:
    """Slabs from the surface, free, down to the interface.

    stiffness (2, 2, nk) and transverse (nk,): of the underside. bare, sprung: of the underside of what
    lies above each slab, without and with the spring between them. springs: below each slab but the last, Pa/m.
    """

    k: Array
    slabs: Sequence[Slab]
    springs: Sequence[float]
    stiffness: Array
    transverse: Array
    bare: list[tuple[Array, Array]]
    sprung: list[tuple[Array, Array]]

    @classmethod
    def of(cls, k: Array, slabs: Sequence[Slab], springs: Sequence[float]) -> _Upper:
        nothing: tuple[Array, Array] = np.zeros((2, 2, len(k))), np.zeros_like(k)
        bare: list[tuple[Array, Array]] = [nothing]
        compliances: list[tuple[Array, Array]] = [nothing]
        plane: Array
        plane, transverse = _stiffness(slabs[0])
        for slab, spring in zip(slabs[1:], springs, strict=True):
            bare.append((plane, transverse))
            compliances.append(_through(k, spring, plane, transverse))
            plane, transverse = compliances[-1]
            slab_stiffness, slab_transverse = _stiffness(slab)
            c, t = _compliance(slab), _turned(slab)
            rest = _times(plane, _inverse(_unit(k) + _times(c, plane)))
            plane = slab_stiffness + _times(np.swapaxes(t, 0, 1), _times(rest, t))
            swaying = transverse / (1 + slab.c_transverse * transverse)
            transverse = slab_transverse + slab.t_transverse**2 * swaying
        return cls(k, slabs, springs, plane, transverse, bare, compliances)

    def up(
        self, number: int, moved: Array, swayed: Array
    ) -> tuple[tuple[Array, Array], tuple[Array, Array], tuple[Array, Array]]:
        """At the top of a slab whose bottom moves: displacement there, that above its spring, and force."""
        slab = self.slabs[number]
        stiff, swaying = self.sprung[number]
        top = _times(_inverse(_unit(self.k) + _times(_compliance(slab), stiff)), _times(_turned(slab), moved))
        turned = slab.t_transverse * swayed / (1 + slab.c_transverse * swaying)
        force, shear = -_times(stiff, top), -swaying * turned
        spring = self.springs[number - 1] if number else np.inf
        if spring == np.inf:
            return (top, turned), (top, turned), (force, shear)
        bare, alone = self.bare[number]
        over = top.copy()
        over[0] = (spring * top[0] - self.k * bare[0, 1] * top[1]) / (spring + self.k * bare[0, 0])
        return (top, turned), (over, spring * turned / (spring + self.k * alone)), (force, shear)


def _through(k: Array, spring: float, plane: Array, transverse: Array) -> tuple[Array, Array]:
    """Stiffness of an underside below a spring, Pa/m."""
    if spring == np.inf:
        return plane, transverse
    kept = spring / (spring + k * plane[0, 0])
    lost = k / (spring + k * plane[0, 0])
    zz = plane[1, 1] - lost * plane[0, 1] ** 2
    below = np.stack([np.stack([plane[0, 0] * kept, plane[0, 1] * kept]), np.stack([plane[0, 1] * kept, zz])])
    return below, transverse * spring / (spring + k * transverse)


def _stiffness(slab: Slab) -> tuple[Array, Array]:
    xx, zz, xz, _ = slab.k
    return np.stack([np.stack([xx, xz]), np.stack([xz, zz])]), np.asarray(slab.k_transverse)


def _compliance(slab: Slab) -> Array:
    xx, zz, xz, _ = slab.c
    return np.stack([np.stack([xx, xz]), np.stack([xz, zz])])


def _turned(slab: Slab) -> Array:
    xx, xz, zx, zz, _ = slab.t
    return np.stack([np.stack([xx, xz]), np.stack([zx, zz])])


def _unit(k: Array) -> Array:
    unit: Array = np.eye(2)[:, :, None]
    return np.broadcast_to(unit, (2, 2, len(k)))


def _times(first: Array, second: Array) -> Array:
    product: Array = np.einsum("ijk,jlk->ilk", first, second)
    return product


def _inverse(matrix: Array) -> Array:
    (a, b), (c, d) = matrix
    inverse: Array = np.stack([np.stack([d, -b]), np.stack([-c, a])]) / (a * d - b * c)
    return inverse
