"""The validation table: every group of checks, run and printed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from treadload.errors import InputError, TreadloadError, nearest
from treadload.validation import (
    basins,
    cracking,
    crossing,
    dissimilar,
    energy_ratios,
    frost,
    grain,
    histories,
    journeys,
    laws,
    layers,
    moving,
    on_layers,
    paper,
    pressing,
    published,
    rates,
    reliability,
    rheology,
    rib_bodies,
    ribs,
    roads,
    rolling_ribs,
    roughness,
    shearing,
    stones,
    stress,
    stress_dependent,
    tensors,
    tires,
    upright,
    viscoelastic,
    yielding,
)
from treadload.validation.check import Check

GROUPS: Mapping[str, Callable[[], Iterator[Check]]] = {
    "hertz": pressing.hertz_checks,
    "carter": shearing.carter_checks,
    "cattaneo": shearing.cattaneo_checks,
    "kalker": shearing.kalker_checks,
    "disc": shearing.disc_checks,
    "bentall": dissimilar.bentall_checks,
    "rubber": dissimilar.rubber_checks,
    "viscoelastic": viscoelastic.cylinder_checks,
    "grain": grain.grain_checks,
    "upright": upright.upright_checks,
    "yielding": yielding.yielding_checks,
    "rib sections": rib_bodies.section_checks,
    "ribs": ribs.rib_checks,
    "three ribs": rib_bodies.rolling_checks,
    "rolling ribs": rolling_ribs.rolling_rib_checks,
    "blocks": rib_bodies.block_checks,
    "histories": histories.history_checks,
    "stress": stress.stress_checks,
    "stones": stones.stone_checks,
    "texture": roughness.texture_checks,
    "crossing": crossing.crossing_checks,
    "layers": layers.layer_checks,
    "stress-dependent": stress_dependent.stress_dependent_checks,
    "moving": moving.moving_checks,
    "contact on layers": on_layers.layered_contact_checks,
    "bilinear": rates.rate_checks,
    "rheology": rheology.rheology_checks,
    "fatigue": laws.law_checks,
    "energy ratio": energy_ratios.energy_ratio_checks,
    "published": published.published_checks,
    "reliability": reliability.reliability_checks,
    "frost": frost.frost_checks,
    "basins": basins.basin_checks,
    "roads": roads.road_checks,
    "cracks": cracking.crack_checks,
    "criteria": tensors.criteria_checks,
    "traffic": journeys.traffic_checks,
    "conditions": tires.condition_checks,
    "iterations": pressing.iteration_checks,
    "mesh": tires.mesh_checks,
    "modulus": tires.modulus_checks,
    "footprint": paper.footprint_checks,
    "strain": paper.strain_checks,
}

_HEADER = ("problem", "quantity", "treadload", "reference", "deviation", "bound", "", "source")


def run_checks(progress: Callable[[str], None] | None = None, names: Iterable[str] | None = None) -> list[Check]:
    """Run the checks and compare.

    progress: called with the name of each group before it runs. names: of the groups, see `GROUPS`; None for all.
    Returns the checks in the order of the table. A group whose solver stops gives one failed check with the reason.
    Raises InputError for an unknown name.
    """
    wanted = list(GROUPS) if names is None else list(names)
    for name in wanted:
        if name not in GROUPS:
            raise InputError(f"no group of checks {name!r}; {nearest(name, GROUPS, 'known:')}")
    checks: list[Check] = []
    for name in wanted:
        if progress is not None:
            progress(name)
        try:
            checks.extend(GROUPS[name]())
        except TreadloadError as error:
            checks.append(Check(name, f"stopped: {error}", math.nan, math.nan, math.nan, 0.0, False, ""))
    return checks


def format_table(checks: Sequence[Check]) -> str:
    """Plain text, one line per check, with a last line that counts them."""
    rows = [_HEADER, *(_cells(check) for check in checks)]
    widths = [max(len(row[k]) for row in rows) for k in range(len(_HEADER) - 1)]
    right = (2, 3, 4, 5)
    lines = []
    for row in rows:
        cells = [row[k].rjust(w) if k in right else row[k].ljust(w) for k, w in enumerate(widths)]
        lines.append("  ".join([*cells, row[-1]]).rstrip())
    lines.insert(1, "-" * max(len(line) for line in lines))
    return "\n".join([*lines, "", _count(checks)])


def format_markdown(checks: Sequence[Check]) -> str:
    """The same as a Markdown table."""
    lines = ["| " + " | ".join((*_HEADER[:6], "passed", _HEADER[7])) + " |", "|---|---|--:|--:|--:|--:|---|---|"]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in _cells(check)) + " |" for check in checks]
    return "\n".join([*lines, "", _count(checks)])


def _cells(check: Check) -> tuple[str, ...]:
    percent = check.relative
    return (
        check.group,
        check.quantity,
        _number(check.measured),
        _number(check.reference),
        _deviation(check.deviation, percent),
        _number(100 * check.bound, 3) + " %" if percent else _number(check.bound, 3),
        "yes" if check.passed else "NO",
        check.source,
    )


def _deviation(deviation: float, percent: bool) -> str:
    return f"{100 * deviation:+.2g} %" if percent else f"{deviation:+.2g}" if deviation else "0"


def _number(value: float, digits: int = 6) -> str:
    return f"{value:.{digits}g}"


def _count(checks: Sequence[Check]) -> str:
    passed = sum(check.passed for check in checks)
    return f"{passed} of {len(checks)} checks passed"
