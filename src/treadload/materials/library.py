"""The catalogue of road materials: one data file a source in `catalogue/data/mixes`, and those of other packages.

Another package adds its own by an entry point of the group `treadload.mixes`: a function without arguments that
returns Mix, HydraulicMix and Unbound, for one `lambda: read_mixes(path)` of a file like ours.
"""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import Any

from treadload.catalogue.named import Catalogue, data, only, read_tables
from treadload.errors import InputError
from treadload.materials.mixture import HydraulicMix, Mix, RoadMaterial, Unbound

_MIX_KEYS = ("moduli", "epsilon_6", "scatter", "calibration", "ratios")
_HYDRAULIC_KEYS = (
    "modulus", "poisson", "sigma_6", "inverse_slope", "scatter", "calibration", "joints", "thickness_scatter"
)  # fmt: skip


def mix(name: str) -> RoadMaterial:
    """A road material by its name: Mix for "EB-GB3", HydraulicMix for "GC-T3", Unbound for "GNT1" or "PF3".

    Raises InputError that names the nearest known one.
    """
    return _catalogue().find(name)


def mixes() -> dict[str, RoadMaterial]:
    """All road materials by name: ours, and those that other packages bring along by `treadload.mixes`.

    Raises InputError for an entry point that fails, and for a name that stands twice.
    """
    return _catalogue().all()


def read_mixes(path: str | os.PathLike[str]) -> list[RoadMaterial]:
    """Road materials of a TOML file; see the files of `catalogue/data/mixes`.

    Keys: source; bituminous with temperatures (°C), frequency (Hz) of the moduli (Pa), poisson, slope, mixes and
    ratios; hydraulic; unbound. Raises InputError that names file and key.
    """
    file = Path(path)
    tables = only(read_tables(file), ("source", "bituminous", "hydraulic", "unbound"), str(file))
    try:
        return [*_bituminous(tables, file), *_hydraulic(tables, file), *_unbound(tables, file)]
    except KeyError as error:
        raise InputError(f"{file}: key {error.args[0]!r} is missing") from error
    except InputError:
        raise
    except (TypeError, ValueError, AttributeError) as error:
        raise InputError(f"{file}: {error}; take the files of treadload/catalogue/data/mixes as a pattern") from error


@cache
def _own() -> tuple[RoadMaterial, ...]:
    return tuple(item for file in data("mixes") for item in read_mixes(file))


def _catalogue() -> Catalogue[RoadMaterial]:
    return Catalogue("mix", (Mix, HydraulicMix, Unbound), _own, "treadload.mixes")


def _bituminous(tables: dict[str, Any], file: Path) -> list[Mix]:
    if "bituminous" not in tables:
        return []
    common = only(
        tables["bituminous"],
        ("temperatures", "frequency", "poisson", "slope", "mixes", "ratios"),
        f"{file}, bituminous",
    )
    found = []
    for name, table in common["mixes"].items():
        own = only(table, _MIX_KEYS, f"{file}, {name}")
        rows = _moduli(own["moduli"], float(common["frequency"]), _ratios(own, common, f"{file}, {name}"))
        found.append(
            Mix(
                name,
                tuple(common["temperatures"]),
                tuple(rows),
                tuple(rows.values()),
                common["poisson"],
                common["frequency"],
                own.get("epsilon_6"),
                common.get("slope"),
                own.get("scatter"),
                own.get("calibration"),
                _source(tables),
            )
        )
    return found


def _ratios(own: dict[str, Any], common: dict[str, Any], place: str) -> dict[str, list[float]]:
    if "ratios" not in own:
        return {}
    known = common.get("ratios", {})
    if own["ratios"] not in known:
        raise InputError(f"{place}: no table of ratios {own['ratios']!r}; known are {', '.join(known)}")
    ratios: dict[str, list[float]] = known[own["ratios"]]
    return ratios


def _moduli(moduli: list[float], frequency: float, ratios: dict[str, list[float]]) -> dict[float, tuple[float, ...]]:
    """Rows of moduli by frequency, Hz: the ratios, rounded to two digits, tell only what frequency changes."""
    by_frequency = {float(key): row for key, row in ratios.items()} or {frequency: [1.0] * len(moduli)}
    if frequency not in by_frequency:
        raise InputError(f"a table of ratios must hold the frequency of the moduli, {frequency:g} Hz")
    here = by_frequency[frequency]
    return {
        other: tuple(modulus * (there / one) for modulus, there, one in zip(moduli, row, here, strict=True))
        for other, row in sorted(by_frequency.items())
    }


def _hydraulic(tables: dict[str, Any], file: Path) -> list[HydraulicMix]:
    found = []
    for name, table in tables.get("hydraulic", {}).items():
        own = dict(only(table, _HYDRAULIC_KEYS, f"{file}, {name}"))
        slope = -1 / own.pop("inverse_slope")
        found.append(HydraulicMix(name=name, slope=slope, source=_source(tables), **own))
    return found


def _unbound(tables: dict[str, Any], file: Path) -> list[Unbound]:
    if "unbound" not in tables:
        return []
    shared = ("poisson", "slope", "constant", "constant_light")
    common = only(tables["unbound"], (*shared, "constant_inverted", "granular", "platforms"), f"{file}, unbound")
    base = {key: common[key] for key in shared}
    granular = {
        name: Unbound(
            name=name,
            modulus=modulus,
            constant_inverted=common.get("constant_inverted"),
            source=_source(tables),
            **base,
        )
        for name, modulus in common.get("granular", {}).items()
    }
    platforms = {
        name: Unbound(name=name, modulus=modulus, source=_source(tables), **base)
        for name, modulus in common.get("platforms", {}).items()
    }
    return [*granular.values(), *platforms.values()]


def _source(tables: dict[str, Any]) -> str:
    return " ".join(str(tables["source"]).split())
