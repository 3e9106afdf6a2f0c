"""What a response states of stress-dependent layers: moduli and stress of their parts."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.materials import AtStress
from treadload.pavement import Pavement
from treadload.rows import Row, row

_FIELDS = ("top", "bottom", "layer", "modulus", "bulk_stress", "deviator_stress")


def sublayer_fields(road: Pavement) -> xr.Dataset:
    """Variables over `sublayer` of the parts of a road whose moduli follow from stress; none without such parts.

    sublayer_layer is the number of the part among the layers of the road, whose names are an attribute of a response.
    """
    edges = np.concatenate([[0.0], road.interfaces, [math.nan]])
    rows = [
        (edges[number], edges[number + 1], number, material.modulus, material.bulk, material.deviator)
        for number, layer in enumerate(road.layers)
        if isinstance(material := layer.material, AtStress)
    ]
    if not rows:
        return xr.Dataset()
    names = [f"sublayer_{name}" for name in _FIELDS]
    columns = zip(names, np.array(rows).T, strict=True)
    return xr.Dataset({name: (("sublayer",), values, variables.attributes(name)) for name, values in columns})


def sublayer_rows(data: xr.Dataset) -> Iterator[Row]:
    """Rows of the largest and the least modulus of each stress-dependent layer; none without."""
    if "sublayer_modulus" not in data or data["sublayer_modulus"].dims != ("sublayer",):
        return
    names = json.loads(data.attrs.get("layer_names", "[]"))
    fields = {name: data[f"sublayer_{name}"].to_numpy() for name in _FIELDS}
    numbers = fields["layer"].astype(int)
    layers = [_layer(names[number] if number < len(names) else "") for number in numbers]
    for layer in dict.fromkeys(layers):
        members = np.array([k for k, name in enumerate(layers) if name == layer])
        moduli = fields["modulus"][members]
        for key, place in (("largest", int(moduli.argmax())), ("least", int(moduli.argmin()))):
            part = members[place]
            bulk, deviator = fields["bulk_stress"][part] / 1e3, fields["deviator_stress"][part] / 1e3
            yield row(
                f"{key}_sublayer_modulus",
                float(moduli[place]),
                note=f"{_where(fields, part)}, θ = {bulk:.3g} kPa, q = {deviator:.3g} kPa",
                group=f"{layer or 'layer'}, stress-dependent, in {len(members)} part(s)",
            )


def _layer(name: str) -> str:
    """The name of a layer without the number of its part."""
    return name.rpartition(" ")[0]


def _where(fields: dict[str, np.ndarray], part: int) -> str:
    top, bottom = fields["top"][part] * 1e3, fields["bottom"][part] * 1e3
    return f"below {top:.0f} mm" if math.isnan(bottom) else f"{top:.0f} to {bottom:.0f} mm deep"
