"""What a tree of results must be like, so that whatever reads it can rely on it: checked in one place.

Groups may be absent, and most variables too. What is there has the dimensions, the units and the kind of numbers that
`variables.py` and this page say.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from treadload.errors import InputError
from treadload.files import parse_toml
from treadload.variables import VARIABLES

_RESPONSES = ("response", "slice", "slice_along", "slice_across", "bowl")
_OVER_SPEED = ("slip_x", "slip_y", "creepage_x", "creepage_y")
_OVER_DISTANCE = ("slip_distance_x", "slip_distance_y")
# Dimensions that lie in the road, with a coordinate of numbers; the others are counted or named.
_LENGTHS = ("x", "y", "depth")
_COMPONENTS = 3
# More than any road has; what is beyond numbers no layer.
_MOST_LAYERS = 10_000


@dataclass(frozen=True)
class _Field:
    """A variable of a group. dims: in any order. finite: "all" of its values, "some", or "any" number, infinity too.

    codes: it holds whole numbers from 0, this many.
    """

    dims: frozenset[str]
    finite: str = "any"
    codes: int = 0


@dataclass(frozen=True)
class _Group:
    """What a group holds. needed: variables and coordinates without which it says nothing. with_it: variable → what
    it is read with. numbers: attributes that are finite numbers. texts: JSON attributes → kind of what they hold.
    """

    fields: Mapping[str, _Field]
    needed: tuple[str, ...]
    with_it: Mapping[str, str]
    numbers: tuple[str, ...]
    texts: Mapping[str, type]


def _fields(names: str, dims: Iterable[str], finite: str = "any", codes: int = 0) -> dict[str, _Field]:
    return dict.fromkeys(names.split(), _Field(frozenset(dims), finite, codes))


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
        **_fields("allowable_passes crack_angle crack_dip", _MAP),
        **_fields("crack_orientation", _MAP, codes=5),
        **_fields("worst_x worst_y worst_strain", (), "all"),
        **_fields("worst_depth", (), "all"),
        **_fields("worst_crack_orientation", (), codes=5),
        **_fields("worst_passes worst_crack_angle worst_crack_dip", ()),
    },
    ("x", "y", "worst_strain", "worst_passes", "worst_x", "worst_y", "worst_depth", "worst_crack_orientation"),
    {},
    ("epsilon_6", "slope", "depth", "oblique_tolerance"),
    {},
)
_LIFE = _Group(
    {
        **_fields("damage_per_year", ("criterion", "y"), "all"),
        **_fields("damage_share", ("criterion", "axle_class", "season"), "all"),
        **_fields("worst_y largest_reading design_damage", ("criterion",), "all"),
        **_fields("life_years life_passes first_crack_angle first_crack_dip read_depth", ("criterion",)),
        **_fields("orientation_damage", ("criterion", "orientation"), "all"),
        **_fields("elasticity", ("input",), "all"),
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
)  # fmt: skip
_SENSITIVITY = _Group(
    _fields("elasticity", ("input",), "all"),
    ("elasticity",),
    {"elasticity": "input"},
    ("contacts", "responses", "coverage"),
    {},
)
_GROUPS: Mapping[str, _Group] = {
    "contact": _CONTACT,
    **dict.fromkeys(_RESPONSES, _ROAD),
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
        said = node.attrs.get("result", group)
        kind = said if isinstance(said, str) and said else str(group)
        where = f"{name}: the group /{group}"
        if node.data_vars and kind in _GROUPS:
            _check_group(node.to_dataset(), _GROUPS[kind], where)
            if kind == "contact":
                _check_slip(node.to_dataset(), where)
            if kind == "life":
                _check_life(node.to_dataset(), where)


def _check_root(attrs: Mapping[Any, Any], name: str) -> None:
    for key in ("title", "case", "treadload_version"):
        if not isinstance(attrs.get(key, ""), str):
            raise InputError(f"{name}: the attribute {key} must be text, got {attrs[key]!r}")
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
        if name in data.attrs and not _is_number(data.attrs[name]):
            raise InputError(f"{where}: the attribute {name} must be a finite number, got {data.attrs[name]!r}")
    _json_attributes(data.attrs, rules.texts, where)
    _check_interfaces(data.attrs, where)


def _check_coordinate(data: xr.Dataset, name: str, where: str) -> None:
    """Coordinates present, finite, in m and increasing; depths may be repeated, for both sides of an interface."""
    if not data.sizes[name]:
        raise InputError(f"{where} is empty: it has no {name}")
    if name not in data.coords:
        raise InputError(f"{where} has {data.sizes[name]} rows along {name} and does not say where they lie")
    _check_field(data[name], _Field(frozenset({name}), "all"), f"{where}: {name}")
    steps = np.diff(data[name].to_numpy())
    if (steps < 0).any() or (name != "depth" and (steps == 0).any()):
        raise InputError(f"{where}: {name} does not increase everywhere; sort it")


def _check_field(field: xr.DataArray, rule: _Field, who: str) -> None:
    if set(field.dims) != rule.dims:
        got, wanted = (", ".join(sorted(map(str, dims))) or "no dimension" for dims in (field.dims, rule.dims))
        raise InputError(f"{who} is over {got}, not {wanted}")
    if not field.size:
        raise InputError(f"{who} is empty")
    values = field.to_numpy()
    if values.dtype.kind not in "fiu":
        raise InputError(f"{who} holds {values.dtype}, not numbers")
    unit, said = VARIABLES[str(field.name)][0], field.attrs.get("units")
    if said is not None and str(said) != unit:
        raise InputError(f"{who} is in {said!s}, results are in {unit if unit != '1' else 'pure numbers'}")
    finite = np.isfinite(values)
    if rule.finite == "all" and not finite.all():
        raise InputError(f"{who} has {int((~finite).sum())} of {values.size} values that are NaN or infinite")
    if rule.finite == "some" and (np.isinf(values).any() or not finite.any()):
        raise InputError(f"{who} is infinite somewhere or NaN everywhere")
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
            f"{where}: the attribute interfaces must be increasing depths in m, got {attrs['interfaces']!r}"
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
            raise InputError(f"{where}: the attribute {name} must be {meant} as JSON text, got {attrs[name]!r}")
    return held


def _key(table: Any, key: str) -> Any:
    return table.get(key) if isinstance(table, dict) else None


def _is_number(value: Any) -> bool:
    kind = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    try:
        return kind and math.isfinite(value)
    except OverflowError:
        return False
