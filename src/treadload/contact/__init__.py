"""Contact of tire and road: pressure, shear, stick and slip."""

from treadload.contact import friction
from treadload.contact.crossing import Crossing, cross_obstacle
from treadload.contact.curve import CreepCurve, creep_curve
from treadload.contact.enveloped import Enveloped, envelop
from treadload.contact.indentation import Indentation, solve_indentation
from treadload.contact.maneuver import STRAIGHT, Maneuver
from treadload.contact.pitch import PitchPassage, solve_pitch
from treadload.contact.resistance import RollingResistance, rolling_resistance
from treadload.contact.rolling_state import Rolling
from treadload.contact.rough import TextureContact, solve_texture
from treadload.contact.solution import Contact
from treadload.contact.solve import solve_contact
from treadload.contact.transient import TransientResult, solve_transient
from treadload.contact.turning import TurnResult, turn_on_the_spot

__all__ = [
    "STRAIGHT",
    "Contact",
    "CreepCurve",
    "Crossing",
    "Enveloped",
    "Indentation",
    "Maneuver",
    "PitchPassage",
    "Rolling",
    "RollingResistance",
    "TextureContact",
    "TransientResult",
    "TurnResult",
    "creep_curve",
    "cross_obstacle",
    "envelop",
    "friction",
    "rolling_resistance",
    "solve_contact",
    "solve_indentation",
    "solve_pitch",
    "solve_texture",
    "solve_transient",
    "turn_on_the_spot",
]
