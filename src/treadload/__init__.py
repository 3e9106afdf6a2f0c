"""treadload: what a tire does to a road.

Public names are loaded when first used, so that importing the package stays quick.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from treadload._version import __version__

if TYPE_CHECKING:
    from treadload.case import Case
    from treadload.contact import (
        Contact,
        CreepCurve,
        Rolling,
        RollingResistance,
        TransientResult,
        TurnResult,
        creep_curve,
        rolling_resistance,
        solve_contact,
        solve_transient,
        turn_on_the_spot,
    )
    from treadload.damage import (
        AsphaltInstitute,
        AsphaltInstituteSubgrade,
        FatigueLine,
        FrenchBituminous,
        FrenchHydraulic,
        FrenchSubgrade,
        MepdgBottomUp,
        MepdgTopDown,
        ShellFatigue,
        Verdict,
        assess,
        crack_rose,
        envelope,
        equivalent_axles,
    )
    from treadload.errors import ConvergenceError, GeometryError, InputError, TreadloadError
    from treadload.grid import Grid
    from treadload.materials import Elastic, HuetSayegh, Model2S2P1D, PowerLawCreep, Prony, as_prony
    from treadload.pavement import BONDED, FRICTIONLESS, HALF_BONDED, Bond, Layer, Pavement, TemperatureProfile
    from treadload.reporting import report
    from treadload.response import Response, UniformDisc, UniformRectangle, solve_response
    from treadload.results import load, save, to_tree
    from treadload.study import Result, run_case
    from treadload.tire import Groove, LateralGrooves, Tire, TreadProfile, example_mesh, modulus_from_inflation

_HOME = {
    "AsphaltInstitute": "damage",
    "AsphaltInstituteSubgrade": "damage",
    "BONDED": "pavement",
    "Bond": "pavement",
    "Case": "case",
    "Contact": "contact",
    "ConvergenceError": "errors",
    "CreepCurve": "contact",
    "Elastic": "materials",
    "FRICTIONLESS": "pavement",
    "FatigueLine": "damage",
    "FrenchBituminous": "damage",
    "FrenchHydraulic": "damage",
    "FrenchSubgrade": "damage",
    "GeometryError": "errors",
    "Grid": "grid",
    "Groove": "tire",
    "HALF_BONDED": "pavement",
    "HuetSayegh": "materials",
    "InputError": "errors",
    "LateralGrooves": "tire",
    "Layer": "pavement",
    "MepdgBottomUp": "damage",
    "MepdgTopDown": "damage",
    "Model2S2P1D": "materials",
    "Pavement": "pavement",
    "PowerLawCreep": "materials",
    "Prony": "materials",
    "Response": "response",
    "Result": "study",
    "Rolling": "contact",
    "RollingResistance": "contact",
    "ShellFatigue": "damage",
    "TemperatureProfile": "pavement",
    "Tire": "tire",
    "TransientResult": "contact",
    "TreadProfile": "tire",
    "TreadloadError": "errors",
    "TurnResult": "contact",
    "UniformDisc": "response",
    "UniformRectangle": "response",
    "Verdict": "damage",
    "as_prony": "materials",
    "assess": "damage",
    "crack_rose": "damage",
    "creep_curve": "contact",
    "envelope": "damage",
    "equivalent_axles": "damage",
    "example_mesh": "tire",
    "load": "results",
    "modulus_from_inflation": "tire",
    "report": "reporting",
    "rolling_resistance": "contact",
    "run_case": "study",
    "save": "results",
    "solve_contact": "contact",
    "solve_response": "response",
    "solve_transient": "contact",
    "to_tree": "results",
    "turn_on_the_spot": "contact",
}

__all__ = [
    "BONDED",
    "FRICTIONLESS",
    "HALF_BONDED",
    "AsphaltInstitute",
    "AsphaltInstituteSubgrade",
    "Bond",
    "Case",
    "Contact",
    "ConvergenceError",
    "CreepCurve",
    "Elastic",
    "FatigueLine",
    "FrenchBituminous",
    "FrenchHydraulic",
    "FrenchSubgrade",
    "GeometryError",
    "Grid",
    "Groove",
    "HuetSayegh",
    "InputError",
    "LateralGrooves",
    "Layer",
    "MepdgBottomUp",
    "MepdgTopDown",
    "Model2S2P1D",
    "Pavement",
    "PowerLawCreep",
    "Prony",
    "Response",
    "Result",
    "Rolling",
    "RollingResistance",
    "ShellFatigue",
    "TemperatureProfile",
    "Tire",
    "TransientResult",
    "TreadProfile",
    "TreadloadError",
    "TurnResult",
    "UniformDisc",
    "UniformRectangle",
    "Verdict",
    "__version__",
    "as_prony",
    "assess",
    "crack_rose",
    "creep_curve",
    "envelope",
    "equivalent_axles",
    "example_mesh",
    "load",
    "modulus_from_inflation",
    "report",
    "rolling_resistance",
    "run_case",
    "save",
    "solve_contact",
    "solve_response",
    "solve_transient",
    "to_tree",
    "turn_on_the_spot",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'treadload' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"treadload.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOME])
