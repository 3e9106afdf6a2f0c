"""Structures written as layers: what a road engineer writes is what is built."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadload as tl
from treadload.case import Case
from treadload.errors import InputError
from treadload.pavement.catalogue import find_structure
from treadload.pavement.notation import bonds, in_words, read_layers


@pytest.mark.parametrize("name", tl.catalogue.structures)
def test_the_catalogue_is_what_its_names_say(name):
    # Each name, read as layers instead of looked up, gives the catalogue's road to the last bond.
    layers = read_layers(name)
    held = bonds([material for material, _ in layers])
    written = [(one.name, thickness, bond) for (one, thickness), bond in zip(layers, held, strict=True)]
    assert written == [(one.mix, one.thickness, one.bond) for one in tl.catalogue.structures[name].courses]
    assert in_words(layers) == name
    assert tl.Pavement.from_catalogue(name) == tl.Pavement.from_catalogue(tl.catalogue.structures[name])


def test_layers_of_one_mix_stay_two():
    road = tl.Pavement.from_catalogue("6 BBSG3 / 10 GB3 / 10 GB3 / PF3", temperature=15)
    assert [layer.name for layer in road.layers] == ["EB-BBSG3", "EB-GB3", "EB-GB3", "PF3"]
    assert [layer.thickness for layer in road.layers] == [0.06, 0.1, 0.1, None]
    # E(15 °C, 10 Hz) of NF P98-086, as in the catalogue.
    assert [layer.elastic.modulus for layer in road.layers] == pytest.approx([7000e6, 9000e6, 9000e6, 120e6])
    assert all(layer.bond == tl.pavement.BONDED for layer in road.layers)


@pytest.mark.parametrize(
    "text",
    [
        "6,5 BBSG3 / 25 GNT1 / PF2qs",
        "6.5 cm EB-BBSG3 / 25cm GNT1 / PF2qs",
        "65 mm bbsg3/0.25 m GNT1/pf2QS",
        "  6.5BBSG3 /  250 mm gnt1 / PF2qs  ",
    ],
)
def test_spellings_of_one_road(text):
    found = find_structure(text)
    assert found.name == "6.5 BBSG3 / 25 GNT1 / PF2qs"
    assert tl.Pavement.from_catalogue(text) == tl.Pavement(
        [
            tl.Layer(tl.catalogue.mixes["EB-BBSG3"], 0.065, name="EB-BBSG3"),
            tl.Layer(tl.catalogue.mixes["GNT1"], 0.25, name="GNT1"),
            tl.Layer(tl.catalogue.mixes["PF2qs"], name="PF2qs"),
        ]
    )


def test_treated_layers_are_half_bonded_to_each_other_only():
    road = tl.Pavement.from_catalogue("8 BBSG3 / 18 GC-T3 / 20 GLp-T2 / 10 GNT1 / PF3")
    assert [layer.bond for layer in road.layers[:-1]] == [
        tl.pavement.BONDED,
        tl.pavement.HALF_BONDED,
        tl.pavement.BONDED,
        tl.pavement.BONDED,
    ]


@settings(deadline=None)
@given(
    courses=st.lists(
        st.tuples(st.integers(1, 4000), st.sampled_from(["EB-BBSG3", "EB-GB3", "GNT1", "GC-T3", "BBM", "EB-EME2"])),
        max_size=6,
    ),
    base=st.sampled_from(["PF1", "PF2", "PF3", "PF4"]),
    short=st.booleans(),
    unit=st.sampled_from(["", " cm", " mm", "mm", " m"]),
    mark=st.sampled_from(".,"),
)
def test_what_is_written_comes_back(courses, base, short, unit, mark):
    def shown(tenths, name):
        value = {"mm": tenths, "m": tenths / 1000}.get(unit.strip(), tenths / 10)
        number = f"{value:.4f}" if unit.strip() == "m" else f"{value:.1f}"
        return f"{number.replace('.', mark)}{unit} {name.removeprefix('EB-') if short else name}"

    text = " / ".join([*(shown(*one) for one in courses), base])
    layers = read_layers(text)
    assert [(one.name, thickness) for one, thickness in layers[:-1]] == [(name, t / 1000) for t, name in courses]
    assert layers[-1][0].name == base
    if courses:
        assert read_layers(in_words(layers)) == layers


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("6 BBSG3 / 15 GB9 / PF3", "no mix 'GB9'; did you mean 'GB[1-4]'"),
        ("6 BBSG3 / 15 GB3", "'15 GB3', has a thickness"),
        ("BBSG3 / 15 GB3 / PF3", "cannot read 'BBSG3': it does not start with a number"),
        ("6 BBSG3 / / PF3", "nothing between"),
        ("6 / 15 GB3 / PF3", "'6' names no mix"),
        ("0 BBSG3 / PF3", "must be > 0"),
        ("-6 BBSG3 / PF3", "must be > 0"),
        ("1,500 BBSG3 / PF3", "may mean 1500 or 1.5"),
        ("6 BBSG3 / 15 GB3 / PF9", "no mix 'PF9'; did you mean 'PF[1-4]'"),
        ("6 inch BBSG3 / PF3", "no mix 'inch BBSG3'"),
        ("6 BBSG3", 'write its layers, "6 BBSG3 / 10 GB3'),
    ],
)
def test_what_cannot_be_read_is_told_in_one_sentence(text, words):
    with pytest.raises(InputError, match=words) as refused:
        tl.Pavement.from_catalogue(text)
    assert "no structure" in str(refused.value)
    assert "\n" not in str(refused.value)


WHEEL = '[tire]\nprofile = "315/80R22.5"\n[pavement]\nstructure = "6 BBSG3 / PF3"\n'


def test_the_source_of_a_case_says_what_runs_it_and_what_it_takes():
    design = f"{WHEEL}[climate]\ntemperature = 15\n[traffic]\npasses_per_year = 1\n"
    with pytest.raises(InputError, match=r"^road.toml: 'traffic\.classes' is missing$"):
        Case.from_text(design, name="road.toml")
    classes = 'classes = [{ name = "rear", share = 1, axle_load = "130 kN", inflation_pressure = "8 bar" }]\n'
    criteria = '[[criteria]]\nname = "base"\nlaw = "french-bituminous"\nlayer = 1\nrisk = 0.05\n'
    life = Case.from_text(f"{design}{classes}{criteria}")
    assert life.command == "life"
    wheel = f"{WHEEL}temperature = 15\n[rolling]\nnormal_load = 1\nfriction = 0.7\n"
    assert Case.from_text(wheel).command == "run"
    with pytest.raises(
        InputError, match=r"rolling: a case with .*\[climate\].* has no use for 'rolling'; leave it out"
    ):
        Case.from_text(f"{wheel}[climate]\ntemperature = 15\n")
