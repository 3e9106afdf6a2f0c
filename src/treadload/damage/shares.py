"""Shares of a whole: of passes among classes, tracks and seasons."""

from __future__ import annotations

import math
from collections.abc import Sequence

from treadload.errors import InputError

# Shares that come from a table with few digits.
_ROUND_OFF = 1e-6


def check_shares(what: str, shares: Sequence[float]) -> None:
    """Raise InputError unless shares lie in [0, 1] and sum to 1. what: a word for whose they are."""
    if not all(0 <= share <= 1 for share in shares):
        raise InputError(f"the shares of a {what} must lie in [0, 1], got {list(shares)}")
    total = math.fsum(shares)
    if abs(total - 1) > _ROUND_OFF:
        raise InputError(f"the shares of a {what} must sum to 1, got {total:.6g}; give fractions, not per cent")
