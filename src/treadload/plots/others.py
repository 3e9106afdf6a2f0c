"""What `.plot` of lives, bonds, curves, comparisons and of fields of any kind offers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.accessors import offers
from treadload.composing import Source, dataset_of
from treadload.plots.calibration import calibration_fit, calibration_numbers
from treadload.plots.climate import day_temperatures, season_moduli
from treadload.plots.crossing import crossing_contacts, crossing_history
from treadload.plots.curve import creep_curves
from treadload.plots.design import design_thicknesses
from treadload.plots.equivalents import standard_axles
from treadload.plots.footprint import comparison_cuts, comparison_maps, rib_shares
from treadload.plots.growth import crack_depth, crack_intensity
from treadload.plots.history import transient_history, turn_history
from treadload.plots.indentation import indentation
from treadload.plots.interface import bond_utilisation, bonded_and_parted
from treadload.plots.kit.offered import Figures
from treadload.plots.life import life_damage, life_inputs, life_shares, life_years
from treadload.plots.passes import drum_contact, plastic_strain, residual_stress, rut_profile
from treadload.plots.plain import losses, plain_map
from treadload.plots.reliability import reliability_inputs, reliability_years
from treadload.plots.ruts import life_rut
from treadload.plots.stones import stones_in_mortar
from treadload.plots.texture import enveloped_pressure, texture_contact
from treadload.plots.tire_card import tire_card
from treadload.plots.uniform import uniform_comparison
from treadload.plots.works import life_works


@offers("plot", "Life")
class LifePlots(Figures):
    """Figures of a life."""

    main = "years"

    def years(self, *, ax: Axes | None = None) -> Figure:
        """Years by criterion, with the design life."""
        return life_years(self._result, ax=ax)

    def damage(self, *, ax: Axes | None = None) -> Figure:
        """Damage across the wheel path, by criterion."""
        return life_damage(self._result, ax=ax)

    def shares(self, criterion: str | None = None) -> Figure:
        """Who does the damage, and when: classes of axles by seasons."""
        return life_shares(self._result, criterion)

    def works(self) -> Figure:
        """Polishing by class of axles, and tearing by class and season."""
        return life_works(self._result)

    def rut(self) -> Figure:
        """Rut against years, layer on layer, with its limit."""
        return life_rut(self._result)

    def temperatures(self, months: Sequence[int] = (1, 4, 7, 10)) -> Figure:
        """Temperature over depth and hour on the mean day of months, below a weather. months: January is 1."""
        return day_temperatures(self._result, months)

    def moduli(self) -> Figure:
        """Temperature and modulus over depth in the coldest and the warmest season, old and young."""
        return season_moduli(self._result)


@offers("plot", "Indentation")
class IndentationPlots(Figures):
    """Figures of a body pressed into a road that yields."""

    main = "dent"

    def dent(self) -> Figure:
        """Pressure and dent on a line through the middle, step by step."""
        return indentation(self._result)


@offers("plot", "Passes")
class PassesPlots(Figures):
    """Figures of passes over a road that yields."""

    main = "rut"

    def rut(self, *, ax: Axes | None = None) -> Figure:
        """Shape of the surface across travel, pass by pass."""
        return rut_profile(self._result, ax=ax)

    def drum(self) -> Figure:
        """Of a drum on its track: pressure along travel, and how deep it stands, pass by pass."""
        return drum_contact(self._result)

    def strain(self, *, ax: Axes | None = None) -> Figure:
        """Accumulated plastic strain in a section across travel, %."""
        return plastic_strain(self._result, ax=ax)

    def stress(
        self, component: Literal["xx", "yy", "zz"] = "xx", *, y: float = 0.0, ax: Axes | None = None
    ) -> Figure:
        """Residual stress against depth below a line y, m, pass by pass."""
        return residual_stress(self._result, component, y=y, ax=ax)


@offers("plot", "Heterogeneous")
class HeterogeneousPlots(Figures):
    """Figures of a window of mortar with stones."""

    main = "section"

    def section(self, *, along: Literal["travel", "across"] = "across", at: float | None = None) -> Figure:
        """Largest tension in a vertical section with stones and without, and how it is spread. at: m."""
        return stones_in_mortar(self._result, along=along, at=at)


@offers("plot", "TextureContact")
class TexturePlots(Figures):
    """Figures of rubber on a texture."""

    main = "patch"

    def patch(self) -> Figure:
        """Texture, pressure on its peaks, area against mean pressure, and which pressures carry the load."""
        return texture_contact(self._result)


@offers("plot", "Enveloped")
class EnvelopedPlots(Figures):
    """Figures of an enveloped pressure."""

    main = "pressure"

    def pressure(self, before: Source | None = None) -> Figure:
        """The enveloped pressure in plan. before: the contact itself, to be drawn beside it on its own scale."""
        return enveloped_pressure(self._result, before)


@offers("plot", "Sensitivity")
class SensitivityPlots(Figures):
    """Figures of a sensitivity."""

    main = "inputs"

    def inputs(self, *, ax: Axes | None = None, most: int = 10) -> Figure:
        """Change of the life as each input grows by 5 %."""
        return life_inputs(self._result, ax=ax, most=most)


@offers("plot", "ThicknessDesign")
class ThicknessDesignPlots(Figures):
    """Figures of a design."""

    main = "lives"

    def lives(self, *, ax: Axes | None = None) -> Figure:
        """Years by criterion against the thickness that was looked for."""
        return design_thicknesses(self._result, ax=ax)


@offers("plot", "Equivalents")
class EquivalentsPlots(Figures):
    """Figures of a traffic in standard axles."""

    main = "axles"

    def axles(self, *, ax: Axes | None = None) -> Figure:
        """What one passage of each class does, in standard axles, by criterion."""
        return standard_axles(self._result, ax=ax)


@offers("plot", "Reliability")
class ReliabilityPlots(Figures):
    """Figures of a reliability."""

    main = "years"

    def years(self, *, ax: Axes | None = None) -> Figure:
        """Probability of failure against years, by criterion."""
        return reliability_years(self._result, ax=ax)

    def inputs(self, *, ax: Axes | None = None) -> Figure:
        """What the scatter of each criterion is made of."""
        return reliability_inputs(self._result, ax=ax)


@offers("plot", "Growth")
class GrowthPlots(Figures):
    """Figures of a crack that grows."""

    main = "depth"

    def depth(self, *, ax: Axes | None = None) -> Figure:
        """Depth of the first crack against years, with what scatters."""
        return crack_depth(self._result, ax=ax)

    def intensity(self) -> Figure:
        """Range of the stress intensity against depth, by class of axles and mode."""
        return crack_intensity(self._result)


@offers("plot", "BondVerdict")
class BondVerdictPlots(Figures):
    """Figures of a verdict on bonds."""

    main = "utilisation"

    def utilisation(self, *, contact: Source | None = None) -> Figure:
        """Utilisation of the bond of every interface, in plan."""
        return bond_utilisation(self._result, contact=contact)


@offers("plot", "BondComparison")
class BondComparisonPlots(Figures):
    """Figures of a road with its bond and without."""

    main = "lives"

    def lives(self) -> Figure:
        """Lives by criterion: bonded, debonded, bonded until the bond fails."""
        return bonded_and_parted(self._result)


@offers("plot", "FootprintComparison")
class FootprintComparisonPlots(Figures):
    """Figures of a computed contact beside a measured footprint."""

    main = "maps"

    def maps(self) -> Figure:
        """Both maps as the sensor tells them on one scale, and their difference, kPa."""
        return comparison_maps(self._result)

    def cuts(self, *, x: float | None = None, y: float | None = None) -> Figure:
        """Both pressures along travel at y, m, and across it at x, m; through the heaviest rib if left out; kPa."""
        return comparison_cuts(self._result, x=x, y=y)

    def ribs(self, *, ax: Axes | None = None) -> Figure:
        """Share of the load on each rib, %."""
        return rib_shares(self._result, ax=ax)


@offers("plot", "CreepCurve")
class CreepCurvePlots(Figures):
    """Figures of a creep curve."""

    main = "forces"

    def forces(self, *, along: str = "") -> Figure:
        """Force and slip against creepage. along: "x" or "y"; left out, that of the curve."""
        given = along or str(getattr(self._result, "along", "")) or _direction(dataset_of(self._result))
        return creep_curves([self._result], [f"along {given}"], along=given)


def _direction(data: object) -> str:
    """Along which the creepage of a curve was prescribed."""
    values = data["creepage_y"].to_numpy() if "creepage_y" in data else ()  # type: ignore[index, operator]
    return "y" if len(values) and bool((abs(values - data["creepage"].to_numpy()) < 1e-12).all()) else "x"  # type: ignore[index]


@offers("plot", "UniformComparison")
class UniformPlots(Figures):
    """Figures of a contact beside uniform loads."""

    main = "strains"

    def strains(self) -> Figure:
        """Largest strains over depth, a line for each load."""
        return uniform_comparison(self._result)


@offers("plot", "TireCard")
class TireCardPlots(Figures):
    """Figures of a tire card."""

    main = "card"

    def card(self) -> Figure:
        """Deflection, footprint, load of the shoulders and slip stiffnesses over load."""
        return tire_card(self._result)


@offers("plot", "TransientResult")
class TransientPlots(Figures):
    """Figures of rolling from rest."""

    main = "history"

    def history(self) -> Figure:
        """Forces and slip against the distance rolled."""
        return transient_history(self._result)


@offers("plot", "Crossing")
class CrossingPlots(Figures):
    """Figures of a wheel over an obstacle."""

    main = "history"

    def history(self) -> Figure:
        """Pressures, shares of the load and work along the way."""
        return crossing_history(self._result)

    def contacts(self) -> Figure:
        """A strip of contacts."""
        return crossing_contacts(self._result)


@offers("plot", "TurnResult")
class TurnPlots(Figures):
    """Figures of a turn on the spot."""

    main = "history"

    def history(self) -> Figure:
        """Torque and slip against the angle."""
        return turn_history(self._result)


@offers("plot", "Calibration")
class CalibrationPlots(Figures):
    """Figures of a calibration; those of its footprints are `calibration.comparisons[0].plot`."""

    main = "fit"

    def fit(self) -> Figure:
        """Data against the fitted tire, and the residuals of all readings."""
        return calibration_fit(self._result)

    def numbers(self) -> Figure:
        """How sure the numbers are, and which go together."""
        return calibration_numbers(self._result)


@offers("plot", "RollingResistance")
class RollingResistancePlots(Figures):
    """Figures of rolling resistance."""

    main = "losses"

    def losses(self, *, ax: Axes | None = None) -> Figure:
        """What resists, beside what the materials lose."""
        return losses(self._result, ax=ax)


@offers("plot", "Fields")
class FieldsPlots(Figures):
    """Figures of fields of any kind."""

    def map(self, name: str, *, depth: float | None = None, ax: Axes | None = None) -> Figure:
        """A variable in plan. depth: m, of fields over several depths; left out, the first."""
        return plain_map(self._result, name, depth=depth, ax=ax)
