"""What a tree of results must be like, so that whatever reads it can rely on it: checked in one place.

Groups may be absent, and most variables too. What is there has the dimensions, the units and the kind of numbers that
`variables.py` and this page say.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from treadload.errors import InputError, one_line
from treadload.files import parse_toml
from treadload.kernels.arrays import Array
from treadload.variables import VARIABLES

RESPONSES = ("response", "slice", "slice_along", "slice_across", "bowl")
_OVER_SPEED = ("slip_x", "slip_y", "creepage_x", "creepage_y")
_OVER_DISTANCE = ("slip_distance_x", "slip_distance_y")
# Texts that a file and each of its groups may have.
_TEXTS = ("title", "case", "treadload_version", "created", "season", "summary")
_TEXTS_OF_A_GROUP = ("result", "part_of", "summary", "sentence")
# Dimensions that lie in the road, with a coordinate of numbers; the others are counted or named.
_LENGTHS = ("x", "y", "depth")
_COMPONENTS = 3
# More than any road has; what is beyond numbers no layer.
_MOST_LAYERS = 10_000
# No quantity of a tire or a road reaches it in SI units, and figures overflow not far beyond.
_LARGEST = 1e30
# Letters of a wrong value in a sentence.
_SHOWN = 100
# A life that changes by e⁵⁰⁰ is none, and the percentage that is shown of it overflows at e⁷⁰⁹.
_STEEPEST = 500.0


@dataclass(frozen=True)
class _Field:
    """A variable of a group. dims: in any order. finite: "all" of its values, "some", or "any" number, infinity too.

    codes: it holds whole numbers from 0, this many. positive: all that is not NaN is above zero. largest: size that
    its values can have; where infinity will do, any.
    """

    dims: frozenset[str]
    finite: str = "any"
    codes: int = 0
    positive: bool = False
    largest: float = _LARGEST


@dataclass(frozen=True)
class _Group:
    """What a group holds. needed: variables and coordinates without which it says nothing. with_it: variable → what
    it is read with. numbers: attributes that are finite numbers. texts: JSON attributes → kind of what they hold.
    positive: numbers above zero.
    """

    fields: Mapping[str, _Field]
    needed: tuple[str, ...]
    with_it: Mapping[str, str]
    numbers: tuple[str, ...]
    texts: Mapping[str, type]
    positive: tuple[str, ...] = ()


def _fields(names: str, dims: Iterable[str], finite: str = "any", **more: Any) -> dict[str, _Field]:
    return dict.fromkeys(names.split(), _Field(frozenset(dims), finite, **more))


_MAP, _SPACE = ("y", "x"), ("depth", "y", "x")
_CONTACT = _Group(
    {
        **_fields("pressure traction_x traction_y", _MAP, "all"),
        **_fields("state", _MAP, codes=3),
        **_fields("initial_gap gap displacement_x displacement_y displacement_z", _MAP, "some"),
        **_fields("slip_x slip_y", _MAP),
        **_fields("friction_coefficient friction_work friction_power flash_temperature", _MAP),
        **_fields("approach spin normal_load tractive_force lateral_force", (), "all"),
        **_fields("creepage_x creepage_y", ()),
        **_fields("aligning_moment pressure_centre_x rolling_resistance_moment friction", ()),
        **_fields("friction_work_total friction_power_total", ()),
    },
    ("x", "y", "pressure"),
    {},
    ("dx", "dy"),
    {},
    ("dx", "dy"),
)
_TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")
_ROAD = _Group(
    {
        **_fields(" ".join(f"{kind}_{of}" for kind in ("stress", "strain") for of in _TENSOR), _SPACE, "some"),
        **_fields("principal_strain_1 principal_strain_2 principal_strain_3 in_plane_strain_1", _SPACE, "some"),
        **_fields("von_mises_stress octahedral_shear_stress mean_stress mazars_strain", _SPACE, "some"),
        **_fields("displacement_x displacement_y displacement_z", _SPACE),
        **_fields("in_plane_angle_1", _SPACE, "some"),
        **_fields("principal_direction_1", (*_SPACE, "component"), "some"),
        **_fields("dissipated_energy", ("depth", "y")),
        **_fields("layer", ("depth",), "all", codes=_MOST_LAYERS),
    },
    ("x", "y", "depth"),
    {"principal_strain_1": "principal_direction_1", "in_plane_strain_1": "in_plane_angle_1"},
    ("speed", "load_x"),
    {"layer_names": list},
)
_DAMAGE = _Group(
    {
        **_fields("extension_strain", _MAP, "some"),
        **_fields("allowable_passes", _MAP, positive=True),
        **_fields("crack_angle crack_dip", _MAP),
        **_fields("crack_orientation", _MAP, codes=5),
        **_fields("worst_x worst_y worst_strain", (), "all"),
        **_fields("worst_depth", (), "all"),
        **_fields("worst_crack_orientation", (), codes=5),
        **_fields("worst_passes", (), positive=True),
        **_fields("worst_crack_angle worst_crack_dip", ()),
    },
    ("x", "y", "worst_strain", "worst_passes", "worst_x", "worst_y", "worst_depth", "worst_crack_orientation"),
    {},
    ("epsilon_6", "slope", "depth", "oblique_tolerance"),
    {},
    ("epsilon_6",),
)
_LIFE = _Group(
    {
        **_fields("damage_per_year", ("criterion", "y"), "all"),
        **_fields("damage_share", ("criterion", "axle_class", "season"), "all"),
        **_fields("worst_y largest_reading design_damage design_utilisation", ("criterion",), "all"),
        **_fields("life_years life_passes", ("criterion",), positive=True),
        **_fields("first_crack_angle first_crack_dip read_depth", ("criterion",)),
        **_fields("orientation_damage", ("criterion", "orientation"), "all"),
        **_fields("elasticity", ("input",), "all", largest=_STEEPEST),
    },
    ("criterion", "life_years", "life_passes", "worst_y", "largest_reading"),
    {
        "damage_per_year": "y", "damage_share": "season", "elasticity": "input",
        "orientation": "orientation_damage", "orientation_damage": "first_crack_angle",
    },
    ("design_years", "sensitivity_contacts", "sensitivity_responses", "sensitivity_coverage"),
    {
        "stats": dict, "laws": list, "sources": list, "doubts": list, "reads": list, "ends": list,
        "groups": list,
    },
    ("design_years",),
)  # fmt: skip
_SENSITIVITY = _Group(
    _fields("elasticity", ("input",), "all", largest=_STEEPEST),
    ("elasticity",),
    {"elasticity": "input"},
    ("contacts", "responses", "coverage"),
    {},
)
_POINTS = replace(
    _ROAD,
    fields={
        name: replace(rule, dims=rule.dims - {"y", "x"} | {"point"}) if {"y", "x"} <= rule.dims else rule
        for name, rule in _ROAD.fields.items()
        if name != "dissipated_energy"
    },
)
_GROUPS: Mapping[str, _Group] = {
    "contact": _CONTACT,
    **dict.fromkeys(RESPONSES, _ROAD),
    "points": _POINTS,
    "damage": _DAMAGE,
    "life": _LIFE,
    "sensitivity": _SENSITIVITY,
}
_OF_A_CRITERION = ("laws", "sources", "doubts", "reads")
_OF_A_QUANTITY = {"words": str, "shown": str, "factor": float, "harm": str}
_OF_A_LIFE = ("contacts", "responses", "combinations", "seconds", "interpolation_error")


def check_tree(tree: xr.DataTree, name: str) -> None:
    """Raise InputError that says what in a tree of results cannot be read. name: of the file or case."""
    _check_root(tree.attrs, name)
    for group, node in tree.children.items():
        where = f"{name}: the group /{group}"
        check_texts(node.attrs, _TEXTS_OF_A_GROUP, where)
        if node.data_vars:
            check_kind(node.to_dataset(), node.attrs.get("result") or str(group), where)


def check_kind(data: xr.Dataset, kind: str, where: str) -> None:
    """Raise InputError where what a group of this kind holds is not as it must be. where: the file and the group."""
    if kind in _GROUPS:
        _check_group(data, _GROUPS[kind], where)
    if kind == "contact":
        _check_slip(data, where)
    if kind == "life":
        _check_life(data, where)


def check_texts(attrs: Mapping[Any, Any], names: Iterable[str], where: str) -> None:
    """Raise InputError where an attribute of these names is there and no text."""
    for key in names:
        if not isinstance(attrs.get(key, ""), str):
            raise InputError(f"{where}: the attribute {key} must be text, got {short(attrs[key])}")


def _check_root(attrs: Mapping[Any, Any], name: str) -> None:
    check_texts(attrs, _TEXTS, name)
    parse_toml(attrs.get("case", ""), f"{name}: the case that it holds")
    held = _json_attributes(attrs, {"layers": list}, name)
    for number, layer in enumerate(held.get("layers", ()), start=1):
        lacking = [key for key in ("modulus", "poisson") if not _is_number(_key(layer, key))]
        told = [key for key in ("thickness", "temperature", "frequency") if _key(layer, key) is not None]
        lacking += [key for key in told if not _is_number(layer[key])]
        lacking += [key for key in ("name", "bond") if not isinstance(_key(layer, key) or "", str)]
        if lacking:
            raise InputError(f"{name}: layer {number} of the attribute layers has no {lacking[0]} that can be read")


def _check_group(data: xr.Dataset, rules: _Group, where: str) -> None:
    for name in data.dims:
        if name in _LENGTHS:
            _check_coordinate(data, str(name), where)
    if data.sizes.get("component", _COMPONENTS) != _COMPONENTS:
        raise InputError(f"{where} has {data.sizes['component']} components of a direction in space, not 3")
    needed = [*rules.needed, *(other for name, other in rules.with_it.items() if name in data.variables)]
    lacking = next((name for name in needed if name not in data.variables), None)
    if lacking is not None:
        raise InputError(f"{where} lacks {lacking!r}; compute the case again, or remove the group")
    for name, rule in rules.fields.items():
        if name in data.variables:
            _check_field(data[name], rule, f"{where}: {name}")
    for name in rules.numbers:
        if name in data.attrs:
            check_number(data.attrs[name], f"{where}: the attribute {name}", positive=name in rules.positive)
    _json_attributes(data.attrs, rules.texts, where)
    _check_interfaces(data.attrs, where)


def _check_coordinate(data: xr.Dataset, name: str, where: str) -> None:
    """Coordinates present, finite, in m, increasing; depths in the road, repeated for both sides of an interface."""
    if not data.sizes[name]:
        raise InputError(f"{where} is empty: it has no {name}")
    if name not in data.coords:
        raise InputError(f"{where} has {data.sizes[name]} rows along {name} and does not say where they lie")
    _check_field(data[name], _Field(frozenset({name}), "all"), f"{where}: {name}")
    steps = np.diff(data[name].to_numpy())
    if (steps < 0).any() or (name != "depth" and (steps == 0).any()):
        raise InputError(f"{where}: {name} does not increase everywhere; sort it")
    if name == "depth":
        _check_depths(data[name].to_numpy(), where)


def _check_depths(depths: Array, where: str) -> None:
    if depths[0] < 0:
        raise InputError(f"{where}: depth is {depths[0]:g} m, above the road; depth counts downwards")
    often = depths[2:][depths[2:] == depths[:-2]]
    if often.size:
        raise InputError(
            f"{where}: depth {often[0]:g} m is there more than twice, and an interface has two sides; compute it anew"
        )


def check_number(value: Any, who: str, *, positive: bool = False) -> None:
    """Raise InputError for what is no number of a quantity. who: the file, the group and the attribute."""
    if not _is_number(value):
        raise InputError(f"{who} must be a finite number, got {short(value)}")
    if abs(value) > _LARGEST or (positive and not value > 0):
        bound = "above zero" if positive and not value > 0 else f"at most {_LARGEST:g}"
        raise InputError(f"{who} must be {bound}, got {value:g}")


def check_numbers(field: xr.DataArray, dims: AbstractSet[str], who: str, *, more: bool = False) -> Array:
    """Values of a variable over these dimensions, or over others besides, in the unit of results.

    who: the file, the group and the name. Raises InputError where they are no numbers, none at all, of another unit.
    """
    if set(field.dims) != dims and not (more and dims < set(field.dims)):
        got, wanted = (", ".join(sorted(map(str, one))) or "no dimension" for one in (field.dims, dims))
        raise InputError(f"{who} is over {got}, not {wanted}")
    if not field.size:
        raise InputError(f"{who} is empty")
    values: Array = field.to_numpy()
    if values.dtype.kind not in "fiu":
        raise InputError(f"{who} holds {values.dtype}, not numbers")
    unit, said = VARIABLES.get(str(field.name), (None, ""))[0], field.attrs.get("units")
    if said is not None and unit is not None and str(said) != unit:
        raise InputError(f"{who} is in {said!s}, results are in {unit if unit != '1' else 'pure numbers'}")
    return values


def _check_field(field: xr.DataArray, rule: _Field, who: str) -> None:
    values = check_numbers(field, rule.dims, who)
    finite = np.isfinite(values)
    if rule.finite == "all" and not finite.all():
        raise InputError(f"{who} has {int((~finite).sum())} of {values.size} values that are NaN or infinite")
    if rule.finite == "some" and (np.isinf(values).any() or not finite.any()):
        raise InputError(f"{who} is infinite somewhere or NaN everywhere")
    if rule.finite != "any" and (beyond := np.abs(values[finite]) > rule.largest).any():
        raise InputError(
            f"{who} has {int(beyond.sum())} of {values.size} values beyond {rule.largest:g}, which no road "
            "and no tire reaches"
        )
    if rule.positive and (values <= 0).any():
        raise InputError(f"{who} has {int((values <= 0).sum())} of {values.size} values that are not above zero")
    if rule.codes and not np.isin(values, np.arange(rule.codes)).all():
        raise InputError(f"{who} has values other than 0 to {rule.codes - 1}")


def _check_slip(data: xr.Dataset, where: str) -> None:
    """Slip and creepage over a speed are numbers; they are NaN where a wheel stood, which slips by a distance."""
    known = {name: data[name].to_numpy() for name in _OVER_SPEED if name in data}
    stood = set(_OVER_DISTANCE) <= set(data.data_vars) and all(np.isnan(values).all() for values in known.values())
    for name, values in known.items():
        wrong = int((~np.isfinite(values)).sum())
        if wrong and not stood:
            raise InputError(
                f"{where}: {name} has {wrong} of {values.size} values that are NaN or infinite; only a wheel that "
                f"turned or was shifted on the spot has no {', '.join(_OVER_SPEED)}, but {_OVER_DISTANCE[0]}"
            )


def _check_interfaces(attrs: Mapping[Any, Any], where: str) -> None:
    given = np.atleast_1d(np.asarray(attrs.get("interfaces", [])))
    if given.size and (given.dtype.kind not in "fiu" or not (np.diff(given, prepend=0.0) > 0).all()):
        raise InputError(
            f"{where}: the attribute interfaces must be increasing depths in m, got {short(attrs['interfaces'])}"
        )


def _check_life(data: xr.Dataset, where: str) -> None:
    """Criteria and what is said of each of them."""
    count = data.sizes.get("criterion", 0)
    if not count:
        raise InputError(f"{where} has no criterion")
    held = _json_attributes(data.attrs, _LIFE.texts, where)
    told = [*_OF_A_CRITERION, *(["ends"] if held.get("ends") else [])]
    for name in told:
        if len(held.get(name, ())) != count:
            raise InputError(f"{where}: the attribute {name} must have {count} entries, one per criterion")
    for one in held["reads"]:
        wrong = next((key for key, kind in _OF_A_QUANTITY.items() if not isinstance(_key(one, key), kind)), None)
        if wrong is not None or not _is_number(one["factor"]):
            raise InputError(f"{where}: the attribute reads must give {wrong or 'factor'!r} for every quantity")
    stats = held.get("stats", {})
    lacking = next((key for key in _OF_A_LIFE if stats and not _is_number(stats.get(key))), None)
    if lacking is not None:
        raise InputError(f"{where}: the attribute stats has no number for {lacking!r}")
    together = ("sensitivity_contacts", "sensitivity_responses", "sensitivity_coverage")
    if 0 < sum(name in data.attrs for name in together) < len(together):
        raise InputError(f"{where} has some of the attributes {', '.join(together)}, and needs all or none")
    if ("design_damage" in data) != ("design_years" in data.attrs):
        raise InputError(f"{where} has one of design_damage and the attribute design_years, and needs both or none")


def _json_attributes(attrs: Mapping[Any, Any], kinds: Mapping[str, type], where: str) -> dict[str, Any]:
    """What the JSON attributes hold, those that are there."""
    held = {}
    for name, kind in kinds.items():
        if name not in attrs:
            continue
        try:
            held[name] = json.loads(attrs[name]) if isinstance(attrs[name], str) else None
        except (ValueError, RecursionError):
            held[name] = None
        if not isinstance(held[name], kind):
            meant = "a list" if kind is list else "a table"
            raise InputError(f"{where}: the attribute {name} must be {meant} as JSON text, got {short(attrs[name])}")
    return held


def read_json(text: Any, otherwise: Any) -> Any:
    """What JSON text holds, of the same kind as `otherwise`; that if it holds something else."""
    if not isinstance(text, str):
        return otherwise
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        return otherwise
    return value if isinstance(value, type(otherwise)) else otherwise


def short(value: Any) -> str:
    """A value from a file in so few letters that a sentence stays one."""
    said = one_line(repr(value))
    return said if len(said) <= _SHOWN else f"{said[: _SHOWN - 1]}…"


def _key(table: Any, key: str) -> Any:
    return table.get(key) if isinstance(table, dict) else None


def _is_number(value: Any) -> bool:
    kind = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    try:
        return kind and math.isfinite(value)
    except OverflowError:
        return False
