"""Checks of ribs with free sides: blocks bonded on both faces, and five ribs that roll."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.ndimage import uniform_filter

from treadload.contact import Contact, Rolling, solve_contact
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


def rib_checks() -> Iterator[Check]:
    """Blocks of four Poisson's ratios in plane strain; the profile 315/80R22.5 at 35 kN, rolling freely."""
    for poisson, stiffness in _BLOCKS:
        quantity = f"apparent modulus over E, ν = {poisson:g}"
        yield relative("block bonded on both faces", quantity, bonded_block(poisson), stiffness, 3e-3, _SOURCE)
    belt = Belt(tread=Elastic(5.5e6, 0.495), bending=(80.0, 100.0, 150.0))
    tire = Tire.from_profile("315/80R22.5", inflation_pressure=820e3, belt=belt, tread="ribs")
    road = Pavement.half_space(Elastic(5.4e9, 0.35))
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
