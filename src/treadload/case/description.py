"""What a case describes: tire, road, wheel, traffic, climate, and the objects that they stand for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from treadload.case.choices import TIRE_MATERIAL
from treadload.case.climate import AgeingPart, ClimatePart
from treadload.case.criteria import Criterion, CriterionTable, is_of_absent, without_absent
from treadload.case.file import FilePart
from treadload.case.road import PavementPart
from treadload.case.tire import TirePart
from treadload.case.traffic import TrafficPart
from treadload.contact import Rolling
from treadload.contact.bodies.choose import RoadCompliance
from treadload.damage import Climate, Traffic
from treadload.damage.criterion import Criterion as Judge
from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import Pavement, Relief
from treadload.read import As
from treadload.tire import Tire
from treadload.units import Length, Number


def _layer_in_words(layer: int | str) -> str:
    return f"layer {layer}" if isinstance(layer, int) else layer


class Description(FilePart):
    """What a case describes; what it asks for are the tables of its steps.

    Numbers are SI; in a TOML file a quoted number carries its unit. title: of summaries and reports. spacing: of the
    contact's cells; left out, 3 mm, of a calibration 6 mm, or the cells of a height map. tolerance: relative, of the
    contact, 1e-6 if left out, of a calibration 1e-8; of a service life that of values interpolated over the climate,
    5e-3. road_compliance: "layers" for a stiff body such as a steel wheel, see `solve_contact`; else the top layer's
    half-space. tire: its surface and what it is made of. pavement: the road. rolling: load, friction, forces.
    traffic: axles that pass. climate: how warm the road is over the year. ageing: how old its mixes are. criteria:
    what ends the service life. All other tables ask for a result, see `treadload.steps`.
    """

    spacing: Length | None = None
    tolerance: Number | None = None
    road_compliance: RoadCompliance = "half_space"
    tire: TirePart | None = None
    pavement: PavementPart | None = None
    rolling: Annotated[Any, As(Rolling)] = None
    traffic: TrafficPart | None = None
    climate: ClimatePart | None = None
    ageing: AgeingPart | None = None
    criteria: tuple[Criterion, ...] = ()

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """The table of a step; None where the case has none."""

    @property
    def speed(self) -> float | None:
        """Speed of the wheels over the road, m/s: that of the response, else that of rolling; None if neither."""
        if self.response.speed is not None:
            return float(self.response.speed)
        speed: float | None = None if self.rolling is None else self.rolling.speed
        return speed

    def build_road(self) -> Pavement | None:
        """The road; None for the track of a test rig. In a life its materials wait for their temperature."""
        if self.pavement is None:
            return None
        return self.pavement.untempered() if self.source.waits_for_temperature else self.pavement.build()

    def road(self) -> Pavement:
        """The road. Raises InputError for a case without one."""
        road = self.build_road()
        if road is None:
            raise InputError("'pavement' is missing: give its layers, or the name of a structure")
        return road

    def build_tire(self) -> Tire:
        """The tire, read from its file if it has one. Raises InputError for a case of a recorded footprint."""
        if self.tire is None:
            raise InputError("this case has a recorded footprint and no tire")
        return self.tire.build(self.folder)

    def build_rolling(self) -> Rolling:
        """The rolling state. Raises InputError for a case without one."""
        if self.rolling is None:
            raise InputError(f"this case has [{self.source.name}] and no rolling state")
        rolling: Rolling = self.rolling.build(self.folder)
        return rolling

    def build_relief(self) -> Relief | None:
        """The texture under the whole tire, read from its file if it has one; None where the road is a plane."""
        relief: Relief | None = None
        if self.texture is not None and self.texture.resolved:
            relief = self.texture.build(self.folder)
        return relief

    def build_traffic(self) -> Traffic:
        """The traffic; friction maps start from the folder. Raises InputError for a case without."""
        if self.traffic is None:
            raise InputError("'traffic' is missing: give [traffic] with its classes of axles")
        return self.traffic.build(self.folder)

    def build_climate(self) -> Climate:
        """The climate. Raises InputError for a case without."""
        if self.climate is None:
            raise InputError("'climate' is missing: give [climate], such as temperature = 15")
        climate = self.climate
        if self._absent and self.pavement is not None:
            climate = climate.without(self._absent, len(self.pavement.layers or ()))
        return climate.build(self.road(), self.folder, self.ageing)

    def build_criteria(self) -> tuple[Judge, ...]:
        """The criteria on this road."""
        return self.criteria_on(self.road())

    def criteria_on(self, road: Pavement) -> tuple[Judge, ...]:
        """The criteria on a road with the layers of this case, less those of layers that are absent."""
        kept = [criterion for criterion in self.criteria if not self._is_of_absent(criterion, road)]
        if self.criteria and not kept:
            names = ", ".join(repr(str(criterion.name)) for criterion in self.criteria)
            raise InputError(
                f"no criterion is left: the layers of {names} are absent, with a thickness of 0; add one of a layer "
                "that is there"
            )
        absent = self._absent
        return tuple(without_absent(criterion, absent).on(road) for criterion in kept)

    @property
    def left_out(self) -> tuple[str, ...]:
        """A sentence for each criterion whose layer is absent."""
        if not self._absent:
            return ()
        road = self.road()
        return tuple(
            f"criterion {criterion.name!r} is not evaluated: the road has no {_layer_in_words(criterion.layer)}"
            for criterion in self.criteria
            if self._is_of_absent(criterion, road)
        )

    @property
    def _absent(self) -> dict[int, str]:
        """Names of the absent layers by their numbers."""
        part = self.pavement
        layers = () if part is None else part.layers or ()
        return {} if part is None else {number: layers[number].label for number in part.absent}

    def _is_of_absent(self, criterion: CriterionTable, road: Pavement) -> bool:
        return is_of_absent(criterion, road, self._absent)

    @property
    def has_elastic_tire(self) -> bool:
        """True where the tire's material is elastic, or follows from its inflation."""
        material = None if self.tire is None else self.tire.material
        return material is None or isinstance(TIRE_MATERIAL.build(material), Elastic)
