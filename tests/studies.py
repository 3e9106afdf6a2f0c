"""Studies without a solver: a function stands in for it, so that what is made of their results can be tested."""

from pathlib import Path

import numpy as np

from cases import COARSE_CASE
from treadload.case import Case
from treadload.sweeps import Sweep, open_sweep
from treadload.sweeps.description import about
from treadload.sweeps.design import product
from treadload.sweeps.gathered import gathered, with_fields
from treadload.sweeps.record import Record
from treadload.sweeps.store import begun
from treadload.sweeps.work import Question

CASE = Case.from_text(COARSE_CASE)
FREE = Case.from_text(COARSE_CASE.replace('tractive_force = "10 kN"', ""))
X, Y = np.linspace(-0.1, 0.1, 9), np.linspace(-0.15, 0.15, 11)


def records_of(design, solve):
    """What the cases of a design gave. solve: inputs by the ends of their keys → numbers by name, or why it failed.

    Arrays of a number are over depth, of two dimensions a field over (y, x), of three over (depth, y, x).
    """
    dims = {0: (), 1: ("depth",), 2: ("y", "x"), 3: ("depth", "y", "x")}
    for number in range(design.count):
        found = solve(**{key.rpartition(".")[2]: value for key, value in design.at(number).items()})
        if isinstance(found, str):
            yield Record(number, 0.01, failure=found)
        elif found is not None:
            values = {name: (dims[np.ndim(value)], np.asarray(value)) for name, value in found.items()}
            numbers = {name: one for name, one in values.items() if len(one[0]) < 2}
            fields = {name: one for name, one in values.items() if len(one[0]) > 1}
            places = {"depth": np.array([0.0, 0.02]), "x": X, "y": Y}
            yield Record(number, 0.25, numbers, fields, places, ("mind the gap",) if number % 2 else ())


def study_of(design, solve, case=CASE):
    """A study in memory, see `records_of`."""
    records = list(records_of(design, solve))
    data = with_fields(gathered(design, records), design, records)
    return Sweep(data.assign_attrs(about(case, design, question(case))), case)


def stored(path, design, solve, case=CASE):
    """A study in a store, see `records_of`."""
    with begun(path, case, design, question(case)) as store:
        for record in records_of(design, solve):
            store.append(record)
    return open_sweep(path)


def question(case):
    return Question(case.as_tables(), Path("."), ())


def wheel(friction=0.7, normal_load=3e4, creepage_x=-0.01, **_):
    """Numbers that look like those of a wheel; it slides where friction is low and is not solved where it is high."""
    if friction < 0.25:
        return f"gross sliding: {friction:g} x {normal_load:g} N is too little"
    if friction > 0.85:
        return None
    strain = 1e-6 * (40 + 30 * friction) * (normal_load / 3e4)
    share = -np.tanh(60 * creepage_x / friction)
    bump = np.exp(-((X[None, :] / 0.06) ** 2) - (Y[:, None] / 0.08) ** 2)
    return {
        "worst_strain": strain, "worst_passes": 1e6 * (1e-4 / strain) ** 5, "friction": friction,
        "normal_load": normal_load, "tractive_force": share * friction * normal_load, "creepage_x": creepage_x,
        "largest_extension": np.array([1.4, 1.0]) * strain, "lateral_force": 1e-13 * friction,
        "pressure": 8e5 * bump, "principal_strain_1": np.stack([strain * bump, 0.5 * strain * bump]),
    }  # fmt: skip


FRICTIONS, LOADS = [0.2, 0.4, 0.6, 0.8], ["20 kN", "30 kN", "40 kN"]


def product_study(**vary):
    vary = vary or {"friction": FRICTIONS, "normal_load": LOADS}
    # A creepage takes the place of the force.
    case = FREE if "rolling.creepage_x" in vary else CASE
    return study_of(product(case, vary), wheel, case)
