"""By how much each remedy changes a design: the default steps, with their reasons."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from treadload.errors import InputError, nearest, positive
from treadload.tire import Tire
from treadload.units import Length, Number, Pressure, Share, Speed

Kind = Literal[
    "thickness", "mix", "bond", "wander", "load", "tire", "pressure", "speed", "braking", "turning", "friction"
]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""Kinds of remedies, in the order in which they are solved."""
# Shares of which less than everything must be left.
_SHARES = ("modulus", "load", "maneuver")


@dataclass(frozen=True)
class RemedySteps:
    """One step of every kind of remedy; the defaults are judgements of this package, not of a source.

    thickness: more of each layer, m; 2 cm is beyond the tolerance of laying, about 1 cm. modulus: share by which a
    layer that is not of the catalogue is stiffer or softer; neighbours in the catalogue are some 20 % apart. mixes:
    name of a layer → material of the catalogue in its place; left out, the neighbours of the same use, see
    `road_changes.neighbours`. wander: more standard deviation, m; 5 cm is a fifth of the usual 25 cm. load: share by
    which wheel loads are lowered; 5 % is the order of what weighing can enforce. tire: in place of that of the
    traffic; left out, the catalogue's next profile. pressure: less inflation pressure, Pa; 1 bar is about an eighth.
    speed: more and less, m/s; 10 km/h is a step of speed limits. maneuver: share by which braking, starting and
    turning are gentler; a quarter is a stopping distance, or a radius, a third longer. friction: more and less; 0.1
    is a step that a change of texture makes. only: kinds to solve; left out, all. Raises InputError.

    >>> f"{len(tl.life.RemedySteps().kinds)} kinds of changes, each by one step"
    '11 kinds of changes, each by one step'
    """

    thickness: Length = 0.02
    modulus: Share = 0.2
    mixes: Mapping[str, str] = field(default_factory=dict)
    wander: Length = 0.05
    load: Share = 0.05
    tire: Tire | None = None
    pressure: Pressure = 1e5
    speed: Speed = 10 / 3.6
    maneuver: Share = 0.25
    friction: Number = 0.1
    only: tuple[Kind, ...] = ()

    def __post_init__(self) -> None:
        for name in ("thickness", "wander", "pressure", "speed", "friction"):
            positive(
                f"the step {name}", getattr(self, name), "SI", f"{getattr(RemedySteps, name):.3g} is the default"
            )
        for name in _SHARES:
            if not 0 < getattr(self, name) < 1:
                raise InputError(
                    f"the step {name} must lie in (0, 1), got {getattr(self, name)}; "
                    f"{getattr(RemedySteps, name):g} is the default"
                )
        stray = next((kind for kind in self.only if kind not in KINDS), None)
        if stray is not None:
            raise InputError(f"no kind of remedy is called {stray!r}; {nearest(stray, KINDS)}")

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """Kinds that are solved."""
        return self.only or KINDS
