"""A layer of a road: what it is made of, how thick it is, and how it is bonded to what lies below."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.materials import (
    Anisotropic,
    Elastic,
    ElastoPlastic,
    Material,
    Solid,
    StressDependent,
    TemperatureDependent,
)
from treadload.materials.kinds import AnyElastic, elastic_part
from treadload.pavement.bonds import BONDED, BondLaw

_KINDS = (
    "Elastic, ElastoPlastic, StressDependent, anisotropic, viscoelastic such as Prony, or one that depends on "
    "temperature"
)


@dataclass(frozen=True)
class Layer:
    """One layer of a road.

    material: what it is made of: elastic, anisotropic, viscoelastic, elastoplastic, or known once its temperature or
    its stress is.
    thickness: m; None for the last layer, which is semi-infinite. name: free text. bond: to the layer below, BONDED,
    FRICTIONLESS or Bond(stiffness=...).

    >>> tl.Layer(tl.Elastic(5e9, 0.35), 0.15, name="asphalt").thickness
    0.15
    """

    material: Material | TemperatureDependent | ElastoPlastic | StressDependent
    thickness: float | None = None
    name: str = ""
    bond: BondLaw = BONDED

    def __post_init__(self) -> None:
        # The protocols themselves would evaluate limits that a fluid has not.
        if not (
            isinstance(self.material, AnyElastic | ElastoPlastic | StressDependent | TemperatureDependent)
            or hasattr(self.material, "complex_modulus")
        ):
            raise InputError(
                f"layer {self.name!r}: material must be {_KINDS}, got {type(self.material).__name__} "
                f"{self.material!r}"
            )
        if self.thickness is not None:
            thickness = self.thickness if isinstance(self.thickness, Real) else str(self.thickness)
            positive(f"layer {self.name!r}: thickness", thickness, "metres", "leave it out for the last layer")
        if not isinstance(self.bond, BondLaw):
            raise InputError(
                f"layer {self.name!r}: bond must be BONDED, HALF_BONDED, FRICTIONLESS or Bond(stiffness=...), "
                f"got {self.bond!r}"
            )

    @property
    def elastic(self) -> Solid:
        """The material, where it is elastic and the same in all horizontal directions.

        Raises InputError for another anisotropic one and for one that needs a speed or a temperature.
        """
        material = self.resolved
        if isinstance(material, Anisotropic) and not isinstance(material, Solid):
            raise InputError(
                f"layer {self.name!r} is {material}, and layers must be the same in all horizontal directions; take "
                "the road as a half-space of it, or a TransverselyIsotropic or an Elastic"
            )
        if not isinstance(material, Solid):
            raise InputError(
                f"layer {self.name!r} is viscoelastic ({material}): give the speed of the load (m/s), or solve with "
                "an elastic limit of the material, .glassy for fast and .rubbery for slow loads"
            )
        return material

    @property
    def resolved(self) -> Material:
        """The material, elastic or viscoelastic; of an elastoplastic one its elastic part.

        Raises InputError for one that needs a temperature or loads.
        """
        if isinstance(self.material, Elastic):
            # Of nearly all layers, often asked for; whether it follows a protocol takes longer.
            return self.material
        if isinstance(self.material, TemperatureDependent):
            raise InputError(
                f"layer {self.name!r} depends on temperature ({self.material}): choose one first with "
                "Pavement.at_temperature(...)"
            )
        if self.depends_on_stress:
            raise InputError(
                f"layer {self.name!r} is {self.material}, and its modulus follows from the loads: solve_response "
                "settles it, or take Pavement.at_nominal_stress for the moduli under a usual truck"
            )
        material = elastic_part(self.material)
        assert not isinstance(material, TemperatureDependent | StressDependent)
        return material

    @property
    def depends_on_temperature(self) -> bool:
        """True if the material or the bond is known only once the temperature is."""
        return isinstance(self.material, TemperatureDependent) or self.bond.depends_on_temperature

    @property
    def depends_on_stress(self) -> bool:
        """True if the modulus is known only once the loads are."""
        return isinstance(self.material, StressDependent)

    __repr__ = as_call
