"""The fatigue line, and what it allows of the load."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step, numbers_of
from treadload.damage import FatigueLine, Verdict
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.layers.depths import same_depth
from treadload.read import As, TargetTable
from treadload.response import MATERIAL_LENGTH, Response
from treadload.response.material import check_length
from treadload.steps.loaded import judge, on_two_grids
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.steps.script import NoCallError, Script
from treadload.units import Length


class DamageStep(Step, name="damage"):
    """`[damage]`: the fatigue line, and which strain it reads, where, over how much road.

    fatigue: the line, with epsilon_6 and slope. strain: "in-plane", of the horizontal plane, or "principal", in
    space. mean_over: side of the cube of road whose mean strain is read; 10 mm if left out. depth: one of the
    response's depths, whose points are read instead; left out, the means of all that lie in the top layer.
    lattices: 2 reads the mean of two contacts whose cells lie half a cell apart, so that the reading does not depend
    on where cells lie, 1 that of one; left out, 2 where the tire is known between its cells and no depth is given.
    error_estimate: also solve the case on cells twice as large, and report how much the reading changes. See
    `treadload.assess`.

    >>> wheel = {"tire": {"profile": "315/80R22.5", "inflation_pressure": "8 bar"}, "spacing": "12 mm"}
    >>> wheel |= {"rolling": {"normal_load": "32.5 kN", "friction": 0.7}, "response": {"depths": ["0 mm", "20 mm"]}}
    >>> road = {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}}
    >>> fatigue = {"damage": {"fatigue": {"epsilon_6": "120 microstrain", "slope": -0.2}}}
    >>> plan = tl.plan(tl.Case.from_dict(wheel | road | fatigue))
    >>> next(line for line in plan.splitlines() if line.startswith("verdict"))
    'verdict   fatigue line, ε₆ = 120 microstrain, slope -0.2, means over 10 mm in the top layer'
    """

    after: ClassVar = ("contact", "response")
    swept: ClassVar = True
    heading: ClassVar = "Fatigue"

    fatigue: Annotated[TargetTable, As(FatigueLine)]
    strain: Literal["principal", "in-plane"] = "in-plane"
    mean_over: Length = MATERIAL_LENGTH
    depth: Length | None = None
    lattices: Literal[1, 2] | None = None
    error_estimate: bool = False

    @model_validator(mode="after")
    def _read_once(self) -> DamageStep:
        check_length(self.mean_over)
        if self.depth is not None and self.names_key("mean_over"):
            raise ValueError("depth reads points and mean_over a mean: give one of them")
        if self.depth is not None and self.lattices == 2:
            raise ValueError("depth reads the points of one lattice of cells: leave lattices out")
        return self

    def check(self, case: Description) -> None:
        """Refuse a depth that the response does not have."""
        if self.depth is not None and not same_depth(case.response.depths, self.depth).any():
            raise ValueError(
                f"damage.depth {self.depth:g} m is not one of response.depths {list(case.response.depths)} m; add it "
                "there"
            )

    @property
    def is_quick(self) -> bool:
        """True: the page shows it as soon as it is solved."""
        return True

    def solve(self, scene: Scene) -> Verdict:
        """What the line allows. In a study a line that reads means needs no map of points."""
        load = scene.loaded
        scene.tell("verdict")
        reads_means = scene.options.only_numbers and self.depth is None
        response = scene.means if reads_means else scene.result("response")
        assert isinstance(response, Response)
        verdict = judge(load, response)
        return on_two_grids(load, verdict) if self.error_estimate else verdict

    def numbers(self, scene: Scene) -> xr.Dataset:
        """The worst strain, its place and direction, the load repetitions allowed."""
        verdict = scene.result("damage")
        assert verdict is not None
        return numbers_of(verdict.dataset)

    def plan(self, outline: Outline) -> None:
        """The line, and what it reads."""
        wide, deep = f"means over {self.mean_over * 1e3:g} mm in the top layer", self.depth
        outline.add("verdict", f"{self.fatigue.build()}, {wide if deep is None else f'points at {deep * 1e3:g} mm'}")

    def python(self, script: Script) -> list[str] | None:
        """`tl.assess`, with a second grid where both grid offsets are read; None with an error estimate."""
        if self.error_estimate:
            return None
        law = self.fatigue.build()
        try:
            line = script.code(law)
        except NoCallError as error:
            raise InputError(f"the law {law} has no words in Python; keep the case as TOML") from error
        how: dict[str, Any] = {"strain": self.strain, "depth": self.depth}
        if self.depth is None and self.mean_over != MATERIAL_LENGTH:
            how["mean_over"] = self.mean_over
        tire = script.case.tire
        if self.depth is None and self.lattices != 1 and tire is not None and tire.height_map is None:
            how["shifted"] = True
        return [script.call("verdict = tl.assess", ["response", line, *script.keywords(how)])]
