"""Least squares on the real solver."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import TypedDict, Unpack

import numpy as np
import scipy

from treadload.calibration.evaluations import Evaluations, Progress
from treadload.calibration.problem import Problem
from treadload.calibration.solution import Calibration, Fit, solution
from treadload.contact.contact_grid import DEFAULT_SPACING
from treadload.errors import ConvergenceError, InputError, positive
from treadload.footprint.measured import FRICTION, READINGS, Measured, Unknown, unknowns
from treadload.kernels.arrays import Array
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.tire import Tire

# Flat track of a test rig.
STEEL = Elastic(210e9, 0.3)
# Coarser than a contact of its own: deflections, moments and extents below the size of a cell move by less than a
# percent from 6 mm to 3 mm. Ribs are whole cells wide: their shares of the load move by a point, and ask for 3 mm.
SPACING = 2 * DEFAULT_SPACING
_BY_RIBS = ("rib_shares", "footprint", "width", "pins")
# Steps of the derivatives, of a number's size. The readings of a standing tire are known to the tolerance, 1e-8: a
# step of 1e-3 changes a deflection by some 1e-4 of itself, ten thousand times that, and bends the slope by less than
# 1e-3 of it. Extents of the print and slopes of rolling are known to 1e-5 or so and take a step of 1e-2.
_STEP, _LONG_STEP = 1e-3, 1e-2
_SMOOTH = ("deflection", "spread_x", "spread_y", "rib_shares")
# The search ends where the sum of squares falls by less than this part of itself, so that numbers lie within a
# hundredth of their standard deviations, or where they change by less than this part.
_FTOL, _XTOL = 1e-5, 1e-6
# Size of a number that may be zero, as camber, rad, or an arm, m; what its unit's prefix would be.
_SIZES = {"camber": 0.02, "arm": 0.01, "shoulder_radius": 0.01, "edge_radius": 0.002, "sidewall_stiffness": 1e6,
          "bending_twist": 100.0}  # fmt: skip
# A number this close to its bound, of its size, lies there.
_AT_BOUND = 1e-4


class Setting(TypedDict, total=False):
    """On what, and how finely, a tire is solved as it was measured; each with the default of `pose`."""

    road: Pavement | None
    friction: float
    errors: Mapping[str, float | str] | None
    spacing: float | None
    tolerance: float


def calibrate(
    tire: Tire,
    sought: Iterable[str | Unknown],
    data: Iterable[Measured],
    *,
    most: int = 30,
    jobs: int = 1,
    state: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    **setting: Unpack[Setting],
) -> Calibration:
    """Numbers of a tire from what was measured of it: weighted least squares on the real solver.

    tire: from which the search starts; numbers that are not sought stay. sought: names of numbers
    (`treadload.tire.numbers.NUMBERS`: "foundation", "modulus", "crown_radius", …, or "friction"), or `Unknown` with
    start and bounds. data: rows at any loads and pressures, see `Measured`; no peaks, which depend on the cells.
    most: steps of the search. jobs: processes. state: file that keeps every point that was solved, so
    that a search goes on where it stopped. progress: called with (done, expected, what) after every contact.
    setting: road=, friction=, errors=, spacing= and tolerance=.
    road: that it was measured on; left out, a flat track of steel. friction: Coulomb's, of rolling readings, 0.7.
    errors: standard deviations of readings by name, for rows without their own, SI or texts, "0.3 mm", "2 %". Where
    none is given, a customary one weighs the reading, and the scatter of the data determines the size of all errors.
    spacing: cells of the contact, m; left out, 6 mm, and 3 mm where shares, maps or widths are fitted. tolerance: of
    normal contact, 1e-8.

    A standing tire is pressed on without friction; slip stiffnesses are those of `tire_card`. Under pins the tire
    rolls freely, and they lie where they read its pressure best. E scales out of the tables of ribs and
    friction does not enter them; where ν is sought, they are interpolated between three ν from its lower to its upper
    bound, each of which takes a second or so for each kind of rib, once.
    Returns the fitted tire, standard deviations, correlations, and in words what the data cannot determine.
    Raises InputError for fewer data than unknowns and what cannot be measured or sought; ConvergenceError of a
    contact, and of a search that did not end.
    Method: trust-region reflective least squares (Branch, Coleman & Li 1999); covariance from the Jacobian.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.5, 1.0, 0.25), inflation_pressure=8e5)
    >>> tl.calibrate(tire, ["foundation", "modulus"], [tl.footprint.Measured(load=30e3, deflection=0.03)])
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: 1 readings cannot determine 2 numbers (foundation, modulus); measure more, or
    seek at most 1
    """
    began = time.perf_counter()
    if isinstance(jobs, bool) or not isinstance(jobs, int) or jobs < 1:
        raise InputError(f"jobs must be a whole number of processes from 1, got {jobs!r}")
    if isinstance(most, bool) or not isinstance(most, int) or most < 1:
        raise InputError(f"most must be a whole number of steps from 1, got {most!r}")
    problem = pose(tire, sought, data, **setting)
    names = problem.sought
    start, low, high = np.array([unknown.on(tire, problem.friction) for unknown in names]).T
    size = np.array([_size(unknown, value) for unknown, value in zip(names, start, strict=True)])
    with Evaluations(problem, jobs=jobs, state=state, progress=progress).open() as solves:
        search = _Search(problem, solves, size, low, high)
        # The reflective method begins inside.
        inside = np.clip(start, low + 1e-6 * size, high - 1e-6 * size)
        solution_of = scipy.optimize.least_squares(
            search.residuals,
            inside / size,
            jac=search.jacobian,
            bounds=(low / size, high / size),
            ftol=_FTOL,
            xtol=_XTOL,
            gtol=1e-10,
            max_nfev=most,
        )
        if solution_of.status == 0:
            raise ConvergenceError(
                f"the search did not end in {most} steps; raise most, begin nearer (start of an unknown), or seek "
                "fewer numbers: " + ", ".join(unknown.name for unknown in names),
                float(solution_of.optimality),
            )
        values = solution_of.x * size
        at_bound = np.where(values - low < _AT_BOUND * size, -1, np.where(high - values < _AT_BOUND * size, 1, 0))
        fitted = Fit(
            start, values, low, high, size, at_bound,
            search.model(start), search.model(values), search.measured, search.errors, search.stated,
            search.slopes(values),
        )  # fmt: skip
    stats = {
        "evaluations": int(solution_of.nfev),
        "contacts": solves.solved,
        "contacts_from_state": solves.evaluated_before,
        "optimality": float(solution_of.optimality),
        "seconds": time.perf_counter() - began,
    }
    return solution(problem, fitted, stats)


def pose(
    tire: Tire,
    sought: Iterable[str | Unknown],
    data: Iterable[Measured],
    *,
    road: Pavement | None = None,
    friction: float = 0.7,
    errors: Mapping[str, float | str] | None = None,
    spacing: float | None = None,
    tolerance: float = 1e-8,
) -> Problem:
    """The question that `calibrate` answers, checked; its arguments are those. Raises InputError."""
    names = unknowns(sought)
    rows = tuple(measured.loaded() for measured in data)
    Measured.check_errors(errors or {})
    positive("friction", friction)
    if not 1e-12 <= tolerance <= 1e-4:
        raise InputError(f"tolerance must lie in [1e-12, 1e-4], got {tolerance:g}; slopes need 1e-8 or so")
    ribbed = any(name in measured.readings for measured in rows for name in _BY_RIBS)
    usual = DEFAULT_SPACING if ribbed else SPACING
    cells = None if tire.fixed_grid is not None else usual if spacing is None else spacing
    ground = Pavement.half_space(STEEL) if road is None else road
    problem = Problem(tire, ground, names, rows, friction, dict(errors or {}), cells, tolerance)
    _check(problem)
    problem.at([unknown.on(tire, friction)[0] for unknown in names])
    return problem


class _Search:
    """Residuals and their slopes, in numbers over their size."""

    def __init__(self, problem: Problem, solves: Evaluations, size: Array, low: Array, high: Array) -> None:
        self.problem, self._solves, self._size, self._low, self._high = problem, solves, size, low, high
        measured, errors, stated = [], [], []
        for row, name, number in problem.readings:
            value = float(problem.measured_of(row, name)[number])
            error, is_stated = problem.data[row].error(name, value, problem.errors)
            measured.append(value)
            errors.append(error)
            stated.append(is_stated)
        self.measured, self.errors, self.stated = np.array(measured), np.array(errors), np.array(stated)
        if not (self.errors > 0).all():
            row, name, _ = problem.readings[int(np.argmin(self.errors))]
            raise InputError(
                f"the reading {name} of row {row + 1} of the data is zero and its error a part of it; give an error "
                f"in {READINGS[name].unit or 'pure numbers'}"
            )
        kinds = {name for _, name, _ in problem.readings}
        self._step = _STEP if kinds <= set(_SMOOTH) else _LONG_STEP

    def residuals(self, scaled: Array) -> Array:
        """(model - measured) / error at numbers over their size."""
        return np.asarray((self.model(scaled * self._size) - self.measured) / self.errors)

    def model(self, values: Array) -> Array:
        """All readings at numbers, SI."""
        return self._solves.at([_point(values)])[0]

    def jacobian(self, scaled: Array) -> Array:
        """Slopes of the residuals."""
        return np.asarray(self.slopes(scaled * self._size) / self.errors[:, None])

    def slopes(self, values: Array) -> Array:
        """Change of the readings per size of a number: (readings, numbers), by steps away from the nearer bound."""
        steps = self._step * self._size
        steps = np.where(values + steps > self._high, -steps, steps)
        points = [_point(values), *(_point(values + steps * step) for step in np.eye(len(values)))]
        middle, *ends = self._solves.at(points)
        changes = np.stack([end - middle for end in ends], axis=1)
        return np.asarray(changes / (steps / self._size))


def _check(problem: Problem) -> None:
    """Refuse a question that has no answer."""
    count, sought = len(problem.readings), len(problem.sought)
    if not problem.data:
        raise InputError(
            "a calibration needs data: rows of what was measured, such as Measured(load=…, deflection=…)"
        )
    if count < sought:
        names = ", ".join(unknown.name for unknown in problem.sought)
        raise InputError(
            f"{count} readings cannot determine {sought} numbers ({names}); measure more, or seek at most {count}"
        )
    rolled = any(READINGS[name].how in ("rolling", "pins") for row in problem.data for name in row.readings)
    if any(unknown.name == FRICTION for unknown in problem.sought) and not rolled:
        raise InputError(
            "friction is sought, and no reading knows of it: give pins, or tractive_force or lateral_force at a "
            "creepage"
        )
    if problem.tire.fixed_grid is None and problem.spacing is not None:
        positive("spacing", problem.spacing, "metres", "6 mm is 0.006")


def _size(unknown: Unknown, start: float) -> float:
    """What a step of a number is a part of."""
    return max(abs(start), _SIZES.get(unknown.name, 0.0))


def _point(values: Sequence[float] | Array) -> tuple[float, ...]:
    # Points that differ by round-off alone are one.
    return tuple(float(f"{value:.12g}") for value in values if math.isfinite(value))
