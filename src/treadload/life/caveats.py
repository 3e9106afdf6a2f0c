"""Values of a traffic that no road sees, and bonds beyond their tests: sentences for the warnings of a life."""

from __future__ import annotations

from collections.abc import Sequence

from treadload.contact.friction.laws import law_of
from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.rib_sides import SHALLOW, sides_in_words
from treadload.damage.traffic import Traffic
from treadload.life.design import Design
from treadload.life.halving import CELL_ERRORS, can_be_halved, near_surface, pushed_classes
from treadload.life.seasons import Warm, beyond_data
from treadload.life.wheels import Wheels
from treadload.pavement import Pavement
from treadload.plausible import caveat, load_caveat
from treadload.tire import Tire


def beyond_tables(road: Pavement, climate: Climate) -> tuple[str, ...]:
    """Sentences on mixes that the climate takes beyond their tables: how far, and in which share of the passes."""
    furthest_by_layer: dict[tuple[str, float], tuple[float, float]] = {}
    for season in climate.seasons:
        worst: dict[tuple[str, float], float] = {}
        for name, value, limit in beyond_data(road, season):
            far = worst.get((name, limit), limit)
            worst[name, limit] = max(far, value) if value > limit else min(far, value)
        for key, value in worst.items():
            furthest, share = furthest_by_layer.get(key, (key[1], 0.0))
            furthest = max(furthest, value) if value > key[1] else min(furthest, value)
            furthest_by_layer[key] = furthest, share + season.share
    return tuple(
        f"{name} reaches {furthest:.0f} °C, beyond its table to {limit:g} °C, in {100 * share:.2g} % of the passes: "
        "ln E is extrapolated there, laws stay at the limit"
        for (name, limit), (furthest, share) in furthest_by_layer.items()
    )


def bond_caveats(criteria: Sequence[Criterion], warm: Sequence[Warm], wheels: Sequence[Wheels]) -> tuple[str, ...]:
    """Sentences on bonds in seasons and under classes for which their strength was not tested."""
    caveats = {
        f"{criterion.name}: {text}": None
        for season in warm
        for k, criterion in enumerate(criteria)
        if criterion.quantity.between_layers
        for wheel in wheels
        for text in season.criteria[k]
        .passing(wheel.speed, season.criteria[k].depth(season.road), wheel.length)
        .quantity.caveat.split("; ")
        if text not in criterion.quantity.caveat
    }
    return tuple(caveats)


def surface_caveats(road: Pavement, criteria: Sequence[Criterion], tire: Tire, traffic: Traffic) -> tuple[str, ...]:
    """A sentence where a criterion reads the surface below tires without free ribs."""
    if all(min(criterion.depths(road)) >= SHALLOW for criterion in criteria):
        return ()
    return tuple(sides_in_words([(row.tire or tire).rib_sides for row in traffic.classes]))


def cell_caveats(design: Design) -> tuple[str, ...]:
    """A sentence on the error of years at the surface by the cells of the contacts, where wheels have a side force.

    It was measured, see `docs/notes/cells_and_means.md`, and is not computed from the life. design: as solved.
    """
    near = ", ".join(design.criteria[k].name for k in near_surface(design))
    pushed = ", ".join(design.traffic.classes[row].name for row in pushed_classes(design.traffic))
    if not near or not pushed:
        return ()
    spacing, cause = design.spacing, f"{near}: a side force ({pushed}) leaves tension in strips of a few millimetres"
    if design.contacts.halved:
        return (
            f"{cause}, which do enough of the damage that these contacts were solved on cells of "
            f"{500 * spacing:g} mm instead of {1e3 * spacing:g} mm: years within 3 % of those on cells of 0.75 mm",
        )
    if can_be_halved(design):
        return (
            f"{cause}, which do so little of the damage that cells of {1e3 * spacing:g} mm change the years by at "
            "most 3 %, compared with 0.75 mm",
        )
    cells = next((cell for cell in sorted(CELL_ERRORS) if spacing < 1.01 * cell), max(CELL_ERRORS))
    coarser = "" if spacing < 1.01 * cells else f"; cells of {1e3 * spacing:g} mm were not compared and err more"
    return (
        f"{cause}, and the years that they govern depend on the cells of the contact: on cells of {1e3 * cells:g} mm "
        f"by up to {100 * CELL_ERRORS[cells]:.0f} %, compared with 0.75 mm{coarser}. Cells of 3 mm are halved where "
        "these wheels do much of the damage",
    )


def traffic_caveats(tire: Tire, traffic: Traffic, climate: Climate) -> tuple[str, ...]:
    """Sentences on the classes of axles, how many there are, how that grows, and the temperatures."""
    caveats = caveat("number of passes per year", traffic.passes_per_year) if traffic.passes_per_year else ()
    caveats += caveat("annual growth", traffic.growth)
    for row in traffic.classes:
        _, width = (row.tire or tire).extent
        caveats += load_caveat(row.wheel_load, width, row.name)
        caveats += caveat("inflation pressure", row.inflation_pressure, row.name)
        caveats += caveat("friction", law_of(row.friction).largest, row.name)
        if row.speed is not None:
            caveats += caveat("speed", row.speed, row.name)
    for season in climate.seasons:
        for temperature in season.temperatures:
            caveats += caveat("temperature", temperature, season.name)
    return caveats
