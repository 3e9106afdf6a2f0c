"""A design case: a tire, a road, its traffic, its climate, and the criteria it must meet."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import model_validator

from treadload.case.climate import AgeingPart, ClimatePart
from treadload.case.criteria import Criterion
from treadload.case.file import FilePart
from treadload.case.growth import GrowthPart
from treadload.case.reliability import ReliabilityPart
from treadload.case.road import PavementPart, RoadPart
from treadload.case.tire import TirePart
from treadload.case.traffic import TrafficPart
from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage import Climate, Traffic
from treadload.damage.criterion import Criterion as Judge
from treadload.damage.rutting import Rutting
from treadload.pavement import Pavement
from treadload.pavement.sublayers import middle_temperatures
from treadload.read import As, Made
from treadload.tire import Tire
from treadload.units import Length, Number


class DesignRoadPart(RoadPart):
    """`[pavement]` of a design case: as in a case, but its temperatures are those of [climate]."""

    @classmethod
    def unknown(cls, key: str) -> str:
        """Which key was meant."""
        if key in PavementPart.known_keys():
            return "it is not allowed here: the road takes the temperatures of [climate]"
        return super().unknown(key)


class LifeCase(FilePart):
    """Everything that the life of a road depends on, checked.

    Numbers are SI; in a TOML file a quoted number carries its unit. title: of summaries and reports. tire: of the
    classes of axles that bring none. pavement: the road. traffic: what passes. climate: how warm the road is over the
    year. ageing: how old its mixes are. criteria: what ends its life. spacing: of the contact's cells, 3 mm if left
    out: surface lives move by less than 5 % on finer ones, and by half on cells of 6 mm. tolerance: of readings
    interpolated over the climate. rutting: how a rut is counted; left out, none is. growth: of a crack; left out,
    none grows. reliability: what scatters; left out, no probabilities.
    """

    own_tables: ClassVar = ("traffic", "climate", "ageing", "criteria")
    how_to_run: ClassVar = "a design case: use `treadload life {name}`, in Python LifeCase"

    spacing: Length = DEFAULT_SPACING
    tolerance: Number = 5e-3
    tire: TirePart
    pavement: DesignRoadPart
    traffic: TrafficPart
    climate: ClimatePart
    ageing: AgeingPart | None = None
    criteria: tuple[Criterion, ...]
    rutting: Annotated[Made, As(Rutting)] | None = None
    growth: GrowthPart | None = None
    reliability: ReliabilityPart | None = None

    @model_validator(mode="after")
    def _buildable(self) -> LifeCase:
        road, climate = self.build_road(), self.build_climate()
        if not self.criteria:
            raise ValueError("a life needs at least one of [[criteria]], got none")
        names = [one.name for one in self.criteria]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise ValueError(f"two criteria have the name {twice!r}; give them different names")
        if self.growth is not None:
            self.growth.build(self.build_criteria())
        self.build_traffic()
        temperatures = {season.temperature for season in climate.seasons}
        waiting = any(layer.depends_on_temperature for layer in road.layers)
        if self.ageing is not None and not waiting:
            raise ValueError(
                "ageing needs a mix with moduli over temperature, and no layer has one; give mixes of the catalogue "
                "or materials with a shift"
            )
        if len(temperatures) > 1 and not waiting:
            raise ValueError(
                f"the climate has {len(temperatures)} temperatures, but no layer has moduli for them; give mixes of "
                "the catalogue or materials with a shift, or one temperature"
            )
        criteria = self.build_criteria()
        for season in climate.seasons:
            profile, warm = season.profile, season.temperatures
            if profile is None:
                each = list(warm) if isinstance(season.temperature, tuple) else [*warm] * len(road.layers)
                warmed = road.at_temperature(season.temperature)
            else:
                warmed = road.at_temperature(middle_temperatures(road, profile), extrapolate=True)
            for criterion in criteria:
                number = criterion.number(road)
                criterion.depth(warmed)
                if profile is None:
                    criterion.law_at(each[number])
        return self

    def build_tire(self) -> Tire:
        """The tire, read from its file if it has one."""
        return self.tire.build(self.folder)

    def build_road(self) -> Pavement:
        """The road, whose materials wait for their temperature."""
        return self.pavement.untempered()

    def build_traffic(self) -> Traffic:
        """The traffic; friction maps start from the folder."""
        return self.traffic.build(self.folder)

    def build_climate(self) -> Climate:
        """The climate."""
        return self.climate.build(self.build_road(), self.folder, self.ageing)

    def build_criteria(self) -> tuple[Judge, ...]:
        """The criteria on this road."""
        road = self.build_road()
        return tuple(one.on(road) for one in self.criteria)
