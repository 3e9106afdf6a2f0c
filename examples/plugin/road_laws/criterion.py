"""A fatigue law that a test track gave."""

from dataclasses import dataclass
from typing import ClassVar

from treadload.damage import FatigueLine, PowerLaw
from treadload.units import Number, Strain


@dataclass(frozen=True)
class TestTrack(PowerLaw):
    """Passes until the first crack on a track.

    epsilon_6: strain of a million passes. power: of the strain, > 0. shift: factor on the passes from track to road.
    """

    epsilon_6: Strain
    power: Number
    shift: Number = 1.0

    # The quantity that the law is a law of: the largest tensile strain.
    reads = FatigueLine.reads
    source: ClassVar[str] = "our test track, 2025"
    caveat: ClassVar[str] = "one mix, one temperature"
    end_of_life: ClassVar[str] = "the first crack"

    @property
    def at_a_million(self) -> float:
        """Strain of a million passes on the road."""
        return self.epsilon_6 * self.shift ** (1 / self.power)

    @property
    def exponent(self) -> float:
        """Slope of strain over passes."""
        return -1 / self.power

    def __str__(self) -> str:
        return f"test track, power {self.power:g}"
