"""What loads the road in a case: a rolling state, or a recorded footprint in its place."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from treadload.read import As, Table
from treadload.response import GridLoad
from treadload.units import Length, Pressure


class FootprintPart(Table):
    """`[footprint]`, in place of [tire] and [rolling]: recorded contact stress.

    file: a CSV table or matrix, or NetCDF such as a result of this package (.nc). units: { pressure = "kPa" }, of
    columns and variables that name no unit. spacing: of the cells of a matrix. missing: "error" or "zero". noise:
    pressures this far below zero count as zero. decimal: "." or ",", where a CSV file can be read in two ways.
    shear_on: the body that the recorded shear acts on. interpolation: "constant" or "bilinear".
    """

    file: str
    units: dict[str, str] = Field(default_factory=dict)
    spacing: Annotated[Any, As(Length | tuple[Length, Length])] = None
    missing: Literal["error", "zero"] = "error"
    noise: Pressure = 0.0
    decimal: Literal[".", ","] | None = None
    shear_on: Literal["road", "tire"] = "road"
    interpolation: Literal["constant", "bilinear"] = "constant"

    @model_validator(mode="after")
    def _of_a_table(self) -> FootprintPart:
        stray = sorted(self.model_fields_set - {"file", "units", "interpolation"}) if self.is_result else []
        if stray:
            raise ValueError(f"{stray[0]} belongs to a CSV file; {self.file} is NetCDF, which holds it")
        return self

    @property
    def is_result(self) -> bool:
        """True for a NetCDF file."""
        return self.file.endswith(".nc")

    def build(self, folder: Path) -> GridLoad:
        """The load; a relative path starts from the folder."""
        if self.is_result:
            return GridLoad.from_file(folder / self.file, units=self.units, interpolation=self.interpolation)
        told: dict[str, Any] = {name: value for name, value in self if name != "file"}
        return GridLoad.from_csv(folder / self.file, **told)
