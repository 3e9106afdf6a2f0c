"""Displacement of the face of a section under waves of load on it.

The columns of a section are eliminated from left to right, all waves at once: with S = L Lᵀ of a line, its loads
become Z = L⁻¹ F, and the compliance of the face is the sum of Zᵀ Z over the lines: symmetric and positive by
construction. Between the waves, C(k) (k + k₀) is a smooth function of ln(k + k₀).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.sections.elements import stiffness
from treadload.kernels.sections.section import Mesh, Section

# Waves of a section of this height, times the height: 0 and a geometric row; and k₀.
_WAVES = np.concatenate([[0.0], np.geomspace(0.12, 52.0, 26)])
_SHIFT = 0.8
# Waves beyond the lattice that are folded back onto it, and the smallest weight of one that is.
_ALIASES, _UNSEEN = 2, 1e-20


def face_compliance(section: Section, poisson: float, waves: Array | None = None) -> FaceTable:
    """Displacement of the face of a section of E = 1 Pa under waves of load.

    poisson: ν, below ½. waves: k ≥ 0, 1/m; 27 that a table interpolates between if left out. Raises ValueError for
    a ν that is not below ½.
    """
    if not -1 < poisson < 0.5:
        raise ValueError(f"Poisson's ratio must lie between -1 and below 0.5, got {poisson:g}")
    mesh = section.mesh
    shear_modulus = 0.5 / (1 + poisson)
    lame = poisson / ((1 + poisson) * (1 - 2 * poisson))
    waves = _WAVES / section.height if waves is None else waves
    return FaceTable(section, poisson, waves, _swept(mesh, shear_modulus, lame, waves))


@dataclass(frozen=True, eq=False)
class FaceTable:
    """Compliance of the face of a section of E = 1 Pa at some waves.

    waves: k (n,), 1/m, the first 0. compliance: (n, 3 nodes, 3 nodes), m per N/m: U, V, W of the nodes of the face
    from left to right, by line loads of them; node by node. u = (i U, V, W) e^{ikx} for loads
    (i Q_x, Q_y, Q_z) e^{ikx}, z from the base to the face.
    """

    section: Section
    poisson: float
    waves: Array
    compliance: Array

    def on_cells(self, edges: Array, force_width: float | None = None) -> CellTable:
        """The same for strips of the face: mean displacement of a strip by a uniform load on another.

        edges: (strips, 2), y of both ends of every strip, m; all on the face. force_width: m; where it is given, a
        unit load is one per this width whatever the strip's own: a strip next to a wall may be wider or narrower than
        its cell and carries the cell's force. Left out: the strip's own width.
        """
        shares = _shares(self.section.mesh, edges)
        width = edges[:, 1] - edges[:, 0]
        means = shares / width
        loads = means * (width if force_width is None else force_width)
        count, strips = len(self.waves), len(width)
        nodes = shares.shape[0]
        table = self.compliance.reshape(count, nodes, 3, nodes, 3)
        on_strips = np.einsum("ai,kacbd,bj->kcidj", means, table, loads, optimize=True)
        return CellTable(self.section.height, self.waves, on_strips.reshape(count, 3 * strips, 3 * strips))


@dataclass(frozen=True, eq=False)
class CellTable:
    """Compliance of strips of a face, E = 1 Pa, at some waves.

    waves: (n,), 1/m. compliance: (n, 3 strips, 3 strips), m/Pa: U of all strips, then V, then W, by loads alike.
    """

    height: float
    waves: Array
    compliance: Array

    def at(self, k: Array) -> Array:
        """Compliance (m, 3 strips, 3 strips) at waves k (m,) ≥ 0, 1/m; beyond those of the table it falls as 1/k."""
        return np.asarray(self._combined(self._weights(k)).real)

    def lattice_weights(
        self, cells: int, dx: float, ahead: float = 0.0, fading: float = 0.0
    ) -> tuple[Array | ComplexArray, Array | ComplexArray]:
        """Share of every wave of the table in those of cells of length dx, m, periodic after so many: `by_weights`.

        Returns two (cells // 2 + 1, n): for what is even along travel, and for what is odd. A wave of the lattice
        stands for all that look alike on it: mean displacement of cells by uniform loads on others. ahead: distance
        of the displacement from the cells, m; complex where it is not 0. fading: length behind a steadily rolling
        load over which the displacement fades, m, V T of rubber that retards it, 1/(1 - i k V T); complex where it is
        not 0.
        """
        number = np.arange(cells // 2 + 1)
        # Every wave of the lattice is a sum of those of the table; those against the direction of travel apart.
        forth = np.zeros((number.size, self.waves.size), complex if ahead or fading else float)
        back = np.zeros_like(forth)
        for alias in range(-_ALIASES, _ALIASES + 1):
            waves = number / cells + alias
            weight = np.sinc(waves) ** 2
            seen = np.flatnonzero(weight > _UNSEEN)
            part = self._weights(2 * np.pi / dx * np.abs(waves[seen])) * weight[seen, None]
            if ahead:
                # Half way round, a wave and its image are one: of both together only what is real is left.
                part = part * np.exp(2j * np.pi * ahead / dx * waves[seen])[:, None]
            if fading:
                part = part / (1 - 2j * np.pi * fading / dx * waves[seen])[:, None]
            (back if alias < 0 else forth)[seen] += part
        # Loads and displacements along travel turn round with the direction of a wave.
        return forth + back, forth - back

    def by_weights(self, even: Array | ComplexArray, odd: Array | ComplexArray) -> Array | ComplexArray:
        """Compliance (m, 3 strips, 3 strips), m/Pa, of sums of the waves of the table, in its frame.

        even, odd: (m, n), see `lattice_weights`; odd joins u_x to q_y and p, and q_x to u_y and u_n. Real weights of
        the lattice give matrices that are symmetric and positive.
        """
        total = self._combined(even)
        third = total.shape[1] // 3
        by_across, by_along = np.s_[:, :third, third:], np.s_[:, third:, :third]
        for part in (by_across, by_along):
            turned = self.compliance[part]
            total[part] = (odd @ turned.reshape(self.waves.size, -1)).reshape(-1, *turned.shape[1:])
        return total

    def _weights(self, k: Array) -> Array:
        """(m, n) of the waves of the table in C(k), k (m,) ≥ 0, 1/m: the spline is linear in what it joins."""
        shift = _SHIFT / self.height
        inside = np.minimum(k, self.waves[-1])
        return np.asarray(self._spline(np.log(inside + shift)) / (k + shift)[:, None])

    def _combined(self, weights: Array | ComplexArray) -> Array | ComplexArray:
        """Sums (m, 3 strips, 3 strips) of the compliance at the waves of the table by weights (m, n)."""
        flat = self.compliance.reshape(self.waves.size, -1)
        sums: Array | ComplexArray = weights @ flat
        return sums.reshape(-1, *self.compliance.shape[1:])

    @cached_property
    def _spline(self) -> scipy.interpolate.CubicSpline:
        shift = _SHIFT / self.height
        return scipy.interpolate.CubicSpline(np.log(self.waves + shift), np.diag(self.waves + shift), axis=0)


def _shares(mesh: Mesh, edges: Array) -> Array:
    """Integrals (nodes, strips) of the shape functions of the face over strips, m."""
    blocks = []
    for y in mesh.face:
        block = np.zeros((y.size, len(edges)))
        for first in range(0, y.size - 1, 2):
            left, middle, right = y[first : first + 3]
            half = 0.5 * (right - left)
            low, high = (np.clip((edge - middle) / half, -1.0, 1.0) for edge in edges.T)

            def between(power: int, low: Array = low, high: Array = high) -> Array:
                return np.asarray((high**power - low**power) / power)

            constant, linear, square = between(1), between(2), between(3)
            block[first] += half * 0.5 * (square - linear)
            block[first + 1] += half * (constant - square)
            block[first + 2] += half * 0.5 * (square + linear)
        blocks.append(block)
    return np.concatenate(blocks)


def _swept(mesh: Mesh, shear_modulus: float, lame: float, waves: Array) -> Array:
    """Compliance of the nodes of the face, (waves, 3 nodes, 3 nodes)."""
    powers = np.stack([np.ones_like(waves), waves, waves**2], axis=1)
    face = mesh.face_lines
    compliance = np.zeros((waves.size, 3 * face.size, 3 * face.size))
    numbers = {line: 3 * place for place, line in enumerate(face)}
    loaded = 0
    top = len(mesh.levels) - 1
    heights = [max(pair) for pair in zip((0, *mesh.rows), (*mesh.rows, 0), strict=True)]
    # What the columns to the left leave on the next line: its stiffness, and the loads on it.
    left = np.zeros((waves.size, 6 * heights[0], 6 * heights[0]))
    brought = np.zeros((waves.size, 6 * heights[0], 0))

    def with_load(forces: Array, line: int) -> Array:
        """Forces with the unit loads of a line that reaches the face as further columns."""
        if line not in numbers:
            return forces
        units = np.zeros((waves.size, forces.shape[1], 3))
        units[:, 3 * (top - 1) : 3 * top] = np.eye(3)
        return np.concatenate([forces, units], axis=2)

    for column, rows in enumerate(mesh.rows):
        size, following = 6 * rows, 6 * heights[column + 1]
        stiff = np.tensordot(powers, _column(mesh, column, shear_modulus, lame), 1)
        # The left line and the middle of the column meet what lies to the right of them through this column alone.
        wide = left.shape[1]
        kept = np.zeros((waves.size, wide + size, wide + size))
        kept[:, :wide, :wide] = left
        inner = np.r_[:size, wide : wide + size]
        kept[:, inner[:, None], inner] += stiff[:, : 2 * size, : 2 * size]
        ahead = np.zeros((waves.size, wide + size, following))
        ahead[:, inner, :size] = stiff[:, : 2 * size, 2 * size :]
        forces = with_load(brought, 2 * column)
        middle = np.zeros((waves.size, size, forces.shape[2]))
        forces = np.concatenate([forces, middle], axis=1)
        if 2 * column + 1 in numbers:
            units = np.zeros((waves.size, wide + size, 3))
            units[:, wide + size - 3 :] = np.eye(3)
            forces = np.concatenate([forces, units], axis=2)
        factor = _inverse_factor(kept)
        forces, ahead = factor @ forces, factor @ ahead
        loaded = forces.shape[2]
        compliance[:, :loaded, :loaded] += forces.swapaxes(1, 2) @ forces
        left = -ahead.swapaxes(1, 2) @ ahead
        left[:, :size, :size] += stiff[:, 2 * size :, 2 * size :]
        brought = -ahead.swapaxes(1, 2) @ forces
    forces = _inverse_factor(left) @ with_load(brought, 2 * len(mesh.rows))
    loaded = forces.shape[2]
    compliance[:, :loaded, :loaded] += forces.swapaxes(1, 2) @ forces
    return compliance


def _inverse_factor(stiff: Array) -> Array:
    """L⁻¹ (waves, n, n) of symmetric positive L Lᵀ; a triangle is inverted in an eighth of the steps of a square."""
    factors = np.linalg.cholesky(stiff)
    for factor in factors:
        # The transpose of a row-major triangle is the column-major one that LAPACK inverts in place.
        inverse, _ = scipy.linalg.lapack.dtrtri(factor.T, lower=0, overwrite_c=1)
        factor[:] = inverse.T
    return np.asarray(factors)


def _column(mesh: Mesh, column: int, shear_modulus: float, lame: float) -> Array:
    """K₀, K₁, K₂ (3, n, n) of a column without its base: its left line, its middle, its right line, from below."""
    rows = mesh.rows[column]
    levels = mesh.levels[: 2 * rows + 1]
    y = mesh.lines[2 * column : 2 * column + 3, : 2 * rows + 1]
    up = 2 * np.arange(rows)[:, None] + np.arange(3)
    parts = stiffness(
        y[:, up].transpose(1, 0, 2), np.broadcast_to(levels[up][:, None, :], (rows, 3, 3)), shear_modulus, lame
    )
    nodes = 2 * rows + 1
    whole = np.zeros((3, 9 * nodes, 9 * nodes))
    across = np.arange(3)[:, None] * nodes
    for row in range(rows):
        places = (3 * (across + up[row]).reshape(9, 1) + np.arange(3)).ravel()
        whole[:, places[:, None], places] += parts[:, row]
    free = (np.arange(9 * nodes) // 3) % nodes > 0
    return whole[:, free][:, :, free]
