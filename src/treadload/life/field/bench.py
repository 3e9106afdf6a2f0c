"""The field bench: what a table of road sections shows about the age of cracks, and of mechanics that predict it."""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Callable, Mapping
from typing import TypeVar

import numpy as np

from treadload.kernels.arrays import Array
from treadload.life.field.cells import cells_of, entries_of, in_words, looked_at, shares_of_all
from treadload.life.field.fit import NAMES, Fit, Model, fit
from treadload.life.field.likelihood import KINDS, Kind, Sections
from treadload.life.field.prediction import HARDENING, Predictions
from treadload.life.field.scores import Folds, coverage, folds_of, gain, transform
from treadload.life.field.solution import AGE_ONLY, FITTED, PLAIN, TRUSTED, FieldBench, FieldLook
from treadload.life.field.table import Event, SectionTable
from treadload.life.field.table_file import read_field_table
from treadload.variables import dataset

Progress = Callable[[int, int, str], None]
Table = SectionTable | str | os.PathLike[str]
Result = TypeVar("Result")
Fields = dict[str, tuple[tuple[str, ...], Array]]

AGES = np.concatenate([np.linspace(0.25, 10, 40), np.linspace(10.5, 40, 60)])
POWERS = np.round(np.concatenate([np.arange(-0.4, 0.4, 0.02), np.arange(0.4, 1.21, 0.1)]), 3)
_DRAWS = 400
# Years of a section whose predicted damage is none: beyond, ln of the age would decide the fit.
_LONGEST = 1e6


def field_look(table: Table) -> FieldLook:
    """What a table of sections shows without any fit: shares cracked so far, by class of age; of few sections, too.

    table: sections, the name of a table of the catalogue, or a TOML file. Raises InputError.

    >>> look = tl.life.field_look("LTPP").dataset
    >>> shares = look.seen_share.sel(event="wheel-path").values
    >>> [f"{share:.0%}" for share in shares[:4]]  # of sections that have cracked, by class of age
    ['0%', '40%', '62%', '70%']
    """
    sections = _opened(table)
    rows = {event: looked_at(sections, event) for event in sections.events}
    dims = ("event", "cell")
    data = dataset(
        {
            "cell_sections": (dims, np.array([[row[1] for row in cells] for cells in rows.values()], dtype=float)),
            "seen_share": (dims, np.array([[row[2] for row in cells] for cells in rows.values()])),
            "cell_age": (("cell",), np.array([row[3] for row in next(iter(rows.values()))])),
        },
        {"event": list(rows), "cell": [row[0] for row in next(iter(rows.values()))]},
        table=sections.name,
        sections=len(sections),
        source=sections.source,
    )
    return FieldLook(data, warnings=sections.warnings)


def field_bench(
    table: Table,
    predictions: Predictions | None = None,
    *,
    event: Event = "wheel-path",
    progress: Progress | None = None,
) -> FieldBench:
    """What a table of road sections shows about the age of the first crack, and of mechanics that predict it.

    The ages are interval-censored and lognormal, conditional on being in the table at the first survey; parameters
    are ln of the level, the scatter, the lag from crack to overlay and the power of the mechanics, fitted by maximum
    likelihood. Models are compared by the log score over unseen folds.
    table: sections, the name of a table of the catalogue, or a TOML file. predictions: ages of the mechanics; left
    out, the ages alone. event: whose shares and scores are given. progress: called after every fit or fold.
    Raises InputError for fewer than 30 sections, among others.

    >>> bench = tl.open_results("field_bench.nc").field_bench  # of tl.life.field_bench("LTPP"), which takes 10 s
    >>> level = bench.dataset.crack_level.sel(event="wheel-path", likelihood="plain").item()
    >>> f"a plain fit is late: {level:.1f} years"
    'a plain fit is late: 9.9 years'
    """
    start = time.process_time()
    sections = _opened(table)
    sections.check_fit()
    interval = sections.interval(event)
    mechanics = None if predictions is None else predictions.of(sections)
    index, caveats = (np.zeros(len(sections)), []) if mechanics is None else index_of(mechanics.surface)
    with_index = Sections(interval, sections.entry, index)
    ages = Sections(interval, sections.entry, np.zeros(len(sections)))
    models = {AGE_ONLY: (ages, Model()), PLAIN: (ages, Model("plain"))}
    if mechanics is not None:
        models |= {TRUSTED: (with_index, Model(power=1.0)), FITTED: (with_index, Model(with_power=True))}
    steps = len(sections.events) * len(KINDS) + len(models) + 2
    count = _Counter(steps, progress)
    fits = {
        name: {kind: count.after(fit(_sections(sections, name), Model(kind)), "fit") for kind in KINDS}
        for name in sections.events
    }
    folds = {name: count.after(folds_of(*model), "model") for name, model in models.items()}
    best = fits[event]["overlay-lag"]
    cells, entries = cells_of(folds[AGE_ONLY], sections), entries_of(ages, best, fits[event]["plain"])
    covered = coverage(folds[AGE_ONLY])
    fields, texts = _fits(fits), {"cells": in_words(cells)}
    fields |= _scores(folds) | _curves(best, fits[event]["plain"])
    fields |= {
        "cell_age": (("cell",), np.array([cell.age for cell in cells])),
        "cell_sections": (("cell",), np.array([float(cell.count) for cell in cells])),
        "seen_share": (("cell",), np.array([cell.seen for cell in cells])),
        "predicted_share": (("cell",), np.array([cell.predicted for cell in cells])),
        "share_error": (("cell",), np.array([cell.error for cell in cells])),
        "entry_age": (("entry",), np.array([entry.age for entry in entries])),
        "entry_sections": (("entry",), np.array([float(entry.count) for entry in entries])),
        "entry_seen": (("entry",), np.array([entry.seen for entry in entries])),
        "entry_predicted": (("entry",), np.array([entry.predicted for entry in entries])),
        "entry_plain": (("entry",), np.array([entry.plain for entry in entries])),
        "entry_level": (("entry",), np.array([entry.level for entry in entries])),
    }
    low, high = transform(folds[AGE_ONLY])
    fields |= {"transform_low": (("section",), low), "transform_high": (("section",), high)}
    numbers: dict[str, float] = {"covered_mass": covered.share, "surely_outside": covered.outside}
    places: dict[str, list[str] | Array] = {}
    count.after(None, "share")
    if mechanics is not None:
        more, stated, places = _mechanics(with_index, mechanics, best)
        fields, numbers = fields | more, numbers | stated
    count.after(None, "profile")
    attributes = {
        "table": sections.name, "sections": len(sections), "event": event, "source": sections.source,
        "thickness_range": _range(sections.thickness), "mean_air_range": _range(sections.mean_air),
        "traffic_range": _range(sections.traffic),
        "about": json.dumps(mechanics.about if mechanics else (), ensure_ascii=False), **texts, **numbers,
    }  # fmt: skip
    coordinates = {
        "event": list(fits), "likelihood": list(KINDS), "model": list(folds), "age": AGES,
        "cell": [cell.name for cell in cells], "section": list(sections.sections), **places,
    }  # fmt: skip
    stats = {"fits": steps, "seconds": time.process_time() - start}
    data = dataset(fields, coordinates, **attributes)
    return FieldBench(data, stats, (*sections.warnings, *caveats))


def index_of(ages: Array) -> tuple[Array, list[str]]:
    """Ln of predicted ages less its mean (n,), and sentences on sections without damage."""
    capped = np.minimum(ages, _LONGEST)
    lost = int((ages > _LONGEST).sum())
    text = f"{lost} of {len(ages)} sections have a predicted age of more than {_LONGEST:g} years and count as that"
    logarithm = np.log(capped)
    return logarithm - logarithm.mean(), [text] if lost else []


def _geometric(ages: Array) -> float:
    """Geometric mean of ages, years."""
    return float(np.exp(np.log(np.minimum(ages, _LONGEST)).mean()))


class _Counter:
    """Tells how many fits are done."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.total, self.done, self.progress = total, 0, progress

    def after(self, result: Result, what: str) -> Result:
        """The result, after a word on it."""
        self.done += 1
        if self.progress is not None:
            self.progress(self.done, self.total, what)
        return result


def _opened(table: Table) -> SectionTable:
    return table if isinstance(table, SectionTable) else read_field_table(table)


def _sections(table: SectionTable, event: Event) -> Sections:
    return Sections(table.interval(event), table.entry, np.zeros(len(table)))


def _fits(fits: Mapping[Event, Mapping[Kind, Fit]]) -> Fields:
    """Level, scatter and lag of every event and likelihood, with the ends of their 95 % intervals and errors."""
    dims = ("event", "likelihood")
    fields: Fields = {}
    for name in NAMES[:3]:
        rows = [[_parameter(fitted, name) for fitted in by_kind.values()] for by_kind in fits.values()]
        value, low, high, error = np.moveaxis(np.array(rows), -1, 0)
        fields |= {
            f"crack_{name}": (dims, value),
            f"crack_{name}_low": (dims, low),
            f"crack_{name}_high": (dims, high),
            f"crack_{name}_error": (dims, error),
        }
    return fields


def _parameter(fitted: Fit, name: str) -> tuple[float, float, float, float]:
    """Value, ends of its interval, and standard error of its ln; NaN where the fit has none."""
    if name not in fitted.values:
        return (np.nan,) * 4
    low, high = fitted.interval(name)
    return float(np.exp(fitted.values[name])), float(np.exp(low)), float(np.exp(high)), fitted.errors[name]


def _scores(folds: Mapping[str, Folds]) -> Fields:
    gains = [gain(folds[AGE_ONLY], model) for model in folds.values()]
    return {
        "log_score": (("model",), np.array([model.score for model in folds.values()])),
        "score_gain": (("model",), np.array([difference.nats for difference in gains])),
        "score_gain_error": (("model",), np.array([difference.error for difference in gains])),
    }


def _curves(best: Fit, plain: Fit) -> Fields:
    share, low, high = shares_of_all(AGES, best, _DRAWS)
    dims = ("age",)
    return {
        "cracked_share": (dims, share), "cracked_share_low": (dims, low), "cracked_share_high": (dims, high),
        "cracked_share_plain": (dims, shares_of_all(AGES, plain, 2)[0]),
    }  # fmt: skip


def _mechanics(
    sections: Sections, mechanics: Predictions, alone: Fit
) -> tuple[Fields, dict[str, float], dict[str, list[str] | Array]]:
    """Profile of the power, of what the mechanics leave open, and the factor from the mechanics to the roads."""
    fitted = fit(sections, Model(with_power=True))
    low, high = fitted.interval("power")
    drops = np.array([fit(sections, Model(power=float(power))).log_likelihood for power in POWERS])
    geometric = _geometric(mechanics.surface)
    numbers = {
        "power": fitted.parameters.power, "power_low": low, "power_high": high,
        "mechanics_level": geometric, "field_factor": alone.parameters.level / geometric,
    }  # fmt: skip
    aged = mechanics.variants.get(HARDENING, {}).get(1.0)
    if aged is not None:
        numbers["predicted_aged"] = _geometric(aged)
    names, values = [], []
    for what, by_value in mechanics.variants.items():
        best = []
        for value, ages in by_value.items():
            part = Sections(sections.interval, sections.entry, index_of(ages)[0])
            best.append(fit(part, Model(with_power=True)).log_likelihood)
            names.append(f"{what} {value:g}")
        values += [likelihood - max(best) for likelihood in best]
    fields: Fields = {
        "power_profile": (("power",), drops - fitted.log_likelihood),
        "predicted_surface": (("section",), mechanics.surface),
        "predicted_bottom": (("section",), mechanics.bottom),
    }
    places: dict[str, list[str] | Array] = {"power": POWERS}
    if names:
        fields["variant_profile"] = (("variant",), np.array(values))
        places["variant"] = names
    return fields, numbers, places


def _range(values: Array) -> str:
    """5 and 95 % of the values of sections, in JSON; without bounds where the table has none."""
    finite = values[np.isfinite(values)]
    return json.dumps([float(v) for v in np.percentile(finite, [5, 95])] if len(finite) else [-math.inf, math.inf])
