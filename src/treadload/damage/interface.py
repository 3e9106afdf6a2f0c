"""What the interfaces of a layered road bear under a load, and where and when their bonds fail."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import ClassVar

import numpy as np

from treadload import variables
from treadload.composing import BaseResult, Holds, Source, dataset_of
from treadload.damage.bond_border import WorstOfBond, worst_of_bond
from treadload.damage.cracks import gridded
from treadload.damage.criterion import interface_number
from treadload.damage.laws.bond import BondStrength, ShearFatigue
from treadload.damage.laws.validity import warnings_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.layers.depths import same_depth
from treadload.pavement import FRICTIONLESS, BondLaw, Pavement
from treadload.rows import Place, Row, row
from treadload.units import repetitions_in_words

_DIMS = ("interface", "y", "x")


def delaminate(road: Pavement, interface: int, bond: BondLaw = FRICTIONLESS) -> Pavement:
    """The road with another bond at one interface.

    interface: counted from the surface, 0 below the top layer, negative from the lowest. bond: what is left,
    FRICTIONLESS, HALF_BONDED or Bond(stiffness=...). Raises InputError for an interface that is not there.

    >>> asphalt, soil = tl.Elastic(5e9, 0.35), tl.Elastic(60e6, 0.4)
    >>> road = tl.Pavement([tl.Layer(asphalt, 0.06), tl.Layer(asphalt, 0.1), tl.Layer(soil)])
    >>> roads, tire = (road, tl.damage.delaminate(road, 0)), tl.UniformDisc(0.125, 662e3)
    >>> strains = [tl.solve_response(tire, r, depths=[0.06], points=[[0, 0]]).dataset.strain_xx.item() for r in roads]
    >>> [f"{strain * 1e6:.0f} microstrain" for strain in strains]
    ['-17 microstrain', '226 microstrain']
    """
    number = interface_number(road, interface)
    layers = [replace(layer, bond=bond) if k == number else layer for k, layer in enumerate(road.layers)]
    return Pavement(layers, rigid_base=road.rigid_base)


def interface_fields(above: Source, below: Source | None = None) -> xr.Dataset:
    """Shear, pressure and sliding at every interface of a layered road.

    above: a response that has the depth of every interface, side "above". below: the same with side "below",
    for the jump of the displacement; left out, no jump.
    Returns a dataset over (interface, y, x): interface_shear_x, interface_shear_y, their size interface_shear,
    interface_pressure (compression positive), Pa; jump_x, jump_y, the horizontal displacement below the interface
    minus that above it, m. The shear is σ_xz and σ_yz: at a Bond it is stiffness times the jump. Coordinates depth,
    m, and between, the names of both layers.
    Raises InputError for a response without interfaces, or without their depths.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.06), tl.Layer(tl.Elastic(100e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.125, 8e5), road, depths=[0.06], x=[0.0, 0.125], y=[0.0])
    >>> fields = tl.damage.interface_fields(response)
    >>> [f"{shear / 1e3:.0f} kPa" for shear in fields.interface_shear.values.ravel()]
    ['0 kPa', '58 kPa']
    """
    data = gridded(above)
    names = _layer_names(data)
    depths = np.atleast_1d(np.asarray(data.attrs.get("interfaces", []), dtype=float))[: len(names) - 1]
    if not len(depths):
        raise InputError("this road has no interfaces: its response is that of one half-space; give it layers")
    rows = _at_depths(data, depths)
    fields: dict[str, tuple[tuple[str, ...], Array]] = {
        "interface_shear_x": (_DIMS, rows["stress_xz"].to_numpy()),
        "interface_shear_y": (_DIMS, rows["stress_yz"].to_numpy()),
        "interface_shear": (_DIMS, np.hypot(rows["stress_xz"].to_numpy(), rows["stress_yz"].to_numpy())),
        "interface_pressure": (_DIMS, -rows["stress_zz"].to_numpy()),
    }
    if below is not None:
        under = _at_depths(gridded(below), depths)
        if any(not np.array_equal(under[name], rows[name]) for name in ("x", "y")):
            raise InputError(
                "the responses above and below must have the same x and y; solve both at the same points"
            )
        for name in "xy":
            part = under[f"displacement_{name}"].to_numpy() - rows[f"displacement_{name}"].to_numpy()
            fields[f"jump_{name}"] = (_DIMS, part)
    dataset = variables.dataset(
        fields,
        {"interface": np.arange(len(depths)), "y": rows["y"].to_numpy(), "x": rows["x"].to_numpy()},
        **{name: data.attrs[name] for name in ("road", "layer_names", "interfaces", "speed") if name in data.attrs},
    )
    between = [f"{upper} / {lower}" for upper, lower in pairwise(names)]
    return dataset.assign_coords(
        depth=("interface", depths, variables.attributes("depth")), between=("interface", between)
    )


def _layer_names(data: xr.Dataset) -> list[str]:
    names = json.loads(data.attrs.get("layer_names", "[]"))
    return [name or f"layer {number}" for number, name in enumerate(names)]


def _at_depths(data: xr.Dataset, depths: Array) -> xr.Dataset:
    levels = data["depth"].to_numpy()
    rows = [int(np.argmin(np.abs(levels - depth))) for depth in depths]
    far = ~same_depth(levels[rows], depths)
    if far.any():
        raise InputError(
            f"the response lacks the interface at {depths[far][0]:g} m; solve it with depths=road.interfaces"
        )
    return data.isel(depth=rows).transpose("depth", "y", "x", ...)


@dataclass(frozen=True, eq=False)
class BondVerdict(BaseResult, group="bonds"):
    """Whether the interfaces of a road are strong enough for a load.

    dataset: the fields of `interface_fields`, utilisation and, with a law, bond_passes (interface, y, x), NaN where
    no strength is given; largest_utilisation, parting_x, parting_y, parting_passes (interface), parting_shear and
    parting_pressure, Pa, there.
    strengths: one for each interface, None where not assessed. law: of fatigue, or None. warnings: for the user.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.06), tl.Layer(tl.Elastic(100e6, 0.4))])
    >>> at = [-0.25, -0.125, 0.0, 0.125, 0.25]
    >>> fields = tl.life.solve_interfaces(tl.UniformDisc(0.125, 8e5), road, x=at, y=at)
    >>> result = tl.damage.assess_bonds(fields, tl.damage.InterfaceStrength(cohesion=0.4e6))
    >>> f"{float(result.dataset.largest_utilisation[0]):.2f} of the strength, {len(result.warnings)} warnings"
    '0.14 of the strength, 0 warnings'
    """

    title: ClassVar[str] = "Interface bonds"
    subject: ClassVar[str] = "What the bonds of a road bear"
    holds: ClassVar[Holds] = Holds(
        {
            "x": "x",
            "y": "y",
            "interface depth largest_utilisation parting_x parting_y": "interface",
            "interface_shear interface_pressure utilisation": "interface y x",
        },
        not_nan="largest_utilisation",
        maybe={"parting_passes parting_shear parting_pressure": "interface", "bond_passes": "interface y x"},
        with_field={"law": "parting_passes"},
        labels={"between": "interface"},
        each={"interface": "strengths"},
    )

    dataset: xr.Dataset
    strengths: tuple[BondStrength | None, ...]
    law: ShearFatigue | None = None
    warnings: tuple[str, ...] = ()

    @property
    def first(self) -> int:
        """Number of the interface that fails first: the one with the largest utilisation."""
        return int(np.nanargmax(self.dataset["largest_utilisation"].to_numpy()))

    def rows(self) -> tuple[Row, ...]:
        """Strength, utilisation, shear and normal stress at the worst place of every interface; the assessment."""
        rows: list[Row] = []
        for k, strength in enumerate(self.strengths):
            data = self.dataset.isel(interface=k)
            name = _named(data)
            if strength is None:
                rows.append(row("bond_strength", "no strength given", group=name))
                continue
            x, y = data["parting_x"], data["parting_y"]
            worst, place = _at_worst(data), Place(float(x), float(y))
            rows += [
                row("bond_strength", str(strength), group=name),
                row("largest_utilisation", data["largest_utilisation"], place=place, group=name),
                row("interface_shear", worst["shear"], group=name),
                row("interface_pressure", worst["pressure"], group=name),
            ]
            if self.law is not None:
                rows.append(row("parting_passes", data["parting_passes"], group=name))
        return (*rows, row("verdict", self._verdict()))

    def _verdict(self) -> str:
        first = self.dataset.isel(interface=self.first)
        used = float(first["largest_utilisation"])
        if used >= 1:
            return f"{_named(first)} fails in the first pass."
        if self.law is None:
            return (
                f"no bond fails at once; the utilisation of {_named(first)} is largest. Give a law for its load "
                "repetitions."
            )
        if used == 0:
            return "no bond carries any load."
        passes = repetitions_in_words(float(first["parting_passes"]))
        y = round(1e3 * float(first["parting_y"]), 1) + 0.0
        return f"{_named(first)} fails first, after {passes} load repetitions, from y = {y:.1f} mm."


def assess_bonds(
    fields: Source,
    strengths: BondStrength | Sequence[BondStrength | None],
    law: ShearFatigue | None = None,
    *,
    temperature: float | Sequence[float] | None = None,
) -> BondVerdict:
    """Where, and after how many passes, the bonds of a road fail under a load.

    fields: of `interface_fields` or `solve_interfaces`, or a response that has the depth of every interface.
    strengths: one for all interfaces, or one for each from the surface down, None for
    those that are not assessed. law: fatigue of the bonds; left out, only the strength is assessed. temperature: of
    the interfaces, °C, one or one for each, for strengths that depend on it.
    x is where the worst place stands in the frame of the load: as a wheel rolls by, every point at that y sees it.
    Where the largest utilisation lies at the edge of the points of a response, the interface is solved further, as
    far as the basin reaches, until it lies inside; a warning states the place beyond, or that it still lies at the
    end. Fields alone cannot be solved further: a warning states the edge.
    Returns a BondVerdict. Raises InputError for a wrong number of strengths or temperatures, or one that is missing.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.06), tl.Layer(tl.Elastic(100e6, 0.4))])
    >>> at = [-0.25, -0.125, 0.0, 0.125, 0.25]
    >>> fields = tl.life.solve_interfaces(tl.UniformDisc(0.125, 8e5), road, x=at, y=at)
    >>> bonds = [tl.damage.InterfaceStrength(cohesion) for cohesion in (0.8e6, 0.05e6)]
    >>> [f"{float(tl.damage.assess_bonds(fields, bond).dataset.largest_utilisation[0]):.2f}" for bond in bonds]
    ['0.07', '1.15']
    """
    above, source = fields, dataset_of(fields)
    fields = source if "interface_shear" in source else interface_fields(source)
    count = fields.sizes["interface"]
    by_interface = [strengths] * count if isinstance(strengths, BondStrength) else list(strengths)
    if len(by_interface) != count:
        raise InputError(
            f"give a strength for each of the {count} interfaces, None to leave one out, got {len(by_interface)}"
        )
    if all(strength is None for strength in by_interface):
        raise InputError("a verdict on bonds needs the strength of at least one interface, got none")
    warm = [temperature] * count if temperature is None or isinstance(temperature, int | float) else list(temperature)
    if len(warm) != count:
        raise InputError(f"give one temperature, or one for each of the {count} interfaces, got {len(warm)}")
    shear, pressed = (fields[f"interface_{name}"].transpose(*_DIMS).to_numpy() for name in ("shear", "pressure"))
    used = np.full(shear.shape, np.nan)
    warnings: list[str] = json.loads(fields.attrs.get("warnings", "[]"))
    warmed: list[BondStrength | None] = []
    for k, (strength, degrees) in enumerate(zip(by_interface, warm, strict=True)):
        at = strength if strength is None or degrees is None else strength.at(float(degrees))
        warmed.append(at)
        if at is not None:
            used[k] = at.utilisation(shear[k], pressed[k])
            warnings += [f"{_named(fields.isel(interface=k))}: {text}" for text in _caveats(at, pressed[k])]
    x, y, depths = (fields[name].to_numpy() for name in ("x", "y", "depth"))
    places: list[WorstOfBond | None] = [
        None if strength is None else worst_of_bond(above, strength, depth, x, y, shear[k], pressed[k])
        for k, (strength, depth) in enumerate(zip(warmed, depths, strict=True))
    ]
    warnings += [
        f"{_named(fields.isel(interface=k))}: {place.sentence}"
        for k, place in enumerate(places)
        if place is not None and place.sentence
    ]
    values = {
        name: np.array([math.nan if place is None else getattr(place, name) for place in places])
        for name in ("utilisation", "x", "y", "shear", "pressure")
    }
    largest = values["utilisation"]
    added: dict[str, tuple[tuple[str, ...], Array]] = {
        "utilisation": (_DIMS, used),
        "largest_utilisation": (("interface",), largest),
        **{f"parting_{name}": (("interface",), values[name]) for name in ("x", "y", "shear", "pressure")},
    }
    if law is not None:
        added["bond_passes"] = (_DIMS, law.allowable_passes(used))
        added["parting_passes"] = (("interface",), law.allowable_passes(largest))
        warnings += warnings_of(law, largest)
    dataset = fields.assign({name: (dims, data, variables.attributes(name)) for name, (dims, data) in added.items()})
    return BondVerdict(dataset, tuple(warmed), law, tuple(dict.fromkeys(warnings)))


def _at_worst(interface: xr.Dataset) -> dict[str, float]:
    """Shear and pressure, Pa, where the utilisation is largest; of older files at the nearest point."""
    names = ("shear", "pressure")
    if all(f"parting_{name}" in interface for name in names):
        return {name: float(interface[f"parting_{name}"]) for name in names}
    near = interface.sel(x=interface["parting_x"], y=interface["parting_y"], method="nearest")
    return {name: float(near[f"interface_{name}"]) for name in names}


def _caveats(strength: BondStrength, pressed: Array) -> list[str]:
    caveats = [strength.caveat] if strength.caveat else []
    tension = float(-pressed.min())
    # Tension that matters: a hundredth of what presses. Less stands everywhere around a load.
    if tension > 0.01 * float(np.abs(pressed).max()) and math.isinf(strength.tension_limit):
        caveats.append(f"tension up to {tension / 1e3:.3g} kPa acts and is not assessed; give a tensile_strength")
    return caveats


def interface_in_words(interface: int, between: str) -> str:
    """An interface as people count it. interface: from 0 at the surface. between: names of both layers, "a / b"."""
    return f"interface {interface + 1}, below {between.split(' / ')[0]}"


def _named(interface: xr.Dataset) -> str:
    name = interface_in_words(int(interface["interface"]), str(interface["between"].item()))
    return f"{name} ({float(interface['depth']) * 1e3:g} mm deep)"
