"""Rigid punches on layers by an integral equation on their radius: no cells, no images, no Fourier grid.

N(k) is k times the displacement under a pressure wave, N∞ its limit. With p̄(k) = ∫ φ(t) cos kt dt the pressure
vanishes outside of the radius a; the displacement u(r) inside asks for

    φ(t) + 1/π ∫ φ(s) [K(t - s) + K(t + s)] ds = 2/(π N∞) d/dt ∫ r u(r)/√(t² - r²) dr,  K(u) = ∫ (N/N∞ - 1) cos ku dk

and the load is 2π ∫ φ dt. Contact is taken to be whole: the pressure may turn out negative.

Source: Lebedev & Ufliand (1958), J. Appl. Math. Mech. 22, 442-450.
"""

import numpy as np

NODES = 48


def compliance_of_bonded_layer(shear, poisson, thickness):
    """N(k) of a layer bonded to a rigid base. Source: Hayes et al. (1972), J. Biomech. 5, 541-551."""
    kappa = 3 - 4 * poisson

    def compliance(k):
        x = np.minimum(k * thickness, 300.0)
        rise = 2 * kappa * np.sinh(2 * x) - 4 * x
        return (1 - poisson) / shear * rise / (2 * kappa * np.cosh(2 * x) + 1 + kappa**2 + 4 * x**2)

    return compliance


def _solve(compliance, top, first, radius, sides):
    """∫ φ dt and φ(a) for every side(t), t in radii. first: depth of the first interface, m."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    t, w = (nodes + 1) / 2, weights / 2
    # N/N∞ - 1 is gone at k h = 20; panels graded towards k = 0 hold what happens at long waves.
    edges = np.concatenate([[0], np.geomspace(1e-9, 1, 60), np.arange(1.5, max(2.0, 20 * radius / first) + 1, 0.5)])
    half = np.diff(edges) / 2
    k = (edges[:-1, None] + half[:, None] * (1 + nodes[None])).ravel()
    weight = (half[:, None] * weights).ravel() * (compliance(k / radius) / top - 1)
    wave = np.cos(np.outer(np.append(t, 1.0), k))
    kernel = (wave * weight) @ wave[:-1].T  # ½[K(t - s) + K(t + s)]
    right = np.stack([side(np.append(t, 1.0)) for side in sides], axis=1)
    phi = np.linalg.solve(np.eye(NODES) + 2 / np.pi * kernel[:-1] * w, right[:-1])
    rim = right[-1] - 2 / np.pi * (kernel[-1] * w) @ phi
    return w @ phi, rim


def flat_punch_stiffness(compliance, top, first, radius):
    """Load over settlement, N/m, of a rigid disc without friction. top: N(∞), 1/Pa."""
    (phi,), _ = _solve(compliance, top, first, radius, [lambda t: 0 * t + 2 / (np.pi * top)])
    return 2 * np.pi * radius * phi


def sphere(compliance, top, first, radius, curvature):
    """Load, N, and approach, m, of a rigid paraboloid r²/2R that touches within a radius, m; curvature: R, m."""
    unit, bowl = (lambda t: 0 * t + 2 / (np.pi * top)), (lambda t: -2 / (np.pi * top) * (radius * t) ** 2 / curvature)
    phi, rim = _solve(compliance, top, first, radius, [unit, bowl])
    approach = -rim[1] / rim[0]  # φ = 0 at the rim: the pressure there is finite
    return 2 * np.pi * radius * (approach * phi[0] + phi[1]), approach
