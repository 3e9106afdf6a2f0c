"""What a surface does under pressure and shear: half-spaces, layers, memory, and whatever else is a `Body`."""

from treadload.contact.bodies.body import Body, Offsets, Sum, Waves
from treadload.contact.bodies.choose import Pair, surface_of
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence

__all__ = ["Body", "HalfSpaces", "Influence", "Offsets", "Pair", "Sum", "Waves", "surface_of"]
