"""Warnings about a contact: sentences for `Contact.warnings`."""

from __future__ import annotations

import math

import numpy as np

from treadload.contact.rolling_state import Rolling
from treadload.deferred import xarray as xr
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.plausible import caveat, load_caveat
from treadload.tire import Tire
from treadload.tire.belt import RUBBER, Belt, belt_caveat
from treadload.tire.cross_section import TreadSection
from treadload.tire.modulus import modulus_caveat
from treadload.tire.surface import HeightMapSurface
from treadload.tire.undertread import UNDERTREAD

# NaN by design: no material, or nothing that rolls.
_MAY_BE_NAN = {"initial_gap", "gap", "creepage_x", "creepage_y", "slip_x", "slip_y", "approach"}

# Mean pressure of a footprint over the inflation pressure: a sensor below 315/80R22.5 at 35 kN gave 0.73 (Materials
# 2021, 14, 2117), rated loads give 1.0 to 1.3 (as commonly quoted), overload more.
_MEAN_OVER_INFLATION = (0.6, 1.6)
# Grooves that are shallower than this part of the tread's thickness may close: below a truck's pressure the faces of
# ribs sink by 4 % of it, and rubber rises between them.
_MAY_CLOSE = 0.1


def of_tire(tire: Tire) -> list[str]:
    """What is known of the tire's surface, and where its modulus comes from when nobody gave it."""
    warnings = [] if tire.quality is None else list(tire.quality.warnings)
    surface = tire.surface
    if isinstance(surface, HeightMapSurface) and surface.is_steep:
        length, width = surface.extent
        warnings.append(
            f"the heights of the tread differ by {surface.relief:.4g} m on a map of {length:.3g} x {width:.3g} m; if "
            'they are in mm, give units={"gap": "mm"}'
        )
    if tire.material is None and tire.belt is None and tire.inflation_pressure is not None:
        radius = tire.outer_radius
        caveat_of_modulus = modulus_caveat(tire.inflation_pressure, None if radius is None else 2 * radius)
        warnings += [] if caveat_of_modulus is None else [caveat_of_modulus]
    if tire.belt is not None and tire.inflation_pressure is not None:
        radius = tire.outer_radius
        caveat_of_modulus = belt_caveat(tire.belt, tire.inflation_pressure, None if radius is None else 2 * radius)
        warnings += [] if caveat_of_modulus is None else [caveat_of_modulus]
    if tire.tread == "ribs" and tire.belt is not None:
        warnings += of_rubber("ribs", tire.belt)
    section = tire.cross_section if tire.tread == "ribs" else None
    if section is not None and tire.belt is not None:
        warnings += [*of_tie_bars(section), *_of_shallow_grooves(section, tire.ribs[0].section.height)]
    if section is not None and section.measured:
        warnings += section.caveats
        if tire.undertread is None:
            warnings.append(
                f"the ribs stand on {UNDERTREAD * 1e3:g} mm of rubber below the deepest groove "
                f"({section.deepest * 1e3:.1f} mm), which is assumed, as no scan shows it: give undertread where it "
                "is known"
            )
    return warnings


def of_rubber(what: str, belt: Belt) -> list[str]:
    """That "ribs" or "blocks" are not of rubber, but of what stands for a layer with grooves."""
    poisson = belt.tread.poisson
    if poisson >= RUBBER:
        return []
    return [
        f"the {what} have a Poisson's ratio of {poisson:g}, as of a layer that stands for grooves as well; "
        f"rubber has {RUBBER:g} to 0.4999: give the belt ribs_poisson = 0.495"
    ]


def of_tie_bars(section: TreadSection) -> list[str]:
    """That tie bars are taken as continuous along travel, with what bounds their effect."""
    tied = [channel for channel in section.channels if channel.tie_bar > 0]
    if not tied:
        return []
    heights = sorted({round(channel.tie_bar * 1e3, 3) for channel in tied})
    return [
        f"tie bars of {' and '.join(f'{height:g}' for height in heights)} mm in {len(tied)} of "
        f"{len(section.channels)} grooves are taken as continuous along travel: an upper bound of the stiffness of "
        "bars that are interrupted; tie_bar = 0 gives the lower bound"
    ]


def _of_shallow_grooves(section: TreadSection, thickness: float) -> list[str]:
    """That the road may reach the bottom of a groove, which carries no pressure. thickness: of the tread, m."""
    shallowest = min(section.channels, key=lambda channel: channel.clear_depth, default=None)
    if shallowest is None or shallowest.clear_depth >= _MAY_CLOSE * thickness:
        return []
    bottom = "tie bar" if shallowest.tie_bar > 0 else "floor"
    return [
        f"the groove at y = {shallowest.centre * 1e3:g} mm is {shallowest.clear_depth * 1e3:.3g} mm deep down to its "
        f"{bottom}, less than {_MAY_CLOSE:.0%} of the tread's thickness of {thickness * 1e3:.3g} mm: it may close "
        f"under load, and the {bottom} of a groove carries no pressure; leave the groove out where it closes"
    ]


def of_rolling(tire: Tire, rolling: Rolling) -> list[str]:
    """What does not fit between a tire and how it rolls: camber without the spin that it makes."""
    belongs = tire.camber_spin
    if belongs == 0 or rolling.spin != 0:
        return []
    return [
        f"the tire leans by {math.degrees(tire.camber):.3g}° and rolls without spin; on a straight path its camber "
        f"makes a spin of {belongs:.3g} rad/m, -sin(camber)/R: give Rolling(spin={belongs:.3g})"
    ]


def of_numbers(tire: Tire, rolling: Rolling, grid: Grid) -> list[str]:
    """Loads, pressures, speeds, cells that no tire has, with the unit that was likely meant."""
    length, width = tire.extent
    warnings = caveat("width of the surface", width) or caveat("width of the surface", length)
    if rolling.normal_load is not None:
        warnings += load_caveat(rolling.normal_load, width)
    if tire.inflation_pressure is not None:
        warnings += caveat("inflation pressure", tire.inflation_pressure)
    if isinstance(tire.material, Elastic):
        warnings += caveat("modulus of the tire", tire.material.modulus)
    warnings += caveat("friction", rolling.law.largest)
    if rolling.speed is not None:
        warnings += caveat("speed", rolling.speed)
    warnings += caveat("size of the cells", min(grid.dx, grid.dy)) or caveat(
        "size of the cells", max(grid.dx, grid.dy)
    )
    return list(warnings)


def of_mean_pressure(tire: Tire, load: float, area: float) -> list[str]:
    """A mean pressure that no inflated tire has, by its inflation pressure. load: N. area: in contact, m²."""
    inflation = tire.inflation_pressure
    if inflation is None or not (area > 0 and load > 0 and inflation > 0):
        return []
    ratio, (low, high) = load / area / inflation, _MEAN_OVER_INFLATION
    if low <= ratio <= high:
        return []
    remedy = (
        "the tread's modulus, and that it has no belt, hold for loads near the rated one: give a belt or a modulus"
        if tire.belt is None
        else "look at the load, the inflation pressure and the belt"
    )
    return [
        f"the mean contact pressure is {ratio:.2g} times the inflation pressure, {low:g} to {high:g} is "
        f"usual: the footprint is too {'large' if ratio < low else 'small'} for this load; {remedy}"
    ]


def of_fields(data: xr.Dataset) -> list[str]:
    """Results that are not numbers, by name; those that are NaN by design do not count."""
    warnings = []
    infinite = [str(name) for name, part in data.data_vars.items() if np.isinf(part.values).any()]
    if infinite:
        warnings.append(
            f"{', '.join(infinite)} {'is' if len(infinite) == 1 else 'are'} infinite: beyond the largest number of "
            "this machine, 1.8e308; look at the speed"
        )
    unknown = [
        str(name) for name, part in data.data_vars.items() if name not in _MAY_BE_NAN and np.isnan(part.values).any()
    ]
    if unknown:
        warnings.append(f"{', '.join(unknown)} could not be computed and {'is' if len(unknown) == 1 else 'are'} NaN")
    return warnings
