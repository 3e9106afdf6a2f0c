"""Modulus of the tire as an elastic half-space, from its inflation pressure."""

from __future__ import annotations

from treadload.errors import InputError, positive

LOWEST_PRESSURE = 10e3
HIGHEST_PRESSURE = 3e6
# Equation 15 was fitted to one 315/80R22.5: 1.076 m, 8.2 bar. Tires of heavy trucks and buses are near it.
TRUCK_DIAMETERS = (0.9, 1.2)
TRUCK_PRESSURES = (500e3, 1000e3)


def check_inflation_pressure(inflation_pressure: float) -> float:
    """Return the inflation pressure (Pa) as a float, or raise InputError when it cannot be one in Pa."""
    try:
        pressure = float(inflation_pressure)
    except (TypeError, ValueError):
        raise InputError(
            f"inflation_pressure must be a number of Pa, got {inflation_pressure!r}; a truck tire is near 820e3"
        ) from None
    positive("inflation_pressure", pressure, "Pa", "a truck is near 820e3")
    if pressure < LOWEST_PRESSURE:
        hint = (
            f"{pressure:g} kPa is {pressure * 1e3:g} Pa"
            if pressure > 50
            else f"{pressure:g} bar is {pressure:g}e5 Pa"
        )
        raise InputError(
            f"inflation_pressure is {pressure:g} Pa, below {LOWEST_PRESSURE:g} Pa; "
            f"give it in Pa, not kPa or bar ({hint})"
        )
    if pressure > HIGHEST_PRESSURE:
        raise InputError(
            f"inflation_pressure is {pressure:g} Pa, above {HIGHEST_PRESSURE:g} Pa (30 bar); "
            "give it in Pa, a truck tire is near 820e3"
        )
    return pressure


def modulus_from_inflation(inflation_pressure: float) -> float:
    """Young's modulus of the half-space that stands for an inflated tire.

    inflation_pressure: Pa, gauge, between 10 kPa and 3 MPa. Returns Pa.
    E [MPa] = 2.7e-3 p [kPa] + 0.7, so 820 kPa gives 2.914 MPa.
    Raises InputError outside these bounds.
    Source: Materials 2021, 14, 2117, equation 15.

    >>> f"{tl.tire.modulus_from_inflation(820e3) / 1e6:.2f} MPa"
    '2.91 MPa'
    """
    return 2.7 * check_inflation_pressure(inflation_pressure) + 0.7e6


def modulus_caveat(inflation_pressure: float, diameter: float | None) -> str | None:
    """A sentence when a tire is not of the kind that `modulus_from_inflation` was fitted to; else None.

    inflation_pressure: Pa. diameter: outer, m; None where it is not known.
    """
    off = unlike_a_truck(inflation_pressure, diameter)
    if off is None:
        return None
    return (
        f"the tire's modulus of {modulus_from_inflation(inflation_pressure) / 1e6:.3g} MPa comes from its inflation "
        f"pressure by a line that was fitted to one truck tire (315/80R22.5 at 820 kPa), and this one has "
        f"{off}: give its material, fitted to a measured deflection or footprint"
    )


def unlike_a_truck(inflation_pressure: float, diameter: float | None) -> str | None:
    """What of a tire is beyond those of trucks, with the bounds; None of nothing.

    inflation_pressure: Pa. diameter: outer, m; None where it is not known.
    """
    off = []
    if diameter is not None and not TRUCK_DIAMETERS[0] <= diameter <= TRUCK_DIAMETERS[1]:
        off.append(f"an outer diameter of {diameter:.2g} m (not {TRUCK_DIAMETERS[0]:g} to {TRUCK_DIAMETERS[1]:g} m)")
    if not TRUCK_PRESSURES[0] <= inflation_pressure <= TRUCK_PRESSURES[1]:
        low, high = (value / 1e3 for value in TRUCK_PRESSURES)
        off.append(f"{inflation_pressure / 1e3:.3g} kPa (not {low:g} to {high:g} kPa)")
    return " and ".join(off) or None
