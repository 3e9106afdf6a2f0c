"""Loading frequency: how fast a wheel's load comes and goes at a depth, by the rules of design methods."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from treadload.errors import InputError
from treadload.materials import Aged, Mix, TemperatureDependent
from treadload.materials.kinds import AnyElastic, upright
from treadload.pavement import Layer, Pavement

# At which French moduli are read, at 15 °C or the equivalent temperature: all classes, depths and speeds alike, Hz.
CONVENTION = 10.0
# Moduli and frequencies depend on each other: rounds until no frequency moves by a thousandth.
_ROUNDS, _SETTLED = 30, 1e-3


@dataclass(frozen=True)
class LoadingFrequency:
    """The frequency at which a class of axles reads the moduli of mixes, by its speed and the depth.

    rule: "mepdg", t = L/v with L = 2 (a + z_eff): the length over which a load spread at 45° passes the middle of a
    layer, at Odemark's depth z_eff = Σ h (E/E_soil)^(1/3), a the radius of the wheel's contact as a disc; or "brown",
    log t = 0.5 z - 0.2 - 0.94 log v, z the depth in m, v in km/h, t in s. angular: True for f = 1/(2πt), False
    for f = 1/t; left out, as the source of the rule has it, 1/t by the MEPDG and 1/(2πt) by Brown.
    Raises InputError.
    Sources: NCHRP 1-37A (2004), appendix CC-3, as coded in ProductOneME (commit c89fe2b); Brown (1973), Proc. Instn
    Civ. Engrs 55, as commonly quoted, not checked against the source.
    """

    rule: Literal["mepdg", "brown"] = "mepdg"
    angular: bool | None = None

    def __post_init__(self) -> None:
        if self.rule not in ("mepdg", "brown"):
            raise InputError(f'the rule of a loading frequency must be "mepdg" or "brown", got {self.rule!r}')

    def frequencies(
        self, thicknesses: Sequence[float], moduli: Sequence[float], speed: float, radius: float
    ) -> list[float]:
        """Frequency at the middle of each layer above the soil, Hz.

        thicknesses: of the layers with one, m. moduli: of all layers, Pa, the soil last. speed: m/s. radius: a, m.
        """
        h, e = np.asarray(thicknesses, dtype=float), np.asarray(moduli, dtype=float)
        tops = np.concatenate([[0.0], np.cumsum(h)])[:-1]
        if self.rule == "mepdg":
            deep = h * (e[: len(h)] / e[-1]) ** (1 / 3)
            middle = np.cumsum(deep) - 0.5 * deep
            time = 2 * (radius + middle) / speed
        else:
            time = 10 ** (0.5 * (tops + 0.5 * h) - 0.2 - 0.94 * math.log10(3.6 * speed))
        angular = self.rule == "brown" if self.angular is None else self.angular
        result: list[float] = (1 / (2 * math.pi * time if angular else time)).tolist()
        return result

    def on(
        self, road: Pavement, temperatures: Sequence[float], speed: float, radius: float
    ) -> tuple[Pavement, list[float]]:
        """The road with its mixes at their own frequencies, and these, Hz; of layers above the soil.

        road: whose mixes have no temperature yet. temperatures: °C, one for each layer. speed, radius: as above.
        Found by iteration, since moduli and frequencies depend on each other. Raises InputError for a mix known at
        one frequency only.
        """
        thicknesses = [layer.thickness for layer in road.layers if layer.thickness is not None]
        frequencies = [CONVENTION] * len(thicknesses)
        for _ in range(_ROUNDS):
            warm = _read_at(road, frequencies).at_temperature(temperatures, extrapolate=True)
            materials = [layer.resolved for layer in warm.layers]
            if not all(isinstance(material, AnyElastic) for material in materials):
                raise InputError("loading frequencies are for elastic mixes: a viscoelastic layer knows the speed")
            moduli = [upright(material)[0] for material in materials if isinstance(material, AnyElastic)]
            updated = self.frequencies(thicknesses, moduli, speed, radius)
            settled = max(abs(math.log(a / b)) for a, b in zip(updated, frequencies, strict=True)) < _SETTLED
            frequencies = updated
            if settled:
                break
        return _read_at(road, frequencies), frequencies

    def __str__(self) -> str:
        angular = self.rule == "brown" if self.angular is None else self.angular
        name = {"mepdg": "MEPDG, t = 2 (a + z_eff)/v", "brown": "Brown, log t = 0.5 z - 0.2 - 0.94 log v"}[self.rule]
        return f"{name}, f = {'1/(2πt)' if angular else '1/t'}"


def contact_radius(wheel_load: float, inflation_pressure: float) -> float:
    """Radius of the disc under the inflation pressure that carries the wheel, m."""
    return math.sqrt(wheel_load / (math.pi * inflation_pressure))


def _read_at(road: Pavement, frequencies: Sequence[float]) -> Pavement:
    pairs = zip(road.layers, [*frequencies, CONVENTION], strict=False)
    return Pavement([_layer_at(layer, f) for layer, f in pairs], rigid_base=road.rigid_base)


def _layer_at(layer: Layer, frequency: float) -> Layer:
    return replace(layer, material=_material_at(layer.material, frequency))


def _material_at(material: object, frequency: float) -> TemperatureDependent:
    if isinstance(material, Mix):
        return material.with_frequency(frequency)
    if isinstance(material, Aged):
        return replace(material, material=_material_at(material.material, frequency))
    return material  # type: ignore[return-value]
