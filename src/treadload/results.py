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
from importlib import metadata
from pathlib import Path

import xarray as xr

from treadload._version import __version__
from treadload.case import Case
from treadload.contact import Contact
from treadload.damage import Verdict
from treadload.errors import InputError
from treadload.files import replacing
from treadload.grid import Grid
from treadload.materials import Prony
from treadload.pavement import BONDED, Pavement
from treadload.response import Response
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
    "stress": "Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, chapter 3.",
}


def citations(contact: Contact | None, response: Response | None) -> list[str]:
    """References of the methods that these results really used."""
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
    return [CITATIONS[key] for key in used]


def to_tree(
    parts: Iterable[Contact | Response | Verdict], *, case: Case | None = None, title: str = ""
) -> xr.DataTree:
    """One tree of results: /contact, /response, /slice_along, /slice_across, /damage.

    A response on a single row of y becomes /slice_along, on a single column of x /slice_across.
    The root carries the title, the case as TOML text, versions, the date and the citations as JSON.
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
        elif isinstance(part, Verdict):
            sentence = part.summary().splitlines()[-1]
            groups["damage"] = part.dataset.assign_attrs(sentence=sentence)
        else:
            response = part
            stats = json.dumps(dict(part.stats), default=float)
            groups[_response_group(part.dataset)] = part.dataset.assign_attrs(stats=stats)
    root = {
        "title": title or (case.title if case is not None else ""),
        "case": case.to_toml() if case is not None else "",
        "treadload_version": __version__,
        "versions": json.dumps(_versions()),
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "citations": json.dumps(citations(contact, response), ensure_ascii=False),
        "conventions": "x: travel, y: right, z: down; tension positive; traction: by the tire on the road; SI units",
    }
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=root), **{f"/{k}": v for k, v in groups.items()}})


def height_map(tire: Tire, spacing: float) -> xr.Dataset:
    """The tire's initial gap on its whole extent, as `Tire.from_height_map` reads it back from a file.

    spacing: of the cells, m; a tire that is a height map keeps its own.
    """
    grid = tire.fixed_grid or Grid.centred(*tire.extent, spacing)
    gap = {"initial_gap": (("y", "x"), tire.height_map(grid))}
    about = {"tire": str(tire), "treadload_version": __version__}
    return dataset(gap, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about)


def save(results: xr.DataTree | xr.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write results as NetCDF-4; the file appears whole or not at all.

    Raises InputError if the path cannot be written.
    """
    with replacing(path) as temporary:
        results.to_netcdf(temporary, engine="h5netcdf")
    return Path(path)


def load(path: str | os.PathLike[str]) -> xr.DataTree:
    """Read a tree of results into memory. Raises InputError if the file is none of ours."""
    path = Path(path)
    if not path.is_file():
        raise InputError(f"there is no result file {path}; `treadload run case.toml -o {path}` makes one")
    try:
        with xr.open_datatree(path, engine="h5netcdf") as tree:
            loaded: xr.DataTree = tree.load()
    except Exception as error:
        raise InputError(f"cannot read {path} as a result in NetCDF-4: {error}") from error
    if "treadload_version" not in loaded.attrs:
        raise InputError(f"{path} is a NetCDF file, but no result of treadload: it lacks treadload_version")
    return loaded


def write_csv(data: xr.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write the fields of a dataset on (y, x), or (depth, y, x), as a table with one row a point."""
    with replacing(path) as temporary:
        fields = [name for name in data.data_vars if data[name].ndim and "component" not in data[name].dims]
        frame = data[fields].to_dataframe()
        frame.columns = [f"{name} [{data[name].attrs.get('units', '')}]" for name in fields]
        frame.to_csv(temporary)
    return Path(path)


def _response_group(data: xr.Dataset) -> str:
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
