"""What roads show beside what the mechanics predict: a factor with its data, its error and the scatter of roads.

A shift is named and turned on by a case; nothing takes one silently.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from statistics import NormalDist
from typing import Literal

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.named import Catalogue, read_tables, sentence

Line = Literal["fresh", "aged"]
LINES: tuple[Line, ...] = ("fresh", "aged")
"""Fatigue lines at the surface: of a young mix, b = -0.2, and of old cores, b = -0.342."""
MIDDLE = 0.9
"""Share of roads that stated ranges hold: between 5 and 95 %."""
UNSUPPORTED = (
    "thickness and traffic are ordered by the mechanics alone, which these data do not support: fitted to roads, the "
    "mechanics know nothing of which road cracks first"
)


@dataclass(frozen=True)
class FieldShift:
    """Age of the first crack that a set of roads shows, and the factor from the mechanics to it.

    name: in the catalogue. event: whose age it is. likelihood: by which it was fitted. sections: how many roads.
    date: of the fit. level: median age, years; level_error: standard error of its ln. scatter: standard deviation of
    ln age over roads; scatter_error: its standard error. lag: mean years from crack to overlay. predicted_fresh,
    predicted_aged: geometric means over the sections of the years that the mechanics predict at the surface, by the
    `LINES`. thickness: of the asphalt, m, mean_surface: of the road's surface over the year, °C, and traffic:
    standard axles of 80 kN a year, within which the shift holds. mean_air: of the sections' air over the year, °C,
    from which mean_surface follows by the priors. source: of the data. caveats: what is not certain, a sentence each.
    Raises InputError.

    >>> shift = tl.damage.field_shifts["LTPP"]
    >>> [f"{shift.years(share):.0f}" for share in (0.05, 0.5, 0.95)]  # years until 5, 50, 95 % of the roads crack
    ['2', '5', '18']
    >>> shift.outside(thickness=0.6)
    'asphalt of 600 mm, outside 42 to 309 mm'
    """

    name: str
    event: str
    likelihood: str
    sections: int
    date: str
    level: float
    level_error: float
    scatter: float
    scatter_error: float
    lag: float
    predicted_fresh: float
    predicted_aged: float
    thickness: tuple[float, float]
    mean_air: tuple[float, float]
    mean_surface: tuple[float, float]
    traffic: tuple[float, float]
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        for name in ("level", "level_error", "scatter", "predicted_fresh", "predicted_aged"):
            positive(f"{name} of the field shift {self.name!r}", getattr(self, name))
        for name in ("thickness", "mean_air", "mean_surface", "traffic"):
            low, high = getattr(self, name)
            if not low < high:
                raise InputError(
                    f"{name} of the field shift {self.name!r} must be a range [low, high], got [{low:g}, {high:g}]"
                )

    def __str__(self) -> str:
        median = f"median {self.level:.2g} years, scatter {self.scatter:.2f} of ln age"
        return f"{self.event}, {median}, {self.sections} roads"

    __repr__ = as_call

    def predicted(self, line: Line) -> float:
        """Geometric mean of the years that the mechanics predict for the sections, by a line."""
        if line not in LINES:
            raise InputError(f"line must be one of {', '.join(LINES)}, got {line!r}")
        return self.predicted_fresh if line == "fresh" else self.predicted_aged

    def factor(self, line: Line = "fresh") -> float:
        """Years of roads over years of the mechanics."""
        return self.level / self.predicted(line)

    def years(self, probability: float = 0.5) -> float:
        """Years by which a share of roads of this kind shows the event, whatever the mechanics predict."""
        return self.level * self._spread(probability)

    def shifted(self, years: float, probability: float = 0.5, line: Line = "fresh") -> float:
        """Years by which roads with a predicted life, years, show the event with a probability.

        The factor takes the mechanics to the level of the roads, and their scatter is that of all roads.
        """
        return years * self.factor(line) * self._spread(probability)

    def _spread(self, probability: float) -> float:
        if not 0 < probability < 1:
            raise InputError(f"a probability must lie between 0 and 1, got {probability:g}")
        return math.exp(self.scatter * NormalDist().inv_cdf(probability))

    @property
    def range(self) -> tuple[float, float]:
        """Years at 5 and 95 % of roads of this kind."""
        return self.years((1 - MIDDLE) / 2), self.years((1 + MIDDLE) / 2)

    @property
    def roads_show(self) -> str:
        """What is known of roads of this kind without the mechanics, in a sentence."""
        low, high = self.range
        return (
            f"roads of this kind show the {self.event} after {low:.2g} to {high:.2g} years "
            f"({100 * MIDDLE:g} %, {self.name})"
        )

    @property
    def ranks(self) -> str:
        """The factor between mechanics and roads, and what the mechanics are good for, in a sentence."""
        late = [f"{float(f'{1 / self.factor(line):.2g}'):g} by the {line} line" for line in LINES]
        return (
            f"for them the mechanics alone are late by a factor of {' and '.join(late)}: mechanics rank alternatives "
            "and forecast no years at the surface"
        )

    def outside(
        self, thickness: float | None = None, mean_surface: float | None = None, traffic: float | None = None
    ) -> str:
        """Why a road is not of this kind, in words; "" where it is.

        thickness: of the asphalt, m. mean_surface: of the road's surface over the year, °C. traffic: standard axles
        of 80 kN a year.
        """
        reasons = []
        for value, (low, high), scale, unit, what in (
            (thickness, self.thickness, 1e3, "mm", "asphalt"),
            (mean_surface, self.mean_surface, 1.0, "°C", "mean surface temperature"),
            (traffic, self.traffic, 1e-3, "thousand standard axles a year", "traffic"),
        ):
            if value is not None and not low <= value <= high:
                reasons.append(
                    f"{what} of {scale * value:.3g} {unit}, outside {scale * low:.3g} to {scale * high:.3g} {unit}"
                )
        return "; ".join(reasons)


def read_field_shifts(path: str | os.PathLike[str]) -> list[FieldShift]:
    """The shift of a TOML file, in a list; its keys are the fields of `FieldShift`. Raises InputError.

    >>> from pathlib import Path
    >>> folder = Path(tl.catalogue.__file__).parent / "data"
    >>> (shift,) = tl.damage.read_field_shifts(folder / "field_shifts" / "ltpp.toml")
    >>> f"median of {shift.years(0.5):.0f} years"
    'median of 5 years'
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    shift: FieldShift = read(FieldShift, read_tables(Path(path)), str(path))
    texts = {name: sentence(getattr(shift, name)) for name in ("source", "likelihood")}
    return [FieldShift(**{**vars(shift), **texts, "caveats": tuple(map(sentence, shift.caveats))})]


field_shifts: Mapping[str, FieldShift] = Catalogue(
    "field shift",
    (FieldShift,),
    folder="field_shifts",
    read=read_field_shifts,
    words=str,
    group="treadload.field_shifts",
    use='shift = "LTPP" in [field_shift] of a case',
)
"""Shifts from the mechanics to roads, by name."""

DEFAULT = "LTPP"
"""Roads whose ages are stated beside every life of the surface."""
