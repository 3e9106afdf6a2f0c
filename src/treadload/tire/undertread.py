"""Rubber below the grooves of ribs: how thick it is, and the belt with the thickness of tread that follows."""

from __future__ import annotations

from dataclasses import replace

from treadload.errors import InputError
from treadload.tire.belt import Belt
from treadload.tire.cross_section import TreadSection

# Rubber below the deepest groove of a measured tread, m, where nobody gives it: that of the catalogue's 315/80R22.5,
# 20 mm of tread with grooves of 15 mm.
UNDERTREAD, _THICKEST = 5e-3, 0.1
_INCOMPRESSIBLE = 0.5


def check_rubber_of_ribs(belt: Belt, undertread: float | None) -> None:
    """Refuse a thickness below the grooves, m, or a rubber that ribs cannot have. Raises InputError."""
    if undertread is not None and not 0 <= undertread <= _THICKEST:
        raise InputError(
            f"undertread must lie between 0 and {_THICKEST:g} m, got {undertread:g} m; it is the "
            "rubber below the deepest groove, a few millimetres"
        )
    poisson = belt.tread.poisson
    if poisson >= _INCOMPRESSIBLE:
        raise InputError(
            f"ribs need a Poisson's ratio below {_INCOMPRESSIBLE:g}, got {poisson:g}: give the tread of the belt "
            "Elastic(modulus, 0.495); rubber has 0.49 to 0.4999"
        )


def replaces_thickness(section: TreadSection | None, undertread: float | None) -> bool:
    """True where the undertread makes the thickness of the tread in place of the belt's: given, or as measured."""
    return undertread is not None or (section is not None and section.measured)


def belt_below_ribs(belt: Belt, section: TreadSection | None, undertread: float | None) -> Belt:
    """The belt with the thickness of tread that the undertread leaves, m; its neutral line stays where it is."""
    if section is None or not replaces_thickness(section, undertread):
        return belt
    thickness = section.deepest + (UNDERTREAD if undertread is None else undertread)
    arm = max(0.0, thickness - (belt.tread_thickness - belt.arm))
    return replace(belt, tread_thickness=thickness, arm=arm)
