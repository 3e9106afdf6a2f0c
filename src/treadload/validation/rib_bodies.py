"""Checks of ribs and blocks as bodies: operators, one rib pressed, cells, filled grooves, mirrors, one pitch."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from treadload.contact import Contact, PitchPassage, Rolling, solve_contact, solve_pitch
from treadload.contact.bodies import Influence, Pair
from treadload.contact.solvers.coupling import Surfaces, solve_coupled
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.layers.layered import Stack, transfer
from treadload.kernels.sections import Section, face_compliance
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.response import solve_response
from treadload.response.loads import GridLoad
from treadload.tire import Belt, Tire, TreadProfile
from treadload.tire.grooves import Groove, LateralGrooves
from treadload.validation.check import Check, absolute, relative
from treadload.validation.one_rib import PressedRib, half_rib, outer_pin, outer_third

_SECOND = "a second program of the same equations, on other elements"
_ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))
_PRESSURE, _LOAD, _FRICTION = 820e3, 8e3, 0.7
_BELT = Belt(tread=Elastic(5.5e6, 0.495), bending=(80.0, 100.0, 150.0))
# Three ribs, so that a contact has a few thousand cells.
_GROOVES = (Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015))
_NARROW = TreadProfile(0.5, 0.8, 0.12, grooves=_GROOVES, shoulder_radius=0.005)
# Friction, groove depth, m, and the shear of the outer third over the mean pressure.
_THIRDS = (
    (0.15, 0.015, 0.139), (0.3, 0.015, 0.278), (0.5, 0.015, 0.396), (0.7, 0.015, 0.408), (0.9, 0.015, 0.408),
    (0.5, 0.010, 0.353), (0.5, 0.005, 0.278),
)  # fmt: skip
# A light tire on two blocks a pitch, one element a cell.
_PITCH, _BLOCK_LOAD, _BLOCK_CELL = 0.04, 2500.0, 8e-3
_LUGS = TreadProfile(
    0.3, 0.8, 0.088, grooves=(Groove(0.0, 0.01, 0.016),), lateral=(LateralGrooves(_PITCH, 0.006, 0.016),)
)


def section_checks() -> Iterator[Check]:
    """The operator of ribs; a section without grooves against the layer; one rib pressed, and its cells."""
    group = "operator of three ribs on a belt"
    matrix = _operator(Pair.of(_ribs(_NARROW), _ROAD).both)
    largest = float(np.abs(matrix).max())
    yield absolute(
        group, "largest asymmetry over the largest", np.abs(matrix - matrix.T).max() / largest, 0.0, 1e-12,
        "reciprocity",
    )  # fmt: skip
    values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
    smallest = float(values[0] / values[-1])
    words = "smallest eigenvalue over the largest; above zero"
    yield Check(group, words, smallest, 0.0, min(0.0, smallest), 0.0, smallest > 0, "energy", relative=False)
    yield from _slab_checks()
    group = "one rib of 48.6 mm pressed"
    for friction, depth, reference in _THIRDS:
        quantity = f"shear of the outer third over the mean pressure, μ {friction:g}, groove {depth * 1e3:g} mm"
        shear = outer_third(PressedRib(friction=friction, depth=depth))
        yield relative(group, quantity, shear, reference, 0.03, _SECOND)
    fine = PressedRib(cells=40)
    pin = "shear of a pin of 9.7 mm at the edge over the mean pressure"
    yield relative(group, pin, outer_pin(fine), 0.479, 0.03, _SECOND)
    half = "lateral force of half of the rib over its load"
    yield relative(group, half, half_rib(fine), 0.158, 0.03, _SECOND)
    group, coarse, fine = "one rib pressed, cells of 3 mm", PressedRib(cells=16), PressedRib(cells=32)
    for quantity, measure in (("shear of the outer third", outer_third), (pin, outer_pin), (half, half_rib)):
        yield relative(group, quantity, measure(coarse), measure(fine), 0.03, "cells of 1.5 mm")


def rolling_checks() -> Iterator[Check]:
    """Three ribs that roll: cells across, grooves that are filled, and a tread that is mirrored."""
    contacts = [_on_cells(size) for size in (3e-3, 1.5e-3)]
    quantity = "largest strain in the plane of the surface, mean over 10 mm, microstrain"
    strains = [1e6 * _largest(load) for load in contacts]
    yield relative("three ribs rolling, cells of 3 mm", quantity, *strains, 0.03, "cells of 1.5 mm across")
    smooth = replace(_NARROW, grooves=(), shoulder_radius=0.03)
    belt = replace(_BELT, tread=Elastic(5.5e6, 0.47))
    wheel = Rolling(normal_load=_LOAD, friction=_FRICTION)
    ribs, layer = (
        solve_contact(
            Tire.from_profile(smooth, inflation_pressure=_PRESSURE, belt=belt, tread=tread),
            _ROAD,
            wheel,
            spacing=5e-3,
        )
        for tread in ("ribs", "layer")
    )
    group, source = "a section with all grooves filled", "the layer without grooves"
    for quantity, number in (("deflection, mm", _approach), ("mean pressure of the middle third, kPa", _middle)):
        yield relative(group, quantity, number(ribs), number(layer), 0.01, source)
    yield from _mirror_checks()


def block_checks() -> Iterator[Check]:
    """Two blocks a pitch, free and under given creepages: balance, mirror image, and one pitch after another."""
    group, belt = "blocks over one pitch", Belt(tread=Elastic(4e6, 0.49), tread_thickness=0.024, arm=0.024)
    tire = Tire.from_profile(_LUGS, inflation_pressure=300e3, belt=belt)
    free = _pitch(tire, Rolling(normal_load=_BLOCK_LOAD, friction=_FRICTION), 0.01)
    data = free.dataset
    loads = np.abs(data.normal_load.to_numpy() / _BLOCK_LOAD - 1)
    yield absolute(
        group, "load over the given load, less 1, worst position", loads.max(), 0.0, 1e-6, "balance of forces"
    )
    forces = np.hypot(data.tractive_force, data.lateral_force) / _BLOCK_LOAD
    yield absolute(group, "horizontal force over load, free rolling", forces.max(), 0.0, 1e-6, "balance of forces")
    quantity = "difference from the mirror image over the largest pressure"
    yield absolute(group, quantity, _asymmetry(free), 0.0, 2e-3, "symmetry, in steps with a tolerance of 1e-4")
    driven = Rolling(normal_load=_BLOCK_LOAD, friction=_FRICTION, creepage_x=-0.02, creepage_y=0.01)
    first, settled = (_pitch(tire, driven, periodic) for periodic in (0.01, 1e-4))
    for name, words in (("tractive_force", "tractive"), ("lateral_force", "lateral")):
        values, last = (passage.dataset[name].to_numpy() for passage in (first, settled))
        change = float(np.abs(values - last).max() / np.abs(last).max())
        quantity = f"{words} force, worst change from a pitch to those settled within 1e-4"
        yield absolute(group, quantity, change, 0.0, 0.01, "periodicity")


def _ribs(profile: TreadProfile) -> Tire:
    return Tire.from_profile(profile, inflation_pressure=_PRESSURE, belt=_BELT, tread="ribs")


def _operator(pair: Pair) -> Array:
    """The operator on the cells of a small grid as a dense matrix."""
    grid = Grid.on_lattice(0.04, 0.12, 8e-3, 6e-3)
    influence = Influence(grid.shape, grid.dx, grid.dy, pair, grid.y0)
    rows = influence.material
    shape = (3, int(rows.sum()), grid.nx)
    columns = []
    for load in range(int(np.prod(shape))):
        fields, whole = np.zeros(shape), np.zeros((3, *grid.shape))
        fields.flat[load] = 1.0
        whole[:, rows] = fields
        columns.append(influence.displacement(whole[2], whole[:2])[:, rows].ravel())
    return np.array(columns).T


def _slab_checks() -> Iterator[Check]:
    """A slab of 160 mm without grooves, ν = 0.47: displacement of a cell of 6 mm by its own load."""
    poisson, cell, height, k = 0.47, 6e-3, 0.020, 50.0
    section = Section(((-0.08, 0.08),), height, (0.0, 0.0)).for_cells(3e-3)
    places = np.array([[-0.5, 0.5]]) * cell
    moved = face_compliance(section, poisson, waves=np.array([k])).on_cells(places).compliance[0]
    across = (np.arange(40_000) + 0.5) * 0.2
    size = np.hypot(k, across)
    layer = transfer(size, Stack([0.5 / (1 + poisson)], [poisson], [height], [], rigid=True), [0.0], [False])
    plane, transverse, along = layer.plane[0, 0, 0] / size, layer.transverse[0, 0] / size, (k / size) ** 2
    weight = np.sinc(across * cell / (2 * np.pi)) ** 2 * cell * 0.2 / np.pi
    symbols = (
        along * plane + (1 - along) * transverse,
        (1 - along) * plane + along * transverse,
        layer.plane[0, 1, 1] / size,
    )
    for number, (symbol, words) in enumerate(zip(symbols, ("along", "across", "down"), strict=True)):
        quantity = f"own displacement of a cell {words} over that of the layer, 50 waves/m"
        exact = float((weight * symbol).sum())
        yield relative(
            "slab without grooves", quantity, moved[number, number] / exact, 1.0, 0.01, "closed form of a layer"
        )


def _on_cells(dy: float) -> GridLoad:
    """Three ribs that roll freely, cells of 3 mm along and dy, m, across."""
    tire = _ribs(_NARROW)
    grid = Grid.on_lattice(0.16, 0.15, 3e-3, dy)
    influence = Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire, _ROAD).both, grid.y0)
    wheel = Rolling(normal_load=_LOAD, friction=_FRICTION)
    solved = solve_coupled(influence, Surfaces(grid, tire.height_map(grid)), wheel, check=lambda pressure: None)
    shear = solved.slipping.tangential.shear
    return GridLoad(grid, solved.normal.pressure, -shear[0], -shear[1])


def _largest(load: GridLoad) -> float:
    step = 2e-3
    x, y = (step * (np.arange(-half, half + 1) + 0.25) for half in (30, 30))
    data = solve_response(load, _ROAD, depths=[0.0], x=x, y=y, mean_over=10e-3).dataset
    along, across, sheared = (data[f"strain_{name}"].to_numpy() for name in ("xx", "yy", "xy"))
    return float((0.5 * (along + across) + np.hypot(0.5 * (along - across), sheared)).max())


def _approach(contact: Contact) -> float:
    return 1e3 * float(contact.dataset.approach)


def _middle(contact: Contact) -> float:
    return 1e-3 * float(contact.dataset.pressure.sel(y=slice(-0.02, 0.02), x=slice(-0.04, 0.04)).mean())


def _mirror_checks() -> Iterator[Check]:
    """Grooves at unlike places, and their mirror image, driven and steered."""
    grooves = (Groove(-0.025, 0.012, 0.015, edge_radius=0.002), Groove(0.015, 0.008, 0.012, edge_radius=0.002))
    image = tuple(replace(groove, centre=-groove.centre) for groove in grooves[::-1])
    data, mirrored = (
        solve_contact(
            _ribs(replace(_NARROW, grooves=cut)), _ROAD,
            Rolling(normal_load=_LOAD, friction=0.5, creepage_x=-0.002, creepage_y=side * 0.003),
            spacing=6e-3, tolerance=1e-7,
        ).dataset
        for cut, side in ((grooves, 1.0), (image, -1.0))
    )  # fmt: skip
    peak = float(data.pressure.max())
    for name, parity in (("pressure", 1), ("traction_x", 1), ("traction_y", -1)):
        difference = np.abs(mirrored[name].to_numpy()[::-1] - parity * data[name].to_numpy()).max() / peak
        quantity = f"{name.replace('_', ' ')}, difference from the mirror image over the largest pressure"
        yield absolute("mirrored tread with ribs", quantity, difference, 0.0, 1e-6, "symmetry")


def _pitch(tire: Tire, wheel: Rolling, periodic: float) -> PitchPassage:
    return solve_pitch(tire, _ROAD, wheel, spacing=_BLOCK_CELL, positions=4, periodic=periodic)


def _asymmetry(passage: PitchPassage) -> float:
    data, largest = passage.dataset, 0.0
    for name, sign in (("pressure", 1), ("traction_x", 1), ("traction_y", -1)):
        field = data[name].transpose("position", "y", "x").to_numpy()
        largest = max(largest, float(np.abs(field - sign * field[:, ::-1]).max()))
    return largest / float(data["largest_pressure"].max())
