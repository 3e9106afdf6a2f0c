"""Checks against Materials 2021, 14, 2117 and against an independent trial of its case."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from treadload.contact import Rolling, solve_contact
from treadload.grid import Grid
from treadload.pavement import Pavement
from treadload.response import solve_response
from treadload.tire import Tire, TreadProfile, equal_ribs
from treadload.validation.check import Check, relative
from treadload.validation.pressing import ASPHALT, RUBBER

_PAPER = "Materials 2021, 14, 2117"
_TRIAL = "independent trial program, same tread and cells"


def trial_profile() -> TreadProfile:
    """Tread of the trial: Rx 538, Ry 2000, width 282, four grooves of 12, shoulder radius 10 mm, sharp edges."""
    return TreadProfile(
        rolling_radius=0.538,
        crown_radius=2.0,
        width=0.282,
        shoulder_radius=0.010,
        grooves=equal_ribs(0.282, 4, 0.012, 0.015),
        name="trial",
    )


def footprint_checks() -> Iterator[Check]:
    """Area and peak pressure of the shipped profile at 35 kN on 3 mm cells."""
    tire = Tire.from_profile("315/80R22.5", material=RUBBER)
    contact = solve_contact(tire, Pavement.half_space(ASPHALT), Rolling(normal_load=35e3, friction=0.7))
    group = "paper, 35 kN on 3 mm cells"
    yield relative(group, "contact area, mm²", contact.area * 1e6, 59553, 0.03, _PAPER)
    yield relative(group, "largest pressure, kPa", contact.dataset.pressure.max() / 1e3, 1576, 0.05, _PAPER)


def strain_checks() -> Iterator[Check]:
    """Largest extension at points of the surface at 32.5 kN: free, and driving with 10 kN.

    On the cells of the trial, which meet its tread between two of them: such readings belong to the cells.
    """
    cells = Grid.centred(111 * 3e-3, 98 * 3e-3, 3e-3)
    tire = Tire.from_height_map(trial_profile().gap(cells.x, cells.y), 3e-3, material=RUBBER)
    road = Pavement.half_space(ASPHALT)

    def extension(force: float) -> tuple[float, float]:
        contact = solve_contact(tire, road, Rolling(normal_load=32.5e3, friction=0.7, tractive_force=force))
        strain = solve_response(contact, road, depths=[0.0]).dataset
        return tuple(float(np.nanmax(strain[n])) * 1e6 for n in ("principal_strain_1", "in_plane_strain_1"))  # type: ignore[return-value]

    group = "surface extension, 32.5 kN"
    free, _ = extension(0.0)
    driving, in_plane = extension(10e3)
    yield relative(group, "free rolling, microstrain", free, 25.6, 0.05, _TRIAL)
    yield relative(group, "driving with 10 kN, microstrain", driving, 183, 0.05, _TRIAL)
    yield relative(group, "driving with 10 kN, in plane, microstrain", in_plane, 136, 0.05, _TRIAL)
    # The paper's tread is not published; a scan of 77 treads gave 25.6 to 26.2 and 127 to 179 microstrain.
    yield relative(group, "free rolling, on another tread, microstrain", free, 35, 0.30, _PAPER)
    yield relative(group, "driving with 10 kN, on another tread, microstrain", driving, 200, 0.25, _PAPER)
