"""Predicted ages of road sections: the chain of one section, priors that are stated, runs that resume."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.damage import AgedLine
from treadload.errors import InputError
from treadload.life.field import mechanics
from treadload.life.field.mechanics import HARDENINGS, ages_of, predict_damage, predict_sections
from treadload.life.field.prediction import HARDENING
from treadload.life.field.priors import Priors, RoadSection
from treadload.life.field.table_file import read_field_table
from treadload.life.solve import solve_life, solve_sum
from treadload.life.surface_lines import yearly_by

# A day in one part, no thermal stress, coarse cells: a section takes half a second.
QUICK = Priors(parts_of_day=1, thermal=False, spacing=12e-3, age=0.0)
THICK = RoadSection("thick", 0.18, "ACUB", 100e3, 12.0)
THIN = RoadSection("thin", 0.06, "ACUB", None, 18.0)
TREATED = RoadSection("treated", 0.10, "ACATB", 50e3, 8.0)


@pytest.fixture(scope="module")
def solved():
    return predict_damage((THICK, THIN, TREATED), QUICK, workers=1)


def test_a_section_has_the_years_of_its_life(solved):
    """The design of a section, solved in every season by `solve_life`: within the error that the prediction prints.

    An error of a strain moves the damage of a fifth power fivefold.
    """
    contacts = QUICK.contacts()
    life = solve_life(replace(QUICK.design(THICK, contacts), tolerance=0.0), workers=1)
    damage = solved[0]
    assert damage.error < 5e-3
    bound = 5 * damage.error + 1e-6
    assert damage.surface_age() == pytest.approx(life.years("surface"), rel=bound)
    assert damage.bottom_age == pytest.approx(life.years("bottom"), rel=bound)
    assert damage.surface_age(1.0) == pytest.approx(float(life.dataset["life_years_aged_line"][0]), rel=bound)
    assert damage.largest_surface == pytest.approx(float(life.dataset["largest_reading"][0]), rel=damage.error)


def test_lines_between_those_evaluated(solved):
    """A hardening of 0.7 solved and by the cubic: the damage within 1 %, of ages that scatter by a factor of two."""
    design = QUICK.design(THIN, QUICK.contacts())
    passages = solve_sum(design, workers=1).passages
    readings, y = passages.readings.to_numpy(), passages.readings["y"].to_numpy()
    direct, _ = yearly_by(AgedLine(100e-6, -0.2, 0.7), design, readings[0], y, None)
    assert solved[1].surface_age(0.7) == pytest.approx(1 / direct, rel=0.01)


def test_ages_follow_the_traffic(solved):
    (twice,) = predict_damage((replace(THICK, traffic=200e3),), QUICK, workers=1)
    assert twice.surface_age() == pytest.approx(solved[0].surface_age() / 2, rel=1e-9)
    assert twice.bottom_age == pytest.approx(solved[0].bottom_age / 2, rel=1e-9)


def test_thin_roads_are_strained_more(solved):
    thick, thin, _ = solved
    assert thin.largest_bottom > 2 * thick.largest_bottom
    assert ages_of(solved).shape == (3,)
    assert ages_of(solved)[1] < ages_of(solved)[0]
    assert [damage.assumed_traffic for damage in solved] == [False, True, False]
    # The line of old cores bears less at the strains of a thick road's surface.
    assert thick.surface_age(1.0) < thick.surface_age(0.0)
    with pytest.raises(InputError, match=r"hardening must lie in \[0, 1.5\], got 2"):
        thick.surface_age(2.0)


def test_thermal_stress_is_a_part_of_its_own():
    with_days = replace(QUICK, thermal=True)
    (cold,) = predict_damage((replace(THICK, mean_air=4.0),), with_days, workers=1)
    assert len(cold.thermal) == len(HARDENINGS)
    assert min(cold.thermal) > 0
    alone, both = 1 / cold.traffic[0], 1 / (cold.traffic[0] + cold.thermal[0])
    assert cold.surface_age(0.0, thermal_share=0.0) == pytest.approx(alone, rel=1e-12)
    assert cold.surface_age(0.0) == pytest.approx(both, rel=1e-12)


def test_a_run_resumes(tmp_path, monkeypatch, solved):
    """One more section is solved here, for the same numbers as beside others; what follows takes those solved."""
    file = tmp_path / "sections.json"
    steps_done = []
    first = predict_damage((THICK,), QUICK, kept=file, workers=1, progress=lambda *what: steps_done.append(what))
    assert steps_done == [(1, 1, "section thick")]
    assert first[0] == solved[0]
    solved_names = []
    by_name = {damage.name: damage for damage in solved}

    def counted(section, *rest):
        solved_names.append(section.name)
        return by_name[section.name]

    monkeypatch.setattr(mechanics, "section_damage", counted)
    again = predict_damage((THICK, THIN), QUICK, kept=file, workers=1)
    assert solved_names == ["thin"]
    assert again == solved[:2]
    # Another prior is another prediction.
    predict_damage((THICK,), replace(QUICK, subgrade_modulus=50e6), kept=file, workers=1)
    assert solved_names == ["thin", "thick"]
    file.write_text("[1]", "utf-8")
    with pytest.raises(InputError, match="holds no predicted sections"):
        predict_damage((THICK,), QUICK, kept=file)


def test_what_is_interrupted_is_kept(tmp_path, monkeypatch, solved):
    file = tmp_path / "sections.json"
    sections = [replace(THICK, name=str(k), mean_air=10.0 + k) for k in range(7)]
    row = solved[0]

    def stops(section, *rest):
        if section.name == "6":
            raise KeyboardInterrupt
        return replace(row, name=section.name)

    monkeypatch.setattr(mechanics, "section_damage", stops)
    with pytest.raises(KeyboardInterrupt):
        predict_damage(sections, QUICK, kept=file, workers=1)
    solved_names = []
    monkeypatch.setattr(
        mechanics, "section_damage", lambda s, *rest: solved_names.append(s.name) or replace(row, name=s.name)
    )
    predict_damage(sections, QUICK, kept=file, workers=1)
    assert solved_names == ["6"]


def test_a_table_states_priors_with_units():
    stated = {"subgrade_modulus": "50 MPa", "granular": {"15 cm": "25 cm", "0 mm": 0.4}, "thermal": False}
    priors = Priors.of(stated, "ours.toml")
    assert priors == replace(Priors(), subgrade_modulus=50e6, granular={0.0: 0.4, 0.15: 0.25}, thermal=False)
    assert priors.of_class(priors.granular, 0.2) == 0.25
    assert Priors.of({}, "ours.toml") == Priors()
    with pytest.raises(InputError, match=r"ours\.toml: subgrade_modulus: cannot read '50 m' as a quantity in Pa"):
        Priors.of({"subgrade_modulus": "50 m"}, "ours.toml")
    with pytest.raises(InputError, match="unknown key 'subgrade'"):
        Priors.of({"subgrade": 5e7}, "ours.toml")
    with pytest.raises(InputError, match=r"granular begins at 0\.1 m of asphalt; thinner sections need a value, too"):
        Priors(granular={0.1: 0.3})


def test_priors_are_stated():
    priors = Priors()
    reasons = priors.reasons
    assert {"structure", "vehicles", "missing traffic", "tires", "wander", "weather", "age"} <= set(reasons)
    assert all(len(text) > 20 for text in reasons.values())
    assert priors.traffic_of(THIN) == 83e3
    assert priors.traffic_of(replace(THIN, thickness=0.2)) == 171e3
    assert priors.traffic_of(THICK) == 100e3
    # Three passages a truck, which stands for 1.5 standard axles.
    assert priors.traffic(THICK).passes_per_year == pytest.approx(200e3)
    assert [layer.name for layer in priors.road(TREATED).layers] == [
        "asphalt",
        "asphalt-treated base",
        "untreated base",
        "subgrade",
    ]
    assert priors.road(THICK).layers[1].thickness == 0.20
    assert priors.road(THIN).layers[1].thickness == 0.30
    assert priors.criteria(priors.road(TREATED))[1].layer == 1
    cold, warm = priors.weather(replace(THICK, mean_air=5.0)), priors.weather(replace(THICK, mean_air=22.0))
    for weather, mean in ((cold, 5.0), (warm, 22.0)):
        assert weather.air_temperature.mean() == pytest.approx(mean, abs=0.1)
    assert np.ptp(cold.air_temperature) > np.ptp(warm.air_temperature)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"thickness": 5.0}, "5 m thick.*5 inches are 0.127"),
        ({"thickness": 124.0}, "124 m thick"),
        ({"family": "GB"}, "family must be one of ACUB, ACATB, ACTB"),
        ({"traffic": 0.0}, "traffic of section thick must be a positive"),
        ({"mean_air": 50.0}, "50 °F is 10 °C"),
    ],
)
def test_bad_sections_are_refused(change, text):
    with pytest.raises(InputError, match=text):
        replace(THICK, **change)


def test_names_are_unique():
    with pytest.raises(InputError, match="two sections have the name 'thick'"):
        predict_damage((THICK, THICK), QUICK)


def test_a_section_is_a_design():
    assert isinstance(QUICK.design(THIN, QUICK.contacts()), tl.life.Design)


def test_sections_of_a_table_have_predicted_ages():
    table = read_field_table("ltpp").at(np.array([0, 3]))
    predictions = predict_sections(table, QUICK, workers=1)
    assert predictions.sections == table.sections
    assert (predictions.surface > 0).all()
    np.testing.assert_array_equal(predictions.parts["assumed_traffic"], np.isnan(table.traffic))
    assert any("traffic is missing for 1 of 2 sections" in text for text in predictions.about)
    lines = predictions.variants[HARDENING]
    assert list(lines) == list(HARDENINGS)
    np.testing.assert_array_equal(lines[0.0], predictions.surface)
    assert (lines[1.0] != predictions.surface).all()
    again = predictions.of(table.at(np.array([1])))
    assert again.variants[HARDENING][1.0] == lines[1.0][1]


def test_a_section_without_thickness_is_refused():
    table = read_field_table("ltpp").at(np.array([0, 3]))
    table.thickness[1] = np.nan
    with pytest.raises(InputError, match=f"section {table.sections[1]} has no asphalt thickness"):
        predict_sections(table, QUICK)
