"""Checks of ribs with free sides: blocks bonded on both faces, and five ribs that roll."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.ndimage import uniform_filter

from treadload.contact import Contact, Rolling, solve_contact
from treadload.contact.bodies import Influence, Pair
from treadload.contact.solvers.coupling import Surfaces, solve_coupled
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.sections import Section, face_compliance
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.response import solve_response
from treadload.tire import Belt, Tire
from treadload.validation.check import Check, absolute, relative
from treadload.validation.tires import contact_conditions

_SOURCE = "a second program of the same equations, on other elements"
_BLOCKS = ((0.45, 2.163), (0.49, 3.159), (0.495, 3.380), (0.4995, 3.615))
_SLENDERNESS = 2.67
# Load, N, friction, and the shear of the middle, the second and the shoulder rib.
_LOADS_AND_FRICTION = (
    (35e3, 0.3, (0.260, 0.261, 0.239)),
    (20e3, 0.7, (0.283, 0.274, 0.253)),
    (50e3, 0.7, (0.303, 0.301, 0.254)),
)
# Of the surface strain: squares over which it is a mean, and points, m apart.
_SQUARE, _POINT = 10e-3, 1e-3
# Of pins at the shoulder: their width, how far beyond the face forces are counted, cells along travel, m, and grid
# offsets across, whose mirror images are those of the other shoulder.
_PIN, _BEYOND, _ALONG, _OFFSETS = 9.7e-3, 4e-3, 6e-3, (0.0, 0.25, 0.5)
_ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))


def rib_checks() -> Iterator[Check]:
    """Blocks of four Poisson's ratios in plane strain; the profile 315/80R22.5 at 35 kN, rolling freely."""
    for poisson, stiffness in _BLOCKS:
        quantity = f"apparent modulus over E, ν = {poisson:g}"
        yield relative("block bonded on both faces", quantity, bonded_block(poisson), stiffness, 3e-3, _SOURCE)
    tire, road = _tire(), _ROAD
    contact = solve_contact(tire, road, Rolling(normal_load=35e3, friction=0.7))
    group, data = "five ribs, free rolling", contact.dataset
    yield relative(group, "deflection, mm", float(data.approach) * 1e3, 34.6, 0.01, _SOURCE)
    length = float((data.pressure > 0).any("y").sum()) * float(data.attrs["dx"])
    yield absolute(group, "contact length, mm", length * 1e3, 180.0, 6.0, _SOURCE)
    yield absolute(group, "rolling radius over R", 1 / (1 - float(data.creepage_x)), 0.9874, 1e-3, _SOURCE)
    lateral = float(data.lateral_force) / float(data.normal_load)
    yield absolute(group, "lateral force over load", lateral, 0.0, 1e-9, "symmetry")
    yield from _amplitudes(group, contact, (0.29, 0.29, 0.26))
    strain = surface_strain(contact, road)
    quantity = "largest tensile strain in the plane of the surface, mean over 10 x 10 mm, microstrain"
    yield relative(group, quantity, strain * 1e6, 41.0, 0.1, _SOURCE)
    for load, friction, reference in _LOADS_AND_FRICTION:
        wheel = Rolling(normal_load=load, friction=friction)
        name = f"five ribs, {load / 1e3:g} kN, μ {friction:g}"
        yield from _amplitudes(name, solve_contact(tire, road, wheel), reference)
    yield from contact_conditions("five ribs", contact)
    yield from _shoulder_checks()


def _tire() -> Tire:
    belt = Belt(tread=Elastic(5.5e6, 0.495), bending=(80.0, 100.0, 150.0))
    return Tire.from_profile("315/80R22.5", inflation_pressure=820e3, belt=belt, tread="ribs")


def _shoulder_checks() -> Iterator[Check]:
    """The pin at the shoulder on cells of 3 and 1.5 mm, wherever the grid lies."""
    group, source = "five ribs, cells of 3 mm across", "cells of 1.5 mm, mean over four grid offsets"
    coarse, fine = np.array(shoulder_pins(3e-3)), float(np.mean(shoulder_pins(1.5e-3)))
    quantity = "shear of a pin of 9.7 mm at the shoulder over the rib's pressure, mean over four grid offsets"
    yield relative(group, quantity, float(coarse.mean()), fine, 0.01, source)
    worst = float(coarse[np.argmax(np.abs(coarse - fine))])
    # Pressure ends within a row of cells on the rounded shoulder.
    yield relative(group, "the same, worst of the four grid offsets", worst, fine, 0.05, source)


@lru_cache(maxsize=8)
def shoulder_pins(dy: float) -> tuple[float, ...]:
    """Outward shear of a pin at the shoulder over the rib's mean pressure, for four grid offsets across.

    dy: size of the cells across, m. Pins of 9.7 mm at the outer end of the shoulder rib's face; 315/80R22.5, 35 kN,
    820 kPa, μ 0.7, free rolling, cells of 6 mm along. Offsets of 0, a quarter, a half and three quarters of a cell.
    """
    tire, wheel = _tire(), Rolling(normal_load=35e3, friction=0.7)
    pins: list[float] = []
    for offset in _OFFSETS:
        lattice = Grid.on_lattice(0.26, 0.30, _ALONG, dy)
        grid = replace(lattice, y0=lattice.y0 + offset * dy)
        influence = Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire, _ROAD).both, grid.y0)
        solved = solve_coupled(influence, Surfaces(grid, tire.height_map(grid)), wheel, check=lambda pressure: None)
        shear = -solved.slipping.tangential.shear[1]
        (low, inner), (far, high) = tire.ribs[0].faces[0], tire.ribs[-1].faces[0]
        pressure = solved.normal.pressure
        left = -_force(grid, shear, low - _BEYOND, low + _PIN) / _force(
            grid, pressure, low - _BEYOND, inner + _BEYOND
        )
        right = _force(grid, shear, high - _PIN, high + _BEYOND) / _force(
            grid, pressure, far - _BEYOND, high + _BEYOND
        )
        scale = (high - far) / _PIN
        # The grids of no and of half an offset are their own mirror image.
        pins.extend([scale * right] if offset in (0.0, 0.5) else [scale * right, scale * left])
    return tuple(pins)


def _force(grid: Grid, field: Array, low: float, high: float) -> float:
    """Sum over rows of a field (ny, nx) from y = low to high, m, times their width."""
    covered = np.clip(np.minimum(grid.y + grid.dy / 2, high) - np.maximum(grid.y - grid.dy / 2, low), 0, None)
    return float((covered[:, None] * field).sum())


def _amplitudes(group: str, contact: Contact, references: tuple[float, float, float]) -> Iterator[Check]:
    shear = shear_of_ribs(contact)
    for name, number, reference in zip(("middle", "second", "shoulder"), (2, 3, 4), references, strict=True):
        quantity = f"shear of the outer less the inner third, halved, over pressure, {name} rib"
        yield relative(group, quantity, shear[number], reference, 0.07, _SOURCE)


def surface_strain(contact: Contact, road: Pavement) -> float:
    """Largest tensile strain in the plane of the surface, of the strain tensor's mean over squares of 10 mm."""
    data = contact.dataset
    pressed = data.where(data.pressure > 0, drop=True)
    # Off the edges of cells, where the strain is not bounded; the right half of the tread is that of the left.
    x = np.arange(float(pressed.x.min()), float(pressed.x.max()), _POINT) + 0.25 * _POINT
    y = np.arange(-_SQUARE, float(pressed.y.max()) + _SQUARE, _POINT) + 0.25 * _POINT
    fields = solve_response(contact, road, depths=[0.0], x=x, y=y).dataset
    width = round(_SQUARE / _POINT)
    along, across, sheared = (
        uniform_filter(fields[f"strain_{name}"].to_numpy()[0], width)[
            width // 2 : -width // 2, width // 2 : -width // 2
        ]
        for name in ("xx", "yy", "xy")
    )
    return float((0.5 * (along + across) + np.hypot(0.5 * (along - across), sheared)).max())


def bonded_block(poisson: float) -> float:
    """Mean stress over mean strain and E of a block in plane strain, 2.67 times as wide as high, bonded twice."""
    height = 1.0
    width = _SLENDERNESS * height
    table = face_compliance(Section(((0.0, width),), height, (0.0, 0.0)), poisson)
    nodes = table.compliance.shape[1] // 3
    plane = table.compliance[0].reshape(nodes, 3, nodes, 3)[:, 1:, :, 1:].reshape(2 * nodes, 2 * nodes)
    forces = np.linalg.solve(plane, np.tile([0.0, 1.0], nodes))
    return float(forces[1::2].sum()) / width * height


def shear_of_ribs(contact: Contact) -> list[float]:
    """Half of the shear on the road by which the outer third of each rib exceeds the inner, over its pressure."""
    data, dy = contact.dataset, float(contact.dataset.attrs["dy"])
    y, pressure, traction = (data[name].to_numpy() for name in ("y", "pressure", "traction_y"))
    shear = []
    for group in contact.tire.ribs:
        for left, right in group.faces:
            third = (right - left) / 3
            places = np.array([(left, left + third), (right - third, right), (left, right)])
            shares = np.clip(np.minimum(y + dy / 2, places[:, 1:]) - np.maximum(y - dy / 2, places[:, :1]), 0, None)
            inner, outer, _ = shares @ traction.sum(1)
            shear.append(float(1.5 * (outer - inner) / (shares[2] @ pressure.sum(1))))
    return shear
