"""A table of a case becomes an object by the annotations of what makes it.

The annotations of a frozen dataclass or a function describe what a table of TOML holds:

    @FRICTION.register("stribeck")
    @dataclass(frozen=True)
    class Stribeck(FrictionLaw):
        static: Number
        reference_speed: SlidingSpeed
        base: FrictionLaw | None = None

A number carries a unit (`treadload.units`: Length, Modulus, ...; a bare float is a pure number), words are Literal or
Enum, a Path starts from the folder of the case, tuple[X, ...] is a list, a dataclass a table within, and a type that
a registry makes (`treadload.registry`) a table distinguished by its kind. pydantic reads; the objects do not know it.
"""

from treadload.read.choice import REFERENCE, As, Choice, choice_named, read, readable, reader, table_of
from treadload.read.signature import made_by, parameters
from treadload.read.table import Table, TargetTable, arms, by_key, guarded, in_words, sentences

__all__ = [
    "REFERENCE",
    "As",
    "Choice",
    "Table",
    "TargetTable",
    "arms",
    "by_key",
    "choice_named",
    "guarded",
    "in_words",
    "made_by",
    "parameters",
    "read",
    "readable",
    "reader",
    "sentences",
    "table_of",
]
