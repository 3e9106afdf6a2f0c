"""Observed roads: tables of road sections, the ages of their first cracks, what these show about the mechanics."""

from treadload.life.field.bench import field_bench, field_look
from treadload.life.field.mechanics import SectionDamage, predict_damage, predict_sections
from treadload.life.field.prediction import Predictions
from treadload.life.field.prediction_file import read_predictions, write_predictions
from treadload.life.field.priors import Priors, RoadSection
from treadload.life.field.solution import FieldBench, FieldLook
from treadload.life.field.table import EVENTS, Interval, SectionTable
from treadload.life.field.table_file import field_tables, read_field_table
from treadload.life.field.years import FieldYears, field_years

__all__ = [
    "EVENTS",
    "FieldBench",
    "FieldLook",
    "FieldYears",
    "Interval",
    "Predictions",
    "Priors",
    "RoadSection",
    "SectionDamage",
    "SectionTable",
    "field_bench",
    "field_look",
    "field_tables",
    "field_years",
    "predict_damage",
    "predict_sections",
    "read_field_table",
    "read_predictions",
    "write_predictions",
]
