"""The road and its layers."""

from treadload.pavement.structure import BONDED, FRICTIONLESS, Bond, Layer, Pavement

__all__ = ["BONDED", "FRICTIONLESS", "Bond", "Layer", "Pavement"]
