"""Rigid punches on layers by Ritz's method on the pressure: no integral equation, no cells, no images.

With ρ = r/a and x = √(1 - ρ²) the pressure is p = Σ bₙ P₂ₙ(x)/(wₙ x), wₙ = |P₂ₙ(0)|. The plane wave's expansion in
Legendre polynomials gives its Hankel transform ∫ ρ p J₀(κρ) dρ = Σ bₙ j₂ₙ(κ) in spherical Bessel functions, and the
displacement a ∫ N(κ/a) (Σ bₙ j₂ₙ) J₀(κρ) dκ, weighted by each term of the pressure, is to be that of the punch:

    a Σ bₙ ∫ N(κ/a) j₂ₘ j₂ₙ dκ = 1/wₘ ∫ P₂ₘ(x) u dx,    ∫ j₂ₘ j₂ₙ dκ = δₘₙ π/(8n + 2)

N(k) is k times the displacement under a pressure wave; the load is 2π a² b₀. Contact is taken to be whole: the
pressure may turn out negative.
"""

import numpy as np
from scipy import special

TERMS = 24


def compliance_of_bonded_layer(shear, poisson, thickness):
    """N(k) of a layer bonded to a rigid base. Source: Hayes et al. (1972), J. Biomech. 5, 541-551."""
    kappa = 3 - 4 * poisson

    def compliance(k):
        x = np.minimum(k * thickness, 300.0)
        rise = 2 * kappa * np.sinh(2 * x) - 4 * x
        return (1 - poisson) / shear * rise / (2 * kappa * np.cosh(2 * x) + 1 + kappa**2 + 4 * x**2)

    return compliance


def _solve(compliance, top, first, radius, sides):
    """Coefficients bₙ (TERMS, sides) for ∫ P₂ₘ(x) u dx of each side. first: depth of the first interface, m."""
    # N - N(∞) is gone at k h = 20; towards k = 0 panels that halve hold what happens at long waves.
    edges = np.concatenate([[0], 2.0 ** np.arange(-30, 1), np.arange(2, max(3.0, 20 * radius / first + 2))])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2
    k = (edges[:-1, None] + half * (1 + nodes)).ravel()
    n = 2 * np.arange(TERMS)
    wave = special.spherical_jn(n[:, None], k)
    change = (half * weights).ravel() * (compliance(k / radius) - top)
    stiffness = radius * (np.diag(top * np.pi / (4 * n + 2)) + (wave * change) @ wave.T)
    return np.linalg.solve(stiffness, sides / np.abs(special.eval_legendre(n, 0.0))[:, None])


def flat_punch_stiffness(compliance, top, first, radius):
    """Load over settlement, N/m, of a rigid disc without friction. top: N(∞), 1/Pa."""
    return 2 * np.pi * radius**2 * _solve(compliance, top, first, radius, np.eye(TERMS, 1))[0, 0]


def sphere(compliance, top, first, radius, curvature):
    """Load, N, and approach, m, of a rigid paraboloid r²/2R that touches within a radius, m; curvature: R, m."""
    # ρ² = 2/3 (P₀ - P₂), and ∫ P₂² dx = 1/5.
    sides = np.zeros((TERMS, 2))
    sides[0, 0] = 1.0
    sides[:2, 1] = -(radius**2) / (3 * curvature), radius**2 / (15 * curvature)
    unit, bowl = _solve(compliance, top, first, radius, sides).T
    # Σ bₙ P₂ₙ(0)/wₙ = 0: the pressure at the rim is finite.
    sign = (-1.0) ** np.arange(TERMS)
    approach = -(sign @ bowl) / (sign @ unit)
    return 2 * np.pi * radius**2 * (approach * unit[0] + bowl[0]), approach
