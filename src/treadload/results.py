"""Results on disk: one tree of datasets with its provenance, as NetCDF that others can open.

Names, units and signs of the variables are said in `variables.py` and explained in
docs/explanation/conventions.md.
"""

from __future__ import annotations

import datetime
import json
import os
import platform
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from importlib import metadata
from pathlib import Path

import xarray as xr

from treadload._version import __version__
from treadload.case import Case, LifeCase
from treadload.contact import Contact
from treadload.damage import Life, Season, Verdict
from treadload.errors import InputError
from treadload.files import NETCDF, check_suffix, read_tree, replacing
from treadload.grid import Grid
from treadload.materials import HuetSayegh, Model2S2P1D, Prony
from treadload.pavement import BONDED, HALF_BONDED, LayerRow, Pavement, layer_rows
from treadload.response import GridLoad, Response
from treadload.schema import check_tree
from treadload.tire import Tire
from treadload.variables import dataset

CITATIONS = {
    "chain": "Materials 2021, 14(9), 2117. Approach of Pavement Surface Layer Degradation Caused by Tire Contact "
    "Using Semi-Analytical Model. doi:10.3390/ma14092117",
    "influence": "Love, A. E. H. (1929). The stress produced in a semi-infinite solid by pressure on part of the "
    "boundary. Phil. Trans. R. Soc. A 228, 377-420.",
    "convolution": "Liu, S., Wang, Q., Liu, G. (2000). A versatile method of discrete convolution and FFT (DC-FFT) "
    "for contact analyses. Wear 243, 101-111.",
    "normal": "Polonsky, I. A., Keer, L. M. (1999). A numerical method for solving rough contact problems based on "
    "the multi-level multi-summation and conjugate gradient techniques. Wear 231, 206-219.",
    "preconditioner": "Vollebregt, E. A. H. (2014). A new solver for the elastic normal contact problem using "
    "conjugate gradients, deflation, and an FFT-based preconditioner. J. Comput. Phys. 257, 333-351.",
    "rolling": "Kalker, J. J. (1990). Three-Dimensional Elastic Bodies in Rolling Contact. Kluwer.",
    "newton": "Alart, P., Curnier, A. (1991). A mixed formulation for frictional contact problems prone to Newton "
    "like solution methods. Comput. Methods Appl. Mech. Eng. 92, 353-375.",
    "splitting": "Lions, P.-L., Mercier, B. (1979). Splitting algorithms for the sum of two nonlinear operators. "
    "SIAM J. Numer. Anal. 16, 964-979.",
    "memory": "Wang, G., Knothe, K. (1993). Stress analysis for rolling contact between two viscoelastic cylinders. "
    "J. Appl. Mech. 60, 310-317.",
    "pivoting": "Júdice, J. J., Pires, F. M. (1994). A block principal pivoting algorithm for large-scale strictly "
    "monotone linear complementarity problems. Comput. Oper. Res. 21, 587-596.",
    "coupling": "Panagiotopoulos, P. D. (1975). A nonlinear programming approach to the unilateral contact- and "
    "friction-boundary value problem in the theory of elasticity. Ing. Arch. 44, 421-432.",
    "mixing": "Walker, H. F., Ni, P. (2011). Anderson acceleration for fixed-point iterations. SIAM J. Numer. Anal. "
    "49, 1715-1735.",
    "falling": "Vollebregt, E. A. H., Schuttelaars, H. M. (2012). Quasi-static analysis of two-dimensional rolling "
    "contact with slip-velocity dependent friction. J. Sound Vib. 331, 2141-2155.",
    "flash": "Jaeger, J. C. (1942). Moving sources of heat and the temperature at sliding contacts. Proc. R. Soc. "
    "N.S.W. 76, 203-224.",
    "layers": "Kennett, B. L. N. (1983). Seismic Wave Propagation in Stratified Media. Cambridge University Press, "
    "chapter 6: reflection from a stack of layers, from the bottom up.",
    "sliding": "Goodman, R. E., Taylor, R. L., Brekke, T. L. (1968). A model for the mechanics of jointed rock. J. "
    "Soil Mech. Found. Div. ASCE 94, 637-659.",
    "half-bonded": "NF P98-086 (2019). Dimensionnement structurel des chaussées routières: semi-bonded interfaces.",
    "huet": "Huet, C. (1963). Étude par une méthode d'impédance du comportement viscoélastique des matériaux "
    "hydrocarbonés. Annales des Ponts et Chaussées 6, 373-429.",
    "sayegh": "Sayegh, G. (1967). Viscoelastic properties of bituminous mixtures. Proc. 2nd Int. Conf. Structural "
    "Design of Asphalt Pavements, Ann Arbor, 743-755.",
    "2s2p1d": "Olard, F., Di Benedetto, H. (2003). General 2S2P1D model and relation between the linear viscoelastic "
    "behaviours of bituminous binders and mixes. Road Mater. Pavement Des. 4, 185-224.",
    "prony": "Park, S. W., Schapery, R. A. (1999). Methods of interconversion between linear viscoelastic material "
    "functions. Int. J. Solids Struct. 36, 1653-1675.",
    "moving": "Duhamel, D., Chabot, A., Tamagny, P., Harfouche, L. (2005). ViscoRoute: visco-elastic modeling for "
    "asphalt pavements. Bull. Lab. Ponts Chaussées 258-259, 89-103.",
    "miner": "Miner, M. A. (1945). Cumulative damage in fatigue. J. Appl. Mech. 12, A159-A164.",
    "stress": "Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, chapter 3.",
}


def citations(contact: Contact | None, response: Response | None, road: Pavement | None = None) -> list[str]:
    """References of the methods that these results really used; road: of the response."""
    used = ["chain"]
    if contact is not None:
        used += ["influence", "convolution", "normal", "preconditioner", "rolling", "newton"]
        if contact.stats.get("splitting_iterations"):
            used.append("splitting")
        if contact.stats.get("coupling_rounds", 1) > 1:
            used += ["coupling", "mixing"]
        if contact.rolling.law.needs_speed:
            used.append("falling")
        if "flash_temperature" in contact.dataset:
            used.append("flash")
        if isinstance(contact.tire.material, Prony):
            used += ["memory", "pivoting"]
    if response is not None:
        used += [key for key in ("influence", "convolution", "stress") if key not in used]
        used += _of_the_road(road if road is not None or contact is None else contact.road)
    return [CITATIONS[key] for key in used]


def _of_the_road(road: Pavement | None) -> list[str]:
    """Keys of the methods that a road calls for."""
    if road is None or (road.is_homogeneous and not road.is_viscoelastic):
        return []
    bonds = [layer.bond for layer in road.layers[:-1]]
    materials = [layer.resolved for layer in road.layers]
    asked = {
        "layers": not road.is_homogeneous,
        "sliding": any(bond != BONDED for bond in bonds),
        "half-bonded": HALF_BONDED in bonds,
        "moving": road.is_viscoelastic,
        "huet": any(isinstance(one, HuetSayegh | Model2S2P1D) for one in materials),
        "sayegh": any(isinstance(one, HuetSayegh) for one in materials),
        "2s2p1d": any(isinstance(one, Model2S2P1D) for one in materials),
        "prony": any(isinstance(one, Prony) for one in materials),
    }
    return [key for key, used in asked.items() if used]


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
                "road": _road_in_words(part.road),
                "rolling": str(part.rolling),
                "stats": json.dumps(dict(part.stats), default=float),
                "warnings": json.dumps(list(part.warnings)),
            }
            groups["contact"] = part.dataset.assign_attrs(about)
        elif isinstance(part, GridLoad):
            groups["contact"] = _footprint(part, road)
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
        "layers": json.dumps([asdict(row) for row in _rows(road, case)], ensure_ascii=False),
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
        "citations": json.dumps(_of_life(road), ensure_ascii=False),
        **_provenance(),
    }
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=root), "/life": data})


def _of_life(road: Pavement | None) -> list[str]:
    used = ["chain", "influence", "convolution", "normal", "preconditioner", "rolling", "newton", "stress"]
    return [CITATIONS[key] for key in [*used, *_of_the_road(road), "miner"]]


def _provenance() -> dict[str, str]:
    return {
        "treadload_version": __version__,
        "versions": json.dumps(_versions()),
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "conventions": "x: travel, y: right, z: down; tension positive; traction: by the tire on the road; SI units",
    }


def height_map(tire: Tire, spacing: float) -> xr.Dataset:
    """The tire's initial gap on its whole extent, as `Tire.from_height_map` reads it back from a file.

    spacing: of the cells, m; a tire that is a height map keeps its own.
    """
    grid = tire.fixed_grid or Grid.on_lattice(*tire.extent, spacing)
    gap = {"initial_gap": (("y", "x"), tire.height_map(grid))}
    about = {"tire": str(tire), "treadload_version": __version__}
    return dataset(gap, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about)


def save(results: xr.DataTree | xr.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write results as NetCDF-4; the file appears whole or not at all. Tables: `write_csv`, `write_excel`.

    Raises InputError if the path cannot be written, or its suffix names another format.
    """
    check_suffix(path, NETCDF, "NetCDF")
    with replacing(path) as temporary:
        results.to_netcdf(temporary, engine="h5netcdf")
    return Path(path)


def load(path: str | os.PathLike[str]) -> xr.DataTree:
    """Read a tree of results into memory. Raises InputError if the file is none of ours, or broken."""
    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"there is no result file {path}; `treadload run case.toml -o {path}` makes one")
    loaded = read_tree(path, "a result in NetCDF-4")
    if "treadload_version" not in loaded.attrs:
        raise InputError(f"{path} is a NetCDF file, but no result of treadload: it lacks treadload_version")
    check_tree(loaded, str(path))
    return loaded


def road_in_rows(road: Pavement, case: Case | None = None) -> str:
    """The layers of a road as a table in text: thickness, modulus, bond, temperature; the speed of the wheels.

    road: at its temperature. case: that tells the temperatures and the speed.
    """
    rows = _rows(road, case)
    speed = case.speed if case is not None and road.is_viscoelastic else None
    lines = ["road from the surface down" + ("" if speed is None else f", wheels at {speed * 3.6:g} km/h")]
    wide = max(len(row.name) for row in rows)
    for number, row in enumerate(rows, start=1):
        thickness = "" if row.thickness is None else f"{row.thickness * 1e3:g} mm"
        told = [f"E = {row.modulus / 1e6:.5g} MPa", f"ν = {row.poisson:g}"]
        if row.frequency is not None:
            told[0] = f"|E*| = {row.modulus / 1e6:.4g} MPa at {row.frequency:g} Hz"
        told += [f"{row.temperature:g} °C"] if row.temperature is not None else []
        told += [f"{row.bond}{' to the next' if number < len(rows) else ''}"] if row.bond else []
        lines.append(f"  {number}  {row.name:{wide}}  {thickness:>8}  " + ", ".join(told))
    return "\n".join(lines)


def _rows(road: Pavement | None, case: Case | None) -> tuple[LayerRow, ...]:
    if road is None:
        return ()
    return layer_rows(road, case.pavement.layer_temperatures() if case is not None else ())


def _footprint(load: GridLoad, road: Pavement | None) -> xr.Dataset:
    """A recorded footprint with the names that a contact has."""
    plane = ("y", "x")
    pressure, along, across = load.array
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "pressure": (plane, pressure),
        "traction_x": (plane, along),
        "traction_y": (plane, across),
        "normal_load": ((), load.normal_load),
        "tractive_force": ((), load.tractive_force),
        "lateral_force": ((), load.lateral_force),
    }
    words = {} if road is None else {"road": _road_in_words(road)}
    cell = {"dx": load.grid.dx, "dy": load.grid.dy}
    told = f"recorded footprint{f', read from {load.source}' if load.source else ''}: {load}"
    return dataset(fields, {"x": load.grid.x, "y": load.grid.y}, **cell, tire=told, **words)


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


def _road_in_words(road: Pavement) -> str:
    layers = []
    for layer in road.layers:
        depth = "half-space" if layer.thickness is None else f"{layer.thickness * 1e3:g} mm"
        bond = "" if layer.bond == BONDED else f", {layer.bond} below"
        layers.append(f"{layer.name or 'layer'} ({depth}): {layer.material}{bond}")
    return "; ".join([*layers, "rigid base"] if road.rigid_base else layers)


def _versions() -> Mapping[str, str]:
    names = ("numpy", "scipy", "xarray")
    return {"python": platform.python_version(), **{name: metadata.version(name) for name in names}}
