"""What has been worn off a tread since an earlier scan of it, as a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.rows import Row, row


@dataclass(frozen=True, eq=False)
class Wear(BaseResult, group="wear"):
    """What was worn off a tread between two scans of it, along the radius.

    dataset: tread_wear (across, wheel_angle), positive where material is gone, and its median round the tire, NaN off
    the ribs and where one of the scans knows nothing; tread_height and earlier_tread_height (across), the medians of
    both scans over the crown of the later one, m, the earlier as it was shifted; groove_depth and
    earlier_groove_depth over groove, those in both. Attributes: datum, by which the radii of the earlier scan were
    lowered so that the floors of the grooves, which do not wear, agree; shift, of the earlier scan across, m.

    >>> import numpy as np
    >>> import xarray as xr
    >>> across, angle = np.linspace(-0.1, 0.1, 5), np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
    >>> fields = {"tread_wear": (("across", "wheel_angle"), np.full((5, 8), 2e-3))}
    >>> heights = {"median_tread_wear": 2e-3, "tread_height": -2e-3, "earlier_tread_height": 0.0}
    >>> fields |= {name: ("across", np.full(5, height)) for name, height in heights.items()}
    >>> wear = tl.tire.Wear(xr.Dataset(fields, {"across": across, "wheel_angle": angle}))
    >>> f"{wear.dataset.median_tread_wear.mean().item() * 1e3:.0f} mm worn off"
    '2 mm worn off'
    """

    title: ClassVar[str] = "Tread wear"
    holds: ClassVar[Holds] = Holds(
        {
            "across": "across", "wheel_angle": "wheel_angle",
            "tread_wear": "across wheel_angle",
            "median_tread_wear tread_height earlier_tread_height": "across",
        },
        maybe={"groove groove_depth earlier_groove_depth": "groove"},
        not_nan="median_tread_wear",
        numbers="datum shift",
    )  # fmt: skip

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def by_place(self) -> Array:
        """(ny,) median round the tire, m; NaN off the ribs."""
        return np.asarray(self.dataset["median_tread_wear"].to_numpy(), dtype=np.float64)

    @property
    def mean(self) -> float:
        """Of the ribs, m."""
        return float(np.nanmean(self.by_place))

    @property
    def uneven(self) -> float:
        """Most minus least across, m: 95 % less 5 % of the places."""
        low, high = np.nanquantile(self.by_place, [0.05, 0.95])
        return float(high - low)

    @property
    def datum(self) -> float:
        """By which the radii of the earlier scan were lowered, m."""
        return float(self.dataset.attrs["datum"])

    @property
    def grooves(self) -> tuple[tuple[float, float, float], ...]:
        """(place across, depth before, depth now) of the grooves in both scans, m."""
        if "groove_depth" not in self.dataset or "earlier_groove_depth" not in self.dataset:
            return ()
        parts = (self.dataset[name].to_numpy() for name in ("groove", "earlier_groove_depth", "groove_depth"))
        return tuple((float(at), float(before), float(now)) for at, before, now in zip(*parts, strict=True))

    def rows(self) -> tuple[Row, ...]:
        """How much, where most, how unevenly; the grooves then and now."""
        place = int(np.nanargmax(self.by_place))
        at = f"y = {float(self.dataset['across'][place]) * 1e3:+.0f} mm"
        lines = [
            row("mean_tread_wear", self.mean),
            row("largest_tread_wear", float(self.by_place[place]), note=f"at {at}"),
            row("wear_range", self.uneven),
            row("datum", self.datum)
            if self.grooves
            else row("datum", "no groove in both scans: the radii are compared as they are, swelling and scale "
                     "included"),
        ]  # fmt: skip
        for centre, before, now in self.grooves:
            group = f"groove at y = {centre * 1e3:+.1f} mm"
            lines += [row("earlier_groove_depth", before, group=group), row("groove_depth", now, group=group)]
        return tuple(lines)
