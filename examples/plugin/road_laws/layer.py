"""A layer whose stiffness falls by the same factor with each kelvin."""

from dataclasses import dataclass

from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.units import Celsius, Kelvin, Modulus, Number


@dataclass(frozen=True)
class Softening:
    """Asphalt whose modulus is divided by ten over a rise of temperature.

    modulus: at the reference. decade: rise of temperature that divides it by ten. poisson: Poisson's ratio.
    reference: temperature. coldest, warmest: between which it was measured.
    """

    modulus: Modulus
    decade: Kelvin
    poisson: Number = 0.35
    reference: Celsius = 15.0
    coldest: Celsius = -10.0
    warmest: Celsius = 40.0

    def at(self, temperature: float, *, extrapolate: bool = False) -> Elastic:
        """The layer at a temperature."""
        if not extrapolate and not self.coldest <= temperature <= self.warmest:
            raise InputError(
                f"this asphalt was measured from {self.coldest:g} to {self.warmest:g} °C, got {temperature:g} °C; "
                "widen coldest and warmest if you know better"
            )
        return Elastic(self.modulus * 10 ** ((self.reference - temperature) / self.decade), self.poisson)
