"""How compliant a tread is to the waves of a texture: a half-space of rubber, or a layer of it on a stiff belt."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials import Elastic, Prony

# cosh of more overflows nothing and has long become the half-space.
_DEEP = 30.0


@dataclass(frozen=True)
class TreadRubber:
    """Rubber as a texture meets it. modulus: Young's, Pa. poisson. thickness: m, on a rigid belt; None: deep.

    frequency: Hz, at which the modulus was read; None of an elastic one.
    """

    modulus: float
    poisson: float
    thickness: float | None = None
    frequency: float | None = None

    @classmethod
    def of(cls, rubber: Elastic | Prony, thickness: float | None, speed: float | None, wave: float) -> TreadRubber:
        """The rubber as it meets waves of a length, m, at a speed, m/s: |E*| at speed over wave.

        Raises InputError for a viscoelastic rubber without speed and for other materials.
        """
        if thickness is not None:
            positive("thickness of the tread", thickness, "metres", "15 mm is 0.015")
        if isinstance(rubber, Elastic):
            return cls(rubber.modulus, rubber.poisson, thickness)
        if not isinstance(rubber, Prony):
            raise InputError(
                f"rubber must be an Elastic or a Prony, got {type(rubber).__name__}: texture needs the rubber's own "
                "modulus, not what stands for the whole tire, e.g. Elastic(6e6, 0.5)"
            )
        if speed is None:
            raise InputError("viscoelastic rubber needs speed in m/s: its modulus is that at speed over wavelength")
        positive("speed", speed, "m/s", "80 km/h is 22.2")
        frequency = speed / wave
        return cls(
            float(np.abs(rubber.complex_modulus(2 * math.pi * frequency))), rubber.poisson, thickness, frequency
        )

    @property
    def plane_modulus(self) -> float:
        """E* = E/(1 - ν²), Pa."""
        return self.modulus / (1 - self.poisson**2)

    def compliance(self, k: Array) -> Array:
        """Displacement by a pressure wave of |k|, 1/m, over its amplitude, m/Pa; 0 at k = 0, which no texture
        contains.

        2/(E* k), and of a layer bonded to a rigid base less by a function of k times thickness (Johnson 1985, 5.8).
        """
        k = np.asarray(k, dtype=float)
        with np.errstate(divide="ignore"):
            deep = np.where(k > 0, 2 / (self.plane_modulus * np.where(k > 0, k, 1.0)), 0.0)
        if self.thickness is None:
            return deep
        q = np.minimum(k * self.thickness, _DEEP)
        a = 3 - 4 * self.poisson
        shape = (a * np.sinh(2 * q) - 2 * q) / (a * np.cosh(2 * q) + 0.5 * (a * a + 1) + 2 * q * q)
        return np.asarray(deep * shape)

    def __str__(self) -> str:
        text = f"rubber of {self.modulus / 1e6:.3g} MPa, ν = {self.poisson:g}"
        if self.frequency is not None:
            text += f" at {self.frequency:.3g} Hz"
        return text if self.thickness is None else f"{text}, {self.thickness * 1e3:.3g} mm on a stiff belt"


def wave_that_matters(texture_wave: float, frequency_wave: float | None) -> float:
    """Length, m, by which a speed becomes a frequency. Raises InputError."""
    wave = texture_wave if frequency_wave is None else frequency_wave
    positive("the wave by which speed becomes a frequency", wave, "m", "give wave in m")
    return wave
