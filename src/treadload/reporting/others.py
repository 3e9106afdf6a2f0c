"""Results without a table of their own in a report: their summary, and the figures that their class offers."""

from __future__ import annotations

import re
from dataclasses import dataclass

from treadload.plots import (
    BondComparisonPlots,
    BondVerdictPlots,
    CalibrationPlots,
    ContactPlots,
    CreepCurvePlots,
    CrossingPlots,
    EnvelopedPlots,
    EquivalentsPlots,
    FieldsPlots,
    FootprintComparisonPlots,
    GrowthPlots,
    HeterogeneousPlots,
    IndentationPlots,
    LifePlots,
    MorrisPlots,
    PassesPlots,
    ReliabilityPlots,
    RollingResistancePlots,
    SensitivityPlots,
    SobolPlots,
    TexturePlots,
    ThicknessDesignPlots,
    TireCardPlots,
    TornadoPlots,
    TransientPlots,
    TurnPlots,
    UniformPlots,
    WearPlots,
)
from treadload.reporting.inputs import NamedTable
from treadload.reporting.pictures import Picture, picture
from treadload.reporting.reading import Other, summary_of
from treadload.reporting.studies import study_pictures, study_tables

HEADINGS = {
    "calibration": "Calibration of the tire",
    "bonds": "Bonds between layers",
    "bond_comparison": "Road with and without its bond",
    "comparison": "Computed and measured footprint",
    "creep_curve": "Creep curve",
    "growth": "A crack that grows",
    "crossing": "A wheel over an obstacle",
    "indentation": "Indentation",
    "texture": "Rubber on texture",
    "enveloped": "Enveloped pressure",
    "sensitivity": "What the life depends on",
    "equivalents": "Standard axles and equivalent temperature",
    "design": "Design of a thickness",
    "reliability": "Years with a probability",
    "transient": "Rolling from rest",
    "turn": "Turn on the spot",
    "tire_card": "Tire card",
    "uniform": "Contact and uniform loads",
    "rolling_resistance": "Rolling resistance",
    "points": "Response at points",
    "fields": "Fields",
    "heterogeneous": "Stones in mortar",
    "sweep": "Study",
    "tornado": "Tornado",
    "sobol": "Sobol indices",
    "morris": "Morris screening",
    "passes": "Passes over a road that yields",
    "wear": "Wear of a tread since an earlier scan",
}


# Two wide gaps in a line make it one of a table.
_COLUMNS = re.compile(r"\S\s{3,}\S.*\S {3,}\S")


@dataclass(frozen=True)
class OtherReport:
    """A result under its heading. text: its summary. tables: of what figures do not tell."""

    heading: str
    pictures: tuple[Picture, ...]
    text: str
    tables: tuple[NamedTable, ...] = ()

    @property
    def in_columns(self) -> bool:
        """True where lines of the summary stand below each other in columns, which wrapping would tear apart."""
        return bool(_COLUMNS.search(self.text))


def other_report(other: Other) -> OtherReport:
    """What a report says of a result without a table."""
    named = HEADINGS.get(other.kind, other.kind.replace("_", " "))
    heading = named if other.name == other.kind else f"{named}: {other.name}"
    tables = study_tables(other.dataset) if other.kind == "sweep" else ()
    return OtherReport(heading, tuple(_pictures(other)), summary_of(other.dataset), tables)


def _pictures(other: Other) -> list[Picture]:
    data, inside = other.dataset, other.inside
    match other.kind:
        case "bonds":
            caption = "Share of the strength that the load uses up; arrows: shear of the upper layer on the lower."
            return picture("Utilisation of the bonds", caption, BondVerdictPlots(data).utilisation, wide=True)
        case "bond_comparison":
            caption = "Life by every criterion with the bond, without it, and with it until it fails."
            return picture("Life with and without the bond", caption, BondComparisonPlots(data).lives, wide=True)
        case "calibration":
            fitted = CalibrationPlots(data)
            drawn = picture(
                "Data and fitted tire",
                "Dots: measured, lines: fitted; residuals are counted in standard deviations of the readings.",
                fitted.fit,
                wide=True,
            )
            drawn += picture(
                "Numbers and their error bars",
                "95 % intervals of the fitted numbers, and their correlations.",
                fitted.numbers,
                wide=True,
            )
            if "comparison" in inside:
                caption = "Means over the sensels of the sensor, on one scale; red: more was computed than measured."
                beside = FootprintComparisonPlots(inside["comparison"])
                drawn += picture("Computed, measured, and their difference", caption, beside.maps, wide=True)
            return drawn
        case "comparison":
            plots = FootprintComparisonPlots(data)
            drawn = picture(
                "Computed, measured, and their difference",
                "Means over the sensels of the sensor, on one scale; red: more was computed than measured.",
                plots.maps,
                wide=True,
            )
            drawn += picture("Cuts", "Pressure along travel and across it, sensel by sensel.", plots.cuts, wide=True)
            if data.sizes.get("rib", 0) > 1:
                drawn += picture("Ribs", "Share of the load that each rib carries, from left to right.", plots.ribs)
            return drawn
        case "creep_curve":
            caption = "Force over friction times load, and the share of the contact that slips, against creepage."
            return picture("Force against creepage", caption, CreepCurvePlots(data).forces, wide=True)
        case "growth":
            plots_of_growth = GrowthPlots(data)
            caption = (
                "The first crack of the wheel path, from its initiation to the end of its way; the band holds what "
                "scatters in initiation and in growth."
            )
            drawn = picture("Depth of the crack against years", caption, plots_of_growth.depth, wide=True)
            caption = (
                "Range of the stress intensity in a passage at the worst place with no wander, in the season where "
                "it is largest; faces close under pressure and rub."
            )
            return drawn + picture("Stress intensity", caption, plots_of_growth.intensity, wide=True)
        case "indentation":
            caption = "Pressure under the body, and what the surface keeps of it, step by step."
            return picture("Pressure and dent", caption, IndentationPlots(data).dent, wide=True)
        case "texture":
            caption = (
                "A patch that stands for the road: its heights, the pressure on its peaks, how much of it touches, "
                "and which pressures carry the load."
            )
            return picture("Rubber on texture", caption, TexturePlots(data).patch, wide=True)
        case "enveloped":
            caption = "The pressure on peaks, filtered over the enveloping length, with the same load."
            return picture("Enveloped pressure", caption, EnvelopedPlots(data).pressure)
        case "passes":
            plots_of_passes = PassesPlots(data)
            caption = "Displacement of the surface that passes leave, down; the same all along travel."
            drawn = picture("Rut across travel", caption, plots_of_passes.rut, wide=True)
            if "pressure" in data:
                caption = "Pressure along travel below the drum's middle, and its depth below the first surface."
                drawn = picture("Drum on its own track", caption, plots_of_passes.drum, wide=True) + drawn
            if not data["equivalent_plastic_strain"].any():
                return drawn
            drawn += picture(
                "Plastic strain", "Equivalent plastic strain after the last pass.", plots_of_passes.strain, wide=True
            )
            return drawn + picture(
                "Residual stress", "Along travel, below the wheel's line, tension positive.", plots_of_passes.stress
            )
        case "sensitivity":
            caption = "Change of the governing life as each input grows by 5 %, temperature by 1 °C."
            return picture("What the life depends on", caption, SensitivityPlots(data).inputs)
        case "equivalents":
            caption = (
                f"Passes of the standard axle ({data.attrs['standard_axle']}) that do as much damage as one passage "
                "of a class, by every criterion; crosses: by the load alone."
            )
            return picture("In standard axles", caption, EquivalentsPlots(data).axles, wide=True)
        case "design":
            caption = "Years that every criterion lasts with each thickness that was solved, and those asked for."
            return picture("How thick it must be", caption, ThicknessDesignPlots(data).lives, wide=True)
        case "reliability":
            plots_of_reliability = ReliabilityPlots(data)
            caption = "Probability that a criterion has failed by a year; dotted: the first of them."
            drawn = picture("When the road fails", caption, plots_of_reliability.years, wide=True)
            caption = "Share of each input in the scatter of a criterion's years at the smallest risk."
            return drawn + picture("What the years scatter by", caption, plots_of_reliability.inputs, wide=True)
        case "heterogeneous":
            caption = (
                "Largest tension in a section with stones, which are outlined, and of the mortar alone; right: the "
                "share of the mastic, and of the stones' faces, that bears more."
            )
            return picture("Stones in mortar", caption, HeterogeneousPlots(data).section, wide=True)
        case "uniform":
            caption = (
                "Largest strains at every depth under the computed contact and under uniform loads of the same force."
            )
            return picture("What uniform loads miss", caption, UniformPlots(data).strains, wide=True)
        case "tire_card":
            caption = "Deflection, footprint, load of the outer ribs and slip stiffness of the freely rolling tire."
            return picture("What the tire shows", caption, TireCardPlots(data).card, wide=True)
        case "rolling_resistance":
            caption = "The force that resists, and the energy that the materials lose per metre."
            return picture("Rolling resistance", caption, RollingResistancePlots(data).losses)
        case "sweep":
            return study_pictures(data)
        case "tornado":
            caption = "The result with one input at an end of its range, the others as in the base case."
            return picture("Tornado", caption, TornadoPlots(data).tornado, wide=True)
        case "sobol":
            caption = "Share of the variance of the result over the ranges that is due to each input."
            return picture("Sobol indices", caption, SobolPlots(data).sobol, wide=True)
        case "morris":
            caption = "Right: inputs that matter. High: inputs whose effect bends or depends on others."
            return picture("Morris screening", caption, MorrisPlots(data).morris)
        case "wear":
            caption = "Unrolled from the place over the road; across: the tread then and now, and the median wear."
            return picture("Worn off since the earlier scan", caption, WearPlots(data).wear, wide=True)
        case "life":
            return picture("Life by criterion", "Years until the damage is 1.", LifePlots(data).years)
        case "crossing":
            caption = "Peak pressures, shares of the load, and the work that each place of the road takes."
            drawn = picture("Along the way", caption, CrossingPlots(data).history, wide=True)
            drawn += picture("Contacts", "Each where it stands on the road.", CrossingPlots(data).contacts, wide=True)
            return drawn
        case "transient" | "turn":
            history = TransientPlots(data) if other.kind == "transient" else TurnPlots(data)
            what = "distance" if other.kind == "transient" else "angle"
            drawn = picture(
                f"Against the {what}", "Forces, and the share of the contact that slips.", history.history, wide=True
            )
            if "contact" in inside:
                at_end = ContactPlots(inside["contact"])
                drawn += picture("Shear at the end", "Shear in plan; hatched cells slip.", at_end.shear, wide=True)
            return drawn
        case "fields":
            maps = [str(name) for name, field in data.data_vars.items() if {"x", "y"} <= set(field.dims)][:_MOST]
            return [
                one
                for name in maps
                for one in picture(_long(data, name), "In plan.", lambda name=name: FieldsPlots(data).map(name))  # type: ignore[misc]
            ]
    return []


_MOST = 6


def _long(data: object, name: str) -> str:
    return name.replace("_", " ")
