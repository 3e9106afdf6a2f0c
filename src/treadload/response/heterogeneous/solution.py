"""What a window with stones gives, and what to read in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.citations import STONES
from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.materials import Aggregates
from treadload.pavement import Pavement
from treadload.response.loads import PlacedLoad
from treadload.rows import Row, row


@dataclass(frozen=True, eq=False)
class Heterogeneous(BaseResult, group="heterogeneous"):
    """Stress and strain in a window of mortar with stones.

    dataset: over depth, y and x the components of stress and strain, their largest principal values, `phase` (0 the
    mortar, then the aggregates in their order) and `stone`; over `percentile`, by volume away from the window's sides
    and bottom by the radius of the largest stone, the largest tension and extension in the mastic and of the mortar
    alone, and `peak_over_mean`; over `face` the stress of the bond between stones and mortar; numbers for all. Where
    stones are softer than the mortar, or voids, `soft_strain_error` is the error of their mean strain by their cells,
    the largest of them, as the attribute error_estimate describes; NaN where it is not estimated.
    stats: seconds, iterations. warnings: sentences for the user. loads, road, stones, bond_strength: the question.

    >>> load = tl.response.GridLoad.from_arrays([[0.8e6] * 4] * 4, spacing=5e-3)
    >>> stone = tl.materials.Aggregates.from_centres(0.0, 0.0, 5.5e-3, 4e-3, tl.Elastic(60e9, 0.2))
    >>> cells = {"window": (12e-3, 12e-3), "depth": 12e-3, "spacing": 2e-3}
    >>> result = tl.response.compute_heterogeneous(load, tl.Elastic(3e9, 0.35), stone, **cells)
    >>> f"{result.dataset.stone_fraction.item():.1%} of the window is stone"
    '14.8% of the window is stone'
    """

    title: ClassVar[str] = "Aggregate-scale response"
    subject: ClassVar[str] = "Stones in the mortar of a road"
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
        not_nan="principal_stress_1 principal_strain_1",
        maybe_numbers="bond_strength largest_load_pressure",
        maybe={"soft_strain_error": ""},
    )

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    loads: tuple[PlacedLoad, ...] = ()
    road: Pavement | None = None
    stones: tuple[Aggregates, ...] = ()
    bond_strength: float | None = None

    def cites(self) -> tuple[str, ...]:
        """Methods of inclusions."""
        return STONES

    def factor(self, percentile: float = 95.0) -> float:
        """How much larger the mastic's extension is at a percentile than the mean over stones and mastic.

        The strain that a fatigue law of the mix reads times this is the strain that a law of the mastic reads.
        percentile: one of those of the dataset. Raises InputError for another.
        """
        levels = self.dataset["percentile"].to_numpy()
        if percentile not in levels:
            text = ", ".join(f"{level:g}" for level in levels)
            raise InputError(f"percentile must be one of {text}, got {percentile!r}")
        return float(self.dataset["peak_over_mean"].to_numpy()[levels == percentile][0])

    def rows(self) -> tuple[Row, ...]:
        """Shares, the mastic's tension and tensile strain beside those of the mortar alone, bonds, factors."""
        data, attrs = self.dataset, self.dataset.attrs
        high = int(np.flatnonzero(data["percentile"].to_numpy() == 95)[0]) if 95 in data["percentile"] else -1
        at = f"{float(data['percentile'][high]):g}th percentile of the volume"
        over = (
            f"of the bond's strength of {attrs['bond_strength'] / 1e6:g} MPa"
            if "bond_strength" in attrs
            else f"of the load's largest pressure, {attrs.get('largest_load_pressure', np.nan) / 1e6:.3g} MPa"
        )
        soft: tuple[Row, ...] = ()
        if "soft_strain_error" in data:
            off = float(data["soft_strain_error"])
            shown = off if np.isfinite(off) else "not estimated"
            soft = (row("soft_strain_error", shown, note=str(attrs.get("error_estimate", ""))),)
        return (
            row("grid", f"{_cells(data)} cells"),
            row("mortar", str(attrs.get("mortar", "unnamed"))),
            row("aggregates", str(attrs.get("aggregates", "unnamed"))),
            row("stone_fraction", float(data["stone_fraction"])),
            *(
                row(name, float(data[name][high]), note=at)
                for name in ("mastic_tension", "homogeneous_tension", "mastic_extension", "peak_over_mean")
            ),
            *(row(name, float(data[name])) for name in ("stone_over_mastic", "bond_tension_high", "bond_shear_high")),
            row("ravelling_index", float(data["ravelling_index"]), note=over),
            *soft,
        )


def _cells(data: xr.Dataset) -> str:
    return " x ".join(str(data.sizes[name]) for name in ("x", "y", "depth"))
