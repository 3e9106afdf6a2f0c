"""From a traffic and a climate to a service life, what it depends on, and the thickness that a life asks for."""

from treadload.life.delamination import BondComparison, compare_bonds, solve_interfaces
from treadload.life.design import Design
from treadload.life.equivalents import Equivalents, life_equivalents
from treadload.life.field import (
    FieldBench,
    FieldLook,
    FieldYears,
    Predictions,
    Priors,
    SectionTable,
    field_bench,
    field_look,
    field_tables,
    field_years,
    predict_sections,
    read_field_table,
    read_predictions,
    write_predictions,
)
from treadload.life.growth import grow_cracks
from treadload.life.passages import Passages, solve_passages
from treadload.life.reliability import MonteCarlo, Reliability, life_reliability
from treadload.life.remedy import Remedies, RemedySteps, remedies
from treadload.life.sensitivity import Sensitivity, life_sensitivity
from treadload.life.shakedown import shakedown_map
from treadload.life.solve import solve_life
from treadload.life.thickness import ThicknessDesign, design_thickness

__all__ = [
    "BondComparison",
    "Design",
    "Equivalents",
    "FieldBench",
    "FieldLook",
    "FieldYears",
    "MonteCarlo",
    "Passages",
    "Predictions",
    "Priors",
    "Reliability",
    "Remedies",
    "RemedySteps",
    "SectionTable",
    "Sensitivity",
    "ThicknessDesign",
    "compare_bonds",
    "design_thickness",
    "field_bench",
    "field_look",
    "field_tables",
    "field_years",
    "grow_cracks",
    "life_equivalents",
    "life_reliability",
    "life_sensitivity",
    "predict_sections",
    "read_field_table",
    "read_predictions",
    "remedies",
    "shakedown_map",
    "solve_interfaces",
    "solve_life",
    "solve_passages",
    "write_predictions",
]
