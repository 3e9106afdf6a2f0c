"""Checks on tires: the conditions of contact, the example mesh, the modulus from inflation."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec

import numpy as np

from treadload.contact import Contact, Rolling, solve_contact
from treadload.pavement import Pavement
from treadload.tire import Tire, example_mesh, modulus_from_inflation
from treadload.validation.check import Check, absolute, relative
from treadload.validation.pressing import ASPHALT, RUBBER

_OPEN, _SLIP = 0, 2


def condition_checks() -> Iterator[Check]:
    """The profile 315/80R22.5 at 32.5 kN, driving with 10 kN and cornering with 6 kN on a radius of 20 m."""
    tire = Tire.from_profile("315/80R22.5", material=RUBBER)
    road = Pavement.half_space(ASPHALT)
    driving = Rolling(normal_load=32.5e3, friction=0.7, tractive_force=10e3)
    cornering = Rolling(normal_load=32.5e3, friction=0.7, lateral_force=6e3, spin=0.05)
    for name, rolling in (("driving", driving), ("cornering", cornering)):
        yield from contact_conditions(f"315/80R22.5, {name}", solve_contact(tire, road, rolling))


def contact_conditions(group: str, contact: Contact) -> Iterator[Check]:
    """What every solved contact must satisfy: balance, feasibility, complementarity, slip along the shear."""
    data, rolling = contact.dataset, contact.rolling
    p, gap = data.pressure.to_numpy(), data.gap.to_numpy()
    traction = np.stack([data.traction_x, data.traction_y])
    slip = np.stack([data.slip_x, data.slip_y])
    state, approach = data.state.to_numpy(), float(data.approach)
    balance, law = "balance of forces", "conditions of contact and friction"
    if rolling.normal_load is not None:
        carried = p.sum() * contact.cell_area / 1e3
        yield relative(group, "Σ p dA, kN", carried, rolling.normal_load / 1e3, 1e-6, balance)
    bound = data.friction_coefficient.to_numpy() * p
    limit = bound.sum() * contact.cell_area
    for axis, force, component in zip("xy", rolling.forces, traction, strict=True):
        if force is not None:
            # The road feels the opposite of the force on the tire.
            carried = -component.sum() * contact.cell_area / limit
            yield absolute(group, f"Σ q_{axis} dA over μP", carried, force / limit, 1e-6, balance)
    yield absolute(group, "pressure below zero, Pa", min(0.0, p.min()), 0, 0, law)
    penetration = float(min(0.0, np.nanmin(gap))) / approach
    yield absolute(group, "penetration over approach", penetration, 0, 1e-6, law)
    apart = float(np.abs(gap[p > 0]).max()) / approach
    yield absolute(group, "gap under pressure over approach", apart, 0, 1e-6, law)
    # On the ellipse of anisotropic friction, shear is measured against its axes.
    size = np.hypot(*(part / axis for part, axis in zip(traction, rolling.law.axes, strict=True)))
    # Without friction the bound is zero, and so must the shear be.
    over = (size - bound) / np.maximum(bound, np.finfo(float).tiny)
    yield absolute(group, "|q| above μp, over μp", over[state != _OPEN].max(initial=0.0), 0, 1e-9, law)
    loose = float(size[state == _OPEN].max(initial=0.0))
    yield absolute(group, "shear outside the contact, Pa", loose, 0, 0, law)
    sliding = state == _SLIP
    # The tire slides over the road and drags it along: shear on the road points as the slip does.
    against = int(((traction * slip).sum(0)[sliding] <= 0).sum())
    what = f"cells, of {int(sliding.sum())} in slip, whose slip does not oppose the shear on the tire"
    yield absolute(group, what, against, 0, 0, law)
    yield absolute(group, "|q| short of μp in slip, over μp", -over[sliding].min(initial=0.0), 0, 1e-9, law)


def mesh_checks() -> Iterator[Check]:
    """The truck tire mesh that ships with the package; nothing where trimesh is not installed."""
    if find_spec("trimesh") is None:
        return
    quality = Tire.from_scan(example_mesh()).quality
    assert quality is not None
    group, source = "mesh 335/65R22.5", "dimensions of the mesh (Project Chrono)"
    yield absolute(group, "crown radius, mm", quality.crown_radius * 1e3, 504.6, 1.0, source)
    yield absolute(group, "overall width, mm", quality.width * 1e3, 343.5, 1.0, source)
    yield absolute(group, "grooves", len(quality.grooves), 3, 0, source)
    for groove, width in zip(quality.grooves, (17, 25, 17), strict=False):
        where = f"groove at {groove.centre * 1e3:+.0f} mm"
        yield absolute(group, f"{where}: width, mm", groove.width * 1e3, width, 2.0, source)
        # The floors are known to lie between 14 and 17 mm, and that to 1 mm.
        yield absolute(group, f"{where}: floor below the crown, mm", groove.floor * 1e3, 15.5, 2.5, source)
    yield absolute(group, "error of the axis, degrees", axis_error(), 0, 0.05, "the mesh turned by known angles")


def axis_error() -> float:
    """Angle in degrees between the axle fitted to the example mesh and the one it was turned to."""
    from treadload.tire.scan.axis import fit_axis, sample_surface
    from treadload.tire.scan.mesh_file import read_mesh

    mesh = read_mesh(example_mesh())
    a, b = 0.7, -0.4
    about_z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    about_x = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    turn = about_x @ about_z
    fitted = fit_axis(*sample_surface(mesh.vertices @ turn.T + np.array([3.0, -1.0, 2.0]), mesh.faces))
    # The axle of the file lies along y.
    return float(np.degrees(np.arcsin(np.linalg.norm(np.cross(fitted.direction, turn @ np.array([0.0, 1.0, 0.0]))))))


def modulus_checks() -> Iterator[Check]:
    """Equation 15 of the paper."""
    yield relative(
        "modulus from inflation",
        "E at 820 kPa, MPa",
        modulus_from_inflation(820e3) / 1e6,
        2.914,
        1e-12,
        "Materials 2021, 14, 2117, eq. 15",
    )
