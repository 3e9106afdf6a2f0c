"""A question as a file: TOML text, nested tables, and errors that name the key."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Self

import tomli_w
from pydantic import Field, ValidationError

from treadload.case.changes import changed
from treadload.errors import InputError
from treadload.files import parse_toml, text_of
from treadload.pavement import Pavement
from treadload.read import Table, in_words

A_CASE = "the TOML file of a case"
"""What a file should be that is read as a case, for the error."""


class FilePart(Table):
    """What every kind of case has: a title, and the folder that paths in it start from."""

    title: str = ""
    folder: Path = Field(default=Path("."), exclude=True, repr=False)
    # Tables that only this kind of case has, and what runs it.
    own_tables: ClassVar[tuple[str, ...]] = ()
    how_to_run: ClassVar[str] = ""

    @classmethod
    def from_dict(cls, table: dict[str, Any], *, folder: Path | str = ".", name: str = "case") -> Self:
        """Case from nested tables as a TOML file holds them. Raises InputError that names the key."""
        if not isinstance(table, Mapping):
            raise InputError(f"{name}: a case is a table of keys and values, got {table!r}")
        if "folder" in table:
            raise InputError(f"{name}: unknown key 'folder'; paths start from the folder of the file")
        cls._check_kind(table, name)
        try:
            return cls.model_validate({**table, "folder": Path(folder)})
        except ValidationError as error:
            raise InputError(f"{name}: {in_words(error)}") from error

    @classmethod
    def _check_kind(cls, table: dict[str, Any], name: str) -> None:
        """Refuse a case of another kind, and say what runs it."""
        for other in FilePart.__subclasses__():
            theirs = [key for key in other.own_tables if key in table]
            if other is not cls and theirs and not any(key in table for key in cls.own_tables):
                raise InputError(f"{name} has [{theirs[0]}], so it is {other.how_to_run.format(name=name)}")

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str], *, changes: Sequence[str] = ()) -> Self:
        """Case from a TOML file; paths in it start from its folder. Raises InputError.

        changes: keys to set, "rolling.friction=0.6" or "pavement.layers.0.thickness=8 cm", see `case.changes`.
        """
        return cls.from_text(text_of(path, A_CASE), folder=Path(path).parent, name=str(path), changes=changes)

    @classmethod
    def from_text(
        cls, text: str, *, folder: Path | str = ".", name: str = "case", changes: Sequence[str] = ()
    ) -> Self:
        """Case from TOML text. changes: as for `from_toml`. Raises InputError."""
        return cls.from_dict(changed(parse_toml(text, name), changes), folder=folder, name=name)

    def __reduce__(self) -> tuple[Any, ...]:
        # Tables of kinds are made as they are read, and have no module to be found in.
        return type(self)._again, (self.given(), self.folder)

    @classmethod
    def _again(cls, table: dict[str, Any], folder: Path) -> Self:
        return cls.from_dict(table, folder=folder)

    def given(self) -> dict[str, Any]:
        """What was given, as nested tables in SI units."""
        return self.model_dump(mode="json", exclude_unset=True, exclude_none=True)

    def build_road(self) -> Pavement | None:
        """The road, before any temperature where its materials wait for one; None where the case gives none."""
        return None

    def to_toml(self) -> str:
        """The case as TOML text in SI units; what was left out stays out."""
        return tomli_w.dumps(self.given())
