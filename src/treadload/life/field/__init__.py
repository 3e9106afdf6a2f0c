"""What roads show: tables of road sections, the ages of their first cracks, and what these say of the mechanics."""

from treadload.life.field.mechanics import SectionDamage, predict_damage, predict_sections
from treadload.life.field.prediction import Predictions
from treadload.life.field.priors import Priors, RoadSection
from treadload.life.field.table import EVENTS, Interval, SectionTable
from treadload.life.field.table_file import field_tables, read_field_table

__all__ = [
    "EVENTS",
    "Interval",
    "Predictions",
    "Priors",
    "RoadSection",
    "SectionDamage",
    "SectionTable",
    "field_tables",
    "predict_damage",
    "predict_sections",
    "read_field_table",
]
