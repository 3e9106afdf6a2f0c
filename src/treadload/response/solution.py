"""The response of a road: stress and strain, and what to read in them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from treadload.composing import BaseResult, Columns, Holds
from treadload.contact import Contact
from treadload.deferred import xarray as xr
from treadload.kernels.largest import index_of_largest
from treadload.pavement import Pavement, methods_of
from treadload.response.fields import COMPONENTS, angle_in_words, direction_in_words, kind_of_points, layer_in_words
from treadload.response.loads import PlacedLoad
from treadload.response.sublayers import sublayer_rows
from treadload.rows import Place, Row, row

_FIELDS = " ".join(
    (*(f"{kind}_{component}" for kind in ("stress", "strain") for component in COMPONENTS), "principal_strain_2",
     "principal_strain_3", "von_mises_stress", "octahedral_shear_stress", "mean_stress", "mazars_strain")
)  # fmt: skip
# More than any road has; what is beyond numbers no layer.
_MOST_LAYERS = 10_000


@dataclass(frozen=True, eq=False)
class Response(BaseResult, group="response"):
    """Stress and strain in a road.

    dataset: fields (depth, y, x), or (depth, point) of a list of points, with the names of `treadload.variables`; its
    attributes hold the material. stats: seconds spent, points evaluated, method ("fft", "precorrected", "direct",
    "disc", "layered" or several, "none" without load). warnings: sentences for the user. loads, road, speed, side:
    the question, so that more can be asked of the same road; no road for fields that come from elsewhere. restrained:
    stress that was added to both horizontal normal stresses, Pa, one per depth; empty where none was, see
    `add_thermal_stress`. contacts: that the loads are, as `solve_response` takes them; empty for other loads and in a
    response that was opened from a file.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.0, 0.15], x=[0.0], y=[0.0])
    >>> f"deflection {response.dataset.displacement_z.sel(depth=0).item() * 1e3:.2f} mm"
    'deflection 0.71 mm'
    """

    title: ClassVar[str] = "Strain in the road"
    sections: ClassVar[tuple[str, ...]] = ("slice_along", "slice_across", "bowl")
    also: ClassVar[tuple[str, ...]] = ("points", "slice")
    columns: ClassVar[Columns] = Columns(stats="Response")

    # On a grid, or at a list of points.
    holds: ClassVar[Holds] = Holds(
        {
            "depth": "depth",
            "x y": "...",
            "principal_strain_1 in_plane_strain_1 in_plane_angle_1": "depth @",
            "principal_direction_1": "depth @ component",
        },
        not_nan="principal_strain_1 in_plane_strain_1",
        maybe={
            f"{_FIELDS} displacement_x displacement_y displacement_z": "depth @",
            "dissipated_energy": "depth y",
            "layer": "depth",
            "sublayer_top sublayer_bottom sublayer_modulus sublayer_bulk_stress sublayer_deviator_stress": "sublayer",
            "sublayer_layer": "sublayer",
        },
        finite="layer",
        bounded=f"{_FIELDS} principal_strain_1 in_plane_strain_1 in_plane_angle_1 principal_direction_1",
        codes={"layer": _MOST_LAYERS},
        with_it={"principal_strain_1": "principal_direction_1", "in_plane_strain_1": "in_plane_angle_1"},
        json={"layer_names": list},
        tree="x y depth",
        maybe_numbers="mean_over speed load_x",
        sizes={"component": (3, 3)},
    )

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    loads: tuple[PlacedLoad, ...] = ()
    road: Pavement | None = None
    speed: float | None = None
    side: Literal["above", "below"] = "above"
    restrained: tuple[float, ...] = ()
    contacts: tuple[Contact, ...] = field(default=(), init=False)

    @property
    def group_name(self) -> str:
        """What its points are: a map, a section along or across travel, a line of the surface, a list."""
        return kind_of_points(self.dataset)

    @property
    def heading(self) -> str:
        """The road, and the points."""
        data = self.dataset
        return (
            f"{data.attrs.get('road', 'unnamed road')}; {data.sizes['depth']} depth(s) of {_count(data)} points"
            + (f"; means over {data.attrs['mean_over'] * 1e3:g} mm" if "mean_over" in data.attrs else "")
        )

    def rows(self) -> tuple[Row, ...]:
        """Largest tensile strain at each depth, in space and in the horizontal plane, with its place; then moduli.

        The moduli are those of stress-dependent layers, if the road has any.
        """
        lines = []
        for number, depth in enumerate(self.dataset["depth"].values):
            plane = self.dataset.isel(depth=number)
            side = layer_in_words(plane)
            group = f"depth {depth * 1e3:g} mm{f' ({side})' if side else ''}"
            lines += strain_rows(plane, group)
        return (*lines, *sublayer_rows(self.dataset))

    def cites(self) -> tuple[str, ...]:
        """Methods of the stresses, and of the road's materials and bonds."""
        return ("influence", "convolution", "stress", *(() if self.road is None else methods_of(self.road)))


def strain_rows(data: xr.Dataset, group: str = "") -> list[Row]:
    """Rows of the largest strains of a map or a section, three-dimensional and in the horizontal plane."""
    kinds = (
        ("largest_principal_strain", "principal_strain_1", _in_space),
        ("largest_in_plane_strain", "in_plane_strain_1", _in_plane),
    )
    return [_largest(key, data[name], group, direction, data) for key, name, direction in kinds if name in data]


def _largest(
    key: str, strain: xr.DataArray, group: str, direction: Callable[[xr.Dataset], str], plane: xr.Dataset
) -> Row:
    """The row of the largest strain of a plane, with its place and direction. strain: one of the plane's fields."""
    values = strain.to_numpy()
    if np.isnan(values).all():
        return row(key, np.nan, group=group, note="unknown: it is NaN everywhere")
    index = index_of_largest(values, horizontal=len({"x", "y"} & set(strain.dims)))
    here = plane.isel(dict(zip(map(str, strain.dims), index, strict=True)))
    value = float(np.nanmax(values))
    if value <= 0:
        return row(key, value, group=group, note="no tensile strain")
    depth = float(here["depth"]) if "depth" in strain.dims else None
    return row(key, value, group=group, place=Place(float(here["x"]), float(here["y"]), depth), note=direction(here))


def _count(data: xr.Dataset) -> str:
    return str(data.sizes["point"]) if "point" in data.sizes else f"{data.sizes['x']} x {data.sizes['y']}"


def _in_space(here: xr.Dataset) -> str:
    return direction_in_words(here["principal_direction_1"].to_numpy())


def _in_plane(here: xr.Dataset) -> str:
    return angle_in_words(float(here["in_plane_angle_1"]))
