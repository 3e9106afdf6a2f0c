"""Self-affine textures, made of waves with random phases."""

from __future__ import annotations

import math

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels import fft
from treadload.kernels.arrays import Array
from treadload.pavement.texture.description import Texture

_MOST_POINTS = 4096


def self_affine(
    size: float,
    spacing: float,
    *,
    hurst: float,
    shortest: float,
    roll_off: float | None = None,
    rms_slope: float | None = None,
    rms_height: float | None = None,
    seed: int = 0,
) -> Texture:
    """An isotropic self-affine texture that continues at its borders.

    size: of its sides, m; the longest wave. spacing: of its points, m; a whole number of them must fit. hurst: in
    (0, 1]. shortest: the shortest wave, m, four points or more. roll_off: wave, m, beyond which the spectrum is flat;
    left out, size. rms_slope or rms_height, m: one of them; exact. seed: of the phases. Every wave keeps its phase
    whatever the spacing and the shortest wave, so that finer points show the same surface, and shorter waves add to
    it. The power spectrum goes as q^(-2 - 2 hurst). Raises InputError.

    Source: random phases as in Müser et al. (2017), Tribol. Lett. 65, 118.
    """
    for name, value in {"size": size, "spacing": spacing, "shortest wave": shortest}.items():
        positive(f"the {name} of a texture", value, "metres", "1 mm is 0.001")
    if not 0 < hurst <= 1:
        raise InputError(f"hurst must lie in (0, 1], got {hurst:g}; roads are near 0.8")
    if (rms_slope is None) == (rms_height is None):
        raise InputError("give either rms_slope or rms_height, in m, of a self-affine texture")
    wanted = rms_slope if rms_height is None else rms_height
    assert wanted is not None
    positive("rms_slope" if rms_height is None else "rms_height", wanted, "1" if rms_height is None else "metres")
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise InputError(f"seed must be a whole number >= 0, got {seed!r}")
    points = round(size / spacing)
    if not math.isclose(points * spacing, size, rel_tol=1e-6) or not 8 <= points <= _MOST_POINTS:
        raise InputError(
            f"a texture of {size:g} m needs 8 to {_MOST_POINTS} points a side and a whole number of them, got "
            f"{size / spacing:.6g} at a spacing of {spacing:g} m"
        )
    if shortest < 4 * spacing * (1 - 1e-9):
        raise InputError(
            f"a shortest wave of {shortest:g} m needs four points, got a spacing of {spacing:g} m: take "
            f"{shortest / 4:.3g} m or less"
        )
    flat = size if roll_off is None else roll_off
    if not shortest <= flat <= size * (1 + 1e-9):
        raise InputError(
            f"roll_off must lie between the shortest wave, {shortest:g} m, and the size, {size:g} m, got {flat:g} m"
        )
    most = math.floor(size / shortest * (1 + 1e-9))
    phase = _phases(most, int(seed))
    # Number of whole waves along y (rows, both signs) and along x (columns, not negative).
    along, across = np.arange(most + 1), fft.fftfreq(2 * most + 1, 1 / (2 * most + 1))
    waves = np.hypot(along[None, :], across[:, None])
    amplitude = np.maximum(waves, size / flat, where=waves > 0, out=np.ones_like(waves)) ** (-1.0 - hurst)
    amplitude[(waves > most) | (waves == 0)] = 0.0
    # Of the waves with no part along x, one of each pair stands for both.
    twice = np.full(waves.shape, 2.0)
    twice[:, 0] = 1.0
    weight = 1.0 if rms_slope is None else (2 * np.pi * waves / size) ** 2
    amplitude *= wanted / math.sqrt(float((twice * amplitude**2 * weight).sum()))
    half = np.zeros((points, points // 2 + 1), complex)
    half[np.ix_(across.astype(int) % points, along)] = amplitude * np.exp(1j * phase)
    # The origin of the waves is the corner, at -size/2.
    heights = fft.irfft2(half, s=(points, points)) * points**2
    relief = f"rms slope {rms_slope:g}" if rms_height is None else f"rms height {rms_height * 1e3:g} mm"
    source = (
        f"self-affine, Hurst exponent {hurst:g}, waves of {shortest * 1e3:.4g} to {size * 1e3:.4g} mm, flat beyond "
        f"{flat * 1e3:.4g} mm, {relief}, seed {seed}"
    )
    return Texture(heights, size / points, size / points, True, size / most, source)


def _phases(most: int, seed: int) -> Array:
    """Phases (2 most + 1, most + 1), rad, shell by shell, so that shorter waves change no longer one."""
    phase = np.zeros((2 * most + 1, most + 1))
    for shell in range(1, most + 1):
        drawn = 2 * np.pi * np.random.default_rng([seed, shell]).random(4 * shell + 1)
        # Waves with `shell` along x, of either sign across; then those with ± `shell` across.
        phase[np.arange(-shell, shell + 1), shell] = drawn[: 2 * shell + 1]
        phase[shell, 1:shell] = drawn[2 * shell + 1 : 3 * shell]
        phase[-shell, 1:shell] = drawn[3 * shell : 4 * shell - 1]
        phase[shell, 0] = drawn[4 * shell]
        phase[-shell, 0] = -drawn[4 * shell]
    return phase
