"""A truck wheel in a roundabout: does it tear the road?

The paper announces the study of "tearing phenomena in singular road points (turns, roundabouts)". Here a 315/80R22.5
wheel rolls straight, climbs, brakes, locks, turns in a roundabout, also as the outer wheel that the vehicle leans on,
and is turned on the spot as in parking; on the paper's asphalt as a half-space, and on a structure of the French
catalogue at 15 °C. For each: the largest tensile strain at the surface and below it, which way its cracks run, and
the load repetitions that the fatigue line allows.

At the surface, where ribs end and slide, the exact extension has no bound: its largest value grows with every finer
cell and the passes fall with it, as in the paper. The verdict reads its mean over a cube of 10 mm, the size of the
mix's stones, which has one, in the horizontal plane, where it opens cracks downwards, and only where something is
tensile: in a stiff course that bends, the largest tensile strain in space is vertical below the wheel, where
everything is compressed, and opens no crack. The assessment evaluates the whole basin around the wheel, and the table
has the basin's strain where it is larger than the map's: the structure hogs 0.7 to 0.95 m from a wheel that rolls
straight (8.0 microstrain), climbs (9.3) or brakes (10.1). On the paper's asphalt, which is one material and does not
hog, the largest strain of a wheel that rolls straight lies 50 mm beside its footprint (6.3).

    python examples/roundabout/run.py [folder] [--coarse]
"""

import math
import sys
from pathlib import Path

import numpy as np
import xarray as xr

import treadload as tl
from treadload.damage import crack_rose, envelope
from treadload.plots import compare_strain, orientation_shares, save, tearing, trace_rose

TIRE = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.5))
LOAD, FRICTION = 32.5e3, 0.7
RADIUS, SPEED = 12.0, 20 / 3.6
STRUCTURE = "6 BBSG3 / 15 GB3 / PF3"
# Each road with the fatigue line of its surface: the paper's, and the laboratory's of the mix, without calibration.
MIX = tl.catalogue.mixes["EB-BBSG3"]
ROADS = {
    "the paper's asphalt": (tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.FatigueLine(120e-6, -0.2)),
    STRUCTURE: (tl.Pavement.from_catalogue(STRUCTURE, temperature=15), tl.FatigueLine(MIX.epsilon_6, MIX.slope)),
}
MANEUVERS = {
    "straight": tl.contact.STRAIGHT,
    "uphill 6 %": tl.contact.Maneuver.uphill(0.06, 0.25),
    "braking 3 m/s²": tl.contact.Maneuver.braking(3.0),
    "locked": tl.contact.Maneuver.braking(),
    "roundabout": tl.contact.Maneuver.turning(RADIUS, SPEED),
    "outer wheel": tl.contact.Maneuver.turning(RADIUS, SPEED, track=2.0, centre_of_gravity=1.6),
}
PARKING = "parking turn"
DEEP = 0.01
# Roses are drawn on the contact's grid. Further out a road that bends is strained too, but by less than the
# threshold: the structure by 8 to 10 microstrain where the wheel rolls straight, climbs or brakes.
# Road that extends by less than a fifth of the paper's ε₆ bears it thousands of millions of times.
THRESHOLD = 24e-6


def contacts(spacing: float) -> dict[str, tl.contact.Contact]:
    """The wheel in every maneuver. What the road is made of matters to none: it gives 0.6 % of the compliance."""
    road = ROADS["the paper's asphalt"][0]
    found = {
        name: tl.solve_contact(TIRE, road, maneuver.rolling(LOAD, FRICTION, speed=SPEED), spacing=spacing)
        for name, maneuver in MANEUVERS.items()
    }
    standing = tl.Rolling(normal_load=LOAD, friction=FRICTION)
    angles = np.radians([1.0, 3.0, 6.0, 10.0, 15.0, 22.0, 30.0])
    turned = tl.contact.turn_on_the_spot(TIRE, road, standing, angles=angles, spacing=spacing)
    torque = float(turned.dataset.steering_torque[-1] / turned.dataset.sliding_torque)
    assert 0.99 < torque <= 1.0, "a wheel turned by 30° slides all over"
    return {**found, PARKING: turned.contact}


def rose_of(name: str, response: tl.response.Response, line: tl.FatigueLine) -> xr.Dataset:
    """How the cracks run at the surface, each point at its worst instant.

    A road point sees the whole passage of a rolling wheel. Under a wheel that is turned it sees one place only.
    """
    if name == PARKING:
        cracks = tl.assess(response, line, strain="in-plane").dataset
    else:
        cracks = envelope(response, strain="in-plane").isel(depth=0)
    return crack_rose(cracks, threshold=THRESHOLD, classes=18)


def table(
    wheels: dict[str, tl.contact.Contact], responses: dict[str, tl.response.Response], line: tl.FatigueLine
) -> xr.Dataset:
    """Prints a line for each maneuver; returns largest tensile strains, passes and shares."""
    print(
        f"{'':15s} {'load':>5s} {'Q/P':>5s} {'slip':>5s} | {'read':>6s} {'in plane':>9s} {'10 mm deep':>11s} | "
        f"{'width':>5s} {'along':>6s} {'oblique':>8s} {'across':>7s} | {'passes':>8s}"
    )
    rows, roses = [], []
    for name, response in responses.items():
        data = wheels[name].dataset
        # The mean over 10 mm in the plane; what it is where nothing need be tensile; and in space, at points.
        verdict = tl.assess(response, line).dataset
        read, plane = max(0.0, float(verdict.worst_strain)), float(verdict.attrs["largest_in_plane_strain"])
        deep = float(response.dataset.principal_strain_1.sel(depth=DEEP).max())
        passes = float(verdict.worst_passes)
        rose = rose_of(name, response, line)
        load = float(data.normal_load)
        force = math.hypot(float(data.tractive_force), float(data.lateral_force)) / load
        shares = 100 * rose.orientation_share.sel(orientation=["longitudinal", "oblique", "transverse"]).values
        width = "" if name == PARKING else f"{rose.attrs['weight_total'] * 1e3:.0f}"
        print(
            f"{name:15s} {load / 1e3:5.1f} {force:5.2f} {100 * wheels[name].slip_fraction:5.0f} | "
            f"{read * 1e6:6.0f} {plane * 1e6:9.0f} {deep * 1e6:11.0f} | "
            f"{width:>5s} {shares[0]:6.0f} {shares[1]:8.0f} {shares[2]:7.0f} | {passes:8.1e}"
        )
        rows.append([read, plane, deep, passes])
        roses.append(rose)
    print(
        f"{'':15s} {'kN':>5s} {'':5s} {'%':>5s} | {'microstrain':>28s} | {'mm':>5s} "
        f"{'% of the cracked road':>23s} |\n"
    )
    numbers = dict(zip(("read", "in_plane", "deep", "passes"), np.transpose(rows), strict=True))
    both = xr.concat(roses, xr.Variable("maneuver", list(responses)), combine_attrs="override")
    return both.assign({key: ("maneuver", column) for key, column in numbers.items()})


def edges(contact: tl.contact.Contact) -> tuple[float, float]:
    """The most work of sliding on a strip of road over the median strip's, and its distance to a rib's edge, m."""
    data = contact.dataset
    touches = (data.pressure > 0).any("x").values
    y, dy = data.y.values, data.attrs["dy"]
    ends = y[:-1][touches[1:] != touches[:-1]] + dy / 2
    work = data.friction_work.sum("x").values
    most = int(work.argmax())
    return float(work[most] / np.median(work[touches])), float(np.abs(y[most] - ends).min())


def draw(
    folder: Path,
    wheels: dict[str, tl.contact.Contact],
    responses: dict[str, dict[str, tl.response.Response]],
    tables: list[xr.Dataset],
) -> None:
    """Tearing, strain maps, roses and bars."""
    first, second = responses.values()
    turn = wheels["roundabout"]
    words = f"Tearing in a roundabout of {RADIUS:g} m at {SPEED * 3.6:g} km/h"
    asphalt = "the paper's asphalt"
    save(tearing(turn, first["roundabout"], title=f"{words}, {asphalt}"), folder / "tearing_half_space.png")
    bent = tearing(turn, second["roundabout"], strain="in-plane", title=f"{words}, {STRUCTURE}")
    save(bent, folder / "tearing_structure.png")
    parked = tearing(wheels[PARKING], first[PARKING], title=f"A wheel turned on the spot by 30°, {asphalt}")
    save(parked, folder / "tearing_parking.png")
    shown = ["straight", "uphill 6 %", "locked", "roundabout", "outer wheel", PARKING]
    save(compare_strain([first[name] for name in shown], shown), folder / "strain.png")
    for name, road, numbers in zip(("half_space", "structure"), ROADS, tables, strict=True):
        names = [str(m) for m in numbers.maneuver.values]
        roses = [numbers.sel(maneuver=m) for m in names]
        largest = [max(0.0, float(one.in_plane)) * 1e6 for one in roses]
        save(trace_rose(roses, names), folder / f"rose_{name}.png")
        notes = [f"up to {strain:.0f} microstrain" if strain else "all compressed" for strain in largest]
        title = f"How the cracks run at the surface, {road}"
        save(orientation_shares(roses, names, notes=notes, title=title), folder / f"orientation_{name}.png")


def check(wheels: dict[str, tl.contact.Contact], tables: list[xr.Dataset]) -> None:
    """What must hold, whatever the cells."""
    turn, outer = (wheels[name].dataset for name in ("roundabout", "outer wheel"))
    # Statics: V²/(gR) of the load to the side, and 2 h/t of that more load on the outer wheel.
    side = SPEED**2 / (9.81 * RADIUS)
    assert math.isclose(float(turn.lateral_force), side * LOAD, rel_tol=1e-4)
    assert math.isclose(float(outer.normal_load), LOAD * (1 + 2 * side * 1.6 / 2.0), rel_tol=1e-4)
    # A locked wheel loses μP in each metre, but for what the tire's own deformation turns aside.
    assert math.isclose(float(wheels["locked"].dataset.friction_work_total), FRICTION * LOAD, rel_tol=1e-2)
    ratio, distance = edges(wheels["roundabout"])
    print(
        f"roundabout: the work of sliding peaks {distance * 1e3:.0f} mm from a rib's edge, {ratio:.1f} x the median"
    )
    assert ratio > 1.5
    assert distance < 6.1e-3
    for numbers in tables:
        of = {str(name): numbers.sel(maneuver=name) for name in numbers.maneuver.values}
        # A force along the road opens cracks across it, a side force hardly any.
        share = {name: one.orientation_share for name, one in of.items()}
        assert share["locked"].sel(orientation="transverse") > 0.5
        assert share["roundabout"].sel(orientation="transverse") < 0.1
        for strain in ("read", "in_plane", "deep"):
            assert float(of["outer wheel"][strain]) > float(of["roundabout"][strain]) > float(of["straight"][strain])


def main(folder: Path, spacing: float = 2e-3) -> dict[str, xr.Dataset]:
    """Solve, print, draw, check; returns a table for each road."""
    folder.mkdir(parents=True, exist_ok=True)
    wheels = contacts(spacing)
    responses, tables = {}, []
    for name, (road, line) in ROADS.items():
        print(f"{name}: {line}; cells of {spacing * 1e3:g} mm")
        responses[name] = {m: tl.solve_response(c, road, depths=[0.0, DEEP]) for m, c in wheels.items()}
        tables.append(table(wheels, responses[name], line))
    check(wheels, tables)
    draw(folder, wheels, responses, tables)
    return dict(zip(ROADS, tables, strict=True))


if __name__ == "__main__":
    where = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    main(Path(where[0]) if where else Path("roundabout"), 6e-3 if "--coarse" in sys.argv else 2e-3)
