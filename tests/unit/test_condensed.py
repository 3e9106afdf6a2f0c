"""Ribs that press with a share of their shear condensed out: the same operator and solution, in fewer products."""

import numpy as np
import pytest

import treadload as tl
from treadload.contact.bodies import Influence, Pair, condensed
from treadload.contact.bodies.condensed import CondensedInfluence
from treadload.contact.bodies.influence import forget_operators
from treadload.contact.solvers.normal import solve_normal
from treadload.grid import Grid
from treadload.materials import Prony
from treadload.tire import TreadProfile
from treadload.tire.grooves import Groove

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
NARROW = TreadProfile(
    0.5, 0.8, 0.12, grooves=(Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015)), shoulder_radius=0.005
)


def narrow_tire(tread="ribs", rubber=None):
    belt = tl.tire.Belt(tread=rubber or tl.Elastic(5.5e6, 0.495), bending=(80, 100, 150))
    return tl.Tire.from_profile(NARROW, inflation_pressure=820e3, belt=belt, tread=tread)


def operators_of(tire, **speed):
    grid = Grid.on_lattice(0.06, 0.12, 6e-3, 4e-3)
    return Influence(grid.shape, grid.dx, grid.dy, Pair.of(tire, ROAD, **speed).both, grid.y0)


def test_both_parts_together_are_the_opening_of_the_pair():
    influence = operators_of(narrow_tire())
    apart = CondensedInfluence.of(influence)
    random = np.random.default_rng(3)
    pressure = random.random(influence.shape) * influence.material[:, None]
    shear = random.standard_normal((2, *influence.shape)) * influence.material[:, None]
    opening = apart.normal(pressure) + apart.gap_by(shear, pressure)
    whole = influence.displacement(pressure, shear)[2]
    # Sums of some hundred terms in double precision.
    np.testing.assert_allclose(opening, whole, rtol=0, atol=1e-12 * np.abs(whole).max())
    # A rib whose face is held is stiffer, 3.2 E for 2.1 E: half of the compliance that this takes leaves 0.8 of it.
    stiffer = (pressure * apart.normal(pressure)).sum() / (pressure * influence.normal(pressure)).sum()
    assert 0.7 < stiffer < 1.0


def test_the_condensed_operator_is_symmetric_and_positive():
    apart = CondensedInfluence.of(operators_of(narrow_tire()))
    rows = apart.material
    cells = int(rows.sum()) * apart.shape[1]
    columns = []
    for load in range(cells):
        field, whole = np.zeros((int(rows.sum()), apart.shape[1])), np.zeros(apart.shape)
        field.flat[load] = 1.0
        whole[rows] = field
        columns.append(apart.normal(whole)[rows].ravel())
    matrix = np.array(columns).T
    # The bound of the plain operator in `treadload validate`.
    assert np.abs(matrix - matrix.T).max() < 1e-12 * np.abs(matrix).max()
    assert np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[0] > 0


def test_only_elastic_ribs_have_one():
    assert CondensedInfluence.of(operators_of(narrow_tire("layer"))) is None
    prony = Prony(5.5e6, ((0.5, 0.01),), 0.495)
    assert CondensedInfluence.of(operators_of(narrow_tire(rubber=prony), speed=5.0)) is None
    influence = operators_of(narrow_tire())
    assert CondensedInfluence.of(influence) is CondensedInfluence.of(influence)


def test_a_pressure_in_single_precision_steps_meets_the_tolerance():
    """The inner loop runs in single precision; the conditions hold in double precision far below its 1e-7."""
    influence = operators_of(narrow_tire())
    grid = Grid.on_lattice(0.06, 0.12, 6e-3, 4e-3)
    gap = np.where(influence.material[:, None], narrow_tire().height_map(grid), np.nan)
    normal = solve_normal(influence, gap, load=2e3, tolerance=1e-10)
    after = gap + influence.normal(normal.pressure) - normal.approach
    pressed = normal.pressure > 0
    assert np.abs(after[pressed]).max() < 1e-10 * normal.approach
    assert np.nanmin(after) > -1e-10 * normal.approach
    assert normal.pressure.sum() * grid.cell_area == pytest.approx(2e3, rel=1e-12)


@pytest.mark.parametrize("wheel", [{}, {"creepage_y": 0.01}, {"friction": 0.1}], ids=["free", "steered", "slippery"])
def test_the_share_changes_the_work_and_not_the_solution(wheel, monkeypatch):
    rolling = tl.Rolling(**({"normal_load": 8e3, "friction": 0.7} | wheel))
    contacts = []
    for share in (condensed._SHARE, 0.0):
        monkeypatch.setattr(condensed, "_SHARE", share)
        forget_operators()
        contacts.append(tl.solve_contact(narrow_tire(), ROAD, rolling, spacing=4e-3, tolerance=1e-7))
    forget_operators()
    foreseen, plain = contacts
    peak = float(plain.dataset.pressure.max())
    for name in ("pressure", "traction_x", "traction_y"):
        difference = np.abs(foreseen.dataset[name] - plain.dataset[name]).max()
        # The tolerance is of a mean over the cells; at the edge of slip a cell differs by some hundred times as much.
        assert float(difference) < 3e-5 * peak
    assert float(foreseen.dataset.approach) == pytest.approx(float(plain.dataset.approach), rel=1e-7)
    assert foreseen.stats["coupling_rounds"] <= plain.stats["coupling_rounds"]
    if not wheel:
        assert foreseen.stats["krylov_iterations"] < plain.stats["krylov_iterations"]
        assert foreseen.stats["normal_iterations"] < plain.stats["normal_iterations"]
