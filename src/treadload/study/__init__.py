"""From a case to its results, from a traffic to a life."""

from treadload.study.as_python import case_as_python
from treadload.study.calibration import Calibration, calibrate
from treadload.study.delamination import BondComparison, compare_bonds, solve_interfaces
from treadload.study.dents import Dents, run_dents
from treadload.study.designing import ThicknessDesign, design_thickness
from treadload.study.equivalents import Equivalents, life_equivalents
from treadload.study.growth import grow_cracks
from treadload.study.life import solve_life
from treadload.study.loaded import map_grid
from treadload.study.passages import Passages, solve_passages
from treadload.study.plan import plan_case, plan_life
from treadload.study.reliability import Reliability, life_reliability
from treadload.study.run import Result, run_case
from treadload.study.run_calibration import CalibrationResult, plan_calibration, run_calibration
from treadload.study.run_life import LifeResult, design_case, run_life
from treadload.study.screening import Morris, Sobol, Tornado, morris, sobol, tornado
from treadload.study.sensitivity import Sensitivity, life_sensitivity
from treadload.study.shakedown import shakedown_map
from treadload.study.sweeps import Sweep, open_sweep, sampled, sweep
from treadload.study.tire_card import TireCard, tire_card
from treadload.study.two_grids import assess_on_two_grids
from treadload.study.uniform import UniformComparison, compare_uniform

__all__ = [
    "BondComparison",
    "Calibration",
    "CalibrationResult",
    "Dents",
    "Equivalents",
    "LifeResult",
    "Morris",
    "Passages",
    "Reliability",
    "Result",
    "Sensitivity",
    "Sobol",
    "Sweep",
    "ThicknessDesign",
    "TireCard",
    "Tornado",
    "UniformComparison",
    "assess_on_two_grids",
    "calibrate",
    "case_as_python",
    "compare_bonds",
    "compare_uniform",
    "design_case",
    "design_thickness",
    "grow_cracks",
    "life_equivalents",
    "life_reliability",
    "life_sensitivity",
    "map_grid",
    "morris",
    "open_sweep",
    "plan_calibration",
    "plan_case",
    "plan_life",
    "run_calibration",
    "run_case",
    "run_dents",
    "run_life",
    "sampled",
    "shakedown_map",
    "sobol",
    "solve_interfaces",
    "solve_life",
    "solve_passages",
    "sweep",
    "tire_card",
    "tornado",
]
