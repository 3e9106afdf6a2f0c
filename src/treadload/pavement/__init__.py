"""The road and its layers."""

from treadload.pavement.structure import Layer, Pavement

__all__ = ["Layer", "Pavement"]
