"""A step of a case in one file: its table, its result, its rows and its figure.

A case that has

    [carrying]
    share = 0.5

then has the length that carries a share of the load, in its summary, report, file and studies, and on the page.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from treadload.composing import BaseResult, Source
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.plots import new_figure
from treadload.plots.kit.style import styled
from treadload.rows import Row, row
from treadload.steps import Scene, Step
from treadload.units import Share
from treadload.variables import Display

LENGTH = Display("carrying length", "mm", ".0f")


@dataclass(frozen=True, eq=False, repr=False)
class CarryingLength(BaseResult, group="carrying"):
    """How much of the contact's length carries a share of the load."""

    title: ClassVar[str] = "Carrying length"
    dataset: xr.Dataset

    def rows(self) -> tuple[Row, ...]:
        """The length, and the share that it carries."""
        share = float(self.dataset.attrs["share"])
        return (row("carrying_length", float(self.dataset["carrying_length"]), display=LENGTH,
                    note=f"{100 * share:g} % of the load"),)  # fmt: skip


class CarryingStep(Step, name="carrying"):
    """`[carrying]`: the length along travel that carries a share of the load.

    share: of the load, in (0, 1).
    """

    after: ClassVar = ("contact",)
    swept: ClassVar = True

    share: Share = 0.5

    def check(self, case: object) -> None:
        """Refuse what is no share."""
        if not 0 < self.share < 1:
            raise InputError(f"carrying.share must lie in (0, 1), got {self.share:g}; 0.5 is the default")

    @property
    def is_quick(self) -> bool:
        """True: the page solves it at once."""
        return True

    def solve(self, scene: Scene) -> CarryingLength:
        """Columns of the contact, the most loaded first, until they carry the share."""
        data = scene.result("contact").dataset
        columns = data["pressure"].sum("y")
        carried = np.cumsum(np.sort(columns.to_numpy())[::-1]) / float(columns.sum())
        count = int(np.searchsorted(carried, self.share)) + 1
        fields = {"carrying_length": count * float(data.attrs["dx"]), "line_pressure": columns * data.attrs["dy"]}
        return CarryingLength(xr.Dataset(fields, attrs={"share": self.share}))


@figure("CarryingLength", name="line", title="Load along travel", caption="Load per length.", main=True)
@styled
def line(result: Source) -> Figure:
    """Load per length along travel, kN/m."""
    data = result if isinstance(result, xr.Dataset) else result.dataset
    drawing = new_figure(6, 3)
    axes = drawing.subplots()
    axes.plot(data["x"] * 1e3, data["line_pressure"] / 1e3)
    axes.set(xlabel="x along travel, mm", ylabel="load per length, kN/m")
    return drawing
