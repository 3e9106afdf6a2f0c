"""The design of a road: what is asked of it, in one object that every verb of a service life takes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from treadload.contact.contact_grid import DEFAULT_SPACING
from treadload.damage.answer import RUT
from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.rutting import Rutting
from treadload.damage.scatter import Scatter
from treadload.damage.traffic import Traffic
from treadload.errors import InputError
from treadload.life.contacts import Contacts
from treadload.pavement import Pavement
from treadload.tire import Tire

DEFAULT_TOLERANCE = 5e-3


@dataclass(frozen=True, eq=False)
class Design:
    """A road under a tire, a traffic and a climate, the criteria that end its life, and how closely it is solved.

    tire: of classes without one of their own; the inflation pressure is that of the class. road: materials may depend
    on temperature. climate: with the ageing of its mixes, if they age. criteria: one at least.
    criteria_of: gives those of a road with another thickness, where the numbers of a law depend on it, as Sh does;
    left out, they stay. rutting: how a rut is
    counted; left out, none is. scatter: of the inputs, for reliability; left out, fatigue and thickness by the laws
    and the rule of the French method. spacing: of the contact's cells, m; wheels are moved by half a cell at most, so
    that all share one grid. tolerance: of values interpolated over the climate, relative, in [0, 1); 0 solves every
    season.
    contacts: those solved so far, which all verbs share; `dataclasses.replace` keeps them while tire and spacing
    stay. Raises InputError.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.5, 1.0, 0.25), inflation_pressure=8e5)
    >>> bus = tl.damage.AxleClass("bus", 1.0, wheel_load=35e3, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((bus,), passes_per_year=1e5), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1)
    >>> design = tl.Design(tire, tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3"), traffic, climate, [base])
    >>> round(tl.pavement.bituminous_thickness(design.with_thickness(1, 0.18).road, 1), 3)  # m, with 180 mm of base
    0.24
    """

    tire: Tire
    road: Pavement
    traffic: Traffic
    climate: Climate
    criteria: Sequence[Criterion]
    criteria_of: Callable[[Pavement], Sequence[Criterion]] | None = field(default=None, kw_only=True)
    rutting: Rutting | None = field(default=None, kw_only=True)
    scatter: Scatter | None = field(default=None, kw_only=True)
    spacing: float = field(default=DEFAULT_SPACING, kw_only=True)
    tolerance: float = field(default=DEFAULT_TOLERANCE, kw_only=True)
    contacts: Contacts = field(default=None, kw_only=True, repr=False)  # type: ignore[assignment]

    def __post_init__(self) -> None:
        if not 0 <= self.tolerance < 1:
            raise InputError(f"tolerance must lie in [0, 1), got {self.tolerance}; 5e-3 is the default")
        if not self.criteria:
            raise InputError("a life needs at least one criterion, got none")
        if self.rutting is not None and any(criterion.name == RUT for criterion in self.criteria):
            raise InputError(f"a criterion has the name {RUT!r}, which the life's rut has; give it another name")
        contacts = self.contacts
        if contacts is None or contacts.tire is not self.tire or contacts.spacing != self.spacing:
            object.__setattr__(self, "contacts", Contacts(self.tire, self.spacing))

    def with_thickness(self, number: int, thickness: float) -> Design:
        """The design with another thickness, m, of a layer, from 0 at the surface; contacts are shared."""
        layers = list(self.road.layers)
        layers[number] = replace(layers[number], thickness=thickness)
        return self.on_road(Pavement(layers, rigid_base=self.road.rigid_base))

    def on_road(self, road: Pavement) -> Design:
        """The design with another road, and the criteria that it has there; contacts are shared."""
        return replace(self, road=road, criteria=self.criteria_of(road) if self.criteria_of else self.criteria)
