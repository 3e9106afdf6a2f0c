"""Which published methods the stresses in a road call for."""

from __future__ import annotations

from treadload.materials import (
    AtStress,
    Bilinear,
    Boyce,
    HuetSayegh,
    KTheta,
    Model2S2P1D,
    Orthotropic,
    Prony,
    StressDependent,
    TransverselyIsotropic,
    Universal,
    Uzan,
)
from treadload.pavement.bonds import BONDED, HALF_BONDED
from treadload.pavement.structure import Pavement

_LAWS = {"k-theta": KTheta, "uzan": Uzan, "universal": Universal, "boyce": Boyce, "bilinear": Bilinear}


def methods_of(road: Pavement) -> tuple[str, ...]:
    """Keys of `treadload.citations.CITATIONS` for the response of a road, by its materials and bonds.

    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    >>> tl.pavement.methods_of(road)
    ('layers',)
    """
    if isinstance(road.layers[0].material, Orthotropic):
        return ("grain below",)
    upright = any(isinstance(layer.material, TransverselyIsotropic) for layer in road.layers)
    laws = [layer.material.law for layer in road.layers if isinstance(layer.material, StressDependent | AtStress)]
    road = road.at_nominal_stress
    methods = {"upright": upright}
    if not road.is_homogeneous or road.is_viscoelastic:
        bonds = [layer.bond for layer in road.layers[:-1]]
        materials = [layer.resolved for layer in road.layers]
        methods |= {
            "layers": not road.is_homogeneous,
            "sliding": any(bond != BONDED for bond in bonds),
            "half-bonded": HALF_BONDED in bonds,
            "moving": road.is_viscoelastic,
            "huet": any(isinstance(material, HuetSayegh | Model2S2P1D) for material in materials),
            "sayegh": any(isinstance(material, HuetSayegh) for material in materials),
            "2s2p1d": any(isinstance(material, Model2S2P1D) for material in materials),
            "prony": any(isinstance(material, Prony) for material in materials),
        }
    methods["stress-dependent"] = bool(laws)
    methods |= {key: any(isinstance(law, kind) for law in laws) for key, kind in _LAWS.items()}
    return tuple(key for key, is_used in methods.items() if is_used)
