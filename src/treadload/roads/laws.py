"""Laws of stress-dependent layers in the dataset of a backcalculation, and the layers that they give back."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping

import numpy as np

from treadload.kernels.arrays import Array
from treadload.materials import StressDependent
from treadload.materials.stress_laws import ModulusLaw
from treadload.pavement import Pavement
from treadload.registry import MODULUS_LAWS
from treadload.roads.unknowns import layer_names

LAWS = "layer_laws"
"""Attribute with the material of each stress-dependent layer as JSON: tables as a case has them, of a factor of 1."""


def law_factors(road: Pavement, moduli: Array) -> Array:
    """Factor on the law of each layer (n, L) from its moduli at the nominal stress, Pa; NaN of others."""
    factors = np.full(moduli.shape, np.nan)
    for number, layer in enumerate(road.layers):
        if isinstance(layer.material, StressDependent):
            factors[:, number] = moduli[:, number] / dataclasses.replace(layer.material, factor=1.0).nominal.modulus
    return factors


def laws_as_json(road: Pavement) -> str:
    """For the attribute `LAWS`: name of a layer → table of its material, of those that can be written as one."""
    tables = {
        name: _table(layer.material)
        for name, layer in zip(layer_names(road), road.layers, strict=True)
        if isinstance(layer.material, StressDependent)
    }
    return json.dumps({name: table for name, table in tables.items() if table is not None})


def _table(material: StressDependent) -> dict[str, object] | None:
    """The material as a table of a case, of a factor of 1; None where its law is none that a table can hold."""
    law = _law_table(material.law)
    if law is None:
        return None
    names = [entry.name for entry in dataclasses.fields(StressDependent) if entry.name not in ("law", "factor")]
    rest = {name: getattr(material, name) for name in names}
    return {"kind": "stress-dependent", "law": law, **{name: v for name, v in rest.items() if v is not None}}


def _law_table(law: ModulusLaw) -> Mapping[str, object] | None:
    kind = next((name for name in MODULUS_LAWS.names() if MODULUS_LAWS.find(name).target is type(law)), None)
    if kind is None or not dataclasses.is_dataclass(law):
        return None
    values = {entry.name: getattr(law, entry.name) for entry in dataclasses.fields(law)}
    if not all(isinstance(value, int | float | str | None) for value in values.values()):
        return None
    return {"kind": kind, **{name: value for name, value in values.items() if value is not None}}
