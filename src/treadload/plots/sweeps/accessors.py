"""What `.plot` of studies of many cases offers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.accessors import offers
from treadload.plots.kit.offered import Figures
from treadload.plots.sweeps.curves import study_curve, study_curves, study_slip_curve
from treadload.plots.sweeps.maps import study_map, study_multiples
from treadload.plots.sweeps.screening import morris_effects, sobol_bars, tornado_bars


@offers("plot", "Sweep")
class SweepPlots(Figures):
    """Figures of a study of many cases. at: name → value of what else is varied, SI; left out, the middle one."""

    def curve(
        self,
        of: str,
        against: str = "",
        *,
        by: str | None = None,
        at: Mapping[str, Any] | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """A result against an input, a line for each value of another, or of a dimension such as depth."""
        return study_curve(self._result, of, against, by=by, at=at, ax=ax)

    def curves(
        self,
        of: Sequence[str] = (),
        against: str = "",
        *,
        by: str | None = None,
        at: Mapping[str, Any] | None = None,
    ) -> Figure:
        """Panels of curves: several results against one input."""
        return study_curves(self._result, of, against, by=by, at=at)

    def slip_curve(
        self, *, by: str | None = None, at: Mapping[str, Any] | None = None, ax: Axes | None = None
    ) -> Figure:
        """Shear force over friction times load against creepage, of a study that varies one of them."""
        return study_slip_curve(self._result, by=by, at=at, ax=ax)

    def map(
        self, of: str, x: str = "", y: str = "", *, at: Mapping[str, Any] | None = None, ax: Axes | None = None
    ) -> Figure:
        """A result over two inputs, in colour."""
        return study_map(self._result, of, x, y, at=at, ax=ax)

    def multiples(self, of: str, across: str = "", down: str = "", *, at: Mapping[str, Any] | None = None) -> Figure:
        """A field of every case in plan, small maps on one scale."""
        return study_multiples(self._result, of, across, down, at=at)


@offers("plot", "Tornado")
class TornadoPlots(Figures):
    """Figures of a tornado."""

    main = "tornado"

    def tornado(self, *, ax: Axes | None = None) -> Figure:
        """Bars from the base case to both ends of every input."""
        return tornado_bars(self._result, ax=ax)


@offers("plot", "Sobol")
class SobolPlots(Figures):
    """Figures of Sobol indices."""

    main = "sobol"

    def sobol(self, *, ax: Axes | None = None) -> Figure:
        """First-order and total indices with their intervals."""
        return sobol_bars(self._result, ax=ax)


@offers("plot", "Morris")
class MorrisPlots(Figures):
    """Figures of a Morris screening."""

    main = "morris"

    def morris(self, *, ax: Axes | None = None) -> Figure:
        """Spread of the effects of every input against their mean size."""
        return morris_effects(self._result, ax=ax)
