"""Checks of printed designs: the worked examples of IRC:37-2018, which `examples/published` has as case files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from treadload.damage import Criterion, IrcCementTreated, IrcFatigue, IrcRutting, granular_modulus, subgrade_modulus
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import UniformDisc, dual_wheels, solve_response
from treadload.validation.check import Check, absolute, relative

_SOURCE = "IRC:37-2018, annexes II and III, by IITPAVE"
_TEN = subgrade_modulus(10.0)
_SOFT = (None, 62e6, 0.35)
_SUBGRADE = (None, _TEN, 0.35)
_ASPHALT, _CEMENTED = 3000e6, 5000e6
# Tires of 20 kN, their pressure, Pa, and their distance, m.
_LOAD, _USUAL, _OF_CEMENTED, _APART = 20e3, 0.56e6, 0.80e6, 0.31
Layers = tuple[tuple[float | None, float, float], ...]
_STRUCTURES: dict[str, Layers] = {
    "II.2": ((0.150, 95e6, 0.35), (None, 50e6, 0.35)),
    "II.3": ((0.190, _ASPHALT, 0.35), (0.480, 200e6, 0.35), _SOFT),
    "II.5": ((0.100, _ASPHALT, 0.35), (0.180, 800e6, 0.35), (0.250, 600e6, 0.25), _SOFT),
    "III.1": ((0.145, _ASPHALT, 0.35), (0.450, granular_modulus(0.45, _TEN), 0.35), _SUBGRADE),
    "III.2": (
        (0.100, _ASPHALT, 0.35), (0.100, 450e6, 0.35), (0.100, _CEMENTED, 0.25), (0.200, 600e6, 0.25), _SUBGRADE
    ),
    "III.3": ((0.100, _ASPHALT, 0.35), (0.130, _CEMENTED, 0.25), (0.200, 600e6, 0.25), _SUBGRADE),
    "III.5": (
        (0.100, _ASPHALT, 0.35), (0.100, 450e6, 0.35), (0.160, _CEMENTED, 0.25),
        (0.200, granular_modulus(0.20, _TEN), 0.35), _SUBGRADE,
    ),
    "III.6": ((0.110, _ASPHALT, 0.35), (0.150, 350e6, 0.35), (0.200, 600e6, 0.25), _SUBGRADE),
}  # fmt: skip


@dataclass(frozen=True)
class Printed:
    """A printed strain of a worked example.

    example: its number. kind: of the strain. depth: m, of the interface that it is read at. strain: printed,
    microstrain. pressure: of the tires, Pa.
    """

    example: str
    kind: Literal["tensile", "vertical"]
    depth: float
    strain: float
    pressure: float = _USUAL

    @property
    def road(self) -> Pavement:
        """The structure of the example, all layers bonded."""
        layers = [Layer(Elastic(modulus, nu), thick) for thick, modulus, nu in _STRUCTURES[self.example]]
        return Pavement(layers)

    def solve(self) -> float:
        """The strain that comes out here, microstrain: the larger of below a tire and between both."""
        road = self.road
        layer = int(np.flatnonzero(np.isclose(road.interfaces, self.depth))[0])
        criterion = (
            Criterion("base", IrcFatigue(_ASPHALT, 0.035, 0.115), layer)
            if self.kind == "tensile"
            else Criterion("subgrade", IrcRutting(), layer + 1, "top")
        )
        radius = math.sqrt(_LOAD / (math.pi * self.pressure))
        wheels = dual_wheels(UniformDisc(radius, self.pressure), _APART)
        solved = solve_response(
            wheels, road, depths=[self.depth], x=[0.0], y=[-0.5 * _APART, 0.0], side=criterion.side
        )
        return 1e6 * float(criterion.read(solved.dataset.isel(depth=0)).max())


PRINTED = (
    Printed("II.2", "vertical", 0.150, 4324),
    Printed("II.3", "tensile", 0.190, 146),
    Printed("II.3", "vertical", 0.670, 243),
    Printed("II.5", "tensile", 0.100, 104.2),
    Printed("III.1", "tensile", 0.145, 175),
    Printed("III.1", "vertical", 0.595, 278),
    Printed("III.2", "tensile", 0.100, 132),
    Printed("III.2", "vertical", 0.500, 252),
    Printed("III.2", "tensile", 0.300, 59.2, _OF_CEMENTED),
    Printed("III.3", "vertical", 0.430, 251),
    Printed("III.5", "tensile", 0.100, 128),
    Printed("III.6", "tensile", 0.110, 173),
)


def published_checks() -> Iterator[Check]:
    """Twelve printed strains, and the passes of example III.1 by the laws of the guideline."""
    group = "IRC:37-2018"
    for row in PRINTED:
        where = f"example {row.example}: {row.kind} strain at {1e3 * row.depth:g} mm, microstrain"
        # Printed to three digits, of which IITPAVE's own quadrature takes part.
        yield relative(group, where, row.solve(), row.strain, 0.007, _SOURCE)
    # The print cuts to whole millions.
    million = IrcFatigue(_ASPHALT, 0.035, 0.115).allowable_passes(175e-6) / 1e6
    yield absolute(group, "III.1: passes to fatigue at 175 microstrain, millions", million, 53.5, 0.5, _SOURCE)
    million = IrcRutting().allowable_passes(278e-6) / 1e6
    yield absolute(group, "III.1: passes to rutting at 278 microstrain, millions", million, 187, 1, _SOURCE)
    base = IrcCementTreated(1.4e6).allowable_passes(0.7e6)
    yield relative(
        group, "cement-treated base at half of its strength: passes", base, 10 ** (0.472 / 0.0825), 1e-11,
        "own regression after IRC:37-2018, kept to detect changes",
    )  # fmt: skip
