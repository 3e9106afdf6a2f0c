"""How cracks grow: fracture mechanics on the uncracked stress, Paris' law, and when a crack has come how deep."""

from treadload.damage.growth.advance import chances, grown, risk_quantiles
from treadload.damage.growth.intensity import Crossing, crack_paths, intensity_ranges
from treadload.damage.growth.laws import PARIS, FromStrength, GrowthLaw, ParisLaw, law_of_mix
from treadload.damage.growth.options import CrackGrowth
from treadload.damage.growth.solution import Growth

__all__ = [
    "PARIS",
    "CrackGrowth",
    "Crossing",
    "FromStrength",
    "Growth",
    "GrowthLaw",
    "ParisLaw",
    "chances",
    "crack_paths",
    "grown",
    "intensity_ranges",
    "law_of_mix",
    "risk_quantiles",
]
