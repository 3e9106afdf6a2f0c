"""Measured roads: moduli of layers from deflection basins."""

from treadload.roads.backcalculate import backcalculate
from treadload.roads.basins import Basins
from treadload.roads.drop_histories import DropHistories, read_history
from treadload.roads.layout import BasinLayout
from treadload.roads.moving_basins import DualWheels, MovingBasins
from treadload.roads.moving_layout import MovingLayout
from treadload.roads.reading import read_basins
from treadload.roads.solution import Backcalculation

__all__ = [
    "Backcalculation",
    "BasinLayout",
    "Basins",
    "DropHistories",
    "DualWheels",
    "MovingBasins",
    "MovingLayout",
    "backcalculate",
    "read_basins",
    "read_history",
]
