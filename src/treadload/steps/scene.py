"""What a step sees while a case is solved: the case, the road under its wheels, and the results so far."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from treadload.case import Case
from treadload.case.step import Step, step_class
from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.errors import InputError
from treadload.life.contacts import Contacts
from treadload.life.design import Design
from treadload.registry import STEPS
from treadload.response import MATERIAL_LENGTH, Response
from treadload.steps.design import design_of
from treadload.steps.loaded import Loaded, Touch, contact_of, load_case


@dataclass(frozen=True)
class Progress:
    """How far a computation is. stage: called with a line of text. count: with how many of how many, and of what.

    >>> progress = tl.steps.Progress(stage=print)
    >>> progress.stage("contact")
    contact
    """

    stage: Callable[[str], None] = lambda text: None
    count: Callable[[int, int, str], None] = lambda done, total, what: None


@dataclass(frozen=True)
class Options:
    """What is no part of a case: how it is solved.

    leave_out: names of steps that are not solved. workers: threads of a service life; all cores if left out. jobs:
    processes of a calibration. state: file that keeps what a calibration has solved. contact: of the case, where it
    is known. touch: solves the contacts of the case. contacts: of a service life, those known among them.
    only_numbers: True where no maps are wanted, as in a study.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> options = tl.steps.Options(leave_out=("slices", "bowl"))
    >>> [step.name for step in tl.steps.Scene(case, options=options).steps]
    ['contact', 'response']
    """

    leave_out: tuple[str, ...] = ()
    workers: int | None = None
    jobs: int = 1
    state: Any = None
    contact: Contact | None = None
    touch: Touch = contact_of
    contacts: Contacts | None = None
    only_numbers: bool = False


class Scene:
    """A case while it is solved; each step is solved once, when its result is first needed.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> scene = tl.steps.Scene(case, options=tl.steps.Options(leave_out=("slices",)))
    >>> [step.name for step in scene.steps]
    ['contact', 'response', 'bowl']
    """

    def __init__(self, case: Case, progress: Progress | None = None, options: Options | None = None) -> None:
        self.case = case
        self.progress, self.options = progress or Progress(), options or Options()
        self.steps = tuple(step for step in case.steps if step.name not in self.options.leave_out)
        self.results: dict[str, BaseResult] = {}
        self._solved: set[str] = set()

    @property
    def tell(self) -> Callable[[str], None]:
        """What is called with a line of text at every stage."""
        return self.progress.stage

    @cached_property
    def loaded(self) -> Loaded:
        """The road of the case under its wheels. Raises InputError for a case without wheels."""
        return load_case(self.case, self.tell, contact=self.options.contact, touch=self.options.touch)

    @cached_property
    def design(self) -> Design:
        """The design of a service life, with the contacts that its steps share."""
        return design_of(self.case, self.options.contacts)

    @cached_property
    def means(self) -> Response:
        """The response as surface criteria read it: means over a length of road near the surface."""
        damage = self.case.damage
        length = None if damage is None or damage.depth is not None else damage.mean_over
        return self.loaded.solve(
            self.case.response.depths, mean_over=length or MATERIAL_LENGTH, loads=self.loaded.read_wheels
        )

    def result(self, group: str) -> BaseResult | None:
        """The result of a group, solved if it is not yet; None where no step of the case makes it."""
        if group not in self.results:
            maker = next((step for step in self.steps if group in step.makes), None)
            if maker is not None and maker.name not in self._solved:
                self.solve(maker)
        return self.results.get(group)

    def solve(self, step: Step) -> dict[str, BaseResult]:
        """The results of a step by their groups. Raises InputError for what is not a result."""
        for group in step.after:
            self.result(group)
        outcome = step.solve(self)
        self._solved.add(step.name)
        several = outcome or {} if outcome is None or isinstance(outcome, Mapping) else {step.makes[0]: outcome}
        results: dict[str, BaseResult] = dict(several)
        for group, result in results.items():
            if not isinstance(result, BaseResult):
                raise InputError(
                    f"the step {step.name!r} of {STEPS.find(step.name).package} must return a result, got "
                    f"{type(result).__name__} for {group!r}; return an object of treadload.composing.BaseResult"
                )
        self.results |= results
        return results


def stream(scene: Scene) -> Iterator[tuple[str, BaseResult]]:
    """Name and result of every step of a case, in order of dependence, each as soon as it is solved.

    Raises the errors of reading and of the solvers.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> scene = tl.steps.Scene(case, options=tl.steps.Options(leave_out=("response", "slices")))
    >>> [f"{name}: {result.area * 1e4:.0f} cm²" for name, result in tl.steps.stream(scene)]
    ['contact: 10 cm²']
    """
    for step in scene.steps:
        if step.name not in scene._solved:
            yield from scene.solve(step).items()
        else:
            yield from ((group, scene.results[group]) for group in step.makes if group in scene.results)


def group_names() -> tuple[str, ...]:
    """Groups of the results of all steps, in the order in which a file holds them."""
    return tuple(dict.fromkeys(group for name in STEPS.built_in() for group in step_class(name).makes))
