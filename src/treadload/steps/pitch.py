"""A tread with blocks that rolls through one pitch."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step, numbers_of
from treadload.citations import BLOCKS
from treadload.composing import BaseResult
from treadload.contact import Contact, PitchPassage, solve_pitch
from treadload.contact.pitch import POSITIONS, check_positions
from treadload.damage.pitch import respond_to_pitch
from treadload.deferred import xarray as xr
from treadload.errors import positive
from treadload.materials import Prony
from treadload.read import As, TargetTable
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.tire.grooves import LateralGrooves
from treadload.tire.lugs import lugged_tread
from treadload.units import Length, Number

# Pitches that it takes until one repeats the one before, about; the time of a position over that of a contact.
_PITCHES, _OF_CONTACT = 6, 0.3


class PitchStep(Step, name="pitch"):
    """`[pitch]`: blocks on a belt, position by position through one pitch, see `treadload.contact.solve_pitch`.

    lateral: grooves that cut the ribs of a scan, or of a profile without lateral grooves; left out, those of the
    profile. positions: of the wheel in a pitch. spacing: of the cells; left out, that of the case. tolerance: of the
    conditions of a step. periodic: what may still change from a pitch to the next, relative. depths: at which the
    road's strains are read at every position, for their mean and their worst over the pitch; left out, none are.

    >>> tire = {"profile": "315/80R22.5", "belt": "315/80R22.5", "inflation_pressure": "8 bar"}
    >>> wheel = {"tire": tire, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> lugs = {"lateral": [{"pitch": "70 mm", "width": "8 mm", "depth": "12 mm"}]}
    >>> [step.name for step in tl.Case.from_dict(wheel | road | {"pitch": lugs}).steps]
    ['contact', 'response', 'slices', 'bowl', 'pitch']
    """

    makes: ClassVar = ("pitch", "pitch_response")
    swept: ClassVar = True

    lateral: tuple[Annotated[TargetTable, As(LateralGrooves)], ...] = ()
    positions: int = POSITIONS
    spacing: Length | None = None
    tolerance: Number = 1e-4
    periodic: Number = 0.01
    depths: tuple[Length, ...] = ()

    @model_validator(mode="after")
    def _possible(self) -> PitchStep:
        if self.spacing is not None:
            positive("spacing", self.spacing, "metres", "leave it out for that of the case")
        check_positions(self.positions)
        if self.depths and min(self.depths) < 0:
            raise ValueError(f"depths must be >= 0, got {min(self.depths):g} m; depth counts downwards")
        self.grooves()
        return self

    def grooves(self) -> tuple[LateralGrooves, ...]:
        """The lateral grooves that the table gives."""
        return tuple(groove.build() for groove in self.lateral)

    def check(self, case: Description) -> None:
        """Refuse what does not fit the rest of the case."""
        if case.rolling is None or case.tire is None:
            raise ValueError("[pitch] needs a wheel, and this case has a footprint; give tire and rolling")
        if case.tire.belt is None:
            raise ValueError('[pitch] has blocks on a belt: give tire.belt, such as "315/80R22.5"')
        belt = case.tire._belt()
        if belt is not None and isinstance(belt.under_ribs().tread, Prony):
            raise ValueError("[pitch] takes elastic rubber; give the tread of the belt an elastic modulus")
        if case.build_rolling().law.needs_speed:
            raise ValueError("[pitch] does not follow friction that falls with slip; give a number")

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of the step."""
        return BLOCKS

    def solve(self, scene: Scene) -> dict[str, BaseResult]:
        """The passage of a pitch, and what it does to the road at the depths."""
        case, contact = scene.case, scene.result("contact")
        assert isinstance(contact, Contact)
        passage = solve_pitch(
            contact.tire, scene.loaded.road, contact.rolling, lateral=self.grooves(), positions=self.positions,
            spacing=case.spacing if self.spacing is None else self.spacing, tolerance=self.tolerance,
            periodic=self.periodic, road_compliance=case.road_compliance, progress=scene.tell,
        )  # fmt: skip
        results: dict[str, BaseResult] = {"pitch": passage}
        if self.depths:
            results["pitch_response"] = respond_to_pitch(
                passage, scene.loaded.road, depths=self.depths, speed=case.speed, progress=scene.tell
            )
        return results

    def numbers(self, scene: Scene) -> xr.Dataset:
        """Those of the passage: mean and worst over the positions."""
        passage = scene.result("pitch")
        assert isinstance(passage, PitchPassage)
        data = passage.dataset
        worst = {name: float(data[name].max()) for name in ("largest_pressure", "largest_traction")}
        mean = {f"mean_{name}": float(data[name].mean()) for name in ("largest_pressure", "largest_traction")}
        return numbers_of(data).assign({**worst, **mean})

    def plan(self, outline: Outline) -> None:
        """The blocks and the number of positions."""
        tread = lugged_tread(outline.case.build_tire(), self.grooves())
        outline.add(
            "pitch", f"{tread.pattern}; {self.positions} positions, about {_PITCHES} pitches until it repeats"
        )
        outline.contacts += _PITCHES * self.positions * _OF_CONTACT
