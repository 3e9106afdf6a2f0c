"""A half-space of any anisotropic material for the response: its modes, and loads as its kernels take them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from treadload.errors import InputError
from treadload.kernels.anisotropy.interior import Modes
from treadload.kernels.anisotropy.symbol import NotConvergedError
from treadload.materials import Anisotropic
from treadload.response.loads import GridLoad, SurfaceLoad, UniformDisc
from treadload.response.material import laid

# Cells across a disc: it has no closed form here.
_ACROSS = 64


def modes_of(material: Anisotropic, unit: float) -> Modes:
    """What the kernels need of a material. unit: Pa, over which its stiffness is taken.

    Raises InputError for one whose stiffness differs more with direction than they can follow.
    """
    try:
        return _modes(np.ascontiguousarray(material.stiffness / unit).tobytes())
    except NotConvergedError as error:
        raise InputError(
            f"the stiffness of the road ({material}) differs with direction more than the stress below can be "
            f"computed for: {error}; bring its moduli closer together"
        ) from error


def on_cells(loads: Sequence[SurfaceLoad]) -> list[SurfaceLoad]:
    """Loads uniform on cells; a disc as 64 cells across, loaded as far as it covers them: to 4e-4 of its pressure.

    Raises InputError for loads that vary within their cells.
    """
    taken: list[SurfaceLoad] = []
    for load in loads:
        if isinstance(load, GridLoad) and load.interpolation == "bilinear":
            raise InputError(
                'a load with interpolation="bilinear" has no closed form on a road of general anisotropy; take '
                'interpolation="constant", or a TransverselyIsotropic road'
            )
        taken.append(laid(load, 2 * load.radius / _ACROSS) if isinstance(load, UniformDisc) else load)
    return taken


@lru_cache(maxsize=8)
def _modes(stiffness: bytes) -> Modes:
    """Of the numbers of a stiffness matrix, kept: one road carries many loads."""
    return Modes.of(np.frombuffer(stiffness).reshape(6, 6))
