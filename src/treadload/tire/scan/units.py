"""The unit of a scan: given, from a known diameter, or the only one that makes a tire."""

from __future__ import annotations

from treadload.errors import InputError

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "inch": 0.0254}
_UNIT_NAMES = {
    **{name: name for name in UNITS},
    "metre": "m", "meter": "m", "metres": "m", "meters": "m",
    "millimetre": "mm", "millimeter": "mm", "millimetres": "mm", "millimeters": "mm",
    "centimetre": "cm", "centimeter": "cm", "in": "inch", "inches": "inch",
}  # fmt: skip
GUESSED_DIAMETERS = (0.4, 1.6)
POSSIBLE_DIAMETERS = (0.2, 4.5)
UNIT_MATCH = 0.03


def unit_name(units: str | None) -> str | None:
    """The unit's own name, of any usual spelling. Raises InputError for another."""
    if units is None:
        return None
    name = _UNIT_NAMES.get(str(units).strip().lower())
    if name is None:
        raise InputError(f"unknown units {units!r} of a scan; use one of {', '.join(UNITS)}")
    return name


def scale_of(
    diameter: float, unit: str | None, nominal: float | None, name: str, scale: float | None = None
) -> tuple[str, float, list[str]]:
    """Unit, metres per unit of the file and warnings.

    diameter: outer, in the unit of the file. nominal: m. scale: m per unit, from a length that is known in the scan.
    """
    warnings = []
    if scale is not None:
        if nominal is not None and abs(diameter * scale / nominal - 1) > UNIT_MATCH:
            warnings.append(
                f"by the reference length the outer diameter is {diameter * scale:.4g} m and not the nominal "
                f"{nominal:.4g} m"
            )
        check_diameter(diameter * scale, "measure of the reference length", name)
        return "reference", scale, warnings
    if unit is not None:
        scale = UNITS[unit]
        if nominal is not None and abs(diameter * scale / nominal - 1) > UNIT_MATCH:
            warnings.append(
                f"the outer diameter is {diameter * scale:.4g} m in {unit} and not the nominal {nominal:.4g} m"
            )
    elif nominal is not None:
        off = {key: abs(diameter * value / nominal - 1) for key, value in UNITS.items()}
        unit = min(off, key=lambda key: off[key])
        scale = UNITS[unit]
        if off[unit] > UNIT_MATCH:
            unit, scale = "scaled", nominal / diameter
            warnings.append(
                f"no unit makes {diameter:.4g} in the file the nominal diameter; scaled by {scale:.6g} m per unit"
            )
    else:
        low, high = GUESSED_DIAMETERS
        fits = [key for key, value in UNITS.items() if low <= diameter * value <= high]
        if len(fits) != 1:
            diameters = ", ".join(f"{diameter * value:.3g} m in {key}" for key, value in UNITS.items())
            raise InputError(
                f"the units of {name!r} cannot be determined: its outer diameter of {diameter:.4g} would be "
                f"{diameters}, and {'none' if not fits else 'more than one'} lies between {low} and {high} m; give "
                "units=, nominal_diameter= or scale="
            )
        unit, scale = fits[0], UNITS[fits[0]]
    check_diameter(diameter * scale, unit, name)
    return unit, scale, warnings


def check_diameter(diameter: float, unit: str, name: str) -> None:
    """Raise InputError for an outer diameter, m, that no tire has. unit: of the file."""
    low, high = POSSIBLE_DIAMETERS
    if not low <= diameter <= high:
        raise InputError(
            f"in {unit} the tire of {name!r} would have an outer diameter of {diameter:.3g} m, outside {low} to "
            f"{high} m, for which the bands of a tread (3 mm) are made; give other units=, nominal_diameter= or "
            f"scale=, and scale a model up where {diameter:.3g} m is right"
        )
