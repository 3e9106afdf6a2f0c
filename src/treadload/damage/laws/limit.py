"""A limit: a reading that must not be exceeded once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, overload

import numpy as np

from treadload.damage.quantity import Quantity
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import CRITERIA


@CRITERIA.register("limit")
@dataclass(frozen=True)
class Limit:
    """A limit of a reading of any quantity: below it any number of passes, above it the first one fails.

    reads: the quantity, in a case its word. limit: the largest reading that does no harm, > 0, in its SI unit; text
    carries its own, "0.4 MPa". Raises InputError.

    >>> law = tl.damage.Limit(tl.damage.PrincipalTension(), 1e6)
    >>> law.allowable_passes(2e6), law.allowable_passes(0.5e6)
    (1.0, inf)
    """

    reads: Quantity
    limit: float | str

    source: ClassVar[str] = "a limit with the user's number"
    end_of_life: ClassVar[str] = "a reading has exceeded its limit once"
    calibrated: ClassVar[str] = "by the user's number: a strength, a threshold of damage"
    caveat: ClassVar[str] = ""
    verified: ClassVar[bool] = True
    includes_wander: ClassVar[bool] = False
    by_peak: ClassVar[bool] = True
    """A passage exceeds the limit or does not, however often."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "limit", self.reads.number(self.limit))
        positive(f"limit, of the {self.reads},", self.bound, remedy="it is the largest reading that does no harm")

    @property
    def bound(self) -> float:
        """The limit, SI."""
        return float(self.limit)

    @property
    def validity(self) -> tuple[float, float]:
        """Any reading: a limit extrapolates nothing."""
        return 0.0, np.inf

    @overload
    def allowable_passes(self, strain: float) -> float: ...
    @overload
    def allowable_passes(self, strain: Array) -> Array: ...
    def allowable_passes(self, strain: float | Array) -> float | Array:
        """Inf up to the limit, 1 above it, NaN for NaN."""
        strains = np.asarray(strain, dtype=float)
        passes = np.where(np.isnan(strains), np.nan, np.where(strains > self.bound, 1.0, np.inf))
        return passes if strains.ndim else float(passes)

    @overload
    def allowable_strain(self, passes: float) -> float: ...
    @overload
    def allowable_strain(self, passes: Array) -> Array: ...
    def allowable_strain(self, passes: float | Array) -> float | Array:
        """The limit, however many passes, > 0; InputError otherwise."""
        repetitions = np.asarray(passes, dtype=float)
        if not (repetitions > 0).all():
            raise InputError(f"passes must be positive, got {repetitions.min():g}")
        same = np.full(repetitions.shape, self.bound)
        return same if repetitions.ndim else float(same)

    def __str__(self) -> str:
        return f"limit of the {self.reads}, {self.reads.in_words(self.bound)}"
