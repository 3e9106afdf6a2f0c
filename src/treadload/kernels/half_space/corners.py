"""Functions of the distance to a corner of a cell that the fields of loaded cells are made of.

Stress and displacement of a half-space under a load that is uniform on a rectangle are alternating sums over its four
corners of a few elementary functions, see `at_corners`. Under a load interpolated bilinearly between centres they are
second differences of the integrals of these functions over x and y, see `at_nodes`. `fields` puts either together to
stress and displacement, once for both.

Source: Love (1929), Phil. Trans. R. Soc. A 228, 377-420; potentials, and Boussinesq's and Cerruti's point loads, as
in Johnson (1985), Contact Mechanics, section 3.2, integrated over a rectangle; written with asinh and atan2 so that
no corner loses digits. The integrals were found as polynomials times the functions, exact rational coefficients, and
are held by tests against quadrature.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, Reals
from treadload.kernels.gridding.lattice import Corner

_XX, _YY, _ZZ, _XY, _XZ, _YZ, _UX, _UY, _UZ = range(9)
_P, _QX, _QY = range(3)

# Distances below this part of a cell are zero: round-off of coordinates, not geometry.
SNAP = 1e-9


def is_surface(z: Array | float, dx: float, dy: float) -> bool | BoolArray:
    """Whether a depth is the surface."""
    return z <= SNAP * min(dx, dy)


@dataclass(frozen=True)
class _Corners:
    """The functions at the distance x, y, z, m, from a corner.

    r: R. log_x, log_y: asinh(x / √(y² + z²)), asinh(y / √(x² + z²)). log_r: ln(R + z). turn: atan(x y / z R).
    turn_x, turn_y: atan(x y (R - z) / (x² R + z y²)) and the same with x and y exchanged.
    Those below follow from them, evaluated when asked for, to keep little in memory. At the surface, z → 0+, `turn`
    and all that carry a factor z are plain zeros: what `turn` jumps by under the load is the load itself.
    """

    x: Array
    y: Array
    z: Reals
    r: Array
    log_x: Array
    log_y: Array
    log_r: Array
    turn: Reals
    turn_x: Array
    turn_y: Array

    @property
    def part(self) -> Reals:
        return self.z / self.r if self.z != 0 else 0.0

    @property
    def over_x(self) -> Reals:
        return self.part * (self.x / (self.x * self.x + self.z * self.z)) * self.y if self.z != 0 else 0.0

    @property
    def over_y(self) -> Reals:
        return self.part * (self.y / (self.y * self.y + self.z * self.z)) * self.x if self.z != 0 else 0.0

    @property
    def deep_x(self) -> Reals:
        return self.part * (self.z / (self.x * self.x + self.z * self.z)) * self.y if self.z != 0 else 0.0

    @property
    def deep_y(self) -> Reals:
        return self.part * (self.z / (self.y * self.y + self.z * self.z)) * self.x if self.z != 0 else 0.0

    @property
    def slope_x(self) -> Array:
        return self.x / self._far

    @property
    def slope_y(self) -> Array:
        return self.y / self._far

    @property
    def steep_x(self) -> Reals:
        return self.part * self.slope_x

    @property
    def steep_y(self) -> Reals:
        return self.part * self.slope_y

    @property
    def x_log_y(self) -> Array:
        return self.x * self.log_y

    @property
    def y_log_x(self) -> Array:
        return self.y * self.log_x

    @property
    def tilt_x(self) -> Reals:
        return self.y * self.log_r + self.z * self.log_y + self.x * self.turn_x

    @property
    def tilt_y(self) -> Reals:
        return self.x * self.log_r + self.z * self.log_x + self.y * self.turn_y

    @property
    def _far(self) -> Array:
        return self.r + self.z if self.z != 0 else np.where(self.r == 0, 1.0, self.r)


@dataclass(frozen=True)
class _Nodes:
    """Integrals over x and y of the functions of `_Corners`, by their names; continuous, the surface included."""

    z: Reals
    r: Array
    log_x: Array
    log_y: Array
    log_r: Array
    turn: Array
    turn_x: Array
    turn_y: Array
    over_x: Array
    over_y: Array
    deep_x: Array
    deep_y: Array
    part: Array
    slope_x: Array
    slope_y: Array
    steep_x: Array
    steep_y: Array
    x_log_y: Array
    y_log_x: Array
    tilt_x: Array
    tilt_y: Array


Functions = _Corners | _Nodes
"""Those of a corner, or their integrals."""


def at_corners(x: Array, y: Array, z: Reals, dx: float, dy: float, stretch: complex = 1.0) -> _Corners:
    """The functions at (x, y, z) from a corner of cells dx by dy, m, broadcast from x and y.

    stretch: of the depth: how fast waves of a medium that is another along z decay, by those of isotropic ones; its
    real part is positive, and all functions are real analytic in it.
    Singular points of the surface get finite values: a quantity that jumps takes the mean of its sides, and ln d at
    a distance d = 0 is cut at dx / 2π, with which evenly spaced steps sum to the field of a smooth load to second
    order, O(dx²).
    """
    x, y = snapped(x, dx), snapped(y, dy)
    surface = is_surface(z, dx, dy)
    if surface:
        z = 0.0
    elif stretch != 1:
        z = cast("Reals", z * stretch)
    x2, y2 = x * x + z * z, y * y + z * z
    r, edge_x, edge_y = np.sqrt(x2 + y * y), np.sqrt(x2), np.sqrt(y2)
    far = r + z
    if surface:
        edge_x, edge_y = np.where(x == 0, SNAP * dx, edge_x), np.where(y == 0, SNAP * dy, edge_y)
        # The same for a lattice of corners: 0.27 of a square cell.
        far = np.where(r == 0, 0.27 * math.sqrt(dx * dy), r)
    reach_x, reach_y = (np.maximum(r, edge_y), np.maximum(r, edge_x)) if surface else (r, r)
    log_x, log_y = _asinh(x, edge_y, reach_x), _asinh(y, edge_x, reach_y)
    if surface:
        # Σ ln|k| over k ≠ 0 is that of its integral plus ln 2π: a cut at dx / 2π takes the rest away, on the edge
        # alone; on its line beyond, both of its corners have it.
        cut = math.log(2 * math.pi * SNAP)
        log_x += np.sign(x) * np.where(y == 0, cut, 0.0)
        log_y += np.sign(y) * np.where(x == 0, cut, 0.0)
    # R - z without cancellation deep below the load.
    slope = x * y * ((x * x + y * y) / far)
    turn_x = _angle(slope, x * x * r + z * y * y)
    # Below the surface the two turns add up to the third.
    turn = 0.0 if surface else _angle(x * y, z * r)
    turn_y = _angle(slope, y * y * r + z * x * x) if surface else turn - turn_x
    return _Corners(
        x=x,
        y=y,
        z=z,
        r=r,
        log_x=log_x,
        log_y=log_y,
        log_r=np.log(far),
        turn=turn,
        turn_x=turn_x,
        turn_y=turn_y,
    )


def _asinh(x: Array, edge: Array, r: Array) -> Array:
    """asinh(x / edge) where r² = x² + edge²: the logarithm takes a fourth of the time. Real edges are > 0."""
    if np.iscomplexobj(edge):
        return np.arcsinh(x / edge)
    values: Array = np.copysign(np.log((np.abs(x) + r) / edge), x)
    return values


def _angle(sine: Array, cosine: Array) -> Array:
    """atan(sine / cosine), 0 where both are zero; no branch is met while the real part of the depth is > 0.

    Real cosines are >= 0, and zero only where the sine is.
    """
    ratio = np.divide(sine, np.where(cosine == 0, 1.0, cosine))
    return np.arctan(ratio)


def at_nodes(x: Array, y: Array, z: Array | float, dx: float, dy: float, stretch: complex = 1.0) -> _Nodes:
    """The integrals at (x, y, z), m, less what second differences take away; arguments as in `at_corners`."""
    c = at_corners(x, y, z, dx, dy, stretch)
    x, y, z, r, log_x, log_y, log_r = c.x, c.y, c.z, c.r, c.log_x, c.log_y, c.log_r
    turn_x, turn_y, turn = c.turn_x, c.turn_y, c.turn if z != 0 else np.arctan2(x * y, z * r)
    xx, yy, xy, zz = x * x, y * y, x * y, z * z
    by_y, by_x, over = y * log_y, x * log_x, x * log_y + y * log_x
    flat_x, flat_y = (yy - zz) / 2 * log_x, (xx - zz) / 2 * log_y
    edge_x, edge_y = z * (x * log_r - y * turn_x + y * turn), z * (y * log_r - x * turn_y + x * turn)
    return _Nodes(
        z=z,
        r=xy * r / 3 + x * (zz / 2 + xx / 6) * log_y + y * (zz / 2 + yy / 6) * log_x - z**3 / 3 * turn,
        log_x=xy * log_x + flat_y - x * z * turn - y * r / 2,
        log_y=xy * log_y + flat_x - y * z * turn - x * r / 2,
        log_r=xy * log_r + z * over + (yy - zz) / 2 * turn + (xx - yy) / 2 * turn_x,
        turn=xy * turn + z * (by_y + by_x - r),
        turn_x=xy * turn_x + (yy - xx) / 2 * log_r + z * (by_y - r / 2),
        turn_y=xy * turn_y + (xx - yy) / 2 * log_r + z * (by_x - r / 2),
        over_x=z * (r - by_y),
        over_y=z * (r - by_x),
        deep_x=z * (z * log_x + y * turn),
        deep_y=z * (z * log_y + x * turn),
        part=z * (over - z * turn),
        slope_x=y * r / 2 + flat_y - edge_y,
        slope_y=x * r / 2 + flat_x - edge_x,
        steep_x=zz * log_y + edge_y,
        steep_y=zz * log_x + edge_x,
        x_log_y=(yy / 6 - xx / 3 - zz / 3) * r + y * (xx + zz) / 2 * log_y,
        y_log_x=(xx / 6 - yy / 3 - zz / 3) * r + x * (yy + zz) / 2 * log_x,
        tilt_x=-x * z * r / 3
        + z * (xy * log_y + (yy / 2 - zz / 6) * log_x)
        + x * (yy / 2 - xx / 6) * log_r
        + y * ((yy / 6 - zz / 2) * turn + (xx / 2 - yy / 6) * turn_x),
        tilt_y=-y * z * r / 3
        + z * (xy * log_x + (xx / 2 - zz / 6) * log_y)
        + y * (xx / 2 - yy / 6) * log_r
        + x * ((xx / 6 - zz / 2) * turn + (yy / 2 - xx / 6) * turn_y),
    )


def fields(f: Functions, nu: float, *, moves: bool = True) -> Iterator[Corner]:
    """Stress, numbers 0 to 5, and displacement times the shear modulus, 6 to 8, from the functions.

    moves: False leaves the displacement out.
    Yields each with the (load, component) pairs that use it; a plain zero for what vanishes at the surface. Stress
    there is without the part of a uniform load itself, see `_Corners`.
    """
    unit, soft = 1 / (2 * math.pi), 1 - 2 * nu
    turn, over_x, over_y, part = f.turn, f.over_x, f.over_y, f.part
    yield unit * (over_x - 2 * nu * turn - soft * f.turn_x), ((_P, _XX),)
    yield unit * (over_y - 2 * nu * turn - soft * f.turn_y), ((_P, _YY),)
    yield -unit * (turn + over_x + over_y), ((_P, _ZZ),)
    yield unit * (over_x - turn), ((_QX, _XZ),)
    yield unit * (over_y - turn), ((_QY, _YZ),)
    yield -unit * (soft * f.log_r + part), ((_P, _XY),)
    yield -unit * part, ((_QX, _YZ), (_QY, _XZ))
    deep_x, deep_y = f.deep_x, f.deep_y
    yield unit * deep_x, ((_P, _XZ), (_QX, _ZZ))
    yield unit * deep_y, ((_P, _YZ), (_QY, _ZZ))
    log_x, log_y = f.log_x, f.log_y
    across_y, across_x = 2 * nu * f.slope_y + f.steep_y, 2 * nu * f.slope_x + f.steep_x
    yield unit * (2 * log_y + across_y - deep_x), ((_QX, _XX),)
    yield unit * (2 * log_x + across_x - deep_y), ((_QY, _YY),)
    yield unit * (2 * nu * log_y - across_y), ((_QX, _YY),)
    yield unit * (2 * nu * log_x - across_x), ((_QY, _XX),)
    yield unit * (log_x - across_x), ((_QX, _XY),)
    yield unit * (log_y - across_y), ((_QY, _XY),)
    if not moves:
        return

    half, x_log_y, y_log_x, tilt_x, tilt_y = 0.5 * unit, f.x_log_y, f.y_log_x, f.tilt_x, f.tilt_y
    z_log_y, z_log_x, z_turn = f.z * log_y, f.z * log_x, f.z * turn
    whole = x_log_y + y_log_x - z_turn
    yield half * (2 * (1 - nu) * whole + z_turn), ((_P, _UZ),)
    yield -half * (z_log_y + soft * tilt_x), ((_P, _UX),)
    yield -half * (z_log_x + soft * tilt_y), ((_P, _UY),)
    yield half * (soft * tilt_x - z_log_y), ((_QX, _UZ),)
    yield half * (soft * tilt_y - z_log_x), ((_QY, _UZ),)
    yield half * (2 * whole - x_log_y + soft * (x_log_y - f.z * f.turn_x)), ((_QX, _UX),)
    yield half * (2 * whole - y_log_x + soft * (y_log_x - f.z * f.turn_y)), ((_QY, _UY),)
    yield -half * (2 * nu * f.r + soft * f.z * f.log_r), ((_QX, _UY), (_QY, _UX))


def snapped(x: Array, dx: float) -> Array:
    """Coordinates, those within round-off of zero zero."""
    return np.where(np.abs(x) < SNAP * dx, 0.0, x)
