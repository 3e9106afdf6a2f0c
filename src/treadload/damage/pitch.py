"""Strains in a road below a tread with blocks: position by position, their mean and their worst over a pitch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.contact import PitchPassage
from treadload.damage.uniform import READINGS
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import MATERIAL_LENGTH, GridLoad, map_grid, solve_response
from treadload.rows import Row, row
from treadload.variables import dataset

_STRAINS = ("largest_extension", "largest_in_plane_extension", "largest_vertical_shear")


@dataclass(frozen=True, eq=False)
class PitchResponse(BaseResult, group="pitch_response"):
    """Stress and strain of a road below a tread with blocks at every position of a pitch.

    dataset: the largest of strains and stresses over the plane, by name over (position, depth), see `READINGS`.
    """

    title: ClassVar[str] = "Road under one pitch"
    holds: ClassVar[Holds] = Holds(
        {"depth": "depth", " ".join(_STRAINS): "position depth"}, maybe_numbers="mean_over"
    )

    dataset: xr.Dataset

    @property
    def heading(self) -> str:
        """Depths and positions."""
        return f"{self.dataset.sizes['depth']} depth(s) at {self.dataset.sizes['position']} positions of the pitch"

    def mean(self, name: str) -> Array:
        """Mean over the positions of a reading at every depth (depth,)."""
        return np.asarray(self.dataset[name].transpose("position", "depth").to_numpy().mean(0))

    def worst(self, name: str) -> Array:
        """Largest over the positions of a reading at every depth (depth,)."""
        return np.asarray(self.dataset[name].transpose("position", "depth").to_numpy().max(0))

    def rows(self) -> tuple[Row, ...]:
        """Worst and mean of the strains at every depth."""
        at = self.dataset["position"].to_numpy()
        lines = []
        for number, depth in enumerate(self.dataset["depth"].to_numpy()):
            for name in _STRAINS:
                values = self.dataset[name].transpose("position", "depth").to_numpy()[:, number]
                note = f"axle at {at[values.argmax()] * 1e3:.1f} mm, mean {row(name, values.mean()).text}"
                lines.append(row(name, values.max(), note=note, group=f"{1e3 * float(depth):.0f} mm deep"))
        return tuple(lines)


def respond_to_pitch(
    passage: PitchPassage,
    road: Pavement,
    *,
    depths: Sequence[float],
    mean_over: float | None = MATERIAL_LENGTH,
    speed: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> PitchResponse:
    """The largest strains and stresses of the plane at depths, at every position of a pitch.

    depths: m, downwards. mean_over: length whose means are read near the surface, m, as in `solve_response`; None for
    points. speed: m/s, of a viscoelastic road. progress: called with a line of text at every position.
    Returns the readings over positions and depths. Raises InputError as `solve_response`.
    """
    if not len(depths):
        raise InputError("a response to a pitch needs at least one depth in m, got none; 0 is the surface")
    tell = progress or (lambda text: None)
    readings: dict[str, list[Array]] = {name: [] for name in READINGS}
    contacts = passage.contacts
    for number, contact in enumerate(contacts, 1):
        tell(f"stress and strain in the road, position {number} of {len(contacts)}")
        load = GridLoad.from_dataset(contact)
        points = map_grid([load], road)
        response = solve_response(
            [load], road, depths=list(depths), x=points.x, y=points.y, mean_over=mean_over,
            speed=speed if road.is_viscoelastic else None,
        )  # fmt: skip
        for name, quantity in READINGS.items():
            readings[name].append(quantity.values(response.dataset).max(axis=(1, 2)))
    coordinates = {"position": passage.dataset["position"].to_numpy(), "depth": np.asarray(depths, float)}
    data = dataset(
        {name: (("position", "depth"), np.array(values)) for name, values in readings.items()}, coordinates
    )
    return PitchResponse(data if mean_over is None else data.assign_attrs(mean_over=mean_over))
