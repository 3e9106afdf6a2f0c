"""Units that the variables of a file carry: what makes their values SI."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping

from treadload.errors import InputError
from treadload.units import quantity

# Units that a person is likely to want, by the SI unit.
_SUCH_AS = {"m": "m, mm, cm or inch", "Pa": "Pa, kPa, MPa, bar or psi"}
_KIND = {"m": "length", "Pa": "pressure"}
_EXAMPLE = {"m": "mm", "Pa": "kPa"}
_ROUND_OFF = 1e-9
# As CF writes powers and products: "N m-2", "N.m-2", "kg m-1 s-2".
_CF_POWER = re.compile(r"(?<=[A-Za-zµ])(?:\*\*|\^)?([+-]?[0-9]+)(?![0-9A-Za-z])")
_CF_TIMES = re.compile(r"(?<=[A-Za-z0-9])\.(?=[A-Za-z])")
_WORD = re.compile(r"[A-Za-z]{4,}")
_SCALE = re.compile(r"(?P<scale>(?:[0-9]*[.])?[0-9]+(?:[eE][+-]?[0-9]+)?)?\s*(?P<unit>.*)", re.DOTALL)


def factor(unit: str, si: str) -> float:
    """What a number in a unit, as a file spells it, is multiplied by to be in the SI unit.

    unit: such as "kPa", "N m-2", "Pascal" or "1e-3 m" (CF, UDUNITS). Raises InputError for another kind of unit.
    """
    match = _SCALE.match(unit.strip())
    assert match is not None
    text = _CF_TIMES.sub(" ", match["unit"])
    text = _CF_POWER.sub(lambda power: f"^{power[1].lstrip('+')}", text)
    scaled = f"{match['scale'] or 1} {text}"
    try:
        return _positive(quantity(scaled, si))
    except InputError:
        # Names in full are written with a capital, too.
        return _positive(quantity(_WORD.sub(lambda word: word[0].lower(), scaled), si))


def _positive(value: float) -> float:
    if not value > 0:
        raise InputError(f"a unit must be larger than 0, got {value:g}")
    return value


def factor_of(name: str, named: object, si: str, units: Mapping[str, str], *, where: str, bare: str | None) -> float:
    """What the values of a variable are multiplied by to be SI.

    name: of the variable. named: the unit that the file names, None if it names none. si: the unit wanted, "m" or
    "Pa". units: name → unit from the caller, where the file names none that can be read. where: the file, for errors.
    bare: the unit of numbers for which neither names one; None: refuse them.
    Raises InputError with the remedy.
    """
    example = f'units={{"{name}": "{_EXAMPLE[si]}"}}'
    wanted = factor_of_argument(name, units[name], si) if name in units else None
    if named is None or (isinstance(named, str) and not named.strip()):
        if wanted is not None:
            return wanted
        if bare is not None:
            return factor(bare, si)
        raise InputError(
            f"{where}: {name} names no unit; write its attribute units ({_SUCH_AS[si]}), or give {example}"
        )
    try:
        stated = factor(named, si) if isinstance(named, str) else None
    except InputError:
        stated = None
    if stated is None and wanted is None:
        raise InputError(
            f"{where}: {name} is in {named!r}, which is not a unit of {_KIND[si]} such as {_SUCH_AS[si]}; correct "
            f"its attribute units, or give {example}"
        )
    if stated is not None and wanted is not None and abs(wanted - stated) > _ROUND_OFF * stated:
        raise InputError(f"{where}: {name} names a unit of its own, {named!r}; leave it out of units")
    return stated if stated is not None else wanted or 1.0


def factor_of_argument(name: str, unit: object, si: str) -> float:
    """Factor to SI units of a number whose unit is an argument. Raises InputError."""
    try:
        if isinstance(unit, str):
            return factor(unit, si)
    except InputError:
        pass
    raise InputError(f"units has {unit!r} for {name}, which is not a unit of {_KIND[si]} such as {_SUCH_AS[si]}")


def check_names(units: Mapping[str, str], names: Collection[str], what: str) -> None:
    """Refuse a unit for a name that is not there. what: the known names are, for the error."""
    stray = [name for name in units if name not in names]
    if stray:
        raise InputError(f"units names {stray[0]!r}; {what} are {', '.join(names)}")
