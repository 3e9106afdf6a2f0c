"""A solved tire as coefficients of the Magic Formula 6.1: bounded fits of its curves over slip."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from treadload.contact import Contact, Rolling
from treadload.contact.solvers.coupling import Progress
from treadload.describing import Described
from treadload.errors import InputError, within
from treadload.footprint.free_states import FreeState, free_state
from treadload.footprint.slip_curves import (
    REACH,
    WIDEST_ANGLE,
    WIDEST_SLIP,
    SlipCurve,
    SlipSolver,
    combined_loads,
)
from treadload.footprint.tir_coefficients import (
    ACROSS,
    ACROSS_PRESSURE,
    ALONG,
    ALONG_PRESSURE,
    CAMBER,
    COMBINED,
    INDUCED,
    MOMENT,
    MOMENT_PRESSURE,
    ONE_SIDED,
    PRESSED,
    QUADRATIC_IN_PRESSURE,
    RESISTANCE,
    SPEEDS,
    Bounds,
    Draft,
)
from treadload.footprint.tir_sections import Sections, fit_sections
from treadload.footprint.tire_card import listed_loads, listed_pressures
from treadload.kernels.arrays import Array
from treadload.kernels.magic_formula import ALIGNING, LATERAL, LONGITUDINAL, OVERTURNING, SCALES
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tire import MagicFormula, Tire
from treadload.variables import Display

_FEWEST = 3
# Reference speed of a file whose solves had none, m/s: programs ask for one; no coefficient here depends on it.
_SPEED = 16.7
# Share of the load, rms, above which a curve is warned about; of a deflection, radius, stiffness or moment.
_GOOD, _GOOD_STATE = 0.01, 0.05
_SHARE = Display("", "%", ".2f")
_SOLVED = (
    "Fitted to contacts solved by treadload. LONGITUDINAL_STIFFNESS and LATERAL_STIFFNESS are those of the standing "
    "tire, which slip stiffnesses are divided by for the relaxation lengths."
)


@dataclass(frozen=True, eq=False, repr=False)
class FittedFormula(Described):
    """A Magic Formula that was fitted to a solved tire.

    formula: version 6.1, ISO signs. curves: that were solved. residuals: of each curve by its name, and of it by
    variable ("tractive_force", "lateral_force", "aligning_moment"): rms of fit less solve over the load, of moments
    over load times radius. states: free rolling and standing, at each load and inflation pressure; state_residuals:
    rms of what is fitted to them, over the solved value. undecided: coefficients that the curves do not decide, with
    the defaults at which they are fixed. not_fitted: coefficients at their defaults, by the reason.
    at_bounds: coefficients that ended at a bound of the fit. friction: of the solves, in words.
    """

    title: ClassVar[str] = "Magic Formula of a solved tire"

    formula: MagicFormula
    curves: tuple[SlipCurve, ...]
    residuals: Mapping[str, Mapping[str, float]]
    states: tuple[FreeState, ...]
    state_residuals: Mapping[str, float]
    undecided: Mapping[str, float]
    not_fitted: Mapping[str, tuple[str, ...]]
    at_bounds: tuple[str, ...]
    friction: str
    solve_warnings: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """Tire, friction, and loads."""
        loads = sorted({curve.normal_load for curve in self.curves})
        return (
            f"{self.formula.name or 'a tire'}, friction {self.friction}, {loads[0] / 1e3:g} to {loads[-1] / 1e3:g} kN"
        )

    @property
    def largest_residual(self) -> float:
        """The largest rms of all curves, over the load."""
        return max(value for values in self.residuals.values() for value in values.values())

    @property
    def warnings(self) -> tuple[str, ...]:
        """Curves that are fitted badly, coefficients at a bound, and the warnings of all contacts."""
        poor = [
            f"{variable.replace('_', ' ')} of {name} is fitted to {100 * value:.1f} % of the load, more than "
            f"{100 * _GOOD:g} %: leave that load out, or narrow the loads"
            for name, values in self.residuals.items()
            for variable, value in values.items()
            if value > _GOOD
        ]
        poor += [
            f"the {name.replace('_', ' ')} is fitted to {100 * value:.1f} %, more than {100 * _GOOD_STATE:g} %: "
            "narrow the loads or the inflation pressures"
            for name, value in self.state_residuals.items()
            if value > _GOOD_STATE
        ]
        ends = [f"{', '.join(self.at_bounds)} ended at a bound of the fit"] if self.at_bounds else []
        return (*poor, *ends, *self.solve_warnings)

    def cites(self) -> tuple[str, ...]:
        """Methods, keys of `treadload.citations.CITATIONS`: of the formula and of the solves."""
        return (*self.formula.cites(), "influence", "convolution", "normal", "preconditioner", "rolling", "newton")

    def rows(self) -> tuple[Row, ...]:
        """Slopes and friction of the formula, and the residual of each curve."""
        rows = [line for line in self.formula.rows() if line.key != "nominal_pressure"]
        fixed = ", ".join(f"{name} = {value:g}" for name, value in self.undecided.items())
        rows.append(row("undecided", fixed or "none", label="fixed, as the curves leave them open"))
        rows += [row("not_fitted", ", ".join(names), label=reason) for reason, names in self.not_fitted.items()]
        rows += [
            row(
                name, value, group="rms of what is fitted, free rolling", display=_SHARE, label=name.replace("_", " ")
            )
            for name, value in self.state_residuals.items()
        ]
        for name, values in self.residuals.items():
            rows += [
                row(variable, values.get(variable, math.nan), group=f"rms, {name}", label=label, display=_SHARE)
                for variable, label in _LABELS.items()
            ]
        return tuple(rows)


_LABELS = {
    "tractive_force": "F_x over load",
    "lateral_force": "F_y over load",
    "aligning_moment": "M_z over load × radius",
}
_READ = {
    "along": ("tractive_force",),
    "across": ("lateral_force", "aligning_moment"),
    "combined": ("tractive_force", "lateral_force", "aligning_moment"),
}


def magic_formula(
    tire: Tire,
    road: Pavement,
    rolling: Rolling,
    *,
    loads: Sequence[float] | Array,
    pressures: Sequence[float] | Array = (),
    reach: float = 1.0,
    spacing: float | None = None,
    progress: Progress | None = None,
) -> FittedFormula:
    """Coefficients of the Magic Formula 6.1 of a tire, fitted to its solved curves over slip.

    rolling: friction and speed; its load, forces and creepages are not read. loads: of the wheel, N, three or more,
    distinct; the middle one is the nominal load. pressures: inflation pressures beside that of the tire, which is the
    nominal one, Pa; two or more for a quadratic influence. Curves along travel (κ to ±0.3) and across (to 14°) at
    each load, combined slip (κ to ±0.25 at 2° and 5°) at the smallest, the middle and the largest; at other pressures
    curves along and across at these three. reach: factor of these slips and angles, 0.3 to 3. spacing, progress: as
    in `solve_contact`. Deflection, effective radius, stiffnesses of the standing tire and, where the tread is
    viscoelastic, rolling resistance are fitted to the same loads and pressures.
    Raises InputError for fewer loads, pressures of a tire that does not depend on them, a tire without a radius, that
    leans or that pulls to a side, curves that never slide, and as `solve_contact`.
    Source: Pacejka (2012), Tire and Vehicle Dynamics, section 4.3; Besselink et al. (2010); bounded least squares.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.5, 1.0, 0.25), inflation_pressure=8e5)
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5e9, 0.35)), tl.Rolling(normal_load=30e3, friction=0.7)
    >>> tl.footprint.magic_formula(tire, road, wheel, loads=[20e3, 40e3])
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: a fit needs 3 loads or more, got 2: its coefficients are quadratic in the load;
    give such as [20e3, 27.5e3, 35e3] N ("20 kN; 27.5 kN; 35 kN")
    """
    forces = listed_loads(loads)
    if len(forces) < _FEWEST:
        raise InputError(
            f"a fit needs {_FEWEST} loads or more, got {len(forces)}: its coefficients are quadratic in the load; "
            'give such as [20e3, 27.5e3, 35e3] N ("20 kN; 27.5 kN; 35 kN")'
        )
    within("reach", reach, *REACH, "", "1 solves slips of up to 0.3")
    inflation = _other_pressures(tire, pressures)
    radius = tire.outer_radius
    if radius is None:
        raise InputError("this tire has no outer radius, to which moments refer; give a profile or a scan")
    if tire.camber:
        raise InputError(
            f"the tire leans by {math.degrees(tire.camber):.3g}°, and curves of an upright tire are fitted; stand it "
            "upright, with camber = 0"
        )
    curves: list[SlipCurve] = []
    states: list[FreeState] = []
    free: list[Contact] = []
    for pressure in (None, *inflation):
        inflated = tire if pressure is None else replace(tire, inflation_pressure=pressure)
        solver = SlipSolver(inflated, road, rolling, reach, spacing, progress, pressure)
        at_ends = combined_loads(forces)
        for load in forces if pressure is None else at_ends:
            contact = solver.free(load)
            creepage = float(contact.dataset["creepage_x"])
            free.append(contact)
            states.append(free_state(inflated, road, load, contact, radius, spacing))
            curves += solver.pure(load, creepage)
            curves += solver.combined(load, creepage) if pressure is None and load in at_ends else []
    if progress is not None:
        progress("fitting")
    draft = Draft(forces[len(forces) // 2], radius, tire.inflation_pressure)
    alone = QUADRATIC_IN_PRESSURE if len(inflation) == 1 else ()
    for bounds, pressed, kind, variables in _STAGES:
        more = {name: numbers for name, numbers in pressed.items() if inflation and name not in alone}
        draft.fit({**bounds, **more}, [curve for curve in curves if curve.kind == kind], variables)
    sections = fit_sections(states, draft.nominal_load, radius, tire.inflation_pressure)
    draft.undecided["BREFF"] = sections.vertical["BREFF"]
    absent = _absent(len(inflation), has_resistance=bool(sections.rolling))
    depths = np.array([(state.deflection, state.normal_load) for state in states[: len(forces)]]).T
    formula = MagicFormula(
        "6.1",
        "ISO",
        _frozen(_sections(draft, sections, rolling, [tire.inflation_pressure, *inflation], depths[1], reach)),
        "",
        tire.name,
        np.column_stack([[0.0, 0.0], depths]),
        (_SOLVED, *_remarks(draft.undecided, absent)),
    )
    residuals = {
        curve.name: {name: float(np.sqrt(np.mean(_off(formula, curve, name) ** 2))) for name in _READ[curve.kind]}
        for curve in curves
    }
    return FittedFormula(
        formula,
        tuple(curves),
        _frozen(residuals),
        tuple(states),
        MappingProxyType(dict(sections.residuals)),
        MappingProxyType(draft.undecided),
        MappingProxyType(absent),
        tuple(draft.at_bounds),
        str(rolling.law),
        tuple(dict.fromkeys(text for contact in free for text in contact.warnings)),
    )


# Bounds, those beside them where several inflation pressures are solved, and the curves that decide.
_STAGES: tuple[tuple[Bounds, Bounds, str, tuple[str, ...]], ...] = (
    (ALONG, ALONG_PRESSURE, "along", ("tractive_force",)),
    (ACROSS, ACROSS_PRESSURE, "across", ("lateral_force",)),
    (MOMENT, MOMENT_PRESSURE, "across", ("aligning_moment",)),
    (COMBINED, {}, "combined", ("tractive_force", "lateral_force")),
)


def _other_pressures(tire: Tire, pressures: Sequence[float] | Array) -> list[float]:
    """Inflation pressures beside that of the tire, Pa, sorted. Raises InputError."""
    if len(pressures) == 0:
        return []
    listed = listed_pressures(pressures)
    nominal = tire.inflation_pressure
    if nominal is None or tire.material is not None:
        what = "has no inflation pressure" if nominal is None else f"is of {tire.material} whatever its inflation"
        raise InputError(
            f"the tire {what}, so that {len(listed)} pressures decide nothing; leave pressures out, or give "
            "inflation_pressure and a belt"
        )
    return [pressure for pressure in listed if pressure != nominal]


def _absent(pressures: int, *, has_resistance: bool) -> dict[str, tuple[str, ...]]:
    """Coefficients that nothing was solved for, by the reason."""
    absent = {
        "0, as the tire is upright": CAMBER,
        "0, as the tire has neither ply steer nor conicity": ONE_SIDED,
        "0, as forces that combined slip adds are not fitted": INDUCED,
        "absent, as no overturning moment is solved": tuple(OVERTURNING),
    }
    if pressures == 0:
        absent["0, as one inflation pressure is solved"] = PRESSED
    elif pressures == 1:
        absent["0, as one inflation pressure beside the nominal one is solved"] = QUADRATIC_IN_PRESSURE
    if has_resistance:
        absent["0, as one speed of free rolling is solved"] = SPEEDS
    else:
        absent["absent, as an elastic tread does not resist rolling"] = RESISTANCE
    return absent


def _remarks(undecided: Mapping[str, float], absent: Mapping[str, tuple[str, ...]]) -> Iterable[str]:
    """Comments of a file."""
    yield "Fixed, as the curves leave them open: " + ", ".join(
        f"{key} = {value:g}" for key, value in undecided.items()
    )
    for reason, names in absent.items():
        yield f"{reason[0].upper()}{reason[1:]}: {', '.join(names)}."


def _sections(
    draft: Draft,
    fitted: Sections,
    rolling: Rolling,
    pressures: Sequence[float | None],
    loads: Array,
    reach: float,
) -> Mapping[str, Mapping[str, float]]:
    """Sections of the file. pressures: the nominal one first."""

    def part(names: Sequence[str]) -> Mapping[str, float]:
        return {name: float(draft.values.get(name, 0.0)) for name in names}

    inflation = [pressure for pressure in pressures if pressure is not None]
    slip, angle = reach * WIDEST_SLIP, reach * WIDEST_ANGLE
    return {
        "MODEL": {"LONGVL": rolling.speed or _SPEED},
        "DIMENSION": {"UNLOADED_RADIUS": draft.radius},
        "OPERATING_CONDITIONS": {"NOMPRES": inflation[0], "INFLPRES": inflation[0]} if inflation else {},
        "VERTICAL": fitted.vertical,
        "STRUCTURAL": fitted.structural,
        "INFLATION_PRESSURE_RANGE": {"PRESMIN": min(inflation), "PRESMAX": max(inflation)} if inflation else {},
        "VERTICAL_FORCE_RANGE": {"FZMIN": float(loads[0]), "FZMAX": float(loads[-1])},
        "LONG_SLIP_RANGE": {"KPUMIN": -slip, "KPUMAX": slip},
        "SLIP_ANGLE_RANGE": {"ALPMIN": -angle, "ALPMAX": angle},
        "SCALING_COEFFICIENTS": dict.fromkeys(SCALES, 1.0),
        "LONGITUDINAL_COEFFICIENTS": part(LONGITUDINAL),
        "LATERAL_COEFFICIENTS": part(LATERAL),
        "ROLLING_COEFFICIENTS": fitted.rolling,
        "ALIGNING_COEFFICIENTS": part(ALIGNING),
    }


def _frozen(table: Mapping[str, Mapping[str, float]]) -> Mapping[str, Mapping[str, float]]:
    return MappingProxyType({name: MappingProxyType(dict(values)) for name, values in table.items()})


def _off(formula: MagicFormula, curve: SlipCurve, variable: str) -> Array:
    """Fit less solve over the load; of moments over load times radius. (n,)."""
    out = formula.forces(
        curve.normal_load, slip=curve.slip, slip_angle=curve.slip_angle, inflation_pressure=curve.inflation_pressure
    )
    scale = curve.normal_load * (formula.unloaded_radius if variable == "aligning_moment" else 1.0)
    off: Array = (getattr(out, variable) - getattr(curve, variable)) / scale
    return off
