"""The design that a case describes, and the thickness of a layer for which its road lasts."""

from __future__ import annotations

from treadload.case import Case
from treadload.case.description import Description
from treadload.contact.contact_grid import DEFAULT_SPACING
from treadload.errors import InputError
from treadload.life.contacts import Contacts, Progress
from treadload.life.design import Design
from treadload.life.thickness import ThicknessDesign, design_thickness


def spacing_of(case: Description) -> float:
    """Of the contact's cells, m: surface lives move by less than 5 % on finer ones, by half on cells of 6 mm."""
    return DEFAULT_SPACING if case.spacing is None else case.spacing


def design_of(case: Case, contacts: Contacts | None = None) -> Design:
    """The design of a case: tire, road, traffic, climate, criteria, options of its tables. Raises InputError.

    contacts: of the tire of the case, those that are solved already among them; left out, none is.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> design = tl.steps.design_of(tl.Case.from_dict(case))
    >>> f"{design.traffic.classes[0].wheel_load / 1e3:.0f} kN on a wheel"
    '50 kN on a wheel'
    """
    contacts = contacts or Contacts(case.build_tire(), spacing_of(case))
    return Design(
        contacts.tire,
        case.road(),
        case.build_traffic(),
        case.build_climate(),
        case.build_criteria(),
        criteria_of=case.criteria_on,
        rutting=None if case.rutting is None else case.rutting.build(),
        scatter=None if case.reliability is None else case.reliability.build(),
        spacing=spacing_of(case),
        tolerance=case.source.tolerance_of(case),
        contacts=contacts,
    )


def design_case(
    case: Case,
    layer: int | str,
    *,
    years: float | None = None,
    risk: float | None = None,
    between: tuple[float, float] = (0.04, 0.4),
    step: float = 0.01,
    workers: int | None = None,
    progress: Progress | None = None,
) -> ThicknessDesign:
    """The thickness of a layer for which the road of a case lasts.

    layer: its name, or its number from the surface, 1 the top one, as in `[[criteria]]`. years: those of the traffic
    if left out. risk: of failing, in (0, 1); with `[reliability]` in the case the years at that risk are those of its
    scatter. between, step: m, see `design_thickness`. workers, progress: as in `treadload.run`. Raises InputError,
    and ConvergenceError of a contact.

    >>> axle = {"name": "cart", "share": 1, "axle_load": "1 kN", "inflation_pressure": "8 bar"}
    >>> profile = {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}
    >>> mix, earth = ({"kind": "elastic", "modulus": modulus, "poisson": 0.35} for modulus in ("5 GPa", "60 MPa"))
    >>> top, soil = {"name": "asphalt", "thickness": "3 cm", "material": mix}, {"name": "soil", "material": earth}
    >>> case = {"tire": {"profile": profile}, "pavement": {"layers": [top, soil]}, "spacing": "1 cm"}
    >>> case |= {"traffic": {"passes_per_year": 1e7, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> line = {"law": "fatigue-line", "epsilon_6": "120 microstrain", "slope": -0.2}
    >>> case["criteria"] = [{"name": "base", "layer": "asphalt", "place": "bottom"} | line]
    >>> answer = tl.steps.design_case(tl.Case.from_dict(case), "asphalt", years=10, between=(0.05, 0.1))
    >>> f"{answer.dataset.design_thickness.item() * 1e3:.0f} mm of asphalt last 20 years"
    '50 mm of asphalt last 20 years'
    """
    design, number = design_of(case), layer
    if isinstance(layer, int):
        if not 1 <= layer <= len(design.road.layers):
            raise InputError(
                f"no layer {layer}; the road has 1 to {len(design.road.layers)}, counted from the surface"
            )
        number = layer - 1
    return design_thickness(
        design, number, years=years, risk=risk, between=between, step=step, workers=workers, progress=progress
    )
