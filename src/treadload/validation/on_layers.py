"""Checks of contact on layers: rigid punches, near-equal layers, and the response under the computed pressure."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

import numpy as np

from treadload.contact import Contact, Rolling, solve_contact
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.bodies.layers import layered_road
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.kernels.arrays import Array
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.kernels.layers.layered import Stack
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.pavement.stack import stack_of
from treadload.response import solve_response
from treadload.tire import Tire
from treadload.validation.check import Check, absolute, relative
from treadload.validation.patches import centres
from treadload.validation.punches import plate_stiffness, sphere_on_layers

_SOIL = Elastic(120e6, 0.35)
_ROADS = {
    "asphalt on soil": Pavement([Layer(Elastic(7e9, 0.35), 0.06), Layer(Elastic(9e9, 0.35), 0.15), Layer(_SOIL)]),
    "soil on rock": Pavement([Layer(Elastic(1e8, 0.3), 0.1)], rigid_base=True),
    "inverted": Pavement(
        [
            Layer(Elastic(5e9, 0.35), 0.08),
            Layer(Elastic(3e8, 0.35), 0.12),
            Layer(Elastic(15e9, 0.25), 0.2),
            Layer(Elastic(8e7, 0.35)),
        ]
    ),
}
_SOURCE = "Lebedev & Ufliand (1958), J. Appl. Math. Mech. 22, 442-450"
_LOAD = 1e4


def layered_contact_checks() -> Iterator[Check]:
    """Flat and round punches, the half-space as a limit, displacements against the waves of the response."""
    group = "rigid punch on layers"
    for name in ("asphalt on soil", "soil on rock"):
        stack = stack_of(_ROADS[name])
        sunk, same = _plate(stack, 0.15, 48)
        what = f"{name}, plate of 0.3 m: load over settlement, MN/m"
        # The rim is a staircase of cells.
        yield relative(group, what, _LOAD / sunk / 1e6, plate_stiffness(stack, same) / 1e6, 2e-4, _SOURCE)
    for name, radius, curvature in (("inverted", 0.1, 5.0), ("soil on rock", 0.05, 0.5)):
        stack = stack_of(_ROADS[name])
        load, approach = sphere_on_layers(stack, radius, curvature)
        x = centres(72, 2 * radius / 64)
        gap = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * curvature)
        pressed = _rigid(stack, gap, 2 * radius / 64, load)
        what = f"{name}, sphere of {curvature:g} m: approach, mm"
        yield relative(group, what, pressed.approach * 1e3, approach * 1e3, 1e-3, _SOURCE)
    yield from _near_equal()
    yield from _responses()


def _influence(stack: Stack, shape: tuple[int, ...], dx: float) -> Influence:
    return Influence((shape[0], shape[1]), dx, dx, layered_road(stack))


def _top(stack: Stack) -> CombinedElasticity:
    """A rigid body on the top layer as a half-space."""
    return CombinedElasticity.of(math.inf, 0.0, float(stack.shear[0]), stack.poisson[0])


def _rigid(stack: Stack, gap: Array, dx: float, load: float) -> NormalSolution:
    return solve_normal(_influence(stack, gap.shape, dx), gap, load=load, tolerance=1e-8)


def _plate(stack: Stack, radius: float, cells: int) -> tuple[float, float]:
    """Settlement, m, of a disc of square cells, and the radius, m, that it has by its settlement on a half-space."""
    dx = 2 * radius / cells
    x = centres(cells, dx)
    gap = np.where(x[None, :] ** 2 + x[:, None] ** 2 <= radius**2, 0.0, np.nan)
    layered = _influence(stack, gap.shape, dx)
    plain = Influence(layered.shape, dx, dx, HalfSpaces(_top(stack)))
    on_top = solve_normal(plain, gap, load=_LOAD, tolerance=1e-9).approach
    same = _LOAD * (1 - stack.poisson[0]) / float(stack.shear[0]) / (4 * on_top)
    return solve_normal(layered, gap, load=_LOAD, tolerance=1e-9).approach, same


def _sphere(road: Pavement, tire: Elastic, compliance: Literal["half_space", "layers"]) -> Contact:
    """Sphere of 0.3 m that drives: 4 kN, 1 kN along travel, μ = 0.6."""
    x = centres(40, 3e-3)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) / (2 * 0.3)
    wheel = Rolling(normal_load=4e3, friction=0.6, tractive_force=1e3)
    body = Tire.from_height_map(gap, 3e-3, material=tire)
    return solve_contact(body, road, wheel, tolerance=1e-10, road_compliance=compliance)


def _near_equal() -> Iterator[Check]:
    """Three layers that differ by 1e-13, solved as layers."""
    asphalt, nearly_equal = Elastic(5.4e9, 0.35), Elastic(5.4e9 * (1 + 1e-13), 0.35)
    near = Pavement([Layer(asphalt, 0.06), Layer(nearly_equal, 0.15), Layer(asphalt)])
    steel = Elastic(210e9, 0.3)
    layered = _sphere(near, steel, "layers").dataset
    plain = _sphere(Pavement.half_space(asphalt), steel, "half_space").dataset
    for name in ("pressure", "traction_x", "displacement_z"):
        values, exact = layered[name].to_numpy(), plain[name].to_numpy()
        worst = float(np.abs(values - exact).max() / np.abs(exact).max())
        what = f"{name}, error over the largest value"
        yield absolute("contact on three near-equal layers", what, worst, 0, 1e-8, "contact on the half-space")


def _responses() -> Iterator[Check]:
    """The displacement that the contact gives is that of the layered response to its pressure and shear."""
    for name, road in _ROADS.items():
        contact = _sphere(road, Elastic(50e6, 0.45), "layers")
        response = solve_response(contact, road, depths=[0.0]).dataset
        worst = 0.0
        for axis in "xyz":
            ours = contact.dataset[f"displacement_{axis}"].to_numpy()
            theirs = response[f"displacement_{axis}"].to_numpy()[0]
            worst = max(worst, float(np.abs(ours - theirs).max() / np.abs(theirs).max()))
        what = f"{name}: displacement of the surface, error over the largest value"
        yield absolute("rubber wheel on layers", what, worst, 0, 1e-5, "response of the layers, by wavenumbers")
