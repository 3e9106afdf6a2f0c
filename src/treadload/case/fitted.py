"""A road from a backcalculation: `[pavement] from = "moduli.nc#station 12"` becomes layers and their scatter."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path

from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.files import read_tree

FROM, OVERLAY = "from", "overlay"
_GROUP, LAWS = "backcalculation", "layer_laws"
_REFUSED = 2

_Tables = dict[str, object]


def with_fitted_road(table: Mapping[str, object], folder: Path) -> _Tables:
    """The tables of a case with the layers that a backcalculation found; as they are where it names none.

    `[pavement] from`: a result file and a station, "moduli.nc#km 1.2"; the first drop of the station is taken.
    `[pavement] overlay`: a layer as in `[[pavement.layers]]`, laid on top and named "overlay" unless it has a name.
    `[reliability]` without moduli takes their scatter and correlation. folder: that the file is looked for in.
    Raises InputError.
    """
    pavement = table.get("pavement")
    if not isinstance(pavement, Mapping) or FROM not in pavement:
        return dict(table)
    source = pavement[FROM]
    stray = next((key for key in pavement if key in ("layers", "structure", "rigid_base", "temperature")), None)
    if stray is not None:
        raise InputError(f"pavement.from replaces pavement.{stray}; leave one of them out")
    if not isinstance(source, str) or "#" not in source:
        raise InputError(f'pavement.from must be a file and a station, "moduli.nc#km 1.2", got {source!r}')
    file, _, station = source.rpartition("#")
    drop = _drop(folder / file, station.strip())
    rest = {key: value for key, value in pavement.items() if key not in (FROM, OVERLAY)}
    fitted = _layers(drop)
    if OVERLAY in pavement:
        overlay = pavement[OVERLAY]
        if not isinstance(overlay, Mapping):
            raise InputError(
                f"pavement.overlay must be a table of a layer, with its material and thickness, got {overlay!r}"
            )
        assert isinstance(fitted["layers"], list)
        fitted["layers"] = [{"name": OVERLAY, **overlay}, *fitted["layers"]]
    tables = {**table, "pavement": {**rest, **fitted}}
    reliability = table.get("reliability")
    if isinstance(reliability, Mapping) and not {"moduli", "modulus_correlation"} & set(reliability):
        tables["reliability"] = {**reliability, **_scatter(drop)}
    return tables


def _drop(path: Path, station: str) -> xr.Dataset:
    if not path.is_file():
        raise InputError(f"pavement.from: there is no file {path}; `treadload backcalculate` makes one")
    tree = read_tree(path, "a result in NetCDF-4")
    if _GROUP not in tree.children:
        raise InputError(f"pavement.from: {path} holds no backcalculation; its parts: {', '.join(tree.children)}")
    data = tree[_GROUP].to_dataset()
    stations = [str(name) for name in data["station"].to_numpy()]
    name = station if station in stations else station.removeprefix("station").strip()
    if name not in stations:
        raise InputError(
            f"pavement.from: {path} has no station {station!r}; {nearest(name, dict.fromkeys(stations))}"
        )
    drop = data.isel(basin=stations.index(name))
    if int(drop["basin_status"]) == _REFUSED:
        raise InputError(f"pavement.from: station {name} was refused: {drop['reason'].item()}")
    return drop


def _layers(drop: xr.Dataset) -> _Tables:
    layers: list[_Tables] = []
    for number, name in enumerate(map(str, drop["layer_name"].to_numpy())):
        thickness = float(drop["layer_thickness"][number])
        if not thickness > 0:
            continue
        layer: _Tables = {"name": name, "material": _material(drop, number, name)}
        if math.isfinite(thickness):
            layer["thickness"] = thickness
        stiffness = float(drop["bond_stiffness"][number])
        if math.isfinite(stiffness):
            layer["bond"] = {"stiffness": stiffness} if stiffness else "frictionless"
        layers.append(layer)
    rigid = "thickness" in layers[-1]
    if rigid:
        layers[-1].pop("bond", None)
    return {"layers": layers, **({"rigid_base": True} if rigid else {})}


def _material(drop: xr.Dataset, number: int, name: str) -> Mapping[str, object]:
    """Table of the material of a layer: elastic, or its law with the fitted factor."""
    factor = float(drop["law_factor"][number]) if "law_factor" in drop else math.nan
    if math.isfinite(factor):
        laws = json.loads(drop.attrs.get(LAWS, "{}"))
        if name not in laws:
            raise InputError(
                f"pavement.from: the file does not hold the law of layer {name!r}, which is of another package; "
                f"state the layers in [[pavement.layers]], with factor = {factor:.4g} for this one"
            )
        return {**laws[name], "factor": factor}
    modulus, poisson = float(drop["fitted_modulus"][number]), float(drop["layer_poisson"][number])
    return {"kind": "elastic", "modulus": modulus, "poisson": poisson}


def _scatter(drop: xr.Dataset) -> _Tables:
    # Few cases need the search behind it.
    from treadload.roads.scatter import scatter_of

    scatter = scatter_of(drop)
    assert isinstance(scatter.moduli, Mapping)
    pairs = [list(pair) for pair in scatter.modulus_correlation]
    return {"moduli": dict(scatter.moduli), **({"modulus_correlation": pairs} if pairs else {})}
