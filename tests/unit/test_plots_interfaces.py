"""Figures of the bond: maps with arrows on one scale, bars of the lives."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import QuadMesh
from matplotlib.quiver import Quiver

from treadload.damage import InterfaceStrength, ShearFatigue, assess_bonds
from treadload.errors import InputError
from treadload.life import solve_interfaces
from treadload.materials import Elastic
from treadload.pavement import BONDED, FRICTIONLESS, Bond, Layer, Pavement
from treadload.plots import bond_utilisation, bonded_and_parted, png, sliding
from treadload.response import UniformRectangle

X = np.linspace(-0.25, 0.25, 21)
BRAKED = UniformRectangle(0.2, 0.2, 0.8e6, traction_x=0.4e6)


def _road(bond):
    return Pavement(
        [
            Layer(Elastic(7e9, 0.35), 0.06, name="wearing course", bond=bond),
            Layer(Elastic(9e9, 0.35), 0.15, name="base"),
            Layer(Elastic(120e6, 0.35), name="soil"),
        ]
    )


@pytest.fixture(scope="module")
def fields():
    return solve_interfaces(BRAKED, _road(BONDED), x=X, y=X)


def test_maps_share_a_scale_and_arrows_follow_the_braked_wheel(fields):
    verdict = assess_bonds(fields, InterfaceStrength(1e6), ShearFatigue(-0.1))
    figure = bond_utilisation(verdict)
    maps = [ax for ax in figure.axes if ax.get_xlabel()]
    assert [ax.get_title(loc="left") for ax in maps] == [
        "Interface 1, below wearing course",
        "Interface 2, below base",
    ]
    meshes = [next(c for c in ax.collections if isinstance(c, QuadMesh)) for ax in maps]
    assert len({mesh.get_clim() for mesh in meshes}) == 1
    for k, mesh in enumerate(meshes):
        wanted = verdict.dataset["utilisation"].isel(interface=k).to_numpy()
        np.testing.assert_allclose(np.asarray(mesh.get_array()).ravel(), wanted.ravel())
    for k, ax in enumerate(maps):
        arrows = next(c for c in ax.collections if isinstance(c, Quiver))
        assert 20 < len(arrows.U) < 600
        at = fields.isel(interface=k).sel(
            x=xr.DataArray(arrows.X / 1e3), y=xr.DataArray(arrows.Y / 1e3), method="nearest"
        )
        # The tire pushes the road ahead, and the upper layer the lower: minus the traction on the plane facing down.
        along, across = -at["interface_shear_x"].to_numpy(), -at["interface_shear_y"].to_numpy()
        scale = np.hypot(arrows.U, arrows.V).max() / np.hypot(along, across).max()
        np.testing.assert_allclose(arrows.U, scale * along, atol=1e-9)
        np.testing.assert_allclose(arrows.V, scale * across, atol=1e-9)
    ahead = fields["interface_shear_x"].isel(interface=0).sel(x=0.0, y=0.0, method="nearest")
    assert float(ahead) < 0
    assert png(figure, dpi=40).startswith(b"\x89PNG")


def test_only_interfaces_with_a_strength_are_drawn(fields):
    figure = bond_utilisation(assess_bonds(fields, [None, InterfaceStrength(1e6)]))
    assert [ax.get_title(loc="left") for ax in figure.axes if ax.get_xlabel()] == ["Interface 2, below base"]
    with pytest.raises(InputError, match="needs utilisation"):
        bond_utilisation(fields)


def test_free_and_parted_interfaces_are_drawn():
    pressing = UniformRectangle(0.2, 0.2, 0.8e6)
    free = solve_interfaces(pressing, _road(FRICTIONLESS), x=X, y=X)
    strengths = (InterfaceStrength(1e6), InterfaceStrength(0.0, math.radians(10), 0.0))
    figure = bond_utilisation(assess_bonds(free, strengths, ShearFatigue(-0.1)))
    assert png(figure, dpi=40).startswith(b"\x89PNG")


def _compared(years, parting):
    return xr.Dataset(
        {"life_years": (("state", "criterion"), years), "parting_years": ((), parting)},
        {"state": ["bonded", "parted", "bonded, then parted"], "criterion": ["top", "base", "bond"]},
        {"interface": 0, "bond": "frictionless", "parts": "bond"},
    )


def test_bars_are_the_lives():
    years = [[30.0, math.inf, 3.0], [6.0, 2e5, math.inf], [8.0, 2e5, 3.0]]
    figure = bonded_and_parted(_compared(years, 3.0))
    ax = figure.axes[0]
    assert [t.get_text() for t in ax.get_yticklabels()] == ["top", "base"]
    ends = [[bar.get_x() + bar.get_width() for bar in group] for group in ax.containers]
    assert [ends[k][0] for k in range(3)] == pytest.approx([30, 6, 8])
    assert [ends[k][1] for k in (1, 2)] == pytest.approx([2e5, 2e5])
    words = [t.get_text() for t in ax.texts]
    assert "never" in words
    assert "30 years" in words
    assert "the bond fails, 3 years" in words
    assert png(figure, dpi=40).startswith(b"\x89PNG")


def test_a_bond_that_never_parts_has_no_line():
    ax = bonded_and_parted(_compared([[30.0, 20.0, math.inf]] * 3, math.inf)).axes[0]
    assert not any("fails" in t.get_text() for t in ax.texts)
    with pytest.raises(InputError, match="no lives to compare"):
        bonded_and_parted(_compared([[math.inf] * 3] * 3, math.inf))


def test_sliding_is_drawn_where_layers_slide_and_points_the_way_of_the_upper_one(fields):
    figure = sliding(solve_interfaces(BRAKED, _road(Bond(1e9)), x=X, y=X))
    maps = [ax for ax in figure.axes if ax.get_xlabel()]
    assert [ax.get_title(loc="left") for ax in maps] == ["Interface 1, below wearing course"]
    arrows = next(c for c in maps[0].collections if isinstance(c, Quiver))
    # The road is pushed ahead, and its upper layer with it.
    assert np.mean(arrows.U) > 0
    assert len(png(figure)) > 10_000
    with pytest.raises(InputError, match="nothing slides"):
        sliding(fields)
    with pytest.raises(InputError, match="frictionless, whose sliding is not solved"):
        sliding(solve_interfaces(BRAKED, _road(FRICTIONLESS), x=X, y=X))
