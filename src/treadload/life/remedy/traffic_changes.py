"""Changes of the traffic by one step: wander, loads, tires, inflation, speed, braking, turns, friction."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from treadload.contact.maneuver import GRAVITY, Maneuver
from treadload.damage.traffic import AxleClass, Wander
from treadload.errors import InputError
from treadload.life.design import Design
from treadload.life.remedy.changes import Change, NotApplicable, Remedy
from treadload.life.remedy.steps import Kind, RemedySteps
from treadload.life.variants import each_class, friction_number
from treadload.tire import Belt, Tire, TreadProfile
from treadload.tire.belt import belts
from treadload.tire.library import tires
from treadload.tire.tread import ProfileSurface

# At which laws are asked whether they include wander.
_ANY_TEMPERATURE = 15.0
# Round-off of a speed that is one step.
_SAME = 1e-9
# Radii of tires that stand for each other differ by less than this part.
_ALIKE = 0.2


def more_wander(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """Wheels that wander by the step more."""
    wander, title = design.traffic.wander, f"{steps.wander * 1e3:g} mm more wander"
    if not wander.reach:
        yield NotApplicable(title, "the traffic has no wander to widen; give it one")
        return
    laws = [criterion.law_at(_ANY_TEMPERATURE) for criterion in design.criteria]
    if design.rutting is None and all(law.includes_wander for law in laws):
        yield NotApplicable(title, "every law of this case was calibrated on roads with wander and includes it")
        return
    traffic = replace(design.traffic, wander=_wider(wander, steps.wander))
    yield Remedy(title, "wander", replace(design, traffic=traffic), same_responses=design.rutting is None)


def lighter_wheels(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """All wheel loads, lower by the step."""
    part = 1 - steps.load
    yield _with_classes(
        design,
        f"wheel loads {100 * steps.load:g} % lower",
        "load",
        lambda row: replace(row, wheel_load=part * row.wheel_load),
    )


def other_tires(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """The step's tire, or the catalogue's next profile, for all classes without one of their own."""
    if all(row.tire is not None for row in design.traffic.classes):
        yield NotApplicable("another tire", "every class of axles has a tire of its own; change those in the case")
        return
    try:
        tire = _next_tire(design.tire) if steps.tire is None else steps.tire
    except InputError as error:
        yield NotApplicable("another tire", str(error))
        return
    yield Remedy(f"tires {tire.name or 'of the step'}", "tire", replace(design, tire=tire))


def softer_tires(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """All inflation pressures, lower by the step."""
    title = f"tires inflated by {steps.pressure / 1e5:g} bar less"
    low = min(design.traffic.classes, key=lambda row: row.inflation_pressure)
    if low.inflation_pressure <= steps.pressure:
        yield NotApplicable(title, f"{low.name} has {low.inflation_pressure / 1e5:g} bar")
        return
    yield _with_classes(
        design,
        title,
        "pressure",
        lambda row: replace(row, inflation_pressure=row.inflation_pressure - steps.pressure),
    )


def other_speeds(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """All classes slower and faster by the step: moduli at their frequencies and forces in turns follow."""
    classes = design.traffic.classes
    words = f"{steps.speed * 3.6:g} km/h"
    turns = [row for row in classes if row.maneuver.spin]
    if any(row.speed is None for row in classes):
        lacking = next(row for row in classes if row.speed is None)
        yield NotApplicable(f"{words} slower or faster", f"{lacking.name} has no speed")
        return
    if not turns and all(row.frequency is None for row in classes) and not _is_viscoelastic(design):
        why = "moduli here do not depend on it and no class turns; give the traffic a frequency"
        yield NotApplicable(f"{words} slower or faster", why)
        return
    slowest = min(classes, key=lambda row: row.speed or 0.0)
    for sign, word in ((-1, "slower"), (1, "faster")):
        title = f"{words} {word}"
        if sign < 0 and (slowest.speed or 0.0) <= steps.speed * (1 + _SAME):
            yield NotApplicable(title, f"{slowest.name} rolls at {(slowest.speed or 0.0) * 3.6:g} km/h")
            continue
        try:
            yield _with_classes(design, title, "speed", partial(_faster, by=sign * steps.speed))
        except InputError as error:
            yield NotApplicable(title, str(error))


def gentler_braking(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """Tractive forces, of braking, starting and climbing, smaller by the step."""
    classes = [row for row in design.traffic.classes if row.maneuver.tractive and not row.maneuver.locked]
    title = f"braking and starting {100 * steps.maneuver:g} % gentler"
    if not classes:
        locked = any(row.maneuver.locked for row in design.traffic.classes)
        yield NotApplicable(title, "wheels are locked and slide" if locked else "no class brakes or is driven")
        return

    def gentler(row: AxleClass) -> AxleClass:
        tractive = (1 - steps.maneuver) * row.maneuver.tractive
        return row if row.maneuver.locked else replace(row, maneuver=replace(row.maneuver, tractive=tractive))

    yield _with_classes(design, title, "braking", gentler)


def wider_turns(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """Side force and spin smaller by the step, as on a wider path with as much less crossfall."""
    title = f"turns of {100 / (1 - steps.maneuver) - 100:.0f} % larger radius"
    if not any(row.maneuver.spin or row.maneuver.lateral for row in design.traffic.classes):
        yield NotApplicable(title, "no class turns")
        return
    part = 1 - steps.maneuver

    def wider(row: AxleClass) -> AxleClass:
        turn = row.maneuver
        ratio = 1 + part * (turn.load_ratio - 1)
        return replace(
            row, maneuver=replace(turn, lateral=part * turn.lateral, spin=part * turn.spin, load_ratio=ratio)
        )

    yield _with_classes(design, title, "turning", wider)


def other_friction(design: Design, steps: RemedySteps) -> Iterator[Change]:
    """Friction lower and higher by the step."""
    title = f"friction {steps.friction:g} lower or higher"
    numbers = [friction_number(row.friction) for row in design.traffic.classes]
    lacking = [row for row, number in zip(design.traffic.classes, numbers, strict=True) if number is None]
    if lacking:
        yield NotApplicable(title, f"that of {lacking[0].name} is a law, not one number")
        return
    lowest = min(number for number in numbers if number is not None)
    for sign, word in ((-1, "lower"), (1, "higher")):
        title = f"friction {steps.friction:g} {word}"
        if lowest + sign * steps.friction <= 0:
            yield NotApplicable(title, f"a class has {lowest:g} only")
            continue

        def changed(row: AxleClass, by: float = sign * steps.friction) -> AxleClass:
            return replace(row, friction=(friction_number(row.friction) or 0.0) + by)

        remark = f"{title}: the road has less grip for braking" if sign < 0 else ""
        yield _with_classes(design, title, "friction", changed, remark)


def _with_classes(
    design: Design, title: str, kind: Kind, change: Callable[[AxleClass], AxleClass], remark: str = ""
) -> Remedy:
    return Remedy(title, kind, replace(design, traffic=each_class(design.traffic, change)), remark=remark)


def _wider(wander: Wander, step: float) -> Wander:
    """A normal law with the step more deviation; a measured one stretched about its mean by as much."""
    if not wander.offsets:
        return Wander.normal(wander.deviation + step)
    mean = math.fsum(offset * share for offset, share in zip(wander.offsets, wander.shares, strict=True))
    squares = ((offset - mean) ** 2 * share for offset, share in zip(wander.offsets, wander.shares, strict=True))
    deviation = math.sqrt(math.fsum(squares))
    factor = 1 + step / deviation if deviation else 1.0
    return Wander.measured([mean + factor * (offset - mean) for offset in wander.offsets], wander.shares)


def _next_tire(tire: Tire) -> Tire:
    """The tire on the catalogue's next profile; on a belt, on the belt of its size. Raises InputError."""
    treads = {name: shape for name, shape in tires.items() if isinstance(shape, TreadProfile)}
    present = tire.surface.profile.name if isinstance(tire.surface, ProfileSurface) else ""
    if present not in treads:
        raise InputError("the tread is none of the catalogue's profiles; give tire in the steps")
    # A car's tire does not fit a truck, and an aircraft's is inflated to twice the pressure.
    radius, vehicle = treads[present].rolling_radius, treads[present].vehicle
    profiles = [
        name
        for name, shape in treads.items()
        if shape.vehicle == vehicle and abs(shape.rolling_radius / radius - 1) < _ALIKE
    ]
    following = profiles[(profiles.index(present) + 1) % len(profiles)]
    if following == present:
        raise InputError(
            "the catalogue has no other profile of about this radius for the same kind of vehicle; give tire in the "
            "steps"
        )
    belt: Belt | None = None
    if tire.belt is not None:
        size = next((name for name in belts if following.startswith(name)), None)
        if size is None:
            raise InputError(f"the catalogue has no belt for its next profile, {following}; give tire in the steps")
        belt = belts[size]
    return Tire.from_profile(
        following,
        material=tire.material,
        inflation_pressure=tire.inflation_pressure,
        belt=belt,
        tread=tire.tread,
        undertread=tire.undertread,
    )


def _is_viscoelastic(design: Design) -> bool:
    return any(hasattr(layer.material, "complex_modulus") for layer in design.road.layers)


def _faster(row: AxleClass, by: float) -> AxleClass:
    """A class with another speed, m/s; in a turn with the side force and the lean of that speed."""
    assert row.speed is not None
    speed = row.speed + by
    return replace(row, speed=speed, maneuver=_turn_at(row.maneuver, row.speed, speed))


def _turn_at(turn: Maneuver, before: float, after: float) -> Maneuver:
    """A turn at another speed, m/s: Maneuver.turning backwards to the crossfall, and forwards again.

    λ = (V²/gR - c) / (1 + c V²/gR) of the load is side force, and the lean of a vehicle grows with it.
    """
    if not turn.spin:
        return turn
    sign = math.copysign(1.0, turn.spin)
    share = sign * turn.lateral
    pull = [speed**2 * abs(turn.spin) / GRAVITY for speed in (before, after)]
    crossfall = (pull[0] - share) / (1 + pull[0] * share)
    if abs(crossfall) >= 0.5:
        raise InputError(
            f"{turn.name}: its side force is not that of {before * 3.6:g} km/h on its radius (it would need a "
            f"crossfall of {crossfall:.2g}); give the class the speed of its turn"
        )
    # Loads on the road's normal at rest, as factors of the weight: see Maneuver.turning.
    upright = [(1 + each * crossfall) / math.hypot(1, crossfall) for each in pull]
    changed = (pull[1] - crossfall) / (1 + pull[1] * crossfall)
    ratio = turn.load_ratio
    if ratio != 1.0 and share:
        ratio = upright[1] * (1 + (ratio / upright[0] - 1) * changed / share)
    return replace(turn, lateral=sign * changed, load_ratio=ratio)
