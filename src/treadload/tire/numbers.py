"""Numbers of a tire that a fit may change: by name, read from a tire and put into it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.tire.belt import Belt
from treadload.tire.tire import Tire
from treadload.tire.tread import ProfileSurface, TreadProfile
from treadload.units import Unit

# Least Poisson's ratio of rubber with its fillers that is sought.
_OF_RUBBER = 0.45


@dataclass(frozen=True)
class TireNumber:
    """A number of a tire.

    unit: as a case writes it. words: what it is. low, high: it stays between them, SI. read: its value, None where
    the tire has none. put: the tire with another. below, above: bounds that depend on the tire.
    """

    name: str
    unit: Unit
    words: str
    low: float
    high: float
    read: Callable[[Tire], float | None]
    put: Callable[[Tire, float], Tire]
    below: Callable[[Tire], float] = lambda tire: math.inf
    above: Callable[[Tire], float] = lambda tire: -math.inf

    def of(self, tire: Tire) -> float:
        """Its value, SI. Raises InputError where the tire has none."""
        value = self.read(tire)
        if value is None:
            having = [quantity.name for quantity in NUMBERS.values() if quantity.read(tire) is not None]
            raise InputError(
                f"this tire has no {self.name} ({self.words}), so that none can be fitted; it has {', '.join(having)}"
            )
        return value

    def bounds(self, tire: Tire) -> tuple[float, float]:
        """Between what it stays, SI."""
        return max(self.low, self.above(tire)), min(self.high, self.below(tire))


def _belt(name: str) -> tuple[Callable[[Tire], float | None], Callable[[Tire, float], Tire]]:
    def read(tire: Tire) -> float | None:
        return None if tire.belt is None else getattr(tire.belt, name)

    def put(tire: Tire, value: float) -> Tire:
        return _on(tire, **{name: value})

    return read, put


def _on(tire: Tire, **changes: object) -> Tire:
    assert tire.belt is not None
    return replace(tire, belt=replace(tire.belt, **changes))  # type: ignore[arg-type]  # names of numbers of a belt


def _bending(number: int) -> tuple[Callable[[Tire], float | None], Callable[[Tire, float], Tire]]:
    def read(tire: Tire) -> float | None:
        return None if tire.belt is None else tire.belt.bending[number]

    def put(tire: Tire, value: float) -> Tire:
        assert tire.belt is not None
        values = list(tire.belt.bending)
        values[number] = value
        return _on(tire, bending=tuple(values))

    return read, put


def _lateral(name: str) -> tuple[Callable[[Tire], float | None], Callable[[Tire, float], Tire]]:
    def read(tire: Tire) -> float | None:
        return None if tire.belt is None or tire.belt.lateral is None else getattr(tire.belt.lateral, name)

    def put(tire: Tire, value: float) -> Tire:
        assert tire.belt is not None
        assert tire.belt.lateral is not None
        return _on(tire, lateral=replace(tire.belt.lateral, **{name: value}))

    return read, put


def _elastic(tire: Tire) -> Elastic | None:
    """What the tread is made of, or the half-space that stands for the tire; None of what is not elastic."""
    if tire.belt is not None:
        rubber = tire.belt.tread
    elif tire.material is None and tire.inflation_pressure is None:
        return None
    else:
        rubber = tire.carcass  # type: ignore[assignment]  # a tire without a belt
    return rubber if isinstance(rubber, Elastic) else None


def _of_material(name: str) -> tuple[Callable[[Tire], float | None], Callable[[Tire, float], Tire]]:
    def read(tire: Tire) -> float | None:
        elastic = _elastic(tire)
        return None if elastic is None else getattr(elastic, name)

    def put(tire: Tire, value: float) -> Tire:
        elastic = _elastic(tire)
        assert elastic is not None
        changed = replace(elastic, **{name: value})
        return replace(tire, material=changed) if tire.belt is None else _on(tire, tread=changed)

    return read, put


def _tread(tire: Tire) -> TreadProfile | None:
    return tire.surface.profile if isinstance(tire.surface, ProfileSurface) else None


def _reshaped(tire: Tire, **changes: object) -> Tire:
    tread = _tread(tire)
    assert tread is not None
    return replace(tire, surface=ProfileSurface(replace(tread, **changes)))  # type: ignore[arg-type]  # its numbers


def _profile(name: str) -> tuple[Callable[[Tire], float | None], Callable[[Tire, float], Tire]]:
    def read(tire: Tire) -> float | None:
        tread = _tread(tire)
        return None if tread is None else getattr(tread, name)

    return read, lambda tire, value: _reshaped(tire, **{name: value})


def _crown_read(tire: Tire) -> float | None:
    tread = _tread(tire)
    if tread is not None:
        return tread.crown_radius
    belt: Belt | None = tire.belt
    return None if belt is None else belt.crown_radius or tire.crown_arc_radius


def _crown_put(tire: Tire, value: float) -> Tire:
    return _on(tire, crown_radius=value) if _tread(tire) is None else _reshaped(tire, crown_radius=value)


def _edge_read(tire: Tire) -> float | None:
    tread = _tread(tire)
    return None if tread is None or not tread.grooves else tread.grooves[0].edge_radius


def _edge_put(tire: Tire, value: float) -> Tire:
    tread = _tread(tire)
    assert tread is not None
    return _reshaped(tire, grooves=tuple(replace(groove, edge_radius=value) for groove in tread.grooves))


def _camber_read(tire: Tire) -> float | None:
    return tire.camber if hasattr(tire.surface, "camber") and tire.fixed_grid is None else None


def _camber_put(tire: Tire, value: float) -> Tire:
    return replace(tire, surface=replace(tire.surface, camber=value))  # type: ignore[type-var]  # a scan


def _arc_read(tire: Tire) -> float | None:
    """Endless where the belt has none of its own."""
    return None if tire.belt is None else tire.belt.belt_radius or math.inf


def _half_width(tire: Tire) -> float:
    tread = _tread(tire)
    return math.inf if tread is None else 0.5 * tread.width


def _least_poisson(tire: Tire) -> float:
    """Ribs are rubber; a layer's ν may stand for grooves as well."""
    return _OF_RUBBER if tire.tread == "ribs" else -math.inf


def _arm(tire: Tire) -> float:
    return 0.0 if tire.belt is None else tire.belt.arm


def _thickness_read(tire: Tire) -> float | None:
    """None where the undertread and the grooves of ribs make it."""
    return None if tire.belt is None or tire.has_undertread else tire.belt.tread_thickness


def _thickness(tire: Tire) -> float:
    return math.inf if tire.belt is None else tire.belt.tread_thickness


_LENGTH, _RADIUS = Unit("m"), Unit("m", "radius")
_ROWS = (
    TireNumber("modulus", Unit("Pa", "modulus"), "Young's modulus of the tread, or of the half-space that stands for "
               "the tire", 0.1e6, 1e9, *_of_material("modulus")),
    TireNumber("poisson", Unit(""), "Poisson's ratio of the same", 0.1, 0.4999, *_of_material("poisson"),
               above=_least_poisson),
    TireNumber("foundation", Unit("1/m"), "hold of the sidewalls per inflation pressure", 0.05, 100.0,
               *_belt("foundation")),
    TireNumber("sidewall_stiffness", Unit("Pa/m"), "hold of the sidewalls without inflation", 0.0, 1e8,
               *_belt("sidewall_stiffness")),
    TireNumber("meridional", _LENGTH, "tension across per inflation pressure", 1e-3, 1.0, *_belt("meridional")),
    TireNumber("bending_along", Unit("N m"), "bending stiffness of the belt along", 0.1, 1e5, *_bending(0)),
    TireNumber("bending_twist", Unit("N m"), "bending stiffness of the belt in twist", 0.0, 1e5, *_bending(1)),
    TireNumber("bending_across", Unit("N m"), "bending stiffness of the belt across", 0.1, 1e5, *_bending(2)),
    TireNumber("tread_thickness", _LENGTH, "thickness of the tread", 1e-3, 0.1, _thickness_read,
               _belt("tread_thickness")[1], above=_arm),
    TireNumber("arm", _LENGTH, "from the surface of the tread to the neutral line of the belt", 0.0, 0.1,
               *_belt("arm"), below=_thickness),
    TireNumber("belt_radius", _RADIUS, "radius of the belt's own arc across", 0.2, 1e3, _arc_read,
               _belt("belt_radius")[1]),
    TireNumber("lateral_stiffness", Unit("Pa"), "lateral foundation of the belt", 1e3, 1e8,
               *_lateral("stiffness")),
    TireNumber("lateral_length", _LENGTH, "length over which a lateral deflection fades", 0.01, 10.0,
               *_lateral("length")),
    TireNumber("crown_radius", _RADIUS, "radius of the tread arc across", 0.1, 100.0, _crown_read, _crown_put),
    TireNumber("shoulder_radius", _LENGTH, "rounding of the shoulders", 0.0, 0.5, *_profile("shoulder_radius"),
               below=_half_width),
    TireNumber("edge_radius", _LENGTH, "rounding of the edges of all grooves", 0.0, 0.05, _edge_read, _edge_put),
    TireNumber("rolling_radius", _LENGTH, "radius of the unloaded crown", 0.05, 3.0, *_profile("rolling_radius")),
    TireNumber("camber", Unit("rad"), "lean of the wheel to the right", -0.5, 0.5, _camber_read, _camber_put),
)  # fmt: skip
NUMBERS = {row.name: row for row in _ROWS}
"""All by their names."""
