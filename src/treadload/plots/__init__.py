"""Figures of contact, response and verdict: functions of datasets that return a matplotlib Figure."""

from treadload.plots import interactive as interactive
from treadload.plots.backcalculation import fitted_basins, moduli_along
from treadload.plots.bowl import deflection_bowl
from treadload.plots.calibration import calibration_fit, calibration_numbers
from treadload.plots.climate import day_temperatures, season_moduli
from treadload.plots.compare import compare_pressure, compare_strain
from treadload.plots.contact import height_map, pressure, shear, stick_slip
from treadload.plots.crossing import crossing_contacts, crossing_history
from treadload.plots.curve import creep_curves
from treadload.plots.design import design_thicknesses
from treadload.plots.energy import dissipated_energy
from treadload.plots.equivalents import standard_axles
from treadload.plots.field import (
    field_look_shares,
    field_power,
    field_shares,
    field_survivors,
    field_transform,
    field_years_range,
)
from treadload.plots.first import first_places
from treadload.plots.first_crack import first_crack
from treadload.plots.footprint import comparison_cuts, comparison_maps, rib_shares
from treadload.plots.fringes import fringe_scan
from treadload.plots.frost import frost_months
from treadload.plots.growth import crack_depth, crack_intensity
from treadload.plots.history import transient_history, turn_history
from treadload.plots.indentation import indentation
from treadload.plots.interface import bond_utilisation, bonded_and_parted, sliding
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.files import png, raster, save
from treadload.plots.kit.layers import both_sides
from treadload.plots.kit.places import places_under
from treadload.plots.life import life_damage, life_inputs, life_shares, life_years
from treadload.plots.material import black_diagram, cole_cole, master_curve, shift_factors
from treadload.plots.network import network_due, network_stations
from treadload.plots.panels import strain_panels
from treadload.plots.passes import drum_contact, plastic_strain, residual_stress, rut_profile, shakedown_map
from treadload.plots.pitch import pitch_history, pitch_maps, pitch_strains
from treadload.plots.plain import losses, plain_map
from treadload.plots.profile import strain_profiles
from treadload.plots.reliability import reliability_inputs, reliability_years
from treadload.plots.remedies import remedy_tornado
from treadload.plots.response import depth_slice, strain_directions
from treadload.plots.rib_shear import rib_shear
from treadload.plots.roads import compare_roads, compare_temperatures
from treadload.plots.rose import orientation_shares, trace_rose
from treadload.plots.ruts import life_rut
from treadload.plots.stones import stones_in_mortar
from treadload.plots.sweeps.curves import study_curve, study_curves, study_slip_curve
from treadload.plots.sweeps.maps import study_map, study_multiples
from treadload.plots.sweeps.screening import morris_effects, sobol_bars, tornado_bars
from treadload.plots.tearing import tearing
from treadload.plots.texture import enveloped_pressure, texture_contact
from treadload.plots.tir_fit import tir_fit
from treadload.plots.tire_card import tire_card
from treadload.plots.uniform import uniform_comparison
from treadload.plots.verdict import cracks, fatigue_line
from treadload.plots.wear import tread_wear
from treadload.plots.works import life_works

__all__ = [
    "black_diagram",
    "bond_utilisation",
    "bonded_and_parted",
    "both_sides",
    "calibration_fit",
    "calibration_numbers",
    "cole_cole",
    "compare_pressure",
    "compare_roads",
    "compare_strain",
    "compare_temperatures",
    "comparison_cuts",
    "comparison_maps",
    "crack_depth",
    "crack_intensity",
    "cracks",
    "creep_curves",
    "crossing_contacts",
    "crossing_history",
    "day_temperatures",
    "deflection_bowl",
    "depth_slice",
    "design_thicknesses",
    "dissipated_energy",
    "drum_contact",
    "enveloped_pressure",
    "fatigue_line",
    "field_look_shares",
    "field_power",
    "field_shares",
    "field_survivors",
    "field_transform",
    "field_years_range",
    "first_crack",
    "first_places",
    "fitted_basins",
    "fringe_scan",
    "frost_months",
    "height_map",
    "indentation",
    "life_damage",
    "life_inputs",
    "life_rut",
    "life_shares",
    "life_works",
    "life_years",
    "losses",
    "master_curve",
    "moduli_along",
    "morris_effects",
    "network_due",
    "network_stations",
    "new_figure",
    "orientation_shares",
    "pitch_history",
    "pitch_maps",
    "pitch_strains",
    "places_under",
    "plain_map",
    "plastic_strain",
    "png",
    "pressure",
    "raster",
    "reliability_inputs",
    "reliability_years",
    "remedy_tornado",
    "residual_stress",
    "rib_shares",
    "rib_shear",
    "rut_profile",
    "save",
    "season_moduli",
    "shakedown_map",
    "shear",
    "shift_factors",
    "sliding",
    "sobol_bars",
    "standard_axles",
    "stick_slip",
    "stones_in_mortar",
    "strain_directions",
    "strain_panels",
    "strain_profiles",
    "study_curve",
    "study_curves",
    "study_map",
    "study_multiples",
    "study_slip_curve",
    "tearing",
    "texture_contact",
    "tir_fit",
    "tire_card",
    "tornado_bars",
    "trace_rose",
    "transient_history",
    "tread_wear",
    "turn_history",
    "uniform_comparison",
]
