"""The structure file of `treadload backcalculate`: a road, what is sought of it, and which column holds what."""

from __future__ import annotations

from typing import Annotated, Any, TypedDict

from pydantic import Field, model_validator

from treadload.case.file import FilePart
from treadload.case.road import RoadPart
from treadload.pavement import Pavement
from treadload.read import As, Table
from treadload.roads import BasinLayout, MovingLayout
from treadload.roads.unknowns import STIFF_LAYER
from treadload.units import Celsius, Number

# Numbers in SI of whatever kind their key asks for, or texts with units, which the verb reads.
_Number = Number | str
LAYOUT = As(BasinLayout)
MOVING_LAYOUT = As(MovingLayout)
HALF_SPACE = "none"
"""The value of `stiff_layer` for a structure that ends in a half-space: TOML has no None."""


class Setting(TypedDict):
    """What of `backcalculate` a file can set."""

    fixed: tuple[str, ...]
    bounds: dict[str, tuple[float | str, float | str]]
    priors: dict[str, float | str | tuple[float | str, float | str]]
    stiff_layer: float | str | tuple[float | str, float | str] | None
    error: float | str | tuple[float | str, ...] | None
    reference_temperature: float


class SoughtPart(Table):
    """`[backcalculation]`: what is sought, see `treadload.backcalculate`.

    fixed: names of layers with a known modulus. bounds: by layer, { base = ["50 MPa", "2000 MPa"] }. priors: by
    layer, a coefficient of variation about the layer's modulus, { base = 0.3 }, or with another modulus,
    { base = ["300 MPa", 0.3] }.
    stiff_layer: depth of a rigid layer below the surface, "10 m" if left out; two depths to seek it between them;
    "none" for a half-space. error: of the sensors, "2 %", "2 µm", or both. reference_temperature: of mixes, °C.
    """

    fixed: tuple[str, ...] = ()
    bounds: dict[str, tuple[_Number, _Number]] = Field(default_factory=dict)
    priors: dict[str, _Number | tuple[_Number, _Number]] = Field(default_factory=dict)
    stiff_layer: _Number | tuple[_Number, _Number] = STIFF_LAYER
    error: _Number | tuple[_Number, ...] | None = None
    reference_temperature: Celsius = 15.0

    def options(self) -> Setting:
        """The arguments of `backcalculate`."""
        return {
            "fixed": self.fixed,
            "bounds": self.bounds,
            "priors": self.priors,
            "stiff_layer": None if self.stiff_layer == HALF_SPACE else self.stiff_layer,
            "error": self.error,
            "reference_temperature": self.reference_temperature,
        }


class StructureFile(FilePart):
    """A structure file: [pavement], [backcalculation], and the layout of a table.

    basins: of falling weights. moving_basins: of slopes ahead of rolling wheels, which it states; the one or the
    other.

    >>> file = tl.steps.StructureFile.from_text('''
    ... pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
    ... basins = { plate_radius = "150 mm" }
    ... ''')
    >>> [layer.name for layer in file.structure.layers]
    ['EB-BBSG3', 'EB-GB3', 'PF3']
    """

    pavement: RoadPart
    backcalculation: SoughtPart = Field(default_factory=SoughtPart)
    basins: Annotated[Any, LAYOUT] = None
    moving_basins: Annotated[Any, MOVING_LAYOUT] = None

    @model_validator(mode="after")
    def _single_layout(self) -> StructureFile:
        if self.basins is not None and self.moving_basins is not None:
            raise ValueError(
                "[basins] is of falling weights, [moving_basins] of rolling wheels; leave one of them out"
            )
        return self

    @property
    def structure(self) -> Pavement:
        """The road; mixes wait for the temperatures of the basins."""
        return self.pavement.untempered()

    @property
    def layout(self) -> BasinLayout | MovingLayout | None:
        """Of the table of basins; None where none is given."""
        if self.moving_basins is not None:
            moving: MovingLayout = MOVING_LAYOUT.build(self.moving_basins)
            return moving
        return None if self.basins is None else LAYOUT.build(self.basins)
