"""What a remedy is: a changed design, or why a change does not apply; and all of them for a design."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from treadload.life.design import Design
from treadload.life.remedy.steps import Kind, RemedySteps


@dataclass(frozen=True)
class Remedy:
    """A change of a design by one step.

    name: in words, "2 cm more EB-GB3". kind: of change. design: changed. layer: number of the layer that changed,
    None for a change of the traffic. same_responses: True where the evaluated values of the life stay, so that only
    Miner's sum is new. remark: a sentence for the user, or empty.
    """

    name: str
    kind: Kind
    design: Design
    layer: int | None = None
    same_responses: bool = False
    remark: str = ""


@dataclass(frozen=True)
class NotApplicable:
    """A change that a design does not allow. name: of the change. reason: a sentence without its end."""

    name: str
    reason: str

    def __str__(self) -> str:
        return f"{self.name}: {self.reason}"


Change = Remedy | NotApplicable
Changes = Callable[[Design, RemedySteps], Iterable[Change]]


def changes_of(
    design: Design, steps: RemedySteps, by_kind: Mapping[Kind, Changes]
) -> tuple[list[Remedy], list[NotApplicable]]:
    """Remedies of a design, and changes that it does not allow. by_kind: what makes those of a kind."""
    changes = [change for kind in steps.kinds for change in by_kind[kind](design, steps)]
    return (
        [change for change in changes if isinstance(change, Remedy)],
        [change for change in changes if isinstance(change, NotApplicable)],
    )
