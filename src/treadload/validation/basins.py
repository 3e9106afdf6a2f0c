"""Checks of backcalculated moduli: a closed form, and basins of the solver of single roads."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from treadload.kernels.arrays import Array
from treadload.materials import Elastic, KTheta, Prony, StressDependent, Universal
from treadload.pavement import Layer, Pavement
from treadload.response import UniformDisc, solve_response
from treadload.roads import Basins, DualWheels, MovingBasins, backcalculate
from treadload.validation.check import Check, relative

_OFFSETS = np.array([0.0, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2, 1.5, 1.8])
_LOAD, _RADIUS = 50e3, 0.15
# Moduli, Pa, Poisson's ratios and thicknesses, m, to the stiff layer.
_ROADS = {
    "asphalt, base, soil": ((4e9, 3e8, 7e7), (0.35, 0.35, 0.4), (0.15, 0.3, 9.55)),
    "thin asphalt on a treated base": ((8e9, 1.2e10, 1e8), (0.35, 0.25, 0.4), (0.06, 0.2, 9.74)),
}


def basin_checks() -> Iterator[Check]:
    """Moduli of a half-space under both plates by Boussinesq; of layers whose basins another quadrature made."""
    group = "Backcalculated moduli"
    modulus, poisson = 1e8, 0.4
    bare = Pavement.half_space(Elastic(1e9, poisson), name="soil")
    beside = np.arcsin(_RADIUS / np.maximum(_OFFSETS, _RADIUS))
    rigid = _LOAD * (1 - poisson**2) / (math.pi * _RADIUS * modulus) * beside
    result = backcalculate(Basins(rigid[None], _OFFSETS, _load(), _RADIUS, plate="rigid"), bare, stiff_layer=None)
    fitted = float(result.dataset["fitted_modulus"][0, 0])
    yield relative(group, "half-space, rigid plate: E, Pa", fitted, modulus, 1e-9, "Boussinesq (1885)")
    for name, (moduli, ratios, thickness) in _ROADS.items():
        layers = [
            Layer(Elastic(e, v), h, name=f"layer {k + 1}")
            for k, (e, v, h) in enumerate(zip(moduli, ratios, thickness, strict=True))
        ]
        road = Pavement(layers, rigid_base=True)
        disc = UniformDisc(_RADIUS, _LOAD / (math.pi * _RADIUS**2))
        response = solve_response([disc], road, depths=[0.0], x=_OFFSETS, y=[0.0])
        down = response.dataset["displacement_z"].to_numpy().reshape(1, -1)
        result = backcalculate(Basins(down, _OFFSETS, _load(), _RADIUS), road)
        for k, wanted in enumerate(moduli):
            fitted = float(result.dataset["fitted_modulus"][0, k])
            # Deflections of both quadratures agree to 1e-8; thin stiff layers feel that a hundred times.
            yield relative(group, f"{name}: E of layer {k + 1}, Pa", fitted, wanted, 1e-5, "our layered solver")
    yield from _law_checks(group)
    yield from _moving_checks(group)


def _law_checks(group: str) -> Iterator[Check]:
    """Factors on the laws of two layers from the bowls of three loads, whose moduli `settle` finds to 0.1 %."""
    base = StressDependent(KTheta(200e6, 0.5), sublayer=0.1)
    soil = StressDependent(Universal(560, 0.3, -1.0), 0.4, 0.8, sublayer=1.5)
    asphalt = Layer(Elastic(4e9, 0.35), 0.1, name="asphalt")
    road = Pavement([asphalt, Layer(base, 0.3, name="base"), Layer(soil, 9.6, name="soil")], rigid_base=True)
    loads, rows = np.array([30e3, 60e3, 100e3]), []
    for load in loads:
        disc = UniformDisc(_RADIUS, load / (math.pi * _RADIUS**2))
        response = solve_response([disc], road, depths=[0.0], x=_OFFSETS, y=[0.0])
        rows.append(response.dataset["displacement_z"].to_numpy().ravel())
    # The laws that the search takes are half and twice as stiff.
    laws = [replace(road.layers[1], material=replace(base, factor=0.5))]
    laws.append(replace(road.layers[2], material=replace(soil, factor=2.0)))
    drops = Basins(np.array(rows), _OFFSETS, loads, _RADIUS, station=("1",) * len(loads))
    result = backcalculate(drops, Pavement([asphalt, *laws], rigid_base=True))
    for k, name in ((1, "base"), (2, "soil")):
        fitted = float(result.dataset["law_factor"][0, k])
        yield relative(group, f"three loads: factor on the law of the {name}", fitted, 1.0, 5e-3, "our `settle`")


def _moving_checks(group: str) -> Iterator[Check]:
    """Slopes that differences of the deflection under moving loads give, and the moduli that they lead back to."""
    asphalt = Prony(1e10, ((0.5, 0.01), (0.4, 0.1)), 0.35)
    layers = [Layer(asphalt, 0.15, name="asphalt"), Layer(Elastic(3e8, 0.35), 0.3, name="base")]
    wheels, speed, step = DualWheels(0.34, 0.24, 0.22), 20.0, 1e-3
    offsets = np.array([0.1, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2, 1.5])
    road = Pavement([*layers, Layer(Elastic(7e7, 0.4), 9.55, name="soil")], rigid_base=True)
    x = np.sort(np.concatenate([offsets + k * step for k in (-2, -1, 1, 2)]))
    response = solve_response(list(wheels.loads), road, depths=[0.0], x=x, y=[0.0], speed=speed)
    down = response.dataset["displacement_z"].to_numpy().ravel()
    u = [down[np.searchsorted(x, offsets + k * step - 0.1 * step)] for k in (-2, -1, 1, 2)]
    slope = -_LOAD * (8 * (u[2] - u[1]) - (u[3] - u[0])) / (12 * step)
    result = backcalculate(MovingBasins(slope[None], offsets, _load(), np.array([speed]), wheels), road)
    wanted = (float(np.abs(asphalt.complex_modulus(20 * math.pi))), 3e8, 7e7)
    for k, name in enumerate(("asphalt, |E*| at 10 Hz", "base", "soil")):
        fitted = float(result.dataset["fitted_modulus"][0, k])
        # Slopes agree to 1e-5; moduli feel that some times.
        yield relative(group, f"moving basin: {name}, Pa", fitted, wanted[k], 2e-4, "our solver of moving loads")


def _load() -> Array:
    return np.array([_LOAD])
