"""How a history of contacts is solved: keywords that its verbs share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

from treadload.contact.bodies.choose import RoadCompliance
from treadload.contact.solvers.coupling import Progress


class NumericsKeys(TypedDict, total=False):
    """The fields of `Numerics`, as keywords of the verbs."""

    tolerance: float
    road_compliance: RoadCompliance
    progress: Progress | None


@dataclass(frozen=True)
class Numerics:
    """How a contact is solved beside tire, road and rolling, as `solve_contact` explains it.

    tolerance: of the conditions of contact, relative. road_compliance: of the road, as `solve_contact` takes it.
    progress: called with a line of text at every stage.
    """

    tolerance: float = 1e-6
    road_compliance: RoadCompliance = "half_space"
    progress: Progress | None = None

    def tell(self, text: str) -> None:
        """Pass a line on to whoever listens."""
        if self.progress is not None:
            self.progress(text)
