"""Service lives of aged mixes compared with those of the young mixes, whose fatigue lines they keep."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from treadload.damage.life import Life
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.solve import solve_life

# Lives that differ by less are the same to a reader: that of a case is good to some per cent.
_LONGER = 1.01


@dataclass(frozen=True)
class _Young:
    """Ageing that leaves a mix as it is, so that the courses are divided alike."""

    def as_cold_as(self, temperature: float, depth: float) -> float:
        """The temperature itself, °C."""
        return temperature


def longer_by_ageing(
    design: Design, life: Life, *, workers: int | None = None, progress: Progress | None = None
) -> tuple[str, ...]:
    """Sentences on criteria of aged mixes that last longer than the young ones would; none without ageing.

    An aged mix is stiffer and so strains less, while its fatigue line stays that of the young mix: the gain is not
    real. life: of the aged mixes. workers, progress: as in `solve_life`, which solves the life of the young mixes.
    """
    road, climate, criteria = design.road, design.climate, design.criteria
    layers = {
        criterion.name: road.layers[criterion.number(road)]
        for criterion in criteria
        if not criterion.quantity.between_layers
    }
    mixes = [name for name, layer in layers.items() if layer.depends_on_temperature]
    if not mixes or all(season.ageing is None for season in climate.seasons):
        return ()
    seasons = tuple(
        season if season.ageing is None else replace(season, ageing=_Young()) for season in climate.seasons
    )
    young = solve_life(
        replace(design, climate=replace(climate, seasons=seasons), rutting=None), workers=workers, progress=progress
    )
    sentences = []
    for name in mixes:
        old, new = life.years(name), young.years(name)
        if old > _LONGER * new:
            years = f"{old:.3g} years" if math.isfinite(old) else "no limit"
            sentences.append(
                f"{name}: the aged mix has a service life of {years}, the young mix {new:.3g} years: ageing stiffens "
                "the mix, and its fatigue line is still that of the young mix; design with the shorter life, or give "
                "the criterion a fatigue line measured on aged specimens"
            )
    return tuple(sentences)
