"""Noise and points that stick out: measured, named, and taken out of the contact."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import treadload as tl
from tire_meshes import RIB_TREAD, lugged_mesh, stick_out, tire_mesh, write
from treadload.cli import app
from treadload.errors import GeometryError, InputError
from treadload.tire import Tire, example_mesh
from treadload.tire.scan.noise import roughness, smoothing_length

MESHES = Path(__file__).parents[1] / "data" / "tire_meshes"
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))


def contact_of(tire, load):
    return tl.solve_contact(tire, ROAD, tl.Rolling(normal_load=load, friction=0.0))


def peak(tire, load):
    contact = contact_of(tire, load)
    return float(contact.dataset.pressure.max()), contact.warnings


def ribs(tmp_path, noise, seed=1):
    return write(tmp_path / "ribs.ply", *tire_mesh(noise=noise, seed=seed, around=300, across=60))


def lugs(tmp_path, noise):
    return write(tmp_path / "lugs.ply", *lugged_mesh(noise=noise, around=600, across=61)[:2])


@pytest.mark.parametrize("noise", [0.1e-3, 0.3e-3, 1e-3])
def test_the_noise_of_a_scan_is_measured(tmp_path, noise):
    # Medians over thousands of points are good to 2 %; walls and rounded ends add a little.
    assert Tire.from_scan(ribs(tmp_path, noise)).quality.noise == pytest.approx(noise, rel=0.1)
    assert Tire.from_scan(lugs(tmp_path, noise)).quality.noise == pytest.approx(noise, rel=0.1)


def test_a_mesh_without_noise_has_none(tmp_path):
    for path in (ribs(tmp_path, 0.0), lugs(tmp_path, 0.0), example_mesh()):
        quality = Tire.from_scan(path).quality
        assert quality.noise < 1e-5
        assert not any("noise" in text for text in quality.warnings)


@pytest.mark.slow
def test_noise_that_a_scanner_smoothed_is_measured_as_well(tmp_path):
    vertices, faces = tire_mesh(replace(RIB_TREAD, grooves=()), around=1500, across=70)
    # The same error on three points in a row, 2.2 mm apart: neighbours agree and the tread does not.
    error = np.random.default_rng(5).normal(scale=0.3e-3, size=len(vertices) // 3 + 1).repeat(3)[: len(vertices)]
    r = np.hypot(vertices[:, 0], vertices[:, 2])
    vertices *= np.stack([1 + error / r, np.ones_like(r), 1 + error / r], axis=1)
    quality = Tire.from_scan(write(tmp_path / "tire.ply", vertices, faces)).quality
    assert 0.15e-3 < quality.noise < 0.35e-3
    assert any("mm of noise" in text for text in quality.warnings)


def test_noise_is_told_by_the_contact_and_auto_takes_it_out(tmp_path):
    load = 32.5e3
    still, _ = peak(Tire.from_scan(ribs(tmp_path, 0.0), inflation_pressure=820e3), load)
    path = ribs(tmp_path, 0.3e-3)
    rough, warnings = peak(Tire.from_scan(path, inflation_pressure=820e3), load)
    assert rough > 1.25 * still
    assert any("0.30 mm of noise" in text and 'smooth="auto"' in text and "revolve=True" in text for text in warnings)
    tire = Tire.from_scan(path, smooth="auto", inflation_pressure=820e3)
    assert tire.quality.revolved
    mended, warnings = peak(tire, load)
    # The mean of 360 angles leaves 0.02 mm, which is worth 2 % (0.05 mm of raw noise is worth 5 to 7 %).
    assert mended == pytest.approx(still, rel=0.025)
    assert any("0.30 mm of noise: the tread is its meridian revolved instead" in text for text in warnings)


@pytest.mark.slow
def test_smoothing_leaves_lugs_as_they_are(tmp_path):
    load = 5e3
    still = contact_of(Tire.from_scan(lugs(tmp_path, 0.0), inflation_pressure=300e3), load)
    path = lugs(tmp_path, 0.3e-3)
    rough = contact_of(Tire.from_scan(path, inflation_pressure=300e3), load)
    assert any('smooth="auto"' in text and "revolve" not in text for text in rough.warnings)
    tire = Tire.from_scan(path, smooth="auto", inflation_pressure=300e3)
    assert not tire.quality.revolved
    # 61 rows of 600 points: each has 3.8 mm to itself.
    spacing = float(np.sqrt(2 * np.pi * 0.35 / 600 * 0.24 / 60))
    assert tire.quality.smoothing == pytest.approx(smoothing_length(0.3e-3, spacing), rel=0.1)
    mended = contact_of(tire, load)
    found, made = float(mended.dataset.pressure.max()), float(still.dataset.pressure.max())
    # Rounded ends of lugs give way a little where the window takes them with the rest.
    assert found == pytest.approx(made, rel=0.1)

    def off(contact):
        return float(((contact.dataset.pressure - still.dataset.pressure) ** 2).sum()) ** 0.5

    # Cell by cell; what stays are edges, ragged by noise across the tread.
    assert off(mended) < 0.75 * off(rough)


def test_the_length_of_smoothing_follows_from_the_pressure_it_leaves():
    length = smoothing_length(0.3e-3, 4e-3)
    assert roughness(0.3e-3, 4e-3, length) == pytest.approx(2.5e-3)
    # White noise behind a Gaussian window presses with E*|k|/2 per wave: the same by a sum over waves.
    k = np.linspace(0, 12 / length, 20001)
    power = (0.3e-3 * 4e-3) ** 2 * (0.5 * k) ** 2 * np.exp(-((k * length) ** 2)) * k / (2 * np.pi)
    assert np.sqrt(np.trapezoid(power, k)) == pytest.approx(2.5e-3, rel=1e-3)


def test_a_window_too_short_is_told(tmp_path):
    path = ribs(tmp_path, 0.3e-3)
    tire = Tire.from_scan(path, smooth=2e-3)
    assert tire.quality.smoothing == 2e-3
    assert any('smooth="auto" would take' in text for text in tire.quality.warnings)
    for bad in (True, 0.0, 1.0, "much", float("nan")):
        with pytest.raises(InputError, match="smooth must be"):
            Tire.from_scan(path, smooth=bad)


_SLOW = pytest.mark.slow


@pytest.mark.parametrize("height", [0.7e-3, 5e-3, pytest.param(0.1, marks=_SLOW), pytest.param(1e9, marks=_SLOW)])
@pytest.mark.slow
def test_a_point_that_sticks_out_is_named_and_put_back(tmp_path, height):
    vertices, faces = tire_mesh(around=300, across=60)
    below = (0.0, 0.02, -0.538)
    still, _ = peak(Tire.from_scan(write(tmp_path / "a.stl", vertices, faces), inflation_pressure=820e3), 32.5e3)
    path = write(tmp_path / "b.stl", stick_out(vertices, height, near=below), faces)
    tire = Tire.from_scan(path, units="m", inflation_pressure=820e3)
    (found,) = tire.quality.outliers
    # Beyond 10 000 times the tire there is no telling how far.
    assert found.height == pytest.approx(height, rel=0.05) or height > 1e3
    assert found.y == pytest.approx(0.02, abs=5e-3)
    # 1.5 mm of a facet of the mesh: half a degree.
    assert abs(found.angle) < 0.02
    pressure, warnings = peak(tire, 32.5e3)
    assert pressure == pytest.approx(still, rel=2e-3)
    assert any("stuck out of the tire in one place" in text and "1 point was put back" in text for text in warnings)
    with pytest.raises(GeometryError, match="sticks out of its tread in 1 place"):
        Tire.from_scan(path, units="m", outliers="refuse")
    if height == 5e-3:
        kept = Tire.from_scan(path, outliers="keep", inflation_pressure=820e3)
        assert peak(kept, 32.5e3)[0] > 1.3 * still
        assert any("left in it" in text for text in kept.quality.warnings)


@pytest.mark.slow
def test_a_clump_and_a_speck_beside_the_tire_are_outliers(tmp_path):
    vertices, faces = tire_mesh(around=300, across=60)
    clump = stick_out(vertices, 4e-3, near=(0.0, 0.02, -0.538), count=4)
    assert Tire.from_scan(write(tmp_path / "clump.ply", clump, faces)).quality.outliers[0].points == 4
    speck = np.array([[0, 0, -0.55], [4e-3, 0, -0.55], [0, 4e-3, -0.55], [0, 0, -0.553]])
    more = np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]]) + len(vertices)
    path = write(tmp_path / "speck.ply", np.concatenate([vertices, speck]), np.concatenate([faces, more]))
    tire = Tire.from_scan(path)
    assert tire.quality.outliers[0].points == 4
    assert tire.surface.first_contact == pytest.approx(0.538, abs=0.1e-3)


@pytest.mark.slow
def test_nothing_of_a_clean_tire_is_taken(tmp_path):
    meshes = example_mesh().parents[0], MESHES
    paths = [path for folder in meshes for path in sorted(folder.glob("*.obj"))]
    assert len(paths) == 4
    # With every noise that a scanner has: one point in 500 million lies beyond six deviations.
    paths += [ribs(tmp_path, 0.3e-3, seed=7), lugs(tmp_path, 0.0)]
    bars = lugged_mesh(angle=0, lugs=18, overlap=0.12, around=600, across=41)[:2]
    paths.append(write(tmp_path / "bars.ply", *bars))
    for path in paths:
        assert Tire.from_scan(path).quality.outliers == (), path


@pytest.mark.slow
def test_a_stone_in_a_groove_and_a_stud_on_a_sidewall_stay(tmp_path):
    vertices, faces = tire_mesh(around=300, across=60)
    groove = RIB_TREAD.grooves[1].centre
    stone = stick_out(vertices, 8e-3, near=(0.0, groove, -0.523), count=3)
    assert Tire.from_scan(write(tmp_path / "stone.ply", stone, faces)).quality.outliers == ()
    letter = vertices.copy()
    side = np.argsort(np.linalg.norm(vertices - np.array([0, -0.16, -0.42]), axis=1))[:6]
    letter[side, 1] -= 2e-3
    assert Tire.from_scan(write(tmp_path / "letter.ply", letter, faces)).quality.outliers == ()


@pytest.mark.slow
def test_many_places_are_refused_unless_they_belong(tmp_path):
    vertices, faces = tire_mesh(around=300, across=60)
    r = np.hypot(vertices[:, 0], vertices[:, 2])
    studs = np.flatnonzero(r > 0.536)[::250]
    assert len(studs) > 40
    factor = 1 + 1.5e-3 / r[studs]
    vertices[studs] *= np.stack([factor, np.ones_like(factor), factor], axis=1)
    path = write(tmp_path / "studs.ply", vertices, faces)
    with pytest.raises(GeometryError, match=r'more than the 30.*outliers="keep"'):
        Tire.from_scan(path)
    assert len(Tire.from_scan(path, outliers="keep").quality.outliers) > 40


@pytest.mark.slow
def test_the_command_tells_noise_and_outliers(tmp_path):
    vertices, faces = tire_mesh(noise=0.2e-3, around=300, across=70)
    path = str(write(tmp_path / "tire.ply", stick_out(vertices, 0.05, near=(0.0, 0.02, -0.538)), faces))
    said = CliRunner().invoke(app, ["scan", path])
    assert said.exit_code == 0, said.output
    assert "noise 0.20 mm" in said.stdout
    told = re.search(r"stuck out of the tire in one place \((\S+) mm high at y = (\S+) mm", said.stdout)
    # Points lie up to 4 mm apart across, and the point had 0.2 mm of noise before it was pushed.
    assert float(told[1]) == pytest.approx(50, abs=1)
    assert float(told[2]) == pytest.approx(20, abs=4)
    said = CliRunner().invoke(app, ["scan", path, "--smooth", "auto"])
    assert "revolved from its meridian" in said.stdout
    said = CliRunner().invoke(app, ["scan", path, "--smooth", "6 mm", "--revolve", "no"])
    assert "smoothed over 6.0 mm" in said.stdout
    assert CliRunner().invoke(app, ["scan", path, "--outliers", "refuse"]).exit_code == 2
    assert "yes, no or auto" in CliRunner().invoke(app, ["scan", path, "--revolve", "maybe"]).stderr


def test_facets_are_revolved_by_default_and_print_no_zigzag(tmp_path):
    """The example mesh has 48 facets: their corners raise the peak by 8 % where they are kept."""
    tires = {
        choice: Tire.from_scan(example_mesh(), revolve=choice, inflation_pressure=820e3) for choice in ("auto", False)
    }
    found = {choice: peak(tire, 32.5e3)[0] for choice, tire in tires.items()}
    assert tires["auto"].quality.revolved
    assert found[False] > 1.06 * found["auto"]


@pytest.mark.parametrize("across", [3e-3, 10e-3])
@pytest.mark.slow
def test_grooves_across_the_tread_are_never_revolved_away(tmp_path, across):
    """Few and narrow, they cover 1 to 3 % of the tread."""
    vertices, faces = tire_mesh(replace(RIB_TREAD, grooves=()), around=700, across=40)
    theta = np.arctan2(vertices[:, 0], vertices[:, 2])
    void = ((theta * 10 / (2 * np.pi)) % 1 < across * 10 / (2 * np.pi * 0.538)) & (np.abs(vertices[:, 1]) < 0.13)
    vertices[void] *= np.array([0.98, 1, 0.98])
    tire = Tire.from_scan(write(tmp_path / "tire.ply", vertices, faces), smooth="auto")
    assert not tire.quality.revolved
