"""What every class of axle does to the surface in every season besides cracking it: polishing and tearing."""

from __future__ import annotations

from typing import Any

import numpy as np

from treadload.damage.climate import Climate
from treadload.damage.indices import polishing_work, tearing_work
from treadload.damage.traffic import Traffic
from treadload.pavement import Pavement
from treadload.study.contacts import Contacts
from treadload.study.seasons import warmed
from treadload.study.wheels import states_of
from treadload.tire import Tire


def surface_works(
    tire: Tire, road: Pavement, traffic: Traffic, climate: Climate, contacts: Contacts
) -> dict[str, tuple[tuple[str, ...], Any]]:
    """Largest works of one wheel's passage, J/m², from contacts that are known, see `damage.indices`.

    largest_polishing_work (axle_class); largest_tearing_work (axle_class, season), with the shear modulus of the
    surface in the season; NaN where the wheel does not slide along, or the surface has no modulus of its own.
    """
    known = [contacts.known[states_of(row, tire)[0]] for row in traffic.classes]
    polishing = [
        float(polishing_work(one).max()) if "friction_work" in one.dataset else float("nan") for one in known
    ]
    moduli = np.array([_shear_modulus(warmed(road, (), season).road) for season in climate.seasons])
    # The work is one over the modulus: once for each contact.
    softness = np.divide(1.0, moduli, out=np.full(len(moduli), np.nan), where=moduli > 0)
    tearing = np.outer([float(tearing_work(one, 1.0).max()) for one in known], softness)
    return {
        "largest_polishing_work": (("axle_class",), np.array(polishing)),
        "largest_tearing_work": (("axle_class", "season"), tearing),
    }


def _shear_modulus(road: Pavement) -> float:
    """Of the top layer, Pa; 0 for one that is viscoelastic or anisotropic."""
    modulus = getattr(road.layers[0].resolved, "shear_modulus", 0.0)
    return float(modulus) if isinstance(modulus, int | float) else 0.0
