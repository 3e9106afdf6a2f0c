"""Checks of rubber on texture: Westergaard's ridges, Hertz in an egg box, light load, a layer, an enveloped load."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.contact.rough import solve_texture
from treadload.contact.rough_theory import sine_area
from treadload.contact.tread_layer import TreadRubber
from treadload.materials import Elastic
from treadload.pavement.texture import Texture, mean_profile_depth, self_affine
from treadload.validation.check import Check, relative

_RUBBER, _STAR = Elastic(6e6, 0.5), 8e6
_HEIGHT, _WAVE = 1e-4, 0.02


def texture_checks() -> Iterator[Check]:
    """Area and peak pressure on ridges and an egg box; area over light load; MPD of a wave; a layer's compliance."""
    group = "texture"
    cosine = np.cos(2 * np.pi * np.arange(512) / 512)
    ridges = Texture(_HEIGHT * cosine, _WAVE / 512, _WAVE / 512, periodic=True)
    full = math.pi * _STAR * _HEIGHT / _WAVE
    shares = np.array([0.1, 0.5])
    data = solve_texture(ridges, _RUBBER, shares * full, tolerance=1e-6).dataset
    for row, share in enumerate(shares):
        yield relative(
            group, f"ridges, 512 cells, {share:g} of the load that fills them: area",
            float(data.real_area_ratio[row]), float(sine_area(share * full, _STAR, _HEIGHT, _WAVE)), 1e-2,
            "Westergaard (1939), J. Appl. Mech. 6, 49",
        )  # fmt: skip
        yield relative(
            group, f"ridges, 512 cells, {share:g} of that load: peak pressure", float(data.peak_pressure[row]),
            2 * math.sqrt(share) * full, 1e-3, "Westergaard (1939), J. Appl. Mech. 6, 49",
        )  # fmt: skip
    wave = cosine[::4]
    box = Texture(_HEIGHT * wave[None] * wave[:, None], _WAVE / 128, _WAVE / 128, periodic=True)
    load = 2e-3 * math.sqrt(2) * full
    radius, force = _WAVE**2 / (4 * math.pi**2 * _HEIGHT), load * _WAVE**2 / 2
    light = solve_texture(box, _RUBBER, [load], tolerance=1e-6).dataset
    yield relative(
        group, "egg box, 128² cells, light load: peak pressure (Pa)", float(light.peak_pressure[0]),
        (6 * force * _STAR**2 / radius**2) ** (1 / 3) / math.pi, 1e-2, "Hertz; Johnson et al. (1985)",
    )  # fmt: skip
    surface = self_affine(1.0, 1 / 512, hurst=0.8, shortest=1 / 64, roll_off=1 / 8, rms_height=5e-3, seed=0)
    loads = np.array([0.01, 0.02])
    rough = solve_texture(surface, _RUBBER, loads * _STAR * surface.rms_slope).dataset
    slope = rough.real_area_ratio.to_numpy() / loads
    yield relative(
        group, "fractal surface, 8 cells a wave: area over load, at twice the load", slope[1], slope[0], 5e-2,
        "proportional: Persson (2001), Bush et al. (1975)",
    )  # fmt: skip
    low, high = math.sqrt(8 / math.pi), math.sqrt(2 * math.pi)
    yield relative(
        group, "the same: κ between Persson's and that of asperities alone", slope[0], 0.5 * (low + high),
        (high - low) / (high + low), "their values, 1.596 and 2.507",
    )  # fmt: skip
    thin = TreadRubber(6e6, 0.5, 0.01).compliance(np.array([1.0]))[0]
    yield relative(
        group, "incompressible tread under a long wave: compliance (m/Pa)", float(thin), 1e-6 / (3 * 2e6), 1e-3,
        "film with one free surface",
    )  # fmt: skip
    x = 0.5e-3 * np.arange(2000)
    depth = mean_profile_depth(Texture(1e-3 * np.cos(2 * np.pi * x / 20e-3), 0.5e-3, 0.5e-3)).mean
    yield relative(group, "MPD of a cosine of 1 mm, 20 mm long (m)", depth, 1e-3, 5e-3, "ISO 13473-1:2019")
