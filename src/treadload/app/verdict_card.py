"""The answer at a glance: the answer of the assessment, and what the brightest spot of the map is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from treadload.app.answers import Card
from treadload.composing import BaseResult
from treadload.damage import Verdict
from treadload.damage.quantity import Reading
from treadload.damage.unevaluated import bright_spot
from treadload.reporting.typesetting import typeset_text
from treadload.response import Response
from treadload.steps.allowed import PassesAllowed
from treadload.steps.chain import answer_of

Parts = Mapping[str, BaseResult]


def card_of(parts: Parts, allowed: PassesAllowed | None = None) -> Card | None:
    """The card of a run; None before anything is assessed.

    allowed: load repetitions by criterion, which are known last; until then the law of the case alone is assessed.
    """
    answer = answer_of(parts)
    if "life" not in parts and allowed is not None and allowed.rows:
        answer = allowed.answer(answer)
    if answer is None:
        return None
    shown = answer.written(typeset_text)
    return Card(
        state=shown.state, headline=shown.headline, facts=list(shown.facts),
        further=shown.further, map=typeset_text(_bright(parts)),
    )  # fmt: skip


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
