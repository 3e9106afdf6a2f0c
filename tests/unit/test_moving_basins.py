"""Slopes ahead of rolling wheels: the derivative of a basin, the solver of moving loads, moduli found again."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.errors import InputError
from treadload.materials import Prony
from treadload.roads import DualWheels, MovingBasins, MovingLayout, backcalculate, read_basins
from treadload.roads.model import thicknesses
from treadload.roads.moving_model import moving_models
from treadload.roads.unknowns import layer_names, pose

OFFSETS = np.array([-0.3, 0.1, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2, 1.5])
LOAD, SPEED = 50e3, 20.0
WHEELS = DualWheels(spacing=0.34, width=0.24, length=0.22)
ASPHALT = Prony(1e10, ((0.5, 0.01), (0.4, 0.1)), 0.35)


def road(top=ASPHALT, thickness=0.15):
    return tl.Pavement(
        [
            tl.Layer(top, thickness, name="asphalt"),
            tl.Layer(tl.Elastic(3e8, 0.35), 0.3, name="base"),
            tl.Layer(tl.Elastic(7e7, 0.4), name="soil"),
        ]
    )


def slopes(structure, *, wheels=WHEELS, speed=SPEED, stiff=10.0, offsets=OFFSETS, side=0.0):
    """Slopes under 50 kN of the model that is fitted, its moduli those of the structure."""
    basins = MovingBasins(np.ones((1, len(offsets))), offsets, LOAD, speed, wheels, side=side)
    unknowns = pose(structure, stiff_layer=stiff, memory=True)
    table = thicknesses(basins, unknowns, layer_names(structure))
    (model,) = moving_models(basins, unknowns, table, np.array([0]))
    moduli = [
        abs(ASPHALT.complex_modulus(20 * math.pi)) if layer.material is ASPHALT else layer.material.modulus
        for layer in structure.layers
    ]
    return model.deflection(np.log(moduli)[None, None])[0, 0]


def derivative(structure, *, stiff=10.0, offsets=OFFSETS, side=0.0, loads=None, **more):
    """The same by differences of the deflection that `solve_response` gives."""
    layers = list(structure.layers)
    if stiff is not None:
        deep = stiff - sum(layer.thickness for layer in layers[:-1])
        layers[-1] = tl.Layer(layers[-1].material, deep)
    step = 1e-3
    x = np.unique(np.round(np.concatenate([offsets + k * step for k in (-2, -1, 1, 2)]), 6))
    loads = WHEELS.loads if loads is None else loads
    response = tl.solve_response(
        list(loads), tl.Pavement(layers, rigid_base=stiff is not None), depths=[0.0], x=x, y=[side], **more
    )
    down = dict(zip(x.round(6), response.dataset["displacement_z"].values.ravel(), strict=True))
    u = {k: np.array([down[round(at + k * step, 6)] for at in offsets]) for k in (-2, -1, 1, 2)}
    return -LOAD * (8 * (u[1] - u[-1]) - (u[2] - u[-2])) / (12 * step)


@pytest.mark.parametrize("stiff", [10.0, None])
def test_without_memory_a_slope_is_the_derivative_of_the_static_basin(stiff):
    """Differences of fourth order over 1 mm and interpolated kernels leave 3e-5 of each slope, 1.5 m ahead."""
    structure = road(tl.Elastic(5e9, 0.35))
    expected = derivative(structure, stiff=stiff)
    np.testing.assert_allclose(slopes(structure, stiff=stiff), expected, rtol=3e-5, atol=1e-6 * expected.max())


def test_with_memory_it_is_that_of_the_solver_of_moving_loads():
    expected = derivative(road(), speed=SPEED)
    values = slopes(road())
    np.testing.assert_allclose(values, expected, rtol=3e-5, atol=1e-6 * expected.max())
    # Memory matters: 0.3 m behind the wheels the surface comes back by a tenth less than it goes down ahead.
    assert -values[0] < 0.9 * values[3]


def test_slow_and_fast_wheels_reach_the_elastic_limits():
    for speed, limit in ((1e-4, ASPHALT.rubbery), (1e6, ASPHALT.glassy)):
        np.testing.assert_allclose(slopes(road(), speed=speed), slopes(road(limit)), rtol=2e-3)


def test_a_disc_a_grid_and_a_line_aside():
    structure = road(tl.Elastic(5e9, 0.35))
    disc = tl.UniformDisc(0.11, 1 / (math.pi * 0.11**2), y=0.2)
    grid = tl.response.GridLoad.from_arrays(np.array([[0.0, 1.0, 3.0], [1.0, 2.0, 0.0]]), spacing=0.06, y0=-0.2)
    total = disc.normal_load + grid.normal_load
    for side in (0.0, 0.04):
        value = slopes(structure, wheels=[disc, grid], side=side)
        expected = derivative(structure, loads=[disc, grid], side=side) / total
        np.testing.assert_allclose(value, expected, rtol=3e-5, atol=1e-6 * np.abs(expected).max())


def basins(values, **changed):
    given = {"offsets": OFFSETS, "load": LOAD, "speed": SPEED, "wheels": WHEELS} | changed
    return MovingBasins(np.atleast_2d(values), **given)


def test_moduli_come_back():
    measured = slopes(road())
    result = tl.backcalculate(basins(measured), road())
    wanted = [abs(ASPHALT.complex_modulus(20 * math.pi)), 3e8, 7e7]
    np.testing.assert_allclose(result.dataset["fitted_modulus"].values[0], wanted, rtol=1e-6)
    assert result.road(0).layers[0].material.modulus == pytest.approx(wanted[0])
    assert result.dataset["undecided"].values[0] == ""
    elastic = tl.backcalculate(basins(slopes(road(tl.Elastic(5e9, 0.35)))), road(tl.Elastic(1e9, 0.35)))
    np.testing.assert_allclose(elastic.dataset["fitted_modulus"].values[0], [5e9, 3e8, 7e7], rtol=1e-6)


def test_bars_cover_elastic_layers():
    """200 draws of 2 % and 5 µm/m: 90 % bars hold 85 to 95 % of each modulus, as binomial scatter of ± 2 % allows."""
    structure = road(tl.Elastic(5e9, 0.35))
    measured = slopes(structure)
    rng = np.random.default_rng(3)
    error = np.hypot(0.02 * measured, 5e-6)
    drawn = basins(measured + error * rng.standard_normal((200, len(OFFSETS))))
    data = backcalculate(drawn, structure, error=("2 %", "5 µm/m")).dataset
    wanted = np.array([5e9, 3e8, 7e7])
    inside = (data["modulus_low"] <= wanted) & (wanted <= data["modulus_high"])
    assert ((inside.mean("basin") >= 0.85) & (inside.mean("basin") <= 0.95)).all(), inside.mean("basin").values


@pytest.mark.slow
def test_bars_cover_layers_with_memory():
    measured = slopes(road())
    rng = np.random.default_rng(4)
    drawn = basins(measured * (1 + 0.02 * rng.standard_normal((200, len(OFFSETS)))))
    data = backcalculate(drawn, road(), error="2 %", jobs=2).dataset
    wanted = np.array([abs(ASPHALT.complex_modulus(20 * math.pi)), 3e8, 7e7])
    inside = ((data["modulus_low"] <= wanted) & (wanted <= data["modulus_high"])).mean("basin")
    assert ((inside >= 0.85) & (inside <= 0.95)).all(), inside.values


def test_temperature_shifts_the_times_of_a_mix():
    mix = next(entry.material for entry in tl.catalogue.materials.values() if hasattr(entry.material, "shift"))
    warm = road(mix)
    cold = basins(slopes(road(tl.Elastic(5e9, 0.35))))
    refused = backcalculate(cold, warm)
    assert "needs the temperature of the asphalt" in refused.dataset["reason"].values[0]
    fitted = backcalculate(basins(cold.slope, temperature=15.0), warm)
    assert fitted.dataset["basin_status"].values[0] < 2
    assert np.isfinite(fitted.dataset["modulus_at_reference"].values[0, 0])


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"load": 0.0}, "a load above 0"),
        ({"speed": 0.0}, "its speed is 0 m/s"),
        ({"speed": 70.0}, "check the unit"),
        ({"slope": -1.0}, "check their sign"),
        ({"slope": 100.0}, "beyond any road"),
    ],
)
def test_a_place_is_refused_with_its_reason(changed, words):
    factor = changed.pop("slope", 1.0)
    measured = slopes(road(tl.Elastic(5e9, 0.35)))[1:] * factor
    result = backcalculate(basins(measured, offsets=OFFSETS[1:], **changed), road(tl.Elastic(5e9, 0.35)))
    assert words in result.dataset["reason"].values[0]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"offsets": OFFSETS[::-1]}, "must rise"),
        ({"side": 0.17}, "passes 0 mm beside"),
        ({"load": [1.0, 2.0]}, "load needs one value"),
        ({"wheels": tl.UniformDisc(0.1, 0.0)}, "pressure above 0"),
    ],
)
def test_a_list_is_checked_as_a_whole(changed, words):
    with pytest.raises(InputError, match=words):
        basins(np.ones(len(OFFSETS)), **changed)


def test_wheels_and_errors_are_checked():
    with pytest.raises(InputError, match=r"leave a gap of 0 mm, less than 10 mm"):
        DualWheels(0.24, 0.24, 0.2)
    with pytest.raises(InputError, match="10 µm/m"):
        backcalculate(basins(np.ones(len(OFFSETS))), road(), error="2 µm")
    with pytest.raises(InputError, match="isotropic elastic layers"):
        tl.backcalculate(tl.roads.Basins([[1e-4, 5e-5]], [0, 0.3], 5e4, 0.15), road())


LAYOUT = MovingLayout(wheel_spacing=0.34, wheel_width=0.24, wheel_length=0.22, measures="velocity", load_of_all=5e4)


def test_a_table_of_velocities_is_read(tmp_path):
    file = tmp_path / "tsd.csv"
    file.write_text("station,speed [km/h],V300 [mm/s],V100 [mm/s],temperature\nA,72,6,8,21\nB,72,3,4,\n")
    read = read_basins(file, LAYOUT)
    np.testing.assert_allclose(read.slope, [[4e-4, 3e-4], [2e-4, 1.5e-4]])
    np.testing.assert_allclose(read.offsets, [0.1, 0.3])
    assert read.station == ("A", "B")
    assert read.speed[0] == pytest.approx(20)
    assert np.isnan(read.temperature[1])
    same = MovingBasins.from_velocity(read.slope * 20, read.offsets, 5e4, 20.0, WHEELS)
    np.testing.assert_allclose(same.slope, read.slope)
    for text, words in (
        ("speed [km/h],S300 [µm/m]\n72,6\n", "no column of a velocity"),
        ("speed,V300 [mm/s]\n72,6\n", r"speed \[km/h\]"),
        ("V300 [mm/s],load [kN]\n6,5\n", "no column 'speed'"),
        ("V300 [kN],speed [km/h]\n6,5\n", "no unit like km/h"),
    ):
        file.write_text(text)
        with pytest.raises(InputError, match=words):
            read_basins(file, LAYOUT)


def test_a_result_is_saved_and_drawn(tmp_path):
    drawn = basins(np.tile(slopes(road(tl.Elastic(5e9, 0.35))), (2, 1)))
    result = backcalculate(drawn, road(tl.Elastic(5e9, 0.35)))
    tl.save_results(result, tmp_path / "moduli.nc")
    again = tl.open_results(tmp_path / "moduli.nc").backcalculation
    assert again.summary() == result.summary()
    assert again.plot.basins().axes[0].get_ylabel().startswith("slope")
    state = tmp_path / "state"
    backcalculate(drawn, road(tl.Elastic(5e9, 0.35)), state=state)
    with pytest.raises(InputError, match="another backcalculation"):
        backcalculate(basins(drawn.slope, speed=10.0), road(tl.Elastic(5e9, 0.35)), state=state)
