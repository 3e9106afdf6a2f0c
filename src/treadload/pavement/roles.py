"""Layers of a road by their role, which holds on any road: the lowest asphalt layer, the subgrade."""

from __future__ import annotations

from treadload.errors import InputError
from treadload.materials import HydraulicMix, Unbound
from treadload.materials.kinds import AnyElastic, elastic_part
from treadload.pavement.asphalt import is_bituminous
from treadload.pavement.layer import Layer
from treadload.pavement.structure import Pavement

TOP, ASPHALT, CEMENT, SUBGRADE = "top layer", "lowest asphalt layer", "lowest cement-bound layer", "subgrade"
ROLES = (TOP, ASPHALT, CEMENT, SUBGRADE)
"""Roles that a criterion can name in place of a layer."""
_ALSO = {"surface layer": TOP, "top of the subgrade": SUBGRADE}
# Words by which the name of a layer says what a plain elastic material is.
_ASPHALT_WORDS = ("asphalt", "bitum", "overlay", "wearing", "binder")
_CEMENT_WORDS = ("cement", "hydraulic", "concrete")


def layer_of_role(road: Pavement, role: str) -> int | None:
    """Number of the layer with a role, from 0 at the surface; None for a text that is no role.

    Materials of the catalogue and viscoelastic ones are known by what they are. An elastic layer is asphalt or bound
    by cement if its name contains such a word; otherwise it is neither below 700 MPa, see `is_bituminous`. Raises
    InputError for a road without such a layer, and where a stiff elastic layer may be either.
    """
    wanted = _role(role)
    if wanted not in ROLES:
        return None
    if wanted in (TOP, SUBGRADE):
        return 0 if wanted == TOP else len(road.layers) - 1
    bound = _bound(road, wanted)
    if not bound:
        listed = ", ".join(f"{number} {layer.name!r}" for number, layer in enumerate(road.layers, start=1))
        what = "asphalt" if wanted == ASPHALT else "bound by cement"
        raise InputError(f"no layer of the road is {what}, so that it has no {wanted}; it has {listed}")
    return bound[-1]


def lacks_role(road: Pavement, role: str) -> bool:
    """True of a role that no layer of a road has. Raises InputError where a stiff elastic layer may have it."""
    wanted = _role(role)
    return wanted in (ASPHALT, CEMENT) and not _bound(road, wanted)


def _role(text: str) -> str:
    wanted = text.casefold().strip()
    return _ALSO.get(wanted, wanted)


def _bound(road: Pavement, role: str) -> list[int]:
    return [number for number, layer in enumerate(road.layers[:-1]) if _kind(layer, number) == role]


def _kind(layer: Layer, number: int) -> str | None:
    """The role that a layer can have by its material, or by its name where the material leaves that open."""
    material = elastic_part(layer.material)
    if isinstance(material, HydraulicMix):
        return CEMENT
    bituminous = is_bituminous(material)
    if bituminous:
        return ASPHALT
    if isinstance(material, Unbound) or not isinstance(material, AnyElastic):
        return None
    name = layer.name.casefold()
    if any(word in name for word in _CEMENT_WORDS) and "asphalt" not in name:
        return CEMENT
    if any(word in name for word in _ASPHALT_WORDS):
        return ASPHALT
    if bituminous is None:
        raise InputError(
            f"layer {number + 1} {layer.name!r} ({material}) may be asphalt or bound by cement, so that its role is "
            'not known; give it a name with "asphalt" or "cement" in it, or a material of the catalogue'
        )
    return None
