"""A crack that ends at the interface of two layers, which it meets at a right angle: how singular its stress is."""

from __future__ import annotations

import math

import scipy

from treadload.kernels.fracture.layers import Strip


def interface_singularity(cracked: Strip, ahead: Strip) -> float:
    """λ in (0, 1) of the stress r^-λ around a tip at a bonded interface, in plane strain; 1/2 of equal layers.

    cracked: the layer that the crack has gone through. ahead: the layer beyond, smaller λ the stiffer it is. A tip at
    a small distance d before the interface has K ~ d^(1/2 - λ): it falls towards a stiffer layer and rises towards a
    softer one.
    Source: Zak and Williams (1963), J. Appl. Mech. 30, 142-143, in Dundurs' parameters as He and Hutchinson (1989),
    J. Appl. Mech. 56, 270-278, write it.
    """
    alpha, beta = dundurs(ahead, cracked)

    def left(order: float) -> float:
        square = 2 * (beta - alpha) / (1 + beta) * (1 - order) ** 2
        return math.cos(order * math.pi) - square - (alpha + beta**2) / (1 - beta**2)

    return float(scipy.optimize.brentq(left, 1e-9, 1 - 1e-9, xtol=1e-12))


def dundurs(first: Strip, second: Strip) -> tuple[float, float]:
    """Dundurs' parameters α, β of two materials in plane strain; α > 0 where the first is the stiffer.

    Source: Dundurs (1969), J. Appl. Mech. 36, 650-652.
    """
    # 1 + κ of Kolosov.
    upper, lower = 4 - 4 * first.poisson, 4 - 4 * second.poisson
    whole = first.shear * lower + second.shear * upper
    return (
        (first.shear * lower - second.shear * upper) / whole,
        (first.shear * (lower - 2) - second.shear * (upper - 2)) / whole,
    )
