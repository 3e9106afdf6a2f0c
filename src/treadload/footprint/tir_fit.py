"""A solved tire as coefficients of the Magic Formula 6.1: bounded fits of its curves over slip."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from treadload.contact import Rolling
from treadload.contact.solvers.coupling import Progress
from treadload.describing import Described
from treadload.errors import InputError, within
from treadload.footprint.slip_curves import REACH, SlipCurve, SlipSolver, combined_loads
from treadload.footprint.tire_card import listed_loads
from treadload.kernels.arrays import Array
from treadload.kernels.magic_formula import ALIGNING, LATERAL, LONGITUDINAL, SCALES
from treadload.pavement import Pavement
from treadload.rows import Row, row
from treadload.tire import MagicFormula, Tire
from treadload.variables import Display

Bounds = Mapping[str, tuple[float, float, float]]

# Start, lowest and highest value of each coefficient, by the curves that decide it. Without bounds fits of solved
# curves end at C or E that mean nothing; these hold whatever a pneumatic tire on a dry or wet road can have.
_ALONG: Bounds = {
    "PCX1": (1.2, 1, 2), "PDX1": (0.7, 0.05, 3), "PDX2": (0, -1, 1), "PEX1": (-2, -20, 1), "PEX2": (0, -20, 1),
    "PEX3": (0, -20, 20), "PEX4": (0, -1, 1), "PKX1": (12, 1, 200), "PKX2": (0, -50, 50), "PKX3": (0, -3, 3),
    "PHX1": (0, -0.02, 0.02), "PHX2": (0, -0.02, 0.02), "PVX1": (0, -0.05, 0.05), "PVX2": (0, -0.05, 0.05),
}  # fmt: skip
_ACROSS: Bounds = {
    "PCY1": (1.5, 1, 2), "PDY1": (0.7, 0.05, 3), "PDY2": (0, -1, 1), "PEY1": (0.5, -20, 1), "PEY2": (0, -20, 1),
    "PKY1": (-12, -200, -0.5), "PKY2": (1.5, 0.1, 20),
}  # fmt: skip
_MOMENT: Bounds = {
    "QBZ1": (8, 0.5, 60), "QBZ2": (0, -50, 50), "QBZ3": (0, -50, 50), "QCZ1": (1.2, 0.5, 3), "QDZ1": (0.05, 0, 1),
    "QDZ2": (0, -1, 1), "QEZ1": (0, -20, 1), "QEZ2": (0, -20, 20), "QEZ3": (0, -20, 20),
}  # fmt: skip
_COMBINED: Bounds = {
    "RBX1": (8, 0.5, 60), "RBX2": (5, -60, 60), "RCX1": (1, 0.5, 2), "REX1": (-0.5, -20, 1), "REX2": (0, -20, 20),
    "RBY1": (8, 0.5, 60), "RBY2": (5, -60, 60), "RCY1": (1, 0.5, 2), "REY1": (-0.5, -20, 1), "REY2": (0, -20, 20),
}  # fmt: skip
# Over loads on the rising side PKY4 and PKY2 trade off: any PKY4 of 0.5 to 2 fits as well with another PKY2.
_UNDECIDED = {"PKY4": 2.0}
_FEWEST = 3
# Reference speed of a file whose solves had none, m/s: programs ask for one; no coefficient here depends on it.
_SPEED = 16.7
# Share of the load, rms, above which a curve is warned about, and of the width between bounds within which a
# coefficient has ended at one of them.
_GOOD, _AT_BOUND = 0.01, 1e-4
_SHARE = Display("", "%", ".2f")
_NOTES = (
    "Fitted to contacts solved by treadload: upright, at one inflation pressure, symmetric to both sides. "
    "Coefficients of camber, of the pressure, of ply steer and conicity, and of what combined slip adds to the "
    "lateral force and the arm of the moment are 0; there are none of overturning and rolling resistance.",
)


@dataclass(frozen=True, eq=False, repr=False)
class FittedFormula(Described):
    """A Magic Formula that was fitted to a solved tire.

    formula: version 6.1, ISO signs. curves: that were solved. residuals: of each curve by its name, and of it by
    variable ("tractive_force", "lateral_force", "aligning_moment"): rms of fit less solve over the load, of moments
    over load times radius. undecided: coefficients that the curves do not decide, with the values at which they are
    fixed. at_bounds: coefficients that ended at a bound of the fit. friction: of the solves, in words.
    """

    title: ClassVar[str] = "Magic Formula of a solved tire"

    formula: MagicFormula
    curves: tuple[SlipCurve, ...]
    residuals: Mapping[str, Mapping[str, float]]
    undecided: Mapping[str, float]
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
        ends = [f"{', '.join(self.at_bounds)} ended at a bound of the fit"] if self.at_bounds else []
        return (*poor, *ends, *self.solve_warnings)

    def rows(self) -> tuple[Row, ...]:
        """Slopes and friction of the formula, and the residual of each curve."""
        rows = [line for line in self.formula.rows() if line.key != "nominal_pressure"]
        fixed = ", ".join(f"{name} = {value:g}" for name, value in self.undecided.items())
        rows.append(row("undecided", fixed, label="fixed, as the curves leave it open"))
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
    reach: float = 1.0,
    spacing: float | None = None,
    progress: Progress | None = None,
) -> FittedFormula:
    """Coefficients of the Magic Formula 6.1 of a tire, fitted to its solved curves over slip.

    rolling: friction and speed; its load, forces and creepages are not read. loads: of the wheel, N, three or more,
    distinct; the middle one is the nominal load. Curves along travel (κ to ±0.3) and across (to 14°) at each load,
    combined slip (κ to ±0.25 at 2° and 5°) at the smallest, the middle and the largest. reach: factor of these slips
    and angles, 0.3 to 3. spacing, progress: as in `solve_contact`.
    Raises InputError for fewer loads, a tire without a radius, that leans or that pulls to a side, curves that never
    slide, and as `solve_contact`.
    Source: Pacejka (2012), Tire and Vehicle Dynamics, section 4.3; bounded least squares.
    """
    forces = listed_loads(loads)
    if len(forces) < _FEWEST:
        raise InputError(
            f"a fit needs {_FEWEST} loads or more, got {len(forces)}: its coefficients are quadratic in the load; "
            'give such as [20e3, 27.5e3, 35e3] N ("20 kN; 27.5 kN; 35 kN")'
        )
    within("reach", reach, *REACH, "", "1 solves slips of up to 0.3")
    radius = tire.outer_radius
    if radius is None:
        raise InputError("this tire has no outer radius, to which moments refer; give a profile or a scan")
    if tire.camber:
        raise InputError(
            f"the tire leans by {math.degrees(tire.camber):.3g}°, and curves of an upright tire are fitted; stand it "
            "upright, with camber = 0"
        )
    solver = SlipSolver(tire, road, rolling, reach, spacing, progress)
    free = [solver.free(load) for load in forces]
    creepages = {load: float(contact.dataset["creepage_x"]) for load, contact in zip(forces, free, strict=True)}
    curves = [curve for load in forces for curve in solver.pure(load, creepages[load])]
    curves += [curve for load in combined_loads(forces) for curve in solver.combined(load, creepages[load])]
    if progress is not None:
        progress("fitting")
    approaches = [float(contact.dataset["approach"]) for contact in free]
    deflection = np.array([[0.0, *approaches], [0.0, *forces]])
    draft = _Draft(tire, radius, forces[len(forces) // 2], deflection, rolling.speed or _SPEED)
    for bounds, kind, variables in (
        (_ALONG, "along", ("tractive_force",)),
        (_ACROSS, "across", ("lateral_force",)),
        (_MOMENT, "across", ("aligning_moment",)),
        (_COMBINED, "combined", ("tractive_force", "lateral_force")),
    ):
        draft.fit(bounds, [curve for curve in curves if curve.kind == kind], variables)
    formula = draft.formula()
    residuals = {
        curve.name: MappingProxyType(
            {name: float(np.sqrt(np.mean(_off(formula, curve, name) ** 2))) for name in _READ[curve.kind]}
        )
        for curve in curves
    }
    return FittedFormula(
        formula,
        tuple(curves),
        MappingProxyType(residuals),
        MappingProxyType(dict(_UNDECIDED)),
        tuple(draft.at_bounds),
        str(rolling.law),
        tuple(dict.fromkeys(text for contact in free for text in contact.warnings)),
    )


class _Draft:
    """Coefficients as fitted so far."""

    def __init__(self, tire: Tire, radius: float, nominal_load: float, deflection: Array, speed: float) -> None:
        self._tire, self._radius, self._load, self._deflection = tire, radius, nominal_load, deflection
        self._speed = speed
        starts = {name: start for part in (_ALONG, _ACROSS, _MOMENT, _COMBINED) for name, (start, *_) in part.items()}
        self._values: dict[str, float] = starts | _UNDECIDED
        self.at_bounds: list[str] = []

    def fit(self, bounds: Bounds, curves: Sequence[SlipCurve], variables: Sequence[str]) -> None:
        """Fit coefficients within bounds to variables of curves, each over its load."""
        from scipy.optimize import least_squares

        names = list(bounds)
        start, low, high = np.array([bounds[name] for name in names]).T

        def off(values: Array) -> Array:
            self._values.update(zip(names, values.tolist(), strict=True))
            formula = self.formula()
            return np.concatenate([_off(formula, curve, name) for curve in curves for name in variables])

        # x_scale "jac": coefficients differ by four orders of magnitude.
        best = least_squares(off, start, bounds=(low, high), x_scale="jac", max_nfev=400)
        off(best.x)
        near = np.minimum(best.x - low, high - best.x) < _AT_BOUND * (high - low)
        self.at_bounds += [name for name, is_near in zip(names, near, strict=True) if is_near]

    def formula(self) -> MagicFormula:
        """The formula of the present coefficients."""

        def part(names: Sequence[str]) -> Mapping[str, float]:
            return MappingProxyType({name: float(self._values.get(name, 0.0)) for name in names})

        pressure = self._tire.inflation_pressure
        loads = self._deflection[1]
        sections: dict[str, Mapping[str, float]] = {
            "MODEL": {"LONGVL": self._speed},
            "DIMENSION": {"UNLOADED_RADIUS": self._radius},
            "OPERATING_CONDITIONS": {"NOMPRES": pressure, "INFLPRES": pressure} if pressure else {},
            "VERTICAL": {"FNOMIN": self._load, "VERTICAL_STIFFNESS": self._stiffness()},
            "VERTICAL_FORCE_RANGE": {"FZMIN": float(loads[1]), "FZMAX": float(loads[-1])},
            "SCALING_COEFFICIENTS": dict.fromkeys(SCALES, 1.0),
            "LONGITUDINAL_COEFFICIENTS": part(LONGITUDINAL),
            "LATERAL_COEFFICIENTS": part(LATERAL),
            "ALIGNING_COEFFICIENTS": part(ALIGNING),
        }
        kept = MappingProxyType({name: MappingProxyType(dict(values)) for name, values in sections.items()})
        return MagicFormula("6.1", "ISO", kept, "", self._tire.name, self._deflection, _NOTES)

    def _stiffness(self) -> float:
        """Slope of the load over the deflection at the nominal load, N/m: of a parabola through zero."""
        depth, loads = self._deflection[:, 1:]
        first, second = np.linalg.lstsq(np.column_stack([depth, depth**2]), loads, rcond=None)[0]
        return float(first + 2 * second * np.interp(self._load, loads, depth))


def _off(formula: MagicFormula, curve: SlipCurve, variable: str) -> Array:
    """Fit less solve over the load; of moments over load times radius. (n,)."""
    out = formula.forces(curve.normal_load, slip=curve.slip, slip_angle=curve.slip_angle)
    scale = curve.normal_load * (formula.unloaded_radius if variable == "aligning_moment" else 1.0)
    off: Array = (getattr(out, variable) - getattr(curve, variable)) / scale
    return off
