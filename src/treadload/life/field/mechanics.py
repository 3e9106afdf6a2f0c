"""Predicted ages of the sections of a table: the chain tire, strain, damage for each, kept so that it resumes."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from treadload._version import __version__
from treadload.damage.laws.aged import AgedLine
from treadload.damage.laws.fatigue import FatigueLine
from treadload.errors import InputError
from treadload.files import text_of, write_whole
from treadload.kernels.arrays import Array
from treadload.life.contacts import Contacts, Counter
from treadload.life.field.prediction import HARDENING, Predictions
from treadload.life.field.priors import BOTTOM, FAMILIES, Priors, RoadSection
from treadload.life.field.table import SectionTable
from treadload.life.solve import solve_sum
from treadload.life.surface_lines import yearly_by
from treadload.life.threads import how_many, pool_of
from treadload.life.wheels import states_of

HARDENINGS = (0.0, 0.5, 1.0, 1.5)
"""Of the fatigue lines at the surface that are evaluated: 0 is the young mix, 1 that of old cores, see `AgedLine`."""
THERMAL = "multiple of the damage by daily thermal stress"
"""What the mechanics leave open beside the line: 1 is as computed, 0 leaves the stress out."""
MULTIPLES = (0.0, 1.0, 10.0, 100.0, 1000.0)
"""Of the damage by daily thermal stress that are predicted."""
Progress = Callable[[int, int, str], None]


@dataclass(frozen=True)
class SectionDamage:
    """Damage of a section in a year, from which its predicted ages follow.

    name: of the section. traffic, thermal: at the surface, of the axles and of daily thermal stress, by the lines of
    `HARDENINGS`. bottom: at the bottom of the asphalt, of the axles. largest_surface, largest_bottom: tensile strain,
    plain. assumed_traffic: True where the traffic is a prior. error: of values interpolated over the climate,
    relative.
    """

    name: str
    traffic: tuple[float, ...]
    thermal: tuple[float, ...]
    bottom: float
    largest_surface: float
    largest_bottom: float
    assumed_traffic: bool
    error: float

    def surface_age(self, hardening: float = 0.0, thermal_share: float = 1.0) -> float:
        """Predicted years until the damage at the surface is 1; inf where none is done.

        hardening: of the line, within `HARDENINGS`; between them ln of the damage follows the cubic through all four.
        thermal_share: by which the damage of daily thermal stress counts, 0 for none.
        """
        parts = [_between(hardening, values) for values in (self.traffic, self.thermal)]
        total = parts[0] + thermal_share * parts[1]
        return 1 / total if total > 0 else np.inf

    @property
    def bottom_age(self) -> float:
        """Predicted years until the damage at the bottom is 1; inf where none is done."""
        return 1 / self.bottom if self.bottom > 0 else np.inf


def _between(hardening: float, values: Sequence[float]) -> float:
    """Damage by a line between those evaluated: ln on their cubic."""
    low, high = HARDENINGS[0], HARDENINGS[-1]
    if not low <= hardening <= high:
        raise InputError(f"hardening must lie in [{low:g}, {high:g}], got {hardening:g}")
    if min(values) <= 0:
        return float(np.interp(hardening, HARDENINGS, values))
    cubic = np.polynomial.Polynomial.fit(HARDENINGS, np.log(values), len(HARDENINGS) - 1)
    return float(np.exp(cubic(hardening)))


def section_damage(section: RoadSection, priors: Priors, contacts: Contacts) -> SectionDamage:
    """The chain of one section: passages of every class in every season, Miner's sum at surface and bottom.

    contacts: of the priors' tire. Raises InputError, and ConvergenceError of a contact.
    """
    design = priors.design(section, contacts)
    summed = solve_sum(design, workers=1)
    readings, y = summed.passages.readings.to_numpy(), summed.passages.readings["y"].to_numpy()
    daily = None if summed.weather is None else summed.weather.readings[0]
    line = design.criteria[0].law
    assert isinstance(line, FatigueLine)
    by_lines = [
        yearly_by(AgedLine(line.epsilon_6, line.slope, hardening), design, readings[0], y, daily)
        for hardening in HARDENINGS
    ]
    largest = summed.life.dataset["largest_reading"].to_numpy()
    return SectionDamage(
        section.name,
        tuple(row[0] for row in by_lines),
        tuple(row[1] for row in by_lines),
        float(summed.life.dataset["damage_per_year"].sel(criterion=BOTTOM).max()),
        float(largest[0]),
        float(largest[1]),
        section.traffic is None,
        summed.passages.interpolation_error,
    )


def predict_damage(
    sections: Sequence[RoadSection],
    priors: Priors | None = None,
    *,
    kept: Path | str | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> tuple[SectionDamage, ...]:
    """Damage of every section of a table in a year, by the chain from the tire to Miner's sum.

    priors: what the table does not state; left out, the defaults. kept: a JSON file in which solved sections are
    kept: those in it under the same inputs, priors and version are not solved again, so that an interrupted run
    resumes. workers: threads; all cores if left out. progress: called after every section.
    Raises InputError, and ConvergenceError of a contact.
    """
    assumed = priors or Priors()
    names = [section.name for section in sections]
    if len(set(names)) < len(names):
        raise InputError(
            f"two sections have the name {next(n for n in names if names.count(n) > 1)!r}; give each its own"
        )
    path = None if kept is None else Path(kept)
    solved = {} if path is None else _read(path)
    keys = [_digest(assumed.key(section)) for section in sections]
    missing = [k for k, key in enumerate(keys) if key not in solved]
    if missing:
        contacts = assumed.contacts()
        count = Counter(len(sections), progress)
        for k in range(len(sections) - len(missing)):
            count.after(k, "section read")
        threads = how_many(workers)
        with pool_of(threads) as pool:
            first = sections[missing[0]]
            classes = assumed.traffic(first).classes
            states = [state for row in classes for state in states_of(row, contacts.tire)]
            contacts.solve(states, assumed.road(first).at_temperature(15.0), pool, Counter(len(states), None))
            tasks = pool.map(lambda k: section_damage(sections[k], assumed, contacts), missing)
            for k, damage in zip(missing, tasks, strict=True):
                solved[keys[k]] = count.after(damage, f"section {damage.name}")
                if path is not None:
                    _write(path, solved)
    return tuple(solved[key] for key in keys)


def predict_sections(
    table: SectionTable,
    priors: Priors | None = None,
    *,
    kept: Path | str | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Predictions:
    """Ages that the mechanics predict for the sections of a table, by the line of a young mix, trusted as they stand.

    priors: what the table does not state; left out, those of the table, else the defaults. The others as in
    `predict_damage`. parts: largest tensile strains at surface and bottom, the share of daily
    thermal stress, 1 where the traffic is a prior, and the error of values interpolated over the climate. variants:
    ages by lines up to that of old cores, and by multiples of the thermal damage.
    Raises InputError for sections without thickness or climate.
    """
    assumed = priors or Priors.of(table.priors, f"[priors] of {table.name}")
    damages = predict_damage(sections_of(table), assumed, kept=kept, workers=workers, progress=progress)
    traffic, thermal = (np.array([getattr(row, name)[0] for row in damages]) for name in ("traffic", "thermal"))
    missing = [row.assumed_traffic for row in damages]
    parts = {
        "largest_surface_strain": np.array([row.largest_surface for row in damages]),
        "largest_bottom_strain": np.array([row.largest_bottom for row in damages]),
        "thermal_share": thermal / np.maximum(traffic + thermal, np.finfo(float).tiny),
        "assumed_traffic": np.array(missing, dtype=float),
        "interpolation_error": np.array([row.error for row in damages]),
    }
    variants = {
        HARDENING: {hardening: ages_of(damages, hardening) for hardening in HARDENINGS},
        THERMAL: {multiple: ages_of(damages, 0.0, multiple) for multiple in MULTIPLES},
    }
    about = [f"{name}: {reason}" for name, reason in assumed.reasons.items()]
    if any(missing):
        about.append(
            f"traffic is missing for {sum(missing)} of {len(missing)} sections, and the prior takes its place"
        )
    unknown = sum(not family for family in table.family)
    if unknown:
        about.append(f"the family of the base is missing for {unknown} sections, taken as untreated")
    bottom = np.array([row.bottom_age for row in damages])
    return Predictions(table.sections, ages_of(damages), bottom, parts, variants, tuple(about))


def sections_of(table: SectionTable) -> tuple[RoadSection, ...]:
    """Sections of a table, for the mechanics. Raises InputError for a thickness or climate missing."""
    sections = []
    for k, name in enumerate(table.sections):
        for value, what in ((table.thickness[k], "asphalt thickness"), (table.mean_air[k], "mean air temperature")):
            if not np.isfinite(value):
                raise InputError(
                    f"section {name} has no {what}, without which its age cannot be predicted; give it, or leave the "
                    "section out"
                )
        traffic = float(table.traffic[k]) if np.isfinite(table.traffic[k]) else None
        family = FAMILIES[0] if not table.family[k] else table.family[k]
        place = float(table.thickness[k]), family, traffic, float(table.mean_air[k])
        sections.append(RoadSection(name, *place))
    return tuple(sections)


def _digest(key: str) -> str:
    return hashlib.sha256(f"{__version__} {HARDENINGS} {key}".encode()).hexdigest()[:24]


def _read(path: Path) -> dict[str, SectionDamage]:
    """Sections kept in a file; none where there is no file. Raises InputError for another file."""
    if not path.exists():
        return {}
    try:
        rows = json.loads(text_of(path, "sections that were predicted"))
        return {
            key: SectionDamage(**{**row, "traffic": tuple(row["traffic"]), "thermal": tuple(row["thermal"])})
            for key, row in rows.items()
        }
    except (ValueError, TypeError, AttributeError, KeyError) as error:
        raise InputError(f"{path} holds no predicted sections ({error}); delete it, or name another file") from error


def _write(path: Path, solved: dict[str, SectionDamage]) -> None:
    write_whole(path, json.dumps({key: asdict(row) for key, row in solved.items()}, indent=1))


def ages_of(damages: Sequence[SectionDamage], hardening: float = 0.0, thermal_share: float = 1.0) -> Array:
    """Predicted ages at the surface (n,), years, see `SectionDamage.surface_age`."""
    return np.array([damage.surface_age(hardening, thermal_share) for damage in damages])
