"""One tree of results with its provenance.

Names, units and signs of the variables are said in `variables.py` and explained in
docs/explanation/conventions.md.
"""

from __future__ import annotations

import datetime
import json
import platform
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from importlib import metadata

import xarray as xr

from treadload._version import __version__
from treadload.case import Case, LifeCase
from treadload.contact import Contact
from treadload.damage import Life, Season, Verdict
from treadload.pavement import LayerRow, Pavement, layer_rows
from treadload.response import GridLoad, Response
from treadload.results.cite import citations, life_citations
from treadload.results.dataset import footprint
from treadload.results.roads import road_in_words, rows_of


def to_tree(
    parts: Iterable[Contact | GridLoad | Response | Verdict],
    *,
    case: Case | None = None,
    road: Pavement | None = None,
    title: str = "",
) -> xr.DataTree:
    """One tree of results: /contact, /response, /slice_along, /slice_across, /bowl, /damage.

    A response on a single row of y becomes /slice_along, on a single column of x /slice_across, on a single line of
    the surface /bowl, one at a list of points /points. A GridLoad, recorded in place of a contact, becomes /contact.
    road: at its temperature; left out, that of the contact.
    The root carries the title, the case as TOML text, the layers of the road as JSON, versions, the date and the
    citations as JSON.
    """
    groups: dict[str, xr.Dataset] = {}
    contact: Contact | None = None
    response: Response | None = None
    for part in parts:
        if isinstance(part, Contact):
            contact = part
            about = {
                "tire": str(part.tire),
                "road": road_in_words(part.road),
                "rolling": str(part.rolling),
                "stats": json.dumps(dict(part.stats), default=float),
                "warnings": json.dumps(list(part.warnings)),
            }
            groups["contact"] = part.dataset.assign_attrs(about)
        elif isinstance(part, GridLoad):
            groups["contact"] = footprint(part, road)
        elif isinstance(part, Verdict):
            sentence = part.summary().splitlines()[-1]
            groups["damage"] = part.dataset.assign_attrs(sentence=sentence)
        else:
            name = _response_group(part.dataset)
            response = part
            about = {"stats": json.dumps(dict(part.stats), default=float)}
            if name == "response":
                # Slices and bowl would say it again for their own depths.
                about["warnings"] = json.dumps(list(part.warnings), ensure_ascii=False)
            groups[name] = part.dataset.assign_attrs(about)
    if road is None and contact is not None:
        road = contact.road
    root = {
        "title": title or (case.title if case is not None else ""),
        "case": case.to_toml() if case is not None else "",
        "layers": json.dumps([asdict(row) for row in rows_of(road, case)], ensure_ascii=False),
        "citations": json.dumps(citations(contact, response, road), ensure_ascii=False),
        **_provenance(),
    }
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=root), **{f"/{k}": v for k, v in groups.items()}})


def life_tree(
    life: Life,
    *,
    case: LifeCase | None = None,
    road: Pavement | None = None,
    season: Season | None = None,
    sensitivity: xr.Dataset | None = None,
    title: str = "",
) -> xr.DataTree:
    """The life of a road as a tree with one group, /life.

    road: in the season, at its temperatures. sensitivity: elasticities to put beside the life. The root carries what
    that of `to_tree` does; the group the laws with their sources and doubts, the solves, the summary and warnings.
    """
    about = {
        "summary": life.summary(),
        "stats": json.dumps(dict(life.stats), default=float),
        "warnings": json.dumps(list(life.warnings), ensure_ascii=False),
        "governing": life.governing,
    }
    data = life.dataset.assign_attrs(about)
    if sensitivity is not None:
        more = {f"sensitivity_{name}": value for name, value in sensitivity.attrs.items()}
        data = data.merge(sensitivity.drop_attrs(deep=False)).assign_attrs(data.attrs | more)
    rows: tuple[LayerRow, ...] = ()
    if road is not None:
        warm = None if season is None else season.temperature
        known = [warm] * len(road.layers) if not isinstance(warm, tuple) else list(warm)
        rows = layer_rows(road, known)
    root = {
        "title": title or (case.title if case is not None else ""),
        "case": case.to_toml() if case is not None else "",
        "layers": json.dumps([asdict(row) for row in rows], ensure_ascii=False),
        "season": "" if season is None else season.name,
        "citations": json.dumps(life_citations(road), ensure_ascii=False),
        **_provenance(),
    }
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=root), "/life": data})


def _provenance() -> dict[str, str]:
    return {
        "treadload_version": __version__,
        "versions": json.dumps(_versions()),
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "conventions": "x: travel, y: right, z: down; tension positive; traction: by the tire on the road; SI units",
    }


def _response_group(data: xr.Dataset) -> str:
    if "point" in data.sizes:
        return "points"
    if data.sizes["depth"] == 1 and data.sizes["y"] == 1 and data.sizes["x"] > 1:
        return "bowl"
    if data.sizes["y"] == 1 and data.sizes["x"] > 1:
        return "slice_along"
    if data.sizes["x"] == 1 and data.sizes["y"] > 1:
        return "slice_across"
    return "response"


def _versions() -> Mapping[str, str]:
    names = ("numpy", "scipy", "xarray")
    return {"python": platform.python_version(), **{name: metadata.version(name) for name in names}}
