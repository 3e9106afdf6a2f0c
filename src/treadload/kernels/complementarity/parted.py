"""A parted face between two elastic bodies: pressed it rubs after Coulomb, pulled it opens.

Sought are the jump d of displacement, above less below, and the traction t that the body above exerts on the one
below, (x, y, pressure) each, on a periodic grid:

    t = t₀ - H d,   p = t_z >= 0,  d_z <= 0,  p d_z = 0,   |t_xy| <= μ p,  t_xy = μ p d_xy / |d_xy| where it slides,

t₀ being the traction of the face as if it held, z down, and H the stiffness per wavenumber, `kernels.layers.jumps`.
This is a sum of an operator that is diagonal in wavenumbers and a law that is local in space; Douglas-Rachford
splitting asks each for its resolvent in turn. With μ p given it minimises a convex energy; with p of its own it is
Coulomb's problem, whose solution is unique where friction is not too large for the coupling of shear and pressure.

Source: Lions and Mercier (1979), SIAM J. Numer. Anal. 16, 964-979; the law of the face as in Kikuchi and Oden (1988),
Contact Problems in Elasticity, chapter 10.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray

# Steps that go beyond the resolvent by this factor converge faster, up to 2.
_BEYOND = 1.6
_MOST = 20_000
# The bound of the shear follows friction times the pressure by this part of what is between them at every step.
_PATIENCE = 0.2


@dataclass(frozen=True, eq=False)
class FaceStiffness:
    """H on the wavenumbers of a grid, (ny, nx // 2 + 1) each.

    along, across: cosine and sine of the wave vector; 0 at k = 0. kk, zz, kz, tt: Pa/m, in the frame of the wave
    vector, H_kz = -i kz; 0 at k = 0, as a jump that is the same everywhere strains nothing.
    """

    along: Array
    across: Array
    kk: Array
    zz: Array
    kz: Array
    tt: Array

    @property
    def scale(self) -> float:
        """Geometric mean of its smallest and its largest eigenvalue, k = 0 aside, Pa/m."""
        springs = self.tt[self.tt > 0]
        return math.sqrt(float(springs.min()) * float(springs.max()))

    def resolve(self, weight: float, right: Array) -> Array:
        """The d (3, ny, nx) of (H + weight) d = right."""
        x, y, z = fft.rfft2(right)
        c, s = self.along, self.across
        ahead, turned = c * x + s * y, (c * y - s * x) / (self.tt + weight)
        kk, zz = self.kk + weight, self.zz + weight
        det = kk * zz - self.kz**2
        ahead, z = (zz * ahead + 1j * self.kz * z) / det, (kk * z - 1j * self.kz * ahead) / det
        # At k = 0 there is no direction.
        ahead[0, 0], turned[0, 0] = x[0, 0] / weight, y[0, 0] / weight
        c, s = c.copy(), s.copy()
        c[0, 0], s[0, 0] = 1.0, 0.0
        waves: ComplexArray = np.stack([c * ahead - s * turned, s * ahead + c * turned, z])
        moved: Array = fft.irfft2(waves, s=right.shape[1:])
        return moved


@dataclass(frozen=True, eq=False)
class PartedFace:
    """The state of a parted face on a grid.

    jump: (3, ny, nx), m, displacement above less below, z down: z <= 0, open where it is less. traction: (3, ny, nx),
    Pa, of the body above on that below, the third the pressure. iterations. residual: largest error of the traction,
    as a part of the largest given.
    """

    jump: Array
    traction: Array
    iterations: int
    residual: float


def solve_parted(
    traction: Array,
    stiffness: FaceStiffness,
    friction: float,
    *,
    tolerance: float = 1e-4,
    start: tuple[Array, Array] | None = None,
) -> PartedFace:
    """Jump and traction of a parted face.

    traction: (3, ny, nx), Pa, t₀: shear along x and y and the pressure, weight included. stiffness: H. friction: μ,
    >= 0; 0 transmits no shear. tolerance: of the traction, as a part of the largest given. start: jump and traction
    to begin with.
    The residual is above the tolerance where it did not converge.
    """
    largest = float(np.abs(traction).max())
    if largest == 0:
        return PartedFace(np.zeros_like(traction), np.zeros_like(traction), 0, 0.0)
    weight = stiffness.scale
    jump, borne = (np.zeros_like(traction), traction) if start is None else start
    split, bound = jump + borne / weight, friction * np.maximum(borne[2], 0.0)
    for step in range(1, _MOST + 1):  # noqa: B007, it is returned
        admissible, borne = _law(split, weight, bound)
        moved = stiffness.resolve(weight, traction + weight * (2 * admissible - split))
        apart = moved - admissible
        split += _BEYOND * apart
        # With the bound of the moment and no more patience than this, pressure and friction may chase each other.
        lag = friction * borne[2] - bound
        bound = bound + _PATIENCE * lag
        residual = max(weight * float(np.abs(apart).max()), float(np.abs(lag).max())) / largest
        if residual <= tolerance:
            break
    return PartedFace(admissible, borne, step, residual)


def _law(split: Array, weight: float, bound: Array) -> tuple[Array, Array]:
    """Jump and traction, (3, ny, nx) each, with weight · jump + traction = weight · split, that obey the law.

    bound: (ny, nx), Pa, of the shear.
    """
    admissible, borne = np.empty_like(split), np.empty_like(split)
    admissible[2], borne[2] = np.minimum(split[2], 0.0), weight * np.maximum(split[2], 0.0)
    size = weight * np.hypot(split[0], split[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(size > bound, bound / size, 1.0)
    admissible[:2], borne[:2] = (1 - share) * split[:2], weight * share * split[:2]
    return admissible, borne
