"""What every class of axle does to the surface in every season besides cracking it: polishing and tearing."""

from __future__ import annotations

import numpy as np

from treadload.damage.indices import polishing_work, tearing_work
from treadload.life.design import Design
from treadload.life.seasons import warmed
from treadload.life.wheels import states_of
from treadload.pavement import Pavement


def surface_works(design: Design) -> dict[str, tuple[tuple[str, ...], object]]:
    """Largest works of one wheel's passage, J/m², from contacts that are solved, see `damage.indices`.

    largest_polishing_work (axle_class); largest_tearing_work (axle_class, season), with the shear modulus of the
    surface in the season; NaN where the wheel does not slide along, or the surface has no modulus of its own.
    """
    solved = [design.contacts.of(states_of(row, design.tire)[0]) for row in design.traffic.classes]
    polishing = [
        float(polishing_work(contact).max()) if "friction_work" in contact.dataset else float("nan")
        for contact in solved
    ]
    moduli = np.array([_shear_modulus(warmed(design.road, (), season).road) for season in design.climate.seasons])
    # The work is one over the modulus: once for each contact.
    softness = np.divide(1.0, moduli, out=np.full(len(moduli), np.nan), where=moduli > 0)
    tearing = np.outer([float(tearing_work(contact, 1.0).max()) for contact in solved], softness)
    return {
        "largest_polishing_work": (("axle_class",), np.array(polishing)),
        "largest_tearing_work": (("axle_class", "season"), tearing),
    }


def _shear_modulus(road: Pavement) -> float:
    """Of the top layer, Pa; 0 for one that is viscoelastic or anisotropic."""
    modulus = getattr(road.layers[0].resolved, "shear_modulus", 0.0)
    return float(modulus) if isinstance(modulus, int | float) else 0.0
