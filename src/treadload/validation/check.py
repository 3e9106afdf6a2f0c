"""One line of the validation table."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """A computed number beside the number it should be.

    group: the problem. quantity: what is compared, with its unit. measured, reference: in that unit.
    deviation: measured minus reference, over the reference where `relative`. bound: largest |deviation|
    allowed. passed: |deviation| ≤ bound; a deviation that is not a number never passes. source: of the reference.
    """

    group: str
    quantity: str
    measured: float
    reference: float
    deviation: float
    bound: float
    passed: bool
    source: str
    relative: bool = True


def relative(group: str, quantity: str, measured: float, reference: float, bound: float, source: str) -> Check:
    """Check of (measured - reference) / reference."""
    measured, reference = float(measured), float(reference)
    deviation = (measured - reference) / reference
    return Check(group, quantity, measured, reference, deviation, bound, abs(deviation) <= bound, source)


def absolute(group: str, quantity: str, measured: float, reference: float, bound: float, source: str) -> Check:
    """Check of measured - reference, in the unit of the quantity."""
    measured, reference = float(measured), float(reference)
    deviation = measured - reference
    return Check(group, quantity, measured, reference, deviation, bound, abs(deviation) <= bound, source, False)
