"""Cases spread over ranges of inputs: a Sobol sequence, a Latin hypercube, random points, or given points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from treadload.case import Case
from treadload.errors import InputError
from treadload.sweeps.columns import listed_values, objects
from treadload.sweeps.design import CASE, MOST_CASES, Design, checked_design, product

METHODS = ("sobol", "latin", "random")


def sampled(
    case: Case, ranges: Mapping[str, tuple[object, object]], count: int, *, method: str = "sobol", seed: int = 0
) -> Design:
    """Cases spread over ranges, over the dimension "case".

    ranges: key → (low, high), in SI units or with their units. count: of the cases. method: "sobol", a scrambled
    Sobol sequence, best at powers of two; "latin", a Latin hypercube; "random". seed: of the scrambling; the same
    gives the same cases. Raises InputError.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> design = tl.sweeps.sampled(case, {"normal_load": ("20 kN", "40 kN")}, 16)
    >>> f"{design.count} loads, {sum(load < 30e3 for load in design.inputs[0].values)} of them below 30 kN"
    '16 loads, 8 of them below 30 kN'
    """
    if method not in METHODS:
        raise InputError(f"a sample is one of {', '.join(METHODS)}, got {method!r}")
    if not 1 <= count <= MOST_CASES:
        raise InputError(f"a sample has 1 to {MOST_CASES} cases, got {count}")
    # Its import takes as long as that of all the rest.
    from scipy.stats import qmc

    bounds = bounds_of(case, ranges)
    unit = (
        np.random.default_rng(seed).random((count, len(bounds)))
        if method == "random"
        else (qmc.Sobol if method == "sobol" else qmc.LatinHypercube)(len(bounds), rng=seed).random(count)
    )
    low, high = (np.array(ends) for ends in zip(*bounds.values(), strict=True))
    return over_points(case, list(bounds), low + unit * (high - low))


def over_points(case: Case, names: Sequence[str], points: np.ndarray) -> Design:
    """Cases at points (n, len(names)) in SI units, over the dimension "case". Raises InputError.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> import numpy as np
    >>> design = tl.sweeps.over_points(case, ["normal_load", "friction"], np.array([[50.0, 0.5], [100.0, 0.7]]))
    >>> f"{design.count} cases", design.at(1)
    ('2 cases', {'rolling.normal_load': 100.0, 'rolling.friction': 0.7})
    """
    columns = {name: ((CASE,), objects(points[:, k].tolist())) for k, name in enumerate(names)}
    return checked_design(case, columns)


def bounds_of(case: Case, ranges: Mapping[str, tuple[object, object]]) -> dict[str, tuple[float, float]]:
    """Ranges in SI units: name → (low, high). Raises InputError for what is no range of numbers.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> tl.sweeps.bounds_of(case, {"normal_load": ("20 kN", "40 kN")})
    {'normal_load': (20000.0, 40000.0)}
    """
    if not ranges:
        raise InputError("nothing is varied; give keys and ranges, such as {'rolling.friction': (0.3, 0.9)}")
    bounds = {}
    for name, ends in ranges.items():
        low_high = listed_values(name, ends)
        if len(low_high) != 2:
            raise InputError(f"a sample of {name} needs its low and high end, got {len(low_high)} values")
        design = product(case, {name: low_high})
        if not design.inputs[0].is_number:
            raise InputError(f"a sample needs numbers, and {name} is {low_high[0]!r}; list its values instead")
        low, high = (float(value) for value in design.inputs[0].labels)
        bounds[name] = (min(low, high), max(low, high))
    return bounds
