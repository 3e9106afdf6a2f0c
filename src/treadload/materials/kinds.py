"""What a material must provide: the kinds that layers and tires can be made of."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

# Those of Python 3.11 would ask a fluid for its rubbery modulus to find out what it is.
from typing_extensions import Protocol, runtime_checkable

from treadload.kernels.arrays import ComplexArray
from treadload.materials.anisotropic import Anisotropic, TransverselyIsotropic
from treadload.materials.elastic import Elastic
from treadload.materials.plastic import ElastoPlastic
from treadload.materials.stress_dependent import StressDependent
from treadload.registry import MATERIALS


@runtime_checkable
class Viscoelastic(Protocol):
    """A linear viscoelastic solid whose Poisson's ratio does not depend on time.

    >>> rubber = tl.materials.Prony(3e6, ((0.5, 0.1),), 0.49)
    >>> isinstance(rubber, tl.materials.Viscoelastic), round(rubber.rubbery.modulus / rubber.glassy.modulus, 2)
    (True, 0.5)
    """

    @property
    def poisson(self) -> float:
        """Poisson's ratio."""

    @property
    def glassy(self) -> Elastic:
        """The elastic limit of fast loading."""

    @property
    def rubbery(self) -> Elastic:
        """The elastic limit of slow loading; InputError for a fluid, which has none."""

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """E*(ω) = E' + iE'', Pa, at angular frequencies ω > 0, rad/s, for motion as exp(iωt); shape of `omega`."""


@runtime_checkable
class Surfaced(Protocol):
    """A material of a tire that makes the surface of its body itself: another kind of body than a half-space."""

    def surface(self, *, is_tire: bool, speed: float | None) -> object:
        """A `treadload.contact.bodies.Body` on the tire's side or the road's, rolling at a speed, m/s."""


@runtime_checkable
class TemperatureDependent(Protocol):
    """A material that is elastic or viscoelastic once its temperature is known.

    >>> mix = tl.catalogue.mixes["EB-GB3"]
    >>> isinstance(mix, tl.materials.TemperatureDependent)
    True
    >>> [round(mix.at(t).modulus / 1e6) for t in (0, 15, 30)]  # MPa
    [18300, 9000, 2700]
    """

    def at(self, temperature: float, *, extrapolate: bool = False) -> Elastic | Viscoelastic:
        """The material at a temperature, °C. Raises InputError outside its data unless asked to extrapolate."""


AnyElastic = Elastic | Anisotropic
"""What deforms at once and comes back, the same in all directions or not."""
Solid = Elastic | TransverselyIsotropic
"""What elastic layers of a road can be: the same in all horizontal directions."""
Material = Elastic | Viscoelastic | Anisotropic
"""What can be solved with."""
MATERIALS.makes(Elastic, Viscoelastic, Anisotropic, TemperatureDependent, ElastoPlastic, StressDependent)


def limit_of(material: Material, which: Literal["glassy", "rubbery"]) -> AnyElastic:
    """The elastic limit of fast ("glassy") or slow ("rubbery") loading; an elastic material is its own."""
    if isinstance(material, AnyElastic):
        return material
    return material.glassy if which == "glassy" else material.rubbery


def upright(material: AnyElastic) -> tuple[float, float]:
    """Young's modulus, Pa, and Poisson's ratio; of an anisotropic material those under vertical stress."""
    return material.upright if isinstance(material, Anisotropic) else (material.modulus, material.poisson)


def elastic_part(
    material: Material | TemperatureDependent | ElastoPlastic | StressDependent,
) -> Material | TemperatureDependent | StressDependent:
    """The elastic part of an elastoplastic material; any other material itself."""
    return material.elastic if isinstance(material, ElastoPlastic) else material
