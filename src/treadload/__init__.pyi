"""treadload: what a tire does to a road.

This stub is the one statement of the public names: `treadload/__init__.py` reads it and loads each name when it is
first used; type checkers and editors read it too. One name a line.
"""

from treadload import catalogue as catalogue
from treadload import contact as contact
from treadload import damage as damage
from treadload import footprint as footprint
from treadload import materials as materials
from treadload import pavement as pavement
from treadload import plots as plots
from treadload import response as response
from treadload import results as results
from treadload import study as study
from treadload import tire as tire
from treadload._version import __version__ as __version__
from treadload.case import Case as Case
from treadload.case import LifeCase as LifeCase
from treadload.contact import Contact as Contact
from treadload.contact import Maneuver as Maneuver
from treadload.contact import Rolling as Rolling
from treadload.contact import friction as friction
from treadload.contact import solve_contact as solve_contact
from treadload.contact import solve_indentation as solve_indentation
from treadload.contact import solve_transient as solve_transient
from treadload.damage import FatigueLine as FatigueLine
from treadload.damage import Verdict as Verdict
from treadload.damage import assess as assess
from treadload.errors import ConvergenceError as ConvergenceError
from treadload.errors import GeometryError as GeometryError
from treadload.errors import InputError as InputError
from treadload.errors import TreadloadError as TreadloadError
from treadload.footprint import compare as compare
from treadload.grid import Grid as Grid
from treadload.materials import Aggregates as Aggregates
from treadload.materials import Elastic as Elastic
from treadload.materials import ElastoPlastic as ElastoPlastic
from treadload.materials import Orthotropic as Orthotropic
from treadload.materials import TransverselyIsotropic as TransverselyIsotropic
from treadload.pavement import BONDED as BONDED
from treadload.pavement import FRICTIONLESS as FRICTIONLESS
from treadload.pavement import Bond as Bond
from treadload.pavement import Layer as Layer
from treadload.pavement import Pavement as Pavement
from treadload.reporting import report as report
from treadload.response import GridLoad as GridLoad
from treadload.response import Response as Response
from treadload.response import UniformDisc as UniformDisc
from treadload.response import UniformRectangle as UniformRectangle
from treadload.response import compute_heterogeneous as compute_heterogeneous
from treadload.response import dual_wheels as dual_wheels
from treadload.response import place_load as place_load
from treadload.response import roll_passes as roll_passes
from treadload.response import solve_response as solve_response
from treadload.results import open_results as open_results
from treadload.results import save_results as save_results
from treadload.study import LifeResult as LifeResult
from treadload.study import calibrate as calibrate
from treadload.study import compare_uniform as compare_uniform
from treadload.study import run_case as run_case
from treadload.study import run_life as run_life
from treadload.study import sweep as sweep
from treadload.tire import Belt as Belt
from treadload.tire import Tire as Tire
from treadload.tire import example_mesh as example_mesh
