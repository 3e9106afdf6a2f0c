"""Tables of road sections: what a file must say, and between which ages the events of its sections lie."""

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.life.field import EVENTS, Predictions, field_tables, mechanics, read_field_table
from treadload.life.field.priors import Priors

HEADS = (
    "state,shrp,family,asphalt_thickness_mm,kesal_per_year,mean_air_temperature_C,age_first_survey,age_last_survey,"
    "age_last_without_wheelpath_crack,age_first_wheelpath_crack,age_first_alligator,first_crack_is"
)
# Cracked before the first survey, between two, not yet; alligator cracking first in the second and the third.
ROWS = [
    "1,a,ACUB,100,50,12,6,12,,6,,at or before the first survey",
    "1,b,ACATB,150,,12,5,11,7,9,5,between surveys",
    "2,a,ACTB,200,80,12,3,10,,,10,after the last survey",
]
SURVEYS = """state,shrp,age,wheelpath_crack_m,alligator_m2
1,a,6,3,0
1,a,12,0,0
1,b,9,1,2
1,b,5,0,1
1,b,7,0,1
2,a,3,0,0
2,a,8,0,0
2,a,10,0,4
"""


def table_of(folder, rows=ROWS, heads=HEADS, surveys=None, text=""):
    (folder / "sections.csv").write_text("\n".join([heads, *rows]) + "\n")
    lines = ['name = "ours"', 'sections = "sections.csv"', *(['surveys = "surveys.csv"'] if surveys else []), text]
    if surveys:
        (folder / "surveys.csv").write_text(surveys)
    (folder / "table.toml").write_text("\n".join(lines))
    return read_field_table(folder / "table.toml")


@pytest.mark.parametrize("surveys", [None, SURVEYS])
def test_events_lie_between_surveys(tmp_path, surveys):
    table = table_of(tmp_path, surveys=surveys)
    assert table.sections == ("1-a", "1-b", "2-a")
    wheel, either = (table.interval(event) for event in EVENTS)
    np.testing.assert_array_equal(wheel.low, [0, 7, 10])
    np.testing.assert_array_equal(wheel.high, [6, 9, np.inf])
    # Without surveys the one before the alligator cracking at 10 years may have been any since the first, at 3.
    np.testing.assert_array_equal(either.low, [0, 0, 8 if surveys else 3])
    np.testing.assert_array_equal(either.high, [6, 5, 10])
    np.testing.assert_allclose(table.thickness, [0.1, 0.15, 0.2])
    np.testing.assert_allclose(table.traffic, [50e3, np.nan, 80e3])
    assert "1 of 3 sections" in table.warnings[0]
    assert "traffic" in table.warnings[0]


def test_the_catalogue_has_the_sections_of_ltpp():
    """Counts of the file's own column `first_crack_is`; 17 more sections show alligator cracking alone."""
    table = field_tables["LTPP"]
    assert len(table) == 149 == len(read_field_table("LTPP"))
    wheel, either = (table.interval(event) for event in EVENTS)
    assert [(wheel.low == 0).sum(), np.isinf(wheel.high).sum()] == [68, 48]
    assert np.isinf(wheel.high).sum() - np.isinf(either.high).sum() == 17
    assert sum(map(len, table.surveys)) == 508
    assert "LTPP InfoPave" in table.source
    assert "58 of 149" in table.warnings[0]


def test_columns_and_units_of_others(tmp_path):
    heads = HEADS.replace("asphalt_thickness_mm", "hac").replace("state,shrp", "road,km")
    text = (
        'section = ["road", "km"]\ncolumns = { thickness = "hac" }\nunits = { thickness = "in", mean_air = "degF" }'
    )
    rows = [
        row.replace(",100,50,12,", ",4,50,50,").replace("150,,12", "6,,50").replace("200,80,12", "8,80,50")
        for row in ROWS
    ]
    table = table_of(tmp_path, rows, heads, text=text)
    np.testing.assert_allclose(table.thickness, [0.1016, 0.1524, 0.2032])
    np.testing.assert_allclose(table.mean_air, 10)


def without(column):
    place = HEADS.split(",").index(column)
    cut = [",".join(cell for k, cell in enumerate(row.split(",")) if k != place) for row in (HEADS, *ROWS)]
    return {"heads": cut[0], "rows": cut[1:]}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (without("age_first_survey"), ["has no ages", "age_first_survey", 'entry = "…"']),
        (without("age_first_wheelpath_crack"), ["no age of the first crack", "first_crack"]),
        ({"rows": [ROWS[0].replace(",6,12,", ",-1,12,"), *ROWS[1:]]}, ["'1-a'", "-1 years", "before it was built"]),
        ({"rows": [ROWS[0].replace(",6,12,", ",6,4,"), *ROWS[1:]]}, ["'1-a'", "at 4 years", "first at 6"]),
        ({"rows": [ROWS[0].replace(",6,12,", ",,12,"), *ROWS[1:]]}, ["'1-a'", "no age of its surveys"]),
        ({"rows": [ROWS[0], ROWS[0]]}, ["'1-a' is there twice"]),
        (without("first_crack_is"), ["1 sections have no age", "'2-a'", 'empty_crack = "none seen"', "not recorded"]),
        (
            {"rows": [row.replace("100,50", "4,50").replace("150,", "6,").replace("200,", "8,") for row in ROWS]},
            ["6 mm", "25 to 600 mm", 'thickness = "in"'],
        ),
        ({"surveys": SURVEYS.replace("1,a,6,3", "1,a,-6,3")}, ["'1-a'", "-6 years", "before it was built"]),
        ({"surveys": SURVEYS.replace("1,b,7,0", "1,b,7,")}, ["1 cells", "'1-b'", "empty_crack"]),
        ({"surveys": SURVEYS.replace("1,b,7,0", "1,b,7,-2")}, ["negative", "-2"]),
        ({"surveys": SURVEYS.replace("1,b,7,0", "1,b,,0")}, ["'1-b' has no age"]),
        ({"surveys": SURVEYS.replace("2,a", "2,x")}, ["'2-a' has no survey"]),
        ({"text": 'columns = { thicknes = "x" }'}, ["'thicknes'", "did you mean 'thickness'"]),
        ({"text": 'units = { thickness = "feet" }'}, ["'feet'", "mm, cm, m, in"]),
        ({"text": 'section = ["road"]'}, ["'road'", "names a section"]),
    ],
)  # fmt: skip
def test_a_table_that_can_mean_two_things_is_asked(tmp_path, changes, words):
    with pytest.raises(InputError) as caught:
        table_of(tmp_path, **changes)
    for word in words:
        assert word in str(caught.value)


def test_what_an_empty_cell_means_can_be_said(tmp_path):
    cut = without("first_crack_is")
    seen = table_of(tmp_path, **cut, text='empty_crack = "none seen"')
    assert np.isinf(seen.interval("wheel-path").high[2])
    assert len(seen) == 3
    left = table_of(tmp_path, **cut, text='empty_crack = "not recorded"')
    assert left.sections == ("1-a", "1-b")
    assert "1 of 3 sections are left out" in left.warnings[0]
    # The survey at 7 years recorded no cracks: the first lies between 5 and 9.
    gap = table_of(tmp_path, surveys=SURVEYS.replace("1,b,7,0", "1,b,7,"), text='empty_crack = "not recorded"')
    assert gap.interval("wheel-path").low[1] == 5


def test_few_sections_are_for_a_look_only(tmp_path):
    with pytest.raises(InputError, match="3 sections, and a fit needs at least 30"):
        table_of(tmp_path).check_fit()
    with pytest.raises(InputError, match="no event 'rut'"):
        table_of(tmp_path).interval("rut")
    field_tables["LTPP"].check_fit()


def test_predictions_follow_the_sections_of_a_table(tmp_path):
    table = table_of(tmp_path)
    ages = Predictions(("2-a", "1-b", "1-a", "x"), np.array([3.0, 2, 1, 9]), np.full(4, np.inf), {"k": np.arange(4)})
    ordered = ages.of(table)
    np.testing.assert_array_equal(ordered.surface, [1, 2, 3])
    np.testing.assert_array_equal(ordered.parts["k"], [2, 1, 0])
    with pytest.raises(InputError, match="1 of 3 sections have no predicted age, '2-a' first"):
        Predictions(("1-a", "1-b"), np.ones(2), np.ones(2)).of(table)
    with pytest.raises(InputError, match="positive years, got 0"):
        Predictions(("1-a", "1-b"), np.array([1.0, 0]), np.ones(2))
    with pytest.raises(InputError, match="2 sections, got shape"):
        Predictions(("1-a", "1-b"), np.ones(3), np.ones(2))


def test_priors_of_a_table_are_kept_for_the_mechanics(tmp_path, monkeypatch):
    table = table_of(tmp_path, text='[priors]\nsubgrade_modulus = "50 MPa"')
    assert table.priors == {"subgrade_modulus": "50 MPa"}
    assert table.at(np.array([0])).priors == table.priors
    assumed = []

    def damages(sections, priors, **options):
        assumed.append(priors)
        raise InputError("stopped")

    monkeypatch.setattr(mechanics, "sections_of", lambda table: ())
    monkeypatch.setattr(mechanics, "predict_damage", damages)
    for priors in (None, Priors(age=8.0)):
        with pytest.raises(InputError, match="stopped"):
            mechanics.predict_sections(table, priors)
    assert assumed == [Priors(subgrade_modulus=50e6), Priors(age=8.0)]
