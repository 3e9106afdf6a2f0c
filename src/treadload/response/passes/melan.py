"""The limit of shakedown of a road whose back stress knows no bound, without passes.

With Prager's back stress X a load comes to rest if and only if some X, the same all along a line of material, keeps
the elastic stress of a passage within the yield surface around it; residual stress is no more than a part of X, since
plastic strain can make any X. So of each line the smallest ball that holds the deviators of its passage decides: its
radius, von Mises' measure, over the strength.

Sources: Melan (1938), Ing.-Arch. 9, 116-126; for balls, of Frank and Wolfe's method with steps away: Yıldırım (2008),
SIAM J. Optim. 19, 1368-1391.
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.plasticity.state import deviator
from treadload.materials import Swift, VonMises
from treadload.response.passes.steady import Track

# Of the radii, relative; steps of the search, which needs some tens.
_TOLERANCE, _MOST = 1e-5, 20000
# 3/2 s:s as a sum of squares.
_SCALE = np.sqrt(1.5 * np.array([1.0, 1, 1, 2, 2, 2]))


def unbounded(law: object) -> bool:
    """Whether a law hardens by Prager's back stress alone."""
    return (
        isinstance(law, VonMises)
        and law.kinematic > 0
        and not (law.recovery or law.hardening or isinstance(law.yield_stress, Swift))
    )


def melan_factor(road: Track, stress: Array) -> float:
    """Largest part of a load that comes to rest where all laws are `unbounded`.

    stress: (6, nz, ny, nx), Pa, of the load on the elastic road; before and behind it there is none.
    """
    largest = 0.0
    for part in road.parts:
        law = part.material.law
        assert isinstance(law, VonMises)
        s = deviator(stress[:, part.rows]) * _SCALE[:, None, None, None] / law.strength
        paths = np.moveaxis(s, 0, -1).reshape(-1, s.shape[-1], 6)
        largest = max(largest, enclosing(np.concatenate([paths, np.zeros_like(paths[:, :1])], axis=1)))
    return 1 / largest if largest > 0 else np.inf


def enclosing(paths: Array) -> float:
    """Largest of the radii of the smallest balls around paths (m, n, d), to 1e-5.

    The centre is a mean of points, whose weights move to the farthest point or away from the nearest that has any.
    """
    shares = np.zeros(paths.shape[:2])
    shares[:, 0] = 1.0
    squares, every, best = (paths**2).sum(axis=-1), np.arange(len(paths)), 0.0
    for _ in range(_MOST):
        centre = np.einsum("mn,mnd->md", shares, paths)
        off = ((paths - centre[:, None]) ** 2).sum(axis=-1)
        least = np.einsum("mn,mn->m", shares, squares) - (centre**2).sum(axis=-1)
        most = off.max(axis=1)
        best = max(best, float(least.max()))
        # No ball is smaller than its lower bound; of those that cannot be the largest nothing more is asked.
        open_ = most > best * (1 + 2 * _TOLERANCE)
        if not open_.any():
            return float(np.sqrt(best))
        paths, shares, squares, off, least, most = (
            part[open_] for part in (paths, shares, squares, off, least, most)
        )
        every = np.arange(len(paths))
        far, near = off.argmax(axis=1), np.where(shares > 0, off, np.inf).argmin(axis=1)
        towards = most - least >= least - off[every, near]
        # Of the way to the far point, or back from the near one until its share is gone.
        share = shares[every, near]
        back = np.where(share < 1, share / np.where(share < 1, 1 - share, 1.0), np.inf)
        step = np.where(
            towards,
            0.5 * (most - least) / np.where(most > 0, most, 1.0),
            -np.minimum(0.5 * (least - off[every, near]) / np.maximum(off[every, near], 1e-300), back),
        )
        shares *= (1 - step)[:, None]
        shares[every, np.where(towards, far, near)] += step
        gone = ~towards & (step == -back)
        shares[every[gone], near[gone]] = 0.0
    raise RuntimeError(f"the balls around {len(paths)} paths are not yet known to {_TOLERANCE:g}")
