"""Fatigue laws of a layer of a road: which of their numbers come from the layer where they are not given.

A law of `treadload.registry.CRITERIA` is a class whose arguments are its numbers, and `law_of_layer` looks for those
that are missing; or a function with a parameter of type OnLayer, which looks itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypedDict, TypeVar, Unpack, get_args

from treadload.damage.laws.conditions import CATALOGUE
from treadload.damage.laws.fatigue import FatigueLaw, FatigueLine
from treadload.damage.laws.french import RISK, FrenchBituminous, FrenchHydraulic, FrenchSubgrade, TrafficClass
from treadload.errors import InputError
from treadload.materials import Elastic, HydraulicMix, Material, Mix, TemperatureDependent, Unbound
from treadload.materials.kinds import elastic_part
from treadload.materials.stress_dependent import StressDependent
from treadload.pavement import Pavement, bituminous_thickness
from treadload.registry import CRITERIA
from treadload.units import Length, Modulus, Number, Share, Strain

Argument = TypeVar("Argument")
Law = FatigueLaw | Callable[[float], FatigueLaw]


@dataclass(frozen=True)
class OnLayer:
    """A layer that a law applies to. name: of the criterion. road. number: of the layer, 0 at the surface.

    >>> base = tl.damage.OnLayer("base", tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3"), 1)
    >>> f"{base.asphalt() * 1e3:.0f} mm of asphalt on a platform of {base.platform_modulus / 1e6:.0f} MPa"
    '210 mm of asphalt on a platform of 120 MPa'
    """

    name: str
    road: Pavement
    number: int

    @property
    def material(self) -> Material | TemperatureDependent | StressDependent:
        """What the layer is made of."""
        return elastic_part(self.road.layers[self.number].material)

    @property
    def platform_modulus(self) -> float | None:
        """Modulus of the unbound layer of the catalogue below, Pa, if there is one."""
        below = self.road.layers[self.number + 1].material if self.number + 1 < len(self.road.layers) else None
        return below.modulus if isinstance(below, Unbound) else None

    def asphalt(self) -> float:
        """Thickness of all asphalt around the layer, m. Raises InputError where it is not known."""
        try:
            return bituminous_thickness(self.road, self.number)
        except InputError as error:
            raise InputError(f"{self.name!r}: {error}") from error

    def needed(self, values: Mapping[str, object], *names: str) -> None:
        """Refuse what neither the caller nor the layer gives, all of it at once. Raises InputError."""
        missing = [name for name in names if values.get(name) is None]
        if not missing:
            return
        *first, last = missing
        listed = f"{', '.join(first)} and {last} are" if first else f"{last} is"
        classes = ", ".join(get_args(TrafficClass))
        hints = {
            "risk": f'risk follows from the class of traffic too: traffic_class = "T1", one of {classes}',
            "air_voids": "shares of volume, usually air_voids = 0.03 to 0.08 and binder_volume = 0.09 to 0.13",
        }
        hint = "".join(f"; {text}" for name, text in hints.items() if name in missing)
        raise InputError(
            f"{self.name!r}: {listed} missing, and the layer does not provide {'them' if first else 'it'}"
            f"; give {'them' if first else 'it'} in the criterion{hint}"
        )

    def risk(
        self, base: Literal["bituminous", "hydraulic"], risk: float | None, traffic_class: TrafficClass | None
    ) -> float | None:
        """The risk, or the one that the French method accepts for a class of traffic, see `RISK`; None for neither.

        Raises InputError for both.
        """
        if traffic_class is None:
            return risk
        accepted = RISK[base][traffic_class]
        if risk is not None:
            raise InputError(
                f"{self.name!r}: risk and traffic_class exclude each other; {traffic_class} is a risk of "
                f"{100 * accepted:g} % for a {base} base: remove one of the two keys"
            )
        return accepted

    def with_layer_values(self, values: Mapping[str, Argument | None], *names: str) -> dict[str, Argument | None]:
        """Values of the table; where it leaves one of these names out, that of the layer's material."""
        defaults = {name: getattr(self.material, name, None) for name in names}
        return {**defaults, **{name: value for name, value in values.items() if value is not None}}


class OfModulus:
    """A law that waits for the modulus of its layer. kind: of law. arguments: other numbers. material: of the layer.

    Called with a temperature, °C, it takes the modulus of the mix as given; `at_modulus` takes another, Pa: that of
    an aged part of the layer, or at the frequency of a class of axles.
    """

    def __init__(self, kind: Callable[..., FatigueLaw], arguments: Mapping[str, object], material: Mix) -> None:
        self._kind, self._arguments, self._material = kind, arguments, material

    def __call__(self, temperature: float) -> FatigueLaw:
        """The law with the modulus of the mix at a temperature, °C."""
        return self.at_modulus(self._material.modulus(temperature))

    def at_modulus(self, modulus: float) -> FatigueLaw:
        """The law with a modulus, Pa."""
        return self._kind(**self._arguments, modulus=modulus)


def law_of_layer(
    kind: Callable[..., FatigueLaw], at: OnLayer, values: Mapping[str, object], needed: tuple[str, ...]
) -> Law:
    """A law of numbers that are given, or that the layer has under the same names. Raises InputError.

    thickness: left out, that of all asphalt. modulus: left out, that of the layer, which makes the law wait for the
    temperature where the modulus does. needed: names of numbers without a default.
    """
    arguments = dict(values)
    rest = [name for name in needed if name != "modulus"]
    if "thickness" in rest and "thickness" not in arguments:
        arguments["thickness"] = at.asphalt()
    arguments = {**at.with_layer_values({}, *(name for name in rest if name not in arguments)), **arguments}
    material = at.material
    if "modulus" in needed and "modulus" not in arguments:
        if isinstance(material, Mix):
            at.needed(arguments, *rest)
            return OfModulus(kind, arguments, material)
        if isinstance(material, Elastic):
            arguments["modulus"] = material.modulus
    at.needed(arguments, *needed)
    law = kind(**arguments)
    if isinstance(law, FatigueLine) and isinstance(material, Mix) and "epsilon_6" not in values:
        return law.under(CATALOGUE)
    return law


class FrenchConstants(TypedDict, total=False):
    """Keys of the French laws of bound layers: b, SN, k_c, Sh and the modulus of what lies below."""

    slope: Number | None
    scatter: Number | None
    calibration: Number | None
    thickness_scatter: Length | None
    platform_modulus: Modulus | None


@CRITERIA.register("french-bituminous")
def _bituminous(
    at: OnLayer,
    risk: Share | None = None,
    epsilon_6: Strain | None = None,
    thickness: Length | None = None,
    traffic_class: TrafficClass | None = None,
    **constants: Unpack[FrenchConstants],
) -> FrenchBituminous | Callable[[float], FrenchBituminous]:
    """Allowable extension at the bottom of bituminous layers by the French method.

    risk: probability of failure over the design life, in (0, 1). traffic_class: in place of a risk, "T5" to "T0",
    "TS" or "TEX", for which the method accepts 30 % to 1 %. epsilon_6: strain of a million cycles at 10 °C and 25 Hz.
    slope: b, near -0.2. scatter: SN, of the logarithm of the fatigue life. calibration: k_c; left out, these four are
    those of the layer's mix. thickness: of all asphalt; left out, that of the bituminous layers around this one,
    added up. thickness_scatter: Sh; left out, by the rule of the method. platform_modulus: of what lies below; left
    out, that of an unbound layer of the catalogue there.
    """
    mix = at.material
    arguments = {
        "risk": at.risk("bituminous", risk, traffic_class), "epsilon_6": epsilon_6, "thickness": thickness,
        **dict.fromkeys(FrenchConstants.__annotations__), **constants,
    }  # fmt: skip
    if isinstance(mix, Mix):
        arguments = {
            **arguments,
            **at.with_layer_values(arguments, "epsilon_6", "slope", "scatter", "calibration"),
        }
    if constants.get("platform_modulus") is None:
        arguments["platform_modulus"] = at.platform_modulus
    if thickness is None:
        # Nothing but Sh depends on it.
        has_scatter = constants.get("thickness_scatter") is not None
        arguments["thickness"] = at.road.layers[at.number].thickness if has_scatter else at.asphalt()
    at.needed(arguments, "risk", "epsilon_6", "slope", "scatter", "thickness", "calibration")
    numbers: dict[str, Any] = arguments
    if not isinstance(mix, Mix):
        return FrenchBituminous(**numbers)
    return lambda temperature: FrenchBituminous(**numbers, modulus_ratio=mix.modulus_ratio(temperature))


@CRITERIA.register("french-hydraulic")
def _hydraulic(
    at: OnLayer,
    risk: Share | None = None,
    sigma_6: Modulus | None = None,
    joints: Number | None = None,
    traffic_class: TrafficClass | None = None,
    **constants: Unpack[FrenchConstants],
) -> FrenchHydraulic:
    """Allowable tension of layers treated with a hydraulic binder by the French method.

    risk: probability of failure over the design life, in (0, 1). traffic_class: in place of a risk, "T5" to "T0",
    "TS" or "TEX", for which the method accepts 25 % to 1 %. sigma_6: stress of a million cycles. slope: b, near
    -1/15. scatter: SN. calibration: k_c. joints: k_d. thickness_scatter: Sh; left out, these are those of the layer's
    mix. platform_modulus: of what lies below; left out, that of an unbound layer of the catalogue there.
    """
    arguments = {
        "risk": at.risk("hydraulic", risk, traffic_class), "sigma_6": sigma_6, "joints": joints,
        **dict.fromkeys(FrenchConstants.__annotations__), **constants,
    }  # fmt: skip
    if isinstance(at.material, HydraulicMix):
        names = ("sigma_6", "slope", "scatter", "calibration", "joints", "thickness_scatter")
        arguments = {**arguments, **at.with_layer_values(arguments, *names)}
    if constants.get("platform_modulus") is None:
        arguments["platform_modulus"] = at.platform_modulus
    at.needed(arguments, "risk", "sigma_6", "slope", "scatter", "calibration")
    numbers: dict[str, Any] = {name: value for name, value in arguments.items() if value is not None}
    return FrenchHydraulic(**numbers)


@CRITERIA.register("french-subgrade")
def _subgrade(
    at: OnLayer,
    constant: Number | None = None,
    slope: Number | None = None,
    traffic: Literal["heavy", "light", "inverted"] | None = None,
) -> FrenchSubgrade:
    """Allowable compression of soil and unbound layers by the French method.

    constant: A, strain of one pass; left out, that of the layer for the traffic. slope: b. traffic: "heavy", which is
    medium too, "light", or "inverted" for the unbound layer of an inverted structure.
    """
    constants = {name: value for name, value in (("constant", constant), ("slope", slope)) if value is not None}
    vehicles = traffic or "heavy"
    if isinstance(at.material, Unbound):
        soil_law = FrenchSubgrade.of(at.material, vehicles)
        return FrenchSubgrade(**{"constant": soil_law.constant, "slope": soil_law.slope, **constants})
    if constant is None and vehicles != "heavy":
        raise InputError(f"{at.name!r}: give constant for the traffic {vehicles!r}, or a layer of the catalogue")
    return FrenchSubgrade(**constants)
