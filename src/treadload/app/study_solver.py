"""Studies and networks that a page starts: many cases, solved one after another in the process of its browser."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

from treadload.app.answers import MOST_CASES, RankedSection
from treadload.case import Case
from treadload.errors import InputError
from treadload.results import save_results
from treadload.sweeps import from_texts, sweep
from treadload.sweeps.network import Network, read_sections, solve_network
from treadload.sweeps.network.solution import ranking
from treadload.units import remaining_in_words, years_in_words

MOST_SECTIONS = 500
"""Sections of a network that a page ranks."""
# Cases of a wheel whose pressure is kept for the map.
_WITH_FIELD = 60

Progress = Callable[[int, int, str], None]


def solve_study(
    table: dict[str, object], varied: Sequence[str], folder: Path, file: Path, progress: Progress
) -> None:
    """Solve a case for values of its inputs and write the study to a file.

    varied: "key=low:high:count" each. folder: of uploaded files. Raises InputError for too many cases.
    """
    case = Case.from_dict(table, folder=folder, name="case")
    design = from_texts(case, varied)
    if design.count > MOST_CASES:
        raise InputError(
            f"this study has {design.count} cases, and a page solves {MOST_CASES} at most; take fewer values, or use "
            "`treadload sweep`"
        )
    fields = ("pressure",) if case.command == "run" and design.count <= _WITH_FIELD else ()
    study = sweep(case, design, fields=fields, progress=progress)
    if not study.stats["solved"]:
        reason = study.failures[0][1] if study.failures else "no case was solved"
        raise InputError(f"every case of this study failed: {reason}")
    save_results(study, file)


def rank_sections(
    table: dict[str, object], sections: Path, shown: str, folder: Path, file: Path, progress: Progress
) -> Network:
    """Rank the sections of a table by their remaining life and write the network to a file.

    sections: the uploaded table. shown: its name as the user knows it. Raises InputError.
    """
    case = Case.from_dict(table, folder=folder, name="case")
    listed = read_sections(case, sections)
    if len(listed.names) > MOST_SECTIONS:
        raise InputError(
            f"{shown} has {len(listed.names)} sections, and a page ranks {MOST_SECTIONS} at most; use "
            "`treadload network`"
        )
    network = solve_network(case, listed, progress=progress)
    if not network.ranked:
        reason = next((str(text) for text in network.dataset["reason"].to_numpy() if text), "none was solved")
        raise InputError(f"no section of {shown} could be ranked: {reason}")
    save_results(network, file)
    return network


def ranked_sections(network: Network) -> list[RankedSection]:
    """Rows of the ranked table, the least remaining life first; sections that failed last, with their reasons."""
    data = network.dataset
    order = [int(number) for number in ranking(data)]
    order += sorted(set(range(data.sizes["section"])) - set(order))
    rows: list[RankedSection] = []
    for number in order:
        at = data.isel(section=number)
        rank = int(at["section_rank"])
        place = float(at["section_position"])
        rows.append(
            RankedSection(
                number=number, rank=str(rank) if rank else "–", section=str(at["section"].item()),
                station="" if math.isnan(place) else f"{place / 1e3:.3f}",
                age=f"{float(at['section_age']):.3g}",
                remaining=remaining_in_words(float(at["remaining_years"])) if rank else "–",
                service_life=years_in_words(float(at["governing_years"])) if rank else "–",
                governing=str(at["governing_criterion"].item()) if rank else str(at["reason"].item()),
            )
        )  # fmt: skip
    return rows
