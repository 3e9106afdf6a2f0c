"""A tree of results as a report reads it: groups, texts, the worst point."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypedDict, cast

import numpy as np

from treadload.composing import Columns, class_of_group, result_classes
from treadload.damage.verdict import rows_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.footprint import Footprint
from treadload.plots.response import assessed_depth, assessed_plane
from treadload.reporting.life import exhausted
from treadload.reporting.typesetting import typeset, with_minus
from treadload.response import GridLoad
from treadload.response.solution import strain_rows
from treadload.results.schema import check_tree, read_json
from treadload.results.tree import QUESTIONS
from treadload.rows import Row, from_json
from treadload.variables import in_order

STRAINS = ("largest_principal_strain", "largest_in_plane_strain")
# Rows of a verdict on its card.
_FACTS = ("evaluation", "contacts_evaluated")
# Names that other writers gave to the same group.
_ALSO = {"slice": "slice_along"}


@dataclass(frozen=True, eq=False)
class Extra:
    """A result that has no table of its own.

    name: of the part. kind: of the result. result: its class. inside: parts of it by kind.
    """

    name: str
    kind: str
    dataset: xr.Dataset
    inside: Mapping[str, xr.Dataset]
    result: str = ""


class LayerTable(TypedDict, total=False):
    """A layer as a file holds it, see `treadload.pavement.LayerRow`."""

    name: str
    thickness: float | None
    modulus: float
    frequency: float | None
    poisson: float
    bond: str
    temperature: float | None
    material: str
    anisotropic: bool


@dataclass(frozen=True, eq=False)
class ReportCase:
    """One case: its label and its groups of results by kind (`groups_in_columns`), those there are; and all others.

    classes: of the results of the groups.
    """

    label: str
    groups: Mapping[str, xr.Dataset]
    attrs: Mapping[str, Any]
    extras: tuple[Extra, ...] = ()
    classes: Mapping[str, str] = field(default_factory=dict)

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
        nodes_by_name = {
            str(name): node for name, node in tree.children.items() if name != QUESTIONS and node.data_vars
        }
        nodes = {name: in_order(node.to_dataset()) for name, node in nodes_by_name.items()}
        inside: dict[str, dict[str, xr.Dataset]] = {}
        for name, node in nodes.items():
            owner = node.attrs.get("part_of")
            if isinstance(owner, str) and owner:
                inside.setdefault(owner, {}).setdefault(kind_of(name, node.attrs), node)
        classes, in_columns = _classes(tree), groups_in_columns()
        kept: dict[str, dict[str, str]] = {}
        by_case: dict[str, tuple[dict[str, xr.Dataset], list[Extra]]] = {}
        for name, node in nodes.items():
            if node.attrs.get("part_of"):
                continue
            kind = _ALSO.get(kind_of(name, node.attrs), kind_of(name, node.attrs))
            called = _called(name, kind, label)
            groups, extras = by_case.setdefault(called, ({}, []))
            if kind in in_columns and kind not in groups:
                groups[kind] = node
                if name in classes:
                    kept.setdefault(called, {})[kind] = classes[name]
            else:
                extras.append(Extra(name, kind, node, inside.get(name, {}), classes.get(name) or _class_of(kind)))
        if not by_case:
            there = ", ".join(tree.children) or "nothing"
            raise InputError(f"the tree of {label!r} holds {there}; a report needs a result such as a contact")
        attrs = {str(name): value for name, value in tree.attrs.items()}
        cases = []
        for called, (groups, extras) in by_case.items():
            # What the life depends on is shown beside it.
            more = next((extra for extra in extras if extra.kind == "sensitivity" and "life" in groups), None)
            if more is not None:
                groups["life"] = _with_sensitivity(groups["life"], more.dataset)
                extras = [extra for extra in extras if extra is not more]
            cases.append(cls(called, groups, attrs, tuple(extras), kept.get(called, {})))
            attrs = {name: value for name, value in attrs.items() if name not in ("case", "title")}
        return cases

    def group(self, name: str) -> xr.Dataset | None:
        """A group of results, or None."""
        return self.groups.get(name)

    def class_of(self, kind: str) -> str:
        """Name of the class of a group of results."""
        return self.classes.get(kind) or _class_of(kind)

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
    def layers(self) -> list[LayerTable]:
        """The road's layers from the surface down, with the keys of `pavement.LayerRow`; empty if unknown."""
        return [cast("LayerTable", dict(layer)) for layer in read_json(self.attrs.get("layers"), [])]

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
            table = tomllib.loads(self.toml).get("response", {})
        except tomllib.TOMLDecodeError:
            return False
        return isinstance(table, Mapping) and "wheels" in table

    @property
    def warnings(self) -> list[str]:
        """Warnings of all groups, each once."""
        datasets = [*self.groups.values(), *(extra.dataset for extra in self.extras)]
        texts = [str(text) for data in datasets for text in read_json(data.attrs.get("warnings"), [])]
        return list(dict.fromkeys(texts))

    def statistics(self, group: str) -> dict[str, object]:
        """Statistics of the solver of a group."""
        data = self.group(group)
        return dict(read_json(data.attrs.get("stats"), {})) if data is not None else {}

    @property
    def surface(self) -> xr.Dataset | None:
        """The map of the response at the assessment's depth, or its shallowest depth; None without a response."""
        return assessed_plane(self.group("response"), self.group("damage"))

    @property
    def strains(self) -> dict[str, Row]:
        """Rows of the largest strains of the map, and of the vertical sections, by key; empty without a response."""
        data = self.surface
        rows_by_key = {} if data is None else {row.key: row for row in strain_rows(data)}
        sections = (self.group(name) for name in ("slice_along", "slice_across"))
        deepest = [row for section in sections if section is not None for row in strain_rows(section)[:1]]
        if deepest:
            worst = max(deepest, key=lambda row: float(row.value))
            rows_by_key["sections"] = replace(worst, label=f"{worst.label}, vertical sections")
        return rows_by_key

    @property
    def depth_in_words(self) -> str:
        """Where the strains of the tables are read."""
        return assessed_depth(self.surface)

    def rows(self, kind: str) -> tuple[Row, ...]:
        """Rows of a group of results; of a file of another writer those that its fields give."""
        data = self.group(kind)
        if data is None:
            return ()
        if rows := from_json(data.attrs.get("rows")):
            return rows
        if kind == "damage":
            law, strain = str(data.attrs.get("law", "unknown")), str(data.attrs.get("strain", "in-plane"))
            return rows_of(data, law, strain, float(data.attrs.get("epsilon_6", math.nan)))
        return Footprint(GridLoad.from_dataset(data)).rows() if kind == "contact" else ()

    @property
    def facts(self) -> list[tuple[str, str]]:
        """What the assessment evaluates, and the largest strains at points, for a card beside the answer."""
        rows = [row for row in self.rows("damage") if row.key in _FACTS]
        points = [
            replace(row, label=f"{row.label}, at a point") for key, row in self.strains.items() if key in STRAINS
        ]
        return [
            (row.label, typeset(row) + (f" at {with_minus(str(row.place))}" if row.place else ""))
            for row in (*rows, *points)
        ]

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
        """The assessment in a sentence; empty without one."""
        rows = [*self.rows("life"), *self.rows("damage")]
        rows += [row for extra in self.extras for row in from_json(extra.dataset.attrs.get("rows"))]
        return next((typeset(row) for row in rows if row.key == "verdict"), "")


def groups_in_columns() -> dict[str, Columns]:
    """Groups of results that a report compares in columns; whatever else a tree holds is shown by itself."""
    groups: dict[str, Columns] = {}
    for kind in result_classes().values():
        if kind.columns is not None:
            groups |= {kind.group: kind.columns, **dict.fromkeys(kind.sections, Columns())}
    return groups


def kind_of(name: str, attrs: Mapping[object, object]) -> str:
    """Kind of the result in a group: as it is recorded, else by its name."""
    result_name = attrs.get("result")
    return result_name if isinstance(result_name, str) and result_name else name


def _classes(tree: xr.DataTree) -> dict[str, str]:
    """Part of a tree → the class of its result, where the file states it."""
    questions = read_json(tree[QUESTIONS].attrs.get("questions"), {}) if QUESTIONS in tree.children else {}
    parts = questions.items() if isinstance(questions, dict) else ()
    return {
        str(name): str(question["is"]) for name, question in parts if isinstance(question, dict) and "is" in question
    }


def _class_of(kind: str) -> str:
    """The class of results of a kind, as it is called in files of other writers."""
    return class_of_group(kind) or kind


def _called(name: str, kind: str, label: str) -> str:
    """Name of the case that a part belongs to: "free contact" to "free", contact_2 to a second one."""
    parts = re.fullmatch(rf"(?P<case>.*?)(?:(?:^|[ _]){re.escape(kind)}(?:_(?P<number>\d+))?)?", name)
    assert parts is not None
    case = parts["case"] or label
    return f"{case} {parts['number']}" if parts["number"] else case


def _with_sensitivity(life: xr.Dataset, more: xr.Dataset) -> xr.Dataset:
    """A life with its elasticities; as it is where it has some of its own."""
    if "input" in life.variables or "input" in life.dims:
        return life
    stats = {name: more.attrs[name] for name in ("contacts", "responses", "coverage") if name in more.attrs}
    attrs = life.attrs | {f"sensitivity_{name}": value for name, value in stats.items()}
    return life.assign(elasticity=more["elasticity"]).assign_attrs(attrs)
