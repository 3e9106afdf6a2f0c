"""Names, units and long names of every variable that a result can hold.

The one place where they are stated; signs are explained in docs/explanation/conventions.md.
x: direction of travel. y: to the right. z: depth, positive down. Tension positive.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

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
}

_TEXTURE = {
    "mean_pressure": ("Pa", "mean pressure on a patch of texture"),
    "local_pressure": ("Pa", "local pressure on a patch of texture"),
    "texture_height": ("m", "height of a road's texture, up positive"),
    "real_area_ratio": ("1", "share of the area that really touches"),
    "mean_gap": ("m", "mean separation of rubber and texture"),
    "persson_area_ratio": ("1", "share of the area that touches after Persson's theory"),
    "asperity_area_ratio": ("1", "share of the area that touches where asperities do not feel each other"),
    "load_share_above": ("1", "share of the load that is carried by pressures above a local one"),
    "area_share_above": ("1", "share of the area that is under pressures above a local one"),
    "reference_pressure": ("Pa", "mean pressure of the fields on the texture"),
    "real_area": ("m^2", "area of the wheel's contact that really touches the texture"),
}

_CROSSING = {
    "position": ("m", "place of the axle along the road"),
    "road_x": ("m", "place along the road, in the direction of travel"),
    "contact_area": ("m^2", "area of the cells in contact"),
    "edge_pressure": ("Pa", "largest contact pressure within a cell of an edge of the road"),
    "share_before": ("1", "share of the load that the road before the first edge carries"),
    "share_beyond": ("1", "share of the load that the road beyond the last edge carries"),
    "highest_pressure": ("Pa", "largest contact pressure that a place of the road has borne"),
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
    "pole_x": ("m", "point along travel about which the step turned the tire"),
    "pole_y": ("m", "point to the right of travel about which the step turned the tire"),
}

_TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")

_RESPONSE = {
    **{f"stress_{c}": ("Pa", f"stress component {c}, tension positive") for c in _TENSOR},
    **{f"strain_{c}": ("1", f"strain component {c}, extension positive, tensor shear") for c in _TENSOR},
    "principal_strain_1": ("1", "largest principal strain (largest extension), three-dimensional"),
    "principal_strain_2": ("1", "middle principal strain, three-dimensional"),
    "principal_strain_3": ("1", "smallest principal strain, three-dimensional"),
    "principal_direction_1": ("1", "unit vector of the largest extension"),
    "in_plane_strain_1": ("1", "largest principal strain in the horizontal plane"),
    "in_plane_angle_1": ("rad", "angle of the largest in-plane extension from travel towards the right"),
    "von_mises_stress": ("Pa", "von Mises equivalent stress"),
    "octahedral_shear_stress": ("Pa", "octahedral shear stress"),
    "mean_stress": ("Pa", "mean stress, tension positive"),
    "mazars_strain": ("1", "Mazars equivalent strain, from the extensions alone"),
}

_MOVING = {
    "dissipated_energy": (
        "J/m^3",
        "energy per unit volume that one passage of the moving load dissipates, NaN where not computed",
    ),
}

_DAMAGE = {
    "extension_strain": ("1", "largest extension strain that the criterion reads"),
    "allowable_passes": ("1", "passes that the fatigue line allows at this strain"),
    "crack_angle": ("rad", "angle of the crack's trace on the surface from travel towards the right"),
    "crack_dip": ("rad", "angle of the crack plane from the horizontal, π/2 is vertical"),
    "crack_orientation": ("1", "0 none, 1 longitudinal, 2 transverse, 3 oblique, 4 horizontal"),
    "instant_x": (
        "m",
        "position along travel, in the wheel's frame, at which the extension of a point of the road is largest",
    ),
    "extension_direction": ("1", "unit vector of the largest extension at its worst instant"),
    "trace_share": ("1", "share of the cracks in a class of trace angles"),
    "orientation_share": ("1", "share of the cracks of an orientation"),
    "worst_x": ("m", "position along travel of the largest extension"),
    "worst_y": ("m", "position to the right of travel of the largest extension"),
    "worst_depth": ("m", "depth of the largest extension"),
    "worst_strain": ("1", "largest extension strain that is read"),
    "worst_passes": ("1", "passes that the fatigue line allows at the largest extension"),
    "worst_crack_angle": ("rad", "crack_angle at the largest extension"),
    "worst_crack_dip": ("rad", "crack_dip at the largest extension"),
    "worst_crack_orientation": ("1", "crack_orientation at the largest extension"),
    "extension_by_depth": ("1", "largest extension strain that is read at each depth"),
}

_QUANTITIES = {
    "in_plane_extension": ("1", "largest extension strain in the horizontal plane"),
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
    "risk_factor": ("1", "strain allowed at a risk over that allowed at even odds, k_r, by draws"),
    "failure_probability": ("1", "probability that a criterion has failed by a year, by draws"),
    "failure_probability_first_order": ("1", "the same to the first order"),
    "importance": ("1", "share of an input in the scatter at the smallest risk, α² of the first order"),
    "road_years_at_risk": ("1", "years until any criterion has failed with a probability, by draws"),
    "road_failure_probability": ("1", "probability that any criterion has failed by a year, by draws"),
    "thickness_slope": ("1/m", "decades that the strain loses per length of thickness"),
    "fatigue_scatter": ("1", "standard deviation of log₁₀ of the passes that a law allows, SN"),
    "law_risk": ("1", "probability of failure that a law has in it"),
    "law_risk_factor": ("1", "k_r that a law has in it"),
    "law_years": ("1", "years by the law as it is"),
    "surface_error": ("1", "relative error of the strain's surface by cross-validation"),
    "coverage": ("1", "share of a criterion's damage in the classes and seasons that were solved again"),
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
    "sublayer_modulus": ("Pa", "Young's modulus of a part of a course in a season"),
    "sublayer_modulus_young": ("Pa", "the same of the young mix"),
}

_GROWTH = {
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
    "parting_passes": ("1", "passes until the bond of an interface fails"),
    "parting_years": ("1", "years until the bond of an interface fails"),
}

_FOOTPRINT = {
    "computed_pressure": ("Pa", "computed contact pressure as the sensor tells it: a mean over each sensel"),
    "measured_pressure": ("Pa", "contact pressure that was measured"),
    "pressure_difference": ("Pa", "computed contact pressure, as the sensor tells it, less the measured one"),
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
    "overlap_of_pressure": ("1", "sum of the lesser of two pressures over that of the larger"),
    "overlap_of_area": ("1", "area that both maps load over area that either does"),
    "rms_difference": ("Pa", "root of the mean square of the difference where either map is loaded"),
    "correlation": ("1", "correlation of two maps over all sensels"),
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
    **_LIFE,
    **_CLIMATE,
    **_RELIABILITY,
    **_DESIGN,
    **_GROWTH,
    **_EQUIVALENTS,
    **_INTERFACES,
    **_PASSES,
    **_UNIFORM,
    **_FOOTPRINT,
    **_SWEEP,
    **_SCREENING,
    **_TIRE_CARD,
    **_HETEROGENEOUS,
}

# In this order an array has its dimensions, and who takes its values counts on it.
_ORDER = (
    "trial", "state", "criterion", "axle_class", "season", "month", "hour", "turn", "direction", "reading", "unknown",
    "input", "risk", "rut_layer", "year", "crack_depth", "solved_depth", "mean_pressure", "local_pressure", "mode",
    "other", "load", "map", "inflation_pressure", "wheel_load", "rib", "groove", "step", "position", "pass",
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


def attributes(name: str) -> dict[str, str]:
    """Attributes `units` and `long_name` of a variable."""
    units, long_name = VARIABLES[name]
    return {"units": units, "long_name": long_name}


def dataset(
    fields: Mapping[str, tuple[tuple[str, ...], Any]], coordinates: Mapping[str, Any], **attrs: Any
) -> xr.Dataset:
    """Dataset whose variables and coordinates carry their units and long names.

    fields: name → (dimensions, array). coordinates: name → 1-D array (or list of labels), or (dimension, array).
    """
    coords = {}
    for name, given in coordinates.items():
        dimension, values = given if isinstance(given, tuple) else (name, given)
        coords[name] = (dimension, np.asarray(values), attributes(name) if name in VARIABLES else {})
    variables = {name: (dims, np.asarray(data), attributes(name)) for name, (dims, data) in fields.items()}
    return xr.Dataset(variables, coords, dict(attrs))
