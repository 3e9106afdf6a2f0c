"""The catalogue of road materials: one data file per source in `catalogue/data/mixes`, and those of other packages.

Another package adds its own by an entry point of the group `treadload.mixes`: a function without arguments that
returns Mix, HydraulicMix, Unbound and UnboundByStress, for one `lambda: read_mixes(path)` of a file like ours.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from treadload.errors import InputError
from treadload.materials.mixture import HydraulicMix, Mix, RoadMaterial, Unbound
from treadload.materials.stress_dependent import UnboundByStress
from treadload.materials.stress_laws import ModulusLaw
from treadload.named import Catalogue, read_tables, sentence
from treadload.units import (
    Celsius,
    Frequency,
    Length,
    Modulus,
    Number,
    Strain,
    UnitWeight,
    leading_number,
    quantity,
)


@dataclass(frozen=True)
class _Bituminous:
    """A mix of a file: moduli, Pa, over the temperatures; ratios: name of their table for other frequencies."""

    moduli: tuple[Modulus, ...]
    epsilon_6: Strain | None = None
    scatter: Number | None = None
    calibration: Number | None = None
    ratios: str | None = None
    caveats: tuple[str, ...] = ()


@dataclass(frozen=True)
class _AllBituminous:
    """What the mixes of a file share. temperatures. frequency: of their moduli. ratios: by frequency, as text."""

    temperatures: tuple[Celsius, ...]
    frequency: Frequency
    poisson: Number
    mixes: dict[str, _Bituminous]
    slope: Number | None = None
    ratios: dict[str, dict[str, tuple[Number, ...]]] | None = None


@dataclass(frozen=True)
class _Hydraulic:
    """A treated material of a file, see HydraulicMix; inverse_slope is -1/b."""

    modulus: Modulus
    poisson: Number
    sigma_6: Modulus
    inverse_slope: Number
    scatter: Number
    calibration: Number
    joints: Number | None = None
    thickness_scatter: Length | None = None
    caveats: tuple[str, ...] = ()


@dataclass(frozen=True)
class _AllUnbound:
    """Unbound materials and platforms of a file by their moduli, and what they share, see Unbound."""

    poisson: Number
    slope: Number
    constant: Number
    constant_light: Number
    constant_inverted: Number | None = None
    granular: dict[str, Modulus] | None = None
    platforms: dict[str, Modulus] | None = None


@dataclass(frozen=True)
class _ByStress:
    """A stress-dependent material of a file, see UnboundByStress."""

    law: ModulusLaw
    earth_pressure: Number
    unit_weight: UnitWeight
    poisson: Number | None = None
    caveats: tuple[str, ...] = ()


@dataclass(frozen=True)
class _File:
    """A file of road materials of one source, and the caveats about it."""

    source: str
    caveats: tuple[str, ...] = ()
    bituminous: _AllBituminous | None = None
    hydraulic: dict[str, _Hydraulic] | None = None
    unbound: _AllUnbound | None = None
    stress_dependent: dict[str, _ByStress] | None = None


def read_mixes(path: str | os.PathLike[str]) -> list[RoadMaterial]:
    """Road materials of a TOML file; see the files of `catalogue/data/mixes`.

    Keys: source; caveats, sentences, also of one mix; bituminous with temperatures (°C), frequency (Hz) of the moduli
    (Pa), poisson, slope, mixes and ratios; hydraulic; unbound; stress_dependent. Raises InputError that names file
    and key.

    >>> from pathlib import Path
    >>> folder = Path(tl.catalogue.__file__).parent / "data"
    >>> mixes = tl.catalogue.read_mixes(folder / "mixes" / "nf_p98_086.toml")
    >>> f"{len(mixes)} mixes, the first is {mixes[0].name}"
    '29 mixes, the first is EB-BBSG1'
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    name = str(Path(path))
    tables: _File = read(_File, read_tables(Path(path)), name)
    try:
        items: list[RoadMaterial] = [
            *_bituminous(tables.bituminous),
            *_hydraulic(tables.hydraulic or {}),
            *_unbound(tables.unbound),
            *_by_stress(tables.stress_dependent or {}),
        ]
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
    source = sentence(tables.source)
    return [
        replace(item, source=source, caveats=tuple(map(sentence, (*item.caveats, *tables.caveats)))) for item in items
    ]


def _bituminous(common: _AllBituminous | None) -> list[Mix]:
    if common is None:
        return []
    mixes = []
    for name, mix in common.mixes.items():
        try:
            rows = _moduli(mix.moduli, common.frequency, _ratios(mix, common))
        except InputError as error:
            raise InputError(f"bituminous.mixes.{name}: {error}") from error
        fatigue = mix.epsilon_6, common.slope, mix.scatter, mix.calibration
        moduli = tuple(rows), tuple(rows.values())
        at = common.poisson, common.frequency
        mixes.append(Mix(name, common.temperatures, *moduli, *at, *fatigue, caveats=mix.caveats))
    return mixes


def _ratios(mix: _Bituminous, common: _AllBituminous) -> Mapping[str, tuple[float, ...]]:
    if mix.ratios is None:
        return {}
    tables = common.ratios or {}
    if mix.ratios not in tables:
        raise InputError(f"no table of ratios {mix.ratios!r}; known are {', '.join(tables)}")
    return tables[mix.ratios]


def _moduli(
    moduli: tuple[float, ...], frequency: float, ratios: Mapping[str, tuple[float, ...]]
) -> dict[float, tuple[float, ...]]:
    """Rows of moduli by frequency, Hz: the ratios, rounded to two digits, give only the change with frequency."""
    by_frequency = {quantity(_in_hertz(key), "Hz"): row for key, row in ratios.items()}
    by_frequency = by_frequency or {frequency: (1.0,) * len(moduli)}
    if frequency not in by_frequency:
        raise InputError(f"a table of ratios must hold the frequency of the moduli, {frequency:g} Hz")
    long = next((row for row in by_frequency.values() if len(row) != len(moduli)), None)
    if long is not None:
        raise InputError(f"a table of ratios needs one for each of the {len(moduli)} moduli, got {len(long)}")
    here = by_frequency[frequency]
    return {
        frequency: tuple(
            modulus * (there / at_reference) for modulus, there, at_reference in zip(moduli, row, here, strict=True)
        )
        for frequency, row in sorted(by_frequency.items())
    }


def _in_hertz(key: str) -> str:
    """A frequency that stands as a key, in Hz where it names no unit."""
    return f"{key} Hz" if leading_number(key)[1] == "" else key


def _hydraulic(tables: Mapping[str, _Hydraulic]) -> list[HydraulicMix]:
    mixes = []
    for name, row in tables.items():
        columns = {field.name: getattr(row, field.name) for field in fields(row) if field.name != "inverse_slope"}
        mixes.append(HydraulicMix(name=name, slope=-1 / row.inverse_slope, **columns))
    return mixes


def _unbound(common: _AllUnbound | None) -> list[Unbound]:
    if common is None:
        return []
    shared: dict[str, Any] = {
        "poisson": common.poisson,
        "slope": common.slope,
        "constant": common.constant,
        "constant_light": common.constant_light,
    }
    granular = [
        Unbound(name=name, modulus=modulus, constant_inverted=common.constant_inverted, **shared)
        for name, modulus in (common.granular or {}).items()
    ]
    platforms = [Unbound(name=name, modulus=modulus, **shared) for name, modulus in (common.platforms or {}).items()]
    return [*granular, *platforms]


def _by_stress(tables: Mapping[str, _ByStress]) -> list[UnboundByStress]:
    return [
        UnboundByStress(name=name, **{field.name: getattr(row, field.name) for field in fields(row)})
        for name, row in tables.items()
    ]


def _words(material: RoadMaterial) -> str:
    words = str(material).removeprefix(f"{material.name}, ")
    if not isinstance(material, Mix):
        return words
    fatigue = "" if material.epsilon_6 is None else f", ε₆ = {material.epsilon_6 * 1e6:g} microstrain"
    return f"E = {material.modulus(15) / 1e6:g} MPa at 15 °C{fatigue}; data {words}"


mixes: Catalogue[RoadMaterial] = Catalogue(
    "mix",
    (Mix, HydraulicMix, Unbound, UnboundByStress),
    folder="mixes",
    read=read_mixes,
    words=_words,
    group="treadload.mixes",
    use='mix = "EB-GB3" in a layer of a case',
    prefix="EB-",
)
"""Road materials: Mix as "EB-GB3", HydraulicMix as "GC-T3", Unbound as "GNT1" or "PF3", UnboundByStress as "FDOT
limerock"; "EB-" may be left out."""
