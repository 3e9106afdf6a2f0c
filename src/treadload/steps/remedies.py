"""What would help the road of a service life."""

from __future__ import annotations

from typing import ClassVar

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.case.tire import TirePart
from treadload.damage import Life
from treadload.life.equivalents import Equivalents
from treadload.life.remedy import Remedies, RemedySteps, remedies
from treadload.life.remedy.solve import remedies_of
from treadload.life.remedy.steps import Kind
from treadload.steps.design import design_of
from treadload.steps.life import fails
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.tire import Tire
from treadload.units import Length, Number, Pressure, Share, Speed

_DEFAULTS = RemedySteps()


class RemediesStep(Step, name="remedies"):
    """`[remedies]` of a design case: each change that an agency can make, by one step, ranked by the years it wins.

    thickness: more of each layer. modulus: share by which a layer that is not of the catalogue is stiffer or softer.
    mixes: a table, name of a layer = material of the catalogue in its place; left out, the neighbours of the same
    use. wander: more deviation. load: share by which wheel loads are lowered. tire: in place of that of the case;
    left out, the catalogue's next profile. pressure: less inflation pressure. speed: more and less. maneuver: share
    by which braking, starting and turning are gentler. friction: more and less. only: kinds to solve, of
    "thickness", "mix", "bond", "wander", "load", "tire", "pressure", "speed", "braking", "turning", "friction"; left
    out, all. See `treadload.life.RemedySteps` for the reasons of the defaults.

    >>> axle = {"name": "axle", "share": 1, "axle_load": "100 kN", "inflation_pressure": "8 bar"}
    >>> case = {"tire": {"profile": "315/80R22.5"}, "pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3"}}
    >>> case |= {"traffic": {"passes_per_year": 1e5, "classes": [axle]}, "climate": {"temperature": 15}}
    >>> case["criteria"] = [{"name": "soil", "law": "french-subgrade"}]
    >>> print(tl.plan(tl.Case.from_dict(case | {"remedies": {}})).splitlines()[-1])
    remedies  12: 12 take about as many responses as the life each, 5 of them new contacts too; 5 do not apply
    """

    after: ClassVar = ("life",)
    also: ClassVar = ("equivalents",)

    thickness: Length = _DEFAULTS.thickness
    modulus: Share = _DEFAULTS.modulus
    mixes: dict[str, str] | None = None
    wander: Length = _DEFAULTS.wander
    load: Share = _DEFAULTS.load
    tire: TirePart | None = None
    pressure: Pressure = _DEFAULTS.pressure
    speed: Speed = _DEFAULTS.speed
    maneuver: Share = _DEFAULTS.maneuver
    friction: Number = _DEFAULTS.friction
    only: tuple[Kind, ...] = ()

    @model_validator(mode="after")
    def _possible(self) -> RemediesStep:
        self._numbers()
        return self

    def check(self, case: Description) -> None:
        """Refuse a layer or a mix of `mixes` that is not there."""
        if self.mixes:
            remedies_of(design_of(case), self._numbers("mix"))  # type: ignore[arg-type]

    def build(self, case: Description) -> RemedySteps:
        """The steps. case: whose folder holds the file of the tire."""
        tire = None if self.tire is None else self.tire.build(case.folder)
        return self._numbers(*self.only, tire=tire)

    def _numbers(self, *only: Kind, tire: Tire | None = None) -> RemedySteps:
        return RemedySteps(
            thickness=self.thickness, modulus=self.modulus, mixes=self.mixes or {}, wander=self.wander,
            load=self.load, tire=tire, pressure=self.pressure, speed=self.speed, maneuver=self.maneuver,
            friction=self.friction, only=only,
        )  # fmt: skip

    def solve(self, scene: Scene) -> Remedies | None:
        """Years after every remedy; None where no criterion ever fails."""
        life, axles = scene.result("life"), scene.results.get("equivalents")
        assert isinstance(life, Life)
        if not fails(life):
            return None
        return remedies(
            scene.design, life, self.build(scene.case),
            equivalents=axles if isinstance(axles, Equivalents) else None,
            workers=scene.options.workers, progress=scene.progress.count,
        )  # fmt: skip

    def plan(self, outline: Outline) -> None:
        """How many remedies are solved, each about as long as the life."""
        candidates, refused = remedies_of(design_of(outline.case), self.build(outline.case))
        again = sum(not remedy.same_responses for remedy in candidates)
        touching = sum(remedy.layer is None and not remedy.same_responses for remedy in candidates)
        outline.add(
            "remedies",
            f"{len(candidates)}: {again} take about as many responses as the life each, {touching} of them new "
            f"contacts too; {len(refused)} do not apply",
        )
