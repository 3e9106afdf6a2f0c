"""The results of a case in a study, each solved when something of it is first asked for."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from treadload.case import Case
from treadload.case.step import Source, step_classes
from treadload.contact import Contact
from treadload.deferred import xarray as xr
from treadload.life.contacts import Contacts
from treadload.steps.loaded import Touch, contact_of
from treadload.steps.scene import Options, Scene
from treadload.sweeps.record import Values


def parts_of(case: Case) -> tuple[str, ...]:
    """Groups of the results that cases of the same source can have."""
    kinds = [kind for kind in step_classes(case.model_fields_set) if not issubclass(kind, Source)]
    groups = list(case.source.makes)
    while reached := [kind for kind in kinds if set(groups).issuperset(kind.after)]:
        groups += [group for kind in reached for group in kind.makes]
        kinds = [kind for kind in kinds if kind not in reached]
    return tuple(dict.fromkeys(groups))


class Parts:
    """Results of one case of a study.

    contact: of it, where it is known already. touch: solves the contacts of the case. contacts: of its service life,
    shared with other cases. leave_out: names of steps that are not solved.
    """

    def __init__(
        self,
        case: Case,
        *,
        contact: Contact | None = None,
        touch: Touch = contact_of,
        contacts: Contacts | None = None,
        leave_out: tuple[str, ...] = (),
    ) -> None:
        options = Options(
            leave_out=leave_out, workers=1, contact=contact, touch=touch, contacts=contacts, only_numbers=True
        )
        self.scene = Scene(case, options=options)
        self._kept = [step for step in self.scene.steps if step.swept]
        self._numbers: xr.Dataset | None = None

    @property
    def searched(self) -> tuple[str, ...]:
        """Groups in which a name without one is looked for, in this order."""
        return tuple(group for step in self._kept for group in step.makes)

    def dataset(self, part: str) -> xr.Dataset | None:
        """The fields of a part; None where the case has none."""
        result = self.scene.result(part)
        return None if result is None else result.dataset

    @property
    def _all(self) -> xr.Dataset:
        if self._numbers is None:
            data = [step.numbers(self.scene) for step in self._kept]
            fields = {str(name): field for dataset in data for name, field in dataset.data_vars.items()}
            self._numbers = xr.Dataset(fields)
        return self._numbers

    def numbers(self) -> Mapping[str, Values]:
        """What is kept of every case."""
        return {
            str(name): (tuple(map(str, field.dims)), field.to_numpy()) for name, field in self._all.data_vars.items()
        }

    def coordinates(self) -> Mapping[str, np.ndarray]:
        """Coordinates of the numbers."""
        return {
            str(name): coordinate.to_numpy()
            for name, coordinate in self._all.coords.items()
            if name in self._all.dims
        }

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, of the results that were solved, each once."""
        scene = self.scene
        results = list(scene.results.values())
        means = [scene.means] if "means" in vars(scene) else []
        return tuple(
            dict.fromkeys(text for result in (*results[:1], *means, *results[1:]) for text in result.warnings)
        )
