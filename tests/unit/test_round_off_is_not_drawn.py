"""Shear that is round-off of the solver is not drawn: a sentence with its size stands in its place."""

import numpy as np
import pytest

from treadload import variables
from treadload.plots import contact as figures
from treadload.plots.interactive.field import shear_field
from treadload.plots.kit.plan import fields_of
from treadload.reporting.tables import _shear


def rolled(shear: float, pressure: float = 1.237679e9):
    """A contact of a stiff wheel, whose peaks are given in Pa."""
    x = y = 1e-4 * (np.arange(21) - 10)
    inside = np.maximum(1 - (x[None] ** 2 + y[:, None] ** 2) / 0.8e-6, 0)
    dims = ("y", "x")
    fields = {
        "pressure": (dims, pressure * np.sqrt(inside)),
        "traction_x": (dims, shear * np.sqrt(inside)),
        "traction_y": (dims, 0 * inside),
        "state": (dims, np.where(inside > 0, 1 + (x[None] > 0), 0)),
    }
    return variables.dataset(fields, {"y": y, "x": x}, dx=1e-4, dy=1e-4)


def words(figure):
    return " ".join(text.get_text().replace("\n", " ") for ax in figure.axes for text in ax.texts)


@pytest.mark.parametrize("draw", [figures.stick_slip, figures.shear])
def test_a_figure_says_that_shear_is_round_off(draw):
    told = words(draw(rolled(420.0)))
    assert "0.42 kPa is round-off" in told
    assert "1.24 GPa" in told
    assert "round-off" not in words(draw(rolled(4e8)))


def test_round_off_has_no_scale_of_its_own():
    figure = figures.stick_slip(rolled(420.0))
    # A map and no colour bar beside it.
    assert not figure.axes[0].child_axes
    assert figures.stick_slip(rolled(4e8)).axes[0].child_axes


def test_the_page_and_the_tables_show_none_either():
    field = shear_field(rolled(420.0))
    assert not np.nan_to_num(field.values).any()
    assert not _shear(rolled(420.0)).any()
    assert _shear(rolled(4e8)).max() == pytest.approx(4e8)


def test_small_shear_of_a_tire_is_no_round_off():
    """0.42 kPa under 800 kPa is far above what the solver leaves, and is drawn."""
    assert "shear_round_off" not in fields_of(rolled(420.0, 8e5), "traction_x").attrs
