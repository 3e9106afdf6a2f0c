"""Names, units and long names of every variable that a result can hold.

The one place where they are stated; signs are explained in docs/explanation/conventions.md.
x: direction of travel. y: to the right. z: depth, positive down. Tension positive.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from treadload.deferred import xarray as xr
from treadload.units import LASTS, remaining_in_words, repetitions_in_words, stress_in_words, years_in_words

_COORDINATES = {
    "x": ("m", "position along the direction of travel"),
    "y": ("m", "position to the right of travel"),
    "creepage": ("1", "prescribed creepage, along x or y"),
    "trace_angle": ("rad", "middle of a class of trace angles, from travel towards the right"),
    "depth": ("m", "depth below the road surface, positive down"),
    "layer": ("1", "number of the layer that was read at a depth, from the surface, 0 the top one"),
}

_CONTACT = {
    "initial_gap": ("m", "separation before loading"),
    "tread_wear": ("m", "worn off the ribs since an earlier scan, along the radius"),
    "median_tread_wear": ("m", "worn off the ribs since an earlier scan, median round the tire"),
    "tread_height": ("m", "tread over its crown, median round the tire"),
    "earlier_tread_height": ("m", "tread of an earlier scan over the crown of the later one, median round the tire"),
    "groove": ("m", "middle of a groove round the tire, to the right of the middle of the tread"),
    "groove_depth": ("m", "depth of a groove below the ribs beside it"),
    "earlier_groove_depth": ("m", "depth of a groove below the ribs beside it in an earlier scan"),
    "wheel_angle": ("rad", "angle round the wheel, from the road towards travel"),
    "gap": ("m", "separation after loading"),
    "road_height": ("m", "height of the road's surface above its plane, up positive"),
    "pressure": ("Pa", "contact pressure"),
    "traction_x": ("Pa", "shear exerted by the tire on the road along travel"),
    "traction_y": ("Pa", "shear exerted by the tire on the road to the right"),
    "state": ("1", "0 open, 1 stick, 2 slip"),
    "slip_x": ("1", "slip velocity of the tire relative to the road along travel, over rolling speed"),
    "slip_y": ("1", "slip velocity of the tire relative to the road to the right, over rolling speed"),
    "displacement_x": ("m", "displacement of the road along travel"),
    "displacement_y": ("m", "displacement of the road to the right"),
    "displacement_z": ("m", "displacement of the road, down"),
    "approach": ("m", "approach of tire and road"),
    "creepage_x": ("1", "longitudinal creepage (V - ωR)/V, negative when driving"),
    "creepage_y": ("1", "lateral creepage"),
    "spin": ("rad/m", "spin creepage"),
    "normal_load": ("N", "normal load"),
    "tractive_force": ("N", "force of the road on the tire along travel, positive when driving"),
    "lateral_force": ("N", "force of the road on the tire to the right"),
    "aligning_moment": ("N m", "moment of the road on the tire about z through the origin of the grid"),
    "pressure_centre_x": ("m", "centre of pressure ahead of the origin of the grid"),
    "rolling_resistance_moment": ("N m", "moment of the pressure about the axle, positive when it resists rolling"),
    "friction": ("1", "coefficient of friction; where it varies, the mean weighted by pressure"),
    "friction_coefficient": ("1", "local coefficient of friction, zero outside the contact"),
    "friction_work": ("Pa", "work lost by sliding per area of the patch and length travelled, J/m² per m"),
    "friction_work_total": ("N", "work lost by sliding per length travelled, J/m"),
    "friction_power": ("W/m^2", "power lost by sliding per area of the patch"),
    "friction_power_total": ("W", "power lost by sliding"),
    "rolling_resistance": ("N", "force of rolling resistance"),
    "rolling_resistance_coefficient": ("1", "force of rolling resistance over normal load"),
    "material_loss": ("N", "energy lost in the materials per length travelled, J/m"),
    "material_power": ("W", "power lost in the materials"),
    "flash_temperature": ("K", "rise of the interface's temperature by sliding above that of the bodies"),
    "road_share": ("1", "share of the compliance that the road contributes"),
    "layer_share": ("1", "change of the compliance by the layers of the road"),
    "peak_before": ("Pa", "largest contact pressure before it was enveloped"),
    "tractive_force_ratio": ("1", "tractive force over friction times load"),
    "lateral_force_ratio": ("1", "lateral force over friction times load"),
    "mean_tread_wear": ("m", "mean of the median tread wear across the ribs"),
    "largest_tread_wear": ("m", "largest median tread wear across the ribs"),
    "wear_range": ("m", "median tread wear that 95 % of the places stay below less that of 5 %"),
    "datum": ("m", "by which the radii of an earlier scan were lowered so that the grooves agree"),
}

_FRINGES = {
    "row": ("1", "row of a picture, from its top, 0 the first"),
    "column": ("1", "column of a picture, from its left, 0 the first"),
    "gap_deviation": ("m", "standard deviation of the initial gap by noise of the measurement"),
    "fringe_phase": ("rad", "phase of the finest fringes, counted from the edge of the projector"),
    "fringe_modulation": ("1", "half the range of a pixel under the finest fringes, grey levels"),
    "fringe_brightness": ("1", "mean of a pixel under the finest fringes, grey levels"),
    "fringe_height": ("m", "height towards the camera, of the pixels that are kept"),
    "fringe_deviation": ("m", "standard deviation of a pixel's height by noise of the pictures"),
    "kept_pixels": ("1", "share of the pixels that have a height"),
    "pixels_without_steps": ("1", "share of the pixels that were kept without their saturated steps"),
    "grey_noise": ("1", "standard deviation of a grey level by noise"),
    "gamma": ("1", "gamma of camera and projector, found in the fringes"),
    "plane_residual": ("m", "root mean square of the planes of the calibration about it"),
    "deepest_cell": ("m", "largest depth of a cell of a piece of tread below its tops"),
}

_TEXTURE = {
    "mean_pressure": ("Pa", "mean pressure on a patch of texture"),
    "local_pressure": ("Pa", "local pressure on a patch of texture"),
    "texture_height": ("m", "height of a road's texture, up positive"),
    "real_area_ratio": ("1", "share of the area that really touches"),
    "mean_gap": ("m", "mean separation of rubber and texture"),
    "persson_area_ratio": ("1", "share of the area that touches after Persson's theory"),
    "asperity_area_ratio": ("1", "share of the area that touches where asperities do not affect each other"),
    "load_share_above": ("1", "share of the load that is carried by pressures above a local one"),
    "area_share_above": ("1", "share of the area that is under pressures above a local one"),
    "reference_pressure": ("Pa", "mean pressure of the fields on the texture"),
    "real_area": ("m^2", "area of the wheel's contact that really touches the texture"),
    "rms_height": ("m", "root mean square of the height of a texture"),
    "rms_slope": ("1", "root mean square of the slope of a texture"),
}

_CROSSING = {
    "position": ("m", "place of the axle along the road"),
    "road_x": ("m", "place along the road, in the direction of travel"),
    "contact_area": ("m^2", "area of the cells in contact"),
    "edge_pressure": ("Pa", "largest contact pressure within a cell of an edge of the road"),
    "share_before": ("1", "share of the load that the road before the first edge carries"),
    "share_beyond": ("1", "share of the load that the road beyond the last edge carries"),
    "highest_pressure": ("Pa", "largest contact pressure that a place of the road has carried"),
    "plain_pressure": ("Pa", "largest contact pressure on the road without the obstacle"),
    "plain_work": ("J/m^2", "largest closing work on the road without the obstacle"),
    "edge_work": ("J/m^2", "largest closing work within a cell of an edge of the road"),
    "closing_work": ("J/m^2", "work of pressing tread and road together, per area of the road"),
    "friction_work_density": ("J/m^2", "work lost by sliding, per area of the road"),
}

_HISTORY = {
    "step": ("1", "number of the step, 0 before the first"),
    "distance": ("m", "distance rolled since the start"),
    "turn_angle": ("rad", "angle that the wheel has turned about z, positive to the right"),
    "shift_x": ("m", "rigid displacement of the tire along the road over the step, along travel"),
    "shift_y": ("m", "rigid displacement of the tire along the road over the step, to the right"),
    "slip_distance_x": ("m", "slip of the tire relative to the road over the step, along travel"),
    "slip_distance_y": ("m", "slip of the tire relative to the road over the step, to the right"),
    "slip_fraction": ("1", "share of the contact area that slips"),
    "friction_energy": ("J", "energy lost by sliding over the step"),
    "steering_torque": ("N m", "torque about z that turns the wheel against friction"),
    "sliding_torque": ("N m", "torque about z at which the whole contact slides"),
    "turning_stiffness": ("N m/rad", "torque over angle of the first increment of a turn on the spot"),
    "pitch": ("m", "length round the tire after which its blocks repeat"),
    "periodicity": ("1", "largest change of pressure or shear from one pitch to the next, relative"),
    "pole_x": ("m", "point along travel about which the step turned the tire"),
    "pole_y": ("m", "point to the right of travel about which the step turned the tire"),
}

_TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")

_RESPONSE = {
    **{f"stress_{c}": ("Pa", f"stress component {c}, tension positive") for c in _TENSOR},
    **{f"strain_{c}": ("1", f"strain component {c}, extension positive, tensor shear") for c in _TENSOR},
    "largest_principal_strain": ("1", "largest principal strain of a plane, three-dimensional"),
    "largest_in_plane_strain": ("1", "largest principal strain of a plane in the horizontal plane"),
    "principal_strain_1": ("1", "largest principal strain, three-dimensional"),
    "principal_strain_2": ("1", "middle principal strain, three-dimensional"),
    "principal_strain_3": ("1", "smallest principal strain, three-dimensional"),
    "principal_direction_1": ("1", "unit vector of the largest tensile strain"),
    "in_plane_strain_1": ("1", "largest principal strain in the horizontal plane"),
    "in_plane_angle_1": ("rad", "angle of the largest in-plane extension from travel towards the right"),
    "von_mises_stress": ("Pa", "von Mises equivalent stress"),
    "octahedral_shear_stress": ("Pa", "octahedral shear stress"),
    "mean_stress": ("Pa", "mean stress, tension positive"),
    "mazars_strain": ("1", "Mazars equivalent strain, from the tensile strains alone"),
}

_MOVING = {
    "dissipated_energy": (
        "J/m^3",
        "energy per unit volume that one passage of the moving load dissipates, NaN where not computed",
    ),
}

_DAMAGE = {
    "extension_strain": ("1", "largest tensile strain that the criterion reads"),
    "allowable_passes": ("1", "passes that the fatigue line allows at this strain"),
    "crack_angle": ("rad", "angle of the crack's trace on the surface from travel towards the right"),
    "crack_dip": ("rad", "angle of the crack plane from the horizontal, π/2 is vertical"),
    "crack_orientation": ("1", "0 none, 1 longitudinal, 2 transverse, 3 oblique, 4 horizontal"),
    "instant_x": (
        "m",
        "position along travel, in the wheel's frame, at which the tensile strain of a point of the road is largest",
    ),
    "extension_direction": ("1", "unit vector of the largest tensile strain at its worst instant"),
    "trace_share": ("1", "share of the cracks in a class of trace angles"),
    "orientation_share": ("1", "share of the cracks of an orientation"),
    "worst_x": ("m", "position along travel of the largest tensile strain"),
    "worst_y": ("m", "position to the right of travel of the largest tensile strain"),
    "worst_depth": ("m", "depth of the largest tensile strain"),
    "worst_strain": ("1", "largest tensile strain that is evaluated"),
    "strain_ratio": ("1", "largest tensile strain that is evaluated, over that allowed a million times"),
    "coarse_strain": ("1", "largest tensile strain that is evaluated on coarser cells"),
    "worst_passes": ("1", "passes that the fatigue line allows at the largest tensile strain"),
    "worst_crack_angle": ("rad", "crack_angle at the largest tensile strain"),
    "worst_crack_dip": ("rad", "crack_dip at the largest tensile strain"),
    "worst_crack_orientation": ("1", "crack_orientation at the largest tensile strain"),
    "extension_by_depth": ("1", "largest tensile strain that is evaluated at each depth"),
}

_QUANTITIES = {
    "in_plane_extension": ("1", "largest tensile strain in the horizontal plane"),
    "vertical_compression": ("1", "vertical strain, compression positive"),
    "mazars_onset_ratio": ("1", "Mazars equivalent strain over the strain at which damage begins"),
    "von_mises_strain": ("1", "von Mises equivalent strain, √(½ Σ (εᵢ - εⱼ)²)"),
    "distortion_energy": ("J/m^3", "distortion energy per unit volume"),
    "vertical_shear_strain": ("1", "largest engineering shear strain between the vertical and the horizontal"),
    "horizontal_tension": ("Pa", "largest principal stress in the horizontal plane, tension positive"),
    "principal_tension": ("Pa", "largest principal stress in space, tension positive"),
    "tension_behind": ("Pa", "largest horizontal tension of the surface behind the load"),
    "tension_behind_x": ("m", "position along travel of the largest horizontal tension behind the load"),
    **{f"residual_stress_{c}": ("Pa", f"stress component {c} left by earlier passes") for c in _TENSOR},
    "residual_tension": ("Pa", "largest horizontal tension left by earlier passes"),
    "total_tension": ("Pa", "largest horizontal tension of earlier passes and the wheel together"),
}

_PASSES = {
    "pass": ("1", "number of passes"),
    "across": ("m", "place to the right of travel, of the surface"),
    **{f"plastic_strain_{c}": ("1", f"plastic strain component {c}, of the tensor") for c in _TENSOR},
    "equivalent_plastic_strain": ("1", "accumulated equivalent plastic strain"),
    "residual_displacement_z": ("m", "displacement of the surface that passes leave, down positive"),
    "rut_depth": ("m", "largest displacement downwards that passes leave"),
    "heave": ("m", "largest displacement upwards that passes leave"),
    "rut_depth_error": ("m", "error of the rut's depth by cells of twice the size"),
    "peak_plastic_strain": ("1", "largest mean of the equivalent plastic strain over a square"),
    "peak_plastic_strain_error": ("1", "error of the largest mean plastic strain by cells of twice the size"),
    "plastic_increment": ("1", "largest equivalent plastic strain that a pass adds"),
    "plastic_left": ("1", "largest change of plastic strain that a pass leaves"),
    "wheel_offset": ("m", "place of the wheel to the right of its line in a pass"),
    "contact_length": ("m", "length of the contact along travel"),
    "contact_width": ("m", "width of the contact across travel"),
    "contact_area": ("m^2", "area of the cells in contact"),
    "peak_pressure": ("Pa", "largest contact pressure of a cell"),
    "peak_pressure_error": ("Pa", "change of the peak pressure by half as long load steps"),
    "largest_plastic_strain_error": ("1", "change of the largest plastic strain by half as long load steps"),
    "largest_plastic_strain": ("1", "largest accumulated equivalent plastic strain"),
    "shakedown_load": ("1", "largest load that shakes down, over that at first yield without shear"),
    "elastic_limit_load": ("1", "largest load that yields nowhere, over that at first yield without shear"),
    "disc_radius": ("m", "radius of a uniform disc that stands for a contact"),
    "spread_ratio_x": ("1", "spread of the load of discs along travel, over that of the contact"),
    "spread_ratio_y": ("1", "spread of the load of discs across travel, over that of the contact"),
    "disc_overlap": ("1", "largest share of its radius by which a disc reaches over another"),
    "elastic_load_factor": ("1", "part of a load at which a road first yields"),
    "shakedown_load_factor": ("1", "largest part of a load at which a road shakes down"),
}

_UNIFORM = {
    "largest_extension": ("1", "largest principal strain of the plane, three-dimensional"),
    "largest_in_plane_extension": ("1", "largest principal strain of the plane, horizontal"),
    "largest_vertical_shear": ("1", "largest engineering shear strain between the vertical and the horizontal"),
    "largest_vertical_compression": ("1", "largest vertical compression, positive"),
    "largest_horizontal_tension": ("Pa", "largest principal stress of the plane, horizontal"),
    "uniform_pressure": ("Pa", "pressure of the uniform loads"),
    "uniform_area": ("m^2", "area of each uniform load"),
}

_RELIABILITY = {
    "risk": ("1", "probability of failure"),
    "year": ("1", "years from the opening"),
    "years_at_risk": ("1", "years until a criterion has failed with a probability, by draws"),
    "years_at_risk_first_order": ("1", "the same to the first order"),
    "years_error": ("1", "what years_at_risk may err by, by direct solves held back and the number of draws"),
    "risk_factor": ("1", "strain allowed at a risk over that allowed at even odds, k_r, by draws"),
    "failure_probability": ("1", "probability that a criterion has failed by a year, by draws"),
    "failure_probability_first_order": ("1", "the same to the first order"),
    "importance": ("1", "share of an input in the scatter at the smallest risk, α² of the first order"),
    "road_years_at_risk": ("1", "years until any criterion has failed with a probability, by draws"),
    "road_years_error": ("1", "what road_years_at_risk may err by"),
    "road_failure_probability": ("1", "probability that any criterion has failed by a year, by draws"),
    "thickness_slope": ("1/m", "decades that the strain loses per length of thickness"),
    "fatigue_scatter": ("1", "standard deviation of log₁₀ of the passes that a law allows, SN"),
    "law_risk": ("1", "probability of failure that a law has in it"),
    "law_risk_factor": ("1", "k_r that a law has in it"),
    "law_years": ("1", "years by the law as it is"),
    "surface_error": ("1", "relative error of the strain's surface by cross-validation"),
    "coverage": ("1", "share of a criterion's damage in the classes and seasons that were solved again"),
}

_FIELD = {
    "mechanics_years": ("1", "service life at the surface by the mechanics alone"),
    "field_years": ("1", "years by which a share of roads shows the first crack, by a named field shift"),
    "road_share": ("1", "share of roads"),
    "crack_level": ("1", "median age of the first crack, years"),
    "crack_level_low": ("1", "lower end of its 95 % interval, years"),
    "crack_level_high": ("1", "upper end of its 95 % interval, years"),
    "crack_level_error": ("1", "standard error of ln of the median age"),
    "crack_scatter": ("1", "standard deviation of ln of the age over roads"),
    "crack_scatter_low": ("1", "lower end of its 95 % interval"),
    "crack_scatter_high": ("1", "upper end of its 95 % interval"),
    "crack_scatter_error": ("1", "standard error of ln of the scatter"),
    "crack_lag": ("1", "mean years from the first crack to an overlay"),
    "crack_lag_low": ("1", "lower end of its 95 % interval, years"),
    "crack_lag_high": ("1", "upper end of its 95 % interval, years"),
    "crack_lag_error": ("1", "standard error of ln of the lag"),
    "log_score": ("1", "log score on unseen sections, nats"),
    "score_gain": ("1", "log score less that of ages with an overlay lag, nats"),
    "score_gain_error": ("1", "standard error of this difference, of pairs, nats"),
    "cell_age": ("1", "middle of a class of age at a survey, years"),
    "cell_sections": ("1", "sections of a class with a survey in it"),
    "seen_share": ("1", "share of a class that has cracked so far"),
    "predicted_share": ("1", "share of a class predicted by fits that have not seen it"),
    "share_error": ("1", "standard error of the share of a class"),
    "cracked_share": ("1", "share of all roads built that have cracked by an age"),
    "cracked_share_low": ("1", "lower end of its 95 % interval"),
    "cracked_share_high": ("1", "upper end of its 95 % interval"),
    "cracked_share_plain": ("1", "share that has cracked by an age, by the plain fit"),
    "age": ("1", "age of a road, years"),
    "entry_age": ("1", "mean age at the first survey of a class, years"),
    "entry_sections": ("1", "sections of a class of age at entry"),
    "entry_seen": ("1", "share cracked at the first survey"),
    "entry_predicted": ("1", "share cracked at the first survey, by the fit with an overlay lag"),
    "entry_plain": ("1", "share cracked at the first survey, by the plain fit"),
    "entry_level": ("1", "median age by the plain fit of these sections alone, years"),
    "transform_low": ("1", "probability transform of the last age without the crack"),
    "transform_high": ("1", "probability transform of the first age with the crack"),
    "power": ("1", "power of the mechanics, 1 trusts them, 0 leaves them out"),
    "mechanics_level": ("1", "geometric mean of the ages that the mechanics predict at the surface, years"),
    "field_factor": ("1", "median age of roads over the geometric mean of the mechanics"),
    "covered_mass": ("1", "mass of unseen sections' intervals within 5 to 95 % of their predictions"),
    "surely_outside": ("1", "share of unseen sections whose crack is surely outside 5 to 95 %"),
    "power_profile": ("1", "log likelihood at a power less the maximum, nats"),
    "variant_profile": ("1", "log likelihood of a variant of the mechanics less the largest, nats"),
    "predicted_surface": ("1", "years to damage 1 at the surface by the mechanics"),
    "predicted_bottom": ("1", "years to damage 1 at the bottom of the asphalt by the mechanics"),
}

_EQUIVALENTS = {
    "standard_axles": ("1", "passes of the standard axle that do as much damage as one passage of a class"),
    "mean_standard_axles": ("1", "the same in the mean over the traffic"),
    "axle_load": ("N", "load of one axle, both its ends"),
    "french_axles": ("1", "passage in axles of 130 kN by the fifth power of the load and K of its group"),
    "single_axle_loads": ("1", "passage in axles of 80 kN by the fourth power of the load"),
    "equivalent_temperature": ("degC", "temperature at which a year does the damage of the climate"),
    "equivalent_reading": ("1", "largest reading at the equivalent temperature, in the law's unit"),
    "years_at_equivalent": ("1", "years at the equivalent temperature of the governing criterion"),
}

_REMEDIES = {
    "remedy_years": ("1", "years that a criterion lasts with a remedy"),
    "road_years": ("1", "years until the first criterion fails with a remedy"),
    "years_won": ("1", "years that the road lasts longer with a remedy"),
    "solved_anew": ("1", "1 where contacts or responses were solved for the remedy, 0 where only the sum is new"),
}

_DESIGN = {
    "exact_thickness": ("m", "thickness of the layer for which the road lasts exactly"),
    "design_thickness": ("m", "thickness of the layer, rounded up"),
    "asked_years": ("1", "years that the road is to last"),
    "trial_thickness": ("m", "thickness of the layer that was tried"),
    "trial_years": ("1", "years that a criterion lasts with a thickness that was tried"),
}

_CALIBRATION = {
    "start_value": ("1", "number that the search began with, in its SI unit"),
    "fitted_value": ("1", "number that fits the data best, in its SI unit"),
    "standard_deviation": ("1", "standard deviation of a fitted number, in its SI unit"),
    "lower_bound": ("1", "lower bound of a number, in its SI unit"),
    "upper_bound": ("1", "upper bound of a number, in its SI unit"),
    "interval_low": ("1", "lower end of the 95 % interval of a fitted number, in its SI unit"),
    "interval_high": ("1", "upper end of the 95 % interval of a fitted number, in its SI unit"),
    "worst_residual": ("1", "residual that is largest in size"),
    "at_bound": ("1", "-1 at the lower bound, 1 at the upper one, else 0"),
    "number_correlation": ("1", "correlation of two fitted numbers"),
    "singular_value": ("1", "change of the readings over their errors, per relative change of the numbers"),
    "direction_part": ("1", "relative change of a number in the direction of a singular value"),
    "measured_reading": ("1", "reading that was measured, in its SI unit"),
    "fitted_reading": ("1", "reading of the fitted tire, in its SI unit"),
    "reading_before": ("1", "reading of the tire that the search began with, in its SI unit"),
    "reading_error": ("1", "standard deviation of a reading, in its SI unit"),
    "residual": ("1", "fitted less measured reading, over its error"),
    "residual_before": ("1", "the same of the tire that the search began with"),
    "reading_slope": ("1", "change of a reading over its error, per relative change of a number"),
}

_BASINS = {
    "sensor": (
        "m",
        "distance of a sensor from the axis of the loading plate, or ahead of the middle of rolling wheels",
    ),
    "plate_load": ("N", "peak load of a drop on the loading plate, or load on rolling wheels"),
    "basin_speed": ("m/s", "speed of the wheels at a moving basin"),
    "history_time": ("s", "time since the start of the record of a drop"),
    "measured_history": ("m", "deflection that a sensor measured over time, down"),
    "fitted_history": ("m", "deflection of the fitted layers over time, down"),
    "measured_slope": (
        "1",
        "slope of the surface that a sensor measured, positive where it goes down towards the wheels",
    ),
    "fitted_slope": (
        "1",
        "slope of the surface of the fitted layers, positive where it goes down towards the wheels",
    ),
    "measured_deflection": ("m", "peak deflection that a sensor measured, down"),
    "fitted_deflection": ("m", "deflection of the fitted layers, down"),
    "fitted_modulus": (
        "Pa",
        "Young's modulus of a layer that fits the deflections, or that was fixed; at the nominal stress of a law",
    ),
    "modulus_low": ("Pa", "lower end of the 90 % interval of a fitted modulus"),
    "modulus_high": ("Pa", "upper end of the 90 % interval of a fitted modulus"),
    "modulus_deviation": (
        "1",
        "standard deviation of ln E of a fitted modulus; NaN if fixed, at a bound or without effect",
    ),
    "law_factor": ("1", "factor on the law of a stress-dependent layer"),
    "modulus_at_reference": ("Pa", "fitted modulus at the reference temperature, by the mix of the layer"),
    "layer_thickness": ("m", "thickness of a layer, infinite for a half-space, 0 where it is absent"),
    "layer_poisson": ("1", "Poisson's ratio of a layer"),
    "bond_stiffness": ("Pa/m", "stiffness of the bond of a layer to the one below, infinite where bonded"),
    "unknown_at_bound": ("1", "-1 at the lower bound, 1 at the upper one, else 0"),
    "unknown_correlation": ("1", "correlation of the logarithms of two unknowns"),
    "basin_misfit": ("1", "root mean square of fitted less measured readings, over the measured ones"),
    "error_scatter": ("1", "size of the sensors' errors over what was taken"),
    "basin_freedom": ("1", "readings of a basin less the unknowns that they decide"),
    "basin_status": ("1", "0 fitted, 1 flagged, 2 refused"),
    "drop_position": ("m", "place of a drop along the road"),
    "asphalt_temperature": ("degC", "temperature of the asphalt under a drop"),
    "stiff_depth": ("m", "depth of the stiff layer below the surface; NaN on a half-space"),
    "stiff_depth_deviation": ("m", "standard deviation of the depth of the stiff layer, where it is sought"),
}

_NETWORK = {
    "remaining_years": ("1", "years of service life that are left, from the opening less the age"),
    "section_age": ("1", "years since the opening of a section"),
    "section_position": ("m", "place of a section along the road; NaN where it is not known"),
    "section_length": ("m", "length of a section; NaN where it is not known"),
    "section_rank": ("1", "rank of a section by its remaining life, 1 for the least; 0 of those without"),
    "section_status": ("1", "0 not solved, 1 solved, 2 failed"),
}

_LIFE = {
    "damage_per_year": ("1", "Miner's damage of the first year, with wander where it applies; 1 is failure"),
    "damage_share": ("1", "share of the damage at the worst place"),
    "life_years": ("1", "years until the damage at the worst place is 1"),
    "weather_share": ("1", "share of daily thermal stress in the damage at the worst place"),
    "day_tension": ("Pa", "largest tension of the mean day's thermal stress over depth"),
    "weather_reading": ("1", "what the law reads of the mean day's thermal stress, in the law's unit"),
    "weather_stress": ("Pa", "largest tension of the mean day's thermal stress where the criterion reads"),
    "life_years_without_wander": ("1", "years until the damage is 1 with all wheels in one track"),
    "life_years_with_wander": ("1", "years until the damage is 1 with wheels that wander, whatever the law includes"),
    "life_years_fresh_line": ("1", "years until the damage of a surface criterion is 1 by the line of a young mix"),
    "life_years_aged_line": ("1", "years until the damage of a surface criterion is 1 by the line of old cores"),
    "life_passes": ("1", "passes until the damage at the worst place is 1"),
    "largest_reading": ("1", "largest reading of the criterion's law, in the law's unit"),
    "class_reading": ("1", "largest reading of the criterion's law by class and season, in the law's unit"),
    "polishing_work": ("J/m^2", "work of sliding that a passage leaves per area of road"),
    "largest_polishing_work": ("J/m^2", "largest work of sliding of a wheel's passage per area of road"),
    "largest_tearing_work": ("J/m^2", "largest elastic work of a wheel's shear in a skin as deep as the texture"),
    "tearing_work": ("J/m^2", "largest elastic work of a passage's shear in a skin as deep as the texture"),
    "distortion_work": ("J/m^2", "distortion energy of a passage in a layer, per area of road"),
    "rut_depth": ("m", "rut that a layer adds, where the rut of all is deepest"),
    "rut_layer": ("1", "number of a layer that ruts, from the surface, 0 the top one"),
    "asphalt_rut": ("m", "rut of the bituminous layers by the permanent strain of NCHRP 1-37A"),
    "design_utilisation": (
        "1",
        "largest reading over what the law allows for the design life, or a year",
    ),
    "design_damage": ("1", "Miner's damage at the worst place at the end of the design life; 1 is failure"),
    "group_factor": ("1", "damage by one axle of a group over that by the same axle alone, K"),
    "axles": ("1", "number of axles of a class, one behind the other"),
    "read_depth": ("m", "depth at which a criterion reads"),
    "first_crack_angle": ("rad", "angle of the first crack's trace from travel towards the right"),
    "first_crack_dip": ("rad", "angle of the first crack's plane from the horizontal, π/2 is vertical"),
    "orientation_damage": ("1", "share of the damage at the worst place due to cracks of an orientation"),
    "crack_repetitions": ("1", "load repetitions of the load that does most until a crack of a direction starts"),
    "crack_place": ("m", "place across travel where a crack of a direction starts first under that load"),
    "crack_strain": ("1", "largest tensile strain across a crack of a direction under that load"),
    "cause_share": ("1", "share of what opens the first crack in the damage of that load at the worst place"),
    "elasticity": ("1", "relative change of the life per relative change of an input; of temperature, per °C"),
}

_CLIMATE = {
    "month": ("1", "month of the year, January is 1"),
    "hour": ("h", "local hour of the day"),
    "profile_depth": ("m", "depth below the road surface of a profile of temperature"),
    "day_temperature": ("degC", "temperature of the road at an hour of the mean day of a month"),
    "sublayer": ("1", "number of a part of a course, from the surface, 0 the top one"),
    "sublayer_top": ("m", "depth of the top of a part of a course"),
    "sublayer_bottom": ("m", "depth of the bottom of a part of a course"),
    "sublayer_layer": ("1", "number of the layer that a part belongs to, from the surface, 0 the top one"),
    "sublayer_temperature": ("degC", "temperature of a part of a course in a season"),
    "sublayer_modulus": ("Pa", "Young's modulus of a part of a course, in a season where there are several"),
    "sublayer_modulus_young": ("Pa", "the same of the young mix"),
    "season_modulus": (
        "Pa",
        "Young's modulus of a layer with a factor of its season, such as frost; at the nominal stress of a law",
    ),
    "frost_depth": ("m", "depth of the deepest frozen point of the unbound layers, 0 without any"),
    "thaw_depth": ("m", "depth of the uppermost frozen point of the unbound layers"),
    "day": ("1", "day of the year of the weather, from 1"),
    "day_month": ("1", "month of a day, January 1"),
    "factored_layer": ("", "layer with a factor of frost, thaw or moisture"),
    "sublayer_bulk_stress": (
        "Pa",
        "bulk stress in the law of a stress-dependent part of a course, compressive",
    ),
    "sublayer_deviator_stress": ("Pa", "deviator stress in the law of a stress-dependent part of a course"),
    "largest_sublayer_modulus": ("Pa", "largest Young's modulus of a stress-dependent layer over its depth"),
    "least_sublayer_modulus": ("Pa", "least Young's modulus of a stress-dependent layer over its depth"),
}

_GROWTH = {
    "direction_years": ("1", "years until a crack of a direction has come so deep, where it is through first"),
    "direction_y": ("m", "place where a crack of a direction is through first"),
    "direction_earliest_years": ("1", "years until a crack of a direction starts, where it starts first"),
    "direction_earliest_y": ("m", "place where a crack of a direction starts first"),
    "earliest_years": ("1", "years until the first crack of any place starts"),
    "earliest_y": ("m", "place where a crack starts first"),
    "crack_depth": ("m", "depth of a crack's tip from its mouth"),
    "solved_depth": ("m", "depth of a crack's tip at which stress intensity was solved"),
    "initiation_passes": ("1", "passes until a crack starts at a place"),
    "growth_passes": ("1", "passes until a crack has come so deep at a place"),
    "growth_rate": ("m", "growth of a crack per pass of the whole traffic"),
    "reach_passes": ("1", "passes until the first crack has come so deep"),
    "reach_years": ("1", "years until the first crack has come so deep"),
    "risk_years": ("1", "years until a crack has come so deep in a share of roads"),
    "reach_chance": ("1", "share of roads in which a crack has come so deep at the end of the design life"),
    "stress_intensity_range": ("Pa m^0.5", "range of the stress intensity as an axle class passes"),
    "thermal_intensity_range": ("Pa m^0.5", "range of the stress intensity over the mean day of a month"),
    "thermal_growth_rate": ("m", "growth of a crack per year by daily thermal stress alone"),
    "crack_offset": ("m", "offset of a crack's path along the normal of its trace"),
}

_INTERFACES = {
    "interface": ("1", "number of the interface from the surface, 0 below the top layer"),
    "interface_shear_x": ("Pa", "shear stress xz at an interface"),
    "interface_shear_y": ("Pa", "shear stress yz at an interface"),
    "interface_shear": ("Pa", "size of the shear stress at an interface"),
    "interface_pressure": ("Pa", "normal stress at an interface, compression positive"),
    "jump_x": ("m", "displacement along travel below an interface minus that above it"),
    "jump_y": ("m", "displacement to the right below an interface minus that above it"),
    "utilisation": ("1", "share of the bond's strength that is used; it fails at 1"),
    "bond_passes": ("1", "passes that the fatigue of the bond allows"),
    "largest_utilisation": ("1", "largest utilisation of an interface"),
    "parting_x": (
        "m",
        "position along travel, in the load's frame, where the utilisation of an interface is largest",
    ),
    "parting_y": ("m", "position to the right of travel where the utilisation of an interface is largest"),
    "parting_shear": ("Pa", "size of the shear stress where the utilisation of an interface is largest"),
    "parting_pressure": (
        "Pa",
        "normal stress where the utilisation of an interface is largest, compression positive",
    ),
    "parting_passes": ("1", "passes until the bond of an interface fails"),
    "parting_years": ("1", "years until the bond of an interface fails"),
}

_FOOTPRINT = {
    "computed_pressure": ("Pa", "computed contact pressure as the sensor records it: a mean over each sensel"),
    "measured_pressure": ("Pa", "contact pressure that was measured"),
    "pressure_difference": ("Pa", "computed contact pressure, as the sensor records it, less the measured one"),
    "print_load": ("N", "load that a footprint carries"),
    "net_area": ("m^2", "area of the loaded cells of a footprint"),
    "gross_area": ("m^2", "area inside the convex outline of a footprint"),
    "print_length": ("m", "from the first to the last loaded cell along travel"),
    "print_width": ("m", "from the first to the last loaded cell across travel"),
    "mean_pressure": ("Pa", "load over net area"),
    "largest_pressure": ("Pa", "largest contact pressure of a cell"),
    "print_centre_x": ("m", "centre of pressure along travel"),
    "print_centre_y": ("m", "centre of pressure to the right of travel"),
    "print_spread_x": ("m", "standard deviation of x under the pressure"),
    "print_spread_y": ("m", "standard deviation of y under the pressure"),
    "rib": ("1", "number of a rib, from left to right"),
    "rib_share": ("1", "share of the load that a rib carries"),
    "rib_left": ("m", "left edge of a rib: the middle of the groove beside it"),
    "rib_right": ("m", "right edge of a rib: the middle of the groove beside it"),
    "third": ("1", "third of the width of a rib, from left to right"),
    "third_load": ("N", "load on a third of a rib"),
    "third_force_x": ("N", "force of the tire on the road along travel on a third of a rib"),
    "third_force_y": ("N", "force of the tire on the road to the right on a third of a rib"),
    "rib_outward_shear": (
        "1",
        "half of the difference of the lateral shear of the right and the left third of a rib over its pressure",
    ),
    "rib_largest_pressure": ("Pa", "largest pressure that a sensel or pin reads on a rib"),
    "rib_largest_traction_x": ("Pa", "largest size of the shear along travel that a sensel or pin reads on a rib"),
    "rib_largest_traction_y": ("Pa", "largest size of the lateral shear that a sensel or pin reads on a rib"),
    "overlap_of_pressure": ("1", "sum of the lesser of two pressures over that of the larger"),
    "overlap_of_area": ("1", "area that both maps load over area that either does"),
    "rms_difference": ("Pa", "root of the mean square of the difference where either map is loaded"),
    "correlation": ("1", "correlation of two maps over all sensels"),
    **{
        f"{of}{name}_error": ("1", f"rms error of the interpolated {field} over the mean pressure, {cases}")
        for of, cases in (("", "all cases left out in turn"), ("largest_", "of the worst case left out"))
        for name, field in (
            ("pressure", "pressure"),
            ("traction_x", "shear along travel"),
            ("traction_y", "lateral shear"),
        )
    },
    "registered_x": ("m", "shift of the footprint's middle along its first axis"),
    "registered_y": ("m", "shift of the footprint's middle along its second axis"),
    "registered_angle": ("rad", "angle of the footprint's first axis from travel towards the right"),
}

_SWEEP = {
    "status": ("1", "0 not solved yet, 1 solved, 2 failed"),
    "seconds": ("s", "time that a case took"),
    "largest_traction": ("Pa", "largest shear stress of a cell"),
    "governing": ("1", "criterion that fails first"),
    "governing_years": ("1", "years until the first criterion fails"),
}

_SCREENING = {
    "input_low": ("1", "low end of the range of an input, in its SI unit"),
    "input_high": ("1", "high end of the range of an input, in its SI unit"),
    "input_base": ("1", "an input of the base case, in its SI unit"),
    "reading_low": ("1", "reading with an input at its low end, in the unit of the reading"),
    "reading_high": ("1", "reading with an input at its high end, in the unit of the reading"),
    "reading_base": ("1", "reading of the base case, in the unit of the reading"),
    "reading_mean": ("1", "mean of the reading over its inputs, in the unit of the reading"),
    "reading_deviation": ("1", "standard deviation of the reading over its inputs, in the unit of the reading"),
    "swing": ("1", "range of the reading as an input goes from end to end, in the unit of the reading"),
    "first_order": ("1", "share of the variance that an input has alone"),
    "first_order_interval": ("1", "half width of the 95 % interval of first_order"),
    "total_order": ("1", "share of the variance that an input has alone and with others"),
    "total_order_interval": ("1", "half width of the 95 % interval of total_order"),
    "second_order": ("1", "share of the variance that two inputs have together, beyond those of each"),
    "second_order_interval": ("1", "half width of the 95 % interval of second_order"),
    "absolute_effect": ("1", "mean size of the effects of an input over its range, in the unit of the reading"),
    "absolute_effect_interval": ("1", "half width of the 95 % interval of absolute_effect"),
    "mean_effect": ("1", "mean effect of an input over its range, in the unit of the reading"),
    "effect_deviation": ("1", "standard deviation of the effects of an input, in the unit of the reading"),
}

_TIRE_CARD = {
    "inflation_pressure": ("Pa", "inflation pressure of the tire"),
    "wheel_load": ("N", "vertical load of the wheel"),
    "loaded_radius": ("m", "radius of the unloaded tread less the deflection"),
    "secant_stiffness": ("N/m", "vertical load over deflection"),
    "effective_rolling_radius": ("m", "distance rolled per angle of a freely rolling wheel"),
    "effective_radius_ratio": ("1", "effective rolling radius over the radius of the unloaded tread"),
    "mean_over_inflation": ("1", "mean pressure over the net area, over the inflation pressure"),
    "gross_mean_over_inflation": ("1", "load over the gross area, over the inflation pressure"),
    "shoulder_over_centre": ("1", "mean load of the two outer ribs over that of the middle"),
    "longitudinal_stiffness": ("N", "slope of the tractive force over longitudinal creepage at free rolling"),
    "cornering_stiffness": ("N/rad", "slope of the lateral force over slip angle at free rolling"),
    "aligning_stiffness": ("N m/rad", "slope of the aligning moment over slip angle at free rolling"),
    "pneumatic_trail": ("m", "aligning stiffness over cornering stiffness"),
    "lateral_stiffness": ("N/m", "lateral force over shift of the standing tire"),
    "relaxation_length": ("m", "cornering stiffness over lateral stiffness"),
}

_HETEROGENEOUS = {
    "principal_stress_1": ("Pa", "largest principal stress (largest tension), three-dimensional"),
    "tension_without_stones": ("Pa", "largest principal stress of the mortar alone"),
    "extension_without_stones": ("1", "largest principal strain of the mortar alone"),
    "phase": ("1", "0 mortar, then the aggregates in the order in which they were given, from 1"),
    "stone": ("1", "number of the stone that a cell is in, from 1, 0 in mortar"),
    "percentile": ("1", "share of the volume, in hundredths, with a lower value"),
    "mastic_tension": ("Pa", "largest principal stress in the mastic, by percentile of its volume"),
    "mastic_extension": ("1", "largest principal strain in the mastic, by percentile of its volume"),
    "stone_tension": ("Pa", "largest principal stress in the stones, by percentile of their volume"),
    "homogeneous_tension": ("Pa", "largest principal stress of the mortar alone, by percentile of the volume"),
    "homogeneous_extension": ("1", "largest principal strain of the mortar alone, by percentile of the volume"),
    "mean_extension": ("1", "mean over stones and mastic of the largest principal strain, where it extends"),
    "peak_over_mean": ("1", "largest principal strain in the mastic, by percentile, over mean_extension"),
    "bond_normal": ("Pa", "stress across a face between stone and mortar, tension positive"),
    "bond_shear": ("Pa", "size of the shear stress along a face between stone and mortar"),
    "bond_pull": ("Pa", "root of tension and shear squared on a face between stone and mortar"),
    "face_area": ("m^2", "area of the stone's surface at a face"),
    "face_stone": ("1", "number of the stone of a face"),
    "face_x": ("m", "position of a face along travel"),
    "face_y": ("m", "position of a face to the right of travel"),
    "face_depth": ("m", "depth of a face"),
    "bond_tension_high": ("Pa", "stress across the faces that 95 % of their area are below"),
    "bond_shear_high": ("Pa", "shear stress along the faces that 95 % of their area are below"),
    "ravelling_index": (
        "1",
        "bond_pull that 95 % of the faces of the upper stones are below, over the bond's strength, else the load's "
        "largest pressure",
    ),
    "stone_fraction": ("1", "share of the window that its cells of stones fill"),
    "soft_strain_error": (
        "1",
        "error of the mean strain of soft stones and voids by their cells, the largest, over its largest component",
    ),
    "stone_over_mastic": ("1", "mean vertical stress of the stones over that of the mastic"),
}

VARIABLES: Mapping[str, tuple[str, str]] = {
    **_COORDINATES,
    **_CONTACT,
    **_FRINGES,
    **_TEXTURE,
    **_CROSSING,
    **_HISTORY,
    **_RESPONSE,
    **_MOVING,
    **_DAMAGE,
    **_QUANTITIES,
    **_CALIBRATION,
    **_BASINS,
    **_NETWORK,
    **_LIFE,
    **_CLIMATE,
    **_RELIABILITY,
    **_DESIGN,
    **_GROWTH,
    **_FIELD,
    **_EQUIVALENTS,
    **_REMEDIES,
    **_INTERFACES,
    **_PASSES,
    **_UNIFORM,
    **_FOOTPRINT,
    **_SWEEP,
    **_SCREENING,
    **_TIRE_CARD,
    **_HETEROGENEOUS,
}

SCALES: Mapping[str, float] = {
    "": 1.0, "m": 1.0, "mm": 1e3, "µm": 1e6, "mm²": 1e6, "N": 1.0, "kN": 1e-3, "Pa": 1.0, "kPa": 1e-3, "MPa": 1e-6,
    "GPa": 1e-9, "N m": 1.0, "kN m": 1e-3, "microstrain": 1e6, "%": 1e2, "°": math.degrees(1.0), "rad/m": 1.0,
    "J/m": 1.0, "J/m²": 1.0, "kJ/m²": 1e-3, "J/m³": 1.0, "J": 1.0, "W": 1.0, "K": 1.0, "°C": 1.0, "s": 1.0,
    "years": 1.0, "N/mm": 1e-3, "kN/rad": 1e-3, "kN/°": 1e-3 / math.degrees(1.0), "N m/°": 1 / math.degrees(1.0),
    "MPa√m": 1e-6, "N/kN": 1e3, "cm²": 1e4, "km/h": 3.6, "kW/m²": 1e-3, "MPa/m": 1e-6,
}  # fmt: skip
"""Units that numbers are shown in, and the factor from the SI unit to each."""


@dataclass(frozen=True)
class Display:
    """How a number is shown. label: for people. unit: a key of `SCALES`. form: of the number in that unit.

    form: a format, or a function of the SI value that returns the text with its unit.
    """

    label: str
    unit: str = ""
    form: str | Callable[[float], str] = ".4g"


_STRESS = stress_in_words


def modulus_in_words(modulus: float) -> str:
    """A modulus, Pa, in MPa with the digits that a measured one deserves."""
    return f"{modulus * 1e-6:.0f} MPa" if modulus >= 1e8 else f"{modulus * 1e-6:.3g} MPa"


# Rows of text have a label alone.
_DISPLAYS_DAMAGE = {
    "law": Display("fatigue law"),
    "evaluation": Display("evaluated"),
    "largest_sublayer_modulus": Display("largest modulus", "MPa", ".4g"),
    "least_sublayer_modulus": Display("least modulus", "MPa", ".4g"),
    "largest_principal_strain": Display("tensile strain, three-dimensional", "microstrain", ".1f"),
    "largest_in_plane_strain": Display("tensile strain, horizontal plane", "microstrain", ".1f"),
    "worst_strain": Display("evaluated tensile strain", "microstrain", ".1f"),
    "strain_ratio": Display("over the strain at a million", "", ".2f"),
    "coarse_strain": Display("error estimate: on coarser cells", "microstrain", ".1f"),
    "worst_passes": Display("allowable load repetitions", "", repetitions_in_words),
    "worst_crack_orientation": Display("first crack"),
    "worst_crack_angle": Display("crack trace from travel", "°", "z.0f"),
    "worst_crack_dip": Display("dip of its plane", "°", ".0f"),
    "contacts_evaluated": Display("evaluated under"),
    "verdict": Display("Verdict"),
    "interface": Display("interface"),
    "bond_strength": Display("bond strength"),
    "largest_utilisation": Display("utilisation of the bond", "", ".3g"),
    "interface_shear": Display("shear stress", "MPa", ".3f"),
    "interface_pressure": Display("normal stress, compression positive", "MPa", ".3f"),
    "parting_passes": Display("debonds after load repetitions", "", repetitions_in_words),
    "parting_years": Display("debonds after", "", years_in_words),
}

_DISPLAYS_LIFE = {
    "solved_anew": Display("solved again"),
    "life_years": Display("service life", "", years_in_words),
    "life_years_fresh_line": Display("by the fresh line", "", years_in_words),
    "life_years_aged_line": Display("by the aged line", "", years_in_words),
    "life_passes": Display("load repetitions", "", repetitions_in_words),
    "largest_reading": Display("largest evaluated value"),
    "read_depth": Display("depth", "mm", "g"),
    "worst_y": Display("y", "mm", "z.0f"),
    "design_utilisation": Display("utilisation", "", ".2g"),
    "design_damage": Display("damage", "", ".2g"),
    "damage_by": Display("most damage by"),
    "law_conditions": Display("law calibrated"),
    "first_crack": Display("first crack"),
    "first_crack_cause": Display("first crack by"),
    "end_of_life": Display("damage 1 means"),
    "quantity": Display("evaluated"),
    "group_factor": Display("axle groups"),
    "roads_show": Display("what roads show"),
    "rut_depth": Display("rut depth", "mm", ".3g"),
    "rut_years": Display("rut reaches its limit after", "", years_in_words),
    "governing": Display("governing criterion"),
    "governing_years": Display("service life of the road", "", years_in_words),
    "solved": Display("solved"),
    "elasticity": Display("change of the service life", "", lambda change: f"{change:+z.2g} %"),
    "growth_starts": Display("crack starts"),
    "crack_depth": Display("crack depth", "mm", ".1f"),
    "reach_years": Display("reached after", "", years_in_words),
    "direction_years": Display("crack is through after", "", years_in_words),
    "direction_earliest_years": Display("crack starts after", "", years_in_words),
    "earliest_years": Display("first crack elsewhere after", "", years_in_words),
    "mechanics_years": Display("mechanics alone", "", years_in_words),
    "field_years": Display("years of roads", "", lambda y: f"{y:.2g} years" if y <= LASTS else years_in_words(y)),
    "field_shift": Display("field shift"),
    "field_table": Display("road sections"),
    "crack_level": Display("median", "", lambda years: f"{years:.2f} years"),
    "crack_level_low": Display("from (95 %)", "", lambda years: f"{years:.2g} years"),
    "crack_level_high": Display("to (95 %)", "", lambda years: f"{years:.2g} years"),
    "crack_level_error": Display("error of ln", "", ".3f"),
    "crack_scatter": Display("scatter of ln", "", ".2f"),
    "crack_lag": Display("overlay lag", "", lambda years: f"{years:.2g} years"),
    "why_late": Display("plain"),
    "log_score": Display("log score", "", ".1f"),
    "score_gain": Display("over ages with lag", "", "+z.1f"),
    "score_gain_error": Display("error of the gain", "", ".1f"),
    "score_verdict": Display("which is"),
    "power": Display("power of the mechanics", "", "z.2f"),
    "mechanics_level": Display("mechanics, geometric mean", "", lambda years: f"{years:.3g} years"),
    "field_factor": Display("roads over mechanics", "", ".2g"),
    "variants": Display("left open"),
    "about_mechanics": Display("mechanics"),
    "cell_sections": Display("sections", "", ".0f"),
    "seen_share": Display("seen", "", ".2f"),
    "predicted_share": Display("predicted unseen", "", ".2f"),
    "share_error": Display("error of the share", "", ".2f"),
    "cells": Display("classes"),
    "covered_mass": Display("mass in 90 % intervals, unseen", "", ".3f"),
    "surely_outside": Display("sections surely outside", "%", ".1f"),
    "unsupported": Display("order of roads"),
    "outside": Display("outside the shift's range"),
    "risk_years": Display("reached after, at a risk", "", years_in_words),
    "stress_intensity_range": Display("stress intensity range", "MPa√m", ".3g"),
    "thermal_intensity_range": Display("stress intensity range of the day", "MPa√m", ".3g"),
    "reach_chance": Display("roads cracked through in the design life", "%", ".0f"),
    "years_at_risk": Display("service life, by draws", "", years_in_words),
    "years_at_risk_first_order": Display("service life, first order", "", years_in_words),
    "years_error": Display("error of these years"),
    "road_years_error": Display("error of the years of the first"),
    "road_years_at_risk": Display("first criterion to fail", "", years_in_words),
    "road_failure_probability": Display("failure probability in the design life", "%", ".2g"),
    "thickness_slope": Display("decades of strain per cm of thickness", "", lambda slope: f"{slope / 100:.3g}"),
    "importance": Display("scatter by"),
    "law_risk_factor": Display("k_r in the law, removed here", "", ".3f"),
    "law_years": Display("service life by the law with k_r", "", years_in_words),
    "exact_thickness": Display("required thickness", "mm", ".1f"),
    "design_thickness": Display("thickness, rounded up", "mm", ".0f"),
    "trial_thickness": Display("thickness", "mm", ".0f"),
    "trial_years": Display("service life at it", "", years_in_words),
    "asked_years": Display("design life", "", years_in_words),
    "road_years": Display("road lasts", "", years_in_words),
    "years_won": Display("years won", "", "+z.3g"),
    "remedy_years": Display("years by", "", years_in_words),
    "best_remedy": Display("helps"),
    "not_applicable": Display("not applicable"),
}

_DISPLAYS_STUDIES = {
    "standard_axles": Display("standard axles"),
    "equivalent_temperature": Display("equivalent temperature", "°C", ".1f"),
    "equivalent_reading": Display("value at that temperature"),
    "years_at_equivalent": Display("service life at that temperature", "", years_in_words),
    "french_axles": Display("(P/130 kN)⁵ K"),
    "single_axle_loads": Display("(P/80 kN)⁴"),
    "axle_load": Display("axle load", "kN", ".1f"),
    "inflation_pressure": Display("inflation pressure", "kPa", ".0f"),
    "wheel_load": Display("wheel load", "kN", ".1f"),
    "effective_radius_ratio": Display("Re/R", "", ".4f"),
    "print_length": Display("footprint length", "mm", ".0f"),
    "mean_over_inflation": Display("mean/p", "", ".3f"),
    "shoulder_over_centre": Display("outer/mid", "", ".3f"),
    "longitudinal_stiffness": Display("longitudinal stiffness", "kN", ".1f"),
    "cornering_stiffness": Display("cornering stiffness", "kN/rad", ".1f"),
    "pneumatic_trail": Display("pneumatic trail", "mm", ".1f"),
    "lateral_stiffness": Display("lateral stiffness", "N/mm", ".0f"),
    "relaxation_length": Display("relaxation length", "m", ".3f"),
    "longitudinal_stiffness_over_load": Display("longitudinal stiffness/load", "", ".2f"),
    "cornering_stiffness_over_load": Display("cornering stiffness/load, 1/rad", "", ".2f"),
    "nominal_load": Display("nominal load", "kN", ".2f"),
    "nominal_pressure": Display("nominal inflation pressure", "kPa", ".0f"),
    "unloaded_radius": Display("unloaded radius", "mm", ".1f"),
    "vertical_stiffness": Display("vertical stiffness", "N/mm", ".0f"),
    "peak_friction_x": Display("peak friction along travel", "", ".3f"),
    "peak_friction_y": Display("peak friction across travel", "", ".3f"),
    "absolute_effect": Display("mean size of the effect", "", ".3g"),
    "absolute_effect_interval": Display("± mean size (95 %)", "", ".2g"),
    "mean_effect": Display("mean effect", "", ".3g"),
    "effect_deviation": Display("deviation σ", "", ".2g"),
    "effect_direction": Display("direction"),
    "reading_base": Display("base case", "", ".4g"),
    "input_low": Display("low end"),
    "input_high": Display("high end"),
    "reading_low": Display("at the low end", "", ".4g"),
    "reading_high": Display("at the high end", "", ".4g"),
    "reading_mean": Display("mean", "", ".4g"),
    "reading_deviation": Display("standard deviation", "", ".2g"),
    "first_order": Display("first order", "", ".3f"),
    "first_order_interval": Display("± first order (95 %)", "", ".3f"),
    "total_order": Display("total", "", ".3f"),
    "total_order_interval": Display("± total (95 %)", "", ".3f"),
    "second_order": Display("second order", "", ".3f"),
    "fitted_value": Display("fitted"),
    "standard_deviation": Display("± standard deviation"),
    "interval_low": Display("95 % from"),
    "interval_high": Display("to"),
    "start_value": Display("before"),
    "residual": Display("residuals, rms", "", ".2f"),
    "residual_before": Display("residuals before, rms", "", ".2f"),
    "worst_residual": Display("worst residual", "", "+.1f"),
    "reading_error": Display("errors of the readings"),
    "number_correlation": Display("correlation", "", "+.2f"),
    "undecided": Display("undecided"),
    "basin_status": Display("basins"),
    "fitted_modulus": Display("modulus", "", modulus_in_words),
    "basin_misfit": Display("misfit, median of the rms", "%", ".2g"),
    "sensor_error": Display("error of the sensors"),
    "stiff_depth": Display("stiff layer"),
    "remaining_years": Display("remaining life", "", remaining_in_words),
    "remaining_bands": Display("sections by remaining life"),
    "remaining_lengths": Display("network by remaining life"),
    "section_age": Display("age", "", years_in_words),
    "section_status": Display("sections of the network"),
    "failed": Display("failed"),
    "flagged": Display("flagged"),
    "refused": Display("refused"),
    "skipped": Display("not changed"),
    "varied": Display("varied"),
    "results": Display("further results"),
    "largest_extension": Display("largest tensile strain", "microstrain", ".1f"),
    "largest_in_plane_extension": Display("largest tensile strain in the horizontal plane", "microstrain", ".1f"),
    "largest_vertical_shear": Display("vertical shear", "microstrain", ".1f"),
}

_DISPLAYS_CONTACT = {
    "grid": Display("grid"),
    "tread": Display("tread"),
    "road_height": Display("road surface"),
    "position": Display("axle positions"),
    "mortar": Display("mortar"),
    "aggregates": Display("aggregates"),
    "registration": Display("registration"),
    "rib_share": Display("load by rib"),
    "lateral_by_thirds": Display("lateral shear by thirds of ribs"),
    "longitudinal_by_thirds": Display("longitudinal shear by thirds of ribs"),
    "rib_outward_shear": Display("shear outward from the middle of ribs"),
    "largest_readings": Display("largest p : q_y : q_x"),
    "pin_face": Display("face of a pin"),
    "threshold": Display("sensor threshold"),
    "saturation": Display("sensor saturation"),
    **{
        f"{of}{name}_error": Display(f"{words} of the {field} when left out", "%", ".2f")
        for of, words in (("", "rms error"), ("largest_", "largest rms error"))
        for name, field in (
            ("pressure", "pressure"),
            ("traction_x", "shear along travel"),
            ("traction_y", "lateral shear"),
        )
    },
    "missing": Display("missing"),
    "source": Display("read from"),
    "road_share": Display("compliance by the road", "%", ".3g"),
    "layer_share": Display(
        "change of compliance by layers", "", lambda part: f"{100 * part:{'+.2g' if abs(part) < 0.1 else '+.0f'}} %"
    ),
    "friction_work_total": Display("frictional energy loss per metre", "J/m", "z.3f"),
    "friction_power_total": Display("frictional power", "W", ".1f"),
    "flash_temperature": Display("peak flash temperature rise", "K", ".1f"),
    "edge_pressure": Display("peak pressure at an edge", "", _STRESS),
    "plain_pressure": Display("peak pressure without obstacle", "", _STRESS),
    "peak_before": Display("peak pressure before enveloping", "", _STRESS),
    "closing_work": Display("peak closing work", "kJ/m²", ".3g"),
    "edge_work": Display("peak closing work at an edge", "kJ/m²", ".3g"),
    "plain_work": Display("closing work without obstacle", "kJ/m²", ".3g"),
    "friction_work_density": Display("frictional energy loss per area", "J/m²", ".2f"),
    "largest_plastic_strain": Display("peak plastic strain", "%", ".3g"),
    "residual_displacement_z": Display("dent depth", "µm", ".4g"),
    "peak_pressure_error": Display("error of the peak pressure"),
    "largest_plastic_strain_error": Display("error of the peak plastic strain"),
    "rms_height": Display("rms height", "mm", ".3g"),
    "rms_slope": Display("rms slope", "", ".3g"),
    "real_area_ratio": Display("real contact area ratio", "%", ".3g"),
    "persson_area_ratio": Display("ratio after Persson", "%", ".3g"),
    "mean_gap": Display("mean gap", "mm", ".3g"),
    "real_area": Display("real contact area", "mm²", ".0f"),
    "tractive_force_ratio": Display("tractive force/μP", "", "z.4f"),
    "lateral_force_ratio": Display("lateral force/μP", "", "z.4f"),
    "sliding_torque": Display("torque of full sliding", "N m", ".1f"),
    "turning_stiffness": Display("turning stiffness", "N m/°", ".1f"),
    "friction_energy": Display("frictional energy loss", "J", ".3f"),
    "turn_angle": Display("turn angle", "°", ".2f"),
    "steering_torque": Display("steering torque", "N m", ".1f"),
    "distance": Display("distance", "mm", ".1f"),
    "pitch": Display("pitch of the blocks", "mm", ".1f"),
    "periodicity": Display("change from pitch to pitch", "%", ".2g"),
    "rolling_resistance": Display("rolling resistance", "N", ".4g"),
    "rolling_resistance_coefficient": Display("rolling resistance over load", "N/kN", ".3g"),
    "rolling_resistance_moment": Display("rolling resistance moment", "N m", ".4g"),
    "pressure_centre_x": Display("centre of pressure ahead of axle", "mm", ".3g"),
    "material_loss": Display("energy loss in the materials", "J/m", ".4g"),
    "material_power": Display("power loss in the materials", "W", ".4g"),
    "gross_area": Display("gross contact area", "mm²", ".0f"),
    "print_width": Display("footprint width", "mm", ".0f"),
    "overlap_of_pressure": Display("overlap of the pressure", "%", ".1f"),
    "overlap_of_area": Display("overlap of the area", "%", ".1f"),
    "rms_difference": Display("rms difference of pressure", "", _STRESS),
    "correlation": Display("correlation of pressure", "", ".3f"),
    "mean_tread_wear": Display("mean tread wear", "mm", ".2f"),
    "largest_tread_wear": Display("peak tread wear", "mm", ".2f"),
    "wear_range": Display("range of tread wear across", "mm", ".2f"),
    "datum": Display("radius shift for equal grooves", "mm", "+.2f"),
    "pixels": Display("pixels"),
    "kept_pixels": Display("pixels with a height", "%", ".1f"),
    "pixels_without_steps": Display("pixels kept without saturated steps", "%", ".1f"),
    "fringe_modulation": Display("modulation, grey levels", "", ".3g"),
    "grey_noise": Display("noise, grey levels", "", ".2g"),
    "gamma": Display("gamma", "", ".2f"),
    "fringe_deviation": Display("deviation of heights by noise", "mm", ".3f"),
    "plane_residual": Display("rms residual of the planes", "mm", ".3f"),
    "laser_lines": Display("lines of the laser"),
    "levelling": Display("levelled on its tops"),
    "deepest_cell": Display("deepest cell", "mm", ".1f"),
    "groove_depth": Display("groove depth", "mm", ".1f"),
    "earlier_groove_depth": Display("groove depth before", "mm", ".1f"),
}

_DISPLAYS_RESPONSE = {
    "print_centre_x": Display("centre of pressure, x", "mm", ".1f"),
    "print_centre_y": Display("centre of pressure, y", "mm", ".1f"),
    "disc_radius": Display("radius", "mm", ".2f"),
    "uniform_pressure": Display("uniform pressure", "MPa", ".4f"),
    "spread_ratio_x": Display("spread along travel over contact's", "", ".3f"),
    "spread_ratio_y": Display("spread across travel over contact's", "", ".3f"),
    "neglected_shear": Display("neglected shear"),
    "disc_overlap": Display("overlap of discs over radius", "%", ".0f"),
    "stone_fraction": Display("share of aggregates", "%", ".1f"),
    "mastic_tension": Display("peak tension in the mastic", "MPa", ".3g"),
    "homogeneous_tension": Display("peak tension, mortar alone", "MPa", ".3g"),
    "mastic_extension": Display("tensile strain in the mastic", "microstrain", ".4g"),
    "peak_over_mean": Display("mastic over mean tensile strain", "", ".3g"),
    "soft_strain_error": Display("strain error, soft stones", "%", ".2g"),
    "stone_over_mastic": Display("aggregate over mastic stress", "", ".3g"),
    "bond_tension_high": Display("bond tension, 95 % of faces below", "MPa", ".3g"),
    "bond_shear_high": Display("bond shear, 95 % of faces below", "MPa", ".3g"),
    "ravelling_index": Display("ravelling index", "", ".3g"),
    "elastic_load_factor": Display("load at first yield over load", "%", ".3g"),
    "shakedown_load_factor": Display("shakedown load over load", "%", ".3g"),
    "heave": Display("heave", "mm", ".3g"),
    "plastic_increment": Display("plastic strain added", "%", ".3g"),
    "peak_plastic_strain": Display("peak mean plastic strain", "%", ".3g"),
    "peak_plastic_strain_error": Display("error of the mean plastic strain"),
    "rut_depth_error": Display("error of the rut depth"),
    "contact_length": Display("contact length", "mm", ".3g"),
    "contact_width": Display("contact width", "mm", ".3g"),
}

# Variables that are shown as single numbers; all other variables are shown by their name, in SI.
_DISPLAYS: Mapping[str, Display] = {
    "normal_load": Display("normal load", "kN", ".3f"),
    "tractive_force": Display("tractive force", "N", "z.1f"),
    "lateral_force": Display("lateral force", "N", "z.1f"),
    "aligning_moment": Display("aligning moment", "N m", "z.1f"),
    "approach": Display("approach", "mm", ".2f"),
    "net_area": Display("net contact area", "mm²", ".0f"),
    "mean_pressure": Display("mean pressure", "", _STRESS),
    "largest_pressure": Display("peak pressure", "", _STRESS),
    "largest_traction": Display("peak shear", "", _STRESS),
    "creepage_x": Display("longitudinal creepage", "", "z.5f"),
    "creepage_y": Display("lateral creepage", "", "z.5f"),
    "spin": Display("spin", "rad/m", "z.4g"),
    "slip_fraction": Display("slip share of the contact", "%", ".1f"),
    **_DISPLAYS_DAMAGE,
    **_DISPLAYS_LIFE,
    **_DISPLAYS_STUDIES,
    **_DISPLAYS_CONTACT,
    **_DISPLAYS_RESPONSE,
}


def display_of(name: str) -> Display:
    """How the numbers of a variable are shown. Raises KeyError for a name that is not a variable's."""
    if name in _DISPLAYS:
        return _DISPLAYS[name]
    unit, _ = VARIABLES[name]
    return Display(name.replace("_", " "), unit if unit in SCALES else "")


def axis_display_of(name: str, unit: str, largest: float = 0.0) -> Display:
    """How a variable is shown on an axis, where all numbers share a unit; also of a name that is not a variable's.

    unit: SI, of the numbers. largest: of them, which a unit of its size is chosen for where the variable states none.
    """
    stated = _DISPLAYS.get(name)
    label = stated.label if stated is not None else name.replace("_", " ").replace("in plane", "in-plane")
    if stated is not None and stated.unit:
        return Display(label, stated.unit)
    if unit not in ("1", ""):
        return Display(label, [shown for least, shown in _AXIS_UNITS.get(unit, ((0, unit),)) if largest >= least][-1])
    if stated is not None:
        return Display(label, "years" if stated.form is years_in_words else "")
    strains, shares = ("strain", "extension", "compression", "epsilon"), ("fraction", "share", "coverage")
    if any(part in name for part in strains) and "damage" not in name:
        return Display(label, "microstrain")
    return Display(label, "%" if any(part in name for part in shares) else "")


# SI unit → units of axes, each with the least number, SI, that it is for.
_AXIS_UNITS: Mapping[str, tuple[tuple[float, str], ...]] = {
    "Pa": ((0, "kPa"), (2e6, "MPa")), "N": ((0, "N"), (1e3, "kN")), "m": ((0, "mm"), (5.0, "m")),
    "m^2": ((0, "cm²"),), "m/s": ((0, "km/h"),), "rad": ((0, "°"),), "degC": ((0, "°C"),), "J/m^3": ((0, "J/m³"),),
    "W/m^2": ((0, "kW/m²"),), "Pa/m": ((0, "MPa/m"),),
}  # fmt: skip


SAMPLE: Mapping[str, Display] = {
    "normal_load": Display("normal load", "N", ".4g"),
    "approach": Display("approach", "µm", ".4g"),
    "largest_pressure": Display("peak pressure", "MPa", ".4g"),
    "net_area": Display("net contact area", "mm²", ".4g"),
}
"""The same variables of small bodies and patches of texture, whose numbers are smaller than those of wheels."""


# In this order an array has its dimensions, and who takes its values counts on it.
_ORDER = (
    "basin", "layer_name", "section",
    "event", "likelihood", "cell", "trial", "remedy", "state", "criterion", "road_share",
    "axle_class", "season", "month", "hour", "turn", "direction", "reading",
    "unknown", "input", "risk", "rut_layer", "year", "crack_depth", "solved_depth", "mean_pressure", "local_pressure",
    "sensor",
    "history_time", "mode", "other", "load", "map", "inflation_pressure", "wheel_load", "rib", "groove", "step",
    "position",
    "pass",
    "interface", "depth", "profile_depth", "sublayer", "point", "row", "column", "y", "across", "wheel_angle", "x",
    "road_x", "component", "orientation",
)  # fmt: skip
_RANK = {name: rank for rank, name in enumerate(_ORDER)}


def in_order(data: xr.Dataset) -> xr.Dataset:
    """The dataset with the dimensions of its variables in the order of results; itself where they are.

    Other programs write and `transpose` leaves them in any order. Variables and dimensions of other names stay.
    """
    turned = {}
    for name, field in data.variables.items():
        if name in VARIABLES and field.ndim > 1:
            ranked = iter(sorted((dim for dim in field.dims if dim in _RANK), key=lambda dim: _RANK[str(dim)]))
            dims = tuple(next(ranked) if dim in _RANK else dim for dim in field.dims)
            if dims != field.dims:
                turned[name] = field.transpose(*dims)
    return data.assign(turned) if turned else data


# What CF-1.11 asks beside units and long names: the direction of depths (section 4.3), flags of the type
# of their variable (section 3.5). X and Y are no longitude and latitude, for which checkers take an `axis`.
_CF: dict[str, dict[str, object]] = {
    "depth": {"standard_name": "depth", "positive": "down"},
    "state": {"flag_values": np.array([0, 1, 2], dtype=np.int8), "flag_meanings": "open stick slip"},
}


def attributes(name: str) -> dict[str, object]:
    """Attributes `units` and `long_name` of a variable, and what CF asks of depths and flags."""
    units, long_name = VARIABLES[name]
    return {"units": units, "long_name": long_name, **_CF.get(name, {})}


def dataset(
    fields: Mapping[str, tuple[tuple[str, ...], object]], coordinates: Mapping[str, object], **attrs: object
) -> xr.Dataset:
    """Dataset whose variables and coordinates carry their units and long names.

    fields: name → (dimensions, array). coordinates: name → 1-D array (or list of labels), or (dimension, array).
    """
    coords = {}
    for name, coordinate in coordinates.items():
        dimension, values = coordinate if isinstance(coordinate, tuple) else (name, coordinate)
        coords[name] = (dimension, np.asarray(values), attributes(name) if name in VARIABLES else {})
    variables = {name: (dims, np.asarray(data), attributes(name)) for name, (dims, data) in fields.items()}
    return xr.Dataset(variables, coords, dict(attrs))
