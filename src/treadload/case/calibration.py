"""A calibration case: a tire, what was measured of it, and which of its numbers are sought."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field, model_validator

from treadload.case.choices import TIRE_MATERIAL
from treadload.case.file import FilePart
from treadload.case.road import PavementPart
from treadload.case.tire import TirePart
from treadload.footprint.measured import Measured, Unknown, unknowns
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.read import As, Table
from treadload.tire import Tire
from treadload.units import Length, Number

# A name, or a table.
SOUGHT = As(tuple[str | Unknown, ...])
MEASURED = As(tuple[Measured, ...])
ROWS = As(tuple[tuple[float | str, ...], ...])
ERRORS = As(dict[str, float | str])


class CalibrationPart(Table):
    """`[calibration]`: which numbers of the tire are sought, and what was measured.

    parameters: names, "foundation" or "modulus", or tables { name, start, low, high }. load_deflection: rows of load
    and deflection, perhaps with the inflation pressure: [["10 kN", "14.1 mm", "8 bar"]]. data: rows of other readings
    under a load and a pressure: areas, length, width, rib_shares with ribs, a footprint, stiffnesses, forces at a
    creepage. errors: standard deviations by reading, { deflection = "0.3 mm", net_area = "2 %" }, for rows without
    their own. friction: of rolling readings.
    """

    parameters: Annotated[Any, SOUGHT]
    load_deflection: Annotated[Any, ROWS] = ()
    data: Annotated[Any, MEASURED] = ()
    errors: Annotated[Any, ERRORS] = Field(default_factory=dict)
    friction: Number = 0.7

    @model_validator(mode="after")
    def _buildable(self) -> CalibrationPart:
        self.build_sought()
        self.build_data()
        Measured.check_errors(self.errors)
        if not self.friction > 0:
            raise ValueError(f"friction must be above 0, got {self.friction:g}")
        return self

    def build_sought(self) -> tuple[Unknown, ...]:
        """What is sought."""
        return unknowns(SOUGHT.build(self.parameters))

    def build_data(self) -> tuple[Measured, ...]:
        """What was measured, footprints not yet read."""
        rows = (*Measured.load_deflection(self.load_deflection), *MEASURED.build(self.data))
        if not rows:
            raise ValueError("give load_deflection, or rows of [[calibration.data]]")
        return rows


class CalibrationCase(FilePart):
    """Everything that a calibration needs, checked.

    Numbers are SI; in a TOML file a quoted number carries its unit. title: of summaries and reports. spacing: of the
    contact's cells; left out, 6 mm, with shares and maps 3 mm, or the cells of a height map. tolerance: of normal
    contact, relative; slopes are differences and need it small. tire: from which the search begins. pavement: that it
    was measured on; left out, a flat track of steel. calibration: what is sought, and what was measured.
    """

    own_tables: ClassVar = ("calibration",)
    how_to_run: ClassVar = "a calibration: use `treadload calibrate {name}`, in Python CalibrationCase"

    spacing: Length | None = None
    tolerance: Number = 1e-8
    tire: TirePart
    pavement: PavementPart | None = None
    calibration: CalibrationPart

    @model_validator(mode="after")
    def _checked(self) -> CalibrationCase:
        if self.tire.material is not None and not isinstance(TIRE_MATERIAL.build(self.tire.material), Elastic):
            raise ValueError("a calibration seeks numbers of an elastic tire; give an elastic material, or a belt")
        self.build_road()
        return self

    def build_tire(self) -> Tire:
        """The tire, read from its file if it has one."""
        return self.tire.build(self.folder)

    def build_road(self) -> Pavement | None:
        """The road; None for the track of a test rig."""
        return None if self.pavement is None else self.pavement.build()

    def build_data(self) -> tuple[Measured, ...]:
        """What was measured; footprints are read from the folder."""
        return tuple(one.loaded(self.folder) for one in self.calibration.build_data())
