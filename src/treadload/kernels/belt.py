"""Surface displacement of a belt under a loaded cell: a tensioned, bending sheet on a foundation, closed to a ring.

Deflection w of the sheet, positive away from the load, under the pressure p and under the shear q at an arm a:

    B w = p - a ∇·q,    B(k) = T_x k_x² + T_y k_y² + D_x k_x⁴ + 2 D_xy k_x² k_y² + D_y k_y⁴ + k_f

and the surface at the arm moves by a ∇w along the sheet: one symmetric operator (1, -a∇)ᵀ B⁻¹ (1, -a∇). Kernels are
cosine and sine sums over the harmonics of the ring along x and of a period across that no field reaches; the loaded
cell is in them by its own transform. Waves up to twice those of the cells are summed: bending makes the rest nothing.

Sources: Pacejka (2012), Tire and Vehicle Dynamics, chapters 5 and 9 (string and sheet on a foundation); Timoshenko &
Woinowsky-Krieger (1959), Theory of Plates and Shells, section 85 (orthotropic plate), section 90 (tension).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from treadload.kernels.arrays import Array

# Decay lengths of the sheet that lie between the farthest point asked for and the next image of the load across.
_APART = 10.0
_NARROWEST = 2.0


@dataclass(frozen=True)
class Sheet:
    """A tensioned, bending sheet on a foundation, closed to a ring along x.

    tension_x, tension_y: N/m. bending: D_x, D_xy, D_y, N m; D_xy goes with 2 k_x² k_y². foundation: k_f, Pa/m.
    arm: a, m, from the sheet to the surface where shear acts. circumference: of the ring, m.
    """

    tension_x: float
    tension_y: float
    bending: tuple[float, float, float]
    foundation: float
    arm: float
    circumference: float

    def stiffness(self, kx: Array, ky: Array) -> Array:
        """B at wavenumbers of any shapes that go together, 1/m: Pa/m."""
        bend_x, bend_xy, bend_y = self.bending
        xx, yy = np.square(kx), np.square(ky)
        return np.asarray(
            self.tension_x * xx
            + self.tension_y * yy
            + bend_x * xx * xx
            + 2 * bend_xy * xx * yy
            + bend_y * yy * yy
            + self.foundation
        )

    @property
    def decay(self) -> tuple[float, float]:
        """Lengths over which deflection fades along x and across, m."""
        lengths = []
        for tension, bend in ((self.tension_x, self.bending[0]), (self.tension_y, self.bending[2])):
            # The slower of the roots of D s⁴ - T s² + k_f, or the size of complex ones.
            root = math.sqrt(max(tension**2 - 4 * bend * self.foundation, 0.0))
            lengths.append(
                math.sqrt((tension + root) / (2 * self.foundation)) if root else (4 * bend / self.foundation) ** 0.25
            )
        return lengths[0], lengths[1]


@lru_cache(maxsize=16)
def coefficients(sheet: Sheet, ny: int, nx: int, dx: float, dy: float, first: float = 0.0) -> Array:
    """Displacement at the arm by unit loads on a cell of dx by dy, at distances from its centre: (6, ny, nx), m/Pa.

    At x = first + dx · (0 … nx-1) and y = dy · (0 … ny-1), m: w by p (even in x and y), u_x by q_x, u_y by q_y
    (even), u_x by q_y = u_y by q_x (odd in both), k_x (odd in x), k_y (odd in y) with w = k_x ∗ q_x + k_y ∗ q_y and
    u = -k ∗ p; w positive away from the load.
    """
    x, y = first + dx * np.arange(nx), dy * np.arange(ny)
    width = max(_NARROWEST, float(y[-1]) + _APART * sheet.decay[1])
    kx, ky, spectrum = _spectrum(sheet, width, dx, dy)
    cos_x, sin_x = np.cos(np.outer(kx, x)), kx[:, None] * np.sin(np.outer(kx, x))
    cos_y, sin_y = np.cos(np.outer(y, ky)), ky * np.sin(np.outer(y, ky))
    even, odd = spectrum @ cos_x, spectrum @ sin_x
    curved = spectrum @ (np.square(kx)[:, None] * cos_x)
    a = sheet.arm
    sums = np.array(
        [
            cos_y @ even,
            a * a * (cos_y @ curved),
            a * a * ((np.square(ky) * cos_y) @ even),
            -a * a * (sin_y @ odd),
            a * (cos_y @ odd),
            a * (sin_y @ even),
        ]
    )
    sums.flags.writeable = False
    return sums


@lru_cache(maxsize=2)
def _spectrum(sheet: Sheet, width: float, dx: float, dy: float) -> tuple[Array, Array, Array]:
    """Harmonics along x and across, 1/m, and what each adds to the deflection by a unit load on a cell, m/Pa."""
    kx, ky = _harmonics(sheet.circumference, dx), _harmonics(width, dy)
    # Each harmonic but the zeroth stands for its mirror image as well; sinc carries the loaded cell.
    along = np.where(kx > 0, 2.0, 1.0) * np.sinc(kx * dx / (2 * np.pi)) * dx / sheet.circumference
    across = np.where(ky > 0, 2.0, 1.0) * np.sinc(ky * dy / (2 * np.pi)) * dy / width
    return kx, ky, along * across[:, None] / sheet.stiffness(kx, ky[:, None])


def string(stiffness: float, length: float, x: Array, dx: float, dy: float) -> Array:
    """u_y of a string on a lateral foundation by a unit q_y on a cell of dx by dy, at distances x: (n,), m/Pa.

    stiffness: of the foundation, k, N/m per m of length. length: σ, m, over which deflection fades: a unit force
    makes e^{-|x|/σ}/(2 k σ). The same at every y: the string moves as a whole.
    """
    near, far = np.abs(x) - 0.5 * dx, np.abs(x) + 0.5 * dx
    outside = np.exp(-np.maximum(near, 0.0) / length) - np.exp(-far / length)
    inside = 2 - np.exp(np.minimum(near, 0.0) / length) - np.exp(-far / length)
    return np.asarray(0.5 * dy / stiffness * np.where(near >= 0, outside, inside))


def _harmonics(period: float, step: float) -> Array:
    """Wavenumbers of a period up to twice those that cells of this size carry, 1/m."""
    return np.asarray(2 * np.pi / period * np.arange(math.ceil(period / step) + 1))
