"""Checks of ribs that roll: what viscoelastic rubber loses, its limits of speed, and a creep curve."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from treadload.contact import Contact, Rolling, creep_curve, rolling_resistance, solve_contact
from treadload.contact.bodies import Influence, Pair
from treadload.contact.bodies.body import Rows
from treadload.contact.bodies.choose import surface_of
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.fft import rfft
from treadload.materials import Elastic, Prony
from treadload.pavement import Pavement
from treadload.tire import Belt, Tire, TreadProfile
from treadload.tire.grooves import Groove
from treadload.validation.check import Check, absolute, relative

_ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))
_RUBBER = Prony(11e6, ((0.3, 2e-3), (0.2, 0.05)), 0.495)
_ELASTIC = Elastic(5.5e6, 0.495)
_GROOVES = (Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015))
_NARROW = TreadProfile(0.5, 0.8, 0.12, grooves=_GROOVES, shoulder_radius=0.005)
_RADIUS, _LOAD, _SPEED = 0.5, 8e3, 5.0
_CELLS, _COARSE = (4e-3, 2e-3), 8e-3
# Length along travel, m, after which loads repeat where the loss of each wave is summed up.
_PERIOD = 2.4
# Friction under which nothing slides at a small creepage; the creepage; one at which everything slides.
_STICKY, _SMALL, _LARGE = 3.0, 1e-6, 0.5


def rolling_rib_checks() -> Iterator[Check]:
    """Three viscoelastic ribs that roll freely and under creepage; three elastic ones over lateral creepage."""
    group = "viscoelastic ribs rolling"
    for words, creepages in (("free", {}), ("driven and steered", {"creepage_x": 0.002, "creepage_y": 0.003})):
        wheel = Rolling(normal_load=_LOAD, friction=0.6, speed=_SPEED, **creepages)
        coarse, fine = (_power(solve_contact(_tire(_RUBBER), _ROAD, wheel, spacing=size)) for size in _CELLS)
        # The step of rolling is of first order.
        brought, lost = 2 * fine - coarse
        quantity = f"energy lost in rubber and by friction, J/m, {words}, from cells of 4 and 2 mm"
        yield relative(group, quantity, lost, brought, 0.01, "moment of the pressure over R, and work of the forces")
    wheel = Rolling(normal_load=_LOAD, friction=0.6)
    for speed, words, limit in ((1e-6, "long-term", _RUBBER.rubbery), (1e7, "instantaneous", _RUBBER.glassy)):
        rolled = solve_contact(_tire(_RUBBER), _ROAD, replace(wheel, speed=speed), spacing=_COARSE).dataset
        elastic = solve_contact(_tire(limit), _ROAD, wheel, spacing=_COARSE).dataset
        # Its grid need not hold the contact of slow rolling.
        elastic = elastic[["pressure", "traction_y"]].reindex_like(
            rolled, method="nearest", tolerance=1e-6, fill_value=0.0
        )
        for name in ("pressure", "traction_y"):
            fields = (data[name].to_numpy() for data in (rolled, elastic))
            difference = np.abs(np.subtract(*fields)).max() / float(elastic.pressure.max())
            quantity = f"{name.replace('_', ' ')} at {speed:g} m/s, difference over the largest pressure"
            yield absolute(group, quantity, float(difference), 0.0, 2e-3, f"elastic ribs of the {words} modulus")
    yield from _creep_checks()


def _creep_checks() -> Iterator[Check]:
    group, tire = "creep curve of ribs", _tire(_ELASTIC)
    wheel = Rolling(normal_load=_LOAD, friction=_STICKY)
    directions: tuple[tuple[Literal["x", "y"], str], ...] = (("y", "lateral"), ("x", "longitudinal"))
    for along, words in directions:
        base = float(solve_contact(tire, _ROAD, wheel, spacing=_COARSE, tolerance=1e-9).dataset.creepage_x)
        at = np.array([-_SMALL, _SMALL]) + (base if along == "x" else 0.0)
        curve = creep_curve(tire, _ROAD, wheel, list(at), along=along, spacing=_COARSE, tolerance=1e-9)
        force = curve.dataset["tractive_force" if along == "x" else "lateral_force"].to_numpy()
        slope = float(np.diff(force)[0] / np.diff(at)[0]) / _LOAD
        expected = adhesion_slope(curve.contacts[1], along) / _LOAD
        source = "dense matrix of full adhesion on the cells in contact"
        yield relative(group, f"{words} force over load and creepage, small creepage", slope, expected, 0.01, source)
    slipped = Rolling(normal_load=_LOAD, friction=0.6)
    curve = creep_curve(tire, _ROAD, slipped, [_LARGE], along="y", spacing=_COARSE)
    used = abs(float(curve.dataset.lateral_force[0])) / (0.6 * _LOAD)
    yield relative(group, f"lateral force over μN, creepage {_LARGE:g}", used, 1.0, 0.02, "Coulomb: all cells slide")


def _power(contact: Contact) -> Array:
    """Energy per metre, J/m: brought in by the moment of the pressure and the forces; lost in rubber and friction."""
    friction = float(contact.dataset.friction_work_total)
    brought = rolling_resistance(contact, _RADIUS).material_loss + friction
    return np.array([brought, lost_in_rubber(contact) + friction])


def lost_in_rubber(contact: Contact) -> float:
    """Energy that the rubber of these viscoelastic ribs loses per metre, J/m, wave by wave from its loss compliance.

    By the tractions and the compliance of elastic ribs of the instantaneous modulus alone: a wave k of tractions t
    loses k Im(1/(1 - i k V T)) f t* C t of every part f, T of the creep compliance.
    """
    data, rubber = contact.dataset, _RUBBER
    dx, dy = float(data.attrs["dx"]), float(data.attrs["dy"])
    body = surface_of(_tire(rubber.glassy).carcass, is_tire=True)
    rows = Rows(data.sizes["y"], dy, float(data.y[0]))
    length = 2 * round(0.5 * _PERIOD / dx)
    loads = np.stack([-data.traction_x.to_numpy(), -data.traction_y.to_numpy(), data.pressure.to_numpy()])
    waves = rfft(loads, n=length, axis=-1) * np.array([-1j, 1.0, -1.0])[:, None, None]
    k = 2 * np.pi * np.arange(length // 2 + 1) / (length * dx)
    speed = float(contact.rolling.speed or 0.0)
    lagging = sum(f * k * speed * t / (1 + (k * speed * t) ** 2) for f, t in rubber.creep_terms)
    weight = np.full(k.size, 2.0)
    weight[[0, -1]] = 1.0
    lost = 0.0
    for strip in body.strips(rows):
        part = waves[:, strip.rows].transpose(2, 0, 1).reshape(k.size, -1)
        energy = np.einsum("ki,kij,kj->k", part.conj(), strip.block(length, dx), part).real
        lost += float((weight * k * lagging * energy).sum()) * dx * dy / length
    return lost


def adhesion_slope(contact: Contact, along: str) -> float:
    """Change of the force of a contact per creepage, N, where all cells stick and the contact stays what it is.

    Pressure, shear and approach change together: a dense matrix of the influence of every cell on every other.
    """
    data = contact.dataset
    dx, dy = float(data.attrs["dx"]), float(data.attrs["dy"])
    pair = Pair.of(contact.tire, contact.road).both
    # A column more ahead of the contact, from which particles come.
    ny, nx = data.pressure.shape
    influence = Influence((ny, nx + 1), dx, dy, pair, float(data.y[0]))
    touching: BoolArray = data.pressure.to_numpy() > 0
    count = int(touching.sum())
    places = np.flatnonzero(touching)
    matrix = np.zeros((3 * count + 1, 3 * count + 1))
    for component in range(3):
        for number, place in enumerate(places):
            loads = np.zeros((3, ny, nx + 1))
            loads[component, place // nx, place % nx] = 1.0
            u = influence.displacement(loads[2], loads[:2])
            moved = np.stack([*(u[:2, :, :-1] - u[:2, :, 1:]), u[2, :, :-1]])
            matrix[: 3 * count, component * count + number] = moved[:, touching].ravel()
    # Rigid approach, and the load that stays.
    matrix[2 * count : 3 * count, -1], matrix[-1, 2 * count : 3 * count] = -1.0, 1.0
    right = np.zeros(3 * count + 1)
    first = 0 if along == "x" else count
    right[first : first + count] = -dx
    change = np.linalg.solve(matrix, right)
    # Shear on the tire is what pulls the tire along: the force of the contact's dataset.
    return float(change[first : first + count].sum()) * dx * dy


def _tire(rubber: Elastic | Prony) -> Tire:
    belt = Belt(tread=rubber, bending=(80.0, 100.0, 150.0))
    return Tire.from_profile(_NARROW, inflation_pressure=820e3, belt=belt, tread="ribs")
