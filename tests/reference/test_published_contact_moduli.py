"""Contact moduli of crystals in any direction against those published with a contact law for anisotropic grains.

Mowlavi & Kamrin (2021), Granular Matter 23, doi:10.1007/s10035-021-01104-7: tables of 30 x 60 directions of the
normal, in the code that accompanies the paper (AnisotropicGrains, MIT licence). Elastic constants, GPa, are theirs.
"""

import numpy as np
import pytest

from treadload.kernels.anisotropy.stiffness import rotated
from treadload.kernels.anisotropy.symbol import surface_symbol

IRON = {"11": 231.4, "22": 231.4, "33": 231.4, "12": 134.7, "13": 134.7, "23": 134.7, "44": 116.4, "55": 116.4,
        "66": 116.4}  # fmt: skip
QUARTZ = {"11": 87.26, "22": 87.26, "33": 105.8, "12": 6.57, "13": 11.95, "23": 11.95, "44": 57.15, "55": 57.15,
          "66": 40.345, "14": -17.18, "24": 17.18, "56": -17.18}  # fmt: skip
ZIRCONIA = {"11": 361, "22": 408, "33": 258, "44": 99.9, "55": 81.2, "66": 126, "12": 142, "13": 55, "23": 196,
            "15": -21.3, "25": 31.2, "35": -18.2, "46": -22.7}  # fmt: skip
# Rows and columns of the tables: polar angle π i / 29 and azimuth 2π j / 59 of the normal.
PLACES = ((5, 7), (12, 33), (15, 0), (22, 50))


def stiffness(constants):
    matrix = np.zeros((6, 6))
    for (i, j), value in constants.items():
        matrix[int(i) - 1, int(j) - 1] = matrix[int(j) - 1, int(i) - 1] = value
    return matrix


def contact_modulus(matrix, polar, azimuth):
    """E*, with which the mean of the point load over directions is 1/πE* r."""
    normal = np.array([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
    along = np.cross(normal, [0.3, 0.5, 0.8])
    along /= np.linalg.norm(along)
    symbol = surface_symbol(rotated(matrix, np.array([along, np.cross(normal, along), normal])))
    return 2 / symbol.harmonics[2, 2, symbol.order].real


@pytest.mark.parametrize(
    ("constants", "published"),
    [
        (IRON, [230.2416339328429, 226.77987364599892, 215.84813540537826, 237.00392120040394]),
        (QUARTZ, [101.48389631517304, 94.34859164432198, 89.26202038778641, 98.9555841543294]),
        (ZIRCONIA, [204.11426921413417, 310.12638401904815, 299.1911912724873, 273.5438312946346]),
    ],
    ids=["iron", "quartz", "monoclinic zirconia"],
)
def test_contact_moduli_of_crystals_are_those_published(constants, published):
    matrix = stiffness(constants)
    found = [contact_modulus(matrix, np.pi * i / 29, 2 * np.pi * j / 59) for i, j in PLACES]
    # Round-off: the whole tables agree to 1e-15.
    assert found == pytest.approx(published, rel=1e-13)
