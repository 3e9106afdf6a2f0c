"""Soil by its bearing ratio."""

from treadload.materials import Elastic
from treadload.units import Number, Share


def soil(cbr: Share, poisson: Number = 0.4) -> Elastic:
    """Soil by its bearing ratio, 17.6 MPa CBR^0.64 (Powell et al. 1984).

    cbr: bearing ratio, 5 % is 0.05. poisson: Poisson's ratio.
    """
    return Elastic(17.6e6 * (100 * cbr) ** 0.64, poisson)
