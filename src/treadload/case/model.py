"""A case: one model that is a TOML file, a Python object and a form.

What a case describes (tire, road, wheel, traffic, climate) is stated here; what it asks for are tables of steps,
which register themselves (`treadload.steps`), ours and those of other packages.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, Self

from pydantic import model_validator
from pydantic.fields import FieldInfo

from treadload.case.description import Description
from treadload.case.step import Source, Step, at_key, source_of, step_classes, steps_of
from treadload.read.table import first_words


class Case(Description):
    """The checked input of a computation: tire, road and what else it describes, and the tables of its steps.

    >>> case = tl.Case.from_text('''
    ... tire = { profile = "315/80R22.5", inflation_pressure = "8.2 bar" }
    ... rolling = { normal_load = "32.5 kN", friction = 0.7 }
    ... pavement = { structure = "6 BBSG3 / 15 GB3 / PF3", temperature = "15 degC" }
    ... ''')
    >>> case.rolling.normal_load
    32500.0
    """

    def __init__(self, /, **tables: object) -> None:
        type(self).take_steps(tables)
        super().__init__(**tables)

    def __eq__(self, case: object) -> bool:
        # A case that was made before another step was known lacks that step's key, which it does not give either.
        if not isinstance(case, Case):
            return NotImplemented
        names = type(self).model_fields
        return all(getattr(self, name, None) == getattr(case, name, None) for name in names)

    __hash__ = Description.__hash__

    @classmethod
    def take_steps(cls, names: Iterable[str]) -> None:
        """Give the model the tables of all steps of this package, and of those of other packages that are named.

        Raises InputError for a step whose package cannot be loaded, and for two that have the same table.
        """
        fields = Case.model_fields
        tables = [kind for kind in step_classes(name for name in names if name not in fields) if kind.has_table]
        new = [kind for kind in tables if _table_of(fields.get(kind.name)) is not kind]
        for kind in new:
            first = kind.default()
            hint: Any = kind if first is not None else kind | None
            Case.__pydantic_fields__[kind.name] = FieldInfo.from_annotated_attribute(hint, first)
        if new:
            Case.model_rebuild(force=True)

    @classmethod
    def from_dict(cls, table: dict[str, object], *, folder: Path | str = ".", name: str = "case") -> Self:
        """Case from nested tables as a TOML file holds them. Raises InputError that names the key."""
        cls.take_steps(table if isinstance(table, Mapping) else ())
        return super().from_dict(table, folder=folder, name=name)

    @classmethod
    def known_keys(cls) -> tuple[str, ...]:
        """Keys that a case knows, with the tables of steps."""
        cls.take_steps(())
        return super().known_keys()

    @classmethod
    def about(cls) -> dict[str, str]:
        """What the keys are, in the words of the docstring; a table of a step in those of its class."""
        tables = {kind.name: first_words(kind) for kind in step_classes() if kind.has_table}
        return {**tables, **super().about()}

    @model_validator(mode="after")
    def _buildable(self) -> Case:
        smallest, usual, largest = self.source.tolerances
        if self.tolerance is not None and not smallest <= self.tolerance <= largest:
            text = f"tolerance must lie in [{smallest:g}, {largest:g}], got {self.tolerance:g}"
            raise at_key("tolerance", f"{text}; leave it out for the default, {usual:g}")
        for step in self.steps:
            step.check(self)
        return self

    @cached_property
    def steps(self) -> tuple[Step, ...]:
        """What the case asks for, in order of dependence, its source first."""
        return tuple(steps_of(self))

    @property
    def source(self) -> Source:
        """The step that the others follow: a contact, a footprint, an indentation, a drum, a life, a calibration."""
        return source_of(self)

    def cites(self) -> tuple[str, ...]:
        """Methods that its steps will use: keys of `treadload.citations.CITATIONS`, or whole references."""
        return tuple(dict.fromkeys(key for step in self.steps for key in step.cites(self)))

    @property
    def command(self) -> str:
        """The command that runs the case: "run", "life" or "calibrate"."""
        return self.source.command


def _table_of(field: FieldInfo | None) -> object:
    """The class of a step's table among the types of a field; None without one."""
    kinds = getattr(field.annotation, "__args__", (field.annotation,)) if field is not None else ()
    return next((kind for kind in kinds if kind is not type(None)), None)
