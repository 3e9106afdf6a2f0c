"""What `contact.plot`, `response.plot` and `verdict.plot` offer; those of other results are in `others`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.accessors import offers
from treadload.composing import Source
from treadload.plots import contact as contact_figures
from treadload.plots import panels
from treadload.plots import profile as profiles
from treadload.plots import response as response_figures
from treadload.plots import rose as roses
from treadload.plots import verdict as verdict_figures
from treadload.plots.interactive import LinkedView, contact_view, response_view, verdict_view
from treadload.plots.kit.offered import Figures
from treadload.plots.response import Strain


@offers("plot", "Contact", "Footprint")
class ContactPlots(Figures):
    """Figures of a contact, or of its dataset. Each returns a matplotlib Figure but `interactive`, a page."""

    main = "pressure"

    def __init__(self, contact: Source) -> None:
        self._contact = contact

    def pressure(self, *, ax: Axes | None = None) -> Figure:
        """Contact pressure in plan, kPa."""
        return contact_figures.pressure(self._contact, ax=ax)

    def height_map(self, *, ax: Axes | None = None) -> Figure:
        """Separation of tread and road before loading, mm."""
        return contact_figures.height_map(self._contact, ax=ax)

    def stick_slip(self, *, ax: Axes | None = None) -> Figure:
        """Shear in plan with the zones that stick and slip, kPa."""
        return contact_figures.stick_slip(self._contact, ax=ax)

    def shear(self) -> Figure:
        """Shear as a surface in space beside its plan, kPa."""
        return contact_figures.shear(self._contact)

    def profile(self) -> Figure:
        """Pressure and shear along travel and across it, kPa."""
        return contact_figures.profile(self._contact)

    def interactive(self, *, measured: Source | None = None, theme: str = "light") -> LinkedView:
        """Pressure and shear as linked maps, profiles along a line to drag, the tread in space; shows itself.

        measured: a footprint to lay over them. theme: "light" or "dark". `.write_html(path)` keeps it as one file.
        """
        return contact_view(self._contact, measured=measured, theme=theme)


@offers("plot", "Response")
class ResponsePlots(Figures):
    """Figures of a response, or of its dataset. Each returns a matplotlib Figure."""

    main = "strain_directions"

    def __init__(self, response: Source) -> None:
        self._response = response

    def strain_directions(
        self,
        depth: float = 0.0,
        strain: Strain = "principal",
        *,
        contact: Source | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """Largest extension in plan with its directions, microstrain. depth: m."""
        return response_figures.strain_directions(self._response, depth=depth, strain=strain, contact=contact, ax=ax)

    def strain_panels(
        self, depth: float = 0.0, strain: Strain = "principal", *, contact: Source | None = None
    ) -> Figure:
        """Largest extension in plan above, microstrain; its direction below. depth: m."""
        return panels.strain_panels(self._response, depth=depth, strain=strain, contact=contact)

    def depth_slice(
        self,
        along: Literal["travel", "across"] | None = None,
        at: float | None = None,
        *,
        ax: Axes | None = None,
    ) -> Figure:
        """Largest extension in a vertical section under the worst point, microstrain. at: y or x, m."""
        return response_figures.depth_slice(self._response, along=along, at=at, ax=ax)

    def profile(
        self, strain: Strain = "principal", *, epsilon_6: float | None = None, ax: Axes | None = None
    ) -> Figure:
        """Strain against depth under the worst point, microstrain."""
        return profiles.profile(self._response, strain=strain, epsilon_6=epsilon_6, ax=ax)

    def strain_profiles(
        self,
        places: Mapping[str, tuple[float, float]] | None = None,
        *,
        strains: Sequence[profiles.Component] = ("xx", "yy", "principal"),
        contact: Source | None = None,
        epsilon_6: float | None = None,
    ) -> Figure:
        """Strains against depth under the tire's centre, a rib's middle and edge, or places given, microstrain."""
        return profiles.strain_profiles(self._response, places, strains=strains, contact=contact, epsilon_6=epsilon_6)

    def interactive(self, *, contact: Source | None = None, theme: str = "light") -> LinkedView:
        """Largest extension and its directions depth by depth, profiles along a line to drag; shows itself.

        contact: gives the outline. theme: "light" or "dark". `.write_html(path)` keeps it as one file.
        """
        return response_view(self._response, contact=contact, theme=theme)


@offers("plot", "Verdict")
class VerdictPlots(Figures):
    """Figures of a verdict, or of its dataset. Each returns a matplotlib Figure."""

    main = "passes"

    def __init__(self, verdict: Source) -> None:
        self._verdict = verdict

    def fatigue_line(self, *, design_passes: float | None = None, ax: Axes | None = None) -> Figure:
        """The fatigue line with the worst strain on it."""
        return verdict_figures.fatigue_line(self._verdict, design_passes=design_passes, ax=ax)

    def passes(self, *, ax: Axes | None = None) -> Figure:
        """Allowable passes in plan, logarithmic."""
        return verdict_figures.passes(self._verdict, ax=ax)

    def cracks(self, *, ax: Axes | None = None) -> Figure:
        """Traces of the cracks to expect, coloured by orientation."""
        return verdict_figures.cracks(self._verdict, ax=ax)

    def rose(self, *, threshold: float | None = None, classes: int = 18) -> Figure:
        """Rose of the cracks' traces, by area of road beyond a threshold of strain, a fifth of the largest."""
        return roses.rose_of(self._verdict, threshold=threshold, classes=classes)

    def interactive(self, *, theme: str = "light") -> LinkedView:
        """Damage with the traces of cracks beside the extension that was read, linked; shows itself."""
        return verdict_view(self._verdict, theme=theme)
