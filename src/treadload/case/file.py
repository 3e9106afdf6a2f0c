"""A question as a file: TOML text, nested tables, and errors that name the key."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Any, Self

import tomli_w
from pydantic import Field, ValidationError

from treadload.case.fields import Part
from treadload.case.words import in_words
from treadload.errors import InputError


class FilePart(Part):
    """What every kind of case has: a title, and the folder that paths in it start from."""

    title: str = ""
    folder: Path = Field(default=Path("."), exclude=True, repr=False)

    @classmethod
    def from_dict(cls, table: dict[str, Any], *, folder: Path | str = ".", name: str = "case") -> Self:
        """Case from nested tables as a TOML file holds them. Raises InputError that names the key."""
        try:
            return cls.model_validate({**table, "folder": Path(folder)})
        except ValidationError as error:
            raise InputError(f"{name}: {in_words(error, cls)}") from error

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """Case from a TOML file; paths in it start from its folder. Raises InputError."""
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except OSError as error:
            raise InputError(f"cannot read the case {path}: {error.strerror or error}") from error
        except UnicodeDecodeError as error:
            raise InputError(f"{path} is not a text file in UTF-8, so it is no case; give a TOML file") from error
        return cls.from_text(text, folder=path.parent, name=str(path))

    @classmethod
    def from_text(cls, text: str, *, folder: Path | str = ".", name: str = "case") -> Self:
        """Case from TOML text. Raises InputError."""
        try:
            table = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise InputError(f"{name} is not valid TOML: {error}") from error
        return cls.from_dict(table, folder=folder, name=name)

    def to_toml(self) -> str:
        """The case as TOML text in SI units; what was left out stays out."""
        return tomli_w.dumps(self.model_dump(mode="json", exclude_unset=True, exclude_none=True))
