"""The answer at a glance: service life or load repetitions, the governing criterion, its place, why, and the map."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping
from typing import cast

from treadload.app.answers import Card
from treadload.composing import BaseResult
from treadload.damage import Life, Verdict
from treadload.damage.quantity import Reading
from treadload.damage.unevaluated import bright_spot
from treadload.plots.kit.style import signed
from treadload.reporting.typesetting import with_powers
from treadload.response import Response
from treadload.steps.allowed import Allowed, PassesAllowed
from treadload.units import repetitions_in_words, years_in_words

Parts = Mapping[str, BaseResult]
# Criteria beside the governing one that a card lists.
_MOST_LINES = 5


def card_of(parts: Parts, allowed: PassesAllowed | None = None) -> Card | None:
    """The card of a run; None before anything is assessed.

    allowed: load repetitions by criterion, which are known last; until then the law of the case stands alone.
    """
    life, verdict = parts.get("life"), parts.get("damage")
    if isinstance(life, Life):
        return _of_life(life)
    if allowed is not None and allowed.rows:
        return _of_allowed(allowed, parts)
    if isinstance(verdict, Verdict):
        return _of_verdict(verdict, parts)
    return None


def _of_life(life: Life) -> Card:
    governing, years = life.governing, life.years(life.governing)
    design = life.dataset.attrs.get("design_years")
    names = [criterion.name for criterion in life.criteria]
    lines = [f"{name}: does not govern, {years_in_words(life.years(name))}" for name in names if name != governing][
        :_MOST_LINES
    ]
    if math.isinf(years):
        return Card(
            state="meets", headline="No criterion ends the service life", facts=[], not_governing=lines, map=""
        )
    state, why = "open", "no design life is given"
    if design is not None:
        state = "meets" if years >= float(design) else "short"
        why = f"{'at least' if state == 'meets' else 'less than'} the design life of {float(design):g} years"
    facts = [("Design life", why), ("Governing criterion", governing)]
    criterion = next((part for part in life.criteria if part.name == governing), None)
    if criterion is not None:
        at = life.dataset.sel(criterion=governing)
        deep = f", {1e3 * float(at['read_depth']):.0f} mm deep" if "read_depth" in at else ""
        between = json.loads(life.dataset.attrs.get("between", "{}")).get(governing)
        number = f"layer {criterion.layer + 1}" if criterion.layer >= 0 else "the last layer"
        layer = between or f"{criterion.place} of {number}"
        facts.append(("Place", f"{layer}{deep}, y = {signed(1e3 * float(at['worst_y']), 0)} mm"))
        quantity = criterion.quantity
        facts.append(("Why", f"{quantity}: up to {quantity.in_words(float(at['largest_reading']))}"))
    return Card(
        state=state, headline=f"Service life {years_in_words(years)}", facts=facts, not_governing=lines, map=""
    )


def _of_allowed(allowed: PassesAllowed, parts: Parts) -> Card:
    first = min(allowed.rows, key=lambda line: line.passes)
    count = Counter(line.name for line in allowed.rows)
    # One law of several layers is named with the layer.
    called = {
        row: f"{line.name}, {line.layer}" if count[line.name] > 1 else line.name
        for row, line in enumerate(allowed.rows)
    }
    lines = [
        f"{called[row]}: does not govern, {_repetitions(line)}"
        for row, line in enumerate(allowed.rows) if line is not first
    ]  # fmt: skip
    bright = _bright(parts)
    if not math.isfinite(first.passes):
        facts = [("Why", "no criterion evaluates a harmful value under this load")]
        names = [f"{name}: does not govern" for name in called.values()]
        return Card(
            state="meets", headline="No criterion governs", facts=facts, not_governing=names[:_MOST_LINES], map=bright
        )
    deep = "surface" if first.depth == 0 else f"{first.depth * 1e3:g} mm deep"
    place = ", ".join(part for part in (first.layer, first.place, deep) if part)
    beyond = ", outside the range of its tests" if first.extrapolated else ""
    facts = [
        ("Governing criterion", first.name),
        ("Place", f"{place}; x = {signed(1e3 * first.x, 0)} mm, y = {signed(1e3 * first.y, 0)} mm"),
        ("Why", f"{first.reads}: {first.reads.in_words(first.reading)}{beyond}"),
    ]
    headline = _counted(first.passes)
    return Card(state="open", headline=headline, facts=facts, not_governing=lines[:_MOST_LINES], map=bright)


def _repetitions(line: Allowed) -> str:
    return _counted(line.passes) if line.reading > 0 else "nothing harmful there"


def _counted(passes: float) -> str:
    return f"{with_powers(repetitions_in_words(passes))} load repetitions"


def _of_verdict(verdict: Verdict, parts: Parts) -> Card:
    """The fatigue law of the case alone."""
    data, strain = verdict.dataset, float(verdict.dataset["worst_strain"])
    lines = ["criteria of the layers follow"]
    if not strain > 0:
        facts = [("Why", verdict.rows()[-1].text)]
        return Card(
            state="meets",
            headline="The fatigue law does not govern",
            facts=facts,
            not_governing=lines,
            map=_bright(parts),
        )
    x, y, depth = (1e3 * float(data[f"worst_{name}"]) for name in ("x", "y", "depth"))
    deep = f"{depth:.0f} mm deep" if depth > 0 else "surface"
    facts = [
        ("Criterion", "fatigue law of the case"),
        ("Place", f"{deep}; x = {signed(x, 0)} mm, y = {signed(y, 0)} mm"),
        ("Why", f"{'in-plane' if verdict.strain == 'in-plane' else 'largest principal'} tensile strain, "
                f"{data.attrs.get('reading', 'local')}: {strain * 1e6:.3g} microstrain"),
    ]  # fmt: skip
    headline = _counted(float(data["worst_passes"]))
    return Card(state="open", headline=headline, facts=facts, not_governing=lines, map=_bright(parts))


def _bright(parts: Parts) -> str:
    """What the brightest spot of the strain map is, where it is not what the law of the case evaluates."""
    response, verdict = parts.get("response"), parts.get("damage")
    if not isinstance(response, Response) or not isinstance(verdict, Verdict):
        return ""
    about = verdict.dataset.attrs
    mean_over = about.get("mean_over")
    evaluated = max(0.0, float(verdict.dataset["worst_strain"]))
    sentences = bright_spot(
        response, cast("Reading", verdict.strain), evaluated, None if mean_over is None else float(mean_over)
    )
    if sentences:
        return f"{sentences[0][:1].upper()}{sentences[0][1:]}."
    return "The largest strain of the map is what the fatigue law of the case evaluates."
