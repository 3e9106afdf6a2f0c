"""Rubber grips less where it is pressed harder."""

from dataclasses import dataclass

import numpy as np

from treadload.contact.friction import FrictionLaw
from treadload.errors import InputError
from treadload.units import Number, Pressure


@dataclass(frozen=True)
class RubberPower(FrictionLaw):
    """Friction that falls with a power of pressure, μ = coefficient_there (p/pressure)^-power, up to most.

    coefficient_there: μ at the pressure, > 0. pressure: at which it was measured.
    power: 1/3 for spheres that are pressed flat (Schallamach 1952, as commonly quoted).
    most: μ where there is next to no pressure.
    """

    coefficient_there: Number
    pressure: Pressure
    power: Number = 1 / 3
    most: Number = 1.5

    def __post_init__(self) -> None:
        if not self.coefficient_there > 0:
            raise InputError(f"coefficient_there must be > 0, got {self.coefficient_there:g}; a dry road is near 0.7")

    @property
    def largest(self) -> float:
        """No pressure gives more."""
        return self.most

    def coefficient(self, at):
        """μ of each cell."""
        pressed = np.maximum(at.pressure / self.pressure, 1e-12)
        return np.minimum(self.coefficient_there * pressed**-self.power, self.most)

    def __str__(self) -> str:
        return f"{self.coefficient_there:g} at {self.pressure / 1e3:g} kPa, falling with its power {self.power:.2g}"
