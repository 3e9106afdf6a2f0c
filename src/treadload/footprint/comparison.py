"""A computed contact beside a footprint, both as the sensor reads them."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal

import numpy as np

from treadload import variables
from treadload.composing import BaseResult, Holds, has_fields
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.footprint.footprint import Footprint, checked_pin
from treadload.footprint.measures import Measures, check_ribs, find_ribs, measure, shares, turn
from treadload.footprint.reading import read_footprint
from treadload.footprint.registration import Registration, cut_off, laid, overlap, register, register_pins, through
from treadload.footprint.rib_shear import shear_by_ribs, shear_rows
from treadload.footprint.spelling import KGF_CM2
from treadload.footprint.thirds import THIRDS
from treadload.kernels.arrays import Array
from treadload.response import GridLoad
from treadload.rows import Row, row
from treadload.units import PSI, quantity

MAPS = ("computed", "seen", "measured")
"""A contact on its own cells; as the sensor would record it; what the sensor recorded."""

# Loads that differ by more are reported: what mats of sensors repeat a load to, after calibration.
_LOAD_DIFFERENCE = 0.05
# Judgement: share of the pressure that overlaps, and difference of the areas. Two prints of one tire on a mat reach
# the first, prints of tires with other grooves stay below the second.
_AGREES, _ROUGHLY = (0.85, 0.05), (0.70, 0.15)
# A print askew by more is reported, rad: over 300 mm a sensel of 5 mm.
_ASKEW = 0.017
# A share of the contact beyond the sensor that is reported.
_BEYOND = 0.01
# What a pressure may have been written in, over what it was read in.
_UNITS = {"kPa": 1e3, "MPa": 1e6, "kgf/cm2": KGF_CM2, "bar": 1e5, "psi": PSI, "Pa": 1.0}
_UNIT_FITS = 0.12


@dataclass(frozen=True, eq=False)
class FootprintComparison(BaseResult, group="comparison"):
    """A computed contact and a measured footprint, sensel by sensel.

    dataset: maps over the sensels (y, x), their measures over `map` (computed on its own cells, seen by the sensor,
    measured), shares of the ribs, forces on the thirds of each where there is shear, and how well they agree; see
    `treadload.variables`. footprint: as it was laid.
    registration: how. warnings: sentences for the user.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> measured = tl.Footprint(tl.response.GridLoad(load.grid, 0.9 * load.pressure))
    >>> f"{tl.compare(load, measured, registration='none').dataset.overlap_of_area.item():.0%} of the area overlaps"
    '100% of the area overlaps'
    """

    title: ClassVar[str] = "Computed and measured footprint"
    holds: ClassVar[Holds] = Holds(
        {
            "print_load net_area gross_area print_length print_width mean_pressure largest_pressure": "map",
            "rib": "rib",
            "rib_share": "map rib",
            "overlap_of_pressure overlap_of_area rms_difference correlation": "",
        },
        maybe={
            "third_load third_force_x third_force_y": "map rib third",
            "rib_outward_shear rib_largest_pressure rib_largest_traction_x rib_largest_traction_y": "map rib",
        },
        values={"map": MAPS},
        positive="print_load net_area gross_area print_length print_width mean_pressure largest_pressure",
        texts="sentence",
    )

    dataset: xr.Dataset
    footprint: Footprint
    registration: Registration
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """The judgement."""
        return str(self.dataset.attrs["sentence"])

    def difference(self, name: str) -> float:
        """Relative difference of a measure: seen by the sensor over measured, less one."""
        row = self.dataset[name]
        return float(row.sel(map="seen") / row.sel(map="measured")) - 1

    @property
    def heading(self) -> str:
        """The footprint's source."""
        return self.footprint.source or "footprint of arrays"

    def rows(self) -> tuple[Row, ...]:
        """Measures by map, shares of the ribs, agreement, and the judgement."""
        d = self.dataset
        lines = [row("registration", str(self.registration))]
        ribs = 100 * d["rib_share"].sel(map=list(MAPS)).to_numpy()
        for number, (name, words) in enumerate(zip(MAPS, ("computed", "through sensor", "measured"), strict=True)):
            lines += [row(key, float(d[of].sel(map=name)), group=words) for of, key in _ROWS.items()]
            if d.sizes["rib"] > 1:
                lines.append(row("rib_share", _percent(ribs[number]), group=words))
        lines += [row(key, f"{100 * self.difference(of):+z.1f} %", group="difference") for of, key in _ROWS.items()]
        if d.sizes["rib"] > 1:
            points = " / ".join(f"{difference:+z.1f}" for difference in ribs[1] - ribs[2]) + " pt"
            lines.append(row("rib_share", points, group="difference"))
        lines += shear_rows(d)
        lines += [row(name, float(d[name])) for name in _AGREEMENT]
        return (*lines, row("verdict", self.sentence))


# Measure of the dataset → row, and how well both agree.
_ROWS: Mapping[str, str] = {
    name: name
    for name in ("print_load", "net_area", "gross_area", "print_length", "print_width", "mean_pressure",
                 "largest_pressure")
} | {"print_load": "normal_load"}  # fmt: skip
_AGREEMENT = ("overlap_of_pressure", "overlap_of_area", "rms_difference", "correlation")
_MEASURES = {
    "print_load": "load", "net_area": "net_area", "gross_area": "gross_area", "print_length": "length",
    "print_width": "width", "mean_pressure": "mean", "largest_pressure": "peak", "print_centre_x": "centre_x",
    "print_centre_y": "centre_y", "print_spread_x": "spread_x", "print_spread_y": "spread_y",
}  # fmt: skip


def compare(
    result: object,
    footprint: object,
    *,
    registration: Literal["full", "shift", "none"] | Registration = "full",
    ribs: Sequence[float] | None = None,
    load_tolerance: float = 0.25,
    pin: float | str | tuple[float, float] | None = None,
) -> FootprintComparison:
    """A computed contact beside a measured footprint.

    The footprint is laid onto the contact, which is then seen through its sensor: averaged over the sensels, exactly
    by area, or over the faces of its pins; nothing below the threshold, no more than the saturation, nothing where no
    sensel works. Where either has shear, it is compared rib by rib: forces on the thirds of each rib along and to the
    right, which cells do not blur, and the largest readings of the sensor.

    result: a contact, a `GridLoad`, or what has one, such as the result of a case or of `open_results`. footprint: a
    `Footprint`, a `GridLoad`, or the path of a file that `read_footprint` reads without further options.
    registration: "full" shifts, turns and mirrors; "shift" shifts and turns a little, for a print whose sides are
    known; "none" takes the coordinates as they are; or one of another comparison. Pins have axes of their own and are
    shifted only. ribs: edges across the tread, m; None: found from the grooves of the computed contact.
    load_tolerance: share by which the loads may differ. pin: side of the faces, m or a text such as "9.7 mm", over
    which both are averaged, of a footprint without pins of its own.
    Returns measures, overlap, difference and one sentence. Raises InputError for loads that differ by more, for
    a footprint that does not meet the contact, and for what is neither.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> measured = tl.Footprint(tl.response.GridLoad(load.grid, 0.9 * load.pressure))
    >>> f"{tl.compare(load, measured, registration='none').dataset.rms_difference.item() / 1e3:.0f} kPa"
    '60 kPa'
    """
    load, sensor = _load(result), _pinned(_footprint(footprint), pin)
    if not load_tolerance > 0:
        raise InputError(f"load_tolerance must be above 0, got {load_tolerance}")
    warnings = [*sensor.warnings, *_check_loads(load, sensor, load_tolerance)]
    pose = registration if isinstance(registration, Registration) else _registered(load, sensor, registration)
    # Arrays that nothing turned keep their own coordinates.
    # Neither do pins, which are moved only.
    if registration != "none" and sensor.pin is None:
        sensor = laid(sensor, pose.quarter_turns, pose.mirrored)
    sensor = sensor.moved(pose.shift_x, pose.shift_y)
    data, more = _maps(load, sensor, pose, ribs)
    warnings += [*_pose_caveats(pose), *more]
    print_ = replace(sensor, warnings=())
    return FootprintComparison(data, print_, pose, {"candidates": dict(pose.candidates)}, tuple(warnings))


def _load(result: object) -> GridLoad:
    contact = getattr(result, "contact", None)
    load_of = result if contact is None else contact
    load = load_of.load if isinstance(load_of, Footprint) else load_of
    if not isinstance(load, GridLoad):
        if not has_fields(load):
            raise InputError(
                f"compare takes a contact or a result that has one, got {type(result).__name__}; give what "
                "solve_contact or run returned, or open_results of a file"
            )
        load = GridLoad.from_dataset(load)
    if not load.normal_load > 0:
        raise InputError("the computed contact carries no load, so that there is nothing to compare")
    return load


def _footprint(footprint: object) -> Footprint:
    if isinstance(footprint, str | os.PathLike):
        footprint = read_footprint(footprint)
    if has_fields(footprint) and not isinstance(footprint, Footprint):
        footprint = GridLoad.from_dataset(footprint)
    sensor = Footprint(footprint) if isinstance(footprint, GridLoad) else footprint
    if not isinstance(sensor, Footprint):
        raise InputError(
            f"compare takes a footprint, a GridLoad or the path of a file, got {type(footprint).__name__}"
        )
    if not sensor.normal_load > 0:
        raise InputError("the footprint carries no load, so that there is nothing to compare")
    return sensor


def _pinned(sensor: Footprint, pin: float | str | tuple[float, float] | None) -> Footprint:
    """The footprint as pins of a size read it. Raises InputError for one that pins have measured."""
    if pin is None:
        return sensor
    sides = tuple(pin) if isinstance(pin, tuple | list) else (pin, pin)
    face = checked_pin([quantity(side, "m") for side in sides])
    if sensor.pin is not None:
        if np.allclose(face, sensor.pin, rtol=1e-3):
            return sensor
        raise InputError(
            f"the footprint was measured by pins of {sensor.pin[0] * 1e3:.3g} x {sensor.pin[1] * 1e3:.3g} mm, and "
            f"pin = {face[0] * 1e3:.3g} x {face[1] * 1e3:.3g} mm differs; leave pin out"
        )
    pressure, along, across = through(sensor.load, replace(sensor, pin=face))
    return replace(
        sensor, load=replace(sensor.load, pressure=pressure, traction_x=along, traction_y=across), pin=face
    )


def _check_loads(load: GridLoad, sensor: Footprint, tolerance: float) -> list[str]:
    """A sentence about loads that differ. Raises InputError where they differ by more than the tolerance."""
    ratio = sensor.normal_load / load.normal_load
    off = abs(ratio - 1)
    if off <= _LOAD_DIFFERENCE:
        return []
    forces = (
        f"the footprint carries {sensor.normal_load / 1e3:.4g} kN and the contact {load.normal_load / 1e3:.4g} kN, "
        f"{abs(100 * (ratio - 1)):.3g} % {'more' if ratio > 1 else 'less'}"
    )
    full = int(sensor.saturated.sum())
    if full:
        forces += f"; {full} of its sensels are saturated"
    if off <= tolerance:
        return [f"{forces}; areas and pressures differ for that alone"]
    fits = {
        f"{name} and not {unit}": abs(ratio * worth / was - 1)
        for name, worth in _UNITS.items()
        for unit, was in _UNITS.items()
        if abs(math.log(worth / was)) > 1
    }
    meant = sorted((pair for pair, error in fits.items() if error < _UNIT_FITS), key=fits.__getitem__)
    hint = f"; it would fit if its pressures were in {' or in '.join(meant[:2])}" if meant else ""
    raise InputError(
        f"{forces}, and at most {100 * tolerance:g} % will do{hint}; compute at its load, scale it to a load that "
        "you know, read_footprint(…, load=), or raise load_tolerance"
    )


def _registered(load: GridLoad, sensor: Footprint, how: str) -> Registration:
    if how not in ("full", "shift", "none"):
        raise InputError(f'registration must be "full", "shift", "none" or a Registration, got {how!r}')
    if how == "none":
        return Registration()
    return register(load, sensor, turns=how == "full") if sensor.pin is None else register_pins(load, sensor)


def _pose_caveats(pose: Registration) -> list[str]:
    caveats = []
    if pose.quarter_turns or pose.mirrored:
        as_is = pose.candidates.get("as it stands")
        before_turn = f", {100 * as_is:.0f} % as it stands" if as_is is not None else ""
        remedy = 'seen_from="below"' if pose.mirrored else "travel="
        caveats.append(
            f"the footprint was {pose.words}: so {100 * pose.overlap:.0f} % of the pressure overlaps{before_turn}; "
            f"if that is how it was taken, read it with {remedy}, else the computed tire is the wrong way round"
        )
    if abs(pose.angle) > _ASKEW:
        caveats.append(
            f"the footprint lies askew by {abs(math.degrees(pose.angle)):.1f}°; length, width and ribs are read "
            "along travel, the maps along the sensor"
        )
    return caveats


def _maps(
    load: GridLoad, sensor: Footprint, pose: Registration, ribs: Sequence[float] | None
) -> tuple[xr.Dataset, list[str]]:
    grid, there, measured = sensor.grid, sensor.sensels, np.maximum(sensor.pressure, 0.0)
    pressure = np.maximum(load.array[0], 0.0)
    angle = pose.angle if sensor.pin is None else 0.0
    by_sensor = through(load, sensor, angle)
    whole = by_sensor[0]
    computed = np.where(there, cut_off(whole, sensor.threshold, sensor.saturation), 0.0)
    if not (computed * measured).any():
        raise InputError(
            'the footprint does not meet the computed contact anywhere; compare with registration="full", or move it'
        )
    cells = (grid.x, grid.y, grid.dx, grid.dy)
    of_maps = [
        measure(pressure, load.grid.x, load.grid.y, load.grid.dx, load.grid.dy),
        measure(computed, *cells, pose.angle),
        measure(measured, *cells, pose.angle),
    ]
    edges = find_ribs(pressure, load.grid.y, load.grid.dy) if ribs is None else check_ribs(ribs)
    _, across = turn(*np.meshgrid(grid.x, grid.y), pose.angle)
    share = [
        shares(pressure, np.broadcast_to(load.grid.y[:, None], pressure.shape), edges),
        shares(computed, across, edges),
        shares(measured, across, edges),
    ]
    difference = computed - measured
    both, either = (computed > 0) & (measured > 0), (computed > 0) | (measured > 0)
    fields: dict[str, tuple[tuple[str, ...], Array | float]] = {
        "computed_pressure": (("y", "x"), np.where(there, computed, np.nan)),
        "measured_pressure": (("y", "x"), np.where(there, measured, np.nan)),
        "pressure_difference": (("y", "x"), np.where(there, difference, np.nan)),
        **{
            name: (("map",), np.array([getattr(values, key) for values in of_maps]))
            for name, key in _MEASURES.items()
        },
        "rib_share": (("map", "rib"), np.array(share)),
        "rib_left": (("rib",), edges[:-1]),
        "rib_right": (("rib",), edges[1:]),
        "overlap_of_pressure": ((), overlap(computed[there], measured[there])),
        "overlap_of_area": ((), float(both.sum() / either.sum())),
        "rms_difference": ((), float(np.sqrt(np.mean(difference[either] ** 2)))),
        "correlation": ((), _correlation(computed[there], measured[there])),
        "registered_x": ((), pose.shift_x),
        "registered_y": ((), pose.shift_y),
        "registered_angle": ((), pose.angle),
    }
    fields |= shear_by_ribs(load, sensor, np.array([computed, *by_sensor[1:]]), edges, angle)
    coordinates = {"x": grid.x, "y": grid.y, "map": list(MAPS), "rib": np.arange(1, len(edges))}
    if "third_load" in fields:
        coordinates["third"] = list(THIRDS)
    sentence = _judgement(of_maps, np.array(share), fields)
    attrs = {"pose": pose.words, "sentence": sentence, "footprint": sensor.source, "dx": grid.dx, "dy": grid.dy}
    attrs |= {"candidates": json.dumps(pose.candidates)}
    beyond = 1 - float(whole.sum()) * grid.cell_area / load.normal_load
    caveats = []
    if beyond > _BEYOND and sensor.pin is None:
        caveats.append(
            f"{100 * beyond:.2g} % of the computed load lies beyond the sensor's cells; areas and shares are of what "
            "lies on it"
        )
    return variables.dataset(fields, coordinates, **attrs), caveats


def _correlation(first: Array, second: Array) -> float:
    if not (np.ptp(first) > 0 and np.ptp(second) > 0):
        return math.nan
    return float(np.corrcoef(first, second)[0, 1])


def _judgement(
    maps: Sequence[Measures], share: Array, fields: Mapping[str, tuple[tuple[str, ...], Array | float]]
) -> str:
    """One sentence: how well they agree, area, peak, overlap, and where they differ most."""
    _, computed, measured = maps
    common, area = float(fields["overlap_of_pressure"][1]), computed.net_area / measured.net_area - 1
    peak = computed.peak / measured.peak - 1
    if common >= _AGREES[0] and abs(area) <= _AGREES[1]:
        word = "agrees with"
    elif common >= _ROUGHLY[0] and abs(area) <= _ROUGHLY[1]:
        word = "agrees roughly with"
    else:
        word = "differs from"
    text = (
        f"the computed contact {word} the footprint: area {computed.net_area * 1e6:.0f} against "
        f"{measured.net_area * 1e6:.0f} mm² ({100 * area:+z.1f} %), peak {computed.peak / 1e3:.0f} against "
        f"{measured.peak / 1e3:.0f} kPa ({100 * peak:+z.1f} %), {100 * common:.0f} % of the pressure overlaps"
    )
    if share.shape[1] > 1:
        rib = int(np.abs(share[1] - share[2]).argmax())
        text += (
            f"; of the ribs number {rib + 1} is off most, {100 * share[1, rib]:.1f} against "
            f"{100 * share[2, rib]:.1f} % of the load"
        )
    return f"{text}."


def _percent(shares: Array) -> str:
    return " / ".join(f"{share:.1f}" for share in shares) + " %"
