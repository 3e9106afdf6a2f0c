"""Surface displacement of an anisotropic half-space under a uniformly loaded rectangle, exactly.

A point load moves the surface by g(φ)/r, with the harmonics of g from those of L (`kernels.anisotropy.symbol`):

    g(φ) = Re L(φ + π/2)/2π - (1/4π²) PV∫ Im L(t)/cos(t - φ) dt,   PV∫ exp(iqs)/cos s ds = 2π (-1)^((|q|-1)/2), q odd.

The double integral of g/r over x and y is homogeneous of degree one: X P(φ) + Y Q(φ), with P = ∫ g/cos, Q = ∫ g/sin
over the angle. What is singular in them has closed forms,

    even part of g:  g(π/2) X asinh(Y/|X|) + g(0) Y asinh(X/|Y|) + r T(φ)
    odd part:        (g(π/2) X + g(0) Y) ln r + h X atan(Y/X) + h' Y atan(X/Y) + r T(φ)

and T is a trigonometric polynomial, known exactly and tabulated with its derivatives: a coefficient is the sum [[ ]]
over four corners of a few elementary functions and one entry of the table, of any material.

Sources: Barnett & Lothe (1975), J. Phys. F 5, 1675-1684 (point load); Love (1929), Phil. Trans. R. Soc. A 228,
377-420.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.kernels import fft
from treadload.kernels.anisotropy.symbol import Symbol
from treadload.kernels.arrays import Array, ComplexArray

EVEN = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Places of the even part of g, symmetric, in the first six rows of `coefficients`."""
ODD = ((0, 1), (0, 2), (1, 2))
"""Places of its odd part, antisymmetric, in the last three."""

# Terms of the Taylor series between entries of the table, and its error relative to the largest value.
_TERMS = 6
_TABLE_ERROR = 1e-16
# Beyond, a table would not fit into a cache.
_LARGEST_TABLE = 2**17
# Corners that are worked on together.
_AT_ONCE = 2**14


@dataclass(frozen=True, eq=False)
class Angular:
    """What a rectangle's coefficients need of a material: functions of the angle.

    across, along: g(π/2) and g(0), (9,), 1/Pa, even parts in the order of `EVEN`, then odd parts in that of `ODD`.
    turn_x, turn_y: h and h', (3,), 1/Pa. table: T and its derivatives over their factorials at whole parts of a
    turn, (angles, 6, 9), 1/Pa. error: of the table, a bound, relative to the largest value of g.
    """

    across: Array
    along: Array
    turn_x: Array
    turn_y: Array
    table: Array
    error: float

    @classmethod
    def of(cls, symbol: Symbol) -> Angular:
        """The functions of a surface's symbol."""
        g = green(symbol)
        size = float(np.abs(g).sum(-1).max())
        direct, turn_x = _over_cosine(g)
        # The other axis sees the angle from its own side: ψ = π/2 - φ.
        turned, turn_y = _over_cosine(_reflected(g))
        back = _reflected(turned)
        smooth = np.zeros((9, g.shape[-1] + 2), complex)
        smooth[:, 2:] += 0.5 * direct + back / 2j
        smooth[:, :-2] += 0.5 * direct - back / 2j
        order = smooth.shape[-1] // 2
        at = np.arange(-order, order + 1)
        rest = np.abs(smooth).max(0) * np.abs(at) ** _TERMS / math.factorial(_TERMS)
        entries = 1024
        while (error := float(rest.sum()) * (math.pi / entries) ** _TERMS / size) > _TABLE_ERROR:
            entries *= 2
            if entries == _LARGEST_TABLE:
                break
        table = np.empty((entries, _TERMS, 9))
        for power in range(_TERMS):
            padded = np.zeros((9, entries), complex)
            padded[:, at] = smooth * (1j * at) ** power / math.factorial(power)
            table[:, power] = fft.ifft(padded, axis=1).real.T * entries
        return cls(_value(g, 0.5 * math.pi), _value(g, 0.0), turn_x[6:], turn_y[6:], table, error)


def green(symbol: Symbol) -> ComplexArray:
    """Harmonics (9, 2 n_max + 1) of g, 1/Pa, n from -n_max: r times the displacement by a point load.

    Rows as those of `coefficients`.
    """
    n = np.arange(-symbol.order, symbol.order + 1)
    harmonics = np.zeros((9, n.size), complex)
    for row, (i, j) in enumerate(EVEN):
        # Those of the real part are even, those of the imaginary part odd.
        harmonics[row] = np.where(n % 2 == 0, symbol.harmonics[i, j] * 1j**n, 0) / (2 * math.pi)
    sign = (-1.0) ** ((np.abs(n) - 1) // 2)
    for row, (i, j) in enumerate(ODD, 6):
        harmonics[row] = np.where(n % 2 == 1, 1j * symbol.harmonics[i, j] * sign, 0) / (2 * math.pi)
    return harmonics


def coefficients(
    angular: Angular,
    ny: int,
    nx: int,
    dx: float,
    dy: float,
    first_x: float = 0.0,
    first_y: float = 0.0,
    rows: Sequence[int] = range(9),
) -> Array:
    """Displacement (9, ny, nx), m/Pa, by unit traction on a cell of dx by dy, m, at z = 0 of a half-space z > 0.

    At x = first_x + dx (0 … nx - 1), y = first_y + dy (0 … ny - 1) from its centre, m. Rows: even parts of u_x by
    t_x, u_y by t_y, u_z by t_z, u_x by t_y, u_x by t_z, u_y by t_z, alike for the two exchanged; then the odd parts
    of the last three, of the other sign for the two exchanged. Even and odd under (x, y) → (-x, -y).
    rows: those wanted, (rows, ny, nx).
    """
    x = _snapped(first_x + dx * (np.arange(nx + 1) - 0.5), dx)[None, :]
    y = _snapped(first_y + dy * (np.arange(ny + 1) - 0.5), dy)[:, None]
    wanted = list(rows)
    table = np.ascontiguousarray(angular.table[..., wanted])
    result = np.empty((len(wanted), ny, nx))
    high = max(1, _AT_ONCE // (nx + 1))
    for low in range(0, ny, high):
        corner = _corners(angular, wanted, table, x, y[low : low + high + 1])
        lines = corner[..., 1:] - corner[..., :-1]
        np.subtract(lines[:, 1:], lines[:, :-1], out=result[:, low : low + high])
    return result


def _corners(angular: Angular, rows: list[int], table: Array, x: Array, y: Array) -> Array:
    """The functions (rows, my, mx) whose alternating sums over corners are the coefficients."""
    r = np.hypot(x, y)
    corner = _smooth(table, np.arctan2(y, x))
    corner *= r
    if min(rows) < len(EVEN):
        by_x, by_y = x * np.arcsinh(y / _divisor(np.abs(x))), y * np.arcsinh(x / _divisor(np.abs(y)))
    if max(rows) >= len(EVEN):
        log = np.log(np.where(r == 0, 1.0, r))
        turn_x, turn_y = x * np.arctan(y / _divisor(x)), y * np.arctan(x / _divisor(y))
    for row, function in zip(rows, corner, strict=True):
        across, along = angular.across[row], angular.along[row]
        if row < len(EVEN):
            function += across * by_x + along * by_y
        else:
            odd = row - len(EVEN)
            function += (across * x + along * y) * log
            function += angular.turn_x[odd] * turn_x + angular.turn_y[odd] * turn_y
    return corner


def _smooth(table: Array, angle: Array) -> Array:
    """T (rows, …) at angles (…), rad, by Taylor's series from the nearest entry of a table (angles, 6, rows)."""
    entries = len(table)
    place = angle * (entries / (2 * math.pi))
    nearest = np.rint(place).astype(int)
    apart = ((place - nearest) * (2 * math.pi / entries)).reshape(-1, 1)
    rows = table[nearest.ravel() % entries]
    value = rows[:, -1].copy()
    for power in range(_TERMS - 2, -1, -1):
        value *= apart
        value += rows[:, power]
    return np.ascontiguousarray(value.T).reshape(-1, *angle.shape)


def _over_cosine(g: ComplexArray) -> tuple[ComplexArray, Array]:
    """Harmonics (9, …) of ∫ (g - what is singular)/cos dφ without its mean, and its rise h (9,) per rad.

    What is singular: g(π/2) in the even parts, g(π/2) sin φ in the odd ones.
    """
    order = g.shape[-1] // 2
    rest = g.copy()
    edge = _value(g, 0.5 * math.pi)
    rest[:6, order] -= edge[:6]
    rest[6:, order + 1] -= edge[6:] / 2j
    rest[6:, order - 1] += edge[6:] / 2j
    quotient = np.zeros_like(rest)
    # cos φ h = rest, from the highest harmonic down: h_(n-1) = 2 rest_n - h_(n+1).
    for n in range(order, 0, -1):
        above = quotient[:, order + n + 1] if n < order else 0
        quotient[:, order + n - 1] = 2 * rest[:, order + n] - above
    rise = quotient[:, order].real.copy()
    integral = np.zeros_like(rest)
    integral[:, order + 1 :] = quotient[:, order + 1 :] / (1j * np.arange(1, order + 1))
    integral[:, order - 1 :: -1] = integral[:, order + 1 :].conj()
    return integral, rise


def _reflected(harmonics: ComplexArray) -> ComplexArray:
    """Harmonics of f(π/2 - φ) from those of f."""
    order = harmonics.shape[-1] // 2
    n = np.arange(-order, order + 1)
    return np.asarray((harmonics * 1j**n)[:, ::-1])


def _value(harmonics: ComplexArray, angle: float) -> Array:
    order = harmonics.shape[-1] // 2
    return np.asarray((harmonics @ np.exp(1j * angle * np.arange(-order, order + 1))).real)


def _snapped(distance: Array, step: float) -> Array:
    """Distances, with those within round-off of zero zero."""
    return np.where(np.abs(distance) < 1e-9 * step, 0.0, distance)


def _divisor(distance: Array) -> Array:
    return np.where(distance == 0, 1.0, distance)
