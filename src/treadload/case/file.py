"""A question as a file: TOML text, nested tables, and errors that name the key."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Self

import tomli_w
from pydantic import Field, ValidationError

from treadload.case.changes import changed
from treadload.case.fitted import with_fitted_road
from treadload.errors import InputError
from treadload.files import parse_toml, text_of
from treadload.read import Table, in_words

A_CASE = "the TOML file of a case"
"""What a file should be that is read as a case, for the error."""


class FilePart(Table):
    """What a case is as a file: a title, nested tables, and the folder that paths in it start from."""

    title: str = ""
    folder: Path = Field(default=Path("."), exclude=True, repr=False)

    @classmethod
    def from_dict(cls, table: dict[str, object], *, folder: Path | str = ".", name: str = "case") -> Self:
        """Case from nested tables as a TOML file holds them. Raises InputError that names the key."""
        if not isinstance(table, Mapping):
            raise InputError(f"{name}: a case is a table of keys and values, got {table!r}")
        stray = next((key for key in table if not isinstance(key, str)), None)
        if stray is not None:
            raise InputError(f"{name}: keys must be text, got {stray!r}; write it in quotes")
        if "folder" in table:
            raise InputError(f"{name}: unknown key 'folder'; paths start from the folder of the file")
        try:
            tables = with_fitted_road(table, Path(folder))
        except InputError as error:
            raise InputError(f"{name}: {error}") from error
        try:
            # Of a class with an `__init__` of its own, `model_validate` checks everything twice.
            return cls(**{**tables, "folder": Path(folder)})
        except ValidationError as error:
            raise InputError(f"{name}: {in_words(error)}") from error

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

    def __reduce__(self) -> tuple[object, ...]:
        # Tables of kinds are made as they are read, and have no module to be found in.
        return type(self)._again, (self.as_tables(), self.folder)

    @classmethod
    def _again(cls, table: dict[str, object], folder: Path) -> Self:
        return cls.from_dict(table, folder=folder)

    def as_tables(self) -> dict[str, object]:
        """What was given, as nested tables in SI units."""
        return self.model_dump(mode="json", exclude_unset=True, exclude_none=True)

    def to_toml(self) -> str:
        """The case as TOML text in SI units; what was left out stays out."""
        return tomli_w.dumps(self.as_tables())
