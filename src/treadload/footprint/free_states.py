"""A solved tire that rolls freely or stands: deflection, rolling radius, carcass stiffnesses, rolling resistance."""

from __future__ import annotations

from dataclasses import dataclass, replace

from treadload.contact import Contact, Rolling, solve_transient
from treadload.materials import Prony
from treadload.pavement import Pavement
from treadload.tire import Tire

# Friction, and force of a standing wheel over its load: small, so that the contact sticks all but its edges.
_FRICTION, _PUSH = 1.0, 0.02


@dataclass(frozen=True)
class FreeState:
    """A tire under a load and an inflation pressure, without slip.

    normal_load: N. inflation_pressure: Pa; None of a tire without. deflection, effective_rolling_radius: m.
    fore_aft_stiffness, lateral_stiffness: of the standing tire, N/m, where its rubber has relaxed.
    resisting_moment: of rolling resistance, N m; None of an elastic tire.
    """

    normal_load: float
    inflation_pressure: float | None
    deflection: float
    effective_rolling_radius: float
    fore_aft_stiffness: float
    lateral_stiffness: float
    resisting_moment: float | None = None


def free_state(
    tire: Tire, road: Pavement, load: float, contact: Contact, radius: float, spacing: float | None
) -> FreeState:
    """The state of a tire whose freely rolling contact is solved. load: N. radius: of the unloaded tire, m."""
    data = contact.dataset
    standing = relaxed(tire)
    free, push = Rolling(normal_load=load, friction=_FRICTION), _PUSH * load

    def stiffness(wheel: Rolling, shift: str) -> float:
        moved = solve_transient(standing, road, wheel, distances=[0.0], spacing=spacing).dataset[shift]
        return push / abs(float(moved[-1]))

    return FreeState(
        load,
        tire.inflation_pressure,
        float(data["approach"]),
        radius / (1 - float(data["creepage_x"])),
        stiffness(replace(free, tractive_force=push), "shift_x"),
        stiffness(replace(free, lateral_force=push), "shift_y"),
        None if standing is tire else float(data["rolling_resistance_moment"]),
    )


def relaxed(tire: Tire) -> Tire:
    """A tire whose rubber has relaxed; the tire itself where its rubber is elastic."""
    if tire.belt is not None and isinstance(tire.belt.tread, Prony):
        return replace(tire, belt=replace(tire.belt, tread=tire.belt.tread.rubbery))
    if isinstance(tire.material, Prony):
        return replace(tire, material=tire.material.rubbery)
    return tire
