"""A network solved: a service life for each of its sections, as a study of one case."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Sequence

import numpy as np

from treadload import variables
from treadload.case import Case
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array, IntArray
from treadload.sweeps.gathered import FAILED, SOLVED
from treadload.sweeps.network.sections import AGE, Sections, read_sections
from treadload.sweeps.network.solution import Network
from treadload.sweeps.sweep import Progress, Sweep, by_cause, sweep

_GOVERNING = "governing"
# Sections that a sentence names.
_LISTED = 6


def solve_network(
    case: Case,
    sections: str | os.PathLike[str] | Sections,
    *,
    ids: Sequence[str] = (),
    store: str | os.PathLike[str] | None = None,
    jobs: int = 1,
    scheduler: object = None,
    progress: Progress | None = None,
) -> Network:
    """The remaining service life of every section of a network, and the criterion that governs it.

    case: a design case (traffic, climate, criteria) that all sections share but for the columns of their table.
    Criteria name their layers by role, such as layer = "lowest asphalt layer", where structures differ. sections: a
    CSV file or an Excel sheet, see `read_sections`, or what that read. ids: columns that identify sections. store:
    folder *.zarr that keeps what is solved; the same call goes on in it. jobs, scheduler, progress: as in `sweep`.
    The remaining life is the service life from the opening, under the traffic's growth, less the age of the section.
    A section that fails keeps its reason, and the others go on. Contacts of tires are solved once for all sections
    with the same traffic and surface. Raises InputError, and what `sweep` raises.

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
    >>> [f"{years:.1f} years" for years in network.dataset.remaining_years.values]  # of 40 and 30 mm
    ['2.5 years', '0.3 years']
    """
    check_case(case)
    listed = sections if isinstance(sections, Sections) else read_sections(case, sections, ids=ids)
    study = sweep(case, listed.design, store=store, jobs=jobs, scheduler=scheduler, progress=progress)
    return network_of(study, listed)


def check_case(case: Case) -> None:
    """Raise InputError for a case that has no service life."""
    if case.command != "life":
        raise InputError(
            "a network needs a design case, with [traffic], [climate] and [[criteria]]; `treadload init life` "
            f"writes one, and this one is for `treadload {case.command}`"
        )


def network_of(study: Sweep, listed: Sections) -> Network:
    """The network of a study, as far as it is solved. listed: its sections. Raises InputError for another study."""
    check_case(study.case)
    data = study.dataset
    if data["status"].shape != (len(listed.names),):
        raise InputError(f"the study has {data['status'].size} cases, the table {len(listed.names)} sections")
    status = data["status"].to_numpy().astype(np.int8)
    count = len(status)
    years = np.full(count, math.nan)
    governing = np.full(count, "", dtype=object)
    if "governing_years" in data:
        years = data["governing_years"].to_numpy().astype(float)
        governing = np.array([str(name) for name in data[_GOVERNING].to_numpy()], dtype=object)
    remaining = years - listed.age
    criteria = [criterion.name for criterion in study.case.criteria]
    by_criterion = np.full((count, len(criteria)), math.nan)
    if "life_years" in data:
        solved_names = [str(name) for name in data["criterion"].to_numpy()]
        for number, name in enumerate(criteria):
            # A criterion whose layer no section has is not among them.
            if name in solved_names:
                by_criterion[:, number] = data["life_years"].to_numpy()[:, solved_names.index(name)]
    reasons = np.full(count, "", dtype=object)
    for number, reason in study.failures:
        reasons[number] = reason
    over = ("section",)
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "life_years": (("section", "criterion"), by_criterion),
        "governing_years": (over, years),
        "remaining_years": (over, remaining),
        "section_age": (over, listed.age),
        "section_position": (over, listed.position),
        **({"section_length": (over, listed.length)} if np.isfinite(listed.length).any() else {}),
        "section_rank": (over, ranks_of(remaining)),
        "section_status": (over, status),
    }
    labels = {
        "section": list(listed.names),
        "criterion": criteria,
        "governing_criterion": ("section", governing.astype(str)),
        "reason": ("section", reasons.astype(str)),
    }
    dataset = variables.dataset(
        fields, labels, **_design_years(study.case), has_ages=int(listed.has_age), network=study.case.title
    )
    stats = {"sections": count, "seconds": float(np.nansum(data["seconds"].to_numpy()))}
    return Network(dataset, stats, _warnings(study, listed, dataset))


def ranks_of(remaining: Array) -> IntArray:
    """Rank of each section, 1 for the least remaining life; 0 of those that have none."""
    good = np.flatnonzero(~np.isnan(remaining))
    ranks = np.zeros(len(remaining), dtype=np.int64)
    ranks[good[np.argsort(remaining[good], kind="stable")]] = np.arange(1, len(good) + 1)
    return ranks


def _design_years(case: Case) -> dict[str, float]:
    years = case.build_traffic().years
    return {} if years is None else {"design_years": float(years)}


def _absent_in_words(listed: Sections) -> str:
    """How many sections are solved without which layer; "" for none."""
    parts = []
    for variable in listed.design.inputs:
        if variable.key.endswith(".thickness"):
            rows = [k for k, value in enumerate(variable.values) if k not in listed.design.faults and value == 0]
            if rows:
                layer = variable.name.removeprefix("thickness_")
                parts.append(f"{layer} in {len(rows)} section(s), such as {listed.names[rows[0]]}")
    return f"solved without a layer whose thickness is 0 or left empty: {'; '.join(parts)}" if parts else ""


def _warnings(study: Sweep, listed: Sections, data: xr.Dataset) -> tuple[str, ...]:
    texts = [str(study.dataset.attrs["damage"])] if study.dataset.attrs.get("damage") else []
    solved = int((data["section_status"] == SOLVED).sum())
    for text, numbers in by_cause(json.loads(study.dataset.attrs["warnings"])).items():
        texts.append(f"{len(numbers)} of {solved} sections, such as {listed.names[min(numbers)]}: {text}")
    failed = np.flatnonzero(data["section_status"].to_numpy() == FAILED)
    if len(failed):
        names = ", ".join(listed.names[k] for k in failed[:_LISTED])
        more = f" and {len(failed) - _LISTED} more" if len(failed) > _LISTED else ""
        texts.append(f"{len(failed)} of {len(listed.names)} sections failed: {names}{more}")
    remaining = data["remaining_years"].to_numpy()
    over = np.flatnonzero(remaining < 0)
    if len(over):
        worst = int(np.nanargmin(remaining))
        texts.append(
            f"{len(over)} of {solved} sections have no remaining life: by the criterion that governs them, their "
            f"service life is over, at {listed.names[worst]} since {-remaining[worst]:.3g} years. Where such a road "
            "is still sound, the computed life is too short for it: check its moduli, traffic and age, and the "
            "scatter of the law"
        )
    without = np.flatnonzero((data["section_status"].to_numpy() == SOLVED) & np.isnan(listed.length))
    if np.isfinite(listed.length).any() and len(without):
        texts.append(
            f"{len(without)} solved sections have no length, such as {listed.names[without[0]]}; they are not in the "
            "sums of lengths"
        )
    absent = _absent_in_words(listed)
    if absent:
        texts.append(absent)
    if not listed.has_age:
        texts.append(
            f"the table has no column {AGE}: all sections count as new, and the remaining life is the service life"
        )
    return tuple(texts)
