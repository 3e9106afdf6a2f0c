"""Deflections over time under a falling weight: the static limit, creep in closed form, moduli found again."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.errors import InputError
from treadload.materials import Prony
from treadload.roads import Basins, DropHistories, backcalculate, read_history
from treadload.roads.history_model import history_models
from treadload.roads.model import models, thicknesses
from treadload.roads.unknowns import layer_names, pose

OFFSETS = np.array([0.0, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2, 1.5])
TIME = np.arange(300) * 2e-4
FORCE = 50e3 * np.where(TIME < 0.03, np.sin(math.pi * TIME / 0.03) ** 2, 0.0)
ASPHALT = Prony(1e10, ((0.5, 0.01), (0.4, 0.1)), 0.35)


def road(top=ASPHALT):
    return tl.Pavement(
        [
            tl.Layer(top, 0.15, name="asphalt"),
            tl.Layer(tl.Elastic(3e8, 0.35), 0.3, name="base"),
            tl.Layer(tl.Elastic(7e7, 0.4), name="soil"),
        ]
    )


def drop(deflection, time=TIME, force=FORCE, **changed):
    return DropHistories(time, force, deflection, OFFSETS, 0.15, **changed)


def shown(structure, time=TIME, force=FORCE, moduli=None, **changed):
    """Deflections (s, nt) at all times that the model shows, its moduli those of the structure."""
    blank = drop(np.ones((len(OFFSETS), len(time))) * 1e-4, time, force, **changed)
    unknowns = pose(structure, memory=True)
    (model,) = history_models(blank, unknowns, thicknesses(blank, unknowns, layer_names(structure)), np.array([0]))
    if moduli is None:
        size = 20 * math.pi
        moduli = [
            abs(layer.material.complex_modulus(size)) if layer.material is ASPHALT else layer.material.modulus
            for layer in structure.layers
        ]
    return model.deflection(np.log(moduli)[None, None])[0, 0].reshape(len(OFFSETS), -1), blank.fitted_times


def static(structure, plate="uniform"):
    moduli = [layer.material.modulus for layer in structure.layers]
    basins = Basins(np.ones((1, len(OFFSETS))), OFFSETS, 1.0, 0.15, plate)
    unknowns = pose(structure)
    (model,) = models(basins, unknowns, thicknesses(basins, unknowns, layer_names(structure)), np.array([0]))
    return model.deflection(np.log(moduli)[None, None])[0, 0]


@pytest.mark.parametrize("plate", ["uniform", "rigid"])
def test_slow_drops_show_the_static_basin_and_fast_ones_that_of_glass(plate):
    """ω → 0: a force that rises over 10⁶ relaxation times follows the long-term moduli to 1e-6."""
    slow = Prony(1e10, ((0.5, 1e-10), (0.4, 1e-9)), 0.35)
    moduli = [abs(slow.complex_modulus(20 * math.pi)), 3e8, 7e7]
    values, at = shown(road(slow), moduli=moduli, plate=plate)
    expected = FORCE[at] * static(road(slow.rubbery), plate)[:, None]
    np.testing.assert_allclose(values, expected, atol=1e-6 * expected.max())
    lazy = Prony(1e10, ((0.5, 1e5), (0.4, 1e6)), 0.35)
    moduli = [abs(lazy.complex_modulus(20 * math.pi)), 3e8, 7e7]
    values, _ = shown(road(lazy), moduli=moduli, plate=plate)
    expected = FORCE[at] * static(road(lazy.glassy), plate)[:, None]
    np.testing.assert_allclose(values, expected, atol=1e-4 * expected.max())


def test_a_half_space_creeps_as_its_compliance_does():
    """u(t) = (1 - ν²) ∫ J(t - s) dF(s) / (π a E) times 2: Boussinesq with the creep compliance in place of 1/E."""
    ground = Prony(1e8, ((0.6, 0.02),), 0.35)
    bare = tl.Pavement.half_space(ground, name="soil")
    blank = drop(np.ones((len(OFFSETS), len(TIME))) * 1e-4)
    unknowns = pose(bare, memory=True, stiff_layer=None)
    (model,) = history_models(blank, unknowns, thicknesses(blank, unknowns, ("soil",)), np.array([0]))
    values = model.deflection(np.log([[[abs(ground.complex_modulus(20 * math.pi))]]]))[0, 0].reshape(len(OFFSETS), -1)
    fine = np.linspace(0, TIME[-1], 30_000)
    force = np.interp(fine, TIME, FORCE)
    rate = np.gradient(force, fine)
    for column in (5, 10, 20):
        t = TIME[blank.fitted_times[column]]
        past = fine <= t
        creep = np.trapezoid(ground.creep_compliance(t - fine[past]) * rate[past], fine[past])
        expected = 2 * (1 - 0.35**2) * creep / (math.pi * 0.15)
        # Samples of 0.2 ms and the numerical integral leave 5e-4.
        assert values[0, column] == pytest.approx(expected, rel=5e-4)


def test_moduli_come_back_and_peaks_are_not_late_without_inertia():
    values, at = shown(road())
    time, force = TIME[at], FORCE[at]
    coarse = drop(values, time, force)
    result = tl.backcalculate(coarse, road())
    wanted = [abs(ASPHALT.complex_modulus(20 * math.pi)), 3e8, 7e7]
    # Here the record itself is sampled at 1.6 ms, which the interpolation of the force between samples feels.
    np.testing.assert_allclose(result.dataset["fitted_modulus"].values[0], wanted, rtol=2e-2)
    lag = coarse.delays[0]
    # Memory delays the plate by some tenths of a millisecond and the outer sensors by less.
    assert 1e-4 < lag[0] < 1e-3
    assert abs(lag[-1]) < 1e-4
    assert coarse.flags() == [""]
    elastic = FORCE * static(road(tl.Elastic(5e9, 0.35)))[:, None]
    refitted = backcalculate(drop(elastic), road(tl.Elastic(1e9, 0.35)))
    np.testing.assert_allclose(refitted.dataset["fitted_modulus"].values[0], [5e9, 3e8, 7e7], rtol=1e-6)
    np.testing.assert_allclose(drop(elastic).delays, 0, atol=1e-9)


def test_late_peaks_are_stated_saved_and_drawn(tmp_path):
    elastic = FORCE * static(road(tl.Elastic(5e9, 0.35)))[:, None]
    late = np.stack([np.roll(row, 4 * k) for k, row in enumerate(elastic)])
    result = backcalculate(drop(late), road(tl.Elastic(1e9, 0.35)))
    assert "come 5.6 ms after those of the innermost sensor: waves travel" in result.dataset["reason"].values[0]
    tl.save_results(result, tmp_path / "moduli.nc")
    again = tl.open_results(tmp_path / "moduli.nc").backcalculation
    assert again.summary() == result.summary()
    assert "ms" in again.plot.basins().axes[0].get_xlabel()
    again.plot.moduli()


def test_a_record_is_read(tmp_path):
    file = tmp_path / "drop.csv"
    rows = [f"{t:g},{f / 4.4482216:.6f},{f * 1e-8 / 2.54e-5:.6f}" for t, f in zip(TIME, FORCE, strict=True)]
    file.write_text("Time,Force,D1\n" + "\n".join(rows))
    units = {"Time": "s", "Force": "lbf", "D1": "mil"}
    record = read_history(file, offsets=[0.0], plate_radius=0.15, units=units)
    assert record.load[0] == pytest.approx(50e3, rel=1e-6)
    assert record.peaks.deflection[0, 0] == pytest.approx(5e-4, rel=1e-5)
    with pytest.raises(InputError, match="2 offsets for 1 columns"):
        read_history(file, offsets=[0.0, 0.3], deflections=["D1"], plate_radius=0.15, units=units)
    with pytest.raises(InputError, match="rise evenly"):
        drop(np.ones((8, 300)), TIME**2, FORCE)
    with pytest.raises(InputError, match=r"needs force \(n, 300\)"):
        drop(np.ones((7, 300)))
