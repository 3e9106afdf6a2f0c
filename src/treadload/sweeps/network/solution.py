"""A network of roads as a result: its sections, ranked by the service life that is left."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.citations import SOLVED_WHOLE
from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array, IntArray
from treadload.rows import Row, row
from treadload.sweeps.gathered import FAILED, SOLVED, UNSOLVED
from treadload.sweeps.sweep import causes_of
from treadload.units import remaining_in_words, years_in_words

# Sections and causes of failures that a summary lists.
_FIRST, _CAUSES = 10, 6
BANDS = (0.0, 5.0, 10.0, 20.0)
"""Years of remaining life between which sections are counted."""


@dataclass(frozen=True, eq=False)
class Network(BaseResult, group="network"):
    """Remaining service life of the sections of a network.

    dataset: over `section`: governing_years from the opening, remaining_years, which are these less section_age,
    section_rank from 1 for the least, section_position, section_status, section_length where the table has
    one; life_years (section, criterion);
    governing_criterion and reason as texts. NaN where a section failed or was not solved. stats: sections, seconds.
    warnings: sentences for the user.

    >>> axle = {"name": "cart", "share": 1, "axle_load": "1 kN", "inflation_pressure": "8 bar"}
    >>> profile = {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}
    >>> mix, earth = ({"kind": "elastic", "modulus": modulus, "poisson": 0.35} for modulus in ("5 GPa", "60 MPa"))
    >>> top, soil = {"name": "asphalt", "thickness": "3 cm", "material": mix}, {"name": "soil", "material": earth}
    >>> case = {"tire": {"profile": profile}, "pavement": {"layers": [top, soil]}, "spacing": "1 cm"}
    >>> case |= {"traffic": {"passes_per_year": 1e7, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> line = {"law": "fatigue-line", "epsilon_6": "120 microstrain", "slope": -0.2}
    >>> case["criteria"] = [{"name": "base", "layer": "asphalt", "place": "bottom"} | line]
    >>> from pathlib import Path
    >>> _ = Path("network.csv").write_text('''section;age [years];thickness asphalt [mm]
    ... A;8;40
    ... B;1;30''')
    >>> network = tl.sweeps.solve_network(tl.Case.from_dict(case), "network.csv")
    >>> [int(rank) for rank in network.dataset.section_rank.values]  # 1 has the least service life left
    [2, 1]
    """

    title: ClassVar[str] = "Remaining life of a network"
    subject: ClassVar[str] = "Which sections of a network fail first"
    holds: ClassVar[Holds] = Holds(
        {
            "life_years": "section criterion",
            "governing_years remaining_years section_age section_position section_rank section_status": "section",
        },
        maybe={"section_length": "section"},
        labels={
            "section": "section",
            "criterion": "criterion",
            "governing_criterion": "section",
            "reason": "section",
        },
        codes={"section_status": 3},
        finite="section_age section_rank",
        above_zero="life_years governing_years",
        maybe_numbers="design_years",
        numbers="has_ages",
        texts="network",
    )

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def cites(self) -> tuple[str, ...]:
        """Methods of the lives."""
        return (*SOLVED_WHOLE, "miner")

    @property
    def ranked(self) -> tuple[str, ...]:
        """Names of the solved sections, the least remaining life first."""
        return tuple(str(self.dataset["section"].to_numpy()[k]) for k in ranking(self.dataset))

    def remaining(self, section: str) -> float:
        """Remaining life of a section, years; negative where its service life is over. Raises InputError."""
        names = [str(name) for name in self.dataset["section"].to_numpy()]
        if section not in names:
            raise InputError(f"there is no section {section!r}; {nearest(section, names)}")
        at = self.dataset.isel(section=names.index(section))
        if int(at["section_status"]) == FAILED:
            raise InputError(f"section {section!r} failed: {at['reason'].item()}")
        return float(at["remaining_years"])

    @property
    def heading(self) -> str:
        """How many sections, and of which network."""
        title = str(self.dataset.attrs["network"])
        return f"{self.dataset.sizes['section']} sections{f', {title}' if title else ''}"

    def rows(self) -> tuple[Row, ...]:
        """How many were solved, what governs, the remaining life and its bands, the first sections, what failed."""
        data = self.dataset
        status = data["section_status"].to_numpy()
        good = status == SOLVED
        counts = {"solved": SOLVED, "failed": FAILED, "not solved yet": UNSOLVED}
        texts = [f"{int((status == code).sum())} {name}" for name, code in counts.items() if (status == code).any()]
        rows = [row("section_status", ", ".join(texts))]
        if good.any():
            remaining = data["remaining_years"].to_numpy()[good]
            low, middle, high = np.quantile(remaining, [0.25, 0.5, 0.75], method="nearest")
            note = f"the middle half of the sections from {remaining_in_words(low)} to {remaining_in_words(high)}"
            rows.append(row("remaining_years", middle, label="remaining life (median)", note=note))
            rows.append(row("remaining_bands", "; ".join(f"{count} {band}" for band, count in bands(remaining))))
            if "section_length" in data:
                rows.append(row("remaining_lengths", _lengths(remaining, data["section_length"].to_numpy()[good])))
            governing = Counter(map(str, data["governing_criterion"].to_numpy()[good]))
            rows.append(row("governing", "; ".join(f"{name} ({count})" for name, count in governing.most_common())))
            rows += list(self._first())
        failures = [(int(k), str(data["reason"].to_numpy()[k])) for k in np.flatnonzero(status == FAILED)]
        names = data["section"].to_numpy()
        for text, numbers in list(causes_of(failures).items())[:_CAUSES]:
            more = f" and {len(numbers) - 1} more" if len(numbers) > 1 else ""
            rows.append(row("failed", f"{names[min(numbers)]}{more}: {text}"))
        if self.stats:
            rows.append(row("solved", "{sections} sections, {seconds:.3g} s of solving".format(**self.stats)))
        return tuple(rows)

    def _first(self) -> Iterator[Row]:
        data = self.dataset
        for rank, k in enumerate(ranking(data)[:_FIRST], start=1):
            at = data.isel(section=int(k))
            note = f"by {at['governing_criterion'].item()}"
            if data.attrs["has_ages"]:
                age = float(at["section_age"])
                note += f", {years_in_words(float(at['governing_years']))} from the opening, aged {age:.3g}"
            label = f"remaining life ({rank}. {at['section'].item()})"
            yield row("remaining_years", float(at["remaining_years"]), label=label, note=note)


def ranking(data: xr.Dataset) -> IntArray:
    """Numbers of the solved sections of a network, the least remaining life first."""
    ranks = data["section_rank"].to_numpy()
    order = np.argsort(ranks, kind="stable")
    kept: IntArray = order[ranks[order] > 0]
    return kept


def _lengths(remaining: Array, length: Array) -> str:
    """Kilometres of network between the `BANDS`. length: of each section, m, NaN where it is not known."""
    there = np.isfinite(length)
    shares = bands(remaining[there], length[there] / 1e3)
    return (
        "; ".join(f"{size:.3g} km {band}" for band, size in shares) + f"; {length[there].sum() / 1e3:.3g} km in all"
    )


def bands(remaining: Array, sizes: Array | None = None) -> list[tuple[str, float]]:
    """How many of some remaining lives, years, lie between the `BANDS`, in words; or the sum of their sizes."""
    edges = [-np.inf, *BANDS, np.inf]
    texts = [
        "at their end or beyond",
        *(f"with {low:g} to {high:g} years" for low, high in itertools.pairwise(BANDS)),
    ]
    texts.append(f"with more than {BANDS[-1]:g} years")
    # An edge belongs to the band below it.
    within = [(remaining > low) & (remaining <= high) for low, high in itertools.pairwise(edges)]
    counts = [int(part.sum()) if sizes is None else float(sizes[part].sum()) for part in within]
    return list(zip(texts, counts, strict=True))
