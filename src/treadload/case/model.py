"""A case: one model that is a TOML file, a Python object and a form."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import model_validator

from treadload.case.aggregates import AggregatesPart
from treadload.case.choices import TIRE_MATERIAL
from treadload.case.crossing import CrossingPart
from treadload.case.file import FilePart
from treadload.case.loading import FootprintPart
from treadload.case.passes import PassesPart
from treadload.case.pressing import DrumPart, IndentationPart
from treadload.case.response import ResponsePart
from treadload.case.road import PavementPart
from treadload.case.texture import TexturePart
from treadload.case.tire import TirePart
from treadload.contact import Rolling
from treadload.contact.bodies.choose import RoadCompliance, surface_of
from treadload.contact.indentation import check_indented
from treadload.damage import FatigueLine
from treadload.errors import InputError
from treadload.kernels.layers.depths import same_depth
from treadload.materials import ElastoPlastic, Prony
from treadload.pavement import Pavement, Relief
from treadload.read import As, Made, Table
from treadload.response import MATERIAL_LENGTH
from treadload.response.material import check_length
from treadload.tire import Tire
from treadload.units import Length, Number


class DamagePart(Table):
    """`[damage]`: the fatigue line, and which strain it reads, where, over how much road.

    fatigue: the line, with epsilon_6 and slope. strain: "in-plane", of the horizontal plane, or "principal", in
    space. mean_over: side of the cube of road whose mean strain is read; 10 mm if left out. depth: one of the
    response's depths, whose points are read instead; left out, the means of all that lie in the top layer.
    lattices: 2 reads the mean of two contacts whose cells lie half a cell apart, so that the reading does not depend
    on where cells lie, 1 that of one; left out, 2 where the tire is known between its cells and no depth is given.
    error_estimate: also solve the case on cells twice as large, and report how much the reading changes. See
    `treadload.assess`.
    """

    fatigue: Annotated[Made, As(FatigueLine)]
    strain: Literal["principal", "in-plane"] = "in-plane"
    mean_over: Length = MATERIAL_LENGTH
    depth: Length | None = None
    lattices: Literal[1, 2] | None = None
    error_estimate: bool = False

    @model_validator(mode="after")
    def _one_reading(self) -> DamagePart:
        check_length(self.mean_over)
        if self.depth is not None and "mean_over" in self.model_fields_set:
            raise ValueError("depth reads points and mean_over a mean: give one of them")
        if self.depth is not None and self.lattices == 2:
            raise ValueError("depth reads the points of one lattice of cells: leave lattices out")
        return self


class Case(FilePart):
    """Everything that a computation needs, checked.

    Numbers are SI; in a TOML file a quoted number carries its unit. title: of summaries and reports. spacing: of the
    contact's cells; left out, 3 mm, or the cells of a height map. tolerance: of the contact, relative.
    road_compliance: "layers" for a stiff body such as a steel wheel, see `solve_contact`; else the top layer's
    half-space. tire: its surface and what it is made of. pavement: the road. rolling: load, friction, forces.
    footprint: recorded contact stress in place of tire and rolling. response: where the road is read. damage: what it
    does to the surface. passes: how often it rolls over a road that yields.
    aggregates: stones in the mortar of the top layer, in a window. indentation, drum: in place of rolling and what
    follows, a body that dents its road, which `treadload.study.run_dents` and `treadload run` solve. texture: of the
    road, which the tread touches. crossing: the wheel over a step, a joint or a plate besides.
    """

    own_tables: ClassVar = (
        "rolling", "footprint", "response", "damage", "passes", "aggregates", "texture", "crossing", "indentation",
        "drum",
    )  # fmt: skip
    how_to_run: ClassVar = "the case of a wheel: use `treadload run {name}`, in Python Case"

    spacing: Length | None = None
    tolerance: Number = 1e-6
    road_compliance: RoadCompliance = "half_space"
    tire: TirePart | None = None
    pavement: PavementPart
    rolling: Annotated[Any, As(Rolling)] = None
    footprint: FootprintPart | None = None
    response: ResponsePart = ResponsePart()
    damage: DamagePart | None = None
    passes: PassesPart | None = None
    aggregates: AggregatesPart | None = None
    texture: TexturePart | None = None
    crossing: CrossingPart | None = None
    indentation: IndentationPart | None = None
    drum: DrumPart | None = None

    @model_validator(mode="after")
    def _buildable(self) -> Case:
        if not 1e-12 <= self.tolerance <= 1e-2:
            raise ValueError(f"tolerance must lie in [1e-12, 1e-2], got {self.tolerance:g}; 1e-6 is the default")
        # Building what is cheap to build finds wrong values before any file is read.
        road = self.pavement.build()
        if self.dents:
            self._check_dents(road)
            return self
        self._check_loading(road)
        if road.is_viscoelastic and self.speed is None:
            raise ValueError("the road is viscoelastic: give the speed in [rolling] or [response]")
        if not road.reaches(max(self.response.depths)):
            raise ValueError(
                f"response.depths reach {max(self.response.depths):g} m, below the rigid base at "
                f"{road.interfaces[-1]:g} m"
            )
        if self.passes is not None:
            _check_yields("[passes] need", road)
        if self.aggregates is not None:
            self.aggregates.road(road)
        if self.texture is not None:
            self.texture.check(has_tire=self.tire is not None, speed=self.speed, cell=self.spacing)
        if self.crossing is not None:
            self.crossing.check(None if self.rolling is None else self.build_rolling())
            if self.tire is not None and isinstance(TIRE_MATERIAL.build(self.tire.material), Prony):
                raise ValueError("[crossing] knows elastic tires only; give tire.material an elastic modulus")
        if self.damage is not None:
            depth = self.damage.depth
            if depth is not None and not same_depth(self.response.depths, depth).any():
                raise ValueError(
                    f"damage.depth {self.damage.depth:g} m is not one of response.depths "
                    f"{list(self.response.depths)} m; add it there"
                )
        return self

    def _check_dents(self, road: Pavement) -> None:
        """Of a body pressed into its road, or rolled over its track."""
        name = "drum" if self.indentation is None else "indentation"
        takes = {"title", "tire", "pavement", name}
        stray = sorted(self.model_fields_set & set(type(self).model_fields) - takes - {"folder"})
        if stray:
            raise ValueError(
                f"[{name}] stands in place of [rolling] and what follows, with cells and a tolerance of its own; "
                f"leave out {stray[0]}"
            )
        if self.tire is None:
            raise ValueError(f"'tire' is missing: the body of [{name}], such as a profile with a material of steel")
        if self.tire.belt is not None:
            raise ValueError(f"[{name}] takes an elastic body; give tire.material in place of belt")
        _check_yields(f"[{name}] needs", road)
        if self.indentation is not None:
            check_indented(road)

    def _check_loading(self, road: Pavement) -> None:
        if self.footprint is not None:
            stray = sorted({"tire", "rolling", "spacing", "road_compliance"} & self.model_fields_set)
            if stray:
                raise ValueError(f"a footprint stands in place of a tire; leave out {stray[0]}")
            return
        missing = [name for name in ("tire", "rolling") if getattr(self, name) is None]
        if missing:
            raise ValueError(f"'{missing[0]}' is missing; or give a recorded [footprint] in place of both")
        assert self.tire is not None
        assert self.rolling is not None
        self.rolling.build(self.folder)
        if self.tire.belt is not None and self.tire.inflation_pressure is None:
            raise ValueError('a belt carries by its inflation: give tire.inflation_pressure, such as "8.2 bar"')
        if self.tire.material is not None:
            surface_of(TIRE_MATERIAL.build(self.tire.material), is_tire=True, speed=self.rolling.speed)

    @property
    def dents(self) -> bool:
        """True for a body that is pressed into its road, or rolls over its own track, in place of a wheel."""
        return self.indentation is not None or self.drum is not None

    @property
    def speed(self) -> float | None:
        """Speed of the wheels over the road, m/s: that of the response, else that of rolling; None if neither."""
        if self.response.speed is not None:
            return self.response.speed
        speed: float | None = None if self.rolling is None else self.rolling.speed
        return speed

    def build_road(self) -> Pavement:
        """The road."""
        return self.pavement.build()

    def build_tire(self) -> Tire:
        """The tire, read from its file if it has one. Raises InputError for a case of a recorded footprint."""
        if self.tire is None:
            raise InputError("this case has a recorded footprint and no tire")
        return self.tire.build(self.folder)

    def build_rolling(self) -> Rolling:
        """The rolling state. Raises InputError for a case of a recorded footprint."""
        if self.rolling is None:
            held = "a recorded footprint" if not self.dents else "an [indentation] or a [drum]"
            raise InputError(f"this case has {held} and no rolling state")
        rolling: Rolling = self.rolling.build(self.folder)
        return rolling

    def build_relief(self) -> Relief | None:
        """The texture under the whole tire, read from its file if it has one; None where the road is a plane."""
        return self.texture.build(self.folder) if self.texture is not None and self.texture.resolved else None


def _check_yields(who: str, road: Pavement) -> None:
    if not any(isinstance(layer.material, ElastoPlastic) for layer in road.layers):
        raise ValueError(
            f"{who} a layer that can yield: give one of the layers a plasticity, "
            'such as { kind = "mohr-coulomb", cohesion = "100 kPa", friction_angle = "35 deg" }'
        )
