"""Contact of the wheel: pressure, shear, stick and slip."""

from __future__ import annotations

from typing import ClassVar

from treadload.case.choices import TIRE_MATERIAL
from treadload.case.description import Description
from treadload.case.step import Source, numbers_of
from treadload.contact import Contact, cautions
from treadload.contact.bodies.choose import surface_of
from treadload.deferred import xarray as xr
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.steps.script import Script

# Rows that a sweep keeps of every case.
_NUMBERS = ("net_area", "mean_pressure", "largest_pressure", "largest_traction", "slip_fraction")


class ContactStep(Source, name="contact"):
    """A tire in its rolling state, `[tire]` and `[rolling]`, on the road: what a case is about if nothing else.

    >>> wheel = {"tire": {"profile": "315/80R22.5", "inflation_pressure": "8 bar"}, "spacing": "12 mm"}
    >>> wheel |= {"rolling": {"normal_load": "32.5 kN", "friction": 0.7}, "response": {"depths": ["0 mm", "20 mm"]}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> plan = tl.plan(tl.Case.from_dict(wheel | road))
    >>> next(line for line in plan.splitlines() if line.startswith("contact"))
    'contact   27 x 29 cells of 12 x 12 mm, 783 cells'
    """

    uses: ClassVar = ("title", "spacing", "tolerance", "road_compliance", "tire", "pavement", "rolling")
    needs: ClassVar = ("pavement", "tire", "rolling")
    has_table: ClassVar = False
    swept: ClassVar = True

    @classmethod
    def stray_text(cls, key: str) -> str:
        """What else a case with a wheel is not."""
        return f"a case with [rolling] has no use for {key!r}; leave it out"

    @classmethod
    def missing_text(cls, key: str) -> str:
        """What stands in place of a wheel."""
        if key == "pavement":
            return super().missing_text(key)
        return f"{key!r} is missing; or give a recorded [footprint] in place of both"

    def check(self, case: Description) -> None:
        """Refuse wheels and tires that no contact can have."""
        super().check(case)
        tire, rolling = case.tire, case.build_rolling()
        assert tire is not None
        case.build_road()
        if tire.belt is not None and tire.inflation_pressure is None:
            raise ValueError('a belt carries by its inflation: give tire.inflation_pressure, such as "8.2 bar"')
        if tire.material is not None:
            surface_of(TIRE_MATERIAL.build(tire.material), is_tire=True, speed=rolling.speed)

    @property
    def is_quick(self) -> bool:
        """True: the page shows it as soon as it is solved."""
        return True

    def solve(self, scene: Scene) -> Contact:
        """The contact on the road of the case."""
        contact = scene.loaded.contact
        assert contact is not None
        return contact

    def plan(self, outline: Outline) -> None:
        """Tire, rolling state, cells."""
        tire, rolling, grid = outline.case.build_tire(), outline.case.build_rolling(), outline.grid
        outline.warnings += cautions.of_numbers(tire, rolling, grid)
        outline.add("tire", f"{tire}")
        outline.add("rolling", f"{rolling}")
        count = f"{grid.nx * grid.ny:,}".replace(",", "\u202f")
        outline.add("contact", f"{grid}, {count} cells")
        outline.contacts += 1

    def python(self, script: Script) -> list[str]:
        """`tl.solve_contact`."""
        return ["", script.call("contact = tl.solve_contact", ["tire", "road", "wheel", *script.contact_keywords()])]

    def numbers(self, scene: Scene) -> xr.Dataset:
        """Those of the contact, with its area, peaks and slip."""
        contact = scene.result("contact")
        assert isinstance(contact, Contact)
        return numbers_of(contact.dataset).assign(
            {row.key: row.value for row in contact.rows() if row.key in _NUMBERS}
        )
