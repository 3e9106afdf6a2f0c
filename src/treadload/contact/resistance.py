"""Rolling resistance: what a viscoelastic tire costs to roll."""

from __future__ import annotations

from dataclasses import dataclass

from treadload.composing import BaseResult
from treadload.contact.solution import Contact
from treadload.deferred import xarray as xr
from treadload.errors import positive
from treadload.rows import Row, row
from treadload.variables import dataset


@dataclass(frozen=True)
class RollingResistance(BaseResult, group="rolling_resistance"):
    """Rolling resistance of a wheel.

    moment: of the pressure about the axle, N m, positive when it resists. pressure_centre_x: its arm, m, ahead of
    the axle. force: moment over rolling radius, N. coefficient: force over normal load.
    material_loss: energy lost in the materials per metre rolled, J/m = N, by pressure and shear, without what
    friction takes. material_power: the same over time, W; None without a speed.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> resistance = tl.contact.rolling_resistance(contact, radius=0.3)
    >>> abs(resistance.force) < 1e-6 * 100.0  # N: an elastic tire loses no energy
    True
    """

    moment: float
    pressure_centre_x: float
    force: float
    coefficient: float
    material_loss: float
    material_power: float | None

    @property
    def dataset(self) -> xr.Dataset:
        """The same numbers by name."""
        values = {
            "rolling_resistance_moment": self.moment, "pressure_centre_x": self.pressure_centre_x,
            "rolling_resistance": self.force, "rolling_resistance_coefficient": self.coefficient,
            "material_loss": self.material_loss, "material_power": self.material_power,
        }  # fmt: skip
        return dataset({name: ((), value) for name, value in values.items() if value is not None}, {})

    def rows(self) -> tuple[Row, ...]:
        """What rolling costs."""
        return tuple(row(str(name), float(value)) for name, value in self.dataset.data_vars.items())


def rolling_resistance(contact: Contact, radius: float) -> RollingResistance:
    """Rolling resistance of a contact.

    contact: of a tire whose axle stands above x = 0. radius: rolling radius R of the wheel, m.
    Per metre rolled, the moment M of the pressure brings in M/R and the shear Q·creepage; what friction does not
    take is lost in the materials: M/R - W - ξ Q_x - η Q_y - φ M_z. In elastic ones that is zero, but for an error
    that falls with the cell size. Raises InputError for a radius that is not a positive number.
    Source: Johnson (1985), Contact Mechanics, sections 9.1 and 9.4.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.7), spacing=0.006)
    >>> abs(tl.contact.rolling_resistance(contact, radius=0.3).coefficient) < 1e-3  # elastic: no loss
    True
    """
    positive("radius", radius, "metres", "a truck tire's is near 0.5 m")
    data = contact.dataset
    moment = float(data.rolling_resistance_moment)
    force = moment / radius
    drive = (
        data.creepage_x * data.tractive_force
        + data.creepage_y * data.lateral_force
        + data.spin * data.aligning_moment
    )
    loss = force - float(data.friction_work_total) - float(drive)
    speed = contact.rolling.speed
    return RollingResistance(
        moment,
        float(data.pressure_centre_x),
        force,
        force / float(data.normal_load),
        loss,
        None if speed is None else loss * speed,
    )
