"""Drops of a station together: what stress-dependent layers are fitted to, since each load has moduli of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.roads.basins import Basins


@dataclass(frozen=True, eq=False)
class StationLoads:
    """Deflection basins by station, a row for each.

    basins: of all drops. members: numbers of the drops of each station. most: drops that a row has room for.
    reasons: of each drop why it is left out, "" where it is fitted. See `Measured` for the rest.
    """

    basins: Basins
    members: tuple[tuple[int, ...], ...]
    most: int
    reasons: tuple[str, ...]

    @classmethod
    def of(cls, basins: Basins) -> StationLoads:
        """Drops of the same station, section and thicknesses belong together."""
        sections = basins.section or ("",) * len(basins)
        rows: dict[tuple[object, ...], list[int]] = {}
        for number, key in enumerate(zip(sections, basins.station, *basins.thickness.values(), strict=True)):
            rows.setdefault(key, []).append(number)
        members = tuple(map(tuple, rows.values()))
        return cls(basins, members, max(map(len, members), default=1), tuple(basins.refusals(basins.usual)))

    def __len__(self) -> int:
        return len(self.members)

    def rows(self, chosen: Sequence[int] | IntArray | BoolArray) -> StationLoads:
        """Some of the stations, by number or by a mask."""
        taken = [self.members[k] for k in np.arange(len(self))[np.asarray(chosen)]]
        drops = [drop for members in taken for drop in members]
        ends = np.cumsum([0, *map(len, taken)])
        members = tuple(tuple(range(a, b)) for a, b in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))
        return StationLoads(
            self.basins.rows(np.array(drops, dtype=int)), members, self.most, tuple(self.reasons[k] for k in drops)
        )

    @property
    def load(self) -> Array:
        """Of each drop (n, most), N; that of the first one where a station has fewer or one is left out."""
        table = np.empty((len(self), self.most))
        for row, members in enumerate(self.members):
            good = [drop for drop in members if not self.reasons[drop]]
            table[row] = self.basins.load[good[0]] if good else 1.0
            for place, drop in enumerate(members):
                if not self.reasons[drop]:
                    table[row, place] = self.basins.load[drop]
        return table

    @property
    def readings(self) -> Array:
        """Deflections of all drops of a station (n, most · sensors), m; NaN where there is none."""
        table = np.full((len(self), self.most, len(self.basins.offsets)), np.nan)
        for row, members in enumerate(self.members):
            for place, drop in enumerate(members):
                if not self.reasons[drop]:
                    table[row, place] = self.basins.deflection[drop]
        return table.reshape(len(self), -1)

    def of_drop(self, values: Array) -> Array:
        """What fits have of the readings (n, most · sensors), a row for each drop."""
        table = values.reshape(len(self), self.most, -1)
        out = np.full((len(self.basins), table.shape[2]), np.nan)
        for row, members in enumerate(self.members):
            out[list(members)] = table[row, : len(members)]
        return out

    @property
    def station_of(self) -> IntArray:
        """Number of the row that each drop belongs to (drops,)."""
        out = np.empty(len(self.basins), dtype=int)
        for row, members in enumerate(self.members):
            out[list(members)] = row
        return out

    @property
    def thickness(self) -> Mapping[str, Array]:
        """Name of a layer → its thickness at each station (n,), m."""
        first = [members[0] for members in self.members]
        return {name: values[first] for name, values in self.basins.thickness.items()}

    @property
    def temperature(self) -> Array | None:
        """Of the asphalt (n,), °C: that of the first drop."""
        if self.basins.temperature is None:
            return None
        return np.asarray(self.basins.temperature[[members[0] for members in self.members]])

    @property
    def offsets(self) -> Array:
        """Of the sensors (s,), m."""
        return self.basins.offsets

    @property
    def scales(self) -> Array:
        """What the misfit of each reading is over."""
        return self.readings

    @property
    def error_sizes(self) -> Array:
        """What relative errors of the readings are of."""
        return self.readings

    @property
    def usual(self) -> float:
        """Median of the compliance of the drops, m/N; NaN without any."""
        return self.basins.usual

    @property
    def numbers(self) -> tuple[Array, ...]:
        """Arrays that the answer depends on."""
        return (*self.basins.numbers, self.station_of.astype(float))

    @property
    def conditions(self) -> tuple[object, ...]:
        """What else it depends on."""
        return (*self.basins.conditions, "drops of a station together")

    def refusals(self, usual: float) -> list[str]:
        """For every station why it cannot be fitted: where all of its drops are left out, the reason of the first."""
        return [self.reasons[members[0]] if all(self.reasons[k] for k in members) else "" for members in self.members]

    def flags(self) -> list[str]:
        """For every station what is unusual: of the first of its drops where something is."""
        flags = self.basins.flags()
        return [next((flags[k] for k in members if flags[k] and not self.reasons[k]), "") for members in self.members]
