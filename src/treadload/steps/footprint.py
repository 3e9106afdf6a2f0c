"""A recorded footprint, in place of a tire and its rolling state."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from treadload.case.step import Source
from treadload.errors import InputError
from treadload.footprint import Footprint, is_pin_table, is_sensor_file, read_footprint
from treadload.read import As
from treadload.response import GridLoad
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.units import Force, Length, Pressure

# Keys that only a table or a matrix has, and those that only the file of a sensor has.
_OF_TEXT = ("missing", "decimal", "shear_on")
_OF_SENSORS = ("frame", "travel", "seen_from", "calibration", "load", "saturation", "dead")
# Those of a table of pins.
_OF_PINS = ("units", "decimal", "shear_on", "load")


class FootprintStep(Source, name="footprint"):
    """`[footprint]`, in place of [tire] and [rolling]: recorded contact stress.

    file: a CSV table or matrix, a table of pins that measure three components, NetCDF such as a result of this
    package (.nc), or an export of Tekscan. units: { pressure = "kPa" }, of columns and variables that name none.
    spacing: of the cells of a matrix. missing: "error" or "zero". noise: pressures this far around zero are none.
    decimal: "." or ",", where a CSV file can be read in two ways. shear_on: the body that the recorded shear acts on.
    interpolation: "constant" or "bilinear".
    Of a sensor's export: frame: "peak", "mean" or a number; travel: "right", "left", "up" or "down" on its page;
    seen_from: "above" or "below"; calibration: pressure of a raw count; load: known, that all is scaled to;
    saturation: what a sensel reads at most; dead: sensels, "leave" or "fill".

    >>> from pathlib import Path
    >>> _ = Path("print.csv").write_text("0;400000;0")
    >>> case = tl.Case.from_text('''
    ... footprint = { file = "print.csv", spacing = "30 mm", units = { pressure = "Pa" } }
    ... pavement = { layers = [{ material = { kind = "elastic", modulus = "5 GPa", poisson = 0.35 } }] }
    ... response = { depths = ["20 mm"] }
    ... ''')
    >>> case.steps[0].name
    'footprint'
    """

    makes: ClassVar = ("contact",)
    heading: ClassVar = "Recorded footprint"
    uses: ClassVar = ("title", "pavement", "tolerance")
    needs: ClassVar = ("pavement",)

    file: str
    units: dict[str, str] = Field(default_factory=dict)
    spacing: Annotated[Any, As(Length | tuple[Length, Length])] = None
    missing: Literal["error", "zero"] = "error"
    noise: Pressure = 0.0
    decimal: Literal[".", ","] | None = None
    shear_on: Literal["road", "tire"] = "road"
    interpolation: Literal["constant", "bilinear"] = "constant"
    frame: int | Literal["peak", "mean"] = "peak"
    travel: Literal["right", "left", "up", "down"] = "right"
    seen_from: Literal["above", "below"] = "above"
    calibration: Pressure | None = None
    load: Force | None = None
    saturation: Pressure | None = None
    dead: Literal["leave", "fill"] = "leave"

    @model_validator(mode="after")
    def _of_a_table(self) -> FootprintStep:
        stray = sorted(self.model_fields_set - {"file", "units", "interpolation"}) if self.is_result else []
        if stray:
            raise ValueError(f"{stray[0]} belongs to a CSV file; {self.file} is NetCDF and contains it")
        return self

    @classmethod
    def stray_text(cls, key: str) -> str:
        """Which keys belong to a tire."""
        return f"a footprint replaces a tire; leave out {key}"

    @property
    def is_quick(self) -> bool:
        """True: the page shows it as soon as it is solved."""
        return True

    def solve(self, scene: Scene) -> Footprint:
        """The footprint on the road of the case."""
        footprint = scene.loaded.footprint
        assert footprint is not None
        return replace(footprint, road=scene.loaded.road)

    def plan(self, outline: Outline) -> None:
        """The file and its load."""
        wheel = outline.wheel
        outline.add("footprint", f"{self.file}, {wheel.grid}, {wheel.normal_load / 1e3:.4g} kN")

    @property
    def is_result(self) -> bool:
        """True for a NetCDF file."""
        return self.file.endswith(".nc")

    def read(self, folder: Path) -> Footprint:
        """The footprint with what is doubtful about it; a relative path starts from the folder."""
        path = folder / self.file
        options: dict[str, Any]
        if self.is_result:
            return Footprint(GridLoad.from_file(path, units=self.units, interpolation=self.interpolation))
        if is_pin_table(path):
            stray = tuple(name for name in (*_OF_SENSORS, "missing", "spacing") if name not in _OF_PINS)
            self._check(stray, f"{self.file} is a table of pins")
            options = {name: getattr(self, name) for name in _OF_PINS}
            return read_footprint(path, threshold=self.noise or None, **options)
        if not is_sensor_file(path):
            options = {name: value for name, value in self if name not in ("file", *_OF_SENSORS)}
            self._check(_OF_SENSORS, f"{self.file} is a table or a matrix, and no export of a sensor")
            return Footprint(GridLoad.from_csv(path, **options))
        self._check(_OF_TEXT, f"{self.file} is an export of a sensor, and no table or matrix")
        details = {name: getattr(self, name) for name in ("units", "spacing", *_OF_SENSORS)}
        footprint = read_footprint(path, threshold=self.noise or None, **details)
        return replace(footprint, load=replace(footprint.load, interpolation=self.interpolation))

    def build(self, folder: Path) -> GridLoad:
        """The load; a relative path starts from the folder."""
        return self.read(folder).load

    def _check(self, keys: tuple[str, ...], what: str) -> None:
        stray = [key for key in keys if key in self.model_fields_set]
        if stray:
            raise InputError(f"footprint.{stray[0]} does not go with its file: {what}; leave it out")
