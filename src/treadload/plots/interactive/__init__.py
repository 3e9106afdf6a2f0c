"""Figures that are looked at in a browser: linked maps, profiles along a line, sections, the tread in space.

Functions of datasets, as all figures of the package, so that a file is enough; they return Figures of plotly, which
the extra "app" brings.
"""

from treadload.plots.interactive.basins import basin_fit, moduli_profile
from treadload.plots.interactive.browser_grids import MOST_HELD, held_numbers, profile_held, section_held
from treadload.plots.interactive.cut import Cut, depth_slice, profiles
from treadload.plots.interactive.drawing import figure
from treadload.plots.interactive.field import (
    Field,
    choices,
    damage_field,
    extension_field,
    field_of,
    pressure_field,
    shear_field,
    variable_field,
    with_outline,
    zones_field,
)
from treadload.plots.interactive.maps import difference_map, linked_maps, marked
from treadload.plots.interactive.places import Place, places_of
from treadload.plots.interactive.solid import tread
from treadload.plots.interactive.theme import DARK, LIGHT, Theme, colour_scale, theme_of
from treadload.plots.interactive.view import (
    CONFIG,
    LinkedView,
    contact_view,
    link_script,
    plotly_script,
    response_view,
    verdict_view,
)

__all__ = [
    "CONFIG",
    "DARK",
    "LIGHT",
    "MOST_HELD",
    "Cut",
    "Field",
    "LinkedView",
    "Place",
    "Theme",
    "basin_fit",
    "choices",
    "colour_scale",
    "contact_view",
    "damage_field",
    "depth_slice",
    "difference_map",
    "extension_field",
    "field_of",
    "figure",
    "held_numbers",
    "link_script",
    "linked_maps",
    "marked",
    "moduli_profile",
    "places_of",
    "plotly_script",
    "pressure_field",
    "profile_held",
    "profiles",
    "response_view",
    "section_held",
    "shear_field",
    "theme_of",
    "tread",
    "variable_field",
    "verdict_view",
    "with_outline",
    "zones_field",
]
