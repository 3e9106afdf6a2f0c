"""Stress of dislocations in a layer of a plane section: in the plane without end, of its images, of all layers.

A dislocation is given by its strength: an edge by E b / (4π (1 - ν²)), a screw by μ b / 2π, N/m. x along the section,
z down. Method: Fourier integrals over waves along x; images in the two boundaries of the layer, as if half-spaces lay
beyond them, are closed forms, and what the layers add is the integral that is left.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.fracture.layers import Strip, antiplane_reflections, reflections, shifted

# Amplitudes (α, β) that a dislocation sends down and up: its Burgers vector along x, along z.
_DOWN = ((0.0, 1.0), (-1.0, -1.0))
_UP = ((0.0, -1.0), (-1.0, -1.0))
# Wavenumbers over the inverse of the largest and the smallest length, panels of points in their logarithm.
_LONGEST, _SHORTEST, _POINTS = 2e-6, 40.0, 8


@dataclass(frozen=True)
class Section:
    """Layers in a plane section, and the one that cracks. rigid: the last lies on rock."""

    strips: tuple[Strip, ...]
    layer: int = 0
    rigid: bool = False

    @property
    def thickness(self) -> float:
        """Of the layer that cracks, m; inf for the last."""
        return self.strips[self.layer].thickness

    @property
    def slides(self) -> bool:
        """Whether an interface slips in proportion to its shear, which matters to short waves at any distance."""
        return any(0 < strip.slip < math.inf for strip in self.strips)

    @cached_property
    def nearest(self) -> tuple[tuple[Array, float] | None, tuple[Array, float] | None]:
        """Reflections of top and bottom as if half-spaces lay beyond; None for a boundary that is not there."""
        return self._beyond(top=True), None if math.isinf(self.thickness) else self._beyond(top=False)

    def _beyond(self, *, top: bool) -> tuple[Array, float]:
        layer_strip, ones = replace(self.strips[self.layer], thickness=math.inf), np.ones(1)
        number = 0 if top else 1
        strips: tuple[Strip, ...]
        if top and self.layer == 0:
            strips, layer, rigid = (replace(layer_strip, slip=0.0),), 0, False
        elif top:
            upper_strip = self.strips[self.layer - 1]
            # Half a million times the length of the wave is far away.
            strips, layer, rigid = (
                (replace(upper_strip, thickness=500.0, slip=_at_once(upper_strip.slip)), layer_strip),
                1,
                False,
            )
        elif self.layer == len(self.strips) - 1:
            strips, layer, rigid = (replace(layer_strip, thickness=500.0),), 0, True
        else:
            below = replace(self.strips[self.layer + 1], thickness=math.inf, slip=0.0)
            strips, layer, rigid = (
                (replace(layer_strip, thickness=500.0, slip=_at_once(layer_strip.slip)), below),
                0,
                False,
            )
        plane = reflections(strips, layer, ones, rigid=rigid)[number][0]
        return plane, float(antiplane_reflections(strips, layer, ones, rigid=rigid)[number][0])


def _at_once(slip: float) -> float:
    """The slip that matters to short waves."""
    return math.inf if slip > 0 else 0.0


def edge_in_the_plane(source: tuple[Array, Array], point: tuple[Array, Array]) -> Array:
    """Stress (xx, zz, xz; Burgers vector along x, along z; points, sources), Pa, of edges of strength 1 N/m.

    The part of a plane without end, singular where a point meets a source; to it add those of `edge_images` and
    `edge_layers`. source, point: (x, z), m, in the layer, z from its top.
    """
    x, z = point[0][:, None] - source[0], point[1][:, None] - source[1]
    square = x**2 + z**2
    quart = square**2
    apart = x**2 - z**2
    return np.stack(
        [
            np.stack([-z * (3 * x**2 + z**2) / quart, x * apart / quart]),
            np.stack([z * apart / quart, x * (x**2 + 3 * z**2) / quart]),
            np.stack([x * apart / quart, z * apart / quart]),
        ]
    )


def screw_in_the_plane(source: tuple[Array, Array], point: tuple[Array, Array]) -> Array:
    """Stress (xy, yz; points, sources), Pa, of screws of strength 1 N/m, arguments as in `edge_in_the_plane`.

    The part of a plane without end; to it add those of `screw_images` and `screw_layers`.
    """
    x, z = point[0][:, None] - source[0], point[1][:, None] - source[1]
    return np.stack([z, -x]) / (x**2 + z**2)


def edge_images(section: Section, source: tuple[Array, Array], point: tuple[Array, Array]) -> Array:
    """The part of the stress of edges of the layer's two boundaries, each as if a half-space lay beyond it.

    It is singular where a point and a source meet at a boundary.
    """
    x = point[0][:, None] - source[0]
    z, zeta = point[1][:, None], source[1]
    stress = np.zeros((3, 2, *x.shape))
    top, bottom = section.nearest
    if top is not None:
        stress += _image(top[0], _UP, x, z + 0 * zeta, zeta + 0 * z, 1.0)
    if bottom is not None:
        h = section.thickness
        stress += _image(bottom[0], _DOWN, x, h - z + 0 * zeta, h - zeta + 0 * z, -1.0)
    return stress


def screw_images(section: Section, source: tuple[Array, Array], point: tuple[Array, Array]) -> Array:
    """The part of the stress of screws of the layer's two boundaries."""
    x = point[0][:, None] - source[0]
    z, zeta = point[1][:, None], source[1]
    stress = np.zeros((2, *x.shape))
    top, bottom = section.nearest
    if top is not None:
        far = z + zeta
        stress -= top[1] * np.stack([far, -x]) / (x**2 + far**2)
    if bottom is not None:
        far = 2 * section.thickness - z - zeta
        stress += bottom[1] * np.stack([far, x]) / (x**2 + far**2)
    return stress


def _image(matrix: Array, sent: Sequence[tuple[float, float]], x: Array, z: Array, zeta: Array, sign: float) -> Array:
    """Of both Burgers vectors, from amplitudes sent to a boundary at the distance zeta and read at z from it.

    sign: 1 below the boundary, -1 above it.
    """
    stress = np.zeros((3, 2, *x.shape))
    inverse = 1 / (z + zeta - 1j * x)
    powers = [inverse, inverse**2, 2 * inverse**3]
    for burgers, (alpha, beta) in enumerate(sent):
        # φ = (a + b k z) exp(-k (z + ζ)), a and b linear in k.
        a = [matrix[0, 0] * alpha + matrix[0, 1] * beta, matrix[0, 0] * beta * zeta]
        b = [matrix[1, 0] * alpha + matrix[1, 1] * beta, matrix[1, 0] * beta * zeta]
        zero = np.zeros_like(zeta)
        ramp = [zero, b[0] * z, b[1] * z]
        a, b = [*a, zero], [*b, zero]
        value = sum((p + r) * power for p, r, power in zip(a, ramp, powers, strict=True))
        first = sum((q - p - r) * power for p, q, r, power in zip(a, b, ramp, powers, strict=True))
        second = sum((p - 2 * q + r) * power for p, q, r, power in zip(a, b, ramp, powers, strict=True))
        stress[:, burgers] = _read(value, first, second, burgers, sign)
    return stress


def _read(value: ComplexArray, first: ComplexArray, second: ComplexArray, burgers: int, sign: float) -> Array:
    """Stress (xx, zz, xz) of waves φ, φ', φ'' times exp(i k x): even in x for a vector along x, else odd."""
    if burgers == 0:
        return np.stack([second.real, -value.real, sign * first.imag])
    return np.stack([second.imag, -value.imag, -sign * first.real])


def _waves(section: Section, z: Array, zeta: Array) -> tuple[Array, Array]:
    """Wavenumbers and their weights for points and sources: from the longest length to the shortest distance."""
    finite = [strip.thickness for strip in section.strips if math.isfinite(strip.thickness)]
    far = [section.thickness - depths.max() for depths in (z, zeta)] if math.isfinite(section.thickness) else []
    # Beyond the images waves fade over the thickness of a layer; where an interface slides, over the distance to it.
    short = min(finite)
    if section.slides:
        short = min(short, max(min(z.min() + zeta.min(), *([sum(far)] if far else [])), 1e-5))
    low, high = math.log(_LONGEST / sum(finite)), math.log(_SHORTEST / short)
    panels = math.ceil((high - low) / 1.2)
    node, weight = np.polynomial.legendre.leggauss(_POINTS)
    edges = np.linspace(low, high, panels + 1)
    half = 0.5 * np.diff(edges)[:, None]
    k = np.exp((0.5 * (edges[1:] + edges[:-1])[:, None] + half * node).ravel())
    return k, (half * weight).ravel() * k


def edge_layers(section: Section, source: tuple[Array, Array], point: tuple[Array, Array]) -> Array:
    """What the layers add to the stress of edges with images: regular where the boundaries are bonded."""
    if len(section.strips) == 1 and not section.rigid:
        return np.zeros((3, 2, len(point[1]), len(source[1])))
    z, zeta = point[1], source[1]
    k, weight = _waves(section, z, zeta)
    x = point[0][:, None] - source[0]
    top, bottom = reflections(section.strips, section.layer, k, rigid=section.rigid)
    finite = math.isfinite(section.thickness)
    h = section.thickness if finite else 0.0
    images = section.nearest
    # (nk, sources, amplitude)
    p = k[:, None]
    fade = np.exp(-k * h)[:, None, None] if finite else np.zeros((len(k), 1, 1))
    through = fade * (np.eye(2) + (k * h)[:, None, None] * np.array([[0.0, 1.0], [0.0, 0.0]]))
    stress = np.zeros((3, 2, len(z), len(zeta)))
    for burgers in range(2):
        at_top = shifted(np.broadcast_to(_UP[burgers], (len(k), len(zeta), 2)), p * zeta)
        if finite:
            at_bottom = shifted(np.broadcast_to(_DOWN[burgers], (len(k), len(zeta), 2)), p * (h - zeta))
        else:
            at_bottom = np.zeros_like(at_top)
        # D = T (a + S U), U = B (b + S D).
        there = np.einsum("kij,ksj->ksi", top, at_top)
        back = np.einsum("kij,ksj->ksi", bottom, at_bottom)
        left = np.eye(2) - top @ through @ bottom @ through
        right = there + np.einsum("kij,ksj->ksi", top @ through, back)
        down = np.linalg.solve(left, right.transpose(0, 2, 1)).transpose(0, 2, 1)
        up = back + np.einsum("kij,ksj->ksi", bottom @ through, down)
        if images[0] is not None:
            down = down - np.einsum("ij,ksj->ksi", images[0][0], at_top)
        if images[1] is not None:
            up = up - np.einsum("ij,ksj->ksi", images[1][0], at_bottom)
        for amplitudes, distance, sign in ((down, z, 1.0), (up, h - z, -1.0)):
            if sign < 0 and not finite:
                continue
            q = p * distance
            near = np.exp(-q) * weight[:, None]
            # φ = (α + β q) e^-q and its derivatives, each as a sum of two products (k, points) x (k, sources).
            alpha, beta = amplitudes[..., 0], amplitudes[..., 1]
            value = (near, alpha), (near * q, beta)
            first = (near, beta - alpha), (-near * q, beta)
            second = (near, alpha - 2 * beta), (near * q, beta)
            phi, phi_1, phi_2 = (_sum(spectrum, k, x, point[0], source[0]) for spectrum in (value, first, second))
            stress[:, burgers] += _read(phi, phi_1, phi_2, burgers, sign)
    return stress


def _sum(terms: Sequence[tuple[Array, Array]], k: Array, x: Array, at: Array, of: Array) -> ComplexArray:
    """Σ over k of products times exp(i k x), complex (points, sources)."""
    if not x.any():
        return np.asarray(sum(left.T @ right for left, right in terms), dtype=complex)
    here, there = np.exp(1j * k[:, None] * at), np.exp(-1j * k[:, None] * of)
    return np.asarray(sum((left * here).T @ (right * there) for left, right in terms))


def screw_layers(section: Section, source: tuple[Array, Array], point: tuple[Array, Array]) -> Array:
    """What the layers add to the stress of screws in the plane with images."""
    if len(section.strips) == 1 and not section.rigid:
        return np.zeros((2, len(point[1]), len(source[1])))
    z, zeta = point[1], source[1]
    k, weight = _waves(section, z, zeta)
    x = point[0][:, None] - source[0]
    top, bottom = antiplane_reflections(section.strips, section.layer, k, rigid=section.rigid)
    images = section.nearest
    finite = math.isfinite(section.thickness)
    h = section.thickness if finite else 0.0
    p = k[:, None]
    a, b = -np.exp(-p * zeta), np.exp(-p * (h - zeta)) if finite else np.zeros((len(k), len(zeta)))
    fade = np.exp(-k * h)[:, None] if finite else np.zeros((len(k), 1))
    t, u = top[:, None], bottom[:, None]
    down = t * (a + fade * u * b) / (1 - t * u * fade**2)
    up = u * (b + fade * down)
    down = down - (images[0][1] if images[0] is not None else 0.0) * a
    up = up - (images[1][1] if images[1] is not None else 0.0) * b
    stress = np.zeros((2, len(z), len(zeta)))
    for amplitude, distance, sign in ((down, z, 1.0), (up, h - z, -1.0)):
        if sign < 0 and not finite:
            continue
        faded = np.exp(-p * distance) * weight[:, None]
        wave = _sum([(faded, amplitude)], k, x, point[0], source[0])
        stress += np.stack([wave.real, -sign * wave.imag])
    return stress
