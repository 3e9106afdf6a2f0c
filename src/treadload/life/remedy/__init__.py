"""Remedies of a road: each change that an agency can make, by one stated step, solved again and ranked."""

from treadload.life.remedy.solution import Remedies
from treadload.life.remedy.solve import remedies
from treadload.life.remedy.steps import KINDS, RemedySteps

__all__ = ["KINDS", "Remedies", "RemedySteps", "remedies"]
