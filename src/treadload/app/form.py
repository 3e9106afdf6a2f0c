"""The form: it is a case. Tables as a TOML file holds them, which of their keys are the user's, and what is wrong."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, ClassVar, Self

import tomli_w

from treadload.app.fields import SURFACES, Field
from treadload.case import Case
from treadload.case.changes import changed, set_key
from treadload.case.file import FilePart
from treadload.case.first import first_case
from treadload.errors import InputError
from treadload.files import parse_toml
from treadload.read import by_key
from treadload.tire import TreadProfile

# Texts that are never the path of a file.
_WORDS = ("title", "name", "source", "notes", "doubts")


@dataclass(frozen=True)
class Checked:
    """What the reader of cases says of a form: the case, or sentences by the path of their key, "" of the whole."""

    case: FilePart | None
    wrong: Mapping[str, str]

    def at(self, path: str, known: set[str]) -> str:
        """What is said of a field: of its key, or of one inside it that has no field of its own."""
        told = [text for key, text in self.wrong.items() if _nearest(key, known) == path]
        return "; ".join(told)

    def elsewhere(self, known: set[str]) -> list[str]:
        """What belongs to no field."""
        return [f"{key}: {text}" if key else text for key, text in self.wrong.items() if not _nearest(key, known)]


def _nearest(key: str, known: set[str]) -> str:
    parts = key.split(".")
    ends = (".".join(parts[:count]) for count in range(len(parts), 0, -1))
    return next((one for one in ends if one in known), "")


@dataclass(frozen=True)
class Form:
    """Tables of a case, and the paths of the keys that are the user's own; the others are where the page began.

    kind: of case. solver: what the process is asked to do with it. road_temperature: True where
    the road has a temperature of its own.
    """

    kind: ClassVar[type[FilePart]] = Case
    solver: ClassVar[str] = "solve"
    road_temperature: ClassVar[bool] = True

    table: Mapping[str, Any]
    yours: frozenset[str] = frozenset()

    @classmethod
    def first(cls) -> Self:
        """Where the page begins: the case that `treadload init` writes, on cells of 3 mm, read at the surface."""
        table = parse_toml(first_case("run"), "case")
        table["spacing"] = "3 mm"
        return cls(table)

    @classmethod
    def from_text(cls, text: str, name: str, files: Mapping[str, str]) -> Self:
        """A form of the text of a TOML file, all of whose keys are the user's.

        files: name that the user knows → name under which an uploaded file is kept. Raises InputError, also for a
        case that names a file which was not uploaded.
        """
        table = parse_toml(text, name)
        _settle(table, files)
        form = cls(table, frozenset(_paths(table)))
        # Whatever else is wrong with it is said at its field; what has no field could not be repaired there.
        cls.kind._check_kind(table, name)
        return form

    def with_text(self, field: Field, text: str) -> Self:
        """The form with what was typed into a field; nothing sets the default."""
        value = field.read(text)
        table = copy.deepcopy(dict(self.table))
        if value is None:
            if self.value(field.path) is not None:
                table = changed(table, [f"{field.path}="])
            return replace(self, table=table, yours=self.yours - {field.path})
        set_key(table, field.path, value)
        return replace(self, table=table, yours=self.yours | {field.path})

    def with_values(self, values: Mapping[str, Any]) -> Self:
        """The form with keys set, or removed where the value is None."""
        table, yours = copy.deepcopy(dict(self.table)), set(self.yours)
        for path, value in values.items():
            if value is not None:
                set_key(table, path, copy.deepcopy(value))
                yours.add(path)
            elif _at(table, path) is not None:
                table = changed(table, [f"{path}="])
                yours = {one for one in yours if one != path and not one.startswith(f"{path}.")}
        return replace(self, table=table, yours=frozenset(yours))

    def value(self, path: str) -> Any:
        """The value of a key as it is given; None where it is not."""
        return _at(self.table, path)

    def is_yours(self, path: str) -> bool:
        """True where the user gave the value, or the table that it stands in."""
        return any(path == one or path.startswith(f"{one}.") for one in self.yours)

    def check(self, folder: Path) -> Checked:
        """What the reader of `treadload run` says. folder: of uploaded files."""
        try:
            _settle(self.table, None)
            return Checked(self.kind.from_dict(dict(self.table), folder=folder, name="case"), {})
        except InputError as error:
            return Checked(None, by_key(error) or {"": str(error).removeprefix("case: ")})

    def to_toml(self) -> str:
        """The case as a TOML file, as it was typed."""
        return tomli_w.dumps(dict(self.table))

    # What the choices above the fields say of the tables.

    @property
    def surface(self) -> str:
        """One of `SURFACES`."""
        tire = self.table.get("tire", {})
        if isinstance(tire, Mapping):
            if "scan" in tire:
                return "example" if tire["scan"] == "example" else "scan"
            if "height_map" in tire:
                return "height_map"
            if isinstance(tire.get("profile"), Mapping):
                return "profile"
        return "library"

    def with_surface(self, surface: str, file: str = "") -> Self:
        """The form with a surface of this kind. file: of a mesh or a height map that was uploaded."""
        assert surface in SURFACES
        tire = dict(self.table.get("tire", {}))
        keep = {key: tire[key] for key in ("inflation_pressure", "material", "belt") if key in tire}
        kinds: dict[str, dict[str, Any]] = {
            "library": {"profile": "315/80R22.5"},
            "profile": {"profile": _plain_profile()},
            "example": {"scan": "example"},
            "scan": {"scan": file},
            "height_map": {"height_map": file},
        }
        own = kinds[surface]
        kept = frozenset(one for one in self.yours if not one.startswith("tire.")) | {f"tire.{key}" for key in own}
        again = {f"tire.{key}" for key in keep if self.is_yours(f"tire.{key}")}
        return replace(self, table={**self.table, "tire": {**own, **keep}}, yours=kept | again)

    @property
    def road(self) -> str:
        """One of `ROADS`."""
        pavement = self.table.get("pavement", {})
        if isinstance(pavement, Mapping) and "structure" in pavement:
            return "structure"
        return "half_space" if len(self.layers) == 1 else "layers"

    @property
    def layers(self) -> list[Any]:
        """Tables of the layers."""
        pavement = self.table.get("pavement", {})
        layers = pavement.get("layers", []) if isinstance(pavement, Mapping) else []
        return list(layers) if isinstance(layers, list) else []

    def with_road(self, kind: str) -> Self:
        """The form with a road of this kind."""
        asphalt = {"kind": "elastic", "modulus": "5400 MPa", "poisson": 0.35}
        first = Form.first().table["pavement"]
        made: dict[str, Any] = {
            "half_space": {"layers": [{"name": "road", "material": asphalt}]},
            "layers": first,
            "structure": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15},
        }[kind]
        if not self.road_temperature:
            made = {key: value for key, value in made.items() if key in ("layers", "structure")}
        kept = frozenset(one for one in self.yours if not one.startswith("pavement"))
        return replace(self, table={**self.table, "pavement": copy.deepcopy(made)}, yours=kept | {"pavement"})

    def with_layers(self, layers: list[Any]) -> Self:
        """The form with these layers."""
        pavement = {**self.table.get("pavement", {}), "layers": layers}
        return replace(self, table={**self.table, "pavement": pavement}, yours=self.yours | {"pavement.layers"})

    @property
    def by_force(self) -> bool:
        """True where forces are prescribed, False for creepages."""
        rolling = self.table.get("rolling", {})
        return not any(key in rolling for key in ("creepage_x", "creepage_y"))

    @property
    def state(self) -> str:
        """One of `STATES`, told from the forces or creepages."""
        rolling = self.table.get("rolling", {})
        along = rolling.get("tractive_force", rolling.get("creepage_x"))
        aside = [rolling.get(key) for key in ("lateral_force", "creepage_y", "spin")]
        turns = any(one not in (None, 0, 0.0) for one in aside)
        if along in (None, 0, 0.0):
            return "turning" if turns else "free"
        backwards = str(along).strip().startswith(("-", "−"))
        drives = backwards != ("tractive_force" in rolling)
        return "combined" if turns else ("driving" if drives else "braking")

    def with_state(self, state: str, *, by_force: bool) -> Self:
        """The form with a wheel that does this, by forces or by creepages."""
        rolling = dict(self.table.get("rolling", {}))
        keep = {key: rolling[key] for key in ("normal_load", "approach", "friction", "speed") if key in rolling}
        along = {"driving": 1, "braking": -1, "combined": 1}.get(state)
        own: dict[str, Any] = {}
        if along is not None:
            own |= {"tractive_force": f"{10 * along} kN"} if by_force else {"creepage_x": -0.01 * along}
        if state in ("turning", "combined"):
            own |= {"lateral_force": "5 kN"} if by_force else {"creepage_y": 0.01}
        if not by_force and state in ("driving", "braking"):
            own |= {"creepage_y": 0.0}
        if not by_force and state == "turning":
            own |= {"creepage_x": 0.0}
        # A wheel that rolls freely is the default of the case: it has no key to be the user's.
        kept = frozenset(one for one in self.yours if one.removeprefix("rolling.") not in _MOVES)
        given = frozenset(f"rolling.{key}" for key in own)
        return replace(self, table={**self.table, "rolling": {**keep, **own}}, yours=kept | given)


_MOVES = ("tractive_force", "lateral_force", "creepage_x", "creepage_y", "spin")


def _plain_profile() -> dict[str, Any]:
    """A truck's tread to begin with, in the units that the fields show."""
    return {
        "rolling_radius": "522 mm", "crown_radius": "800 mm", "width": "280 mm", "shoulder_radius": "20 mm",
        "grooves": [{"centre": f"{y} mm", "width": "12 mm", "depth": "14 mm"} for y in (-80, -27, 27, 80)],
    }  # fmt: skip


def profile_of(form: Form) -> TreadProfile | None:
    """The profile of a form as it stands, for its cross-section; None where it is none or wrong."""
    told = form.value("tire.profile")
    try:
        return TreadProfile.from_dict(told) if isinstance(told, Mapping) else None
    except (InputError, ValueError):
        return None


def _at(table: Any, path: str) -> Any:
    here = table
    for part in path.split("."):
        if isinstance(here, list):
            here = here[int(part)] if part.isdigit() and int(part) < len(here) else None
        else:
            here = here.get(part) if isinstance(here, Mapping) else None
    return here


def _paths(table: Any, before: str = "") -> Iterator[str]:
    members = enumerate(table) if isinstance(table, list) else table.items()
    for key, value in members:
        path = f"{before}{key}"
        if isinstance(value, Mapping) or (isinstance(value, list) and any(isinstance(one, Mapping) for one in value)):
            yield from _paths(value, f"{path}.")
        else:
            yield path


def _settle(table: Any, files: Mapping[str, str] | None) -> None:
    """Put the kept names of uploaded files in a table, and refuse whatever would lead out of their folder."""
    members = enumerate(table) if isinstance(table, list) else table.items()
    for key, value in list(members):
        if isinstance(value, Mapping | list):
            _settle(value, files)
        elif isinstance(value, str) and key not in _WORDS:
            if files is not None and value in files:
                table[key] = files[value]
            elif _leads_out(value):
                raise InputError(
                    f"{key} = {value!r} names a file of the machine that this page runs on, which no page may open; "
                    "upload the file and give its bare name"
                )


def _leads_out(text: str) -> bool:
    here, there = PurePosixPath(text.strip()), PureWindowsPath(text.strip())
    parts = {*here.parts, *there.parts}
    return here.is_absolute() or bool(there.drive or there.root) or ".." in parts or text.strip().startswith("~")
