"""treadload: what a tire does to a road.

This stub is the one statement of the public names: `treadload/__init__.py` reads it and loads each name when it is
first used; type checkers and editors read it too. One name a line.
"""

from treadload import catalogue as catalogue
from treadload import contact as contact
from treadload import damage as damage
from treadload import footprint as footprint
from treadload import life as life
from treadload import materials as materials
from treadload import pavement as pavement
from treadload import plots as plots
from treadload import response as response
from treadload import results as results
from treadload import roads as roads
from treadload import steps as steps
from treadload import sweeps as sweeps
from treadload import tire as tire
from treadload._version import __version__ as __version__
from treadload.calibration import calibrate as calibrate
from treadload.case import Case as Case
from treadload.contact import Rolling as Rolling
from treadload.contact import solve_contact as solve_contact
from treadload.damage import FatigueLine as FatigueLine
from treadload.damage import assess as assess
from treadload.errors import InputError as InputError
from treadload.footprint import Footprint as Footprint
from treadload.footprint import compare as compare
from treadload.life import Design as Design
from treadload.life import solve_life as solve_life
from treadload.materials import Elastic as Elastic
from treadload.pavement import Layer as Layer
from treadload.pavement import Pavement as Pavement
from treadload.reporting import report as report
from treadload.response import UniformDisc as UniformDisc
from treadload.response import UniformRectangle as UniformRectangle
from treadload.response import solve_response as solve_response
from treadload.results import open_results as open_results
from treadload.results import save_results as save_results
from treadload.roads import backcalculate as backcalculate
from treadload.steps import plan as plan
from treadload.steps import run as run
from treadload.sweeps import sweep as sweep
from treadload.tire import Tire as Tire
from treadload.tire import example_mesh as example_mesh
