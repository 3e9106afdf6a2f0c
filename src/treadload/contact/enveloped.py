"""The pressure on peaks as the layers of a road receive it: the enveloped pressure, with the same load, for the
layers below.

A Gaussian filter after ISO 16610-21: a wave of the enveloping length is halved, longer ones stay, shorter ones go.
Below about that length the stress does not depend on the peaks (Saint-Venant).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import scipy

from treadload.composing import BaseResult, Holds
from treadload.contact.solution import Contact
from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.rows import Row, row
from treadload.variables import dataset

# Of the Gaussian, in its standard deviations; cells of the result in an enveloping length.
_REACH, _CELLS = 6.0, 8
_ALPHA = math.sqrt(math.log(2) / math.pi)


@dataclass(frozen=True, eq=False)
class Enveloped(BaseResult, group="enveloped"):
    """Pressure and shear of a contact on texture, enveloped: a load for `solve_response`.

    dataset: pressure, traction_x, traction_y over (y, x), Pa, and normal_load, N, that of the contact. length: m,
    in its attributes.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> enveloped = tl.contact.envelop(contact, length=0.012)
    >>> [f"{result.dataset.pressure.values.max() / 1e3:.0f} kPa" for result in (contact, enveloped)]
    ['212 kPa', '206 kPa']
    """

    title: ClassVar[str] = "Enveloped contact"
    holds: ClassVar[Holds] = Holds(
        {"pressure traction_x traction_y": "y x", "normal_load": ""}, numbers="dx dy enveloping_length",
        positive="dx dy enveloping_length",
    )  # fmt: skip

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """The enveloping length."""
        return f"over {self.dataset.attrs['enveloping_length'] * 1e3:.3g} mm"

    def rows(self) -> tuple[Row, ...]:
        """Load, peak after and before."""
        d = self.dataset
        return (
            row("normal_load", float(d.normal_load)),
            row("largest_pressure", float(d.pressure.max())),
            row("peak_before", self.stats.get("peak_before", math.nan)),
        )


def envelop(contact: Contact, length: float) -> Enveloped:
    """The enveloped pressure and shear of a contact.

    length: m; a wave of pressure of that length is halved. Take half the depth, m, from which on the road is read,
    or less: there it makes next to no difference. The load, the forces and the place of their middle are kept to
    round-off; the grid grows by what spreads. Raises InputError for a length below two cells, which leaves nothing
    to envelop.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.7), spacing=0.006)
    >>> tl.contact.envelop(contact, length=0.006)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: an enveloping length of 6 mm is less than two cells of 6 mm; take a longer one
    """
    positive("the enveloping length", length, "metres", "20 mm is 0.02")
    data = contact.dataset
    dx, dy = float(data.attrs["dx"]), float(data.attrs["dy"])
    if length < 2 * max(dx, dy):
        raise InputError(
            f"an enveloping length of {length * 1e3:.3g} mm is less than two cells of {max(dx, dy) * 1e3:.3g} mm; "
            "take a longer one"
        )
    blocks = [max(1, round(length / _CELLS / step)) for step in (dy, dx)]
    # A Gaussian of unit gain whose transform halves the length.
    sigma = _ALPHA * length / math.sqrt(2 * math.pi)
    kernels = [_gaussian(sigma, step) for step in (dy, dx)]
    fields = {name: data[name].to_numpy() for name in ("pressure", "traction_x", "traction_y")}
    spread = {name: _spread(values, kernels, blocks) for name, values in fields.items()}
    axes = []
    for places, kernel, block, step in zip((data.y, data.x), kernels, blocks, (dy, dx), strict=True):
        first, margin = float(places[0]), kernel.size // 2
        left, _ = _margins(places.size + 2 * margin, block)
        start = first - step * (margin + left) + 0.5 * step * (block - 1)
        axes.append((start, step * block))
    ny, nx = spread["pressure"].shape
    pressure = np.maximum(spread["pressure"], 0.0)
    y, x = (start + step * np.arange(count) for (start, step), count in zip(axes, (ny, nx), strict=True))
    load = float(pressure.sum()) * axes[0][1] * axes[1][1]
    result = dataset(
        {
            "pressure": (("y", "x"), pressure),
            "traction_x": (("y", "x"), spread["traction_x"]),
            "traction_y": (("y", "x"), spread["traction_y"]),
            "normal_load": ((), load),
        },
        {"x": x, "y": y},
        dx=axes[1][1],
        dy=axes[0][1],
        enveloping_length=length,
    )
    return Enveloped(result, {"peak_before": float(fields["pressure"].max())})


def _gaussian(sigma: float, step: float) -> Array:
    """Weights of cells, of sum one: integrals of the Gaussian over them."""
    reach = max(1, math.ceil(_REACH * sigma / step))
    edges = (np.arange(-reach, reach + 2) - 0.5) * step
    weights = np.diff(scipy.special.erf(edges / (sigma * math.sqrt(2))))
    return np.asarray(weights / weights.sum())


def _margins(count: int, block: int) -> tuple[int, int]:
    missing = -count % block
    return missing // 2, missing - missing // 2


def _spread(values: Array, kernels: list[Array], blocks: list[int]) -> Array:
    """Values filtered on a grid that holds all of them, as means of blocks."""
    # scipy.signal brings scipy.stats along, which takes as long to import as all of this package.
    from scipy.signal import fftconvolve

    for axis, (kernel, block) in enumerate(zip(kernels, blocks, strict=True)):
        values = np.moveaxis(values, axis, 0)
        values = fftconvolve(values, kernel[:, None], mode="full", axes=0)
        values = np.pad(values, [_margins(values.shape[0], block), (0, 0)])
        values = values.reshape(values.shape[0] // block, block, values.shape[1]).mean(axis=1)
        values = np.moveaxis(values, 0, axis)
    return values
