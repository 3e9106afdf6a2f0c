"""What a case can ask for, step by step; each becomes a result.

The order of the modules is that of the results in a file. A case has one source, the step that the others follow; a
contact serves where no other is asked for.
"""

# isort: off
from treadload.steps.contact import ContactStep
from treadload.steps.footprint import FootprintStep
from treadload.steps.response import ResponseStep
from treadload.steps.slices import SlicesStep
from treadload.steps.bowl import BowlStep
from treadload.steps.damage import DamageStep
from treadload.steps.passes import PassesStep
from treadload.steps.aggregates import AggregatesStep
from treadload.steps.texture import EnvelopingStep, TextureStep
from treadload.steps.crossing import CrossingStep
from treadload.steps.pitch import PitchStep
from treadload.steps.uniform import UniformStep
from treadload.steps.indentation import DrumStep, IndentationStep
from treadload.steps.life import LifeStep
from treadload.steps.rutting import RuttingStep
from treadload.steps.sensitivity import SensitivityStep
from treadload.steps.reliability import ReliabilityStep
from treadload.steps.field_shift import FieldShiftStep
from treadload.steps.growth import GrowthStep
from treadload.steps.equivalents import EquivalentsStep
from treadload.steps.remedies import RemediesStep
from treadload.steps.calibration import CalibrationStep

# isort: on
from treadload.case import Case
from treadload.case.step import Source, Step
from treadload.steps.backcalculation import StructureFile
from treadload.steps.chain import Result, plan, run
from treadload.steps.design import design_case, design_of
from treadload.steps.outline import Outline
from treadload.steps.scene import Options, Progress, Scene, stream
from treadload.steps.script import Script, case_as_python

Case.take_steps(())

__all__ = [
    "AggregatesStep", "BowlStep", "CalibrationStep", "ContactStep", "CrossingStep", "DamageStep", "DrumStep",
    "EnvelopingStep", "EquivalentsStep", "FieldShiftStep", "FootprintStep", "GrowthStep",
    "IndentationStep", "LifeStep", "Options",
    "Outline", "PassesStep", "PitchStep", "Progress", "ReliabilityStep", "RemediesStep", "ResponseStep", "Result",
    "RuttingStep", "Scene", "Script", "SensitivityStep", "SlicesStep", "Source", "Step", "StructureFile",
    "TextureStep",
    "UniformStep",
    "case_as_python",
    "design_case", "design_of", "plan", "run", "stream",
]  # fmt: skip
