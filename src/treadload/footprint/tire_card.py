"""What a tire states of itself: deflection, footprint and stiffnesses over loads and inflation pressures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.contact import Contact, Rolling, solve_contact, solve_transient
from treadload.contact.solvers.coupling import Progress
from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.footprint.measures import find_ribs, measure, shares
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tire import Tire

# Friction and creepage at which the contact sticks all but its trailing cells: the slope at zero slip.
_FRICTION, _CREEPAGE = 1.0, 1e-3
# Force sideways of a standing wheel, over its load: small, so that it sticks.
_PUSH = 0.02

_ROWS = (
    "approach", "effective_radius_ratio", "print_length", "net_area", "mean_over_inflation", "shoulder_over_centre",
    "pneumatic_trail", "lateral_stiffness", "relaxation_length",
)  # fmt: skip
_OVER_LOAD = ("longitudinal_stiffness", "cornering_stiffness")


@dataclass(frozen=True, eq=False)
class TireCard(BaseResult, group="tire_card"):
    """What a tire states of itself.

    dataset: over (inflation_pressure, wheel_load), and rib shares over rib as well; see `treadload.variables`. The
    attributes `tydex` and `iso_8855` of a variable are its names there. warnings: of all contacts.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    >>> card = tl.footprint.tire_card(tire, road, [50.0, 100.0], stiffness=False, spacing=0.006)
    >>> [f"{load:.0f} N" for load in card.dataset.wheel_load.values]
    ['50 N', '100 N']
    """

    title: ClassVar[str] = "Tire card"
    holds: ClassVar[Holds] = Holds(
        {"wheel_load": "wheel_load", "inflation_pressure": "inflation_pressure"},
        maybe={" ".join((*_ROWS, *_OVER_LOAD)): "inflation_pressure wheel_load"},
        positive="wheel_load",
    )

    dataset: xr.Dataset
    tire: Tire
    road: Pavement
    warnings: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """The tire."""
        return f"{self.tire.name or 'a tire'}, rolling freely"

    def rows(self) -> tuple[Row, ...]:
        """Deflection, footprint and stiffnesses at each inflation pressure and load."""
        data, rows = self.dataset, []
        for pressure in range(data.sizes["inflation_pressure"]):
            for number in range(data.sizes["wheel_load"]):
                at = data.isel(inflation_pressure=pressure, wheel_load=number)
                group = ", ".join(row(name, at[name]).text for name in ("inflation_pressure", "wheel_load"))
                values = {name: at[name] for name in _ROWS if name in at.variables} | {
                    f"{name}_over_load": at[name] / at["wheel_load"] for name in _OVER_LOAD if name in at.variables
                }
                rows += [row(name, value, group=group) for name, value in values.items()]
        return tuple(rows)


def tire_card(
    tire: Tire,
    road: Pavement,
    loads: Sequence[float] | Array,
    pressures: Sequence[float] | Array | None = None,
    *,
    stiffness: bool = True,
    spacing: float | None = None,
    tolerance: float = 1e-6,
    progress: Progress | None = None,
) -> TireCard:
    """Deflection, rolling radius, footprint and stiffnesses of a freely rolling tire.

    loads: of the wheel, N, distinct, > 0. pressures: of inflation, Pa; left out, the tire's own. A tire of a material
    of its own does not depend on its inflation and takes one pressure at most. stiffness: False leaves out what costs
    most, slip and lateral stiffnesses. spacing, tolerance, progress: as in `solve_contact`.
    Slip stiffnesses are slopes at free rolling under friction of 1, by central differences over ±0.001 of creepage.
    The lateral stiffness is that of the standing tire under 2 % of its load; the relaxation length is the cornering
    stiffness over it. Ribs are those of the heaviest load; outer ones over the middle is the ratio of their loads.
    Raises InputError for loads or pressures that are not positive, and as `solve_contact`.
    Sources of terms: ISO 8855:2011; Pacejka (2012), Tire and Vehicle Dynamics, chapters 1 and 5.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    >>> card = tl.footprint.tire_card(tire, road, [100.0], stiffness=False, spacing=0.006)
    >>> f"{card.dataset.loaded_radius.item() * 1e3:.0f} mm loaded, 300 mm unloaded"
    '299 mm loaded, 300 mm unloaded'
    """
    forces = listed_loads(loads)
    inflation = [tire.inflation_pressure or math.nan] if pressures is None else listed_pressures(pressures)
    if len(inflation) > 1 and tire.material is not None:
        raise InputError(
            f"this tire is a half-space of {tire.material} whatever its inflation: the {len(inflation)} pressures "
            "would give one card; leave the material out, or give a belt"
        )
    shown: list[str] = []
    rows: list[list[dict[str, float]]] = []
    prints: list[list[Contact]] = []
    for pressure in inflation:
        inflated = replace(tire, inflation_pressure=pressure) if math.isfinite(pressure) else tire
        rows.append([])
        prints.append([])
        for load in forces:
            if progress is not None:
                progress(f"tire card, {pressure / 1e3:.0f} kPa, {load / 1e3:.3g} kN")
            contact, row = _at(inflated, road, load, stiffness, spacing, tolerance)
            shown += [text for text in contact.warnings if text not in shown]
            rows[-1].append(row)
            prints[-1].append(contact)
    widest = max((footprint for line in prints for footprint in line), key=lambda print_: print_.area)
    edges = find_ribs(
        widest.dataset["pressure"].to_numpy(), widest.dataset["y"].to_numpy(), widest.dataset.attrs["dy"]
    )
    carried = np.array([[_shares(footprint, edges) for footprint in line] for line in prints])
    fields: dict[str, Any] = {
        name: (("inflation_pressure", "wheel_load"), np.array([[row[name] for row in line] for line in rows]))
        for name in rows[0][0]
    }
    fields["rib_share"] = (("inflation_pressure", "wheel_load", "rib"), carried)
    fields["rib_left"], fields["rib_right"] = (("rib",), edges[:-1]), (("rib",), edges[1:])
    middle = carried.shape[-1] // 2
    centre = carried[..., middle] if carried.shape[-1] % 2 else carried[..., middle - 1 : middle + 1].mean(-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = 0.5 * (carried[..., 0] + carried[..., -1]) / centre
    fields["shoulder_over_centre"] = (("inflation_pressure", "wheel_load"), ratio)
    at = {"inflation_pressure": inflation, "wheel_load": forces, "rib": np.arange(carried.shape[-1])}
    data = variables.dataset(fields, at)
    for name, (standard, tydex) in _NAMES.items():
        if name in data.variables:
            data[name].attrs |= {key: word for key, word in (("iso_8855", standard), ("tydex", tydex)) if word}
    return TireCard(data, tire, road, tuple(shown))


# Names of ISO 8855 and channels of TYDEX, where they have one.
_NAMES = {
    "wheel_load": ("vertical tyre force", "FZW"),
    "inflation_pressure": ("inflation pressure", "INFLPRES"),
    "loaded_radius": ("loaded radius", "DSTGRWHC"),
    "effective_rolling_radius": ("effective rolling radius", ""),
    "longitudinal_stiffness": ("longitudinal force coefficient, slope at zero slip", ""),
    "cornering_stiffness": ("cornering stiffness", ""),
    "aligning_stiffness": ("aligning stiffness", ""),
    "pneumatic_trail": ("pneumatic trail", ""),
}


def _at(
    tire: Tire, road: Pavement, load: float, stiffness: bool, spacing: float | None, tolerance: float
) -> tuple[Contact, dict[str, float]]:
    """The freely rolling contact under a load, and a row of the card."""
    wheel = Rolling(normal_load=load, friction=_FRICTION)

    def solve(state: Rolling, start: Contact | None = None) -> Contact:
        return solve_contact(tire, road, state, spacing=spacing, tolerance=tolerance, start=start)

    free = solve(wheel)
    data = free.dataset
    pressure, x, y = (data[name].to_numpy() for name in ("pressure", "x", "y"))
    print_ = measure(pressure, x, y, data.attrs["dx"], data.attrs["dy"])
    radius = math.nan if tire.outer_radius is None else tire.outer_radius
    creepage, approach = float(data["creepage_x"]), float(data["approach"])
    row = {
        "approach": approach,
        "loaded_radius": radius - approach,
        "secant_stiffness": load / approach,
        "creepage_x": creepage,
        "effective_rolling_radius": radius / (1 - creepage),
        "effective_radius_ratio": 1 / (1 - creepage),
        "print_length": print_.length,
        "print_width": print_.width,
        "net_area": print_.net_area,
        "gross_area": print_.gross_area,
        "mean_pressure": print_.mean,
        "mean_over_inflation": print_.mean / (tire.inflation_pressure or math.nan),
        "gross_mean_over_inflation": load / print_.gross_area / (tire.inflation_pressure or math.nan),
    }
    if not stiffness:
        return free, row
    along = [solve(replace(wheel, creepage_x=creepage + step), free).dataset for step in (-_CREEPAGE, _CREEPAGE)]
    across = [solve(replace(wheel, creepage_y=step), free).dataset for step in (-_CREEPAGE, _CREEPAGE)]

    def slope(pair: list[xr.Dataset], name: str) -> float:
        return abs(float(pair[1][name]) - float(pair[0][name])) / (2 * _CREEPAGE)

    pushed = solve_transient(
        tire, road, replace(wheel, lateral_force=_PUSH * load), distances=[0.0], spacing=spacing, tolerance=tolerance
    )
    cornering, aligning = slope(across, "lateral_force"), slope(across, "aligning_moment")
    lateral = _PUSH * load / abs(float(pushed.dataset["shift_y"][-1]))
    row |= {
        "longitudinal_stiffness": slope(along, "tractive_force"),
        "cornering_stiffness": cornering,
        "aligning_stiffness": aligning,
        "pneumatic_trail": aligning / cornering,
        "lateral_stiffness": lateral,
        "relaxation_length": cornering / lateral,
    }
    return free, row


def _shares(contact: Contact, edges: Array) -> Array:
    pressure, y = contact.dataset["pressure"].to_numpy(), contact.dataset["y"].to_numpy()
    return shares(pressure, np.repeat(y[:, None], pressure.shape[1], axis=1), edges)


def listed_loads(loads: Sequence[float] | Array) -> list[float]:
    """Loads of the wheel, N, sorted. Raises InputError for none, for equal ones, and for those that are not > 0."""
    return _listed("loads", loads, "N")


def listed_pressures(pressures: Sequence[float] | Array) -> list[float]:
    """Inflation pressures, Pa, sorted. Raises InputError as `listed_loads`."""
    return _listed("pressures", pressures, "Pa")


def _listed(name: str, values: Sequence[float] | Array, unit: str) -> list[float]:
    try:
        numbers = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError):
        raise InputError(f"{name} must be numbers of {unit}, got {values!r}") from None
    if numbers.ndim != 1 or numbers.size == 0:
        raise InputError(f"{name} must be a list of at least one number of {unit}, got {values!r}")
    for value in numbers:
        positive(f"each of the {name}", float(value), unit)
    if np.unique(numbers).size != numbers.size:
        raise InputError(f"{name} must differ from each other, got {values!r}")
    return [float(value) for value in np.sort(numbers)]
