"""A tree of results as a report reads it: groups, texts, the worst point."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from treadload.damage.cracks import ORIENTATIONS, first_to_expect, in_a_cell, nothing_opens
from treadload.damage.verdict import under
from treadload.errors import InputError
from treadload.plots.kit.plan import MICRO, MM, Plan, peak_of, plane
from treadload.plots.kit.style import power_of_ten, signed
from treadload.reporting.life import exhausted, sentence
from treadload.response.fields import angle_in_words, direction_in_words, layer_in_words
from treadload.results.schema import check_tree, read_json
from treadload.results.tree import ASKED
from treadload.variables import in_order

# Kinds with tables and figures of their own; whatever else a tree holds is shown by its summary and figures.
GROUPS = ("contact", "response", "slice_along", "slice_across", "bowl", "damage", "life")
# A number such as 1.2e+05 in a sentence.
_POWER = re.compile(r"\d+(?:\.\d+)?e[+-]?\d+")
# Names that other writers gave to the same group.
_ALSO = {"slice": "slice_along"}


@dataclass(frozen=True)
class Worst:
    """The largest strain of a map: microstrain, place in words, direction in words."""

    strain: float
    place: str
    direction: str


@dataclass(frozen=True, eq=False)
class Other:
    """A result that has no table of its own. name: of the part. kind: of the result. inside: parts of it by kind."""

    name: str
    kind: str
    dataset: xr.Dataset
    inside: Mapping[str, xr.Dataset]


@dataclass(frozen=True, eq=False)
class ReportCase:
    """One case: its label and its groups of results by kind (`GROUPS`), those that are there; and all others."""

    label: str
    groups: Mapping[str, xr.Dataset]
    attrs: Mapping[str, Any]
    others: tuple[Other, ...] = ()

    @classmethod
    def of(cls, label: str, tree: xr.DataTree) -> ReportCase:
        """The first case in a tree, see `all_of`."""
        return cls.all_of(label, tree)[0]

    @classmethod
    def all_of(cls, label: str, tree: xr.DataTree) -> list[ReportCase]:
        """The cases in a tree: more than one where it has several results of a kind, by the names of its parts.

        Raises InputError if it holds no results, or some that cannot be read.
        """
        check_tree(tree, label)
        held = {str(name): node for name, node in tree.children.items() if name != ASKED and node.data_vars}
        nodes = {name: in_order(node.to_dataset()) for name, node in held.items()}
        inside: dict[str, dict[str, xr.Dataset]] = {}
        for name, node in nodes.items():
            owner = node.attrs.get("part_of")
            if isinstance(owner, str) and owner:
                inside.setdefault(owner, {}).setdefault(kind_of(name, node.attrs), node)
        by_case: dict[str, tuple[dict[str, xr.Dataset], list[Other]]] = {}
        for name, node in nodes.items():
            if node.attrs.get("part_of"):
                continue
            kind = _ALSO.get(kind_of(name, node.attrs), kind_of(name, node.attrs))
            groups, others = by_case.setdefault(_called(name, kind, label), ({}, []))
            if kind in GROUPS and kind not in groups:
                groups[kind] = node
            else:
                others.append(Other(name, kind, node, inside.get(name, {})))
        if not by_case:
            there = ", ".join(tree.children) or "nothing"
            raise InputError(f"the tree of {label!r} holds {there}; a report needs a result such as a contact")
        attrs = {str(name): value for name, value in tree.attrs.items()}
        cases = []
        for called, (groups, others) in by_case.items():
            # What the life depends on is shown beside it.
            more = next((one for one in others if one.kind == "sensitivity" and "life" in groups), None)
            if more is not None:
                groups["life"] = _with_sensitivity(groups["life"], more.dataset)
                others = [one for one in others if one is not more]
            cases.append(cls(called, groups, attrs, tuple(others)))
            attrs = {name: value for name, value in attrs.items() if name not in ("case", "title")}
        return cases

    def group(self, name: str) -> xr.Dataset | None:
        """A group of results, or None."""
        return self.groups.get(name)

    @property
    def title(self) -> str:
        """Title that the case gave itself."""
        return str(self.attrs.get("title", ""))

    @property
    def toml(self) -> str:
        """The case as TOML text, empty if unknown."""
        return str(self.attrs.get("case", ""))

    @property
    def provenance(self) -> str:
        """Version and date of the computation in a line."""
        parts = []
        if self.attrs.get("treadload_version"):
            parts.append(f"computed by treadload {self.attrs['treadload_version']}")
        if self.attrs.get("created"):
            parts.append(f"on {str(self.attrs['created']).replace('T', ' ').replace('+00:00', ' UTC')}")
        versions = read_json(self.attrs.get("versions"), {})
        if versions:
            parts.append("with " + ", ".join(f"{name} {version}" for name, version in versions.items()))
        return " ".join(parts)

    @property
    def citations(self) -> list[str]:
        """References of the methods used."""
        return [str(text) for text in read_json(self.attrs.get("citations"), [])]

    @property
    def layers(self) -> list[dict[str, Any]]:
        """The road's layers from the surface down, with the keys of `pavement.LayerRow`; empty if unknown."""
        return [dict(layer) for layer in read_json(self.attrs.get("layers"), [])]

    @property
    def laws(self) -> dict[str, str]:
        """Law of each criterion of a life in words; empty without one."""
        life = self.group("life")
        if life is None or "criterion" not in life.coords:
            return {}
        names = [str(name) for name in np.atleast_1d(life["criterion"].to_numpy())]
        laws = [str(law) for law in read_json(life.attrs.get("laws"), [])]
        return dict(zip(names, laws, strict=True)) if len(names) == len(laws) else {}

    @property
    def speed(self) -> float | None:
        """Speed of the wheels over a viscoelastic road, m/s; None if it does not matter or is not known."""
        data = self.group("response")
        return float(data.attrs["speed"]) if data is not None and "speed" in data.attrs else None

    @property
    def wheels_placed(self) -> bool:
        """True if the case places its wheels: the response is that of copies of the contact."""
        try:
            asked = tomllib.loads(self.toml).get("response", {})
        except tomllib.TOMLDecodeError:
            return False
        return isinstance(asked, Mapping) and "wheels" in asked

    @property
    def warnings(self) -> list[str]:
        """Warnings of all groups, each once."""
        held = [*self.groups.values(), *(other.dataset for other in self.others)]
        texts = [str(text) for data in held for text in read_json(data.attrs.get("warnings"), [])]
        return list(dict.fromkeys(texts))

    def statistics(self, group: str) -> dict[str, Any]:
        """Statistics of the solver of a group."""
        data = self.group(group)
        return dict(read_json(data.attrs.get("stats"), {})) if data is not None else {}

    @property
    def surface(self) -> xr.Dataset | None:
        """The map of the response at the verdict's depth, or its shallowest depth; None without a response."""
        data = self.group("response")
        if data is None:
            return None
        depths = np.atleast_1d(data["depth"].to_numpy())
        damage = self.group("damage")
        wanted = float(damage.attrs.get("depth", depths.min())) if damage is not None else float(depths.min())
        return data.isel(depth=int(np.argmin(np.abs(depths - wanted)))) if "depth" in data.dims else data

    def worst(self, strain: str) -> Worst | None:
        """The largest "principal" or "in-plane" strain of the map; None without a response."""
        data = self.surface
        name = "principal_strain_1" if strain == "principal" else "in_plane_strain_1"
        if data is None or name not in data:
            return None
        plan, values = Plan.of(data), plane(data, name)
        row, column = peak_of(values)
        here = data.isel(y=row, x=column)
        place = f"x = {signed(float(plan.x[column]))} mm, y = {signed(float(plan.y[row]))} mm"
        value = float(values[row, column]) * MICRO
        if not value > 0:
            return Worst(value, place, "no extension")
        if strain == "principal":
            direction = direction_in_words(here["principal_direction_1"].to_numpy())
        else:
            direction = angle_in_words(float(here["in_plane_angle_1"]))
        return Worst(value, place, direction)

    def worst_in_sections(self) -> Worst | None:
        """The largest three-dimensional strain of the vertical sections; None without them."""
        largest = None
        for name in ("slice_along", "slice_across"):
            data = self.group(name)
            if data is None or "principal_strain_1" not in data:
                continue
            strain = data["principal_strain_1"]
            where = {str(dim): int(index) for dim, index in strain.argmax(...).items()}
            here = data.isel(where)
            value = float(here["principal_strain_1"]) * MICRO
            if largest is None or value > largest.strain:
                x, y, depth = (float(here[key]) * MM for key in ("x", "y", "depth"))
                place = f"x = {signed(x)} mm, y = {signed(y)} mm, {depth:.1f} mm deep"
                largest = Worst(value, place, direction_in_words(here["principal_direction_1"].to_numpy()))
        return largest

    @property
    def depth_in_words(self) -> str:
        """Where the strains of the tables are read."""
        data = self.surface
        if data is None or "depth" not in data.coords or float(data["depth"]) == 0:
            return "at the surface"
        side = layer_in_words(data)
        return f"{float(data['depth']) * MM:g} mm deep{f', {side}' if side else ''}"

    @property
    def reads(self) -> str:
        """What the verdict reads, over how much road; empty without one."""
        data = self.group("damage")
        if data is None:
            return ""
        plane = "in the horizontal plane" if data.attrs.get("strain") == "in-plane" else "three-dimensional"
        return f"{plane}, {data.attrs.get('reading', 'local')}"

    @property
    def read_under(self) -> str:
        """The contacts whose road the verdict reads; empty without one."""
        data = self.group("damage")
        return "" if data is None else under(data)

    @property
    def worst_read(self) -> str:
        """The largest extension that the verdict reads; empty without one."""
        data = self.group("damage")
        if data is None or not float(data["worst_strain"]) > 0:
            return ""
        return f"{float(data['worst_strain']) * MICRO:.1f} microstrain"

    @property
    def worst_depth(self) -> str:
        """The depth at which that is; empty without a verdict."""
        data = self.group("damage")
        return "" if data is None else f"at depth {float(data['worst_depth']) * MM:g} mm"

    @property
    def orientation(self) -> str:
        """Orientation of the first crack in a word; empty without a verdict."""
        data = self.group("damage")
        if data is None:
            return ""
        return ORIENTATIONS[int(data["worst_crack_orientation"])]

    @property
    def first_crack(self) -> str:
        """The first crack for a table; empty without a verdict."""
        return in_a_cell(self.orientation) if self.orientation else ""

    @property
    def exhausted(self) -> bool:
        """True when the worst strain exceeds ε₆: fewer than a million passes; of a life, before its design ends."""
        life = self.group("life")
        if life is not None:
            return exhausted(life)
        data = self.group("damage")
        return data is not None and float(data["worst_passes"]) < 1e6

    @property
    def verdict(self) -> str:
        """The verdict in a sentence; empty without one."""
        life = self.group("life")
        if life is not None:
            return sentence(life)
        data = self.group("damage")
        if data is None:
            said = [line for one in self.others for line in summary_of(one.dataset).splitlines()]
            told = next((line for line in said if line.startswith("Verdict: ")), "")
            return _POWER.sub(_raised, told.removeprefix("Verdict: "))
        if data.attrs.get("sentence"):
            return _POWER.sub(_raised, str(data.attrs["sentence"]).removeprefix("Verdict: ").strip())
        passes = float(data["worst_passes"])
        if not float(data["worst_strain"]) > 0 or math.isinf(passes):
            return nothing_opens(float(data.attrs.get("largest_unread", 0.0)))
        few = "fewer" if passes < 1e6 else "more"
        return (
            f"at its worst point the line allows {power_of_ten(passes)} passes, {few} than a million; "
            f"{first_to_expect(self.orientation)}."
        )


def summary_of(data: xr.Dataset) -> str:
    """The summary that a group holds; empty without one."""
    return str(data.attrs.get("summary", ""))


def kind_of(name: str, attrs: Mapping[Any, Any]) -> str:
    """Kind of the result in a group: as it says, else as it is called."""
    said = attrs.get("result")
    return said if isinstance(said, str) and said else name


def _called(name: str, kind: str, label: str) -> str:
    """Name of the case that a part belongs to: "free contact" to "free", contact_2 to a second one."""
    own = re.fullmatch(rf"(?P<case>.*?)(?:(?:^|[ _]){re.escape(kind)}(?:_(?P<number>\d+))?)?", name)
    assert own is not None
    case = own["case"] or label
    return f"{case} {own['number']}" if own["number"] else case


def _with_sensitivity(life: xr.Dataset, more: xr.Dataset) -> xr.Dataset:
    """A life with its elasticities; as it is where it has some of its own."""
    if "input" in life.variables or "input" in life.dims:
        return life
    told = {name: more.attrs[name] for name in ("contacts", "responses", "coverage") if name in more.attrs}
    own = life.attrs | {f"sensitivity_{name}": value for name, value in told.items()}
    return life.assign(elasticity=more["elasticity"]).assign_attrs(own)


def _raised(match: re.Match[str]) -> str:
    return power_of_ten(float(match[0]))
