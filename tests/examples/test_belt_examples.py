"""The examples of the inflated belt run on coarse cells and end in checked numbers."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples" / "belt"


@pytest.mark.slow
def test_load_deflection(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLES / "load_deflection.py"))["main"](tmp_path, spacing=12e-3)
    rms = found["rms"]
    # Five measured points, one fitted number; cells of 6 mm give 7.1 and 18.0 %.
    assert rms["belt"] <= 0.08
    assert rms["belt"] < rms["half-space, eq. 15 anew"]
    assert rms["half-space, eq. 15 as printed"] == pytest.approx(0.18, abs=0.005)
    assert rms["half-space, one E"] > 0.3
    # Cells of 12 mm move the foundation by 1 % from those of 6 mm, 4.37 ± 0.38 /m.
    assert found["foundation"] == pytest.approx(4.37, rel=0.03)
    assert found["deviation"] == pytest.approx(0.38, rel=0.2)
    # The data alone: no tire grows faster than its pressure, and then half as much.
    (grown, inflated), (later, more) = found["growth"][40, 70], found["growth"][70, 95]
    assert grown > inflated
    assert later - 1 < 0.5 * (more - 1)
    assert found["alone"][70] > 1.25 * max(found["alone"][40], found["alone"][95])
    assert "What the data contradict" in capsys.readouterr().out
    assert (tmp_path / "load_deflection.png").stat().st_size > 10_000


@pytest.mark.slow
def test_two_tires(tmp_path, capsys):
    found = runpy.run_path(str(EXAMPLES / "two_tires.py"))["main"](tmp_path, spacing=6e-3, card_spacing=8e-3)
    known = {name: dict(differences) for name, differences in found["stiffness"].items()}
    bound = ("longitudinal_stiffness", "cornering_stiffness", "lateral_stiffness", "relaxation_length")
    # The textbook's within 20 %, all at once, with the catalogue's belt; cells of 8 and 6 mm differ by 1 %.
    for name in (*bound, "secant_stiffness"):
        assert abs(known["belt"][name]) < 0.2, name
    assert sum(abs(known["half-space"][name]) > 0.4 for name in bound) == 3
    # What is not met, and is said: the belt rolls on too large a radius, its trail is short.
    assert known["belt"]["effective_radius_ratio"] == pytest.approx(0.03, abs=0.01)
    assert -0.35 < known["belt"]["pneumatic_trail"] < -0.15
    # The sensor's 58 761 mm²: met by the tread that was fitted to it, beyond a belt even with its grooves.
    sensor = 58_761e-6
    assert found["print"]["half-space"]["net"] == pytest.approx(sensor, rel=0.06)
    assert found["print"]["belt"]["gross"] < 0.9 * sensor
    # Shear on the road in free rolling: towards the middle of the tire, and out of each rib; none at ν = 0.5.
    sheared = found["ribs"]
    for name in ("belt", "belt, ν = 0.49"):
        left, *_, right = sheared[name].lateral.values
        assert left > 1e-3
        assert right < -1e-3
        assert (sheared[name].bulging > 0).all()
    assert float(abs(sheared["half-space"].lateral).max()) < 1e-4
    assert (sheared["half-space, ν = 0.47"].bulging < 0).all()
    # Free of force along: what the outer ribs drag the middle ones push.
    along = sheared["belt"].longitudinal
    assert abs(float(along.sum())) < 1e-6
    assert float(along[0]) < 0 < float(along[2])
    said = " ".join(capsys.readouterr().out.split())
    for words in ("textbook", "0.73 of the inflation", "of the tire on the road"):
        assert words in said
    for name in ("pressure.png", "sections.png"):
        assert (tmp_path / name).stat().st_size > 10_000


@pytest.mark.slow
def test_road_under_a_belt(tmp_path):
    found = runpy.run_path(str(EXAMPLES / "road.py"))["main"](tmp_path, spacing=6e-3)
    surface, passes = found["surface"], found["structure"]
    # Closed form of a surface that is pressed around a groove: the extension goes as the pressure beside it.
    assert surface["free, half-space"]["space"] == pytest.approx(25.8, rel=0.02)
    assert surface["free, belt"]["space"] / surface["free, half-space"]["space"] == pytest.approx(2.0, abs=0.25)
    assert surface["driving, belt"]["mean"] < 0.95 * surface["driving, half-space"]["mean"]
    # Base and platform feel the shorter print, not the cells: 3 mm give 100.3, 107.8 and 316, 326.
    base, platform = passes["base, bottom-up"], passes["platform, rutting"]
    assert base["free, half-space"][0] == pytest.approx(100.3e-6, rel=0.01)
    assert base["free, belt"][0] == pytest.approx(107.8e-6, rel=0.01)
    assert base["free, belt"][1] / base["free, half-space"][1] == pytest.approx(0.70, abs=0.03)
    assert platform["free, belt"][0] / platform["free, half-space"][0] == pytest.approx(1.032, abs=0.005)
    # The surface never governs.
    for name, (_, allowed) in passes["surface, top-down"].items():
        assert allowed > 1e3 * base[name][1]
    for name in ("strain_free.png", "strain_driving.png"):
        assert (tmp_path / name).stat().st_size > 10_000
