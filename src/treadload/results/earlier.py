"""Parts of files that do not hold their inputs: rebuilt from the case, where there is one."""

from __future__ import annotations

from typing import Any, Protocol

import xarray as xr

from treadload.case import Case
from treadload.case.choices import TIRE_MATERIAL
from treadload.case.file import FilePart
from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.damage import Verdict
from treadload.errors import InputError
from treadload.footprint import Footprint
from treadload.grid import Grid
from treadload.response import GridLoad, Response
from treadload.results.holding import check_dataset, made
from treadload.results.schema import read_json
from treadload.tire import Tire
from treadload.tire.recorded import RecordedSurface

_RESPONSES = ("response", "slice", "slice_along", "slice_across", "bowl", "points")
# Attributes that a tree adds to those of a result.
_TOLD = ("tire", "road", "rolling", "stats", "warnings", "sentence", "summary", "result", "part_of")


class Opened(Protocol):
    """What a part is rebuilt from: the tree, its case and where it was read."""

    tree: xr.DataTree

    @property
    def case(self) -> FilePart | None:
        """The case that they answer."""

    @property
    def where(self) -> str:
        """The file, for errors."""


def from_case(name: str, data: xr.Dataset, opened: Opened) -> BaseResult:
    """The part of this name with the inputs of the case. Raises InputError where the case does not hold them."""
    case = opened.case
    if not isinstance(case, Case):
        raise InputError(_untold(name, opened, "and has no case that holds them"))
    kept = data.attrs if name != "contact" else {k: v for k, v in data.attrs.items() if k not in _TOLD}
    bare = data.drop_attrs(deep=False).assign_attrs({k: v for k, v in kept.items() if k not in ("stats", "sentence")})
    where = f"{opened.where}: the part {name!r}"
    about: dict[str, Any] = {
        "dataset": bare,
        "stats": read_json(data.attrs.get("stats"), {}),
        "warnings": tuple(read_json(data.attrs.get("warnings"), [])),
    }
    road = case.pavement.build()
    if name == "contact" and case.footprint is None:
        check_dataset(Contact, bare, where)
        asked: dict[str, Any] = {"tire": _tire(data, case), "road": road, "rolling": case.build_rolling()}
        return made(Contact, about | asked, where)  # type: ignore[no-any-return]
    if name == "contact":
        return Footprint(GridLoad.from_dataset(data), road)
    if name in _RESPONSES and "contact" in opened.tree.children:
        loads = tuple(case.response.place(GridLoad.from_dataset(opened.tree["contact"].to_dataset())))
        speed = case.speed if road.is_viscoelastic else None
        asked = {"loads": loads, "road": road, "speed": speed, "side": case.response.side}
        return made(Response, about | asked, where)  # type: ignore[no-any-return]
    if name == "damage" and case.damage is not None:
        asked = {"line": case.damage.fatigue.build(), "strain": data.attrs.get("strain", case.damage.strain)}
        return made(Verdict, {"dataset": bare, **asked}, where)  # type: ignore[no-any-return]
    raise InputError(_untold(name, opened, "and its case does not hold them"))


def _untold(name: str, opened: Opened, why: str) -> str:
    version = opened.tree.attrs.get("treadload_version", "an unknown version")
    return (
        f"{opened.where} was written by treadload {version}, which did not keep the inputs of its part {name!r}, "
        f"{why}; its fields are in .tree[{name!r}], and files of this version keep all inputs"
    )


def _tire(data: xr.Dataset, case: Case) -> Tire:
    """A tire in words: the mesh of a scan may be gone."""
    assert case.tire is not None
    x, y = data["x"].to_numpy(), data["y"].to_numpy()
    grid = Grid(len(x), len(y), float(data.attrs["dx"]), float(data.attrs["dy"]), float(x[0]), float(y[0]))
    words = str(data.attrs.get("tire", "a tire"))
    surface = RecordedSurface(words, (grid.nx * grid.dx, grid.ny * grid.dy))
    return Tire(surface, TIRE_MATERIAL.build(case.tire.material), case.tire.inflation_pressure)
