"""What a field bench found: level, scatter and lag, scores on unseen sections, shares, the power of the mechanics."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.damage.field_shift import UNSUPPORTED, FieldShift
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.life.field.fit import DROP
from treadload.life.field.likelihood import KINDS, WHY_LATE, Parameters, Sections, log_likelihood
from treadload.life.field.priors import Priors
from treadload.life.field.scores import Gain
from treadload.life.field.table import FEWEST, Event, SectionTable
from treadload.rows import Row, row

EVENT_IN_WORDS = {
    "wheel-path": "first wheel-path crack",
    "wheel-path or alligator": "first wheel-path or alligator crack",
}
"""What an event is called in a sentence."""
AGE_ONLY, PLAIN, TRUSTED, FITTED = "ages, overlay lag", "ages, plain", "mechanics, power 1", "mechanics, power fitted"
"""Models whose log scores on unseen sections are compared."""
_EACH = [f"{name}{end}" for name in ("level", "scatter", "lag") for end in ("", "_low", "_high", "_error")]

_OF_POWER = ("power", "power_low", "power_high", "mechanics_level", "field_factor")


def _check(data: xr.Dataset) -> None:
    """Raise InputError for an event that the bench does not have, and a profile of the power without its interval."""
    event = data.attrs.get("event")
    if not isinstance(event, str) or event not in EVENT_IN_WORDS or event not in data["event"].to_numpy():
        raise InputError(f"it has no event {event!r}; it has {', '.join(map(str, data['event'].to_numpy()))}")
    if "power_profile" in data and not set(_OF_POWER) <= set(data.attrs):
        raise InputError(f"it has a profile of the power, and needs the attributes {', '.join(_OF_POWER)}")


@dataclass(frozen=True, eq=False)
class FieldLook(BaseResult, group="field_look"):
    """Shares of a table's sections that have cracked so far, by class of age, without any fit.

    dataset: cell_sections, seen_share (event, cell). warnings: sentences about what the table does not have.

    >>> look = tl.life.field_look("LTPP")
    >>> shares = look.dataset.seen_share.sel(event="wheel-path").values
    >>> f"from {shares.min():.0%} to {shares.max():.0%} of the sections have cracks, by class of age"
    'from 0% to 100% of the sections have cracks, by class of age'
    """

    title: ClassVar[str] = "Road sections"
    subject: ClassVar[str] = "What a table of road sections shows"
    holds: ClassVar[Holds] = Holds(
        {"cell_sections seen_share": "event cell", "cell_age": "cell"},
        labels={"event": "event", "cell": "cell"},
        texts="table",
        numbers="sections",
    )

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def rows(self) -> tuple[Row, ...]:
        """The table, and the share cracked by class of age."""
        data = self.dataset
        count = int(data.attrs["sections"])
        note = f"too few for a fit, which needs {FEWEST}" if count < FEWEST else ""
        rows = [row("field_table", f"{data.attrs['table']}, {count} sections", note=note)]
        for k, cell in enumerate(map(str, data["cell"].to_numpy())):
            if not data["cell_sections"][:, k].any():
                continue
            rows.append(row("cell_sections", data["cell_sections"][0, k], group=cell))
            rows += [
                row("seen_share", data["seen_share"][number, k], label=f"seen {event}", group=cell)
                for number, event in enumerate(map(str, data["event"].to_numpy()))
            ]
        return tuple(rows)


@dataclass(frozen=True, eq=False)
class FieldBench(BaseResult, group="field_bench"):
    """What a table of road sections shows about the age of the first crack, and of mechanics that predict it.

    dataset: crack_level, crack_scatter, crack_lag with _low, _high, their 95 % interval, and _error of ln (event,
    likelihood); log_score, score_gain over ages with a lag, score_gain_error (model), nats; cell_sections,
    seen_share, predicted_share, share_error (cell), for unseen folds; cracked_share of all roads built with _low and
    _high, and cracked_share_plain (age); entry_age, entry_sections, entry_seen, entry_predicted, entry_plain,
    entry_level (entry); transform_low, transform_high (section); with mechanics power_profile (power),
    predicted_surface, predicted_bottom (section), and variant_profile (variant). stats: fits and processor time, s.
    warnings: sentences for the user.

    >>> bench = tl.open_results("field_bench.nc").field_bench  # of tl.life.field_bench("LTPP"), which takes 10 s
    >>> level = bench.dataset.crack_level.sel(event="wheel-path", likelihood="overlay-lag").item()
    >>> f"median age of the first crack: {level:.1f} years"
    'median age of the first crack: 5.2 years'
    """

    title: ClassVar[str] = "What roads show"
    subject: ClassVar[str] = "Cracks of road sections compared with the mechanics"
    holds: ClassVar[Holds] = Holds(
        {
            **dict.fromkeys([" ".join(f"crack_{name}" for name in _EACH)], "event likelihood"),
            "log_score score_gain score_gain_error": "model",
            "cell_age cell_sections seen_share predicted_share share_error": "cell",
            "cracked_share cracked_share_low cracked_share_high cracked_share_plain": "age",
            "age": "age",
            "entry_age entry_sections entry_seen entry_predicted entry_plain entry_level": "entry",
            "transform_low transform_high": "section",
        },
        maybe={
            "power_profile": "power",
            "power": "power",
            "predicted_surface predicted_bottom": "section",
            "variant_profile": "variant",
        },
        labels={"event": "event", "likelihood": "likelihood", "model": "model", "cell": "cell", "section": "section"},
        with_it={"power_profile": "power", "variant_profile": "variant"},
        values={"likelihood": KINDS},
        above_zero=" ".join(f"crack_{name}" for name in _EACH if not name.endswith(("error", "low"))),
        numbers="sections covered_mass surely_outside",
        maybe_numbers="predicted_aged power power_low power_high mechanics_level field_factor",
        together=("power power_low power_high mechanics_level field_factor",),
        texts="table event cells source",
        lists="about",
        json={"thickness_range": list, "mean_air_range": list, "traffic_range": list},
        stats=("fits seconds",),
        agree=lambda data: _check(data),
    )

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def event(self) -> Event:
        """Whose shares and scores are given."""
        event: Event = self.dataset.attrs["event"]
        return event

    def parameters(self, event: Event | None = None, likelihood: str = "overlay-lag") -> Parameters:
        """Of ages alone by an event and a likelihood: the model that unseen sections support."""
        at = self._fit(event, likelihood)
        lag = float(at["crack_lag"])
        return Parameters(float(at["crack_level"]), float(at["crack_scatter"]), math.inf if math.isnan(lag) else lag)

    def score_on(self, table: SectionTable) -> float:
        """Log score, nats, of the fit of ages with a lag on the sections of another table."""
        sections = Sections(table.interval(self.event), table.entry, np.zeros(len(table)))
        return float(log_likelihood(sections, self.parameters(), "overlay-lag").sum())

    def shift(self, name: str, date: str, priors: Priors | None = None) -> FieldShift:
        """A field shift of this bench.

        name: of the shift. date: of the fit. priors: by which its range of air temperature becomes one of the
        surface; left out, the defaults.

        Raises InputError for a bench without mechanics.
        """
        data = self.dataset
        if "field_factor" not in data.attrs or "predicted_aged" not in data.attrs:
            raise InputError("a field shift needs ages of the mechanics by both lines; give predictions to the bench")
        at = self._fit(None, "overlay-lag")
        low, high = json.loads(data.attrs["thickness_range"])
        air, traffic = (json.loads(data.attrs[f"{key}_range"]) for key in ("mean_air", "traffic"))
        cold, warm = ((priors or Priors()).mean_surface(end) if math.isfinite(end) else end for end in air)
        level, scatter = float(at["crack_level"]), float(at["crack_scatter"])
        return FieldShift(
            name, EVENT_IN_WORDS[self.event], "interval-censored lognormal age, conditional on no overlay before the "
            "first survey, with an exponential lag from crack to overlay", int(data.attrs["sections"]), date,
            level, float(at["crack_level_error"]), scatter, float(at["crack_scatter_error"]) * scatter,
            float(at["crack_lag"]), float(data.attrs["mechanics_level"]), float(data.attrs["predicted_aged"]),
            (low, high), tuple(air), (cold, warm), tuple(traffic), str(data.attrs["source"]),
        )  # fmt: skip

    def _fit(self, event: Event | None, likelihood: str) -> xr.Dataset:
        return self.dataset.sel(event=event or self.event, likelihood=likelihood)

    def rows(self) -> tuple[Row, ...]:
        """The table, levels by event and likelihood, scores, the mechanics, shares by class, and intervals."""
        data = self.dataset
        sections = int(data.attrs["sections"])
        rows = [row("field_table", f"{data.attrs['table']}, {sections} sections: {EVENT_IN_WORDS[self.event]}")]
        for event in map(str, data["event"].to_numpy()):
            for kind in map(str, data["likelihood"].to_numpy()):
                rows += self._level_rows(data.sel(event=event, likelihood=kind), f"{event}, {kind}")
        rows.append(row("why_late", WHY_LATE))
        for model in map(str, data["model"].to_numpy()):
            at = data.sel(model=model)
            gained = Gain(float(at["score_gain"]), float(at["score_gain_error"]))
            rows.append(row("log_score", at["log_score"], group=model))
            rows.append(row("score_gain", gained.nats, group=model))
            rows.append(row("score_gain_error", gained.error, group=model))
            rows.append(row("score_verdict", gained.in_words if gained.error else "–", group=model))
        rows += self._mechanics_rows()
        for k, cell in enumerate(map(str, data["cell"].to_numpy())):
            names = ("cell_sections", "seen_share", "predicted_share", "share_error")
            rows += [row(name, data[name][k], group=cell) for name in names]
        rows.append(row("cells", str(data.attrs["cells"])))
        rows.append(row("covered_mass", float(data.attrs["covered_mass"])))
        rows.append(row("surely_outside", float(data.attrs["surely_outside"])))
        rows.append(row("verdict", self._verdict()))
        return tuple(rows)

    def _level_rows(self, at: xr.Dataset, group: str) -> list[Row]:
        ends = ("crack_level", "crack_level_low", "crack_level_high", "crack_level_error")
        return [row(name, at[name], group=group) for name in (*ends, "crack_scatter", "crack_lag")]

    def _mechanics_rows(self) -> list[Row]:
        data = self.dataset
        if "power_profile" not in data:
            return []
        low, high = (float(data.attrs[f"power_{end}"]) for end in ("low", "high"))
        rows = [
            row(
                "power",
                float(data.attrs["power"]),
                note=f"95 % {low:.2f} to {high:.2f}; 1 trusts the mechanics, 0 leaves them out",
            ),
            row("mechanics_level", float(data.attrs["mechanics_level"])),
            row("field_factor", float(data.attrs["field_factor"])),
        ]
        if low < 0 and high < 1:
            rows.append(row("unsupported", UNSUPPORTED))
        if "variant_profile" in data:
            drops = dict(zip(map(str, data["variant"].to_numpy()), map(float, data["variant_profile"]), strict=True))
            text = ", ".join(f"{name}: {drop:.1f}" for name, drop in drops.items())
            apart = [name for name, drop in drops.items() if drop < -DROP]
            end = (
                f"distinguished: {', '.join(apart)}"
                if apart
                else f"not distinguished by these data (less than {DROP} nats)"
            )
            rows.append(row("variants", f"{text}; {end}"))
        rows += [row("about_mechanics", text) for text in json.loads(data.attrs["about"])]
        return rows

    def _verdict(self) -> str:
        parameters, at = self.parameters(), self._fit(None, "overlay-lag")
        low, high = (parameters.level * math.exp(sign * 1.645 * parameters.scatter) for sign in (-1, 1))
        late = float(self._fit(None, "plain")["crack_level"]) / parameters.level
        text = (
            f"half of these roads show the {EVENT_IN_WORDS[self.event]} by {parameters.level:.2g} years, times or "
            f"over {math.exp(float(at['crack_level_error'])):.2f}, and 90 % of them between {low:.2g} and {high:.2g} "
            f"years; the plain fit is late by {late:.2g}"
        )
        if TRUSTED not in self.dataset["model"]:
            return f"{text}."
        lost = -float(self.dataset["score_gain"].sel(model=TRUSTED))
        return (
            f"{text}; the mechanics with the power 1 lose {lost:.0f} nats on unseen sections, and the power that "
            f"fits is {float(self.dataset.attrs['power']):z.2f}."
        )
