"""What a window with stones gives, and what to read in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload.composing import BaseResult, Holds
from treadload.describing import first_line
from treadload.errors import InputError
from treadload.materials import Aggregates
from treadload.pavement import Pavement
from treadload.response.loads import PlacedLoad


@dataclass(frozen=True, eq=False)
class Heterogeneous(BaseResult, group="heterogeneous"):
    """Stress and strain in a window of mortar with stones.

    dataset: over depth, y and x the components of stress and strain, their largest principal values, `phase` (0 the
    mortar, then the aggregates in their order) and `stone`; over `percentile`, by volume away from the window's sides
    and bottom by the radius of the largest stone, the largest tension and extension in the mastic and of the mortar
    alone, and `peak_over_mean`; over `face` the stress of the bond between stones and mortar; numbers for all.
    stats: seconds, iterations. warnings: sentences for the user. loads, road, stones, bond_strength: the question.
    """

    holds: ClassVar[Holds] = Holds(
        {
            "depth": "depth",
            "x": "x",
            "y": "y",
            "principal_stress_1 principal_strain_1 tension_without_stones phase stone": "depth y x",
            "percentile": "percentile",
            "mastic_tension mastic_extension homogeneous_tension peak_over_mean": "percentile",
            "bond_normal bond_shear bond_pull face_area": "face",
            "stone_fraction stone_over_mastic ravelling_index bond_tension_high bond_shear_high": "",
        },
        known="principal_stress_1 principal_strain_1",
        maybe_numbers="bond_strength largest_load_pressure",
    )

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    loads: tuple[PlacedLoad, ...] = ()
    road: Pavement | None = None
    stones: tuple[Aggregates, ...] = ()
    bond_strength: float | None = None

    def factor(self, percentile: float = 95.0) -> float:
        """How much larger the mastic's extension is at a percentile than the mean over stones and mastic.

        The strain that a fatigue law of the mix reads times this is the strain that a law of the mastic reads.
        percentile: one of those of the dataset. Raises InputError for another.
        """
        known = self.dataset["percentile"].to_numpy()
        if percentile not in known:
            told = ", ".join(f"{one:g}" for one in known)
            raise InputError(f"percentile must be one of {told}, got {percentile!r}")
        return float(self.dataset["peak_over_mean"].to_numpy()[known == percentile][0])

    def summary(self) -> str:
        """Shares, the mastic's tension and extension beside those of the mortar alone, bonds, factors."""
        data = self.dataset
        high = int(np.flatnonzero(data["percentile"].to_numpy() == 95)[0]) if 95 in data["percentile"] else -1
        at = f"{float(data['percentile'][high]):g}th percentile"

        def mega(name: str) -> float:
            return float(data[name].to_numpy().ravel()[high if data[name].ndim else 0]) / 1e6

        over = (
            f"of the bond's strength of {data.attrs['bond_strength'] / 1e6:g} MPa"
            if "bond_strength" in data.attrs
            else f"of the load's largest pressure, {data.attrs.get('largest_load_pressure', np.nan) / 1e6:.3g} MPa"
        )
        lines = [
            f"stones in mortar, {100 * float(data['stone_fraction']):.1f} % of {_cells(data)} cells",
            f"mortar: {data.attrs.get('mortar', 'unnamed')}",
            f"aggregates: {data.attrs.get('aggregates', 'unnamed')}",
            f"largest tension in the mastic, {at}: {mega('mastic_tension'):.3g} MPa; "
            f"of the mortar alone: {mega('homogeneous_tension'):.3g} MPa",
            f"largest extension in the mastic, {at}: {mega('mastic_extension') * 1e12:.4g} microstrain, "
            f"{float(data['peak_over_mean'][high]):.3g} times the mean of stones and mastic",
            f"mean vertical stress of stones over that of mastic: {float(data['stone_over_mastic']):.3g}",
            f"bond of stones, 95 % of their faces below: tension {mega('bond_tension_high'):.3g} MPa, "
            f"shear {mega('bond_shear_high'):.3g} MPa",
            f"ravelling index: {float(data['ravelling_index']):.3g} {over}",
        ]
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    __repr__ = first_line


def _cells(data: xr.Dataset) -> str:
    return " x ".join(str(data.sizes[name]) for name in ("x", "y", "depth"))
